//! The board: all that touches registers or raw memory, and all `unsafe`. An Arm MPS2 with the image AN386 (Cortex-M4),
//! as QEMU models it.

use core::mem::{align_of, size_of};
use core::ptr;

/// The PSRAM, which no linker script mentions.
const PSRAM: usize = 0x2100_0000;
/// Its bytes.
const PSRAM_BYTES: usize = 16 << 20;

/// The first CMSDK timer: 32 bits, counts down at 25 MHz.
const TIMER: usize = 0x4000_0000;
/// Its registers, from [`TIMER`] on.
const CONTROL: usize = 0;
const VALUE: usize = 4;
const RELOAD: usize = 8;

/// What the board has, given out once.
pub struct Machine {
    /// The clock's timer, running.
    pub timer: Timer,
    /// Memory beside that of statics and stack.
    pub psram: Psram,
}

impl Machine {
    /// The board, for the first who asks.
    pub fn take() -> Option<Self> {
        let _ = cortex_m::Peripherals::take()?;
        for (register, value) in [(RELOAD, u32::MAX), (VALUE, u32::MAX), (CONTROL, 1)] {
            // SAFETY: a register of the timer, which nobody else writes.
            unsafe { ptr::write_volatile((TIMER + register) as *mut u32, value) };
        }
        Some(Self { timer: Timer(()), psram: Psram { next: PSRAM } })
    }
}

/// The running timer.
#[derive(Clone, Copy)]
pub struct Timer(());

impl Timer {
    /// Ticks since some moment; wraps.
    pub fn now(self) -> u32 {
        // SAFETY: reading this register changes nothing.
        !unsafe { ptr::read_volatile((TIMER + VALUE) as *const u32) }
    }
}

/// Memory that is lent for good.
pub struct Psram {
    next: usize,
}

impl Psram {
    /// `count` times `value`, or nothing if there is not so much left.
    pub fn lend<T: Copy>(&mut self, count: usize, value: T) -> Option<&'static mut [T]> {
        let start = self.next.next_multiple_of(align_of::<T>());
        let end = start.checked_add(size_of::<T>().checked_mul(count)?)?;
        if end > PSRAM + PSRAM_BYTES {
            return None;
        }
        self.next = end;
        let first = start as *mut T;
        for index in 0..count {
            // SAFETY: within the PSRAM, aligned, and lent to nobody before.
            unsafe { first.add(index).write(value) };
        }
        // SAFETY: as above, and every element was written.
        Some(unsafe { core::slice::from_raw_parts_mut(first, count) })
    }
}

/// Two instructions, `times` times. `times` is not 0.
#[inline(always)]
pub fn two_instructions(times: u32) {
    // SAFETY: counts a register down.
    unsafe {
        core::arch::asm!(
            "2:",
            "subs {times}, #1",
            "bne 2b",
            times = inout(reg) times => _,
            options(nomem, nostack),
        );
    }
}

/// Bytes of the stack that were ever used. The start-up code has painted it.
pub fn stack_used() -> usize {
    unsafe extern "C" {
        static _stack_end: u32;
        static _stack_start: u32;
    }
    let (mut word, start) = (&raw const _stack_end, &raw const _stack_start);
    // SAFETY: between the ends of the stack; volatile, for what is painted there is no object of the program's.
    while word < start && unsafe { ptr::read_volatile(word) } == cortex_m_rt::STACK_PAINT_VALUE {
        word = word.wrapping_add(1);
    }
    start.addr() - word.addr()
}
