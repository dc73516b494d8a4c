//! The clock tick and the vsync of boards whose panel has no vsync of its own to tell: the tick is the vsync.
//!
//! It is the SysTick timer, which every Cortex-M has, and its interrupt.

#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{SCB, SYST};

static VSYNCS: AtomicU32 = AtomicU32::new(0);

/// Starts the tick: one every `ticks_per_frame` clocks of the processor, at most 2 to the 24.
pub fn start(mut timer: SYST, ticks_per_frame: u32) {
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(ticks_per_frame - 1);
    timer.clear_current();
    timer.enable_counter();
    timer.enable_interrupt();
}

#[cortex_m_rt::exception]
fn SysTick() {
    VSYNCS.store(VSYNCS.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

/// Sleeps until there have been other than `seen` vsyncs; returns how many there have been.
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

/// Returns the clocks since the start, with as many to a frame as [`start`] was told; wraps.
pub fn ticks(ticks_per_frame: u32) -> u32 {
    loop {
        let vsyncs = VSYNCS.load(Ordering::Relaxed);
        let left = SYST::get_current();
        // The timer has begun anew, and its interrupt waits: the count is one behind.
        let pending = u32::from(SCB::is_pendst_pending());
        if VSYNCS.load(Ordering::Relaxed) == vsyncs && SYST::get_current() <= left {
            // The timer counts down, and is 0 where it begins anew.
            let since = if left == 0 { 0 } else { ticks_per_frame - left };
            return vsyncs.wrapping_add(pending).wrapping_mul(ticks_per_frame).wrapping_add(since);
        }
    }
}
