//! Where a program that cannot go on ends.

/// Ends the program by standing still: there is no one to tell.
pub fn fail() -> ! {
    loop {
        cortex_m::asm::wfi();
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    #[cfg(feature = "probe")]
    defmt::error!("the program panicked");
    fail()
}

#[cfg(feature = "probe")]
use defmt_rtt as _;
