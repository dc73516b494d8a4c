//! Labels above panels, drawn by `embedded-graphics` as a firmware would draw them.

use super::{GROUND, paste};
use crate::picture::Picture;
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use embedded_graphics::prelude::{DrawTarget, Drawable, OriginDimensions, Pixel, Point, Size};
use embedded_graphics::text::{Baseline, Text};
use std::convert::Infallible;

/// Rows that [`labelled`] adds above a picture.
pub const LABEL_ROWS: usize = 14;

const INK: Rgb888 = Rgb888::new(226, 226, 232);

/// Returns the picture with a strip of [`LABEL_ROWS`] above it that carries `label`.
///
/// The font has ASCII, 6 pixels a character; other characters become `?`, and what is wider than the picture is cut.
#[must_use]
pub fn labelled(picture: &Picture, label: &str) -> Picture {
    let mut sheet = Picture::filled(picture.width, picture.height + LABEL_ROWS, GROUND);
    let style = MonoTextStyle::new(&FONT_6X10, INK);
    let Ok(_) = Text::with_baseline(label, Point::new(2, 2), style, Baseline::Top).draw(&mut Canvas(&mut sheet));
    paste(picture, &mut sheet, 0, LABEL_ROWS); // last: a label of two lines must not write into the picture
    sheet
}

/// A picture to draw on; what falls outside is dropped, as the trait requires.
struct Canvas<'a>(&'a mut Picture);

impl OriginDimensions for Canvas<'_> {
    fn size(&self) -> Size {
        let side = |pixels: usize| u32::try_from(pixels).unwrap_or(u32::MAX);
        Size::new(side(self.0.width), side(self.0.height))
    }
}

impl DrawTarget for Canvas<'_> {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(Point { x, y }, colour) in pixels {
            let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { continue };
            if x < self.0.width && y < self.0.height {
                self.0.pixels[y * self.0.width + x] = [colour.r(), colour.g(), colour.b()];
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the strip as art: `#` where there is ink.
    fn art(picture: &Picture) -> Vec<String> {
        let mark = |x, y| if picture.at(x, y) == GROUND { '.' } else { '#' };
        (0..LABEL_ROWS).map(|y| (0..picture.width).map(|x| mark(x, y)).collect()).collect()
    }

    #[test]
    fn a_letter_stands_in_the_strip_and_the_picture_below_it() {
        let sheet = labelled(&Picture::filled(8, 2, [7; 3]), "T");
        assert_eq!((sheet.width, sheet.height), (8, 2 + LABEL_ROWS));
        assert_eq!(sheet.pixels[8 * LABEL_ROWS..], [[7; 3]; 16]);
        let rows = art(&sheet);
        assert_eq!(rows[3], "..#####.");
        assert_eq!(rows[6], "....#...");
    }

    #[test]
    fn long_and_foreign_labels_are_cut_not_refused() {
        for (width, height) in [(0, 0), (1, 1), (9, 0), (20, 3)] {
            let sheet = labelled(&Picture::filled(width, height, [7; 3]), "sample-and-hold τ\nsecond line");
            assert_eq!(sheet.pixels.len(), width * (height + LABEL_ROWS));
            assert!(sheet.pixels[width * LABEL_ROWS..].iter().all(|&pixel| pixel == [7; 3]), "text in the picture");
        }
    }
}
