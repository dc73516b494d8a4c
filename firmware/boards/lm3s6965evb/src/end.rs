//! Where a program that cannot go on ends.

/// Ends the program: in the emulator with a code that says that it failed, on a board by standing still.
pub fn fail() -> ! {
    #[cfg(feature = "emulator")]
    semihosting::process::exit(101);
    #[cfg(not(feature = "emulator"))]
    loop {
        cortex_m::asm::wfi();
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    defmt::error!("the program panicked");
    fail()
}

#[cfg(feature = "emulator")]
use defmt_semihosting as _;

#[cfg(feature = "probe")]
use defmt_rtt as _;
