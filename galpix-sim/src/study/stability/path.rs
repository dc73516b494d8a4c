//! A path: one component of one galpixel, its true motion, and when updates come.

use fixed::types::I32F32;
use galpix_core::Galpixel;

use super::exact::Px;
use super::setting::Setting;

/// A true motion in closed form: from a time in frames to position, velocity and acceleration.
pub type Analytic = Box<dyn Fn(f64) -> [f64; 3] + Send + Sync>;

/// How something moves, in cells and frames (in depth: bins).
pub enum Motion {
    /// Position, velocity and acceleration at time 0, and nothing beyond: exact.
    SecondOrder([Px; 3]),
    /// In floating point; its position counts as exact once it is taken to the nearest 2^-40 of a cell.
    Analytic(Analytic),
}

/// One component of one moving galpixel.
pub struct Path {
    /// What distinguishes it from the others of its case.
    pub name: String,
    /// x (0), y (1) or depth (2).
    pub component: usize,
    /// The true motion.
    pub motion: Motion,
    /// Frames that it is followed for.
    pub frames: u32,
    /// Frames from one update to the next; the first one alone if absent.
    pub every: Option<u32>,
    /// The frame counter when the first update enters.
    pub counter: u32,
}

/// What an update hands over: numbers in fixed point of 32 fraction bits, and what they are in cells.
pub struct Given {
    /// The cell that the galpixel is stored in.
    pub cell: i64,
    /// The galpixel.
    pub galpixel: Galpixel,
    /// Position, velocity and acceleration, exactly.
    pub exact: [Px; 3],
}

impl Path {
    /// Creates a path from one update on.
    pub fn new(name: impl Into<String>, component: usize, motion: Motion, frames: u32) -> Self {
        Self { name: name.into(), component, motion, frames, every: None, counter: 0 }
    }

    /// With an update every so many frames.
    #[must_use]
    pub fn every(self, frames: u32) -> Self {
        Self { every: Some(frames), ..self }
    }

    /// With another start of the frame counter.
    #[must_use]
    pub fn from_counter(self, counter: u32) -> Self {
        Self { counter, ..self }
    }

    /// Returns the true position.
    #[must_use]
    pub fn place(&self, time: u32) -> Px {
        match &self.motion {
            Motion::SecondOrder([r, v, a]) => *r + v.times(time) + a.accelerated(time),
            Motion::Analytic(at) => Px::near(at(time.into())[0]),
        }
    }

    /// Returns what an update at `time` hands over.
    #[must_use]
    pub fn given(&self, setting: &Setting, time: u32) -> Given {
        let [r, v, a] = match &self.motion {
            Motion::SecondOrder([_, v, a]) => [self.place(time), *v + a.times(time), *a],
            Motion::Analytic(at) => {
                let [_, v, a] = at(time.into());
                [self.place(time), Px::near(v), Px::near(a)]
            }
        };
        let unit = setting.unit(self.component);
        let number = |value: Px| I32F32::saturating_from_num(value.to_f64() / f64::from(1u32 << unit));
        let mut galpixel = Galpixel::default();
        galpixel.velocity[self.component] = number(v);
        galpixel.acceleration[self.component] = number(a);
        let exact = |value: I32F32| Px::given(value, unit);
        let (cell, r) = if self.component == 2 {
            galpixel.depth = number(r);
            (0, exact(galpixel.depth))
        } else {
            // The cell is that of the stored position, so that no offset has to be clamped to its cell.
            let frac = setting.record.scales[self.component].position_frac;
            let cell = (r.nearest(frac) + (1 << frac >> 1)) >> frac;
            galpixel.offset[self.component] = number(r - Px::of(cell, 0));
            (cell, Px::of(cell, 0) + exact(galpixel.offset[self.component]))
        };
        let exact = [r, exact(galpixel.velocity[self.component]), exact(galpixel.acceleration[self.component])];
        Given { cell, galpixel, exact }
    }
}
