//! The mask of covered cells, one bit each, with a single line of memory: for machines that cannot hold a map of
//! extents.
//!
//! Makes the same two passes as [`super::map`]. The pass up marks the rows anew. Of the line before, a pass needs only
//! the extent that moves with it. The word of a cell holds that extent in the byte of the opposite direction, which has
//! no part in the pass.

use super::extents::{DOWNWARDS, EXTENTS, UPWARDS, blocked, extent, shortened};
use super::mark::Marker;
use super::{Reach, Tally, spread};
use crate::format::Format;
use crate::map::Galpixmap;

/// Writes the mask of the cells that [`map`](super::map()) covers: cell `c` in bit `c % 32` of word `c / 32`, as in the
/// edge map. Returns the counts, which are those of [`map`](super::map()).
///
/// `mask` must have [`stages::words`](crate::stages::words) words, and `line` one for each column; what they hold does
/// not matter. Cells beyond the end of `mask` are left out and not counted. With too short a `line` nothing is covered.
pub fn cover<F: Format>(front: &Galpixmap<'_, F>, line: &mut [u32], mask: &mut [u32], reach: &Reach) -> Tally {
    F::disocclusion_cover(front, line, mask, reach)
}

pub(crate) fn make_cover<F: Format>(
    front: &Galpixmap<'_, F>,
    line: &mut [u32],
    mask: &mut [u32],
    reach: &Reach,
) -> Tally {
    mask.fill(0);
    let Some(line) = line.get_mut(..front.grid().width() as usize) else { return Tally::default() };
    let rows = front.grid().height();
    let mut down = Pass { marker: Marker::new(front, reach), line, mask, covered: 0 };
    down.line.fill(0);
    for y in 0..rows {
        down.row::<DOWNWARDS, UPWARDS>(y);
    }
    let tally = down.marker.tally;
    let mut up = Pass { marker: Marker::new(front, reach), ..down };
    up.line.fill(0);
    for y in (0..rows).rev() {
        up.row::<UPWARDS, DOWNWARDS>(y);
    }
    let tally = Tally { covered: up.covered, ..tally };
    #[cfg(feature = "check")]
    if up.mask.len() >= crate::frame::edge::words(front.grid()) {
        super::check::cover(front, up.mask, &tally, reach);
    }
    tally
}

/// A pass over all rows.
struct Pass<'m, 'p, F> {
    marker: Marker<'m, 'p, F>,
    line: &'m mut [u32],
    mask: &'m mut [u32],
    covered: u32,
}

impl<F: Format> Pass<'_, '_, F> {
    /// Handles the next row of a pass in `DIRECTION`. The byte `OPPOSITE` of each word holds what the line before
    /// propagates.
    fn row<const DIRECTION: u32, const OPPOSITE: u32>(&mut self, y: u32) {
        let Some(start) = self.marker.begin::<DIRECTION>(y, self.line) else { return };
        self.marker.rows::<true>(y, self.line, &mut []);
        if let Some(above) = y.checked_sub(1) {
            // The pairs between the two rows are counted with row `above`.
            let tally = self.marker.tally;
            self.marker.rows::<false>(above, &mut [], self.line);
            self.marker.tally = tally;
        }
        spread::along(self.line, !(0xff << OPPOSITE));
        for (word, cell) in self.line.iter_mut().zip(start..) {
            let own = extent::<DIRECTION>(*word);
            let received = if *word & blocked::<DIRECTION>() == 0 { extent::<OPPOSITE>(*word) } else { 0 };
            let others = EXTENTS & !(0x7f << DIRECTION | 0x7f << OPPOSITE);
            let covered = u32::from(*word & others | own | received != 0);
            if let Some(mask) = self.mask.get_mut((cell >> 5) as usize) {
                self.covered += covered & !(*mask >> (cell & 31));
                *mask |= covered << (cell & 31);
            }
            *word = shortened::<OPPOSITE>(own.max(received) << OPPOSITE);
        }
    }
}
