//! The colours of entries: bilinear between a sample and its linked neighbours, by the residual.

use super::layer::Source;
use super::links::{Links, Side, WORD};
use super::visibility::{Entry, PARTS};
use crate::format::Format;
use crate::format::colour::WEIGHTS;

/// A cell in the parts in which residuals count.
const CELL: i32 = 1 << PARTS;

const _: () = assert!((CELL * CELL) as u32 == WEIGHTS);

/// Returns the colour word of a sample of a layer, seen from a place beside it. `cell` is where it is stored, and
/// `in_front` says whether something nearer than a depth is shown at a side of the cell.
#[inline(always)]
pub(crate) fn colour<F: Format>(
    source: &Source<'_, F>,
    cell: u32,
    [u, v]: [i32; 2],
    in_front: impl Fn(u32, Side) -> bool,
) -> u32 {
    let (map, links) = (&source.map, source.links());
    let own = unmixed(source, cell, in_front);
    let (side, vertical) =
        (if u < 0 { Side::Left } else { Side::Right }, if v < 0 { Side::Above } else { Side::Below });
    let [mut x, mut y] = [u.unsigned_abs(), v.unsigned_abs()];
    let beside = if x == 0 { None } else { links.neighbour(cell, side) };
    let under = if y == 0 { None } else { links.neighbour(cell, vertical) };
    let corner = match (beside, under) {
        (Some(beside), Some(under)) => {
            links.neighbour(beside, vertical).or_else(|| links.neighbour(under, side)).unwrap_or_else(|| {
                // Without the fourth one the colour changes along one axis only.
                if x < y {
                    x = 0
                } else {
                    y = 0
                }
                cell
            })
        }
        _ => cell,
    };
    let beside = beside.unwrap_or_else(|| {
        x = 0;
        cell
    });
    let under = under.unwrap_or_else(|| {
        y = 0;
        cell
    });
    if x | y == 0 {
        return own;
    }
    const SIDE: u32 = CELL as u32;
    map.record().colour_format().weighted(
        [own, map.colour(beside), map.colour(under), map.colour(corner)],
        [(SIDE - x) * (SIDE - y), x * (SIDE - y), (SIDE - x) * y, x * y],
    )
}

/// Returns the colour word of a sample. Beside a nearer surface a renderer may have mixed the colours of both: if the
/// colour lies between that of the nearer surface and that of the neighbour on the other side, and the nearer surface
/// is not seen there any more, it is the neighbour's. Of several neighbours it is the one whose colour differs most.
#[inline(always)]
fn unmixed<F: Format>(source: &Source<'_, F>, cell: u32, in_front: impl Fn(u32, Side) -> bool) -> u32 {
    let (map, links) = (&source.map, source.links());
    let (own, format) = (map.colour(cell), *map.record().colour_format());
    let (mut unmixed, mut farthest) = (own, 0);
    if !source.is_mixed() {
        return own;
    }
    for side in Side::ALL {
        let nearer = links.beyond(cell, side);
        if !links.ends(nearer, side.opposite()) || in_front(nearer, side) {
            continue;
        }
        let Some(inner) = links.neighbour(cell, side.opposite()) else { continue };
        let (inner, nearer) = (map.colour(inner), map.colour(nearer));
        let distance = format.distance(own, inner);
        if distance > farthest && format.is_mixture(own, [inner, nearer]) {
            (unmixed, farthest) = (inner, distance);
        }
    }
    unmixed
}

/// Returns whether the colours of samples beside a nearer surface are taken for mixtures of both: a renderer that mixes
/// does so at all rims, while in a texture a colour may lie between two others anywhere. So a quarter of these samples
/// must be between the nearer surface and the neighbour on the other side, and more than twice as many as of those
/// neighbours, which no renderer has mixed.
pub(crate) fn are_mixed<F: Format>(source: &Source<'_, F>) -> bool {
    let (map, links) = (&source.map, source.links());
    let format = map.record().colour_format();
    let (mut rims, mut mixed, mut inner_mixed) = (0u32, 0u32, 0u32);
    let is_between = |cell: u32, [inner, nearer]: [u32; 2]| {
        let [own, inner, nearer] = [cell, inner, nearer].map(|cell| map.colour(cell));
        own != inner && format.is_mixture(own, [inner, nearer])
    };
    for (first, word) in (0..).step_by(WORD as usize).zip(links.words) {
        // No bit where both of a pair are set, or none.
        if (word ^ word >> 1) & 0x5555_5555 == 0 {
            continue;
        }
        for cell in first..first + WORD {
            for (before, after) in [(Side::Left, Side::Right), (Side::Above, Side::Below)] {
                let beyond = links.beyond(cell, after);
                let (nearer, own, side) = if links.ends(cell, after) {
                    (cell, beyond, after)
                } else if links.ends(beyond, before) {
                    (beyond, cell, before)
                } else {
                    continue;
                };
                let Some(inner) = links.neighbour(own, side) else { continue };
                let Some(innermost) = links.neighbour(inner, side) else { continue };
                rims += 1;
                mixed += u32::from(is_between(own, [inner, nearer]));
                inner_mixed += u32::from(is_between(inner, [innermost, nearer]));
            }
        }
    }
    mixed > inner_mixed << 1 && mixed << 2 >= rims
}

/// Returns how far a cell's centre lies beyond the sample that is nearest to it, towards a side at which the sample's
/// surface ends; `None` if it does not end there.
#[inline(always)]
pub(crate) fn beyond(links: Links<'_>, cell: u32, residual: [i32; 2], side: Side) -> Option<i32> {
    let (mut cell, [mut u, mut v]) = (cell, residual);
    // A sample that is farther than half a cell has a neighbour that is nearer.
    for (part, [before, after]) in [(&mut u, [Side::Left, Side::Right]), (&mut v, [Side::Above, Side::Below])] {
        let (towards, step) = match *part {
            part if part > CELL >> 1 => (after, -CELL),
            part if part < -(CELL >> 1) => (before, CELL),
            _ => continue,
        };
        if let Some(neighbour) = links.neighbour(cell, towards) {
            (cell, *part) = (neighbour, *part + step);
        }
    }
    links.ends(cell, side).then(|| side.along([u, v]))
}

/// What a cell shows, for [`covered`].
#[derive(Clone, Copy)]
pub(crate) struct Cell<'s> {
    pub entry: Entry,
    /// The links of the sample's layer, and the cell where the sample is stored.
    pub links: Links<'s>,
    pub sample: u32,
    /// The colour, before [`covered`].
    pub colour: u32,
}

/// Returns in how many parts of 16 of a cell the neighbour at `side` is seen.
///
/// Where one of the two is nearer by more than `threshold` and its surface ends between them, it ends half a cell
/// beyond its last sample. What shows no sample is behind everything.
#[inline(always)]
pub(crate) fn covered(own: &Cell<'_>, neighbour: &Cell<'_>, side: Side, threshold: i32) -> u32 {
    let nearer = |a: &Cell<'_>, b: &Cell<'_>| a.entry.depth() + threshold < b.entry.depth();
    let reach = |cell: &Cell<'_>, side: Side| beyond(cell.links, cell.sample, cell.entry.residual(), side);
    let part = if nearer(own, neighbour) {
        reach(own, side)
    } else if nearer(neighbour, own) {
        reach(neighbour, side.opposite()).map(|part| -part)
    } else {
        None
    };
    part.map_or(0, |part| part.max(0) as u32)
}
