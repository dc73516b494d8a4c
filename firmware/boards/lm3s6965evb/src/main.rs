//! The display controller on an LM3S6965: a Cortex-M3 with 64 KiB of RAM and an OLED of 128 x 64 gray pixels.
//!
//! Two maps of 128 x 64 galpixels would take all of the RAM. So there is one, with galpixels of a single word, and a
//! window of rows that rolls down it.

#![no_std]
#![no_main]
#![forbid(unsafe_code)]

mod end;
mod memory;
mod panel;
mod ssi;
mod uart;

use galpix_controller::board::Board;
use galpix_controller::inpainted;
use galpix_controller::session::{Session, log_start};
use galpix_core::rolling::Rolling;
use galpix_core::{Galpixmap, Grid, Margin, Scratch, SetupError, Static};
use galpix_link::panel::Panel;

use memory::{Lent, SHARES};
use panel::{Band, Oled};

/// The display as the host knows it.
type Display = galpix_link::panel::Oled;
/// How galpixels are stored.
type Stored = Static<Display>;

/// The processor's clock after a reset, in Hz.
const CLOCK: u32 = 12_500_000;
/// Clocks from one vsync to the next: 60 a second.
const TICKS_PER_FRAME: u32 = CLOCK / 60;

/// What the board gives.
struct Evaluation {
    oled: Oled,
    band: &'static mut Band,
    vsyncs: u32,
}

impl Board for Evaluation {
    type Pixel = embedded_graphics::pixelcolor::Gray4;
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
        self.oled.begin();
        let mut top = 0;
        while top < panel::HEIGHT {
            self.band.move_to(top);
            draw(self.band, top, panel::BAND_ROWS);
            self.oled.send(self.band);
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

#[cortex_m_rt::entry]
fn main() -> ! {
    let Some(peripherals) = cortex_m::Peripherals::take() else { end::fail() };
    let lent = Lent::take();
    uart::start();
    let oled = Oled::start();
    galpix_tick::start(peripherals.SYST, TICKS_PER_FRAME);
    log_start(&Display::DESCRIPTION, Stored::new(), &SHARES);
    let (_, stack) = galpix_registers::cortex_m::stack();
    defmt::info!("memory: {=usize} bytes are left for the stack", stack);

    let board = Evaluation { oled, band: lent.band, vsyncs: 0 };
    let Ok(rolling) = rolling(lent.map, lent.window, lent.starts, lent.turns) else { end::fail() };
    let Ok(maps) = inpainted::of_panel::<Display, _>(rolling, lent.push_pull) else { end::fail() };
    Session::new(board, maps, Display::DESCRIPTION, Display::SETTINGS).run()
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
