//! Stage 1: where each galpixel goes in the next frame, by equations (6) and (7).
//!
//! With time in frames, `r += v + a/2` and `v += a`. The half is not lost: `2v + a` is formed with one fraction bit more
//! than `v` and rounded once, to the position's fraction bits, after the frame's threshold was added (see
//! [`crate::format::rounding`]). The position then snaps to the best-fitting cell, the nearest one (halves towards +infinity), and
//! keeps the rest as its offset.
//!
//! **Cost** a component: 4 additions, 4 shifts and a clamp; no multiplication.

use crate::format::record::{Record, Scale, Words};
use crate::format::rounding::Rounding;
use crate::map::galpixel::Class;

/// Equation (6): the position one frame later, in units of the position's last bit.
///
/// *Ranges:* `v` and `a` within their fields, `threshold` in `0 ..= 2^down - 1`. *Overflow:* none, by
/// [`crate::format::budget::WIDEST_FIELD`], as long as `position` has 30 bits.
#[inline(always)]
#[must_use]
pub const fn step_position(scale: &Scale, threshold: i32, position: i32, v: i32, a: i32) -> i32 {
    let step = (v << 1) + (a << scale.acceleration_up);
    position + (((step + threshold) >> scale.down) << scale.up)
}

/// Equation (7): the velocity one frame later, before it is clamped to its field.
#[inline(always)]
#[must_use]
pub const fn step_velocity(scale: &Scale, v: i32, a: i32) -> i32 {
    v + (a << scale.acceleration_up)
}

/// The velocity clamped to its field: nothing ever wraps.
#[inline(always)]
#[must_use]
pub fn clamp_velocity(scale: &Scale, v: i32) -> i32 {
    let top = (1 << (scale.velocity_bits - 1)) - 1;
    v.min(top).max(!top)
}

/// The best-fitting cell for a position, relative to the cell that its integer part counts from.
#[inline(always)]
#[must_use]
pub const fn snap(scale: &Scale, position: i32) -> i32 {
    (position + ((1 << scale.position_frac) >> 1)) >> scale.position_frac
}

/// The frame's thresholds for x, y and depth.
#[inline(always)]
pub(crate) fn thresholds(record: &Record, rounding: Rounding, frame: u32) -> [i32; 3] {
    let [x, y, z] = &record.scales;
    [rounding.threshold(frame, x.down), rounding.threshold(frame, y.down), rounding.threshold(frame, z.down)]
}

/// What a step did beside changing the words.
pub(crate) struct Step {
    /// Cells moved along the row.
    pub dx: i32,
    /// Cells moved along the column.
    pub dy: i32,
    /// The bits by which velocity x, y, depth and its velocity left their fields; 0 where they did not.
    pub overflowed: [i32; 4],
}

impl Step {
    /// Fields that were clamped.
    #[inline(always)]
    pub fn saturated(&self) -> u32 {
        self.overflowed.iter().map(|&overflowed| (overflowed != 0) as u32).sum()
    }
}

/// Moves one galpixel forward by one frame. The kernel of the engine: knows no image, and does not branch, so that a loop
/// over neighbours becomes vector code.
///
/// Without `CLAMP` a field that strays is said to, and holds rubbish: for callers that take such a step again.
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
    // What was just unobscured is debris from now on.
    let class = record.class().unsigned(words);
    record.class().set(words, class + (class == Class::JustUnobscured as u32) as u32);
    step
}

/// The cells that a galpixel moves in a step, along the row and along the column, and nothing else of it.
#[inline(always)]
pub(crate) fn cells_moved(record: &Record, thresholds: &[i32; 3], words: &Words) -> [i32; 2] {
    if !record.layout().velocity {
        return [0; 2];
    }
    [cells_along(record, thresholds[0], 0, words), cells_along(record, thresholds[1], 1, words)]
}

/// The cells moved in x (0) or y (1).
#[inline(always)]
fn cells_along(record: &Record, threshold: i32, component: usize, words: &Words) -> i32 {
    let scale = &record.scales[component];
    let (v, a) = (record.velocity(component).signed(words), record.acceleration(component).signed(words));
    snap(scale, step_position(scale, threshold, record.offset(component).signed(words), v, a))
}

/// A step in x (0) or y (1): the cells moved, and by which bits the velocity overflowed.
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

/// A step in depth, which saturates at the near and at the far end: by which bits depth and velocity overflowed.
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

/// The velocity of a component after a step: by which bits it overflowed.
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

/// Shading inertia: the luminosity moves by its rate, and whole steps go into the colour's channels, clamped to them.
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

/// A step in x (0) or y (1) of a galpixel that is expected in a cell, `lowest` being the lowest position in it: whether it gets
/// there, and its velocity stays in its field. If not, the words hold rubbish.
#[inline(always)]
pub(crate) fn plane_along<const COMPONENT: usize>(
    record: &Record,
    threshold: i32,
    lowest: i32,
    words: &mut Words,
) -> bool {
    let scale = &record.scales[COMPONENT];
    let offset = record.offset(COMPONENT);
    let Some(step) = step_within(record, COMPONENT, words) else { return false };
    // Of an even step a single bit is dropped without a trace, whatever the threshold.
    let even = !record.layout().acceleration && scale.down == 1;
    let step = if even { step >> 1 } else { (step + threshold) >> scale.down };
    let position = offset.signed(words) + (step << scale.up);
    offset.set(words, position as u32);
    // Whether `snap` gives what is expected, in one comparison.
    (position.wrapping_sub(lowest) as u32) < 1 << scale.position_frac
}

/// A step in depth: whether depth and velocity stay in their fields. If not, the words hold rubbish.
#[inline(always)]
pub(crate) fn depth_within(record: &Record, threshold: i32, words: &mut Words) -> bool {
    let (depth, scale) = (record.depth(), &record.scales[2]);
    let Some(step) = step_within(record, 2, words) else { return false };
    let position = depth.unsigned(words) as i32 + (((step + threshold) >> scale.down) << scale.up);
    depth.set(words, position as u32);
    position as u32 >> depth.bits == 0
}

/// `2v + a` of a component whose velocity stays in its field in the step, which it takes; else nothing.
#[inline(always)]
fn step_within(record: &Record, component: usize, words: &mut Words) -> Option<i32> {
    let (field, scale) = (record.velocity(component), &record.scales[component]);
    let v = field.signed(words);
    if !record.layout().acceleration {
        return Some(v << 1);
    }
    let a = record.acceleration(component).signed(words);
    if let Some(shift) = field.at_top() {
        // At the top of its word the processor's own overflow flag tells whether the sum strays.
        let (word, _) = field.words();
        let (sum, strays) = (words[word] as i32).overflowing_add(a << (scale.acceleration_up + shift));
        words[word] = sum as u32;
        // `2v + a` is the old velocity and the new one.
        return if strays { None } else { Some(v + (sum >> shift)) };
    }
    let velocity = step_velocity(scale, v, a);
    field.set(words, velocity as u32);
    let unused = 32 - scale.velocity_bits;
    if velocity << unused >> unused == velocity { Some(v + velocity) } else { None }
}
