//! A pinned overlay: cells without motion and with priority over everything, as a head-up display has them.
//!
//! An overlay is a surface of its own, never a part of a map: propagation, resolution, edges and fills do not know it, so it
//! cannot smear, and nothing that it covers is lost. It takes part in scan-out alone: [`row`] shows an overlay's colour where
//! something is pinned and the map's elsewhere. Without an overlay [`crate::output::scan_out::row`] is what it was.
//!
//! It may be smaller than the display (a status bar, a cross-hair) and lie anywhere on it, so that an embedded controller
//! pays memory only for what it pins: a word a cell. With the feature `embedded-graphics` it is a `DrawTarget`: text, lines
//! and pictures are drawn into it once and stay until they are removed.

use crate::error::SetupError;
use crate::format::Format;
use crate::format::colour::Colour;
use crate::map::Galpixmap;
use crate::map::grid::Grid;
use crate::output::scan_out::{self, Over};

/// Bits of a word that hold a pinned colour, above what is left.
const COLOUR_BITS: u32 = 30;

/// The word of a cell where nothing is pinned: both bits above the colour are set, as in the class of an empty cell.
const UNPINNED: u32 = 3 << COLOUR_BITS;

/// A surface pinned to the display: a word a cell, in a caller-provided buffer.
#[derive(Debug)]
pub struct Overlay<'p> {
    grid: Grid<'p>,
    words: &'p mut [u32],
    colour: Colour,
    left: u32,
    top: u32,
}

impl<'p> Overlay<'p> {
    /// Returns the words of memory that an overlay over `grid` needs: one a cell.
    #[must_use]
    pub const fn words(grid: &Grid<'_>) -> usize {
        grid.cells() as usize
    }

    /// Lays an overlay of the size of a grid's display over `memory`, with nothing pinned, in the top left corner of the
    /// picture. `colour` is that of the maps that it is shown over. Margin, if the grid has any, are never seen.
    ///
    /// *Errors:* memory shorter than [`Self::words`].
    pub fn new(grid: Grid<'p>, colour: Colour, memory: &'p mut [u32]) -> Result<Self, SetupError> {
        let (need, have) = (Self::words(&grid), memory.len());
        let words = memory.get_mut(..need).ok_or(SetupError::TooShort { plane: "overlay", need, have })?;
        words.fill(UNPINNED);
        Ok(Self { grid, words, colour, left: 0, top: 0 })
    }

    /// The same with its corner at column `left`, row `top` of the display. What lies beyond the display is not seen.
    #[must_use]
    pub fn at(self, left: u32, top: u32) -> Self {
        Self { left, top, ..self }
    }

    /// Columns.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.grid.display_width()
    }

    /// Rows.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.grid.display_height()
    }

    /// Pins a colour (8-bit red, green, blue) to column `x`, row `y` of the overlay; whether there is such a cell.
    pub fn pin(&mut self, x: u32, y: u32, rgb: [u8; 3]) -> bool {
        self.write(x, y, self.pinned_word(self.colour.from_rgb888(rgb)))
    }

    /// Removes what is pinned to column `x`, row `y` of the overlay, so that the map is seen there; whether there is such a
    /// cell.
    pub fn unpin(&mut self, x: u32, y: u32) -> bool {
        self.write(x, y, UNPINNED)
    }

    /// Removes everything.
    pub fn clear(&mut self) {
        self.words.fill(UNPINNED);
    }

    /// The colour word that is pinned to column `x`, row `y` of the overlay.
    #[must_use]
    pub fn pinned(&self, x: u32, y: u32) -> Option<u32> {
        self.shown(*self.row(y).get(x as usize)?)
    }

    #[inline(always)]
    const fn pinned_word(&self, colour: u32) -> u32 {
        colour << (COLOUR_BITS - self.colour.bits())
    }

    fn write(&mut self, x: u32, y: u32, word: u32) -> bool {
        if x >= self.width() || y >= self.height() {
            return false;
        }
        let margin = self.grid.margin();
        let cell = self.grid.cell((x + margin.left) as i32, (y + margin.top) as i32);
        match cell.and_then(|cell| self.words.get_mut(cell as usize)) {
            Some(to) => *to = word,
            None => return false,
        }
        true
    }

    /// Returns the colour of an overlay's word, if something is pinned there.
    #[inline(always)]
    const fn shown(&self, word: u32) -> Option<u32> {
        if word >= UNPINNED { None } else { Some(word >> (COLOUR_BITS - self.colour.bits())) }
    }

    /// The words of row `y` of the overlay; nothing below it.
    #[inline(always)]
    fn row(&self, y: u32) -> &[u32] {
        let grid = &self.grid;
        if y >= grid.display_height() {
            return &[];
        }
        let start = grid.row((y + grid.margin().top) as i32).unwrap_or(0) as usize + grid.margin().left as usize;
        self.words.get(start..start + grid.display_width() as usize).unwrap_or_default()
    }
}

/// The colour words of row `y` of the display under an overlay, from left to right; nothing below the display.
pub fn row<'m, F: Format>(
    map: &'m Galpixmap<'_, F>,
    overlay: &'m Overlay<'_>,
    y: u32,
) -> impl ExactSizeIterator<Item = u32> + 'm {
    overlay.span(map, y, 0, map.grid().display_width())
}

impl Over for &Overlay<'_> {
    #[inline(always)]
    fn span<F: Format>(self, map: &Galpixmap<'_, F>, y: u32, x: u32, width: u32) -> impl ExactSizeIterator<Item = u32> {
        // Above and left of the overlay the difference wraps to a row or column that it does not have.
        let pinned = self.row(y.wrapping_sub(self.top));
        let first = x.wrapping_sub(self.left);
        scan_out::span(map, y, x, width).enumerate().map(move |(column, colour)| {
            let place = first.wrapping_add(column as u32) as usize;
            pinned.get(place).and_then(|&word| self.shown(word)).unwrap_or(colour)
        })
    }
}

#[cfg(feature = "embedded-graphics")]
pub use canvas::Canvas;

#[cfg(feature = "embedded-graphics")]
mod canvas {
    use core::marker::PhantomData;

    use embedded_graphics_core::Pixel;
    use embedded_graphics_core::draw_target::DrawTarget;
    use embedded_graphics_core::geometry::{OriginDimensions, Size};

    use super::Overlay;
    use crate::output::scan_out::PanelColour;

    /// An overlay as a `DrawTarget` of pixels `C`: what is drawn is pinned; what is drawn outside is left out.
    #[derive(Debug)]
    pub struct Canvas<'o, 'p, C> {
        overlay: &'o mut Overlay<'p>,
        pixel: PhantomData<C>,
    }

    impl<'p> Overlay<'p> {
        /// Returns the overlay as a `DrawTarget`. Pixels of another format than the overlay's are converted by 8-bit red,
        /// green and blue.
        pub const fn canvas<C: PanelColour>(&mut self) -> Canvas<'_, 'p, C> {
            Canvas { overlay: self, pixel: PhantomData }
        }
    }

    impl<C> OriginDimensions for Canvas<'_, '_, C> {
        fn size(&self) -> Size {
            Size::new(self.overlay.width(), self.overlay.height())
        }
    }

    impl<C: PanelColour> DrawTarget for Canvas<'_, '_, C> {
        type Color = C;
        type Error = core::convert::Infallible;

        fn draw_iter<I: IntoIterator<Item = Pixel<C>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
            for Pixel(point, pixel) in pixels {
                let word = self.overlay.pinned_word(pixel.word_in(&self.overlay.colour));
                // A negative place is no column or row of any grid.
                self.overlay.write(point.x as u32, point.y as u32, word);
            }
            Ok(())
        }
    }
}
