//! The registers of the boards, and what else needs `unsafe`: all of it in this crate, and nothing else in it.
//!
//! A [`Register`] can be made here only. Each constant of a board's module is a 32-bit register that may
//! be read and written at any time without breaking Rust's rules: none makes a device write to memory.

#![no_std]
#![deny(missing_docs)]

pub mod cortex_m;
pub mod lm3s6965;
#[cfg(feature = "rp2040")]
pub mod rp2040;
pub mod vexpress;

/// A 32-bit register.
#[derive(Debug)]
pub struct Register(usize);

impl Register {
    /// # Safety
    ///
    /// There must be a register at `address` on the board that uses it, for which the promise of this crate holds.
    const unsafe fn at(address: usize) -> Self {
        Self(address)
    }

    /// Reads the register.
    #[inline(always)]
    #[must_use]
    pub fn read(&self) -> u32 {
        // SAFETY: `at` promises it.
        unsafe { (self.0 as *const u32).read_volatile() }
    }

    /// Writes the register.
    #[inline(always)]
    pub fn write(&self, value: u32) {
        // SAFETY: `at` promises it.
        unsafe { (self.0 as *mut u32).write_volatile(value) }
    }

    /// Sets some bits and leaves the others.
    #[inline(always)]
    pub fn set(&self, bits: u32) {
        self.write(self.read() | bits);
    }

    /// Waits until some of `bits` are set.
    #[inline(always)]
    pub fn wait_for(&self, bits: u32) {
        while self.read() & bits == 0 {}
    }
}

macro_rules! registers {
    ($($(#[$doc:meta])* $name:ident = $address:expr;)*) => {$(
        $(#[$doc])*
        // SAFETY: an address from the board's manual.
        pub const $name: $crate::Register = unsafe { $crate::Register::at($address) };
    )*};
}
pub(crate) use registers;

/// The bytes of the stack that have been used since the start, where it was painted with `0xcccc_cccc` before. `end`
/// and `start` are the lowest and the highest address of the stack.
///
/// # Safety
///
/// All words between must be readable memory.
#[must_use]
unsafe fn painted_stack_used(end: usize, start: usize) -> usize {
    let mut word = end;
    // SAFETY: the caller promises it.
    while word < start && unsafe { (word as *const u32).read_volatile() } == 0xcccc_cccc {
        word += 4;
    }
    start - word
}
