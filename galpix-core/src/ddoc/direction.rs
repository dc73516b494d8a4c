//! The direction of a distortion: perpendicular to the line that fits the edge best, towards the farther side.
//!
//! The least squares fit of a line in two dimensions (by distances perpendicular to it) is the principal axis of the
//! cells' second moments. With `p = c_xx - c_yy` and `q = 2 c_xy`, the double angle of the axis is that of (p, q). Half
//! of it needs no arc tangent: with `h = |(p, q)|` the axis is along `(h + p, q)`, or along `(q, h - p)` where p is
//! negative and the first would vanish.

use crate::inpaint::root;

/// Fraction bits of a unit vector's components.
pub const FRACTION_BITS: u32 = 14;

/// Returns `length` along one component of a direction. *Rounding:* down.
#[inline(always)]
#[must_use]
pub const fn along(component: i32, length: i32) -> i32 {
    component.wrapping_mul(length) >> FRACTION_BITS
}

/// The sums over the cells of a window that a line is fitted to; coordinates are cells from the middle of the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Moments {
    /// Cells.
    pub count: i32,
    /// Sums of x and of y.
    pub first: [i32; 2],
    /// Sums of x x, y y and x y.
    pub second: [i32; 3],
}

impl Moments {
    /// Adds a cell.
    #[inline(always)]
    pub const fn add(&mut self, x: i32, y: i32) {
        self.count += 1;
        self.first[0] += x;
        self.first[1] += y;
        self.second[0] += x * x;
        self.second[1] += y * y;
        self.second[2] += x * y;
    }

    /// Returns a vector of any length perpendicular to the line that fits best; `None` if no line fits better than
    /// others, as for one cell alone or cells all around.
    #[must_use]
    pub const fn normal(&self) -> Option<[i32; 2]> {
        let Self { count, first: [x, y], second: [xx, yy, xy] } = *self;
        // At most 31 x 31 cells, each at most 15 away: the products stay below 2^28.
        let (c_xx, c_yy, c_xy) = (count * xx - x * x, count * yy - y * y, count * xy - x * y);
        let [p, q] = fitted([c_xx - c_yy, 2 * c_xy]);
        let h = root::nearest(square([p, q])) as i32;
        if h == 0 {
            None
        } else if p >= 0 {
            Some([-q, h + p])
        } else {
            Some([p - h, q])
        }
    }
}

/// What the window around a cell of an edge holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Window {
    /// The cells of the same edge.
    pub moments: Moments,
    /// The sum of all depth differences from the middle, each times its place from the middle: points to the farther
    /// side.
    pub slope: [i64; 2],
}

/// Returns the direction at an edge as a unit vector: the normal of the line through its cells, turned to the farther
/// side; where there is no line, the direction in which the depth grows; `None` where neither is known.
#[must_use]
pub fn direction(window: &Window) -> Option<[i16; 2]> {
    let [slope_x, slope_y] = window.slope;
    let normal = match window.moments.normal() {
        Some([x, y]) => {
            let farther = i64::from(x) * slope_x + i64::from(y) * slope_y;
            if farther < 0 { [-x, -y] } else { [x, y] }
        }
        None => {
            // Shifted until the components fit in words; only the direction counts.
            let bits = 64 - (slope_x.unsigned_abs() | slope_y.unsigned_abs()).leading_zeros();
            let shift = bits.saturating_sub(15);
            [(slope_x >> shift) as i32, (slope_y >> shift) as i32]
        }
    };
    unit(normal)
}

/// Returns a vector of length 1 with the direction of `vector`, `None` if that is 0.
///
/// *Rounding:* the root to nearest, the quotients towards 0: the length is short by less than 2^-12.
#[must_use]
pub fn unit(vector: [i32; 2]) -> Option<[i16; 2]> {
    let [x, y] = fitted(vector);
    // Lengthened to 15 bits, so that the length of a short vector is as exact.
    let bits = 32 - (x.unsigned_abs() | y.unsigned_abs()).leading_zeros();
    let [x, y] = [x, y].map(|component| component << (15 - bits.min(15)));
    let length = root::nearest(square([x, y])) as i32;
    let one = |component: i32| Some((component << FRACTION_BITS).checked_div(length)? as i16);
    Some([one(x)?, one(y)?])
}

/// Returns the square of the length of a vector that [`fitted`] has returned.
const fn square([x, y]: [i32; 2]) -> u32 {
    let (x, y) = (x.unsigned_abs(), y.unsigned_abs());
    x * x + y * y
}

/// Returns the vector, shortened by a power of two until both components have at most 15 bits and a sign, so that the
/// sum of their squares is a word.
const fn fitted([x, y]: [i32; 2]) -> [i32; 2] {
    let bits = 32 - (x.unsigned_abs() | y.unsigned_abs()).leading_zeros();
    let shift = bits.saturating_sub(15);
    [x >> shift, y >> shift]
}
