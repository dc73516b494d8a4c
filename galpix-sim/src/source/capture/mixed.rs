//! Vectors that belong to no surface.
//!
//! In an anti-aliased render the depth of a pixel comes from one sample, but its vector is averaged over the pixel: at
//! the border of a surface that moves, it lies somewhere between the vectors of the two sides. Such a vector is
//! replaced by that of the nearest cell of the same surface that is away from any border. A vector that is not between
//! the two sides is the surface's own, as in a render of one sample per pixel, and is left alone.

use super::camera::{Distance, Track};
use super::source::Size;

/// Depths of one surface differ from cell to cell by less than this part.
const SAME_SURFACE: f64 = 0.05;

/// Smaller differences, in pixels per frame, are taken for the surface's own.
const TOLERANCE: f64 = 0.1;

/// A mixed vector lies on the line between the two sides' to within this part of their difference.
const OFF_LINE: f64 = 0.1;

/// Replaces mixed vectors; returns how many were.
pub(super) fn unmix(tracks: &mut [Option<Track>], distances: &[Distance], size: Size) -> usize {
    let same = |a: f64, b: f64| (a - b).abs() <= SAME_SURFACE * a.min(b);
    let clean: Vec<bool> = size
        .positions()
        .zip(distances)
        .map(|((x, y), distance)| match distance {
            Distance::At(here) => around(size, x, y, 1).all(|near| match distances[near] {
                Distance::At(there) => same(*here, there),
                Distance::Far | Distance::Unknown => false,
            }),
            Distance::Far | Distance::Unknown => false,
        })
        .collect();
    let given = tracks.to_vec();
    let mut replaced = 0;
    for (cell, (x, y)) in size.positions().enumerate() {
        let (Distance::At(here), false, Some(mixed)) = (distances[cell], clean[cell], given[cell]) else { continue };
        let squared = |near: usize| {
            let (dx, dy) = ((near % size.width).abs_diff(x), (near / size.width).abs_diff(y));
            dx * dx + dy * dy
        };
        let nearest = |side: &dyn Fn(usize) -> bool| {
            let cells = around(size, x, y, 2).filter(|&near| side(near));
            cells.min_by_key(|&near| squared(near)).and_then(|near| given[near])
        };
        let own_side = |near: usize| matches!(distances[near], Distance::At(there) if same(here, there));
        let own = nearest(&|near| clean[near] && own_side(near));
        let other = nearest(&|near| !own_side(near) && distances[near] != Distance::Unknown);
        if let (Some(own), Some(other)) = (own, other)
            && between(mixed.velocity, own.velocity, other.velocity)
        {
            tracks[cell] = Some(own);
            replaced += 1;
        }
    }
    replaced
}

/// Whether a vector lies between those of its own side and of the other, and noticeably off its own.
fn between(mixed: [f64; 3], own: [f64; 3], other: [f64; 3]) -> bool {
    let off = [mixed[0] - own[0], mixed[1] - own[1]];
    let across = [other[0] - own[0], other[1] - own[1]];
    let squared = across[0] * across[0] + across[1] * across[1];
    if off[0].hypot(off[1]) <= TOLERANCE || squared == 0.0 {
        return false;
    }
    let part = (off[0] * across[0] + off[1] * across[1]) / squared;
    let distance = (off[0] * across[1] - off[1] * across[0]).abs() / squared;
    part > 0.0 && part <= 1.0 + OFF_LINE && distance <= OFF_LINE
}

/// Returns the cells at most `reach` columns and rows away, inside the picture.
fn around(size: Size, x: usize, y: usize, reach: usize) -> impl Iterator<Item = usize> {
    let columns = x.saturating_sub(reach)..(x + reach + 1).min(size.width);
    let rows = y.saturating_sub(reach)..(y + reach + 1).min(size.height);
    rows.flat_map(move |y| columns.clone().map(move |x| y * size.width + x))
}
