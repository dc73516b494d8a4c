//! The engine beside a memory copy and beside floats, in one run: figures that survive a noisy machine.
//!
//! ```sh
//! cargo run --release -p galpix-core --example ratios                              # 1024x1024, 15 rounds
//! taskset -c 1 cargo run --release -p galpix-core --example ratios -- 512x512 31   # pinned to a core
//! RUSTFLAGS='-C target-cpu=x86-64-v3' taskset -c 1 cargo run --release -p galpix-core --example ratios
//! ```
//!
//! What the columns mean is said in `benches/common/race.rs`.

#[path = "../benches/common/mod.rs"]
mod common;

use std::cell::RefCell;
use std::hint::black_box;
use std::process::ExitCode;
use std::rc::Rc;

use common::naive::{Pixel, propagate};
use common::race::{Contender, arguments, race, table};
use common::scene::{Motion, Sample, samples};
use common::{Maps, Panel, PanelVelocity};
use galpix_core::galpixel::{Budget, Chosen, Profile, Static};
use galpix_core::layout::{Flat565, Full, Layout, Velocity565};
use galpix_core::rounding::Rounding;
use galpix_core::sweep::sweep;

/// The way in floats: what others are compared with.
const NAIVE: &str = "naive f32";

fn naive(width: u32, height: u32, motion: Motion, samples: &[Sample]) -> Contender {
    let old: Vec<_> = samples.iter().map(Pixel::from).collect();
    let mut new = vec![Pixel::default(); old.len()];
    let bytes = size_of_val(&*old);
    let run = move || propagate(black_box(&old), black_box(&mut new), width as usize, height as usize);
    Contender::new(NAIVE, motion.name(), bytes, Box::new(|| {}), Box::new(run))
}

/// Adds the stages of a layout; the ones beside the sweep with the scene only.
fn enter<L: Layout + 'static, B: Budget<L> + 'static>(
    contenders: &mut Vec<Contender>,
    layout: &str,
    (width, height): (u32, u32),
    budget: B,
    motion: Motion,
    samples: &[Sample],
) {
    let maps = Rc::new(RefCell::new(Maps::<L, B>::new(width, height, budget, samples)));
    let bytes_per_galpixel = maps.borrow().front.record().bytes();
    let bytes = bytes_per_galpixel * (width * height) as usize;
    for stage in Maps::<L, B>::stages() {
        if motion != Motion::Scene && !stage.name.starts_with("sweep") {
            continue;
        }
        let (for_before, for_run) = (Rc::clone(&maps), Rc::clone(&maps));
        contenders.push(Contender::new(
            format!("{} {layout}", stage.name),
            motion.name(),
            bytes,
            Box::new(move || {
                if let Some(before) = stage.before {
                    before(&mut for_before.borrow_mut());
                }
            }),
            Box::new(move || (stage.run)(&mut for_run.borrow_mut())),
        ));
    }
    if motion == Motion::Scene {
        let mut maps = maps.borrow_mut();
        let maps = &mut *maps;
        let tally = sweep(&maps.front, &mut maps.back, &mut [], Rounding::default(), 1);
        let empty = width * height + tally.lost + tally.collided - tally.moved;
        let holes = 100.0 * f64::from(empty) / f64::from(width * height);
        println!("{layout}: {bytes_per_galpixel} bytes a galpixel, {holes:.1} % holes");
    }
}

fn main() -> ExitCode {
    match arguments() {
        Ok((size, rounds)) => {
            compare(size, rounds);
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}

fn compare(size: (u32, u32), rounds: usize) {
    let (width, height) = size;
    let cells = width * height;
    let vectors = [
        ("AVX-512", cfg!(target_feature = "avx512bw")),
        ("AVX2", cfg!(target_feature = "avx2")),
        ("SSE2", cfg!(target_feature = "sse2")),
        ("NEON", cfg!(target_feature = "neon")),
    ];
    let vectors = vectors.iter().find(|(_, there)| *there).map_or("no vectors", |(name, _)| name);
    println!("{width}x{height}, {rounds} rounds, built for {vectors}");

    let mut contenders = Vec::new();
    for motion in Motion::ALL {
        let samples = samples(width, height, motion);
        contenders.push(naive(width, height, motion, &samples));
        let all = &mut contenders;
        enter::<Full, _>(all, "Full", size, Static::<Panel>::new(), motion, &samples);
        enter::<Flat565, _>(all, "Flat565", size, Static::<Panel>::new(), motion, &samples);
        enter::<Velocity565, _>(all, "Velocity565", size, Static::<PanelVelocity>::new(), motion, &samples);
        if motion == Motion::Scene {
            let chosen = Chosen::new(Panel::BITS).expect("the budget of the static maps");
            enter::<Full, _>(all, "Full, chosen at run time", size, chosen, motion, &samples);
        }
    }
    race(&mut contenders, cells, rounds);
    table(&contenders, cells, NAIVE);
}
