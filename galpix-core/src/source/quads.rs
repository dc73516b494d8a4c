//! Stretched quads: where a surface has grown, the cells between its samples.
//!
//! Four linked samples are the corners of a quad. If one of its sides has grown beyond 1.4 cells, the cells whose
//! centres lie in it show its first sample with the place in the quad as the residual. A quad of more than 4x4 cells is
//! not drawn, so that the work is bounded.

use super::layer::{CORNER_PARTS, Source};
use super::visibility::{Entry, Kind, PARTS, Visibility, depth};
use crate::format::Format;
use crate::frame::reference;

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

/// Returns about `2^20 / number`, for a positive number of at most 17 bits. Halves and doubles it by halves of the bits
/// that may be too many or too few: not every processor counts leading zeros.
#[inline(always)]
fn reciprocal(number: i32) -> i32 {
    let (mut mantissa, mut up, mut down) = (number as u32, 0, 0);
    for bits in [8, 4, 2, 1] {
        let long = reference::not_zero(mantissa >> (MANTISSA + bits - 1));
        mantissa >>= bits & long;
        down += bits & long;
    }
    for bits in [4, 2, 1] {
        let short = !reference::not_zero(mantissa >> (MANTISSA - bits));
        mantissa <<= bits & short;
        up += bits & short;
    }
    i32::from(RECIPROCALS[mantissa as usize & 63]) >> down << up
}

/// A quad: the number of its layer's first sample, and column, row and cell of its own first one. It is not drawn if
/// the mask is 0.
pub(crate) struct Quad {
    pub first: u32,
    pub place: [i32; 2],
    pub cell: u32,
    pub mask: u32,
}

/// The places of a quad's corners relative to the first one, to the right, below, and at the opposite corner, and the
/// place of the first one relative to its own cell.
struct Corners {
    place: [i32; 2],
    relative: [[i32; 2]; 3],
}

impl Corners {
    #[inline(always)]
    fn of<F: Format>(source: &Source<'_, F>, cell: u32) -> Self {
        let width = source.map.grid().width();
        let [place, right, below, last] =
            [cell, cell + 1, cell + width, cell + width + 1].map(|cell| source.place(cell));
        let relative = |to: [i32; 2], [cells_x, cells_y]: [i32; 2]| {
            [to[0] - place[0] + cells_x * CELL, to[1] - place[1] + cells_y * CELL]
        };
        Self { place, relative: [relative(right, [1, 0]), relative(below, [0, 1]), relative(last, [1, 1])] }
    }

    #[inline(always)]
    fn is_stretched(&self) -> bool {
        let [a, b, _] = self.relative;
        a[0].abs().max(a[1].abs()).max(b[0].abs()).max(b[1].abs()) > STRETCHED
    }
}

/// Returns all ones if four linked samples are a stretched quad, else 0, in constant time.
#[inline(always)]
pub(crate) fn stretched<F: Format>(source: &Source<'_, F>, cell: u32) -> u32 {
    u32::from(source.links().quad::<true>(cell) & Corners::of(source, cell).is_stretched()).wrapping_neg()
}

/// Shows a quad, if it is stretched. In constant time as many cells are looked at for each.
pub(crate) fn draw_one<F: Format, const CONSTANT_TIME: bool>(
    source: &Source<'_, F>,
    visibility: &mut Visibility<'_>,
    Quad { first, place: [x, y], cell, mask }: Quad,
) {
    let corners = Corners::of(source, cell);
    let [a, b, c] = corners.relative;
    // The first corner as seen from the first cell of the grid.
    let corner = [(x << CORNER_PARTS) + corners.place[0], (y << CORNER_PARTS) + corners.place[1]];
    // The first and the last cell in x or y.
    let span = |corner: i32, [a, b, c]: [i32; 3]| {
        let (low, high) = (a.min(b).min(c).min(0), a.max(b).max(c).max(0));
        ((corner + low + CELL - 1) >> CORNER_PARTS, (corner + high - 1) >> CORNER_PARTS)
    };
    let (columns, rows) = (span(corner[0], [a[0], b[0], c[0]]), span(corner[1], [a[1], b[1], c[1]]));
    let is_small = (columns.1 - columns.0 < LARGEST) & (rows.1 - rows.0 < LARGEST);
    let drawn = mask & u32::from(corners.is_stretched() & is_small).wrapping_neg();
    if !CONSTANT_TIME && drawn == 0 {
        return;
    }
    // The corners of a quad that is drawn are near each other, so that no product overflows.
    let product = |a: i32, b: i32| a.wrapping_mul(b);
    let area = product(a[0], b[1]).wrapping_sub(product(b[0], a[1]));
    let drawn = drawn & u32::from(area >= SMALLEST).wrapping_neg();
    if !CONSTANT_TIME && drawn == 0 {
        return;
    }
    let record = source.map.record();
    let depth = depth(source.map.unsigned(record.depth(), cell), record.depth().bits.into());
    let (slack, reciprocal) = (area >> 2, reciprocal(area));
    let sixteenths =
        |part: i32| product(part, reciprocal).wrapping_add(1 << (RECIPROCAL - PARTS) >> 1) >> (RECIPROCAL - PARTS);
    let last = |(first, last): (i32, i32)| if CONSTANT_TIME { first + LARGEST - 1 } else { last };
    for row in rows.0..=last(rows) {
        for column in columns.0..=last(columns) {
            let from = [(column << CORNER_PARTS) - corner[0], (row << CORNER_PARTS) - corner[1]];
            let u = product(b[1], from[0]).wrapping_sub(product(b[0], from[1]));
            let v = product(a[0], from[1]).wrapping_sub(product(a[1], from[0]));
            let most = area.wrapping_add(slack);
            let least = slack.wrapping_neg();
            let inside = (u >= least) & (v >= least) & (u <= most) & (v <= most);
            let inside = inside & (row <= rows.1) & (column <= columns.1);
            if !CONSTANT_TIME && !inside {
                continue;
            }
            let residual = [sixteenths(u).max(0), sixteenths(v).max(0)];
            let entry = Entry::new(depth, Kind::Quad, first + cell, residual);
            visibility.challenge_where(drawn & u32::from(inside).wrapping_neg(), [column, row], entry);
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
