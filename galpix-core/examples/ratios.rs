//! The engine beside a memory copy and beside floats, in one run: figures that survive a noisy machine.
//!
//! ```sh
//! cargo run --release -p galpix-core --example ratios                              # 1024x1024, 15 rounds
//! taskset -c 1 cargo run --release -p galpix-core --example ratios -- 512x512 31   # pinned to a core
//! RUSTFLAGS='-C target-cpu=x86-64-v3' taskset -c 1 cargo run --release -p galpix-core --example ratios
//! ```
//!
//! In each round every contender runs once, between two copies of as many bytes as its map has. `x copy` is the median over
//! rounds of its time by the mean of these two, `x faster` the median of the time of the floats of the same motion in the
//! same round by its own. All times are this thread's processor time, with caches as the same work left them.

#[path = "../benches/common/mod.rs"]
mod common;

use std::cell::RefCell;
use std::hint::black_box;
use std::process::ExitCode;
use std::rc::Rc;
use std::time::Duration;

use common::naive::{Pixel, propagate};
use common::scene::{Motion, Sample, samples};
use common::{Maps, Panel, PanelVelocity};
use cpu_time::ThreadTime;
use galpix_core::galpixel::{Budget, Chosen, Profile, Static};
use galpix_core::layout::{Flat565, Full, Layout, Velocity565};
use galpix_core::rounding::Rounding;
use galpix_core::sweep::sweep;

/// The way in floats: what others are compared with.
const NAIVE: &str = "naive f32";

struct Contender {
    what: String,
    motion: Motion,
    /// Bytes of its map.
    bytes: usize,
    before: Box<dyn FnMut()>,
    run: Box<dyn FnMut()>,
    /// A time for each round.
    times: Vec<Duration>,
    /// The mean of the two copies for each round.
    copies: Vec<Duration>,
}

impl Contender {
    fn new(what: String, motion: Motion, bytes: usize, before: Box<dyn FnMut()>, run: Box<dyn FnMut()>) -> Self {
        Self { what, motion, bytes, before, run, times: Vec::new(), copies: Vec::new() }
    }

    fn naive(width: u32, height: u32, motion: Motion, samples: &[Sample]) -> Self {
        let old: Vec<_> = samples.iter().map(Pixel::from).collect();
        let mut new = vec![Pixel::default(); old.len()];
        let bytes = size_of_val(&*old);
        let run = move || propagate(black_box(&old), black_box(&mut new), width as usize, height as usize);
        Self::new(NAIVE.to_owned(), motion, bytes, Box::new(|| {}), Box::new(run))
    }

    /// The mean of several times, after one that is not counted: in a display nothing else turns the caches over.
    fn time(&mut self, times: u32) -> Duration {
        let mut timed = Duration::ZERO;
        for counted in 0..=times {
            (self.before)();
            let start = ThreadTime::now();
            (self.run)();
            timed += if counted > 0 { start.elapsed() } else { Duration::ZERO };
        }
        timed / times
    }
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
            motion,
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

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { 0.5 * (values[middle - 1] + values[middle]) }
}

/// Two blocks of memory, one to be copied into the other.
struct Copy {
    from: Vec<u8>,
    to: Vec<u8>,
}

impl Copy {
    /// As [`Contender::time`].
    fn time(&mut self, bytes: usize, times: u32) -> Duration {
        let mut timed = Duration::ZERO;
        for counted in 0..=times {
            let start = ThreadTime::now();
            black_box(&mut self.to[..bytes]).copy_from_slice(black_box(&self.from[..bytes]));
            timed += if counted > 0 { start.elapsed() } else { Duration::ZERO };
        }
        timed / times
    }
}

fn arguments() -> Result<((u32, u32), usize), String> {
    let mut arguments = std::env::args().skip(1);
    let size = arguments.next().unwrap_or("1024x1024".to_owned());
    let rounds = arguments.next().unwrap_or("15".to_owned());
    let sides = size.split_once('x').and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    match (sides, rounds.parse()) {
        (Some((width, height)), Ok(1..)) if !(16..=4096).contains(&width) || !(16..=4096).contains(&height) => {
            Err(format!("a size of {size} cannot be measured: give sides of 16 to 4096 cells"))
        }
        (Some(size), Ok(rounds)) if rounds >= 1 => Ok((size, rounds)),
        _ => Err(format!("\"{size} {rounds}\" is not understood: give a size and rounds, as in \"512x512 15\"")),
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
        contenders.push(Contender::naive(width, height, motion, &samples));
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
    table(&contenders, cells);
}

fn race(contenders: &mut [Contender], cells: u32, rounds: usize) {
    let most = contenders.iter().map(|contender| contender.bytes).max().unwrap_or(0);
    let mut copy = Copy { from: vec![1; most], to: vec![2; most] };
    // Small maps several times, so that a time is milliseconds.
    let times = ((1 << 19) / cells).max(1);
    for round in 0..=rounds {
        for contender in &mut *contenders {
            let before = copy.time(contender.bytes, times);
            let time = contender.time(times);
            let after = copy.time(contender.bytes, times);
            // The first round warms up.
            if round > 0 {
                contender.times.push(time);
                contender.copies.push((before + after) / 2);
            }
        }
    }
}

fn table(contenders: &[Contender], cells: u32) {
    println!(
        "\n{:<40} {:<7} {:>11} {:>8} {:>8} {:>9}",
        "contender", "motion", "ns/galpixel", "copy ns", "x copy", "x faster"
    );
    for contender in contenders {
        let naive = contenders.iter().find(|other| other.what == NAIVE && other.motion == contender.motion);
        let nanoseconds =
            |times: &[Duration]| median(times.iter().map(|time| time.as_secs_f64() * 1e9 / f64::from(cells)).collect());
        let ratio = |above: &[Duration], below: &[Duration]| {
            median(above.iter().zip(below).map(|(above, below)| above.as_secs_f64() / below.as_secs_f64()).collect())
        };
        println!(
            "{:<40} {:<7} {:>11.2} {:>8.2} {:>8.2} {:>9.2}",
            contender.what,
            contender.motion.name(),
            nanoseconds(&contender.times),
            nanoseconds(&contender.copies),
            ratio(&contender.times, &contender.copies),
            naive.map_or(f64::NAN, |naive| ratio(&naive.times, &contender.times)),
        );
    }
}
