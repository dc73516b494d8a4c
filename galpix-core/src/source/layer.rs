//! One layer: samples that stay in the cells where an update put them.

use super::gather::are_mixed;
use super::links::{self, Links};
use crate::error::SetupError;
use crate::format::Format;
use crate::format::record::Field;
use crate::format::rounding::Rounding;
use crate::frame::step::parts;
use crate::frame::tally::Tally;
use crate::layers::{Displacement, displacement, displacement_word};
use crate::map::Galpixmap;

/// The base-2 logarithm of the parts of a cell in which the places of a quad's corners count.
pub(crate) const CORNER_PARTS: u32 = 5;

/// The samples of an update, their displacements and their links, in caller-provided buffers.
#[derive(Debug)]
pub struct Source<'p, F> {
    pub(crate) map: Galpixmap<'p, F>,
    pub(crate) displacements: &'p mut [u32],
    pub(crate) links: &'p mut [u32],
}

impl<'p, F: Format> Source<'p, F> {
    /// Makes a source of the galpixels of `map`, which is written as any other map: in [`Self::map_mut`], also later.
    /// `displacements` has a word for each cell and `links` [`words`](links::words) words; what they hold does not
    /// matter. [`Self::begin`] must follow.
    ///
    /// *Errors:* a buffer that is too short.
    pub fn new(map: Galpixmap<'p, F>, displacements: &'p mut [u32], links: &'p mut [u32]) -> Result<Self, SetupError> {
        let short = |plane, need, have| SetupError::TooShort { plane, need, have };
        let (cells, need) = (map.grid().cells() as usize, links::words(map.grid()));
        let (have, have_links) = (displacements.len(), links.len());
        Ok(Self {
            displacements: displacements.get_mut(..cells).ok_or(short("plane of displacements", cells, have))?,
            links: links.get_mut(..need).ok_or(short("plane of links", need, have_links))?,
            map,
        })
    }

    /// Begins with the galpixels that the map holds: each lies where it is stored, and they are linked anew.
    ///
    /// `edge_threshold` is that of [`Settings`](crate::Settings): depths that differ by more are of two surfaces.
    pub fn begin(&mut self, edge_threshold: u32) {
        self.begin_at([0, 0], edge_threshold);
    }

    /// Begins as [`Self::begin`], with the first cell of the layer's grid at column and row `place` of the display's
    /// map. So a layer that shows one object needs no more cells than the object has. What lies beyond the map is not
    /// shown until it has moved there. Numbers beyond -32768 to 32767 are clamped.
    pub fn begin_at(&mut self, place: Displacement, edge_threshold: u32) {
        self.displacements.fill(displacement_word(place));
        F::source_links(&self.map, edge_threshold, self.links);
        let mixed = are_mixed(self);
        if let Some(word) = self.links.last_mut() {
            *word = mixed.into();
        }
    }

    /// Returns whether colours beside a nearer surface are taken for mixtures of both.
    pub(crate) fn is_mixed(&self) -> bool {
        self.links.last().is_some_and(|&word| word != 0)
    }

    /// Steps all samples without showing them: a source that is not shown yet follows what it missed. `frame` is the
    /// frame counter, as [`Sources::frame`](super::Sources::frame) was when the frame was made. Of the counts, `moved`
    /// and `saturated` are set.
    ///
    /// *Cost:* less than half of a frame's step.
    pub fn step(&mut self, rounding: Rounding, frame: u32) -> Tally {
        F::source_step(self, rounding, frame)
    }

    /// Returns the samples.
    #[must_use]
    pub const fn map(&self) -> &Galpixmap<'p, F> {
        &self.map
    }

    /// Returns the samples, to write an update. [`Self::begin`] must follow.
    pub const fn map_mut(&mut self) -> &mut Galpixmap<'p, F> {
        &mut self.map
    }

    /// Returns the displacement of a sample in whole cells; what is less than a cell is its offset. `[0, 0]` outside of
    /// the map.
    #[must_use]
    pub fn displacement(&self, cell: u32) -> Displacement {
        displacement(self.displacements.get(cell as usize).copied().unwrap_or(0))
    }

    /// Returns displacements, a word for each cell, see [`displacement_word`](crate::layers::displacement_word), to
    /// write those of an update whose samples do not lie where they are stored.
    pub const fn displacements_mut(&mut self) -> &mut [u32] {
        self.displacements
    }

    /// Returns the links of a sample: two bits for the pair with its right neighbour, and above them two for the pair
    /// with the lower one. Both bits of a pair are set if the two are linked; the lower one alone if the first of them,
    /// which is left or above, ends in front of the other; the upper one alone if the second does. 0 outside of the
    /// map.
    #[must_use]
    pub fn link(&self, cell: u32) -> u32 {
        self.links().of(cell)
    }

    pub(crate) fn links(&self) -> Links<'_> {
        let words = self.links.get(..links::pair_words(self.map.grid())).unwrap_or_default();
        Links { words, width: self.map.grid().width() }
    }

    /// Returns the place of a sample relative to the cell where it is stored, in parts of a cell.
    #[inline(always)]
    pub(crate) fn place(&self, cell: u32) -> [i32; 2] {
        let record = self.map.record();
        let [x, y] = self.displacement(cell);
        let part = |field: Field| parts::<CORNER_PARTS>(self.map.signed(field, cell), field.bits.into());
        [(x << CORNER_PARTS) + part(record.offset_x()), (y << CORNER_PARTS) + part(record.offset_y())]
    }
}

/// Returns the word of a displacement, and how many of its two numbers were clamped.
#[inline(always)]
pub(crate) fn moved([dx, dy]: Displacement) -> (u32, u32) {
    let word = displacement_word([dx, dy]);
    let [x, y] = displacement(word);
    (word, u32::from(x != dx) + u32::from(y != dy))
}
