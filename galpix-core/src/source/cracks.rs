//! Cracks: cells inside of a surface that none of its samples is nearest to.
//!
//! Where a surface grows, a cell between two of its samples may stay empty, or show what is behind. It is closed if the
//! cells on opposite sides show samples that are of one surface, which links say, and that are nearer than what the
//! cell shows by more than the edge threshold. It then shows the sample that is nearer to it. First the cells left and
//! right are looked at and those above and below, then the diagonals.
//!
//! All cells are decided from what was shown before any was closed.

use super::layer::Source;
use super::links::Links;
use super::visibility::{Entry, PARTS, Visibility};
use crate::format::Format;
use crate::map::grid::Grid;

/// Samples that are farther from each other in x or y are not looked at as neighbours.
const SPAN: i32 = 2;

/// A cell in the parts in which residuals count.
const CELL: i32 = 1 << PARTS;

/// What closing cracks found and did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Closed {
    /// Cells that showed the sample that is nearest to them.
    pub points: u32,
    /// Empty cells that were closed.
    pub holes: u32,
    /// Cells that are still empty.
    pub empty: u32,
}

/// Decides row by row what takes the place of entries: `decide` postpones them and returns how many. They are shown
/// when the next row is decided, which the old ones have served as neighbours.
#[inline(always)]
pub(crate) fn each_row(
    grid: &Grid<'_>,
    visibility: &mut Visibility<'_>,
    mut decide: impl FnMut(&mut Visibility<'_>, usize, u32) -> usize,
) {
    let mut before = None;
    for (y, &start) in grid.starts().iter().enumerate() {
        let count = decide(visibility, y, start);
        if let Some((y, start, count)) = before.replace((y, start, count)) {
            visibility.settle(y, start, count);
        }
    }
    if let Some((y, start, count)) = before {
        visibility.settle(y, start, count);
    }
}

/// Returns what closes a cell; `None` if nothing does.
#[inline(always)]
pub(crate) fn best<F: Format>(
    sources: &[Source<'_, F>],
    visibility: &Visibility<'_>,
    [x, y]: [i32; 2],
    threshold: i32,
) -> Option<Entry> {
    let grid = visibility.grid();
    let at = |dx: i32, dy: i32| grid.cell(x + dx, y + dy).map_or(Entry::NONE, |cell| visibility.at(cell));
    let own = at(0, 0);
    // What closes the cell must be nearer than this.
    let limit = if own.is_some() { own.depth() - threshold } else { i32::MAX };
    let mut best = None;
    for (dx, dy) in [(1, 0), (0, 1)] {
        best = closing(sources, [at(-dx, -dy), at(dx, dy)], [dx, dy], limit, best);
    }
    for (dx, dy) in [(1, 1), (1, -1)] {
        if best.is_some() {
            break;
        }
        best = closing(sources, [at(-dx, -dy), at(dx, dy)], [dx, dy], limit, best);
    }
    best.map(|(_, entry)| entry)
}

/// An entry that closes a crack, and how far its sample is from the cell.
type Best = Option<(i32, Entry)>;

/// Returns the nearer one of two opposite neighbours, if they close the cell between them and it is nearer than `best`.
#[inline(always)]
fn closing<F: Format>(
    sources: &[Source<'_, F>],
    [a, b]: [Entry; 2],
    towards: [i32; 2],
    limit: i32,
    best: Best,
) -> Best {
    if !a.is_some() || !b.is_some() || a.depth().max(b.depth()) >= limit {
        return best;
    }
    if !joined(sources, a.sample(), b.sample()) {
        return best;
    }
    let from = |entry: Entry, side: i32| {
        let [u, v] = entry.residual();
        let residual = [u + side * towards[0] * CELL, v + side * towards[1] * CELL];
        (residual[0].abs() + residual[1].abs(), entry.seen_from(residual))
    };
    let (a, b) = (from(a, 1), from(b, -1));
    let nearer = if a.0 <= b.0 { a } else { b };
    if best.is_none_or(|best| nearer.0 < best.0) { Some(nearer) } else { best }
}

/// Returns whether two samples are the same, or are linked by a path, see [`path`].
fn joined<F: Format>(sources: &[Source<'_, F>], a: u32, b: u32) -> bool {
    let Some((source, first, _)) = super::layer_of(sources, a.min(b)) else { return false };
    let links = source.links();
    let (from, to) = (a - first, b.wrapping_sub(first));
    // Which row the second one is in follows from the numbers: no path leads around the end of a row.
    let between = to.wrapping_sub(from) as i32;
    let width = links.width as i32;
    [0, -width, width, -2 * width, 2 * width].into_iter().any(|down| {
        let across = between - down;
        across.abs() <= SPAN && path(links, from, across, down)
    })
}

/// Returns whether links lead from a sample `across` samples along its row and `down` samples, which are whole rows,
/// along the column: in turns one sample along the row and one along the column, as long as there are any left.
///
/// So the path between opposite corners leads through what lies between them, and a hole of one cell, around which all
/// samples are linked, is no crack.
fn path(links: Links<'_>, from: u32, across: i32, down: i32) -> bool {
    let width = links.width as i32;
    let (step_x, step_y) = (across.signum(), down.signum() * width);
    let (mut at, mut left_x, mut left_y) = (from, across.abs(), down.abs());
    while left_x | left_y != 0 {
        if left_x != 0 {
            let Some(next) = at.checked_add_signed(step_x).filter(|&next| links.right(at.min(next))) else {
                return false;
            };
            (at, left_x) = (next, left_x - 1);
        }
        if left_y != 0 {
            let Some(next) = at.checked_add_signed(step_y).filter(|&next| links.below(at.min(next))) else {
                return false;
            };
            (at, left_y) = (next, left_y - width);
        }
    }
    true
}
