//! The line to the host: 115 200 baud.

use galpix_registers::cortex_m::unmask;
use galpix_registers::lm3s6965::{
    RCGC1, UART0_CTL, UART0_DR, UART0_FBRD, UART0_FR, UART0_IBRD, UART0_ICR, UART0_IM, UART0_LCRH,
};
use galpix_uart::{Registers, Uart};
use lm3s6965::{Interrupt, interrupt};

/// Bytes of the queue: those of five frames of the display.
pub const QUEUE: usize = 1024;

/// The line.
pub static LINE: Uart<QUEUE> =
    Uart::new(Registers { data: UART0_DR, flags: UART0_FR, mask: UART0_IM, clear: UART0_ICR });

/// Starts it.
pub fn start() {
    RCGC1.set(1);
    let _ = RCGC1.read();
    UART0_CTL.write(0);
    // 12.5 MHz / (16 * 115 200) = 6 + 50/64.
    UART0_IBRD.write(6);
    UART0_FBRD.write(50);
    UART0_LCRH.write(0x70);
    UART0_CTL.write(0x301);
    LINE.start();
    unmask(Interrupt::UART0 as u16);
}

#[interrupt]
fn UART0() {
    LINE.take();
}
