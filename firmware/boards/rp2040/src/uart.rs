//! The line to the host: 921 600 baud on GPIO 0 (out) and 1 (in).

use galpix_registers::cortex_m::unmask;
use galpix_registers::rp2040::{UART0_DR, UART0_FR, UART0_ICR, UART0_IM};
use galpix_uart::{Registers, Uart};
use rp2040_hal::fugit::RateExtU32;
use rp2040_hal::gpio::bank0::{Gpio0, Gpio1};
use rp2040_hal::gpio::{FunctionUart, Pin, PullDown};
use rp2040_hal::pac::{Interrupt, RESETS, UART0, interrupt};
use rp2040_hal::uart::{DataBits, StopBits, UartConfig, UartPeripheral};

use rp2040_hal::fugit::HertzU32;

/// Bytes of the queue: those of a frame of the display.
pub const QUEUE: usize = 3072;

/// The line.
pub static LINE: Uart<QUEUE> =
    Uart::new(Registers { data: UART0_DR, flags: UART0_FR, mask: UART0_IM, clear: UART0_ICR });

/// Starts it. *Errors:* a clock that gives no such rate; then no byte comes or goes.
pub fn start(
    uart: UART0,
    pins: (Pin<Gpio0, FunctionUart, PullDown>, Pin<Gpio1, FunctionUart, PullDown>),
    resets: &mut RESETS,
    clock: HertzU32,
) -> Result<(), rp2040_hal::uart::Error> {
    let config = UartConfig::new(921_600.Hz(), DataBits::Eight, None, StopBits::One);
    UartPeripheral::new(uart, pins, resets).enable(config, clock)?;
    LINE.start();
    unmask(Interrupt::UART0_IRQ as u16);
    Ok(())
}

#[interrupt]
fn UART0_IRQ() {
    LINE.take();
}
