//! What a source holds, before anything is made of it: how fast its cells move, how deep they are, and the first frame.

use schemars::JsonSchema;
use serde::Serialize;

use super::ink;
use super::job::{ExperimentError, Job, Request};
use super::run;
use crate::engine::Scheme;
use crate::picture::Picture;
use crate::source::Source;
use crate::update::{DepthKind, Known, Margin, Update};

/// Bins of a histogram.
const BINS: usize = 10;

/// A source as it was read.
#[derive(Debug, Serialize, JsonSchema)]
pub struct CheckReport {
    /// Its name.
    pub source: String,
    /// What it shows.
    pub about: String,
    /// Columns of the display.
    pub width: usize,
    /// Rows of the display.
    pub height: usize,
    /// Cells beyond it.
    pub margin: Margin,
    /// Frames that it is meant to be extrapolated.
    pub frames: u32,
    /// Where its depth comes from.
    pub depth_kind: DepthKind,
    /// Cells with depth and motion.
    pub known: usize,
    /// Cells of which only the colour is known.
    pub colour_only: usize,
    /// Of known cells: how far they move in a frame, in pixels.
    pub speed_px: Option<Spread>,
    /// Of known cells: depth, from 0 for the nearest to 1 for the farthest.
    pub depth: Option<Spread>,
    /// Of known cells: the change of their velocity in a frame, in pixels.
    pub acceleration_px: Option<Spread>,
    /// Frames whose truth is known.
    pub truths: Vec<u32>,
    /// The first of them, made by the default scheme.
    pub first: Option<First>,
    /// What is noteworthy of it.
    pub notes: Vec<String>,
    /// The manifest of a capture as it was read, in TOML, with the values of keys that are not given.
    pub manifest: Option<String>,
}

/// How numbers are spread.
#[derive(Debug, PartialEq, Serialize, JsonSchema)]
pub struct Spread {
    /// The least.
    pub least: f64,
    /// A quarter is at most this.
    pub quarter: f64,
    /// Half of them are at most this.
    pub median: f64,
    /// Three quarters are at most this.
    pub three_quarters: f64,
    /// All but one in a hundred are at most this.
    pub ninety_nine: f64,
    /// The most.
    pub most: f64,
    /// How many there are in each tenth of the range from the least to the most.
    pub counts: [usize; BINS],
}

/// A frame against its truth.
#[derive(Debug, Serialize, JsonSchema)]
pub struct First {
    /// Frames since the update.
    pub frame: u32,
    /// PSNR of the whole picture, dB.
    pub psnr_db: Option<f64>,
    /// The same of sample-and-hold.
    pub psnr_hold_db: Option<f64>,
    /// Of the cells that a sample reached.
    pub psnr_known_db: Option<f64>,
}

impl Spread {
    /// Returns how some finite numbers are spread; `None` of no numbers.
    #[must_use]
    pub fn of(mut numbers: Vec<f64>) -> Option<Self> {
        numbers.sort_by(f64::total_cmp);
        let at = |part: f64| numbers.get(((numbers.len() - 1) as f64 * part).round() as usize).copied();
        let (least, most) = (*numbers.first()?, *numbers.last()?);
        let mut counts = [0; BINS];
        for number in &numbers {
            let part = if most > least { (number - least) / (most - least) } else { 0.0 };
            counts[((part * BINS as f64) as usize).min(BINS - 1)] += 1;
        }
        Some(Self {
            least,
            quarter: at(0.25)?,
            median: at(0.5)?,
            three_quarters: at(0.75)?,
            ninety_nine: at(0.99)?,
            most,
            counts,
        })
    }
}

/// Looks at a source, and makes its first frame whose truth is known.
///
/// *Errors:* a budget that cannot exist.
pub fn check(source: &Source) -> Result<CheckReport, ExperimentError> {
    let update = source.update();
    let known = || update.samples.iter().filter(|sample| sample.known == Known::Motion);
    let spread = |of: &dyn Fn(&crate::update::Sample) -> f64| Spread::of(known().map(of).collect());
    let truths = source.truth_frames(source.frames());
    let first = match truths.first() {
        Some(&frame) => {
            let request = Request { frames: Some(frame), perceptual: false, ..Request::default() };
            let job = Job::resolve(source, &request.in_scheme(Scheme::Source))?;
            let report = run::job(&job, |_| {})?;
            let truth = report.frames.last().and_then(|frame| frame.truth);
            truth.map(|truth| First {
                frame,
                psnr_db: truth.psnr_db,
                psnr_hold_db: truth.psnr_hold_db,
                psnr_known_db: truth.psnr_known_db,
            })
        }
        None => None,
    };
    Ok(CheckReport {
        source: source.name().to_owned(),
        about: source.about().to_owned(),
        width: update.display_width(),
        height: update.display_height(),
        margin: update.margin,
        frames: source.frames(),
        depth_kind: update.depth_kind,
        known: known().count(),
        colour_only: update.samples.len() - known().count(),
        speed_px: spread(&|sample| sample.velocity[0].hypot(sample.velocity[1])),
        depth: spread(&|sample| sample.depth),
        acceleration_px: spread(&|sample| sample.acceleration[0].hypot(sample.acceleration[1])),
        truths,
        first,
        notes: source.census().map(|census| census.notes.clone()).unwrap_or_default(),
        manifest: match source {
            Source::Scene(_) => None,
            Source::Capture(capture) => Some(capture.resolved()),
        },
    })
}

/// Returns the motion of the display's cells as colours: hue is the direction, strength how fast beside the fastest
/// hundredth; grey cells stand still, black ones are not known.
#[must_use]
pub fn motion(update: &Update) -> Picture {
    let velocity = |x: usize, y: usize| {
        let sample = &update.samples[(y + update.margin.top) * update.width + x + update.margin.left];
        (sample.known == Known::Motion).then_some([sample.velocity[0], sample.velocity[1]])
    };
    let (width, height) = (update.display_width(), update.display_height());
    let all: Vec<_> = (0..height).flat_map(|y| (0..width).map(move |x| velocity(x, y))).collect();
    let speeds = all.iter().flatten().map(|[x, y]| x.hypot(*y)).collect();
    let longest = Spread::of(speeds).map_or(1.0, |spread| spread.ninety_nine).max(1e-9);
    let colour = |velocity: Option<[f64; 2]>| velocity.map_or([0; 3], |velocity| ink::direction(velocity, longest));
    Picture { width, height, pixels: all.into_iter().map(colour).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::capture::ImportOptions;

    #[test]
    fn a_spread_says_where_numbers_lie() {
        assert_eq!(Spread::of(Vec::new()), None);
        let one = Spread::of(vec![3.0; 5]).unwrap();
        assert_eq!((one.least, one.median, one.most, one.counts[0]), (3.0, 3.0, 3.0, 5));
        let spread = Spread::of((0..=100).rev().map(f64::from).collect()).unwrap();
        let Spread { least, quarter, median, three_quarters, ninety_nine, most, counts } = spread;
        assert_eq!([least, quarter, median, three_quarters, ninety_nine, most], [0.0, 25.0, 50.0, 75.0, 99.0, 100.0]);
        assert_eq!(counts, [10, 10, 10, 10, 10, 10, 10, 10, 10, 11]);
    }

    #[test]
    fn a_scene_is_described_as_it_is() {
        let source = Source::open("pan", &ImportOptions::default()).unwrap();
        let report = check(&source).unwrap();
        assert_eq!(report.truths.len() as u32, report.frames);
        assert_eq!(report.known + report.colour_only, source.update().samples.len());
        let first = report.first.unwrap();
        assert!(first.frame == 1 && first.psnr_db > first.psnr_hold_db, "{first:?}");
        assert!(report.manifest.is_none() && report.notes.is_empty());
        // A pan moves everything alike.
        let speed = report.speed_px.unwrap();
        assert!(speed.least == speed.most && speed.least > 0.0, "{speed:?}");
        let picture = motion(&source.update());
        assert!(picture.pixels.iter().all(|pixel| *pixel == picture.pixels[0] && *pixel != [96; 3]));
    }
}
