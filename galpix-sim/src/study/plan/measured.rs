//! A build, run over the update it is made for.

use galpix_core::{Dynamic, Format, Record, Settings};
use schemars::JsonSchema;
use serde::Serialize;

use super::{Build, PlanError};
use crate::engine::Engine;
use crate::metric;
use crate::metric::stats::{mean, median};
use crate::picture::Picture;
use crate::study::job::{Job, Request};
use crate::study::run;

/// Rounds of timing: in each, every build runs once. The first warms up.
const ROUNDS: u32 = 6;
/// Frames of a round.
const FRAMES: u32 = 12;

/// What was seen when a build was run.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Measured {
    /// The worst position error of any galpixel in any frame, against the exact second-order path, in pixels.
    pub worst_px: Option<f64>,
    /// Whether that is within what was certified; null where nothing was.
    pub within_certificate: Option<bool>,
    /// Fields that were clamped, when stored or in a step: none is covered by a certificate.
    pub saturated: u64,
    /// The median time of a frame, in microseconds, with the budget chosen at run time.
    pub frame_us: f64,
    /// The smallest and the largest of the rounds, of which that is the median.
    pub frame_us_range: [f64; 2],
    /// Ratio to the full budget in the same round, the median.
    pub x_full: f64,
    /// The smallest and the largest of the rounds.
    pub x_full_range: [f64; 2],
}

/// A source and how it is run.
pub struct Subject<'s>(pub Job<'s>);

/// A run of a build.
pub struct Ran {
    /// The picture of each frame.
    pub pictures: Vec<Picture>,
    /// Holes of all frames.
    pub holes: u64,
    /// Of these, those that were just unobscured or stayed empty.
    pub unobscured: u64,
    worst_px: Option<f64>,
    saturated: u64,
}

impl Subject<'_> {
    /// Returns the settings of a build with this stored form.
    pub fn settings(&self, build: &Build, record: &Record) -> Settings {
        let request = Request { rounding: build.rounding, fill: build.fill_mode.into(), ..self.0.request };
        request.settings(record, self.0.update.depth_kind)
    }

    fn engine(&self, build: &Build) -> Result<Engine, PlanError> {
        let format = Dynamic::new(build.bits, build.layout)?;
        Ok(Engine::new(format, self.settings(build, format.record())))
    }

    /// Runs a build over all frames.
    pub fn run(&self, build: &Build) -> Result<Ran, PlanError> {
        let mut ran = Ran { pictures: Vec::new(), holes: 0, unobscured: 0, worst_px: None, saturated: 0 };
        let Job { source, update, frames, .. } = &self.0;
        let loaded = self.engine(build)?.run(update, *frames, |frame| {
            if frame.number == 0 {
                return;
            }
            let tally = frame.tally;
            ran.holes += u64::from(tally.holes);
            ran.unobscured += u64::from(tally.holes - tally.bullets);
            ran.saturated += u64::from(tally.saturated);
            ran.pictures.push(frame.picture());
            let position = run::position(source, update, frame, |origin| Some(origin as usize));
            if let Some(position) = position {
                ran.worst_px = Some(ran.worst_px.map_or(position.worst_px, |worst| worst.max(position.worst_px)));
            }
        })?;
        ran.saturated += u64::from(loaded.saturated);
        Ok(ran)
    }
}

impl Ran {
    /// Returns the share of pixels, over all frames, that differ from those of another run.
    pub fn differs(&self, other: &Self) -> f64 {
        let pairs = self.pictures.iter().zip(&other.pictures).flat_map(|(a, b)| a.pixels.iter().zip(&b.pixels));
        let (different, all) =
            pairs.fold((0u64, 0u64), |(different, all), (a, b)| (different + u64::from(a != b), all + 1));
        different as f64 / all.max(1) as f64
    }

    /// Returns the mean likeness to the truth, over the frames whose truth is known.
    pub fn psnr_db(&self, subject: &Subject<'_>) -> Option<f64> {
        let known = (1..).zip(&self.pictures).filter_map(|(frame, picture)| {
            let truth = subject.0.source.truth(frame)?;
            metric::psnr_db(picture, &truth.picture, truth.mask.as_deref())
        });
        mean(known)
    }

    /// Returns what is reported of this run; its time is measured later, together with others.
    pub fn measured(&self, certified_px: Option<f64>) -> Measured {
        // The import itself rounds to 32 fraction bits.
        let slack = 1e-6;
        Measured {
            worst_px: self.worst_px,
            within_certificate: self.worst_px.zip(certified_px).map(|(worst, certified)| worst <= certified + slack),
            saturated: self.saturated,
            frame_us: 0.0,
            frame_us_range: [0.0; 2],
            x_full: 1.0,
            x_full_range: [1.0; 2],
        }
    }
}

/// Times several builds, in turn, so that they share what the machine does meanwhile; the first is the full budget.
pub fn time(subject: &Subject<'_>, builds: &mut [(Build, &mut Measured)]) -> Result<(), PlanError> {
    let mut rounds: Vec<Vec<f64>> = vec![Vec::new(); builds.len()];
    for round in 0..ROUNDS {
        for ((build, _), rounds) in builds.iter().zip(&mut rounds) {
            let mut times = Vec::new();
            subject.engine(build)?.run(&subject.0.update, subject.0.frames.min(FRAMES), |frame| {
                if frame.number > 0 {
                    times.push(frame.time.as_secs_f64());
                }
            })?;
            rounds.extend(median(times).filter(|_| round > 0));
        }
    }
    let full = rounds.first().cloned().unwrap_or_default();
    for ((_, measured), rounds) in builds.iter_mut().zip(rounds) {
        let ratios: Vec<f64> =
            rounds.iter().zip(&full).map(|(time, full)| time / full.max(f64::MIN_POSITIVE)).collect();
        (measured.frame_us, measured.frame_us_range) = within(rounds.iter().map(|time| time * 1e6).collect());
        (measured.x_full, measured.x_full_range) = within(ratios);
    }
    Ok(())
}

/// Returns the median of some values, and the smallest and the largest of them.
fn within(values: Vec<f64>) -> (f64, [f64; 2]) {
    let ends = [f64::min, f64::max].map(|end| values.iter().copied().reduce(end).unwrap_or(0.0));
    (median(values).unwrap_or(0.0), ends)
}
