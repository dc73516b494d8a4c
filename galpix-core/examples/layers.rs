//! What layers cost beside one map, in one run.
//!
//! ```sh
//! cargo run --release -p galpix-core --example layers                             # 1024x1024, 15 rounds
//! taskset -c 1 cargo run --release -p galpix-core --example layers -- 320x240 31  # pinned to a core
//! ```
//!
//! `x sweep` is the median over rounds of a frame's time by that of propagation and resolution of one map alone, `x frame`
//! by that of a frame of one map with the same rung, in the same round. All times are this thread's processor time.

#[path = "../benches/common/mod.rs"]
mod common;

use std::hint::black_box;
use std::process::ExitCode;
use std::time::Duration;

use common::race::arguments;
use common::scene::{Motion, Sample, samples};
use common::{Panel, PanelVelocity};
use cpu_time::ThreadTime;
use fixed::types::I32F32;
use galpix_core::edge;
use galpix_core::fill::Rung;
use galpix_core::frame::{Controller, Scratch, Settings};
use galpix_core::galpixel::{Budget, Class, Galpixel, Static};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::{Grid, Wings};
use galpix_core::layers::{Layer, Layers, seat_words};
use galpix_core::layout::{Full, Layout, Velocity565};
use galpix_core::sweep::sweep;

/// What a layer beside the base holds.
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
struct Memory {
    maps: [Vec<u32>; 4],
    first: [Vec<u32>; 2],
    winners: Vec<u32>,
    edges: Vec<u32>,
    seats: Vec<u32>,
}

/// All planes of a map that holds some galpixels.
fn painted<L: Layout, B: Budget<L>>(grid: Grid<'_>, budget: B, galpixels: &[Galpixel]) -> Vec<u32> {
    let mut memory = vec![0; Galpixmap::<L, B>::words(&grid, budget)];
    let mut map = Galpixmap::<L, B>::new(grid, budget, &mut memory).expect("memory enough");
    for (index, galpixel) in (0..).zip(galpixels) {
        map.store(index % grid.width() as i32, index / grid.width() as i32, galpixel);
    }
    memory
}

impl Memory {
    /// The time of one frame, from the same maps each time.
    fn time<L: Layout, B: Budget<L>>(&mut self, grid: Grid<'_>, budget: B, run: Run, rung: Rung) -> Duration {
        let Self { maps: [m0, m1, m2, m3], first, winners, edges, seats } = self;
        m0.copy_from_slice(&first[0]);
        m2.copy_from_slice(&first[1]);
        let lay = |memory| Galpixmap::<L, B>::over(grid, budget, memory).expect("memory enough");
        let (front, mut back) = (lay(m0), lay(m1));
        let settings = Settings { rung, ..Settings::for_depth(front.record().depth().bits.into()) };
        let settings = black_box(&settings);
        let timed = |run: &mut dyn FnMut()| {
            let start = ThreadTime::now();
            run();
            start.elapsed()
        };
        // Rungs that tell no surfaces apart need none of it.
        let (winners, edges): (&mut [u32], &mut [u32]) =
            if rung.tells_surfaces() { (winners, edges) } else { (&mut [], &mut []) };
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
                let mut layers = Layers::new(base, []).expect("one grid");
                timed(&mut || {
                    black_box(layers.step(settings));
                })
            }
            Run::Two(_) => {
                let layer = Layer::new(lay(m2), lay(m3), Scratch::default(), seats).expect("memory enough");
                let mut layers = Layers::new(base, [layer]).expect("one grid");
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
fn compare<L: Layout, B: Budget<L>>(
    layout: &str,
    (width, height): (u32, u32),
    rounds: usize,
    budget: B,
    motion: Motion,
) {
    let mut starts = vec![0; Grid::rows(height, Wings::NONE)];
    let grid = Grid::new(width, height, Wings::NONE, &mut starts).expect("a size that can be laid out");
    let samples = samples(width, height, motion);
    let first: Vec<_> = samples.iter().map(Sample::galpixel).collect();
    let first = painted::<L, B>(grid, budget, &first);
    let contents = Run::ALL.map(|(_, run)| match run {
        Run::Two(second) => painted::<L, B>(grid, budget, &second.galpixels(&samples)),
        _ => vec![0; first.len()],
    });
    let mut memory = Memory {
        maps: [0; 4].map(|word| vec![word; first.len()]),
        first: [first.clone(), first],
        winners: vec![0; grid.cells() as usize],
        edges: vec![0; edge::words(&grid)],
        seats: vec![0; seat_words(&grid)],
    };
    for rung in [Rung::None, Rung::Extend] {
        let mut times = [(); Run::ALL.len()].map(|()| Vec::new());
        for round in 0..=rounds {
            for ((times, (_, run)), content) in times.iter_mut().zip(Run::ALL).zip(&contents) {
                memory.first[1].clone_from(content);
                let time = memory.time::<L, B>(grid, budget, run, rung).as_secs_f64();
                if round > 0 {
                    times.push(time * 1e9 / f64::from(width * height));
                }
            }
        }
        println!(
            "\n{layout}, {}, rung {}\n{:<40} {:>9} {:>9} {:>9}",
            motion.name(),
            rung.name(),
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
        compare::<Full, _>("Full", size, rounds, Static::<Panel>::new(), motion);
    }
    compare::<Velocity565, _>("Velocity565", size, rounds, Static::<PanelVelocity>::new(), Motion::Scene);
    ExitCode::SUCCESS
}
