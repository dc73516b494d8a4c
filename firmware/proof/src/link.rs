//! What the linker is told; all `unsafe` is here.

unsafe extern "C" {
    /// Defined nowhere.
    safe fn galpix_proof_failed_because_a_panic_can_be_reached() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    galpix_proof_failed_because_a_panic_can_be_reached()
}

/// Where the program would begin.
// SAFETY: no other crate defines this symbol, and nobody calls it.
#[unsafe(no_mangle)]
extern "C" fn _start() -> ! {
    loop {
        crate::run();
    }
}
