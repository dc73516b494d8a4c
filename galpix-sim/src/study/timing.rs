//! The time of a frame: every contender in turn, each between two copies of as many bytes as its map has.
//!
//! A round takes each contender once: the update is loaded (not timed), memory is copied, the frames are stepped and
//! timed one by one, memory is copied again. The time of a round is the median over its frames, its ratio that by the
//! mean of the two copies; the result is the median over the rounds, the first of which warms up, with their range: two
//! times whose ranges overlap are not told apart. The copies, of which every one of a size takes the same time on a
//! machine that does nothing else, say how noisy it was. Times are this thread's processor time.

use std::hint::black_box;
use std::time::Duration;

use cpu_time::ThreadTime;
use galpix_core::{Controller, Format, Galpixmap, Grid, Margin, Scratch, Settings, stages};
use schemars::JsonSchema;
use serde::Serialize;

use crate::engine::fill::{Inpaint, Inpainter};
use crate::engine::{self, EngineError, HiddenLayer, grid, load, margin};
use crate::metric::stats::median;
use crate::update::Update;

/// What can be timed.
pub trait Contender {
    /// Returns the bytes of one of its maps.
    fn bytes(&self) -> usize;
    /// Loads the update.
    fn restart(&mut self, update: &Update);
    /// Makes the next frame.
    fn step(&mut self);
    /// Makes the next frames; the seconds that each took.
    fn times(&mut self, frames: u32) -> Vec<f64> {
        let time = |_| {
            let start = ThreadTime::now();
            self.step();
            start.elapsed().as_secs_f64()
        };
        (0..frames).map(time).collect()
    }
}

/// A time, and its ratio to a copy of the same bytes in the same run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Time {
    /// Microseconds a frame, the median.
    pub frame_us: f64,
    /// Nanoseconds per cell of the map.
    pub ns_per_cell: f64,
    /// Ratio to a copy of as many bytes as the map has, the median.
    pub x_copy: f64,
    /// The smallest and the largest of the rounds, of which `frame_us` is the median.
    pub frame_us_range: [f64; 2],
    /// The same of `x_copy`.
    pub x_copy_range: [f64; 2],
}

impl Time {
    /// Returns half the range of the rounds, in per cent of the median.
    #[must_use]
    pub fn uncertain_percent(&self) -> f64 {
        let [low, high] = self.frame_us_range;
        50.0 * (high - low) / self.frame_us.max(f64::MIN_POSITIVE)
    }

    /// Returns whether no round of one took as long as any of the other.
    #[must_use]
    pub fn is_told_apart(&self, other: &Self) -> bool {
        self.frame_us_range[1] < other.frame_us_range[0] || other.frame_us_range[1] < self.frame_us_range[0]
    }
}

/// How much the same work differed in time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Noise {
    /// The slowest copy of the same bytes by the fastest one: the median over all that was timed.
    pub copy_spread: f64,
    /// Whether that is so much that times are to be doubted.
    pub noisy: bool,
}

impl Noise {
    /// The spread of copies from which on times are to be doubted.
    pub const DOUBTFUL: f64 = 1.25;

    fn of(copies: impl Iterator<Item = Vec<f64>>) -> Option<Self> {
        let spreads = copies.filter_map(|times| {
            let [low, high] = range(&times)?;
            Some(high / low.max(f64::MIN_POSITIVE))
        });
        let copy_spread = median(spreads.collect())?;
        Some(Self { copy_spread, noisy: copy_spread > Self::DOUBTFUL })
    }

    /// Returns a warning, if one is due.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        self.noisy.then(|| {
            format!(
                "The machine was noisy: the same copy of memory took up to {:.2} times as long as at its fastest, so times \
                 and fronts of time are uncertain. Repeat this while nothing else runs.",
                self.copy_spread
            )
        })
    }
}

/// Returns the smallest and the largest value.
fn range(values: &[f64]) -> Option<[f64; 2]> {
    let low = values.iter().copied().reduce(f64::min)?;
    Some([low, values.iter().copied().fold(low, f64::max)])
}

/// What was timed together.
#[derive(Clone, Debug)]
pub struct Race {
    /// The times of the contenders, in their order.
    pub times: Vec<Option<Time>>,
    /// How noisy the machine was, where that was seen.
    pub noise: Option<Noise>,
}

/// The engine over memory of its own, without anything around it.
pub struct Engine<F> {
    format: F,
    settings: Settings,
    size: (u32, u32),
    margin: Margin,
    starts: Vec<u32>,
    front: Vec<u32>,
    back: Vec<u32>,
    winners: Vec<u32>,
    edges: Vec<u32>,
    frame: u32,
    inpainter: Option<Inpainter>,
}

impl<F: Format> Engine<F> {
    /// For updates of the size of this one, with what follows each frame; `None` where such a map cannot be.
    #[must_use]
    pub fn new(update: &Update, format: F, settings: Settings, inpaint: Option<Inpaint>) -> Option<Self> {
        let margin = margin(update.margin);
        let size = (update.display_width() as u32, update.display_height() as u32);
        let mut starts = vec![0; Grid::rows(size.1, margin)];
        let grid = Grid::new(size.0, size.1, margin, &mut starts).ok()?;
        let words = Galpixmap::words(&grid, format);
        // Fill modes that use no edges need no scratch memory, and a product would not provide any.
        let uses_edges = settings.fill_mode.uses_edges();
        let scratch = if uses_edges { (grid.cells() as usize, stages::words(&grid)) } else { (0, 0) };
        let inpainter = inpaint.map(|inpaint| Inpainter::new(&grid, inpaint));
        Some(Self {
            format,
            inpainter,
            settings,
            size,
            margin,
            front: vec![0; words],
            back: vec![0; words],
            winners: vec![0; scratch.0],
            edges: vec![0; scratch.1],
            starts,
            frame: 0,
        })
    }
}

impl<F: Format> Contender for Engine<F> {
    fn bytes(&self) -> usize {
        self.front.len() * 4
    }

    fn restart(&mut self, update: &Update) {
        self.frame = 0;
        let Ok(grid) = Grid::new(self.size.0, self.size.1, self.margin, &mut self.starts) else { return };
        if let Ok(mut map) = Galpixmap::new(grid, self.format, &mut self.front) {
            load(update, &mut map);
        }
    }

    fn step(&mut self) {
        let Ok(grid) = Grid::new(self.size.0, self.size.1, self.margin, &mut self.starts) else { return };
        let front = Galpixmap::over(grid, self.format, &mut self.front);
        let back = Galpixmap::over(grid, self.format, &mut self.back);
        if let (Ok(front), Ok(back)) = (front, back) {
            let scratch = Scratch { winners: &mut self.winners, edges: &mut self.edges };
            let Ok(mut controller) = Controller::new(front, back, scratch) else { return };
            controller.set_frame(self.frame);
            controller.step(&self.settings);
            if let Some(inpainter) = &mut self.inpainter {
                inpainter.paint(&mut controller, &self.settings);
            }
        }
        std::mem::swap(&mut self.front, &mut self.back);
        self.frame = self.frame.wrapping_add(1);
    }
}

/// An engine that makes all frames of a turn by itself: with hidden layers, or of stationary sources, whose picture is
/// part of a frame.
pub struct Whole<'u> {
    engine: engine::Engine,
    update: &'u Update,
    hidden: Vec<HiddenLayer<'u>>,
    bytes: usize,
}

impl<'u> Whole<'u> {
    /// Makes a contender over an update and its hidden layers; its bytes are those of a map of `format`.
    ///
    /// *Errors:* a map that does not fit.
    pub fn new(
        engine: engine::Engine,
        format: impl Format,
        update: &'u Update,
        hidden: Vec<HiddenLayer<'u>>,
    ) -> Result<Self, EngineError> {
        let mut starts = vec![0; Grid::rows(update.display_height() as u32, margin(update.margin))];
        let bytes = 4 * Galpixmap::words(&grid(update, &mut starts)?, format);
        Ok(Self { engine, update, hidden, bytes })
    }
}

impl Contender for Whole<'_> {
    fn bytes(&self) -> usize {
        self.bytes
    }

    /// Each turn begins with the update.
    fn restart(&mut self, _update: &Update) {}

    fn step(&mut self) {
        self.times(1);
    }

    fn times(&mut self, frames: u32) -> Vec<f64> {
        let mut times = Vec::with_capacity(frames as usize);
        let ran = self.engine.run_layers(self.update, &self.hidden, frames, |frame| {
            if frame.number > 0 {
                times.push(frame.time.as_secs_f64());
            }
        });
        // What ran when errors were measured runs again.
        if ran.is_ok() { times } else { Vec::new() }
    }
}

/// Makes a contender when its turn comes; `None` where there cannot be one.
pub type Maker<'m> = Box<dyn Fn() -> Option<Box<dyn Contender + 'm>> + 'm>;

/// How often things are timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Effort {
    /// Rounds that count.
    pub rounds: u32,
    /// Frames of a round.
    pub frames: u32,
}

/// Times the contenders that `make` makes; they live for a turn only, so that their memory need not exist at the same
/// time.
pub fn race(update: &Update, effort: Effort, make: &[Maker<'_>], mut done: impl FnMut()) -> Race {
    let mut rounds: Vec<Rounds> = vec![Rounds::default(); make.len()];
    let mut copy = Copy::default();
    for round in 0..=effort.rounds {
        for (make, rounds) in make.iter().zip(&mut rounds) {
            done();
            let Some(mut contender) = make() else { continue };
            let bytes = contender.bytes();
            contender.restart(update);
            let before = copy.time(bytes);
            let time = median(contender.times(effort.frames));
            let after = copy.time(bytes);
            // The first round warms up.
            if let (Some(time), true) = (time, round > 0) {
                rounds.frames.push(time);
                let copied = (0.5 * (before + after)).max(1e-9);
                rounds.ratios.push(time / copied);
                rounds.copies.push(copied);
            }
        }
    }
    let cells = update.samples.len().max(1) as f64;
    let noise = Noise::of(rounds.iter().map(|rounds| rounds.copies.clone()));
    Race { times: rounds.into_iter().map(|rounds| rounds.time(cells)).collect(), noise }
}

/// The rounds of a contender, in seconds.
#[derive(Clone, Debug, Default)]
struct Rounds {
    frames: Vec<f64>,
    /// By the copy.
    ratios: Vec<f64>,
    /// The mean of the copies before and after: one of them finds more in the caches, in each round the same.
    copies: Vec<f64>,
}

impl Rounds {
    fn time(self, cells: f64) -> Option<Time> {
        let (frame_us_range, x_copy_range) = (range(&self.frames)?.map(|time| time * 1e6), range(&self.ratios)?);
        let (time, x_copy) = (median(self.frames)?, median(self.ratios)?);
        Some(Time { frame_us: time * 1e6, ns_per_cell: time * 1e9 / cells, x_copy, frame_us_range, x_copy_range })
    }
}

/// Memory to be copied, aligned to cache lines: on some processors copies of other memory take ten times as long.
#[derive(Default)]
struct Copy {
    from: Vec<u8>,
    to: Vec<u8>,
}

impl Copy {
    /// Bytes of a cache line, and lines that keep the two apart by no multiple of a page.
    const LINE: usize = 64;
    const APART: usize = 31 * Self::LINE;

    /// Returns the seconds of a copy: the mean of some, after one that does not count.
    fn time(&mut self, bytes: usize) -> f64 {
        let room = bytes + Self::APART + Self::LINE;
        if self.from.len() < room {
            (self.from, self.to) = (vec![1; room], vec![2; room]);
        }
        let first = self.from.as_ptr().align_offset(Self::LINE).min(Self::LINE);
        let second = self.to.as_ptr().align_offset(Self::LINE).min(Self::LINE) + Self::APART;
        let (from, to) = (&self.from[first..first + bytes], &mut self.to[second..second + bytes]);
        // So many that a time is a tenth of a millisecond or more.
        let times = ((4 << 20) / bytes.max(1)).clamp(2, 64) as u32;
        let mut timed = Duration::ZERO;
        for counted in 0..=times {
            let start = ThreadTime::now();
            black_box(&mut *to).copy_from_slice(black_box(from));
            timed += if counted > 0 { start.elapsed() } else { Duration::ZERO };
        }
        timed.as_secs_f64() / f64::from(times)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_the_median_of_its_rounds_and_has_their_range() {
        let rounds = Rounds { frames: vec![4e-6, 2e-6, 3e-6], ratios: vec![2.0, 1.0, 1.5], copies: vec![2e-6; 6] };
        let time = rounds.time(1000.0).expect("a time");
        assert!((time.frame_us - 3.0).abs() < 1e-9 && (time.x_copy - 1.5).abs() < 1e-9);
        assert!((time.uncertain_percent() - 100.0 / 3.0).abs() < 1e-9);
        let at = |low: f64, high: f64| Time { frame_us_range: [low, high], ..time };
        assert!(at(1.0, 2.0).is_told_apart(&at(2.1, 3.0)) && at(2.1, 3.0).is_told_apart(&at(1.0, 2.0)));
        assert!(!at(1.0, 2.0).is_told_apart(&at(1.9, 3.0)) && !at(1.0, 2.0).is_told_apart(&at(1.2, 1.3)));
        assert_eq!(Rounds::default().time(1.0), None);
    }

    #[test]
    fn copies_say_whether_the_machine_is_noisy() {
        let noise =
            |slowest: f64| Noise::of([vec![1.0, slowest], vec![slowest, 1.0, 1.0]].into_iter()).expect("copies");
        assert_eq!((noise(1.1).noisy, noise(1.1).warning()), (false, None));
        assert!(noise(1.5).warning().is_some_and(|text| text.contains("1.50 times")));
        assert_eq!(Noise::of([Vec::new()].into_iter()), None);
    }
}
