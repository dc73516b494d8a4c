//! What layers cost compared with one map, in one run.
//!
//! ```sh
//! cargo run --release -p galpix-bench --bin layers                             # 1024x1024, 15 rounds
//! taskset -c 1 cargo run --release -p galpix-bench --bin layers -- 320x240 31  # pinned to a core
//! ```
//!
//! `x sweep` is the median over rounds of a frame's time by that of propagation and resolution of one map alone, `x
//! frame` by that of a frame of one map with the same fill mode, in the same round. All times are this thread's
//! processor time.

use std::hint::black_box;
use std::process::ExitCode;
use std::time::Duration;

use cpu_time::ThreadTime;
use galpix_bench::race::arguments;
use galpix_bench::scene::{Motion, Sample, samples};
use galpix_bench::{Full, Velocity565, grid};
use galpix_core::fixed::types::I32F32;
use galpix_core::layers::{Layer, Layers, composite_words};
use galpix_core::stages::{self, sweep};
use galpix_core::{Class, Controller, FillMode, Format, Galpixel, Galpixmap, Grid, Profile, Scratch, Settings, Static};

/// What a hidden layer holds.
#[derive(Clone, Copy, Debug)]
enum Second {
    /// Every cell, behind all of the base: seen where the base has holes.
    Behind,
    /// The things of the scene, before the base.
    Things,
    /// Every cell, before all of the base.
    Before,
    /// As the base, mirrored: in about half of the cells it is nearer.
    Mixed,
}

impl Second {
    fn galpixels(self, samples: &[Sample]) -> Vec<Galpixel> {
        let one = |(index, sample): (usize, &Sample)| {
            let of = match self {
                Self::Mixed => &samples[samples.len() - 1 - index],
                _ => sample,
            };
            let mut galpixel = of.galpixel();
            let (eighth, depth) = (galpixel.depth >> 3, galpixel.depth);
            match self {
                Self::Behind => galpixel.depth = eighth + LAST_EIGHTH,
                Self::Before | Self::Things => galpixel.depth = eighth >> 3,
                Self::Mixed => {}
            }
            // Nothing changes its depth so much that it comes through.
            if !matches!(self, Self::Mixed) {
                galpixel.velocity[2] = Galpixel::default().depth;
                galpixel.acceleration[2] = Galpixel::default().depth;
            }
            let background = depth > HALF;
            if matches!(self, Self::Things) && background {
                Galpixel { class: Class::Empty, ..Galpixel::default() }
            } else {
                galpixel
            }
        };
        samples.iter().enumerate().map(one).collect()
    }
}

const HALF: I32F32 = I32F32::from_bits(1 << 31);
const LAST_EIGHTH: I32F32 = I32F32::from_bits(7 << 29);

/// What is timed.
#[derive(Clone, Copy, Debug)]
enum Run {
    /// Propagation and resolution of the base.
    Sweep,
    /// A frame of the base alone.
    Controller,
    /// The same as layers.
    Base,
    /// Two layers.
    Two(Second),
}

impl Run {
    const ALL: [(&'static str, Self); 7] = [
        ("sweep", Self::Sweep),
        ("one map", Self::Controller),
        ("a base alone", Self::Base),
        ("two layers, second full and behind", Self::Two(Second::Behind)),
        ("two layers, second sparse and before", Self::Two(Second::Things)),
        ("two layers, second full and before", Self::Two(Second::Before)),
        ("two layers, mixed", Self::Two(Second::Mixed)),
    ];
}

/// Maps and scratch memory, laid over anew for each time.
struct Memory<F> {
    grid: Grid<'static>,
    format: F,
    maps: [Vec<u32>; 4],
    first: [Vec<u32>; 2],
    winners: Vec<u32>,
    edges: Vec<u32>,
    composited: Vec<u32>,
}

/// Returns all planes of a map that holds some galpixels.
fn painted<F: Format>(grid: Grid<'_>, format: F, galpixels: &[Galpixel]) -> Vec<u32> {
    let mut memory = vec![0; Galpixmap::words(&grid, format)];
    let mut map = Galpixmap::new(grid, format, &mut memory).expect("memory enough");
    for (index, galpixel) in (0..).zip(galpixels) {
        map.store(index % grid.width() as i32, index / grid.width() as i32, galpixel);
    }
    memory
}

impl<F: Format> Memory<F> {
    /// Times one frame, from the same maps each time.
    fn time(&mut self, run: Run, fill_mode: FillMode) -> Duration {
        let Self { grid, format, maps: [m0, m1, m2, m3], first, winners, edges, composited } = self;
        m0.copy_from_slice(&first[0]);
        m2.copy_from_slice(&first[1]);
        let lay = |memory| Galpixmap::over(*grid, *format, memory).expect("memory enough");
        let (front, mut back) = (lay(m0), lay(m1));
        let settings = Settings { fill_mode, ..Settings::for_depth(front.record().depth().bits.into()) };
        let settings = black_box(&settings);
        let timed = |run: &mut dyn FnMut()| {
            let start = ThreadTime::now();
            run();
            start.elapsed()
        };
        // Fill modes that use no edges need none of it.
        let (winners, edges): (&mut [u32], &mut [u32]) =
            if fill_mode.uses_edges() { (winners, edges) } else { (&mut [], &mut []) };
        if let Run::Sweep = run {
            return timed(&mut || {
                black_box(sweep(&front, &mut back, &mut [], settings.rounding, 0));
            });
        }
        let mut base = Controller::new(front, back, Scratch { winners, edges }).expect("memory enough");
        match run {
            Run::Sweep | Run::Controller => timed(&mut || {
                black_box(base.step(settings));
            }),
            Run::Base => {
                let mut layers = Layers::new(base, &mut []).expect("one grid");
                timed(&mut || {
                    black_box(layers.step(settings));
                })
            }
            Run::Two(_) => {
                let layer = Layer::new(lay(m2), lay(m3), Scratch::default(), composited).expect("memory enough");
                let mut hidden = [layer];
                let mut layers = Layers::new(base, &mut hidden).expect("one grid");
                timed(&mut || {
                    black_box(layers.step(settings));
                })
            }
        }
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// A table for a layout and a motion.
fn compare<P: Profile>(layout: &str, (width, height): (u32, u32), rounds: usize, motion: Motion) {
    let (grid, format) = (grid(width, height), Static::<P>::new());
    let samples = samples(width, height, motion);
    let first: Vec<_> = samples.iter().map(Sample::galpixel).collect();
    let first = painted(grid, format, &first);
    let contents = Run::ALL.map(|(_, run)| match run {
        Run::Two(second) => painted(grid, format, &second.galpixels(&samples)),
        _ => vec![0; first.len()],
    });
    let mut memory = Memory {
        grid,
        format,
        maps: [0; 4].map(|word| vec![word; first.len()]),
        first: [first.clone(), first],
        winners: vec![0; grid.cells() as usize],
        edges: vec![0; stages::words(&grid)],
        composited: vec![0; composite_words(&grid)],
    };
    for fill_mode in [FillMode::None, FillMode::Extend] {
        let mut times = [(); Run::ALL.len()].map(|()| Vec::new());
        for round in 0..=rounds {
            for ((times, (_, run)), content) in times.iter_mut().zip(Run::ALL).zip(&contents) {
                memory.first[1].clone_from(content);
                let time = memory.time(run, fill_mode).as_secs_f64();
                if round > 0 {
                    times.push(time * 1e9 / f64::from(width * height));
                }
            }
        }
        println!(
            "\n{layout}, {}, fill mode {}\n{:<40} {:>9} {:>9} {:>9}",
            motion.name(),
            fill_mode.name(),
            "",
            "ns/cell",
            "x sweep",
            "x frame"
        );
        for (times_of, (name, _)) in times.iter().zip(Run::ALL) {
            let ratio = |to: &[f64]| median(times_of.iter().zip(to).map(|(time, to)| time / to).collect());
            println!(
                "{name:<40} {:>9.2} {:>9.2} {:>9.2}",
                median(times_of.clone()),
                ratio(&times[0]),
                ratio(&times[1])
            );
        }
    }
}

fn main() -> ExitCode {
    let (size, rounds) = match arguments() {
        Ok(arguments) => arguments,
        Err(message) => {
            eprintln!("{message}");
            return ExitCode::from(2);
        }
    };
    println!("{}x{}, {rounds} rounds", size.0, size.1);
    for motion in [Motion::Scene, Motion::Random] {
        compare::<Full>("Full", size, rounds, motion);
    }
    compare::<Velocity565>("Velocity565", size, rounds, Motion::Scene);
    ExitCode::SUCCESS
}
