//! What galpixels buy: an update every N frames with the display moving between, compared with sample-and-hold at the
//! same rates.
//!
//! A scene is rendered anew at every N-th frame; the picture of an update itself is without error, so that every frame
//! of the display counts once at each rate. A capture has one update: it is compared with its true pictures by age
//! instead.

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use super::causes::Pair;
use crate::engine::{Engine, EngineError};
use crate::metric;
use crate::picture::Picture;
use crate::source::scene::{self, Scene};

/// Updates every so many frames.
const EVERY: [u32; 6] = [1, 2, 4, 8, 16, 32];

/// Frames between two updates, and the mean errors over all frames of the display.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Rate {
    /// An update every so many frames.
    pub every: u32,
    /// Frames of the display that were compared.
    pub frames: u32,
    /// FLIP with galpix between the updates.
    pub flip: f64,
    /// PSNR of the mean squared error, decibels; none where there is no error.
    pub psnr_db: Option<f64>,
    /// FLIP of sample-and-hold.
    pub flip_hold: f64,
    /// PSNR of sample-and-hold, decibels; none where there is no error.
    pub psnr_hold_db: Option<f64>,
    /// The largest N of this list whose sample-and-hold is not worse in FLIP.
    pub hold_needs_every: u32,
    /// The N whose sample-and-hold is as good in FLIP, by interpolation between two of this list; none where
    /// sample-and-hold is as good at the slowest of them.
    pub hold_equals_every: Option<f64>,
}

/// galpix and sample-and-hold at an age.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Age {
    /// Frames since the update.
    pub frame: u32,
    /// FLIP of galpix.
    pub flip: f64,
    /// FLIP of sample-and-hold.
    pub flip_hold: f64,
    /// PSNR of galpix.
    pub psnr_db: f64,
    /// PSNR of sample-and-hold.
    pub psnr_hold_db: f64,
}

/// Sums of errors.
#[derive(Clone, Copy, Default)]
struct Sum {
    flip: f64,
    squares: f64,
    frames: u32,
}

/// A frame without error.
const FRESH: Sum = Sum { flip: 0.0, squares: 0.0, frames: 1 };

impl Sum {
    fn of(shown: &Picture, truth: &Picture) -> Self {
        let square = |(a, b): (&u8, &u8)| f64::from(a.abs_diff(*b)).powi(2);
        let squares: f64 = shown.bytes().iter().zip(truth.bytes()).map(square).sum();
        Self {
            flip: metric::flip(shown, truth, None).unwrap_or(0.0),
            squares: squares / truth.bytes().len().max(1) as f64,
            frames: 1,
        }
    }

    fn and(self, other: Self) -> Self {
        Self { flip: self.flip + other.flip, squares: self.squares + other.squares, frames: self.frames + other.frames }
    }

    fn flip(self) -> f64 {
        self.flip / f64::from(self.frames.max(1))
    }

    fn psnr_db(self) -> Option<f64> {
        let mean = self.squares / f64::from(self.frames.max(1));
        (mean > 0.0).then(|| 10.0 * (255.0f64.powi(2) / mean).log10())
    }
}

/// Returns how many frames of the display are compared for a scene that is meant for `frames`.
#[must_use]
pub fn length(frames: u32) -> u32 {
    EVERY.into_iter().find(|&every| every >= frames).unwrap_or(32)
}

/// Returns the rates of a scene; `engine` makes the frames between the updates.
///
/// *Errors:* an update that cannot be laid out.
pub fn rates(scene: &dyn Scene, frames: u32, engine: &Engine) -> Result<Vec<Rate>, EngineError> {
    let length = length(frames);
    let truths: Vec<Picture> = (0..length).map(|t| scene::render(scene, f64::from(t))).collect();
    let everies: Vec<u32> = EVERY.into_iter().filter(|&every| every <= length).collect();
    // What follows an update does not depend on when the next one comes: each is extrapolated once, for the slowest
    // rate.
    let starts: Vec<u32> = (0..length).filter(|start| start % 2 == 0 || length == 1).collect();
    let stretches: Vec<Vec<(Sum, Sum)>> = starts
        .par_iter()
        .map(|&start| {
            let slowest = everies.iter().copied().filter(|every| start % every == 0).max().unwrap_or(1);
            let update = scene::update(scene, f64::from(start));
            let hold = update.picture();
            let mut stretch = Vec::new();
            engine.run(&update, slowest - 1, |frame| {
                let truth = &truths[(start + frame.number) as usize];
                // The update itself: what is shown is the truth.
                stretch.push(match frame.number {
                    0 => (FRESH, FRESH),
                    _ => (Sum::of(&frame.picture(), truth), Sum::of(&hold, truth)),
                });
            })?;
            Ok(stretch)
        })
        .collect::<Result<_, EngineError>>()?;
    let total = |every: u32, which: fn(&(Sum, Sum)) -> Sum| {
        if every == 1 {
            return Sum { frames: length, ..FRESH };
        }
        let taken = starts.iter().zip(&stretches).filter(|(start, _)| *start % every == 0);
        taken.flat_map(|(_, stretch)| stretch.iter().take(every as usize).map(which)).fold(Sum::default(), Sum::and)
    };
    let held: Vec<(u32, Sum)> = everies.iter().map(|&every| (every, total(every, |pair| pair.1))).collect();
    let rate = |(every, held_here): &(u32, Sum)| {
        let moved = total(*every, |pair| pair.0);
        Rate {
            every: *every,
            frames: moved.frames,
            flip: moved.flip(),
            psnr_db: moved.psnr_db(),
            flip_hold: held_here.flip(),
            psnr_hold_db: held_here.psnr_db(),
            hold_needs_every: needed(moved.flip(), &held),
            hold_equals_every: equal(moved.flip(), &held),
        }
    };
    Ok(held.iter().map(rate).collect())
}

/// Returns the largest N at which sample-and-hold has at most this FLIP; at N = 1 it has none.
fn needed(flip: f64, held: &[(u32, Sum)]) -> u32 {
    held.iter().filter(|(_, sum)| sum.flip() <= flip).map(|&(every, _)| every).max().unwrap_or(1)
}

/// Returns the N at which sample-and-hold has this FLIP, on the line from the last rate that is not worse to the next.
fn equal(flip: f64, held: &[(u32, Sum)]) -> Option<f64> {
    let not_worse = needed(flip, held);
    let flip_at = |(every, sum): &(u32, Sum)| (f64::from(*every), sum.flip());
    let before = held.iter().find(|(every, _)| *every == not_worse).map(flip_at)?;
    let after = held.iter().find(|(every, _)| *every > not_worse).map(flip_at)?;
    Some(before.0 + (after.0 - before.0) * (flip - before.1) / (after.1 - before.1))
}

/// galpix and sample-and-hold at the ages whose true picture is known.
#[must_use]
pub fn ages(hold: &Picture, pairs: &[Pair]) -> Vec<Age> {
    let age = |(truth, shown): &Pair| {
        let mask = truth.mask.as_deref();
        Some(Age {
            frame: truth.frame,
            flip: metric::flip(shown, &truth.picture, mask)?,
            flip_hold: metric::flip(hold, &truth.picture, mask)?,
            psnr_db: metric::psnr_db(shown, &truth.picture, mask)?,
            psnr_hold_db: metric::psnr_db(hold, &truth.picture, mask)?,
        })
    };
    pairs.par_iter().filter_map(age).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_sample_and_hold_needs_is_the_slowest_rate_that_is_not_worse() {
        let at = |every, flip| (every, Sum { flip, squares: 0.0, frames: 1 });
        let held = [at(1, 0.0), at(2, 0.02), at(4, 0.05), at(8, 0.09)];
        assert_eq!([0.0, 0.01, 0.02, 0.06, 0.5].map(|flip| needed(flip, &held)), [1, 1, 2, 4, 8]);
        let equal =
            [0.0, 0.01, 0.02, 0.07, 0.09].map(|flip| equal(flip, &held).map(|every| (every * 1e6).round() / 1e6));
        assert_eq!(equal, [Some(1.0), Some(1.5), Some(2.0), Some(6.0), None]);
    }
}
