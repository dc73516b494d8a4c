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
use crate::frame::reference::{choose, opaque};

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
/// when the next row is decided, which the old ones have served as neighbours. With `most` no row has more, and the
/// instructions depend on it alone.
#[inline(always)]
pub(crate) fn each_row(
    visibility: &mut Visibility<'_>,
    most: Option<usize>,
    mut decide: impl FnMut(&mut Visibility<'_>, usize, u32) -> usize,
) {
    let settle = |visibility: &mut Visibility<'_>, (y, start, count): (usize, u32, usize)| match most {
        Some(most) => visibility.settle_of(y, start, count, most),
        None => visibility.settle(y, start, count),
    };
    let mut before = None;
    for (y, &start) in visibility.grid().starts().iter().enumerate() {
        let count = decide(visibility, y, start);
        if let Some(before) = before.replace((y, start, count)) {
            settle(visibility, before);
        }
    }
    if let Some(before) = before {
        settle(visibility, before);
    }
}

/// Returns all ones and what closes a cell; 0 and anything if nothing does. In constant time all directions are looked
/// at.
#[inline(always)]
pub(crate) fn best<F: Format, const CONSTANT_TIME: bool>(
    sources: &[Source<'_, F>],
    visibility: &Visibility<'_>,
    [x, y]: [i32; 2],
    threshold: i32,
) -> (u32, Entry) {
    let at = |dx: i32, dy: i32| visibility.at_place::<CONSTANT_TIME>([x + dx, y + dy]);
    let own = at(0, 0);
    // What closes the cell must be nearer than this.
    let limit = choose(mask::<CONSTANT_TIME>(own.is_some()), (own.depth() - threshold) as u32, i32::MAX as u32) as i32;
    let closing =
        |[dx, dy]: [i32; 2]| closing::<F, CONSTANT_TIME>(sources, [at(-dx, -dy), at(dx, dy)], [dx, dy], limit);
    let mut best = Closing::NONE;
    for straight in [[1, 0], [0, 1]] {
        let closing = closing(straight);
        if CONSTANT_TIME || closing.closes() {
            best = closing.or(mask::<CONSTANT_TIME>(closing.distance < best.distance), best);
        }
    }
    for diagonal in [[1, 1], [1, -1]] {
        if !CONSTANT_TIME && best.closes() {
            break;
        }
        best = best.or(mask::<CONSTANT_TIME>(best.closes()), closing(diagonal));
    }
    (mask::<CONSTANT_TIME>(best.closes()), best.entry)
}

/// Returns all ones if a condition holds, else 0.
#[inline(always)]
fn mask<const CONSTANT_TIME: bool>(condition: bool) -> u32 {
    let mask = u32::from(condition).wrapping_neg();
    if CONSTANT_TIME { opaque(mask) } else { mask }
}

/// An entry that closes a crack, and how far its sample is from the cell.
#[derive(Clone, Copy)]
struct Closing {
    distance: i32,
    entry: Entry,
}

impl Closing {
    /// Nothing closes the cell.
    const NONE: Self = Self { distance: i32::MAX, entry: Entry::NONE };

    #[inline(always)]
    const fn closes(&self) -> bool {
        self.distance != i32::MAX
    }

    /// Returns `self` where the mask has ones, else `other`.
    #[inline(always)]
    fn or(self, mask: u32, other: Self) -> Self {
        Self {
            distance: choose(mask, self.distance as u32, other.distance as u32) as i32,
            entry: self.entry.or(mask, other.entry),
        }
    }
}

/// Returns the nearer one of two opposite neighbours, if they close the cell between them.
#[inline(always)]
fn closing<F: Format, const CONSTANT_TIME: bool>(
    sources: &[Source<'_, F>],
    [a, b]: [Entry; 2],
    towards: [i32; 2],
    limit: i32,
) -> Closing {
    let are_nearer = a.is_some() & b.is_some() & (a.depth().max(b.depth()) < limit);
    if !CONSTANT_TIME && !are_nearer {
        return Closing::NONE;
    }
    let are_nearer = mask::<CONSTANT_TIME>(are_nearer);
    let closes = are_nearer & joined::<F, CONSTANT_TIME>(sources, [a, b].map(|entry| entry.sample() & are_nearer));
    if !CONSTANT_TIME && closes == 0 {
        return Closing::NONE;
    }
    let from = |entry: Entry, side: i32| {
        let [u, v] = entry.residual();
        let residual = [u + side * towards[0] * CELL, v + side * towards[1] * CELL];
        Closing { distance: residual[0].abs() + residual[1].abs(), entry: entry.seen_from(residual) }
    };
    let (a, b) = (from(a, 1), from(b, -1));
    a.or(mask::<CONSTANT_TIME>(a.distance <= b.distance), b).or(closes, Closing::NONE)
}

/// Returns all ones if two samples are the same, or are linked by a path, see [`path`], else 0.
#[inline(never)]
fn joined<F: Format, const CONSTANT_TIME: bool>(sources: &[Source<'_, F>], [a, b]: [u32; 2]) -> u32 {
    let found = if CONSTANT_TIME {
        super::layer_of_any(sources, a.min(b))
    } else {
        super::layer_of(sources, a.min(b)).map(|(source, first, _)| (source, first))
    };
    let Some((source, first)) = found else { return 0 };
    let links = source.links();
    let (from, to) = (a - first, b.wrapping_sub(first));
    // Which row the second one is in follows from the numbers: no path leads around the end of a row.
    let between = to.wrapping_sub(from) as i32;
    let width = links.width as i32;
    let downs = [0, -width, width, -2 * width, 2 * width];
    let near = |down: i32| (between - down).abs() <= SPAN;
    if CONSTANT_TIME && width > 2 * SPAN {
        // At most one of the rows is near enough.
        let (down, any) = downs.into_iter().fold((0, 0), |(found, any), down| {
            let near = mask::<CONSTANT_TIME>(near(down));
            (choose(near, down as u32, found as u32) as i32, any | near)
        });
        return any & path::<CONSTANT_TIME>(links, from, choose(any, (between - down) as u32, 0) as i32, down);
    }
    let path = |down: i32| mask::<CONSTANT_TIME>(near(down)) & path::<CONSTANT_TIME>(links, from, between - down, down);
    if CONSTANT_TIME {
        return downs.into_iter().fold(0, |any, down| any | path(down));
    }
    mask::<CONSTANT_TIME>(downs.into_iter().any(|down| near(down) && path(down) != 0))
}

/// Returns all ones if links lead from a sample `across` samples along its row and `down` samples, which are whole
/// rows, along the column, else 0: in turns one sample along the row and one along the column, as long as there are any
/// left, of each [`SPAN`] at most.
///
/// So the path between opposite corners leads through what lies between them, and a hole of one cell, around which all
/// samples are linked, is no crack.
fn path<const CONSTANT_TIME: bool>(links: Links<'_>, from: u32, across: i32, down: i32) -> u32 {
    let width = links.width as i32;
    let (mut at, mut linked) = (from, true);
    for step in 1..=SPAN {
        let along = choose(mask::<CONSTANT_TIME>(across.abs() >= step), across.signum() as u32, 0) as i32;
        linked &= (along == 0) | links.right(at.wrapping_add_signed(along.min(0)));
        if !CONSTANT_TIME && !linked {
            return 0;
        }
        at = at.wrapping_add_signed(along);
        let far = mask::<CONSTANT_TIME>(down.abs() >= step.wrapping_mul(width));
        let along = choose(far, down.signum().wrapping_mul(width) as u32, 0) as i32;
        linked &= (along == 0) | links.below(at.wrapping_add_signed(along.min(0)));
        if !CONSTANT_TIME && !linked {
            return 0;
        }
        at = at.wrapping_add_signed(along);
    }
    mask::<CONSTANT_TIME>(linked)
}
