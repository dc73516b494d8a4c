//! Vectors that belong to no surface.
//!
//! In an anti-aliased render the depth of a pixel comes from one sample, but its vector is averaged over the pixel: at the
//! border of a surface that moves, it belongs to neither side. Such a vector is replaced by that of the nearest cell of the
//! same surface that is away from any border.

use super::camera::{Distance, Track};
use super::source::Size;

/// Depths of one surface differ from cell to cell by less than this part.
const SAME_SURFACE: f64 = 0.05;

/// Smaller differences, in pixels a frame, are taken for the surface's own.
const TOLERANCE: f64 = 0.1;

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
        let of_surface = around(size, x, y, 2)
            .filter(|&near| clean[near] && matches!(distances[near], Distance::At(there) if same(here, there)))
            .min_by_key(|&near| squared(near));
        if let Some(own) = of_surface.and_then(|near| given[near])
            && (0..2).any(|i| (own.velocity[i] - mixed.velocity[i]).abs() > TOLERANCE)
        {
            tracks[cell] = Some(own);
            replaced += 1;
        }
    }
    replaced
}

/// The cells at most `reach` columns and rows away, inside the picture.
fn around(size: Size, x: usize, y: usize, reach: usize) -> impl Iterator<Item = usize> {
    let columns = x.saturating_sub(reach)..(x + reach + 1).min(size.width);
    let rows = y.saturating_sub(reach)..(y + reach + 1).min(size.height);
    rows.flat_map(move |y| columns.clone().map(move |x| y * size.width + x))
}
