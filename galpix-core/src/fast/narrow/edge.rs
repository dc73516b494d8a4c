//! The edge map for processors without vector registers, where each cell costs instructions: skips runs of equal depth.

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
    /// The surface of all cells of the row that are in the strip, if they have equal depths and none is empty.
    surface: Option<u32>,
}

impl Strip {
    /// Compares the `cells` cells from column `x` on of a row.
    #[inline(always)]
    fn of<F: Format>(front: &Galpixmap<'_, F>, row: u32, (x, cells): (u32, u32)) -> Self {
        let start = row + x;
        let empty = 1 << front.record().depth().bits;
        let surface = front.surface_at(start).filter(|surface| surface & empty == 0);
        let uniform =
            surface.is_some() && is_uniform(front, start, cells.min(PROBE)) && is_uniform(front, start, cells);
        Self { row, surface: surface.filter(|_| uniform) }
    }

    /// Returns whether all cells and all their neighbours have equal depths and none is empty.
    #[inline(always)]
    fn is_inside<F: Format>(self, [up, down]: [Self; 2], front: &Galpixmap<'_, F>, (x, cells): (u32, u32)) -> bool {
        let (start, end) = (self.row + x, self.row + x + cells);
        self.surface.is_some()
            && up.surface == self.surface
            && down.surface == self.surface
            && (x == 0 || front.surface_at(start - 1) == self.surface)
            && (x + cells == front.grid().width() || front.surface_at(end) == self.surface)
    }
}

/// Returns whether `cells` cells, of which the first is not empty, have equal depths and none is empty.
#[inline(never)]
fn is_uniform<F: Format>(front: &Galpixmap<'_, F>, start: u32, cells: u32) -> bool {
    let record = *front.record();
    let (mut classes, mut depths) = ([0; MAX_WORDS], [0; MAX_WORDS]);
    record.class().set(&mut classes, u32::MAX);
    record.depth().set(&mut depths, u32::MAX);
    let (mut equal, mut of_one_class) = (true, true);
    for ((plane, class), depth) in front.planes().iter().zip(classes).zip(depths).take(record.words()) {
        if class | depth != 0 {
            let cells = plane.get(start as usize..(start + cells) as usize).unwrap_or_default();
            let first = cells.first().copied().unwrap_or_default();
            let differ = cells.iter().fold(0, |differ, cell| differ | cell ^ first);
            equal &= differ & depth == 0;
            of_one_class &= differ & class == 0;
        }
    }
    equal && (of_one_class || !front.any_empty(start, cells))
}
