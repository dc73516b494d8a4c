//! Spreading in steps of 1, 2, 4, ... cells, as Algorithm 2 of the supplement has it: for machines that work on all
//! cells at once.
//!
//! Each of the four scans of [`galpix_core::disocclusion::spread()`] in two rounds of steps. The extent that moves is
//! as simple as printed: the largest of its own and of those `m` cells before it, shorter by `m`. The others are
//! carried as far as an unbroken chain of cells hands them on. What breaks a chain, a cell that is blocked and for the
//! others one that does not reach the next, is kept in `linked`: cell by cell at first, then of twice as many cells if
//! it held for both halves. Every step reads all cells as they were before it.

use galpix_core::Grid;
use galpix_core::disocclusion::Extents;

/// The bits of a word that are extents. Those between mark a cell as blocked in a direction.
pub const EXTENTS: u32 = 0x7f7f_7f7f;

/// The direction of a scan: the lowest bit of the extent that moves with it. That of the opposite direction differs in
/// bit 3.
const TO_THE_LEFT: u32 = 0;
const TO_THE_RIGHT: u32 = 8;
const UPWARDS: u32 = 16;
const DOWNWARDS: u32 = 24;

/// Returns the first one with the larger of each of four extents.
fn larger(one: u32, other: u32) -> u32 {
    let extents = std::array::from_fn(|at| {
        let [one, other] = [one, other].map(|word| word.to_le_bytes()[at]);
        one & 0x80 | (one & 0x7f).max(other & 0x7f)
    });
    u32::from_le_bytes(extents)
}

/// A scan: the extent that moves, and the step of one cell against its direction.
#[derive(Clone, Copy)]
struct Scan {
    direction: u32,
    back: [i32; 2],
}

const SCANS: [Scan; 4] = [
    Scan { direction: TO_THE_RIGHT, back: [-1, 0] },
    Scan { direction: TO_THE_LEFT, back: [1, 0] },
    Scan { direction: DOWNWARDS, back: [0, -1] },
    Scan { direction: UPWARDS, back: [0, 1] },
];

const NO_END: u32 = Extents::NO_END as u32;

/// Bits of `linked`: as it is, and as it becomes.
const IS: u32 = 0;
const BECOMES: u32 = 1;

/// As [`galpix_core::disocclusion::spread()`], bit by bit, in steps whose number grows with the logarithm of the sides.
///
/// `extents` must have a word for each cell, and `spare` two; else nothing is done.
pub fn spread_by_doubling(extents: &mut [u32], spare: &mut [u32], grid: &Grid<'_>) -> u32 {
    let cells = grid.cells() as usize;
    let Some(extents) = extents.get_mut(..cells) else { return 0 };
    let Some((next, linked)) = spare.split_at_mut_checked(cells) else { return 0 };
    let Some(linked) = linked.get_mut(..cells) else { return 0 };
    for scan in SCANS {
        let sides = [grid.width(), grid.height()];
        let side = if scan.back[0] != 0 { sides[0] } else { sides[1] };
        let levels = 32 - side.leading_zeros();
        link(extents, linked, grid, scan, |_| true);
        for level in 0..levels {
            step([extents, next], grid, scan, 1 << level, |own, before, cell| {
                let extent = before >> scan.direction & NO_END;
                let moved = if extent == NO_END { extent } else { extent.saturating_sub(1 << level) };
                if at(linked, cell) >> IS & 1 != 0 { larger(own, moved << scan.direction) } else { own }
            });
            double(linked, grid, scan, 1 << level);
        }
        link(extents, linked, grid, scan, |before| before >> scan.direction & NO_END >= 2);
        for level in 0..levels {
            // The first step leaves nothing but one cell behind a cell that it reaches.
            let carried = EXTENTS & !(0xff << scan.direction | 0xff << (scan.direction ^ 8));
            let behind = if level == 0 { 1 << (scan.direction ^ 8) } else { 0 };
            step([extents, next], grid, scan, 1 << level, |own, before, cell| {
                if at(linked, cell) >> IS & 1 != 0 { larger(own, before & carried | behind) } else { own }
            });
            double(linked, grid, scan, 1 << level);
        }
    }
    for word in &mut *extents {
        *word &= EXTENTS;
    }
    extents.iter().map(|&word| u32::from(word != 0)).sum()
}

/// Returns the first cell of the row, the column and the row of each cell.
fn places(grid: &Grid<'_>) -> impl Iterator<Item = (u32, u32, u32)> {
    (0..grid.height()).flat_map(move |y| (0..grid.width()).map(move |x| (grid.row(y as i32).unwrap_or(0), x, y)))
}

fn at(words: &[u32], cell: u32) -> u32 {
    words.get(cell as usize).copied().unwrap_or(0)
}

/// Returns the cell `by` cells back on a scan.
fn back(grid: &Grid<'_>, scan: Scan, x: u32, y: u32, by: i32) -> Option<u32> {
    let [dx, dy] = scan.back;
    grid.cell(x as i32 + dx * by, y as i32 + dy * by)
}

/// Each cell that has one `by` cells back becomes `new(itself, that one, its number)`.
fn step([extents, next]: [&mut [u32]; 2], grid: &Grid<'_>, scan: Scan, by: i32, new: impl Fn(u32, u32, u32) -> u32) {
    for (start, x, y) in places(grid) {
        let cell = start + x;
        let own = at(extents, cell);
        if let Some(to) = next.get_mut(cell as usize) {
            *to = back(grid, scan, x, y, by).map_or(own, |before| new(own, at(extents, before), cell));
        }
    }
    for (to, &from) in extents.iter_mut().zip(&*next) {
        *to = from;
    }
}

/// Returns which cells are open to the one before them, and that one `reaches` them.
fn link(extents: &[u32], linked: &mut [u32], grid: &Grid<'_>, scan: Scan, reaches: impl Fn(u32) -> bool) {
    for (start, x, y) in places(grid) {
        let open = at(extents, start + x) & 0x80 << scan.direction == 0;
        let hands_on = open && back(grid, scan, x, y, 1).is_some_and(|before| reaches(at(extents, before)));
        if let Some(to) = linked.get_mut((start + x) as usize) {
            *to = u32::from(hands_on) << IS;
        }
    }
}

/// Which cells are at the end of a chain of `2 by` links, from those of `by`.
fn double(linked: &mut [u32], grid: &Grid<'_>, scan: Scan, by: i32) {
    for (start, x, y) in places(grid) {
        let before = back(grid, scan, x, y, by).map_or(0, |before| at(linked, before));
        if let Some(to) = linked.get_mut((start + x) as usize) {
            *to |= (*to & before) >> IS << BECOMES & 1 << BECOMES;
        }
    }
    for links in linked {
        *links = *links >> BECOMES << IS;
    }
}
