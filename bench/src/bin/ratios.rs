//! The engine compared with a memory copy and with floats, in one run: figures that survive a noisy machine.
//!
//! ```sh
//! cargo run --release -p galpix-bench --bin ratios                              # 1024x1024, 15 rounds
//! taskset -c 1 cargo run --release -p galpix-bench --bin ratios -- 512x512 31   # pinned to a core
//! RUSTFLAGS='-C target-cpu=x86-64-v3' taskset -c 1 cargo run --release -p galpix-bench --bin ratios
//! ```
//!
//! The columns of the first table are described in `race.rs`. The second table is for formats that are chosen at
//! run time: the median over rounds of a stage's time by that of the same format fixed at compile time, in the same
//! round.

use std::cell::RefCell;
use std::hint::black_box;
use std::process::ExitCode;
use std::rc::Rc;

use galpix_bench::naive::{Pixel, propagate};
use galpix_bench::race::{Contender, arguments, race, table};
use galpix_bench::scene::{Motion, Sample, samples};
use galpix_bench::{Flat565, Full, Laid, Maps, Velocity565, at_run_time};
use galpix_core::stages::sweep;
use galpix_core::{Format, Profile, Rounding, Static};

/// The version in floats, with which others are compared.
const NAIVE: &str = "naive f32";
/// The end of a contender's name whose format is chosen at run time.
const AT_RUN_TIME: &str = ", chosen at run time";

/// What all contenders of a group move.
struct Scene {
    width: u32,
    height: u32,
    motion: Motion,
    samples: Vec<Sample>,
}

impl Scene {
    fn naive(&self) -> Contender {
        let (width, height) = (self.width as usize, self.height as usize);
        let old: Vec<_> = self.samples.iter().map(Pixel::from).collect();
        let mut new = vec![Pixel::default(); old.len()];
        let bytes = size_of_val(&*old);
        let run = move || propagate(black_box(&old), black_box(&mut new), width, height);
        Contender::new(NAIVE, self.motion.name(), bytes, Box::new(|| {}), Box::new(run))
    }

    /// Adds the stages of a format fixed at compile time and, with the scene, of the same one chosen at run time.
    fn enter<P: Profile + 'static>(&self, contenders: &mut Vec<Contender>, layout: &str) {
        self.enter_format(contenders, layout, Static::<P>::new());
        if self.motion == Motion::Scene {
            self.enter_format(contenders, &format!("{layout}{AT_RUN_TIME}"), at_run_time::<P>());
        }
    }

    /// Adds the stages of a format; all but the sweep with the scene only.
    fn enter_format<F: Format + 'static>(&self, contenders: &mut Vec<Contender>, name: &str, format: F) {
        let Self { width, height, motion, ref samples } = *self;
        let maps = Rc::new(RefCell::new(Maps::new(width, height, format, samples)));
        let bytes_per_galpixel = format.record().bytes();
        let bytes = bytes_per_galpixel * (width * height) as usize;
        for stage in Maps::<F>::stages() {
            if motion != Motion::Scene && !stage.name.starts_with("sweep") {
                continue;
            }
            let (for_before, for_run) = (Rc::clone(&maps), Rc::clone(&maps));
            contenders.push(Contender::new(
                format!("{} {name}", stage.name),
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
            let Laid { front, mut back, .. } = maps.lay();
            let tally = sweep(&front, &mut back, &mut [], Rounding::default(), 1);
            let empty = width * height + tally.lost + tally.collided - tally.moved;
            let holes = 100.0 * f64::from(empty) / f64::from(width * height);
            println!("{name}: {bytes_per_galpixel} bytes a galpixel, {holes:.1} % holes");
        }
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

fn compare((width, height): (u32, u32), rounds: usize) {
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
        let scene = Scene { width, height, motion, samples: samples(width, height, motion) };
        contenders.push(scene.naive());
        scene.enter::<Full>(&mut contenders, "Full");
        scene.enter::<Flat565>(&mut contenders, "Flat565");
        scene.enter::<Velocity565>(&mut contenders, "Velocity565");
    }
    race(&mut contenders, cells, rounds);
    table(&contenders, cells, NAIVE);
    at_run_time_by_fixed(&contenders);
}

/// Prints what it costs that a format is chosen at run time.
fn at_run_time_by_fixed(contenders: &[Contender]) {
    println!("\n{:<46} {:<8} {:>9}", "chosen at run time, by fixed", "group", "x fixed");
    for contender in contenders {
        let Some(what) = contender.what().strip_suffix(AT_RUN_TIME) else { continue };
        let fixed = contenders.iter().find(|fixed| fixed.what() == what && fixed.group() == contender.group());
        if let Some(fixed) = fixed {
            println!("{what:<46} {:<8} {:>9.2}", contender.group(), contender.by(fixed));
        }
    }
}
