//! What a frame of stationary sources costs, compared with one of the map, in one run.
//!
//! ```sh
//! cargo run --release -p galpix-bench --bin sources                             # 1024x1024, 15 rounds
//! taskset -c 1 cargo run --release -p galpix-bench --bin sources -- 320x240 31  # pinned to a core
//! ```
//!
//! A map is stepped with extend and shown nearest, or sub-cell; sources are stepped, and shown with extend row by row:
//! gathered, filled and finished.
//! The columns are described in `race.rs`; `x faster` is measured against the step of the map.

use std::cell::RefCell;
use std::hint::black_box;
use std::process::ExitCode;
use std::rc::Rc;

use galpix_bench::race::{Contender, arguments, race, table};
use galpix_bench::scene::{Motion, Sample, samples};
use galpix_bench::{Full, Maps, Velocity565, at_run_time, grid, paint};
use galpix_core::source::{Gather, Source, Sources, Visibility, link_words};
use galpix_core::{FillMode, Format, Galpixmap, Grid, Settings, Static, sub_cell};

const STEP_OF_MAP: &str = "map: step";

/// Sources over memory that is never given back.
struct Stage<F: 'static> {
    grid: Grid<'static>,
    sources: Sources<'static, 'static, F>,
    settings: Settings,
    /// The update.
    update: Galpixmap<'static, F>,
    /// Gathered rows: the row above, the row itself and the row below.
    rows: [Vec<u32>; 3],
    line: Vec<u32>,
}

impl<F: Format> Stage<F> {
    fn new(width: u32, height: u32, format: F, samples: &[Sample]) -> Self {
        let grid = grid(width, height);
        let cells = grid.cells() as usize;
        let words = || vec![0; Galpixmap::words(&grid, format)].leak();
        let map = || Galpixmap::new(grid, format, words()).expect("memory enough");
        let mut update = map();
        paint(&mut update, samples);
        let source = Source::new(map(), vec![0; cells].leak(), vec![0; link_words(&grid)].leak());
        let layers = Box::leak(Box::new([source.expect("memory enough")]));
        let line = vec![0; Visibility::line_half_words(&grid)].leak();
        let visibility = Visibility::new(&grid, vec![0; cells].leak(), vec![0; cells].leak(), line);
        let sources = Sources::new(layers, visibility.expect("memory enough")).expect("layers of one grid");
        let settings = Settings::for_depth(format.record().depth().bits.into());
        let row = || vec![0; width as usize];
        let mut stage = Self { grid, sources, settings, update, rows: [row(), row(), row()], line: row() };
        stage.begin();
        stage.step();
        stage.show();
        stage
    }

    /// Begins with the update.
    fn begin(&mut self) {
        let threshold = self.settings.edge_threshold;
        let Some(source) = self.sources.layer_mut(0) else { return };
        let map = source.map_mut();
        for y in 0..self.grid.height() as i32 {
            for x in 0..self.grid.width() as i32 {
                if let Some(galpixel) = self.update.load(x, y) {
                    map.store(x, y, &galpixel);
                }
            }
        }
        source.begin(threshold);
        self.sources.set_frame(1);
    }

    fn step(&mut self) {
        black_box(self.sources.step(&self.settings));
    }

    /// Steps the samples alone.
    fn follow(&mut self) {
        let (rounding, frame) = (self.settings.rounding, self.sources.frame());
        if let Some(source) = self.sources.layer_mut(0) {
            black_box(source.step(rounding, frame));
        }
    }

    /// Makes all rows of the picture: each is finished as soon as the row below it is gathered.
    fn show(&mut self) {
        let edge_threshold = self.settings.edge_threshold;
        let gather = Gather { fill_mode: FillMode::Extend, sub_cell: true, edge_threshold };
        let height = self.grid.height();
        let [mut above, mut row, mut below] = self.rows.each_mut().map(core::mem::take);
        let mut holes = self.sources.gather(0, gather, &mut row);
        for y in 0..height {
            holes += self.sources.gather(y + 1, gather, &mut below);
            let around = [if y == 0 { &[] } else { &*above }, &row, if y + 1 == height { &[] } else { &*below }];
            self.sources.finish(y, edge_threshold, around, &mut self.line);
            black_box(&mut self.line);
            (above, row, below) = (row, below, above);
        }
        black_box(holes);
        self.rows = [above, row, below];
    }
}

/// Adds the stages of a format.
fn enter<F: Format + 'static>(
    contenders: &mut Vec<Contender>,
    name: &str,
    format: F,
    (width, height, samples): (u32, u32, &[Sample]),
) {
    let bytes = format.record().bytes() * (width * height) as usize;
    let maps = Rc::new(RefCell::new(Maps::new(width, height, format, samples)));
    for stage in Maps::<F>::stages().into_iter().filter(|stage| ["step", "scan-out"].contains(&stage.name)) {
        let maps = Rc::clone(&maps);
        let run = Box::new(move || (stage.run)(&mut maps.borrow_mut()));
        contenders.push(Contender::new(format!("map: {}", stage.name), name, bytes, Box::new(|| {}), run));
    }
    let run = Box::new(move || {
        let mut maps = maps.borrow_mut();
        let threshold = maps.settings().edge_threshold;
        let front = maps.lay().front;
        let rows = (0..height).map(|y| sub_cell::row(&front, threshold, y).fold(0, |sum: u32, word| sum ^ word));
        black_box(rows.fold(0, |sum, word| sum ^ word));
    });
    contenders.push(Contender::new("map: sub-cell scan-out", name, bytes, Box::new(|| {}), run));
    let stage = Rc::new(RefCell::new(Stage::new(width, height, format, samples)));
    type Run<F> = fn(&mut Stage<F>);
    let nothing: Run<F> = |_| {};
    let stages: [(&str, Run<F>, Run<F>); 4] = [
        ("source: step", Stage::begin, Stage::step),
        ("source: step, not shown", Stage::begin, Stage::follow),
        ("source: show", nothing, Stage::show),
        ("source: step and show", Stage::begin, |stage| {
            stage.step();
            stage.show();
        }),
    ];
    for (what, before, run) in stages {
        let (for_before, for_run) = (Rc::clone(&stage), Rc::clone(&stage));
        let before = Box::new(move || before(&mut for_before.borrow_mut()));
        let run = Box::new(move || run(&mut for_run.borrow_mut()));
        contenders.push(Contender::new(what, name, bytes, before, run));
    }
}

fn main() -> ExitCode {
    match arguments() {
        Ok(((width, height), rounds)) => {
            let samples = samples(width, height, Motion::Scene);
            let scene = (width, height, &*samples);
            let mut contenders = Vec::new();
            enter(&mut contenders, "Full", Static::<Full>::new(), scene);
            enter(&mut contenders, "FullDyn", at_run_time::<Full>(), scene);
            enter(&mut contenders, "V565", Static::<Velocity565>::new(), scene);
            race(&mut contenders, width * height, rounds);
            table(&contenders, width * height, STEP_OF_MAP);
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}
