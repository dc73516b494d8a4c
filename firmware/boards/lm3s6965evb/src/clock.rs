//! The clock tick and the vsync. The panel has no vsync of its own to tell: the tick is the vsync.

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{SCB, SYST};

/// The processor's clock after a reset, in Hz.
const CLOCK: u32 = 12_500_000;

/// Ticks of the clock from one vsync to the next: 60 a second.
pub const TICKS_PER_FRAME: u32 = CLOCK / 60;

static VSYNCS: AtomicU32 = AtomicU32::new(0);

/// Starts the tick.
pub fn start(mut timer: SYST) {
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(TICKS_PER_FRAME - 1);
    timer.clear_current();
    timer.enable_counter();
    timer.enable_interrupt();
}

#[cortex_m_rt::exception]
fn SysTick() {
    VSYNCS.store(VSYNCS.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

/// Sleeps until there have been other than `seen` vsyncs: how many there have been.
pub fn wait_beyond(seen: u32) -> u32 {
    loop {
        let now = VSYNCS.load(Ordering::Relaxed);
        if now != seen {
            return now;
        }
        // With interrupts held back the tick cannot come between the look and the sleep; it wakes the processor all the
        // same.
        cortex_m::interrupt::free(|_| {
            if VSYNCS.load(Ordering::Relaxed) == seen {
                cortex_m::asm::wfi();
            }
        });
    }
}

/// Ticks since the start; wraps.
pub fn ticks() -> u32 {
    loop {
        let vsyncs = VSYNCS.load(Ordering::Relaxed);
        let left = SYST::get_current();
        // The timer has begun anew, and its interrupt waits: the count is one behind.
        let pending = u32::from(SCB::is_pendst_pending());
        if VSYNCS.load(Ordering::Relaxed) == vsyncs && SYST::get_current() <= left {
            // The timer counts down, and is 0 where it begins anew.
            let since = if left == 0 { 0 } else { TICKS_PER_FRAME - left };
            return vsyncs.wrapping_add(pending).wrapping_mul(TICKS_PER_FRAME).wrapping_add(since);
        }
    }
}
