//! Stage 1: propagates galpixels by one frame, equations (6) and (7).
//!
//! With time in frames, `r += v + a/2` and `v += a`. The half is not lost: `2v + a` has one fraction bit more than `v`,
//! and is rounded once, to the position's fraction bits, after the frame's threshold was added (see
//! [`crate::format::rounding`]). The galpixel then belongs to the best-fitting cell, which is the nearest one (halves
//! towards +infinity), and the difference is stored as its offset.
//!
//! *Cost* per component: 4 additions, 4 shifts and a clamp; no multiplication.

use crate::format::record::{Record, Scale, Words};
use crate::format::rounding::Rounding;
use crate::map::galpixel::Class;

/// Returns the position one frame later, equation (6), in units of the position's last bit.
///
/// *Ranges:* `v` and `a` within their fields, `threshold` in `0 ..= 2^down - 1`. Nothing overflows if `position` has at
/// most 30 bits, because of [`WIDEST_FIELD`](crate::record::WIDEST_FIELD).
///
/// *Rounding:* `threshold` is added to `2v + a`, then `down` bits are dropped.
#[inline(always)]
#[must_use]
pub const fn step_position(scale: &Scale, threshold: i32, position: i32, v: i32, a: i32) -> i32 {
    let step = (v << 1) + (a << scale.acceleration_up);
    position + (((step + threshold) >> scale.down) << scale.up)
}

/// Returns the velocity one frame later, equation (7), not yet clamped to its field.
#[inline(always)]
#[must_use]
pub const fn step_velocity(scale: &Scale, v: i32, a: i32) -> i32 {
    v + (a << scale.acceleration_up)
}

/// Returns the velocity clamped to the range of its field.
#[inline(always)]
#[must_use]
pub fn clamp_velocity(scale: &Scale, v: i32) -> i32 {
    let top = (1 << (scale.velocity_bits - 1)) - 1;
    v.min(top).max(!top)
}

/// Returns the best-fitting cell of a position, relative to the cell that `position` is relative to.
///
/// *Rounding:* to nearest, halves towards +infinity.
#[inline(always)]
#[must_use]
pub const fn snap(scale: &Scale, position: i32) -> i32 {
    (position + ((1 << scale.position_frac) >> 1)) >> scale.position_frac
}

/// Returns an offset with `frac` fraction bits in `2^PARTS` parts of a cell.
///
/// *Rounding:* to nearest, halves upwards; exact with up to `PARTS` fraction bits.
#[inline(always)]
#[must_use]
pub(crate) const fn parts<const PARTS: u32>(offset: i32, frac: u32) -> i32 {
    if frac <= PARTS { offset << (PARTS - frac) } else { (offset + (1 << (frac - PARTS) >> 1)) >> (frac - PARTS) }
}

/// Returns the frame's rounding thresholds for x, y and depth.
#[inline(always)]
pub(crate) fn thresholds(record: &Record, rounding: Rounding, frame: u32) -> [i32; 3] {
    let [x, y, z] = &record.scales;
    [rounding.threshold(frame, x.down), rounding.threshold(frame, y.down), rounding.threshold(frame, z.down)]
}

/// What a step did besides changing the words.
pub(crate) struct Step {
    /// Cells moved along the row.
    pub dx: i32,
    /// Cells moved along the column.
    pub dy: i32,
    /// For the velocities in x and y, the depth and the velocity in depth: 0 if the value stayed in its field.
    pub overflowed: [i32; 4],
}

impl Step {
    /// Returns the number of fields that left their range.
    #[inline(always)]
    pub fn saturated(&self) -> u32 {
        self.overflowed.iter().map(|&overflowed| (overflowed != 0) as u32).sum()
    }
}

/// Propagates a galpixel by one frame.
///
/// With `CLAMP`, velocities and depth that leave their fields are clamped. Without it they are only reported, in
/// [`Step::overflowed`], and the words are unspecified: such a caller repeats the step with `CLAMP`. Free of branches,
/// so that loops over neighbours become vector code.
#[inline(always)]
pub(crate) fn advance<const CLAMP: bool>(record: &Record, thresholds: &[i32; 3], words: &mut Words) -> Step {
    let mut step = Step { dx: 0, dy: 0, overflowed: [0; 4] };
    if record.layout().velocity {
        (step.dx, step.overflowed[0]) = step_plane::<CLAMP>(record, thresholds[0], 0, words);
        (step.dy, step.overflowed[1]) = step_plane::<CLAMP>(record, thresholds[1], 1, words);
    }
    if record.layout().depth_motion {
        (step.overflowed[2], step.overflowed[3]) = step_depth::<CLAMP>(record, thresholds[2], words);
    }
    if record.layout().luminosity {
        step_luminosity(record, words);
    }
    // Just-unobscured becomes debris.
    let class = record.class().unsigned(words);
    record.class().set(words, class + (class == Class::JustUnobscured as u32) as u32);
    step
}

/// Returns the cells that a step moves a galpixel in x and y, without making the step.
#[inline(always)]
pub(crate) fn cells_moved(record: &Record, thresholds: &[i32; 3], words: &Words) -> [i32; 2] {
    if !record.layout().velocity {
        return [0; 2];
    }
    [cells_along(record, thresholds[0], 0, words), cells_along(record, thresholds[1], 1, words)]
}

/// Returns the cells that a step moves a galpixel in x (0) or y (1).
#[inline(always)]
fn cells_along(record: &Record, threshold: i32, component: usize, words: &Words) -> i32 {
    let scale = &record.scales[component];
    let (v, a) = (record.velocity(component).signed(words), record.acceleration(component).signed(words));
    snap(scale, step_position(scale, threshold, record.offset(component).signed(words), v, a))
}

/// Makes a step in x (0) or y (1). Returns the cells moved, and a number that is not 0 if the velocity overflowed.
#[inline(always)]
fn step_plane<const CLAMP: bool>(record: &Record, threshold: i32, component: usize, words: &mut Words) -> (i32, i32) {
    let scale = &record.scales[component];
    let offset = record.offset(component);
    let (v, a) = (record.velocity(component).signed(words), record.acceleration(component).signed(words));
    let position = step_position(scale, threshold, offset.signed(words), v, a);
    // The field keeps the low bits, which are those of `position - (cells << position_frac)`.
    offset.set(words, position as u32);
    (snap(scale, position), set_velocity::<CLAMP>(record, component, words, v, a))
}

/// Makes a step in depth. Returns two numbers that are not 0 if the depth and its velocity overflowed.
#[inline(always)]
fn step_depth<const CLAMP: bool>(record: &Record, threshold: i32, words: &mut Words) -> (i32, i32) {
    let far = ((1u32 << record.depth().bits) - 1) as i32;
    let (v, a) = (record.velocity(2).signed(words), record.acceleration(2).signed(words));
    let depth = record.depth().unsigned(words) as i32;
    let position = step_position(&record.scales[2], threshold, depth, v, a);
    let within = if CLAMP { position.min(far).max(0) } else { position };
    record.depth().set(words, within as u32);
    let overflowed = if CLAMP { position ^ within } else { position & !far };
    (overflowed, set_velocity::<CLAMP>(record, 2, words, v, a))
}

/// Sets the velocity of a component after a step. Returns a number that is not 0 if the velocity overflowed.
#[inline(always)]
fn set_velocity<const CLAMP: bool>(record: &Record, component: usize, words: &mut Words, v: i32, a: i32) -> i32 {
    if !record.layout().acceleration {
        return 0;
    }
    let scale = &record.scales[component];
    let velocity = step_velocity(scale, v, a);
    let unused = 32 - scale.velocity_bits;
    let kept = if CLAMP { clamp_velocity(scale, velocity) } else { velocity << unused >> unused };
    record.velocity(component).set(words, kept as u32);
    velocity ^ kept
}

/// Applies shading inertia: adds the luminosity rate, and whole steps of luminosity to the colour, each channel
/// clamped.
#[inline(always)]
pub(crate) fn step_luminosity(record: &Record, words: &mut Words) {
    if !record.luminosity_rate().present() {
        return;
    }
    let level = record.luminosity().unsigned(words) as i32 + record.luminosity_rate().signed(words);
    record.luminosity().set(words, level as u32);
    let colour = record.colour().unsigned(words);
    record.colour().set(words, record.colour_format().brightened(colour, level >> record.luminosity_frac));
}

/// Makes a step in x (0) or y (1) of a galpixel that is expected to arrive in a given cell. Returns whether it does and
/// its velocity stays in its field; if not, the words are unspecified.
///
/// `lowest` is the lowest position that belongs to the cell, relative to the galpixel's own cell.
#[inline(always)]
pub(crate) fn step_plane_to<const COMPONENT: usize>(
    record: &Record,
    threshold: i32,
    lowest: i32,
    words: &mut Words,
) -> bool {
    let scale = &record.scales[COMPONENT];
    let offset = record.offset(COMPONENT);
    let Some(step) = step_velocity_within(record, COMPONENT, words) else { return false };
    // Without acceleration the step is even: if one bit is dropped, it is 0, and the threshold does not matter.
    let even = !record.layout().acceleration && scale.down == 1;
    let step = if even { step >> 1 } else { (step + threshold) >> scale.down };
    let position = offset.signed(words) + (step << scale.up);
    offset.set(words, position as u32);
    // One comparison decides whether `snap` gives the expected cell.
    (position.wrapping_sub(lowest) as u32) < 1 << scale.position_frac
}

/// Makes a step in depth. Returns whether depth and velocity stay in their fields; if not, the words are unspecified.
#[inline(always)]
pub(crate) fn step_depth_within(record: &Record, threshold: i32, words: &mut Words) -> bool {
    let (depth, scale) = (record.depth(), &record.scales[2]);
    let Some(step) = step_velocity_within(record, 2, words) else { return false };
    let position = depth.unsigned(words) as i32 + (((step + threshold) >> scale.down) << scale.up);
    depth.set(words, position as u32);
    position as u32 >> depth.bits == 0
}

/// Makes the step of a component's velocity and returns `2v + a` of the velocity before the step; `None` if the
/// velocity does not stay in its field.
#[inline(always)]
fn step_velocity_within(record: &Record, component: usize, words: &mut Words) -> Option<i32> {
    let (field, scale) = (record.velocity(component), &record.scales[component]);
    let v = field.signed(words);
    if !record.layout().acceleration {
        return Some(v << 1);
    }
    let a = record.acceleration(component).signed(words);
    if let Some(shift) = field.at_top() {
        // At the top of its word, the velocity overflows exactly if the sum overflows 32 bits, which a processor flag
        // reports.
        let (word, _) = field.words();
        let (sum, overflows) = (words[word] as i32).overflowing_add(a << (scale.acceleration_up + shift));
        words[word] = sum as u32;
        // `2v + a` is the sum of the old velocity and the new one.
        return if overflows { None } else { Some(v + (sum >> shift)) };
    }
    let velocity = step_velocity(scale, v, a);
    field.set(words, velocity as u32);
    let unused = 32 - scale.velocity_bits;
    if velocity << unused >> unused == velocity { Some(v + velocity) } else { None }
}
