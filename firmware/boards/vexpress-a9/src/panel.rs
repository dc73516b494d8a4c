//! The panel: a PL111 that scans one of two pictures out of memory, at 60 frames a second.

use core::convert::Infallible;
use core::mem;

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Point, Size};
use embedded_graphics::pixelcolor::{IntoStorage, Rgb565};
use embedded_graphics::prelude::PointsIter;
use embedded_graphics::primitives::Rectangle;
use galpix_registers::vexpress::{LCD_CONTROL, LCD_IMSC, LCD_TIMING0, LCD_TIMING1, LCD_TIMING2, LCD_UPBASE};

/// Columns.
pub const WIDTH: u32 = 320;
/// Rows.
pub const HEIGHT: u32 = 240;

/// A picture as the display controller reads it: 5 bits of red, 6 of green, 5 of blue.
#[repr(align(8))]
pub struct Picture {
    rows: [[u16; WIDTH as usize]; HEIGHT as usize],
}

/// The display controller and its two pictures.
pub struct Lcd {
    shown: &'static mut Picture,
    hidden: &'static mut Picture,
}

impl Lcd {
    /// Starts it with two black pictures.
    pub fn start([shown, hidden]: [&'static mut Picture; 2]) -> Self {
        LCD_TIMING0.write((WIDTH / 16 - 1) << 2 | 63 << 8 | 31 << 16 | 63 << 24);
        LCD_TIMING1.write((HEIGHT - 1) | 1 << 10 | 5 << 16 | 12 << 24);
        LCD_TIMING2.write(1 << 26 | (WIDTH - 1) << 16);
        let lcd = Self { shown, hidden };
        lcd.point();
        // An interrupt when the next picture's address has been taken over: from then on the other one is free.
        LCD_IMSC.write(1 << 2);
        // On, 5:6:5 with red in the high bits, a TFT, its power on.
        LCD_CONTROL.write(1 | 6 << 1 | 1 << 5 | 1 << 8 | 1 << 11);
        lcd
    }

    /// The picture that is not shown: at a vsync it is free to be drawn on.
    pub fn hidden(&mut self) -> &mut Picture {
        self.hidden
    }

    /// Shows the other picture from the next vsync on.
    pub fn flip(&mut self) {
        mem::swap(&mut self.shown, &mut self.hidden);
        self.point();
    }

    fn point(&self) {
        // The display reads what is in memory, not what the compiler or the processor still has on its way.
        core::sync::atomic::fence(core::sync::atomic::Ordering::SeqCst);
        LCD_UPBASE.write(self.shown.rows.as_ptr() as usize as u32);
    }
}

impl Picture {
    /// A black one.
    pub const fn new() -> Self {
        Self { rows: [[0; WIDTH as usize]; HEIGHT as usize] }
    }
}

impl OriginDimensions for Picture {
    fn size(&self) -> Size {
        Size::new(WIDTH, HEIGHT)
    }
}

impl DrawTarget for Picture {
    type Color = Rgb565;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(Point { x, y }, colour) in pixels {
            if let Some(pixel) = self.rows.get_mut(y as usize).and_then(|row| row.get_mut(x as usize)) {
                *pixel = colour.into_storage();
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
        let row = if x == 0 && size == Size::new(WIDTH, 1) { self.rows.get_mut(y as usize) } else { None };
        let Some(row) = row else {
            return self.draw_iter(area.points().zip(colours).map(|(point, colour)| Pixel(point, colour)));
        };
        for (pixel, colour) in row.iter_mut().zip(colours) {
            *pixel = colour.into_storage();
        }
        Ok(())
    }
}
