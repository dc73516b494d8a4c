//! The edge map, cell by cell. Each cell of the row is read once.

use crate::format::Format;
use crate::format::record::Surface;
use crate::frame::edge::{laplacian, set};
use crate::map::Galpixmap;

/// Cells for each word of the edge map.
pub(crate) const WORD: u32 = 32;

/// The absolute Laplacian of four depths of 28 bits is never larger, and its sum with this number fits in a word.
const LARGEST: u32 = (1 << 30) - 1;

/// Returns the threshold clamped to [`LARGEST`], as [`mark_run`] takes it.
pub(crate) const fn clamped(threshold: u32) -> i32 {
    if threshold < LARGEST { threshold as i32 } else { LARGEST as i32 }
}

/// Marks the cells of a map that are on an edge, see [`crate::frame::edge::mark`].
pub(crate) fn mark<F: Format>(front: &Galpixmap<'_, F>, threshold: u32, edges: &mut [u32]) -> u32 {
    edges.fill(0);
    let (width, threshold) = (front.grid().width(), clamped(threshold));
    let mut count = 0;
    let mut rows = front.grid().starts().iter().copied().peekable();
    let mut above = None;
    while let Some(row) = rows.next() {
        // Beyond the map the row is its own neighbour.
        let (up, down) = (above.unwrap_or(row), rows.peek().copied().unwrap_or(row));
        let mut x = 0;
        while x < width {
            let cells = (width - x).min(WORD);
            count += mark_run(front, [row, up, down], (x, cells), threshold, edges);
            x += cells;
        }
        above = Some(row);
    }
    count
}

/// Marks `cells` cells of a row from column `x` on, at most [`WORD`]; returns how many are on an edge.
///
/// `rows` are the first cells of the row, of the row above and of the row below.
#[inline(always)]
pub(crate) fn mark_run<F: Format>(
    front: &Galpixmap<'_, F>,
    rows: [u32; 3],
    (x, cells): (u32, u32),
    threshold: i32,
    edges: &mut [u32],
) -> u32 {
    let [first, up, down] = rows.map(|row| row + x);
    // In the first and the last column the cell is its own neighbour.
    let z0 = front.surface_at(first).unwrap_or_default();
    let left = if x == 0 { z0 } else { front.surface_at(first - 1).unwrap_or(z0) };
    let ends = x + cells == front.grid().width();
    let paired = cells - u32::from(ends);
    let neighbours = Neighbours { right: first + 1, up, down };
    let (mut flags, last) = neighbours.flags(front, paired, threshold, [left, z0]);
    if ends {
        flags = flags >> 1 | neighbours.skip(paired).flag_of_last(front, threshold, last);
    }
    flags >>= WORD - cells;
    set(edges, first, flags);
    ones(flags)
}

/// The neighbours of the first of some adjacent cells.
#[derive(Clone, Copy)]
struct Neighbours {
    right: u32,
    up: u32,
    down: u32,
}

impl Neighbours {
    /// Returns the neighbours of the cell that follows after `cells` cells.
    const fn skip(self, cells: u32) -> Self {
        Self { right: self.right + cells, up: self.up + cells, down: self.down + cells }
    }

    /// Returns the flags of `cells` cells, the last one in the highest bit. `left` and `z0` are the surfaces left of
    /// the first cell and of the first cell; returns these two of the cell that follows, too.
    #[inline(never)]
    fn flags<F: Format>(
        self,
        front: &Galpixmap<'_, F>,
        cells: u32,
        threshold: i32,
        [mut left, mut z0]: [u32; 2],
    ) -> (u32, [u32; 2]) {
        let (record, surface) = (front.record(), front.record().surface(F::FIXED));
        let count = cells as usize;
        // The words with class, depth and the spilled bits of the depth, for each of the three neighbours.
        let (class, (depth, spill)) = (record.class().words().0, record.depth().words());
        let cut = |word: usize, start: u32| front.planes()[word].get(start as usize..)?.get(..count);
        let rows = |start: u32| Some([cut(class, start)?, cut(depth, start)?, cut(spill, start)?]);
        let (Some(rights), Some(ups), Some(downs)) = (rows(self.right), rows(self.up), rows(self.down)) else {
            return (0, [left, z0]);
        };
        let mut flags = 0;
        let mut lane = 0;
        while lane < count {
            let right = at(surface, &rights, lane);
            let (up, down) = (at(surface, &ups, lane), at(surface, &downs, lane));
            flags = flags >> 1 | flag(front, threshold, z0, [left, right, up, down]);
            (left, z0) = (z0, right);
            lane += 1;
        }
        (flags, [left, z0])
    }

    /// Returns the flag of the last cell of a row, which has no neighbour to the right.
    fn flag_of_last<F: Format>(self, front: &Galpixmap<'_, F>, threshold: i32, [left, z0]: [u32; 2]) -> u32 {
        let (up, down) = (front.surface_at(self.up).unwrap_or(z0), front.surface_at(self.down).unwrap_or(z0));
        flag(front, threshold, z0, [left, z0, up, down])
    }
}

/// Returns the surface of a lane, from the words with its class, its depth and the spilled bits of its depth.
#[inline(always)]
fn at(surface: Surface, [class, depth, spill]: &[&[u32]; 3], lane: usize) -> u32 {
    surface.of(class[lane], depth[lane], spill[lane])
}

/// Returns the highest bit if a cell is on an edge, else 0. Uses signs of numbers, so that no comparison has to become
/// a bit.
#[inline(always)]
fn flag<F: Format>(front: &Galpixmap<'_, F>, threshold: i32, z0: u32, others: [u32; 4]) -> u32 {
    let [left, right, up, down] = others;
    let source = laplacian(z0 as i32, left as i32, right as i32, up as i32, down as i32);
    let (below, above) = (threshold.wrapping_add(source), threshold.wrapping_sub(source));
    // The bit of an empty cell is above the depth.
    let deepest = (1 << front.record().depth().bits) - 1;
    let empty = deepest - (z0 | left | right | up | down) as i32;
    (below | above | empty) as u32 & 1 << (WORD - 1)
}

/// Returns how many bits are set. Not by `count_ones`, which LLVM lowers to a multiplication where there is no such
/// instruction.
pub(crate) const fn ones(bits: u32) -> u32 {
    let pairs = bits - (bits >> 1 & 0x5555_5555);
    let fours = (pairs & 0x3333_3333) + (pairs >> 2 & 0x3333_3333);
    let eights = (fours + (fours >> 4)) & 0x0f0f_0f0f;
    let sixteens = eights + (eights >> 8);
    (sixteens + (sixteens >> 16)) & 63
}
