//! Where a program that cannot go on ends.

use defmt_semihosting as _;

/// Ends the program with a code that says that it failed.
pub fn fail() -> ! {
    semihosting::process::exit(101)
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    defmt::error!("the program panicked");
    fail()
}
