//! Follows a path and splits its error by cause, exactly.
//!
//! Between the true place and the cell shown lie four more places. The distance between two successive places is the
//! share of one cause, so that the shares always add up to the whole error:
//!
//! ```text
//! true motion ─ Taylor ─ exact path of the exact r, v, a ─ quantisation ─ that of r, v, a to nearest
//!     ─ saturation ─ that of the stored r, v, a, clamped where a field ends ─ drift ─ engine ─ snapping ─ cell
//! ```

use galpix_core::Rounding;
use galpix_core::stages::step_position;

use super::exact::Px;
use super::floats::Float;
use super::mover::{Moved, Mover, State};
use super::path::Path;
use super::setting::{Ranges, Setting};

/// The difference between the cell shown and the true place, in pixels: `true - shown` and its shares.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Causes {
    /// What position, velocity and acceleration cannot know.
    pub taylor: Px,
    /// From storing each of them to nearest.
    pub quantisation: Px,
    /// From fields that were clamped, when stored and since.
    pub saturation: Px,
    /// From rounding in each frame.
    pub drift: Px,
    /// From showing a cell.
    pub snapping: Px,
}

impl Causes {
    /// Returns all shares together.
    #[must_use]
    pub fn total(&self) -> Px {
        [self.taylor, self.quantisation, self.saturation, self.drift, self.snapping].into_iter().sum()
    }
}

/// One frame of a path.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Frames since the first update.
    pub frame: u32,
    /// Frames since the last update.
    pub since: u32,
    /// The true place.
    pub place: Px,
    /// The cell shown, in depth the position.
    pub shown: Px,
    /// What parts them.
    pub causes: Causes,
    /// Whether a field has been clamped since the last update.
    pub saturated: bool,
    /// Whether the stored acceleration is 0.
    pub steady: bool,
    /// What the same scheme in `f32` is off from the exact path of the exact r, v, a, in pixels.
    pub f32_px: f64,
    /// The same in `f64`.
    pub f64_px: f64,
}

/// A path followed to its end.
#[derive(Clone, Debug, Default)]
pub struct Followed {
    /// Frame by frame, from the first update on.
    pub rows: Vec<Row>,
    /// Fields that the engine counted as clamped.
    pub clamped: u32,
    /// What the engine did and may not do, one sentence each: for each kind the first time.
    pub findings: Vec<String>,
    /// Whether each update entered at frame 0 of the counter.
    pub aligned: bool,
}

impl Followed {
    fn found(&mut self, frame: u32, what: &str) {
        if !self.findings.iter().any(|finding| finding.contains(what)) {
            self.findings.push(format!("{what} (frame {frame})"));
        }
    }
}

/// The path that the engine should take, exactly.
struct Reference {
    since: u32,
    /// Position, velocity and acceleration as handed over.
    exact: [Px; 3],
    /// The same to nearest.
    nearest: [Px; 3],
    /// The position that nothing rounds; velocities and depths that leave their fields are clamped.
    position: Px,
    /// Position, velocity and acceleration as stored, in last bits.
    raw: [i64; 3],
    saturated: bool,
}

impl Reference {
    /// After an update; and how many fields of velocity and acceleration were clamped.
    fn load(exact: [Px; 3], ranges: &Ranges) -> (Self, u32) {
        let fracs = fracs(ranges);
        let nearest = [0, 1, 2].map(|field| exact[field].nearest(fracs[field]));
        let end = |value: i64, top: i64| value.clamp(-1 - top, top);
        let raw = [
            ranges.far.map_or(nearest[0], |far| nearest[0].clamp(0, far)),
            end(nearest[1], ranges.velocity_top),
            end(nearest[2], ranges.acceleration_top),
        ];
        let clamped = u32::from(raw[1] != nearest[1]) + u32::from(raw[2] != nearest[2]);
        let px = |values: [i64; 3]| [0, 1, 2].map(|field| Px::of(values[field], fracs[field]));
        let reference = Self {
            since: 0,
            exact,
            nearest: px(nearest),
            position: Px::of(raw[0], fracs[0]),
            raw,
            saturated: raw != nearest,
        };
        (reference, clamped)
    }

    /// Returns one frame later; and how many fields were clamped. `threshold` and `before`: of the engine, whose depth
    /// ends where it would leave its range.
    fn step(&mut self, ranges: &Ranges, threshold: i32, before: State) -> u32 {
        let scale = &ranges.scale;
        let [_, v, a] = self.raw;
        self.position += Px::of(v, scale.velocity_frac) + Px::of(a, scale.acceleration_frac).accelerated(1);
        let mut clamped = 0;
        if let Some(far) = ranges.far {
            let next = i64::from(step_position(scale, threshold, before.position as i32, v as i32, a as i32));
            self.position -= Px::of(next - next.clamp(0, far), scale.position_frac);
            clamped += u32::from(next != next.clamp(0, far));
        }
        let next = v + (a << scale.acceleration_up);
        self.raw[1] = next.clamp(-1 - ranges.velocity_top, ranges.velocity_top);
        clamped += u32::from(self.raw[1] != next);
        self.since += 1;
        self.saturated |= clamped > 0;
        clamped
    }

    fn causes(&self, place: Px, state: State, ranges: &Ranges) -> Causes {
        let along = |[r, v, a]: [Px; 3]| r + v.times(self.since) + a.accelerated(self.since);
        let (exact, nearest) = (along(self.exact), along(self.nearest));
        let engine = Px::of(state.position, ranges.scale.position_frac);
        Causes {
            taylor: place - exact,
            quantisation: exact - nearest,
            saturation: nearest - self.position,
            drift: self.position - engine,
            snapping: engine - shown(state, ranges),
        }
    }
}

fn fracs(ranges: &Ranges) -> [u32; 3] {
    let scale = &ranges.scale;
    [scale.position_frac, scale.velocity_frac, scale.acceleration_frac]
}

/// Returns the cell that a state shows; a depth is not snapped.
fn shown(state: State, ranges: &Ranges) -> Px {
    if ranges.far.is_some() { Px::of(state.position, ranges.scale.position_frac) } else { Px::of(state.cell, 0) }
}

/// Follows a path with something that moves it.
pub fn follow(path: &Path, setting: &Setting, rounding: Rounding, mover: &mut dyn Mover) -> Followed {
    let ranges = setting.ranges(path.component);
    let followed = Followed { aligned: path.counter == 0, ..Followed::default() };
    let mut follower = Follower { path, setting, ranges, followed };
    let mut counter = path.counter;
    let mut at = follower.load(0, mover);
    follower.push(0, &at);
    for frame in 1..=path.frames {
        let Some(moved) = mover.step(counter) else {
            follower.followed.found(frame, "the galpixel is nowhere");
            break;
        };
        let threshold = rounding.threshold(counter, ranges.scale.down);
        counter = counter.wrapping_add(1);
        let expected = at.reference.step(&ranges, threshold, at.state);
        follower.check(frame, at.state, moved, expected);
        at.state = moved.state;
        at.floats.0.step();
        at.floats.1.step();
        follower.push(frame, &at);
        if path.every.is_some_and(|every| frame % every.max(1) == 0) && frame < path.frames {
            at = follower.load(frame, mover);
            // A searched table is aligned with the updates, as `Controller::set_frame` advises.
            counter = if rounding == Rounding::Searched { 0 } else { counter };
        }
    }
    follower.followed
}

/// A galpixel on its path, exactly, in the engine and in floats.
struct Along {
    reference: Reference,
    state: State,
    floats: (Float<f32>, Float<f64>),
}

/// A path, and what was found on it.
struct Follower<'p> {
    path: &'p Path,
    setting: &'p Setting,
    ranges: Ranges,
    followed: Followed,
}

impl Follower<'_> {
    /// Stores what an update hands over at a frame.
    fn load(&mut self, frame: u32, mover: &mut dyn Mover) -> Along {
        let Self { path, setting, ranges, followed } = self;
        let given = path.given(setting, frame);
        let (reference, clamped) = Reference::load(given.exact, ranges);
        let moved = mover.load(&given);
        let state = moved.state;
        if [state.position, state.velocity, state.acceleration] != reference.raw {
            followed.found(frame, "a stored field is not the nearest that it can hold");
        }
        if moved.clamped != clamped {
            followed.found(frame, "a clamped field was not counted");
        }
        followed.clamped = followed.clamped.saturating_add(moved.clamped);
        Along { reference, state, floats: (Float::<f32>::load(given.exact), Float::<f64>::load(given.exact)) }
    }

    /// Notes a frame.
    fn push(&mut self, frame: u32, Along { reference, state, floats }: &Along) {
        let place = self.path.place(frame);
        let [r, v, a] = reference.exact;
        let exact = r + v.times(reference.since) + a.accelerated(reference.since);
        self.followed.rows.push(Row {
            frame,
            since: reference.since,
            place,
            shown: shown(*state, &self.ranges),
            causes: reference.causes(place, *state, &self.ranges),
            saturated: reference.saturated,
            steady: reference.raw[2] == 0,
            f32_px: floats.0.off_px(exact),
            f64_px: floats.1.off_px(exact),
        });
    }

    /// What a step may never do, whatever the arithmetic: wrap, leave a field, or clamp and not count it.
    fn check(&mut self, frame: u32, before: State, moved: Moved, clamped: u32) {
        let Self { ranges, followed, .. } = self;
        let (scale, state) = (&ranges.scale, moved.state);
        // 2v + a of the largest fields, in the position's last bits and one more for what was rounded.
        let lift = |steps: i64| ((steps << scale.up) >> scale.down) + 1;
        let most = lift(2 * (ranges.velocity_top + 1) + ((ranges.acceleration_top + 1) << scale.acceleration_up));
        if (state.position - before.position).abs() > most {
            followed.found(frame, "the position jumped farther than the largest velocity allows: it wrapped");
        }
        if (state.velocity - before.velocity).abs() > before.acceleration.abs() << scale.acceleration_up {
            followed.found(frame, "the velocity changed by more than the acceleration: it wrapped");
        }
        if !(-1 - ranges.velocity_top..=ranges.velocity_top).contains(&state.velocity) {
            followed.found(frame, "the velocity is beyond its field");
        }
        if moved.clamped != clamped {
            followed.found(frame, "a clamped field was not counted");
        }
        followed.clamped = followed.clamped.saturating_add(moved.clamped);
    }
}
