//! Stretched quads: where a surface has grown, the cells between its samples.
//!
//! Four linked samples are the corners of a quad. If one of its sides has grown beyond 1.4 cells, the cells whose
//! centres lie in it show its first sample with the place in the quad as the residual. A quad of more than 4x4 cells is
//! not drawn, so that the work is bounded.

use super::layer::{CORNER_PARTS, Source};
use super::visibility::{Entry, Kind, PARTS, Visibility, depth};
use crate::format::Format;

/// A cell in the parts in which places count.
const CELL: i32 = 1 << CORNER_PARTS;

/// Quads whose sides are not longer than this in x and in y are not drawn, because points and cracks suffice.
pub(crate) const STRETCHED: i32 = 44;

/// The widest and highest quad that is drawn, in cells.
const LARGEST: i32 = 4;

/// The smallest area of a quad that is drawn, in parts of a cell squared: a 32nd of a cell. Smaller ones are seen edge
/// on, and those with a negative area from behind.
const SMALLEST: i32 = 1 << (2 * CORNER_PARTS) >> 5;

/// Bits of a number and of its reciprocal together.
const RECIPROCAL: u32 = 20;

/// Bits of a number of which the reciprocal is looked up.
const MANTISSA: u32 = 7;

/// The reciprocals of the numbers of [`MANTISSA`] bits whose highest bit is set.
const RECIPROCALS: [u16; 64] = {
    let mut table = [0; 64];
    let mut i = 0;
    while i < 64 {
        table[i] = ((1 << RECIPROCAL) / (64 + i)) as u16;
        i += 1;
    }
    table
};

/// Returns about `2^20 / number`, for a positive number. Shifts by ones: not every processor counts leading zeros.
#[inline(always)]
fn reciprocal(number: i32) -> i32 {
    const LEAST: i32 = 1 << (MANTISSA - 1);
    let (mut mantissa, mut up, mut down) = (number, 0, 0);
    while mantissa >= LEAST << 1 {
        mantissa >>= 1;
        down += 1;
    }
    while mantissa < LEAST {
        mantissa <<= 1;
        up += 1;
    }
    i32::from(RECIPROCALS[mantissa as usize & 63]) >> down << up
}

/// Shows a quad, if it is stretched.
pub(crate) fn draw_one<F: Format>(
    source: &Source<'_, F>,
    visibility: &mut Visibility<'_>,
    first: u32,
    [x, y]: [i32; 2],
    cell: u32,
) {
    let (width, grid) = (source.map.grid().width(), visibility.grid());
    let [place, right, below, last] = [cell, cell + 1, cell + width, cell + width + 1].map(|cell| source.place(cell));
    let relative = |to: [i32; 2], [cells_x, cells_y]: [i32; 2]| {
        [to[0] - place[0] + cells_x * CELL, to[1] - place[1] + cells_y * CELL]
    };
    let (a, b, c) = (relative(right, [1, 0]), relative(below, [0, 1]), relative(last, [1, 1]));
    let longest = a[0].abs().max(a[1].abs()).max(b[0].abs()).max(b[1].abs());
    if longest <= STRETCHED {
        return;
    }
    // The first corner as seen from the first cell of the grid.
    let corner = [(x << CORNER_PARTS) + place[0], (y << CORNER_PARTS) + place[1]];
    // The first and the last cell in x or y.
    let span = |corner: i32, [a, b, c]: [i32; 3]| {
        let (low, high) = (a.min(b).min(c).min(0), a.max(b).max(c).max(0));
        ((corner + low + CELL - 1) >> CORNER_PARTS, (corner + high - 1) >> CORNER_PARTS)
    };
    let (columns, rows) = (span(corner[0], [a[0], b[0], c[0]]), span(corner[1], [a[1], b[1], c[1]]));
    if columns.1 - columns.0 >= LARGEST || rows.1 - rows.0 >= LARGEST {
        return;
    }
    // The corners are now known to be near each other, so that no product overflows.
    let area = a[0] * b[1] - b[0] * a[1];
    if area < SMALLEST {
        return;
    }
    let record = source.map.record();
    let depth = depth(source.map.unsigned(record.depth(), cell), record.depth().bits.into());
    let (slack, reciprocal) = (area >> 2, reciprocal(area));
    let sixteenths = |part: i32| (part * reciprocal + (1 << (RECIPROCAL - PARTS) >> 1)) >> (RECIPROCAL - PARTS);
    for row in rows.0..=rows.1 {
        for column in columns.0..=columns.1 {
            let Some(target) = grid.cell(column, row) else { continue };
            let from = [(column << CORNER_PARTS) - corner[0], (row << CORNER_PARTS) - corner[1]];
            let u = b[1] * from[0] - b[0] * from[1];
            let v = a[0] * from[1] - a[1] * from[0];
            if u < -slack || v < -slack || u > area + slack || v > area + slack {
                continue;
            }
            let residual = [sixteenths(u).max(0), sixteenths(v).max(0)];
            visibility.challenge(target, Entry::new(depth, Kind::Quad, first + cell, residual));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reciprocal_is_that_of_seven_bits() {
        for area in 1i32..1 << 17 {
            let k = area.ilog2() + 1;
            let (shift, up) = (k.saturating_sub(7), 7u32.saturating_sub(k));
            let expected = (((1 << 20) / ((area >> shift) << up)) >> shift) << up;
            assert_eq!(reciprocal(area), expected, "{area}");
        }
    }

    #[test]
    fn a_reciprocal_is_right_to_a_sixtieth() {
        for number in SMALLEST..1 << 16 {
            let exact = f64::from(1 << RECIPROCAL) / f64::from(number);
            let error = (f64::from(reciprocal(number)) - exact).abs();
            assert!(error <= exact / 60.0 + 1.0, "{number}: {error} of {exact}");
        }
    }
}
