//! The line to the host.

use galpix_registers::vexpress::{UART0_CR, UART0_DR, UART0_FR, UART0_ICR, UART0_IMSC, UART0_LCRH};
use galpix_uart::{Registers, Uart};

/// Bytes of the queue.
const QUEUE: usize = 4096;

/// The line.
pub static LINE: Uart<QUEUE> =
    Uart::new(Registers { data: UART0_DR, flags: UART0_FR, mask: UART0_IMSC, clear: UART0_ICR });

/// Starts it.
pub fn start() {
    UART0_CR.write(0);
    UART0_LCRH.write(0x70);
    UART0_CR.write(0x301);
    LINE.start();
}
