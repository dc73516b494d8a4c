//! The edge map where each key costs an instruction: runs of one depth are looked for, and left out.
//!
//! Gain over [`reference::edge`] on the Cortex-M0, M3 and M4: see the rows `edge` of `firmware/cost.csv`.

use crate::format::Format;
use crate::format::record::MAX_WORDS;
use crate::frame::reference::edge::{WORD, limited, mark_run};
use crate::map::Galpixmap;

/// Cells of a run that are looked at before all of it is.
const GLANCE: u32 = 4;

/// Marks the edges of a map, see [`crate::frame::edge::mark`].
///
/// Strip by strip of a word's width, down the rows: so each row of a strip is looked at once for being of one depth.
pub(crate) fn mark<F: Format>(front: &Galpixmap<'_, F>, threshold: u32, edges: &mut [u32]) -> u32 {
    edges.fill(0);
    let grid = *front.grid();
    let threshold = limited(threshold);
    let (mut count, mut x) = (0, 0);
    while x < grid.width() {
        let cells = (grid.width() - x).min(WORD);
        let mut rows = grid.starts().iter().map(|&row| Strip::of(front, row, (x, cells)));
        // What lies beyond the map is like the row itself.
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
    /// The key of all its cells, if they are galpixels and have the same one.
    key: Option<u32>,
}

impl Strip {
    #[inline(always)]
    fn of<F: Format>(front: &Galpixmap<'_, F>, row: u32, (x, cells): (u32, u32)) -> Self {
        let start = row + x;
        let key = front.key_at(start).filter(|&key| front.class_of(key) == 0);
        let even = key.is_some() && is_even(front, start, cells.min(GLANCE)) && is_even(front, start, cells);
        Self { row, key: key.filter(|_| even) }
    }

    /// Returns whether all cells and all their neighbours are galpixels of one depth.
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

/// Whether `cells` cells all have the key of the first one.
#[inline(never)]
fn is_even<F: Format>(front: &Galpixmap<'_, F>, start: u32, cells: u32) -> bool {
    let record = *front.record();
    let mut ones = [0; MAX_WORDS];
    record.class().set(&mut ones, u32::MAX);
    record.depth().set(&mut ones, u32::MAX);
    let mut even = true;
    for (plane, ones) in front.planes().iter().zip(ones).take(record.words()) {
        if ones != 0 {
            let cells = plane.get(start as usize..(start + cells) as usize).unwrap_or_default();
            let first = cells.first().copied().unwrap_or_default();
            even &= cells.iter().fold(0, |differ, cell| differ | cell ^ first) & ones == 0;
        }
    }
    even
}
