//! Values that carry their own first and second derivative by time.
//!
//! A scene states where a point is as one formula in `t`. Evaluated over [`Jet`]s, the same formula yields velocity and
//! acceleration by the product, quotient and chain rules: exact up to rounding, and never at odds with the place
//! itself.

use std::ops::{Add, Div, Mul, Sub};

/// A value, its rate of change a frame, and the rate of change of that: the Taylor series (1) of the paper to second
/// order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// The value itself.
    pub value: f64,
    /// First derivative by time.
    pub velocity: f64,
    /// Second derivative by time.
    pub acceleration: f64,
}

impl Jet {
    /// The running time `t` (frames): it advances by one per frame.
    #[must_use]
    pub const fn time(t: f64) -> Self {
        Self { value: t, velocity: 1.0, acceleration: 0.0 }
    }

    /// A value that never changes.
    #[must_use]
    pub const fn constant(value: f64) -> Self {
        Self { value, velocity: 0.0, acceleration: 0.0 }
    }

    /// Sine and cosine of an angle in radians.
    #[must_use]
    pub fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        let squared = self.velocity * self.velocity;
        (
            Self { value: sin, velocity: cos * self.velocity, acceleration: cos * self.acceleration - sin * squared },
            Self { value: cos, velocity: -sin * self.velocity, acceleration: -sin * self.acceleration - cos * squared },
        )
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            velocity: self.velocity + other.velocity,
            acceleration: self.acceleration + other.acceleration,
        }
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            velocity: self.velocity * other.value + self.value * other.velocity,
            acceleration: self.acceleration * other.value
                + 2.0 * self.velocity * other.velocity
                + self.value * other.acceleration,
        }
    }
}

impl Div for Jet {
    type Output = Self;
    /// The quotient `q` follows from `self = q * other`, differentiated twice and solved for `q`, `q'` and `q''` in
    /// turn.
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let velocity = (self.velocity - value * other.velocity) / other.value;
        let acceleration =
            (self.acceleration - 2.0 * velocity * other.velocity - value * other.acceleration) / other.value;
        Self { value, velocity, acceleration }
    }
}

impl Add<f64> for Jet {
    type Output = Self;
    fn add(self, shift: f64) -> Self {
        Self { value: self.value + shift, ..self }
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { value: self.value * factor, velocity: self.velocity * factor, acceleration: self.acceleration * factor }
    }
}

/// One coordinate under constant acceleration, equation (2): `start + velocity t + acceleration t² / 2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path {
    /// Where it is at the update, t = 0.
    pub start: f64,
    /// How fast it changes at the update, a frame.
    pub velocity: f64,
    /// How fast that changes, a frame².
    pub acceleration: f64,
}

impl Path {
    /// A coordinate that starts at `start` with `velocity` a frame and is accelerated by `acceleration` a frame².
    #[must_use]
    pub const fn new(start: f64, velocity: f64, acceleration: f64) -> Self {
        Self { start, velocity, acceleration }
    }

    /// A coordinate that stays where it is.
    #[must_use]
    pub const fn still(start: f64) -> Self {
        Self::new(start, 0.0, 0.0)
    }

    /// The coordinate at `t`, with its derivatives if `t` has them.
    #[must_use]
    pub fn at(&self, t: Jet) -> Jet {
        t * (t * (0.5 * self.acceleration) + self.velocity) + self.start
    }

    /// The coordinate's value at `t` frames.
    #[must_use]
    pub fn value(&self, t: f64) -> f64 {
        self.at(Jet::constant(t)).value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// t²·sin(t) / (1 + t), differentiated by hand.
    #[test]
    fn product_quotient_and_chain_rule_agree_with_a_hand_calculation() {
        let t = 0.7_f64;
        let time = Jet::time(t);
        let jet = time * time * time.sin_cos().0 / (time + 1.0);
        let (s, c) = t.sin_cos();
        let (n, n1, n2) = (t * t * s, 2.0 * t * s + t * t * c, 2.0 * s + 4.0 * t * c - t * t * s);
        let d = 1.0 + t;
        assert!((jet.value - n / d).abs() < 1e-14);
        assert!((jet.velocity - (n1 / d - n / (d * d))).abs() < 1e-14);
        assert!((jet.acceleration - (n2 / d - 2.0 * n1 / (d * d) + 2.0 * n / (d * d * d))).abs() < 1e-14);
    }

    #[test]
    fn cosine_of_an_accelerated_angle() {
        let angle = Path::new(0.3, 0.2, 0.1).at(Jet::time(2.0));
        let (x, w, a) = (0.3 + 0.4 + 0.2, 0.4, 0.1);
        let (_, cos) = angle.sin_cos();
        assert!((cos.value - f64::cos(x)).abs() < 1e-14);
        assert!((cos.velocity + w * f64::sin(x)).abs() < 1e-14);
        assert!((cos.acceleration + a * f64::sin(x) + w * w * f64::cos(x)).abs() < 1e-14);
    }
}
