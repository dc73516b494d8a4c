//! A pinned overlay: cells without motion and with priority over everything, as a head-up display has them.
//!
//! An overlay is a surface of its own, never a part of a map: propagation, resolution, edges and fills do not know it, so it
//! cannot smear, and nothing that it covers is lost. It takes part in scan-out alone: [`row`] shows an overlay's colour where
//! something is pinned and the map's elsewhere. Without an overlay [`crate::scan_out::row`] is what it was.
//!
//! It may be smaller than the display (a status bar, a cross-hair) and lie anywhere on it, so that an embedded controller
//! pays memory only for what it pins: a word a cell. With the feature `embedded-graphics` it is a `DrawTarget`: text, lines
//! and pictures are drawn into it once and stay until they are removed.

use core::marker::PhantomData;

use crate::budget::{Bits, Demand};
use crate::colour::Colour;
use crate::error::SetupError;
use crate::galpixel::{Budget, Class, Fixed, Galpixel, Profile, Static};
use crate::galpixmap::Galpixmap;
use crate::grid::Grid;
use crate::layout::{Lanes, Layout};
use crate::scan_out::{self, Over};

/// The layout of an overlay: class and colour.
#[derive(Clone, Copy, Debug)]
pub struct Pinned<C>(PhantomData<C>);

impl<C: Colour> Layout for Pinned<C> {
    type Colour = C;
    const LANES: Lanes = Lanes::NONE;
}

/// What does not move has no budget to choose; this one is never asked.
#[derive(Debug)]
pub struct Motionless;

impl Profile for Motionless {
    const BITS: Bits = Bits::must(Bits::derive(Demand { extent: 64, recog: 8, prop: 8 }));
}

/// A surface pinned to the display.
#[derive(Debug)]
pub struct Overlay<'p, C> {
    map: Galpixmap<'p, Pinned<C>, Static<Motionless>>,
    left: u32,
    top: u32,
}

impl<'p, C: Colour> Overlay<'p, C> {
    /// Words of memory that an overlay over `grid` needs: one a cell.
    #[must_use]
    pub const fn words(grid: &Grid<'_>) -> usize {
        grid.cells() as usize
    }

    /// An overlay of the size of a grid's display, with nothing pinned, in the top left corner of the picture. Wings, if the
    /// grid has any, are never seen.
    ///
    /// *Errors:* memory shorter than [`Self::words`].
    pub fn new(grid: Grid<'p>, memory: &'p mut [u32]) -> Result<Self, SetupError> {
        const { assert!(<Static<Motionless> as Fixed<Pinned<C>>>::RECORD.words() == 1, "a colour of 30 bits at most") }
        Ok(Self { map: Galpixmap::new(grid, Static::new(), memory)?, left: 0, top: 0 })
    }

    /// The same with its corner at column `left`, row `top` of the display. What lies beyond the display is not seen.
    #[must_use]
    pub fn at(self, left: u32, top: u32) -> Self {
        Self { left, top, ..self }
    }

    /// Columns.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.map.grid().display_width()
    }

    /// Rows.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.map.grid().display_height()
    }

    /// Pins a colour (8-bit red, green, blue) to column `x`, row `y` of the overlay; whether there is such a cell.
    pub fn pin(&mut self, x: u32, y: u32, rgb: [u8; 3]) -> bool {
        self.write(x, y, Class::Galpixel, C::from_rgb888(rgb))
    }

    /// Removes what is pinned to column `x`, row `y` of the overlay, so that the map is seen there; whether there is such a
    /// cell.
    pub fn unpin(&mut self, x: u32, y: u32) -> bool {
        self.write(x, y, Class::Empty, 0)
    }

    /// Removes everything.
    pub fn clear(&mut self) {
        self.map.clear();
    }

    /// The colour word that is pinned to column `x`, row `y` of the overlay.
    #[must_use]
    pub fn pinned(&self, x: u32, y: u32) -> Option<u32> {
        shown::<C>(*self.row(y).get(x as usize)?)
    }

    fn write(&mut self, x: u32, y: u32, class: Class, colour: u32) -> bool {
        if x >= self.width() || y >= self.height() {
            return false;
        }
        let wings = self.map.grid().wings();
        let Some(cell) = self.map.grid().cell((x + wings.left) as i32, (y + wings.top) as i32) else { return false };
        let (words, _) = self.map.stored(&Galpixel { class, ..Galpixel::default() });
        let words = self.map.recoloured(words, colour);
        self.map.put(cell, &words);
        true
    }

    /// The words of row `y` of the overlay; nothing below it.
    #[inline(always)]
    fn row(&self, y: u32) -> &[u32] {
        let grid = self.map.grid();
        if y >= grid.display_height() {
            return &[];
        }
        let start = grid.row((y + grid.wings().top) as i32).unwrap_or(0) as usize + grid.wings().left as usize;
        let [plane, ..] = self.map.planes();
        plane.get(start..start + grid.display_width() as usize).unwrap_or_default()
    }
}

/// The colour of an overlay's word, if something is pinned there.
#[inline(always)]
fn shown<C: Colour>(word: u32) -> Option<u32> {
    let record = <Static<Motionless> as Budget<Pinned<C>>>::record(const { &Static::new() });
    let class = record.class().extract().unsigned(word, word);
    if class == Class::Empty as u32 { None } else { Some(record.colour().extract().unsigned(word, word)) }
}

/// The colour words of row `y` of the display under an overlay, from left to right; nothing below the display.
pub fn row<'m, L: Layout, B: Budget<L>>(
    map: &'m Galpixmap<'_, L, B>,
    overlay: &'m Overlay<'_, L::Colour>,
    y: u32,
) -> impl ExactSizeIterator<Item = u32> + 'm {
    overlay.span(map, y, 0, map.grid().display_width())
}

impl<L: Layout<Colour = C>, C: Colour> Over<L> for &Overlay<'_, C> {
    #[inline(always)]
    fn span<B: Budget<L>>(
        self,
        map: &Galpixmap<'_, L, B>,
        y: u32,
        x: u32,
        width: u32,
    ) -> impl ExactSizeIterator<Item = u32> {
        // Above and left of the overlay the difference wraps to a row or column that it does not have.
        let pinned = self.row(y.wrapping_sub(self.top));
        let first = x.wrapping_sub(self.left);
        scan_out::span(map, y, x, width).enumerate().map(move |(column, colour)| {
            let place = first.wrapping_add(column as u32) as usize;
            pinned.get(place).and_then(|&word| shown::<C>(word)).unwrap_or(colour)
        })
    }
}

#[cfg(feature = "embedded-graphics")]
mod panel {
    use embedded_graphics_core::Pixel;
    use embedded_graphics_core::draw_target::DrawTarget;
    use embedded_graphics_core::geometry::{OriginDimensions, Size};

    use super::Overlay;
    use crate::galpixel::Class;
    use crate::scan_out::PanelColour;

    impl<C: PanelColour> OriginDimensions for Overlay<'_, C> {
        fn size(&self) -> Size {
            Size::new(self.width(), self.height())
        }
    }

    /// What is drawn is pinned; what is drawn outside is left out.
    impl<C: PanelColour> DrawTarget for Overlay<'_, C> {
        type Color = C::Pixel;
        type Error = core::convert::Infallible;

        fn draw_iter<I: IntoIterator<Item = Pixel<C::Pixel>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
            for Pixel(point, pixel) in pixels {
                // A negative place is no column or row of any grid.
                self.write(point.x as u32, point.y as u32, Class::Galpixel, C::word(pixel));
            }
            Ok(())
        }
    }
}
