//! The display controller on a Versatile Express A9: a PL111 scans 320 x 240 colour pixels out of memory, and a frame
//! is made for each of its vsyncs.
//!
//! The display controller is one that microcontrollers have built in; only the processor is a stand-in.

#![no_std]
#![no_main]
#![forbid(unsafe_code)]

mod end;
mod interrupts;
mod memory;
mod panel;
mod uart;

use galpix_controller::board::Board;
use galpix_controller::inpainted;
use galpix_controller::session::{Session, log_start};
use galpix_core::{Controller, Galpixmap, Grid, Margin, Scratch, SetupError, Static};
use galpix_link::panel::Panel;
use galpix_registers::vexpress::{TIMER_CONTROL, TIMER_COUNTER, TIMER_LOAD};

use memory::{Lent, SHARES};
use panel::{Lcd, Picture};

/// The display as the host knows it.
type Display = galpix_link::panel::Lcd;
/// How galpixels are stored.
type Stored = Static<Display>;

/// The private timer's clock, in Hz.
const CLOCK: u32 = 100_000_000;

/// What the board gives.
struct Express {
    lcd: Lcd,
    vsyncs: u32,
}

impl Board for Express {
    type Pixel = embedded_graphics::pixelcolor::Rgb565;
    type Band = Picture;

    const TICKS_PER_FRAME: u32 = CLOCK / 60;

    fn vsync(&mut self) -> u32 {
        let now = interrupts::wait_beyond(self.vsyncs);
        let passed = now.wrapping_sub(self.vsyncs);
        self.vsyncs = now;
        passed
    }

    fn ticks(&self) -> u32 {
        // It counts down.
        !TIMER_COUNTER.read()
    }

    fn show(&mut self, mut draw: impl FnMut(&mut Picture, u32, u32)) {
        draw(self.lcd.hidden(), 0, panel::HEIGHT);
        self.lcd.flip();
    }

    fn receive(&mut self) -> Option<u8> {
        uart::LINE.receive()
    }

    fn send(&mut self, byte: u8) {
        uart::LINE.send(byte);
    }
}

#[aarch32_rt::entry]
fn main() -> ! {
    let lent = Lent::take();
    TIMER_LOAD.write(u32::MAX);
    TIMER_CONTROL.write(3);
    uart::start();
    let lcd = Lcd::start(lent.pictures);
    interrupts::start();
    log_start(&Display::DESCRIPTION, Stored::new(), &SHARES);

    let board = Express { lcd, vsyncs: 0 };
    let Ok(controller) = controller(lent.maps, lent.scratch, lent.starts) else { end::fail() };
    let Ok(maps) = inpainted::of_panel::<Display, _>(controller, lent.push_pull) else { end::fail() };
    Session::new(board, maps, Display::DESCRIPTION, Display::SETTINGS).run()
}

/// The two maps over the memory of the program.
fn controller(
    [front, back]: [&'static mut [u32]; 2],
    scratch: Scratch<'static>,
    starts: &'static mut [u32],
) -> Result<Controller<'static, Stored>, SetupError> {
    let grid = Grid::new(u32::from(Display::WIDTH), u32::from(Display::HEIGHT), Margin::NONE, starts)?;
    Controller::new(Galpixmap::new(grid, Stored::new(), front)?, Galpixmap::new(grid, Stored::new(), back)?, scratch)
}
