//! The engine's kernels on all states of a tiny budget, on this processor: ends with 0 if all are right and their hash
//! is the one that every processor has.

#![no_std]
#![no_main]

use cortex_m_rt::{ExceptionFrame, entry, exception};
use galpix_kernels::{HASH, ROWS, STATES, WORDS, check};
use semihosting::{eprintln, println, process};

#[entry]
fn main() -> ! {
    static mut FRONT: [u32; WORDS] = [0; WORDS];
    static mut BACK: [u32; WORDS] = [0; WORDS];
    static mut STARTS: [u32; ROWS] = [0; ROWS];
    match check(FRONT, BACK, STARTS) {
        Ok(HASH) => {
            println!("{} states, each as in plain numbers; hash {:08x}, as on every processor", STATES, HASH);
            process::exit(0)
        }
        Ok(hash) => {
            eprintln!("{} states are right, but the hash of their words is {:08x} and not {:08x}", STATES, hash, HASH)
        }
        Err(wrong) => eprintln!("wrong: {:?}", wrong),
    }
    process::exit(1)
}

#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    process::exit(102)
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    process::exit(101)
}
