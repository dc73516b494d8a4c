//! What all Cortex-M processors have.

/// Lets the interrupt with this number through to the processor: only a handler that is safe at any time may stand
/// behind it.
pub fn unmask(interrupt: u16) {
    const ISER: usize = 0xe000_e100;
    // SAFETY: one bit of a write-one-to-set register; the handlers of the firmware use atomics and critical sections
    // only.
    unsafe { ((ISER + usize::from(interrupt >> 5) * 4) as *mut u32).write_volatile(1 << (interrupt & 31)) }
}

/// Bytes of the stack used so far, and bytes that it has.
#[cfg(target_os = "none")]
#[must_use]
pub fn stack() -> (usize, usize) {
    unsafe extern "C" {
        static _stack_end: u32;
        static _stack_start: u32;
    }
    let (end, start) = (&raw const _stack_end as usize, &raw const _stack_start as usize);
    // SAFETY: the linker script puts both into the RAM, which the start-up code has painted.
    (unsafe { crate::painted_stack_used(end, start) }, start - end)
}
