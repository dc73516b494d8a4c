//! The panel: an ST7789 with 320 x 240 colour pixels over SPI, fed band by band. Each galpixel is shown as 2 x 2
//! pixels.
//!
//! `mipidsi` knows the panel's commands. Pixels go out by DMA from two line buffers: one is sent while the other is
//! filled.

use core::convert::Infallible;

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Dimensions, Point, Size};
use embedded_graphics::pixelcolor::Rgb565;
use embedded_graphics::prelude::{PointsIter, RgbColor};
use embedded_graphics::primitives::Rectangle;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiBus;
use mipidsi::interface::{Interface, InterfaceKind};
use mipidsi::models::ST7789;
use mipidsi::options::{ColorInversion, Orientation, Rotation};
use mipidsi::{Builder, Display};
use rp2040_hal::dma::{CH0, Channel, single_buffer};
use rp2040_hal::gpio::bank0::{Gpio8, Gpio10, Gpio11, Gpio12};
use rp2040_hal::gpio::{FunctionSio, FunctionSpi, Pin, PullDown, SioOutput};
use rp2040_hal::pac::SPI1;
use rp2040_hal::spi::{Enabled, Spi};

/// Columns of the map.
pub const WIDTH: usize = 160;
/// Rows of the map.
pub const HEIGHT: u32 = 120;
/// Rows of the map in a band.
pub const BAND_ROWS: u32 = 8;
/// Pixels of the panel for a galpixel, along each side.
const SCALE: u32 = 2;

/// A row of the panel, as it is sent: two bytes to the pixel, the high one first.
pub type Line = [u8; WIDTH * SCALE as usize * 2];

/// An output pin.
type Output<P> = Pin<P, FunctionSio<SioOutput>, PullDown>;
/// The bus to the panel, which only sends: data out on GPIO 11, clock on GPIO 10.
pub type Bus = Spi<Enabled, SPI1, (Pin<Gpio11, FunctionSpi, PullDown>, Pin<Gpio10, FunctionSpi, PullDown>), 8>;
/// Tells commands (low) from data.
pub type DataPin = Output<Gpio8>;
/// Low resets the panel.
pub type ResetPin = Output<Gpio12>;

/// What sends a line: at rest with the buffer that is free, or at work.
enum Sender {
    Idle(Channel<CH0>, &'static mut Line, Bus),
    Busy(single_buffer::Transfer<Channel<CH0>, &'static mut Line, Bus>),
}

impl Sender {
    /// Waits until the line is out of its buffer.
    fn idle(self) -> (Channel<CH0>, &'static mut Line, Bus) {
        match self {
            Self::Idle(channel, line, bus) => (channel, line, bus),
            Self::Busy(transfer) => transfer.wait(),
        }
    }
}

/// The way to the panel.
pub struct Wire {
    /// Always there, but while it is changed.
    sender: Option<Sender>,
    /// The buffer that is filled, and how far it is.
    line: &'static mut Line,
    filled: usize,
    data: DataPin,
}

impl Wire {
    /// Makes it of a channel, two buffers, the bus and the pin that tells commands from data.
    pub fn new(channel: Channel<CH0>, [line, free]: [&'static mut Line; 2], bus: Bus, data: DataPin) -> Self {
        Self { sender: Some(Sender::Idle(channel, free, bus)), line, filled: 0, data }
    }

    /// Sends the line that is filled, once the one before is out, and goes on with the other buffer.
    fn send_line(&mut self) {
        let Some(sender) = self.sender.take() else { return };
        let (channel, free, bus) = sender.idle();
        let full = core::mem::replace(&mut self.line, free);
        self.filled = 0;
        self.sender = Some(Sender::Busy(single_buffer::Config::new(channel, full, bus).start()));
    }

    /// Sends bytes after all that is on its way, and waits until they are out.
    fn with_bus(&mut self, send: impl FnOnce(&mut Bus, &mut DataPin, &[u8])) {
        let Some(sender) = self.sender.take() else { return };
        let (channel, free, mut bus) = sender.idle();
        let Ok(()) = bus.flush();
        send(&mut bus, &mut self.data, self.line.get(..self.filled).unwrap_or_default());
        self.sender = Some(Sender::Idle(channel, free, bus));
    }
}

impl Interface for Wire {
    type Word = u8;
    type Error = Infallible;

    const KIND: InterfaceKind = InterfaceKind::Serial4Line;

    fn send_command(&mut self, command: u8, arguments: &[u8]) -> Result<(), Infallible> {
        self.with_bus(|bus, data, _| {
            let Ok(()) = data.set_low();
            let Ok(()) = bus.write(&[command]);
            let Ok(()) = bus.flush();
            let Ok(()) = data.set_high();
            let Ok(()) = bus.write(arguments);
            let Ok(()) = bus.flush();
        });
        Ok(())
    }

    fn send_pixels<const N: usize>(&mut self, pixels: impl IntoIterator<Item = [u8; N]>) -> Result<(), Infallible> {
        // `for_each`, and not a loop: what repeats pixels is quicker from the inside.
        pixels.into_iter().for_each(|pixel| {
            if let Some(to) = self.line.get_mut(self.filled..).and_then(|rest| rest.first_chunk_mut()) {
                *to = pixel;
            }
            self.filled += N;
            if self.filled >= self.line.len() {
                self.send_line();
            }
        });
        if self.filled > 0 {
            self.with_bus(|bus, _, begun| {
                let Ok(()) = bus.write(begun);
            });
            self.filled = 0;
        }
        Ok(())
    }

    fn send_repeated_pixel<const N: usize>(&mut self, pixel: [u8; N], count: u32) -> Result<(), Infallible> {
        self.send_pixels((0..count).map(|_| pixel))
    }
}

/// The panel.
pub struct Tft(Display<Wire, ST7789, ResetPin>);

impl Tft {
    /// Starts it, black. `None` if it cannot be set up.
    pub fn start(wire: Wire, reset: ResetPin, delay: &mut impl DelayNs) -> Option<Self> {
        let mut display = Builder::new(ST7789, wire)
            .invert_colors(ColorInversion::Inverted)
            .orientation(Orientation::new().rotate(Rotation::Deg90))
            .reset_pin(reset)
            .init(delay)
            .ok()?;
        display.clear(Rgb565::BLACK).ok()?;
        Some(Self(display))
    }

    /// Sends a band.
    pub fn send(&mut self, band: &Band) {
        let (width, rows) = (WIDTH as u32 * SCALE, BAND_ROWS * SCALE);
        let (right, top) = (width as u16 - 1, (band.top as u32 * SCALE) as u16);
        let twice = |row| core::iter::repeat_n(row, SCALE as usize);
        let pixels =
            band.rows.iter().flat_map(twice).flat_map(|row: &[Rgb565; WIDTH]| row.iter().flat_map(twice_pixel));
        let Ok(()) = self.0.set_pixels(0, top, right, top + rows as u16 - 1, pixels);
    }
}

fn twice_pixel(&pixel: &Rgb565) -> [Rgb565; SCALE as usize] {
    [pixel; SCALE as usize]
}

/// Some rows of the picture.
pub struct Band {
    rows: [[Rgb565; WIDTH]; BAND_ROWS as usize],
    top: i32,
}

impl Band {
    /// An empty one at the top.
    pub const fn new() -> Self {
        Self { rows: [[Rgb565::BLACK; WIDTH]; BAND_ROWS as usize], top: 0 }
    }

    /// Makes it that of the rows from `top` on.
    pub fn move_to(&mut self, top: u32) {
        self.top = top as i32;
    }

    fn row(&mut self, y: i32) -> Option<&mut [Rgb565; WIDTH]> {
        self.rows.get_mut((y - self.top) as usize)
    }
}

impl Dimensions for Band {
    fn bounding_box(&self) -> Rectangle {
        Rectangle::new(Point::new(0, self.top), Size::new(WIDTH as u32, BAND_ROWS))
    }
}

impl DrawTarget for Band {
    type Color = Rgb565;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(Point { x, y }, colour) in pixels {
            if let Some(to) = self.row(y).and_then(|row| row.get_mut(x as usize)) {
                *to = colour;
            }
        }
        Ok(())
    }

    fn fill_contiguous<I: IntoIterator<Item = Rgb565>>(
        &mut self,
        area: &Rectangle,
        colours: I,
    ) -> Result<(), Infallible> {
        let Rectangle { top_left: Point { x, y }, size } = *area;
        let row = if x == 0 && size == Size::new(WIDTH as u32, 1) { self.row(y) } else { None };
        let Some(row) = row else {
            return self.draw_iter(area.points().zip(colours).map(|(point, colour)| Pixel(point, colour)));
        };
        for (to, colour) in row.iter_mut().zip(colours) {
            *to = colour;
        }
        Ok(())
    }
}
