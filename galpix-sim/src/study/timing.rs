//! The time of a frame: every contender in turn, each between two copies of as many bytes as its map has.
//!
//! A round takes each contender once: the update is loaded (not timed), memory is copied, the frames are stepped and
//! timed one by one, memory is copied again. The time of a round is the median over its frames, its ratio that by the
//! mean of the two copies; the result is the median over the rounds, the first of which warms up. Times are this
//! thread's processor time.

use std::hint::black_box;
use std::time::Duration;

use cpu_time::ThreadTime;
use galpix_core::{Controller, Format, Galpixmap, Grid, Margin, Scratch, Settings, stages};
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Time {
    /// Microseconds a frame, the median.
    pub frame_us: f64,
    /// Nanoseconds per cell of the map.
    pub ns_per_cell: f64,
    /// Ratio to a copy of as many bytes as the map has, the median.
    pub x_copy: f64,
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Effort {
    /// Rounds that count.
    pub rounds: u32,
    /// Frames of a round.
    pub frames: u32,
}

/// Times the contenders that `make` makes; they live for a turn only, so that their memory need not exist at the same
/// time.
pub fn race(update: &Update, effort: Effort, make: &[Maker<'_>], mut done: impl FnMut()) -> Vec<Option<Time>> {
    let mut rounds: Vec<Vec<(f64, f64)>> = vec![Vec::new(); make.len()];
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
                rounds.push((time, time / (0.5 * (before + after)).max(1e-9)));
            }
        }
    }
    let cells = update.samples.len().max(1) as f64;
    rounds
        .into_iter()
        .map(|rounds| {
            let time = median(rounds.iter().map(|round| round.0).collect())?;
            let x_copy = median(rounds.iter().map(|round| round.1).collect())?;
            Some(Time { frame_us: time * 1e6, ns_per_cell: time * 1e9 / cells, x_copy })
        })
        .collect()
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
