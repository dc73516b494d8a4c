//! The disocclusion map compared with the propagation of the same map, in one run.
//!
//! ```sh
//! cargo run --release -p galpix-bench --bin disocclusion                              # 1024x1024, 15 rounds
//! taskset -c 1 cargo run --release -p galpix-bench --bin disocclusion -- 512x512 31   # pinned to a core
//! ```
//!
//! `x faster` is the time of the sweep (propagation and resolution of one frame) divided by that of the contender. What
//! the other columns mean is described in `race.rs`.

use std::cell::RefCell;
use std::hint::black_box;
use std::process::ExitCode;
use std::rc::Rc;

use galpix_bench::race::{Contender, arguments, race, table};
use galpix_bench::scene::{Motion, samples};
use galpix_bench::{Flat565, Full, Laid, Maps, Velocity565};
use galpix_core::disocclusion::{Reach, cover, map, mark};
use galpix_core::stages::{self, sweep};
use galpix_core::{Profile, Rounding, Static};

/// What the others are measured against.
const SWEEP: &str = "sweep";
/// What a contender does with its maps.
type Run<P> = Box<dyn FnMut(Laid<'_, Static<P>>)>;
/// Frames until the next update.
const FRAMES: u32 = 16;

fn enter<P: Profile + 'static>(contenders: &mut Vec<Contender>, layout: &str, size: (u32, u32)) {
    for motion in Motion::ALL {
        let ((width, height), group) = (size, format!("{layout} {}", motion.name()).leak());
        let samples = samples(width, height, motion);
        let maps = Rc::new(RefCell::new(Maps::new(width, height, Static::<P>::new(), &samples)));
        let cells = (width * height) as usize;
        let (bytes, reach, tally, through) = {
            let mut maps = maps.borrow_mut();
            let front = &maps.lay().front;
            let record = front.record();
            let reach = Reach::new(FRAMES, record.depth().bits.into());
            let through = map(front, &mut vec![0; cells], &Reach { through: true, ..reach });
            (record.bytes() * cells, reach, map(front, &mut vec![0; cells], &reach), through)
        };
        println!(
            "{group}: {} edges, {} without end; {:.2} % of the cells are covered, {:.2} % if surfaces are let through",
            tally.edges,
            tally.saturated,
            100.0 * f64::from(tally.covered) / cells as f64,
            100.0 * f64::from(through.covered) / cells as f64
        );
        let mut put = |what: &str, mut run: Run<P>| {
            let maps = Rc::clone(&maps);
            let run = Box::new(move || run(maps.borrow_mut().lay()));
            contenders.push(Contender::new(what, &*group, bytes, Box::new(|| {}), run));
        };
        put(
            SWEEP,
            Box::new(|Laid { front, mut back, .. }| {
                black_box(sweep(&front, &mut back, &mut [], black_box(Rounding::default()), 1));
            }),
        );
        put(
            "sweep with winners",
            Box::new(|Laid { front, mut back, scratch }| {
                black_box(sweep(&front, &mut back, scratch.winners, black_box(Rounding::default()), 1));
            }),
        );
        let mut extents = vec![0; cells];
        put(
            "disocclusion: mark",
            Box::new(move |Laid { front, .. }| {
                black_box(mark(&front, &mut extents, &reach));
            }),
        );
        let mut extents = vec![0; cells];
        put(
            "disocclusion: map",
            Box::new(move |Laid { front, .. }| {
                black_box(map(&front, &mut extents, &reach));
            }),
        );
        let mut line = vec![0; width as usize];
        put(
            "disocclusion: cover",
            Box::new(move |Laid { front, .. }| {
                let mut mask = vec![0; stages::words(front.grid())];
                black_box(cover(&front, &mut line, &mut mask, &reach));
            }),
        );
    }
}

fn main() -> ExitCode {
    let ((width, height), rounds) = match arguments() {
        Ok(arguments) => arguments,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    };
    let mut contenders = Vec::new();
    enter::<Full>(&mut contenders, "Full", (width, height));
    enter::<Flat565>(&mut contenders, "Flat565", (width, height));
    enter::<Velocity565>(&mut contenders, "Velocity565", (width, height));
    race(&mut contenders, width * height, rounds);
    table(&contenders, width * height, SWEEP);
    ExitCode::SUCCESS
}
