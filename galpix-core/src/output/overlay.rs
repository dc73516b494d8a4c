//! A pinned overlay: cells without motion that have priority over everything, as in a head-up display.
//!
//! An overlay is a surface of its own, not a part of a map: propagation, resolution, edges and fills ignore it, so that
//! it cannot smear, and what it covers is not lost. It is applied in scan-out: [`row`] returns the overlay's colour
//! where something is pinned and the map's colour elsewhere.
//!
//! An overlay may be smaller than the display (a status bar, a cross-hair) and at any place of it. It needs a word of
//! memory for each of its own cells. With the feature `embedded-graphics` it is a `DrawTarget`: text, lines and
//! pictures are drawn into it once and stay until they are removed.

use crate::error::SetupError;
use crate::format::Format;
use crate::format::colour::Colour;
use crate::map::Galpixmap;
use crate::map::grid::Grid;
use crate::output::scan_out::{self, Over};

/// Bits of a word that hold a pinned colour, at the top of these bits. The two bits above mark cells without one.
const COLOUR_BITS: u32 = 30;

/// The word of a cell at which nothing is pinned.
const UNPINNED: u32 = 3 << COLOUR_BITS;

/// Colours that are pinned to the display, a word for each cell in a caller-provided buffer.
#[derive(Debug)]
pub struct Overlay<'p> {
    grid: Grid<'p>,
    words: &'p mut [u32],
    colour: Colour,
    left: u32,
    top: u32,
}

impl<'p> Overlay<'p> {
    /// Returns the words of the buffer that an overlay over `grid` needs: one for each cell.
    #[must_use]
    pub const fn words(grid: &Grid<'_>) -> usize {
        grid.cells() as usize
    }

    /// Makes an overlay of the size of a grid's display in the top left corner of the picture, with nothing pinned.
    /// `colour` is the colour format of the maps that it is shown over. The margin of the grid, if it has any, is never
    /// shown.
    ///
    /// *Errors:* memory shorter than [`Self::words`].
    pub fn new(grid: Grid<'p>, colour: Colour, memory: &'p mut [u32]) -> Result<Self, SetupError> {
        let (need, have) = (Self::words(&grid), memory.len());
        let words = memory.get_mut(..need).ok_or(SetupError::TooShort { plane: "overlay", need, have })?;
        words.fill(UNPINNED);
        Ok(Self { grid, words, colour, left: 0, top: 0 })
    }

    /// Moves the top left corner to column `left`, row `top` of the display. Cells beyond the display are not shown.
    #[must_use]
    pub fn at(self, left: u32, top: u32) -> Self {
        Self { left, top, ..self }
    }

    /// Returns the columns.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.grid.display_width()
    }

    /// Returns the rows.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.grid.display_height()
    }

    /// Pins a colour (8-bit red, green, blue) to column `x`, row `y` of the overlay. Returns whether there is such a
    /// cell.
    pub fn pin(&mut self, x: u32, y: u32, rgb: [u8; 3]) -> bool {
        self.write(x, y, self.pinned_word(self.colour.from_rgb888(rgb)))
    }

    /// Removes what is pinned to column `x`, row `y` of the overlay, so that the map is shown there. Returns whether
    /// there is such a cell.
    pub fn unpin(&mut self, x: u32, y: u32) -> bool {
        self.write(x, y, UNPINNED)
    }

    /// Removes everything that is pinned.
    pub fn clear(&mut self) {
        self.words.fill(UNPINNED);
    }

    /// Returns the colour word that is pinned to column `x`, row `y` of the overlay, if there is one.
    #[must_use]
    pub fn pinned(&self, x: u32, y: u32) -> Option<u32> {
        self.shown(*self.row(y).get(x as usize)?)
    }

    /// Returns the overlay's word for a pinned colour word.
    #[inline(always)]
    const fn pinned_word(&self, colour: u32) -> u32 {
        colour << (COLOUR_BITS - self.colour.bits())
    }

    /// Writes a word of the overlay; returns whether there is such a cell.
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

    /// Returns the colour word that an overlay's word holds, if something is pinned there.
    #[inline(always)]
    const fn shown(&self, word: u32) -> Option<u32> {
        if word >= UNPINNED { None } else { Some(word >> (COLOUR_BITS - self.colour.bits())) }
    }

    /// Returns the words of row `y` of the overlay; none below it.
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

/// Returns the colour words of row `y` of the display under an overlay, from left to right; none below the display.
pub fn row<'m, F: Format>(
    map: &'m Galpixmap<'_, F>,
    overlay: &'m Overlay<'_>,
    y: u32,
) -> impl ExactSizeIterator<Item = u32> + 'm {
    overlay.over(scan_out::row(map, y), y, 0)
}

impl Over for &Overlay<'_> {
    #[inline(always)]
    fn over(self, colours: impl ExactSizeIterator<Item = u32>, y: u32, x: u32) -> impl ExactSizeIterator<Item = u32> {
        // Above and to the left of the overlay the difference wraps to a row or column that the overlay does not have.
        let pinned = self.row(y.wrapping_sub(self.top));
        let first = x.wrapping_sub(self.left);
        colours.enumerate().map(move |(column, colour)| {
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

    /// An overlay as a `DrawTarget` of pixels `C`. Pins what is drawn; ignores what is drawn outside of the overlay.
    #[derive(Debug)]
    pub struct Canvas<'o, 'p, C> {
        overlay: &'o mut Overlay<'p>,
        pixel: PhantomData<C>,
    }

    impl<'p> Overlay<'p> {
        /// Returns the overlay as a `DrawTarget`. Pixels of another colour format than the overlay's are converted by
        /// 8-bit red, green and blue.
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
                // Negative coordinates wrap to columns or rows that no grid has.
                self.overlay.write(point.x as u32, point.y as u32, word);
            }
            Ok(())
        }
    }
}
