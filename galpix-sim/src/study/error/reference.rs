//! What the frames of a source are compared with: the true pictures, the true paths, and the exact second-order paths.

use std::sync::Arc;

use galpix_core::{FillMode, Layout};
use rayon::prelude::*;

use crate::engine::Scheme;
use crate::picture::Picture;
use crate::source::Source;
use crate::study::job::{ExperimentError, Job};
use crate::update::{Known, Sample, Truth, Update};

/// The frames whose pictures are compared; fewer where they are large: FLIP takes a microsecond per pixel.
const MOST_PICTURES: usize = 4;
/// Pixels whose FLIP is taken for one configuration.
const PIXELS: usize = 700_000;
/// Frames in which positions are compared.
const MOST_PLACES: usize = 6;

/// A source, its update, and its truth.
pub struct Reference<'s> {
    /// Scene or capture.
    pub source: &'s Source,
    /// The update.
    pub update: Arc<Update>,
    /// The update's picture: what sample-and-hold shows.
    pub hold: Picture,
    /// Frames to extrapolate.
    pub frames: u32,
    /// The true pictures that are compared with, in ascending frames.
    pub compared: Vec<Compared>,
    /// The frames in which a configuration is looked at, ascending; those whose pictures are reported are among them.
    pub looked: Vec<u32>,
    /// For each frame from 1 on, where each sample truly is, in cells of the map; only known for scenes.
    tracks: Option<Vec<Vec<[f64; 2]>>>,
}

/// A true picture.
pub struct Compared {
    /// The truth.
    pub truth: Truth,
    /// [`crate::engine::Frame::outline`]: that of the derived budget, for all configurations.
    pub outline: Vec<bool>,
    /// Whether its measures are reported; if not, it is there for the change to the next frame.
    pub reported: bool,
}

/// Returns `count` of some things, evenly spaced, the last among them.
fn spread<T: Copy>(all: &[T], count: usize) -> Vec<T> {
    let count = count.clamp(1, all.len().max(1)).min(all.len());
    (1..=count).map(|k| all[k * all.len() / count - 1]).collect()
}

impl<'s> Reference<'s> {
    /// Of a source over `frames` frames, whose positions alone are compared.
    #[must_use]
    pub fn new(source: &'s Source, frames: u32) -> Self {
        Self::with_update(source, Arc::new(source.update()), frames)
    }

    /// Of the source of a job, whose pictures are compared too.
    ///
    /// *Errors:* a budget that cannot exist, a map that does not fit.
    pub(super) fn of(job: &Job<'s>) -> Result<Self, ExperimentError> {
        let Job { source, frames, .. } = *job;
        let mut reference = Self::with_update(source, job.update.clone(), frames);
        let pictures = (PIXELS / reference.hold.pixels.len().max(1)).clamp(1, MOST_PICTURES);
        let known = source.truth_frames(frames);
        let reported = spread(&known, pictures);
        // With all that the update has, as `galpix run` has it.
        let whole = Job::resolve(source, &job.request)?.with_scheme(Scheme::Map).with_fill(FillMode::None.into());
        whole.engine().outlined().run(&job.update, frames, |frame| {
            let reports = reported.contains(&frame.number);
            let wanted = reports || reported.contains(&(frame.number + 1)) && known.contains(&frame.number);
            if let Some(truth) = wanted.then(|| source.truth(frame.number)).flatten() {
                reference.compared.push(Compared { truth, outline: frame.outline(), reported: reports });
            }
        })?;
        reference.looked.extend(reported);
        reference.looked.sort_unstable();
        reference.looked.dedup();
        Ok(reference)
    }

    fn with_update(source: &'s Source, update: Arc<Update>, frames: u32) -> Self {
        let hold = update.picture();
        let all: Vec<u32> = (1..=frames).collect();
        let looked = spread(&all, MOST_PLACES);
        let tracks = match source {
            Source::Scene(scene) => Some(all.par_iter().map(|&frame| tracks(*scene, &update, frame)).collect()),
            Source::Capture(_) => None,
        };
        Self { source, update, hold, frames, compared: Vec::new(), looked, tracks }
    }

    /// Returns where a sample was in the update, in cells of the map.
    #[must_use]
    pub fn from(&self, origin: u32) -> [f64; 2] {
        let (origin, width) = (origin as usize, self.update.width);
        [(origin % width) as f64, (origin / width) as f64]
    }

    /// Returns where a sample truly is in a frame, where that is known.
    #[must_use]
    pub fn track(&self, origin: u32, frame: u32) -> Option<[f64; 2]> {
        self.tracks.as_ref()?.get(frame.checked_sub(1)? as usize)?.get(origin as usize).copied()
    }

    /// Returns the frames whose pictures are reported.
    #[must_use]
    pub fn pictures(&self) -> Vec<u32> {
        self.compared.iter().filter(|compared| compared.reported).map(|compared| compared.truth.frame).collect()
    }

    /// Returns the frames that must be made: those that are looked at, and those before them whose change is compared.
    #[must_use]
    pub fn made(&self) -> Vec<u32> {
        self.looked.iter().copied().chain(self.compared.iter().map(|compared| compared.truth.frame)).collect()
    }

    /// Returns the most that fields which are left out would have moved a sample by, up to `frame`, in pixels.
    #[must_use]
    pub fn left_out_px(&self, layout: Layout, frame: u32) -> f64 {
        let known = self.update.samples.iter().filter(|sample| sample.known == Known::Motion);
        let gone = |sample: &Sample| {
            let [full, kept] = [displacement(sample, Layout::FULL, frame), displacement(sample, layout, frame)];
            (full[0] - kept[0]).abs().max((full[1] - kept[1]).abs())
        };
        known.map(gone).fold(0.0, f64::max)
    }
}

/// Returns the exact displacement in x and y of a sample with some fields, in pixels.
#[must_use]
pub fn displacement(sample: &Sample, layout: Layout, frame: u32) -> [f64; 2] {
    let n = f64::from(frame);
    [0, 1].map(|axis| {
        let velocity = if layout.velocity { sample.velocity[axis] } else { 0.0 };
        let acceleration = if layout.acceleration { sample.acceleration[axis] } else { 0.0 };
        velocity * n + acceleration / 2.0 * n * n
    })
}

fn tracks(scene: &dyn crate::source::scene::Scene, update: &Update, frame: u32) -> Vec<[f64; 2]> {
    let (left, top) = (update.margin.left as f64, update.margin.top as f64);
    (0..update.samples.len())
        .map(|cell| {
            let (x, y) = ((cell % update.width) as f64 - left, (cell / update.width) as f64 - top);
            let [x, y, _] = scene.track(x, y, 0.0, f64::from(frame));
            [x + left, y + top]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_is_even_and_ends_with_the_last() {
        assert_eq!(spread(&[1, 2, 3, 4, 5, 6], 2), [3, 6]);
        assert_eq!(spread(&[1, 2, 3], 8), [1, 2, 3]);
        assert_eq!(spread(&[1, 2, 3, 4], 1), [4]);
        assert!(spread::<u32>(&[], 3).is_empty());
    }
}
