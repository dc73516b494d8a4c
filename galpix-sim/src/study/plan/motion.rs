//! Fields and bits in the plane: what leaving a field out costs at most, and the certificate of what is left.

use galpix_core::Rounding;
use galpix_core::record::{Component, WIDEST_FIELD};
use schemars::JsonSchema;
use serde::Serialize;

use super::extremes::{Extremes, Reach};
use crate::certificate::{Unreachable, smallest};

/// One axis of the plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Axis {
    /// What leaving fields out costs at most, in pixels.
    pub left_out_px: f64,
    /// What storing and rounding cost at most, in pixels; 0 where every value is stored exactly.
    pub arithmetic_px: f64,
    #[serde(flatten, with = "Widths")]
    pub(crate) component: Component,
}

/// [`Component`] as it is written to JSON.
#[derive(Serialize, JsonSchema)]
#[serde(remote = "Component")]
struct Widths {
    position_frac: u32,
    velocity_int: u32,
    velocity_frac: u32,
    acceleration_int: u32,
    acceleration_frac: u32,
}

impl Axis {
    /// Returns the certified error, in pixels.
    #[must_use]
    pub fn certified_px(&self) -> f64 {
        self.left_out_px + self.arithmetic_px
    }
}

/// Fields and bits in the plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Motion {
    /// Whether there is a velocity.
    pub velocity: bool,
    /// Whether there is an acceleration.
    pub acceleration: bool,
    /// Along a row.
    pub x: Axis,
    /// Along a column.
    pub y: Axis,
    /// The name of the rounding.
    pub rounding: &'static str,
    /// The certificate of both axes, in pixels: the larger of the two.
    pub certified_px: f64,
}

/// A component without motion: only what the layout needs for each component is stored.
const STILL: Component =
    Component { position_frac: 0, velocity_int: 1, velocity_frac: 0, acceleration_int: 0, acceleration_frac: 0 };

impl Motion {
    /// Creates the fewest bits that keep `max_error` pixels for `frames` frames.
    ///
    /// *Errors:* if no budget does.
    pub fn for_error(extremes: &Extremes, frames: u32, max_error: f64) -> Result<Self, Unreachable> {
        let farthest = extremes.x.distance_px.max(extremes.y.distance_px);
        if farthest <= max_error {
            let still = |reach: &Reach| Axis { left_out_px: reach.distance_px, arithmetic_px: 0.0, component: STILL };
            return Ok(Self::of(false, false, still(&extremes.x), still(&extremes.y), Rounding::default()));
        }
        let mut best: Option<Self> = None;
        let mut refusal = None;
        for acceleration in [false, true] {
            // Of equally many bits the first stands: the default.
            for rounding in [Rounding::LowDiscrepancy, Rounding::Searched, Rounding::Nearest, Rounding::Truncate] {
                let axis = |reach: &Reach| axis(reach, acceleration, rounding, frames, max_error);
                match axis(&extremes.x).and_then(|x| Ok((x, axis(&extremes.y)?))) {
                    Ok((x, y)) => {
                        let motion = Self::of(true, acceleration, x, y, rounding);
                        if best.as_ref().is_none_or(|best| motion.bits() < best.bits()) {
                            best = Some(motion);
                        }
                    }
                    Err(error) => refusal = refusal.or(error),
                }
            }
        }
        let nothing = Unreachable { asked: max_error, prop: frames, rounding: Rounding::default(), best: f64::NAN };
        best.ok_or(refusal.unwrap_or(nothing))
    }

    fn of(velocity: bool, acceleration: bool, x: Axis, y: Axis, rounding: Rounding) -> Self {
        let certified_px = x.certified_px().max(y.certified_px());
        Self { velocity, acceleration, x, y, rounding: rounding.name(), certified_px }
    }

    fn bits(&self) -> u32 {
        self.x.component.motion_bits() + self.y.component.motion_bits()
    }

    /// Returns the rounding.
    pub(crate) fn rounding(&self) -> Rounding {
        Rounding::ALL.into_iter().find(|rounding| rounding.name() == self.rounding).unwrap_or_default()
    }

    /// Returns why the fields of the plane are kept or left out.
    pub(crate) fn reasons(&self, extremes: &Extremes, max_error: f64) -> Vec<String> {
        let [distance, by_acceleration] = [
            extremes.x.distance_px.max(extremes.y.distance_px),
            extremes.x.by_acceleration_px.max(extremes.y.by_acceleration_px),
        ];
        let mut reasons = Vec::new();
        reasons.push(match self.velocity {
            false => format!("velocity is left out: nothing moves by more than {distance:.3} of {max_error} px"),
            true => format!("velocity is kept: something moves by {distance:.1} px"),
        });
        if self.velocity {
            reasons.push(match self.acceleration {
                false => format!("acceleration is left out: it carries nothing farther than {by_acceleration:.3} px"),
                true => format!("acceleration is kept: it carries something {by_acceleration:.2} px"),
            });
        }
        reasons
    }
}

/// Returns the fewest bits of one axis; what left-out accelerations cost is taken off the error first.
///
/// *Errors:* `None` where leaving the acceleration out costs too much, else why no budget does.
fn axis(
    reach: &Reach,
    acceleration: bool,
    rounding: Rounding,
    frames: u32,
    max_error: f64,
) -> Result<Axis, Option<Unreachable>> {
    let left_out_px = if acceleration { 0.0 } else { reach.by_acceleration_px };
    let left = max_error - left_out_px;
    if left <= 0.0 {
        return Err(None);
    }
    if reach.distance_px == 0.0 {
        let component = Component { acceleration_int: u32::from(acceleration), ..STILL };
        return Ok(Axis { left_out_px, arithmetic_px: 0.0, component });
    }
    // Without an acceleration a velocity stays as it was stored.
    let integer = |value: f64| integer_bits(value, if acceleration { 2.0 } else { 0.5 });
    let ranges = Component {
        velocity_int: integer(reach.speed),
        acceleration_int: if acceleration { integer_bits(reach.acceleration, 0.5) } else { 0 },
        ..STILL
    };
    let (component, certificate) = smallest(ranges, rounding, frames, left).map_err(Some)?;
    Ok(Axis { left_out_px, arithmetic_px: certificate.total_px, component })
}

/// Returns integer bits, sign included, that hold values of this size with `room` pixels per frame to spare.
fn integer_bits(value: f64, room: f64) -> u32 {
    let needed = (value + room).log2().ceil().max(0.0) as u32 + 1;
    needed.min(WIDEST_FIELD)
}
