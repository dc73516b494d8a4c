//! The panel: an SSD0323 with 128 x 64 pixels of 16 gray levels, fed band by band.

use core::convert::Infallible;

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Dimensions, Point, Size};
use embedded_graphics::pixelcolor::{Gray4, GrayColor};
use embedded_graphics::prelude::PointsIter;
use embedded_graphics::primitives::Rectangle;
use galpix_registers::lm3s6965::{GPIOC_DEN, GPIOC_DIR, GPIOC_DR8R, GPIOC_PIN7, RCGC2};

use crate::ssi;

/// Columns.
pub const WIDTH: u32 = 128;
/// Rows.
pub const HEIGHT: u32 = 64;
/// Rows of a band.
pub const BAND_ROWS: u32 = 8;

/// Bytes of a row: two pixels each.
const PITCH: usize = WIDTH as usize / 2;

/// Pin 7 of port C tells the panel commands from pixels.
const DATA: u32 = 0x80;

/// How the panel is set up. `A0` decides which nibble comes first and in which direction rows and columns run: what a
/// board with the panel mounted otherwise has to change.
const SETUP: &[u8] = &[
    0xae, // off
    0x15, 0x00, 0x3f, // all columns, in pairs
    0x75, 0x00, 0x3f, // all rows
    0x81, 0x3f, // contrast
    0x86, // full current range
    0xa0, 0x52, // remap
    0xa1, 0x00, // first row
    0xa2, 0x4c, // offset
    0xa8, 0x3f, // 64 rows
    0xa4, // not inverted
    0xb1, 0x22, // phases
    0xb2, 0x46, // row period
    0xb3, 0xa0, // clock
    0xbc, 0x10, // precharge
    0xbe, 0x1c, // deselect level
    0xbf, 0x0d, // segment low voltage
    0xb8, 0x01, 0x11, 0x22, 0x32, 0x43, 0x54, 0x65, 0x76, // gray levels
    0xad, 0x03, // converter on
    0xaf, // on
];

/// All columns and rows from the first on: where the next picture goes.
const HOME: &[u8] = &[0x15, 0x00, 0x3f, 0x75, 0x00, 0x3f];

/// The panel.
pub struct Oled(());

impl Oled {
    /// Starts it.
    pub fn start() -> Self {
        ssi::start();
        RCGC2.set(1 << 2);
        let _ = RCGC2.read();
        GPIOC_DIR.set(DATA);
        GPIOC_DR8R.set(DATA);
        GPIOC_DEN.set(DATA);
        let oled = Self(());
        oled.command(SETUP);
        oled
    }

    fn command(&self, bytes: &[u8]) {
        ssi::finish();
        GPIOC_PIN7.write(0);
        for &byte in bytes {
            ssi::send(byte);
        }
        ssi::finish();
        GPIOC_PIN7.write(DATA);
    }

    /// Begins a picture.
    pub fn begin(&mut self) {
        self.command(HOME);
    }

    /// Sends the next band.
    pub fn send(&mut self, band: &Band) {
        for &bytes in band.rows.as_flattened().as_chunks().0 {
            ssi::send_eight(bytes);
        }
    }
}

/// Some rows of the picture, as the panel wants them: the left one of two pixels in the upper nibble.
pub struct Band {
    rows: [[u8; PITCH]; BAND_ROWS as usize],
    top: i32,
}

impl Band {
    /// An empty one at the top.
    pub const fn new() -> Self {
        Self { rows: [[0; PITCH]; BAND_ROWS as usize], top: 0 }
    }

    /// Makes it that of the rows from `top` on.
    pub fn move_to(&mut self, top: u32) {
        self.top = top as i32;
    }

    fn row(&mut self, y: i32) -> Option<&mut [u8; PITCH]> {
        self.rows.get_mut((y - self.top) as usize)
    }
}

impl Dimensions for Band {
    fn bounding_box(&self) -> Rectangle {
        Rectangle::new(Point::new(0, self.top), Size::new(WIDTH, BAND_ROWS))
    }
}

impl DrawTarget for Band {
    type Color = Gray4;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Gray4>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(Point { x, y }, colour) in pixels {
            let Some(byte) = self.row(y).and_then(|row| row.get_mut((x >> 1) as usize)) else { continue };
            let luma = colour.luma();
            *byte = if x & 1 == 0 { *byte & 0x0f | luma << 4 } else { *byte & 0xf0 | luma };
        }
        Ok(())
    }

    fn fill_contiguous<I: IntoIterator<Item = Gray4>>(
        &mut self,
        area: &Rectangle,
        colours: I,
    ) -> Result<(), Infallible> {
        let Rectangle { top_left: Point { x, y }, size } = *area;
        let row = if x == 0 && size == Size::new(WIDTH, 1) { self.row(y) } else { None };
        let Some(row) = row else {
            return self.draw_iter(area.points().zip(colours).map(|(point, colour)| Pixel(point, colour)));
        };
        // A whole row: two pixels at a time.
        let mut colours = colours.into_iter();
        for byte in row {
            let (Some(left), Some(right)) = (colours.next(), colours.next()) else { break };
            *byte = left.luma() << 4 | right.luma();
        }
        Ok(())
    }
}
