//! Which cells are covered, one bit each, with a single line of memory: for machines that cannot hold a map of extents.
//!
//! What [`super::map`] does in one pass down and one pass up, where on the way up the rows are marked anew. Of the line before only one
//! extent matters, the one that moves with the pass; so that the word of a cell holds it in the place of the opposite one.

use super::extents::{DOWNWARDS, EXTENTS, UPWARDS, extent, shorter, shut};
use super::mark::Marker;
use super::{Reach, Tally, spread};
use crate::format::Format;
use crate::map::Galpixmap;

/// The mask of the cells that [`super::map`] covers: cell `c` in bit `c % 32` of word `c / 32`, as in the edge map.
///
/// `mask` must have [`crate::frame::edge::words`] words, and `line` one for each column; what they held does not matter. Cells that are in
/// none of them are not covered.
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
    /// The next row of a pass on the way `WAY`: what the line before hands on is in the place of the extent `AGAINST` it.
    fn row<const WAY: u32, const AGAINST: u32>(&mut self, y: u32) {
        let Some(start) = self.marker.begin::<WAY>(y, self.line) else { return };
        self.marker.rows::<true>(y, self.line, &mut []);
        if let Some(above) = y.checked_sub(1) {
            let tally = self.marker.tally;
            self.marker.rows::<false>(above, &mut [], self.line);
            self.marker.tally = tally;
        }
        spread::along(self.line, !(0xff << AGAINST));
        for (word, cell) in self.line.iter_mut().zip(start..) {
            let own = extent::<WAY>(*word);
            let handed = if *word & shut::<WAY>() == 0 { extent::<AGAINST>(*word) } else { 0 };
            let others = EXTENTS & !(0x7f << WAY | 0x7f << AGAINST);
            let covered = u32::from(*word & others | own | handed != 0);
            if let Some(mask) = self.mask.get_mut((cell >> 5) as usize) {
                self.covered += covered & !(*mask >> (cell & 31));
                *mask |= covered << (cell & 31);
            }
            *word = shorter::<AGAINST>(own.max(handed) << AGAINST);
        }
    }
}
