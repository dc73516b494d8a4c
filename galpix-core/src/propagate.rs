//! Stage 1: where each galpixel goes in the next frame, by equations (6) and (7).
//!
//! With time in frames, `r += v + a/2` and `v += a`. The half is not lost: `2v + a` is formed with one fraction bit more
//! than `v` and rounded once, to the position's fraction bits, after the frame's threshold was added (see
//! [`crate::rounding`]). The position then snaps to the best-fitting cell, the nearest one (halves towards +infinity), and
//! keeps the rest as its offset.
//!
//! **Cost** a component: 4 additions, 4 shifts and a clamp; no multiplication.

use crate::galpixel::{Budget, Class};
use crate::galpixmap::Galpixmap;
use crate::layout::Layout;
use crate::record::{Block, MAX_WORDS, Record, Scale};
use crate::rounding::Rounding;

/// Equation (6): the position one frame later, in units of the position's last bit.
///
/// *Ranges:* `v` and `a` within their fields, `threshold` in `0 ..= 2^down - 1`. *Overflow:* none, by
/// [`crate::budget::WIDEST_FIELD`], as long as `position` has 30 bits.
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

/// `N` galpixels after a step.
pub(crate) struct Moved<const N: usize> {
    /// The words as they will be stored.
    pub block: Block<N>,
    /// Cells moved along the row.
    pub dx: [i32; N],
    /// Cells moved along the column.
    pub dy: [i32; N],
    /// The bits by which velocity x, y, depth and its velocity left their fields; 0 where they did not.
    pub strayed: [[i32; N]; 4],
}

impl<const N: usize> Moved<N> {
    /// Fields of a lane that were clamped.
    #[inline(always)]
    pub fn saturated(&self, lane: usize) -> u32 {
        self.strayed.iter().filter(|strayed| strayed[lane] != 0).count() as u32
    }
}

/// Moves `N` galpixels forward by one frame. The kernel of the engine: knows no image; empty cells pass through.
#[inline(always)]
pub(crate) fn advance<L: Layout, const N: usize>(
    record: &Record,
    thresholds: &[i32; 3],
    mut block: Block<N>,
) -> Moved<N> {
    let (mut dx, mut dy, mut strayed) = ([0; N], [0; N], [[0; N]; 4]);
    if L::LANES.velocity {
        let (offset, cells) = step_plane(record, thresholds[0], 0, &mut block, &mut strayed);
        dx = cells;
        record.offset_x().set(&mut block, &offset);
        let (offset, cells) = step_plane(record, thresholds[1], 1, &mut block, &mut strayed);
        dy = cells;
        record.offset_y().set(&mut block, &offset);
    }
    if L::LANES.depth_motion {
        step_depth(record, thresholds[2], &mut block, &mut strayed);
    }
    if L::LANES.luminosity {
        step_luminosity::<L, N>(record, &mut block);
    }
    // What was just unobscured is debris from now on.
    let mut class = record.class().unsigned(&block);
    for class in &mut class {
        *class += (*class == Class::JustUnobscured as u32) as u32;
    }
    record.class().set(&mut block, &class);
    Moved { block, dx, dy, strayed }
}

/// A step in x (0) or y (1): the new offsets and the cells moved.
#[inline(always)]
fn step_plane<const N: usize>(
    record: &Record,
    threshold: i32,
    component: usize,
    block: &mut Block<N>,
    strayed: &mut [[i32; N]; 4],
) -> ([u32; N], [i32; N]) {
    let scale = &record.scales[component];
    let offset = if component == 0 { record.offset_x() } else { record.offset_y() }.signed(block);
    let (v, a) = (record.velocity(component).signed(block), record.acceleration(component).signed(block));
    let (mut offsets, mut cells, mut velocities) = ([0; N], [0; N], [0; N]);
    for lane in 0..N {
        let position = step_position(scale, threshold, offset[lane], v[lane], a[lane]);
        let velocity = step_velocity(scale, v[lane], a[lane]);
        let clamped = clamp_velocity(scale, velocity);
        strayed[component][lane] = velocity ^ clamped;
        // The field keeps the low bits, which are those of `position - (cells << position_frac)`.
        offsets[lane] = position as u32;
        cells[lane] = snap(scale, position);
        velocities[lane] = clamped as u32;
    }
    if record.acceleration(component).present() {
        record.velocity(component).set(block, &velocities);
    }
    (offsets, cells)
}

/// A step in depth, which saturates at the near and at the far end.
#[inline(always)]
fn step_depth<const N: usize>(record: &Record, threshold: i32, block: &mut Block<N>, strayed: &mut [[i32; N]; 4]) {
    let scale = &record.scales[2];
    let far = ((1u32 << record.depth().bits) - 1) as i32;
    let depth = record.depth().unsigned(block);
    let (v, a) = (record.velocity(2).signed(block), record.acceleration(2).signed(block));
    let (mut depths, mut velocities) = ([0; N], [0; N]);
    for lane in 0..N {
        let position = step_position(scale, threshold, depth[lane] as i32, v[lane], a[lane]);
        let within = position.min(far).max(0);
        let velocity = step_velocity(scale, v[lane], a[lane]);
        let clamped = clamp_velocity(scale, velocity);
        strayed[2][lane] = position ^ within;
        strayed[3][lane] = velocity ^ clamped;
        depths[lane] = within as u32;
        velocities[lane] = clamped as u32;
    }
    record.depth().set(block, &depths);
    if record.acceleration(2).present() {
        record.velocity(2).set(block, &velocities);
    }
}

/// Shading inertia: the luminosity moves by its rate, and whole steps go into the colour's channels, clamped to them.
#[inline(always)]
fn step_luminosity<L: Layout, const N: usize>(record: &Record, block: &mut Block<N>) {
    use crate::colour::Colour;
    let rate = record.luminosity_rate().signed(block);
    let fraction = record.luminosity().unsigned(block);
    let mut colour = record.colour().unsigned(block);
    let mut fractions = [0; N];
    for lane in 0..N {
        let level = fraction[lane] as i32 + rate[lane];
        fractions[lane] = level as u32;
        colour[lane] = L::Colour::brightened(colour[lane], level >> record.luminosity_frac);
    }
    record.luminosity().set(block, &fractions);
    record.colour().set(block, &colour);
}

/// A galpixel on its way: the only thing that crosses from propagation to resolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrival {
    /// The cell that it wants; `None` if it left the map over its border.
    pub cell: Option<u32>,
    /// The cell that it comes from.
    pub source: u32,
    /// Its words as they will be stored.
    pub words: [u32; MAX_WORDS],
    /// Its fields that were clamped.
    pub saturated: u32,
}

/// The arrivals of all galpixels and debris of a map, lazily, in raster order.
pub fn arrivals<'m, L: Layout, B: Budget<L>>(
    front: &'m Galpixmap<'_, L, B>,
    rounding: Rounding,
    frame: u32,
) -> impl Iterator<Item = Arrival> + 'm {
    let grid = *front.grid();
    let record = front.record();
    let thresholds = thresholds(record, rounding, frame);
    grid.starts().iter().enumerate().flat_map(move |(y, &start)| {
        (0..grid.width()).filter_map(move |x| {
            let source = start + x;
            let block = front.block::<1>(source)?;
            if record.class().unsigned(&block)[0] == Class::Empty as u32 {
                return None;
            }
            let moved = advance::<L, 1>(record, &thresholds, block);
            let cell = grid.cell(x as i32 + moved.dx[0], y as i32 + moved.dy[0]);
            Some(Arrival { cell, source, words: moved.block.map(|[word]| word), saturated: moved.saturated(0) })
        })
    })
}
