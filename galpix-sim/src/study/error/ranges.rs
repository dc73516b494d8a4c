//! What the motion of an update ranges over: how many integer bits its scene really needs, and what leaves a field.

use galpix_core::record::Component;
use galpix_core::{Bits, Layout};

use crate::update::{Known, Sample, Update};

/// The largest magnitudes in x, y and depth (pixels per frame, pixels per frame²; depth: parts of the range).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ranges {
    /// Of velocities at the update.
    pub first: [f64; 3],
    /// Of velocities from the update to the last frame, with acceleration.
    pub any: [f64; 3],
    /// Of accelerations.
    pub acceleration: [f64; 3],
}

impl Ranges {
    /// Of the known samples of an update over `frames` frames.
    #[must_use]
    pub fn of(update: &Update, frames: u32) -> Self {
        let mut ranges = Self::default();
        for sample in update.samples.iter().filter(|sample| sample.known == Known::Motion) {
            for axis in 0..3 {
                let (v, a) = (sample.velocity[axis], sample.acceleration[axis]);
                let last = (v + a * f64::from(frames)).abs();
                ranges.first[axis] = ranges.first[axis].max(v.abs());
                ranges.any[axis] = ranges.any[axis].max(v.abs()).max(last);
                ranges.acceleration[axis] = ranges.acceleration[axis].max(a.abs());
            }
        }
        ranges
    }

    /// Returns the component without the integer bits that nothing in the update uses. `bins` is the logarithm of the
    /// units of a whole range: 0 in the plane, the bits of the depth's bins in depth.
    #[must_use]
    pub fn fit(&self, component: Component, axis: usize, bins: u32, layout: Layout) -> Component {
        let unit = f64::from(1u32 << bins.min(31));
        let velocity = if layout.acceleration { self.any[axis] } else { self.first[axis] };
        Component {
            velocity_int: component.velocity_int.min(integer_bits(velocity * unit, component.velocity_frac)),
            acceleration_int: component
                .acceleration_int
                .min(integer_bits(self.acceleration[axis] * unit, component.acceleration_frac)),
            ..component
        }
    }
}

/// Returns integer bits, with sign, of a field with `frac` fraction bits that holds `magnitude` of either sign; at
/// least 1.
fn integer_bits(magnitude: f64, frac: u32) -> u32 {
    let last_bit = 0.5f64.powi(frac as i32);
    (1..31).find(|&bits| magnitude <= f64::from(1u32 << (bits - 1)) - last_bit).unwrap_or(31)
}

/// The velocity and the acceleration of a sample as a component stores them, and whether both fit their fields for
/// `frame` frames: outside of that, the galpixel saturates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stored {
    /// Pixels a frame.
    pub velocity: f64,
    /// Pixels a frame².
    pub acceleration: f64,
    /// Whether nothing was clamped up to this frame.
    pub fits: bool,
}

impl Stored {
    /// Of a sample in x (0) or y (1). What the layout lacks is 0.
    #[must_use]
    pub fn of(sample: &Sample, axis: usize, bits: Bits, layout: Layout, frame: u32) -> Self {
        if !layout.velocity {
            return Self { velocity: 0.0, acceleration: 0.0, fits: true };
        }
        let component = if axis == 0 { bits.x } else { bits.y };
        let (velocity, fits) = stored(sample.velocity[axis], component.velocity_bits(), component.velocity_frac);
        if !layout.acceleration {
            return Self { velocity, acceleration: 0.0, fits };
        }
        let (acceleration, a_fits) =
            stored(sample.acceleration[axis], component.acceleration_bits(), component.acceleration_frac);
        // The step into frame n uses the velocity of frame n - 1; velocities are monotonic, so the last one decides.
        let last = velocity + acceleration * f64::from(frame.saturating_sub(1));
        let top = 0.5f64.powi(component.velocity_frac as i32 + 1) * 2f64.powi(component.velocity_bits() as i32);
        let within = last >= -top && last <= top - 0.5f64.powi(component.velocity_frac as i32);
        Self { velocity, acceleration, fits: fits && a_fits && within }
    }

    /// Returns the displacement after `frame` frames, in pixels.
    #[must_use]
    pub fn displacement(&self, frame: u32) -> f64 {
        let n = f64::from(frame);
        self.velocity * n + self.acceleration / 2.0 * n * n
    }
}

/// Returns `value` to nearest with `frac` fraction bits, halves upwards, clamped to `bits` bits; and whether it fitted.
fn stored(value: f64, bits: u32, frac: u32) -> (f64, bool) {
    let unit = 2f64.powi(frac as i32);
    let raw = (value * unit + 0.5).floor();
    let top = 2f64.powi(bits as i32 - 1);
    (raw.clamp(-top, top - 1.0) / unit, (-top..=top - 1.0).contains(&raw))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integer_bits_hold_either_sign() {
        // With 2 fraction bits, 1 bit holds -1 ..= 0.75, 2 bits -2 ..= 1.75.
        assert_eq!([0.0, 0.75, 0.76, 1.75, 1.8, 3.9].map(|m| integer_bits(m, 2)), [1, 1, 2, 2, 3, 4]);
    }

    #[test]
    fn a_velocity_that_grows_out_of_its_field_does_not_fit() {
        let component = Component {
            position_frac: 4,
            velocity_int: 3,
            velocity_frac: 2,
            acceleration_int: 2,
            acceleration_frac: 2,
        };
        let bits =
            Bits { x: component, y: component, z: component, depth_int: 8, luminosity_int: 4, luminosity_frac: 4 };
        let sample = Sample { velocity: [2.1, 0.0, 0.0], acceleration: [0.5, 0.0, 0.0], ..Sample::default() };
        let at = |frame| Stored::of(&sample, 0, bits, Layout::FULL, frame);
        // 2.1 is stored as 2.0; 3.75 is the largest that fits: 2 + 0.5 * 3 does, 2 + 0.5 * 4 does not.
        assert_eq!(at(1), Stored { velocity: 2.0, acceleration: 0.5, fits: true });
        assert!(at(4).fits && !at(5).fits);
        assert_eq!(at(4).displacement(4), 12.0);
        assert!(Stored::of(&sample, 0, bits, Layout::VELOCITY565, 100).fits);
    }
}
