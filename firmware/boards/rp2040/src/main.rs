//! The display controller on a Raspberry Pi Pico: an RP2040, of which one Cortex-M0+ is used, and an ST7789 of 320 x
//! 240 colour pixels.
//!
//! A map of 320 x 240 galpixels of two words would be larger than the RAM. So there are 160 x 120, each shown as 2 x 2
//! pixels, in one map and a window of rows that rolls down it.

#![no_std]
#![no_main]
#![forbid(unsafe_code)]

mod end;
mod memory;
mod panel;
mod uart;

use embedded_hal::digital::OutputPin;
use galpix_controller::board::Board;
use galpix_controller::session::{Session, log_start};
use galpix_core::rolling::Rolling;
use galpix_core::{Galpixmap, Grid, Margin, Scratch, SetupError, Static};
use galpix_link::panel::Panel;
use rp2040_hal::clocks::{Clock, init_clocks_and_plls};
use rp2040_hal::dma::DMAExt;
use rp2040_hal::fugit::RateExtU32;
use rp2040_hal::gpio::Pins;
use rp2040_hal::{Sio, Spi, Timer, Watchdog, pac};

use memory::{Lent, SHARES};
use panel::{Band, Tft, Wire};

/// The display as the host knows it.
type Display = galpix_link::panel::Tft;
/// How galpixels are stored.
type Stored = Static<Display>;

/// The crystal of a Pico, in Hz.
const CRYSTAL: u32 = 12_000_000;
/// The processor's clock, in Hz.
const CLOCK: u32 = 125_000_000;
/// Frames a second: the longest takes 54 ms, 20 of them on the bus.
const RATE: u32 = 15;
/// Clocks from one frame to the next.
const TICKS_PER_FRAME: u32 = CLOCK / RATE;
/// The clock of the bus to the panel, in Hz: half of the processor's, the quickest that there is.
const BUS: u32 = 62_500_000;

/// What the board gives.
struct Pico {
    tft: Tft,
    band: &'static mut Band,
    vsyncs: u32,
}

impl Board for Pico {
    type Pixel = embedded_graphics::pixelcolor::Rgb565;
    type Band = Band;

    const TICKS_PER_FRAME: u32 = TICKS_PER_FRAME;

    fn vsync(&mut self) -> u32 {
        let now = galpix_tick::wait_beyond(self.vsyncs);
        let passed = now.wrapping_sub(self.vsyncs);
        self.vsyncs = now;
        passed
    }

    fn ticks(&self) -> u32 {
        galpix_tick::ticks(TICKS_PER_FRAME)
    }

    fn stack(&self) -> (u32, u32) {
        let (used, size) = galpix_registers::cortex_m::stack();
        (used as u32, size as u32)
    }

    fn show(&mut self, mut draw: impl FnMut(&mut Band, u32, u32)) {
        let mut top = 0;
        while top < panel::HEIGHT {
            self.band.move_to(top);
            draw(self.band, top, panel::BAND_ROWS);
            self.tft.send(self.band);
            top += panel::BAND_ROWS;
        }
    }

    fn receive(&mut self) -> Option<u8> {
        uart::LINE.receive()
    }

    fn send(&mut self, byte: u8) {
        uart::LINE.send(byte);
    }
}

#[rp2040_hal::entry]
fn main() -> ! {
    let (Some(core), Some(chip)) = (cortex_m::Peripherals::take(), pac::Peripherals::take()) else { end::fail() };
    let lent = Lent::take();
    let Some(board) = pico(core, chip, lent.band, lent.lines) else { end::fail() };
    log_start(&Display::DESCRIPTION, Stored::new(), &SHARES);
    let Ok(rolling) = rolling(lent.map, lent.window, lent.starts, lent.turns) else { end::fail() };
    Session::new(board, rolling, Display::DESCRIPTION, Display::SETTINGS).run()
}

/// Sets up clocks, pins, panel and line. `None` if one of them cannot be set up.
fn pico(
    core: cortex_m::Peripherals,
    chip: pac::Peripherals,
    band: &'static mut Band,
    lines: [&'static mut panel::Line; 2],
) -> Option<Pico> {
    let mut resets = chip.RESETS;
    let mut watchdog = Watchdog::new(chip.WATCHDOG);
    let clocks =
        init_clocks_and_plls(CRYSTAL, chip.XOSC, chip.CLOCKS, chip.PLL_SYS, chip.PLL_USB, &mut resets, &mut watchdog)
            .ok()?;
    let mut timer = Timer::new(chip.TIMER, &mut resets, &clocks);
    let sio = Sio::new(chip.SIO);
    let pins = Pins::new(chip.IO_BANK0, chip.PADS_BANK0, sio.gpio_bank0, &mut resets);
    let peripheral = clocks.peripheral_clock.freq();

    let line = (pins.gpio0.reconfigure(), pins.gpio1.reconfigure());
    uart::start(chip.UART0, line, &mut resets, peripheral).ok()?;

    let bus = Spi::<_, _, _, 8>::new(chip.SPI1, (pins.gpio11.reconfigure(), pins.gpio10.reconfigure()));
    // The mode in which this processor's bus leaves no gaps between bytes.
    let bus = bus.init(&mut resets, peripheral, BUS.Hz(), embedded_hal::spi::MODE_3);
    // The panel is alone on its bus: it is always selected. Its light is on.
    let Ok(()) = pins.gpio9.into_push_pull_output().set_low();
    let Ok(()) = pins.gpio13.into_push_pull_output().set_high();
    let wire = Wire::new(chip.DMA.split(&mut resets).ch0, lines, bus, pins.gpio8.reconfigure());
    let tft = Tft::start(wire, pins.gpio12.reconfigure(), &mut timer)?;
    galpix_tick::start(core.SYST, TICKS_PER_FRAME);
    Some(Pico { tft, band, vsyncs: 0 })
}

/// The map and its window over the memory of the program.
fn rolling(
    map: &'static mut [u32],
    window: &'static mut [u32],
    starts: &'static mut [u32],
    turns: &'static mut [u32],
) -> Result<Rolling<'static, Stored>, SetupError> {
    let grid = Grid::new(u32::from(Display::WIDTH), u32::from(Display::HEIGHT), Margin::NONE, starts)?;
    let rolls = Grid::window(&grid, memory::WINDOW_ROWS as u32, turns)?;
    Rolling::new(
        Galpixmap::new(grid, Stored::new(), map)?,
        Galpixmap::new(rolls, Stored::new(), window)?,
        Scratch::default(),
    )
}
