//! The direction of a distortion: at right angles to the line that fits the edge best, towards what is farther.
//!
//! A least squares fit of a line in two dimensions (distances at right angles to it) is the axis of the cells' second moments.
//! With `p = c_xx - c_yy` and `q = 2 c_xy` the double angle of the axis is that of (p, q), and half of it needs no arc: where
//! `h = |(p, q)|`, the axis is along `(h + p, q)`, or along `(q, h - p)` where p is negative and the first would vanish.

use crate::inpaint::root;

/// Fraction bits of a unit vector's components.
pub const FRACTION_BITS: u32 = 14;

/// `length` along one component of a direction, rounded down.
#[inline(always)]
#[must_use]
pub const fn along(component: i32, length: i32) -> i32 {
    component.wrapping_mul(length) >> FRACTION_BITS
}

/// The sums over the cells of a window that a line is fitted to, each in cells from the window's middle.
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
    /// One more cell.
    #[inline(always)]
    pub const fn add(&mut self, x: i32, y: i32) {
        self.count += 1;
        self.first[0] += x;
        self.first[1] += y;
        self.second[0] += x * x;
        self.second[1] += y * y;
        self.second[2] += x * y;
    }

    /// A vector at right angles to the line that fits best, of any length; nothing if no line fits better than others, as for
    /// a cell alone or cells all around.
    #[must_use]
    pub const fn normal(&self) -> Option<[i32; 2]> {
        let Self { count, first: [x, y], second: [xx, yy, xy] } = *self;
        // At most 31 x 31 cells, 15 away: the products stay below 2^28.
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

/// What is seen around a cell of an edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Window {
    /// The cells of the same edge.
    pub moments: Moments,
    /// The sum of all depths, each times its place from the middle: points to where it is farther.
    pub slope: [i64; 2],
}

/// The direction at an edge, as a unit vector: the normal of the line through its cells, turned to where it is farther; the
/// way in which it gets farther where there is no line; nothing where neither is known.
#[must_use]
pub fn direction(window: &Window) -> Option<[i16; 2]> {
    let [down_x, down_y] = window.slope;
    let normal = match window.moments.normal() {
        Some([x, y]) => {
            let farther = i64::from(x) * down_x + i64::from(y) * down_y;
            if farther < 0 { [-x, -y] } else { [x, y] }
        }
        None => {
            // Shifted until they are words again; only the direction counts.
            let bits = 64 - (down_x.unsigned_abs() | down_y.unsigned_abs()).leading_zeros();
            let shift = bits.saturating_sub(15);
            [(down_x >> shift) as i32, (down_y >> shift) as i32]
        }
    };
    unit(normal)
}

/// A vector of length 1, or nothing if it is 0.
///
/// *Rounding:* the root to nearest, the quotients towards 0: the length is short by less than 2^-12.
#[must_use]
pub fn unit(vector: [i32; 2]) -> Option<[i16; 2]> {
    let [x, y] = fitted(vector);
    // As long as 15 bits allow, so that the length of a short one is as exact.
    let bits = 32 - (x.unsigned_abs() | y.unsigned_abs()).leading_zeros();
    let [x, y] = [x, y].map(|component| component << (15 - bits.min(15)));
    let length = root::nearest(square([x, y])) as i32;
    let one = |component: i32| Some((component << FRACTION_BITS).checked_div(length)? as i16);
    Some([one(x)?, one(y)?])
}

/// The square of the length of a vector of which [`fitted`] has made sure that it is a word.
const fn square([x, y]: [i32; 2]) -> u32 {
    let (x, y) = (x.unsigned_abs(), y.unsigned_abs());
    x * x + y * y
}

/// The vector, shortened by powers of two until both components have 15 bits and a sign, so that their squares add up within a
/// word.
const fn fitted([x, y]: [i32; 2]) -> [i32; 2] {
    let bits = 32 - (x.unsigned_abs() | y.unsigned_abs()).leading_zeros();
    let shift = bits.saturating_sub(15);
    [x >> shift, y >> shift]
}
