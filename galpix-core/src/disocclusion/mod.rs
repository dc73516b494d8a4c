//! The disocclusion map: which hidden samples an update needs.
//!
//! Where a near surface leaves a far one, it uncovers what was hidden behind it. Before an update is shown, the map
//! says of each of its cells whether that can happen within the frames until the next update, and how far what is
//! uncovered extends from the cell. The hidden samples of all other cells need not be carried. After Algorithms 1 and 2
//! of the supplement to the paper on depth layers; `docs/notes/disocclusion.md` says how they were read, and proves the
//! guarantee below.
//!
//! 1. [`mark()`] resolves each pair of neighbours: where one gets away from the other, the nearer one leaves, and
//!    uncovers what is behind itself and behind the cells that it passes (Algorithm 1).
//! 2. [`spread()`] propagates this from cell to cell (Algorithm 2).
//!
//! [`map()`] does both in one pass down and one pass up. [`cover`] does the same with a single line of memory and keeps
//! one bit per cell.
//!
//! **Guarantee.** Two surfaces lie at least [`Reach::separation`] apart, and each moves as a whole. A sample that is
//! hidden behind the near one, moves like the far one, and is where no galpixel of the map is after any of the frames,
//! was hidden in a cell whose extents are not 0. This holds with every rounding, and with velocities that saturate.
//!
//! *Memory:* four bytes per cell. *Cost:* some vector operations per cell and some hundred operations for each pair
//! that these do not decide.

mod extents;
mod line;
mod mark;
mod pair;
mod reach;
mod spread;

pub use extents::Extents;
pub use line::cover;
pub(crate) use line::make_cover;
pub use spread::spread;

#[cfg(feature = "check")]
use crate::fast::check::due;
use crate::format::Format;
use crate::map::Galpixmap;
use mark::{Marker, NO_PASS};

/// What lies beyond the border of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Border {
    /// Something still and infinitely far away: a surface that leaves the border uncovers what is behind it.
    #[default]
    Still,
    /// What is at the border continues beyond it: nothing is uncovered from there.
    Continues,
}

/// The settings of a disocclusion map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reach {
    /// Frames until the next update, 0 to [`Self::MOST_FRAMES`]; more count as that.
    pub frames: u32,
    /// The difference of depths, in units of the depth's last bit, from which on two neighbours are of two surfaces and
    /// the farther one is behind the nearer. Values above 2^30 count as that.
    ///
    /// Neighbours that differ by less are of one surface, in which only tears count, on both sides. At 0 all neighbours
    /// are of two surfaces, and of two at the same depth each is behind the other.
    pub separation: u32,
    /// What lies beyond the border.
    pub border: Border,
    /// Whether tears count: neighbours of one surface that part by a whole cell or more.
    ///
    /// The map then uncovers what is behind a tear. But the true surface stretches where its galpixels part, and what
    /// is behind it is not seen. Without tears the guarantee holds for pairs of two surfaces alone, and tears are left
    /// to the fill modes.
    pub tears: bool,
    /// Whether what a surface uncovers propagates through to farther surfaces that it moves over, beyond its own end.
    ///
    /// More cells are covered then, also some that a chain of three surfaces uncovers. The guarantee, which is for two
    /// surfaces, does not need it.
    pub through: bool,
}

impl Reach {
    /// The most frames.
    pub const MOST_FRAMES: u32 = 255;

    /// Returns settings for depths of `depth_bits` bits that are linear in inverse distance or in disparity: the
    /// separation of [`threshold_for_depth`](crate::stages::threshold_for_depth) (0 without depths), a still border,
    /// tears, and surfaces that end.
    #[must_use]
    pub const fn new(frames: u32, depth_bits: u32) -> Self {
        let separation = if depth_bits == 0 { 0 } else { crate::frame::edge::threshold_for_depth(depth_bits) };
        Self { frames, separation, border: Border::Still, tears: true, through: false }
    }
}

/// Counts of a disocclusion map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tally {
    /// Pairs of neighbours, or of a cell and what lies beyond the border, of which one leaves the other.
    pub edges: u32,
    /// Those of them that uncover [`Extents::NO_END`] cells or more to a side.
    pub saturated: u32,
    /// Cells whose hidden samples may be uncovered; 0 before they are spread.
    pub covered: u32,
}

/// Marks the cells that leave a neighbour. The counts have no covered cells yet.
///
/// `extents` must have a word for each cell (see [`Extents`]); what it holds does not matter. Rows that it holds only
/// in part are not marked.
pub fn mark<F: Format>(front: &Galpixmap<'_, F>, extents: &mut [u32], reach: &Reach) -> Tally {
    F::disocclusion_mark(front, extents, reach)
}

pub(crate) fn mark_pairs<F: Format>(front: &Galpixmap<'_, F>, extents: &mut [u32], reach: &Reach) -> Tally {
    let mut marker = Marker::new(front, reach);
    for (&start, y) in front.grid().starts().iter().zip(0..) {
        mark_row(&mut marker, y, start, extents);
    }
    marker.tally
}

/// Completes row `y`, which begins at cell `start`, and begins the next one.
#[inline(always)]
fn mark_row<F: Format>(marker: &mut Marker<'_, '_, F>, y: u32, start: u32, extents: &mut [u32]) {
    let width = marker.width() as usize;
    let Some(rest) = extents.get_mut(start as usize..) else { return };
    let Some((here, rest)) = rest.split_at_mut_checked(width) else { return };
    let next = rest.get_mut(..width).unwrap_or_default();
    if y == 0 {
        marker.begin::<NO_PASS>(y, here);
    }
    marker.clear::<NO_PASS>(next);
    marker.rows::<true>(y, here, next);
}

/// Marks and spreads a disocclusion map: [`mark()`] and [`spread()`] together, row by row. `extents` as in [`mark()`].
pub fn map<F: Format>(front: &Galpixmap<'_, F>, extents: &mut [u32], reach: &Reach) -> Tally {
    F::disocclusion_map(front, extents, reach)
}

pub(crate) fn make<F: Format>(front: &Galpixmap<'_, F>, extents: &mut [u32], reach: &Reach) -> Tally {
    #[cfg(feature = "check")]
    let expected = due(front.grid().cells()).then(|| check::expected(front, extents.to_vec(), reach));
    let tally = make_by_rows(front, extents, reach);
    #[cfg(feature = "check")]
    assert!(expected.is_none_or(|made| made == (extents.to_vec(), tally)), "the disocclusion map by rows: {reach:?}");
    tally
}

/// Marks and spreads row by row, while a row is in the cache.
fn make_by_rows<F: Format>(front: &Galpixmap<'_, F>, extents: &mut [u32], reach: &Reach) -> Tally {
    let grid = *front.grid();
    let mut marker = Marker::new(front, reach);
    for (&start, y) in grid.starts().iter().zip(0..) {
        mark_row(&mut marker, y, start, extents);
        spread::down(extents, start, grid.width());
    }
    Tally { covered: spread::up(extents, &grid), ..marker.tally }
}

/// Returns whether what is hidden in a cell may be uncovered; `false` beyond the end of `extents`.
#[inline(always)]
#[must_use]
pub fn covered(extents: &[u32], cell: u32) -> bool {
    extents.get(cell as usize).is_some_and(|&word| word != 0)
}

#[cfg(feature = "check")]
mod check {
    extern crate std;

    use std::vec;
    use std::vec::Vec;

    use super::{Reach, Tally, mark_pairs, spread};
    use crate::fast::check::due;
    use crate::format::Format;
    use crate::map::Galpixmap;

    /// Returns what the reference leaves in `extents`: all cells marked, then spread.
    pub(super) fn expected<F: Format>(
        front: &Galpixmap<'_, F>,
        mut extents: Vec<u32>,
        reach: &Reach,
    ) -> (Vec<u32>, Tally) {
        let marked = mark_pairs(front, &mut extents, reach);
        let covered = spread(&mut extents, front.grid());
        (extents, Tally { covered, ..marked })
    }

    /// Asserts that a mask holds the cells that the map of extents covers.
    pub(super) fn cover<F: Format>(front: &Galpixmap<'_, F>, mask: &[u32], tally: &Tally, reach: &Reach) {
        if !due(front.grid().cells()) {
            return;
        }
        let cells = front.grid().cells() as usize;
        let (extents, expected) = expected(front, vec![0; cells], reach);
        assert_eq!(*tally, expected, "the counts of the cells that are covered");
        let made = |cell: usize| mask[cell / 32] >> (cell % 32) & 1 != 0;
        assert!((0..cells).all(|cell| made(cell) == (extents[cell] != 0)), "the cells that are covered");
    }
}
