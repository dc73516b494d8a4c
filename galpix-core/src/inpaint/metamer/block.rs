//! Tiles of a pyramid: 8 x 8 cells of level 1 and what is pulled from them alone, up to one of level 4.

use super::steerable::TILE;
use crate::inpaint::kernel::{Known, Value, pulled};
use crate::inpaint::mean::tie;
use crate::inpaint::pyramid::{Pyramid, State, Stored};
use crate::inpaint::settings::Inpainting;
use crate::inpaint::validity::FULL;

/// Columns and rows of a pulled tile.
pub const HALF: usize = TILE / 2;

/// Levels of a tile above the cells that it is pulled from.
pub const LEVELS: u32 = 4;

/// Columns of level 1 of the tiles of tones that are pulled together.
pub const ACROSS: u32 = 8 * HALF as u32;

/// Cells of a level of a pulled tile, or of its quarters.
pub type Part<V, const CELLS: usize> = [Known<V>; CELLS];

/// Keeps the cells of a level of a tile of `side` x `side` that begins at `left`, `top`.
#[inline(always)]
pub fn keep<V: Stored>(
    pyramid: &mut Pyramid<'_, V>,
    level: u32,
    (left, top): (u32, u32),
    side: usize,
    cells: &[Known<V>],
) {
    for (row, y) in cells.chunks_exact(side).zip(top..) {
        let first = pyramid.index(level, left, y);
        let width = pyramid.levels().level(level).width;
        if first != usize::MAX {
            for ((cell, index), _) in row.iter().zip(first..).zip(left..width) {
                pyramid.set(index, State::Pulled, *cell);
            }
        }
    }
}

/// Pulls the level above a tile's, which has `2 side` x `2 side` cells.
#[inline(always)]
pub fn halved<V: Value, const CELLS: usize>(
    cells: &[Known<V>],
    side: usize,
    (left, top): (u32, u32),
    level: u32,
    inpainting: &Inpainting<'_>,
) -> Part<V, CELLS> {
    let mut halved = [Known::default(); CELLS];
    for (at, to) in halved.iter_mut().enumerate() {
        let (i, j) = (at % side, at / side);
        let first = 2 * (2 * j * side + i);
        let (Some([a, b]), Some([c, d])) =
            (cells.get(first..first + 2), cells.get(first + 2 * side..first + 2 * side + 2))
        else {
            continue;
        };
        let tie = tie(left + i as u32, top + j as u32, level);
        let farthest = a.depth.max(b.depth).max(c.depth.max(d.depth));
        let nearest = a.depth.min(b.depth).min(c.depth.min(d.depth));
        if a.validity & b.validity & c.validity & d.validity == FULL && farthest - nearest <= inpainting.threshold {
            to.validity = FULL;
            to.depth = farthest;
            to.value = V::plain_mean(&[a.value, b.value, c.value, d.value], tie);
        } else {
            *to = pulled(&[*a, *b, *c, *d], inpainting, tie);
        }
    }
    halved
}

/// Pulls levels 3 and 4 of the tile whose cells of level 2 these are, and keeps all; `left`, `top` is its first cell of
/// level 1.
#[inline(always)]
pub fn pull_up<V: Stored>(
    pyramid: &mut Pyramid<'_, V>,
    inpainting: &Inpainting<'_>,
    (left, top): (u32, u32),
    second: &Part<V, 16>,
) {
    let place = |level: u32| (left >> (level - 1), top >> (level - 1));
    keep(pyramid, 2, place(2), 4, second);
    let third: Part<V, 4> = halved(second, 2, place(3), 3, inpainting);
    keep(pyramid, 3, place(3), 2, &third);
    let fourth: Part<V, 1> = halved(&third, 1, place(4), 4, inpainting);
    keep(pyramid, 4, place(4), 1, &fourth);
}
