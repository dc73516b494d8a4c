//! The edge map for processors without vector registers, where each key costs instructions: skips runs of equal depth.

use crate::format::Format;
use crate::format::record::MAX_WORDS;
use crate::frame::reference::edge::{WORD, clamped, mark_run};
use crate::map::Galpixmap;

/// Cells of a run that are compared before the whole run is.
const PROBE: u32 = 4;

/// Marks the cells of a map that are on an edge, see [`crate::frame::edge::mark`].
///
/// Goes down the rows strip by strip, each [`WORD`] cells wide, so that each row of a strip is compared only once.
pub(crate) fn mark<F: Format>(front: &Galpixmap<'_, F>, threshold: u32, edges: &mut [u32]) -> u32 {
    edges.fill(0);
    let grid = *front.grid();
    let threshold = clamped(threshold);
    let (mut count, mut x) = (0, 0);
    while x < grid.width() {
        let cells = (grid.width() - x).min(WORD);
        let mut rows = grid.starts().iter().map(|&row| Strip::of(front, row, (x, cells)));
        // Beyond the map the row is its own neighbour.
        let (mut up, mut row) = (None, rows.next());
        while let Some(strip) = row {
            let down = rows.next();
            let [above, below] = [up.unwrap_or(strip), down.unwrap_or(strip)];
            if !strip.is_inside([above, below], front, (x, cells)) {
                count += mark_run(front, [strip.row, above.row, below.row], (x, cells), threshold, edges);
            }
            (up, row) = (row, down);
        }
        x += cells;
    }
    count
}

/// A row of a strip.
#[derive(Clone, Copy)]
struct Strip {
    /// The first cell of the whole row.
    row: u32,
    /// The key of all cells of the row that are in the strip, if they are galpixels of equal depth.
    key: Option<u32>,
}

impl Strip {
    /// Compares the `cells` cells from column `x` on of a row.
    #[inline(always)]
    fn of<F: Format>(front: &Galpixmap<'_, F>, row: u32, (x, cells): (u32, u32)) -> Self {
        let start = row + x;
        let key = front.key_at(start).filter(|&key| front.class_of(key) == 0);
        let uniform = key.is_some() && is_uniform(front, start, cells.min(PROBE)) && is_uniform(front, start, cells);
        Self { row, key: key.filter(|_| uniform) }
    }

    /// Returns whether all cells and all their neighbours are galpixels of equal depth.
    #[inline(always)]
    fn is_inside<F: Format>(self, [up, down]: [Self; 2], front: &Galpixmap<'_, F>, (x, cells): (u32, u32)) -> bool {
        let (start, end) = (self.row + x, self.row + x + cells);
        self.key.is_some()
            && up.key == self.key
            && down.key == self.key
            && (x == 0 || front.key_at(start - 1) == self.key)
            && (x + cells == front.grid().width() || front.key_at(end) == self.key)
    }
}

/// Returns whether `cells` cells have equal keys.
#[inline(never)]
fn is_uniform<F: Format>(front: &Galpixmap<'_, F>, start: u32, cells: u32) -> bool {
    let record = *front.record();
    let mut ones = [0; MAX_WORDS];
    record.class().set(&mut ones, u32::MAX);
    record.depth().set(&mut ones, u32::MAX);
    let mut uniform = true;
    for (plane, ones) in front.planes().iter().zip(ones).take(record.words()) {
        if ones != 0 {
            let cells = plane.get(start as usize..(start + cells) as usize).unwrap_or_default();
            let first = cells.first().copied().unwrap_or_default();
            uniform &= cells.iter().fold(0, |differ, cell| differ | cell ^ first) & ones == 0;
        }
    }
    uniform
}
