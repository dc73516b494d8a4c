//! What the programs of this crate share: scenes, maps to lay them into, a race, and the obvious versions in floats.
//!
//! - `ratios`: a frame and its stages, compared with a memory copy and floats, and a format fixed at compile time with
//!   the same one chosen at run time
//! - `constant_time`: instructions of a frame, which must not depend on the picture
//! - `inpaint`, `layers`, `disocclusion`: the same for what these modules of the core add
//! - `cargo bench`: each stage, and push-pull, by size

#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod holes;
pub mod naive;
pub mod pictures;
pub mod race;
pub mod scene;
pub mod textbook;

use std::hint::black_box;

use galpix_core::disocclusion::{self, Reach};
use galpix_core::stages::{self, fill, mark, sweep};
use galpix_core::{
    Bits, Controller, Demand, Dynamic, Format, Galpixmap, Grid, Layout, Margin, Profile, Scratch, Settings, Tally,
    scan_out,
};

use scene::Sample;

/// Up to 1024 pixels a side, recognition in 8 frames, an update every 16.
const DEMAND: Demand = Demand { extent: 1024, recog: 8, prop: 16 };
const WITH_ACCELERATION: Bits = Bits::must(Bits::derive(DEMAND));
const WITHOUT_ACCELERATION: Bits = Bits::must(Bits::derive_without_acceleration(DEMAND));

macro_rules! profiles {
    ($($profile:ident: $layout:ident, $bits:ident;)*) => {$(
        #[doc = concat!("[`Layout::", stringify!($layout), "`] for a panel of 1024 pixels a side.")]
        #[derive(Debug)]
        pub struct $profile;

        impl Profile for $profile {
            const LAYOUT: Layout = Layout::$layout;
            const BITS: Bits = $bits;
        }
    )*};
}

profiles! {
    Full: FULL, WITH_ACCELERATION;
    Shaded: SHADED, WITH_ACCELERATION;
    Flat565: FLAT565, WITH_ACCELERATION;
    Velocity565: VELOCITY565, WITHOUT_ACCELERATION;
}

/// Returns the format of a profile, chosen at run time.
#[must_use]
pub fn at_run_time<P: Profile>() -> Dynamic {
    Dynamic::new(black_box(P::BITS), black_box(P::LAYOUT)).expect("a profile that can exist")
}

/// Returns a grid whose table of row starts is never given back. Panics if there is no such grid.
#[must_use]
pub fn grid(width: u32, height: u32) -> Grid<'static> {
    Grid::new(width, height, Margin::NONE, buffer(Grid::rows(height, Margin::NONE)))
        .expect("a size that can be laid out")
}

fn buffer(words: usize) -> &'static mut [u32] {
    vec![0; words].leak()
}

/// Stores cells in raster order.
pub fn paint<F: Format>(map: &mut Galpixmap<'_, F>, samples: &[Sample]) {
    let width = map.grid().width();
    for (row, y) in samples.chunks(width as usize).zip(0..) {
        for (sample, x) in row.iter().zip(0..) {
            map.store(x, y, &sample.galpixel());
        }
    }
}

/// Two maps, scratch memory and settings. The memory is never given back: a bench lives as long as its program.
pub struct Maps<F> {
    format: F,
    grid: Grid<'static>,
    front: &'static mut [u32],
    back: &'static mut [u32],
    scratch: Scratch<'static>,
    settings: Settings,
    line: Vec<u32>,
    extents: Vec<u32>,
}

/// The maps of [`Maps`] and their scratch memory, laid over for one time.
pub struct Laid<'m, F> {
    /// The map that holds the scene.
    pub front: Galpixmap<'m, F>,
    /// The map that is made from it.
    pub back: Galpixmap<'m, F>,
    /// Winner map and edge map.
    pub scratch: Scratch<'m>,
}

impl<F: Format> Maps<F> {
    /// Lays out maps of `width` x `height` cells with the scene in the front one. Panics if there is no such grid.
    pub fn new(width: u32, height: u32, format: F, samples: &[Sample]) -> Self {
        let grid = grid(width, height);
        let words = Galpixmap::words(&grid, format);
        let front = buffer(words);
        paint(&mut Galpixmap::new(grid, format, front).expect("memory enough"), samples);
        Self {
            format,
            grid,
            front,
            back: buffer(words),
            scratch: Scratch { winners: buffer(grid.cells() as usize), edges: buffer(stages::words(&grid)) },
            settings: Settings::for_depth(format.record().depth().bits.into()),
            line: vec![0; width as usize],
            extents: vec![0; grid.cells() as usize],
        }
    }

    /// Returns the format.
    pub fn format(&self) -> F {
        self.format
    }

    /// Returns with what frames are made.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Lays the maps over their memory, as they are. Costs nothing that could be measured.
    pub fn lay(&mut self) -> Laid<'_, F> {
        let Self { format, grid, front, back, scratch, .. } = self;
        let over = |memory| Galpixmap::over(*grid, *format, memory).expect("memory enough");
        let scratch = Scratch { winners: scratch.winners, edges: scratch.edges };
        Laid { front: over(front), back: over(back), scratch }
    }

    /// Returns a controller of the maps.
    pub fn into_controller(self) -> Controller<'static, F> {
        let Self { format, grid, front, back, scratch, .. } = self;
        let over = |memory| Galpixmap::over(grid, format, memory).expect("memory enough");
        Controller::new(over(front), over(back), scratch).expect("maps of one grid")
    }

    /// Returns the stages, in the order of the frame. `sweep` is propagation and resolution.
    pub fn stages() -> [Stage<F>; 7] {
        let stage = |name, run| Stage { name, before: None, run };
        [
            stage("sweep", Self::sweep),
            stage("sweep-winners", Self::sweep_winners),
            stage("edge", Self::edge),
            // Holes are filled once and then there are none left: each fill has its own sweep before it.
            Stage { name: "fill", before: Some(Self::edge_and_sweep), run: Self::fill },
            stage("step", Self::step),
            stage("scan-out", Self::scan_out),
            stage("disocclusion", Self::disocclusion),
        ]
    }

    fn sweep(&mut self) {
        let rounding = self.settings.rounding;
        let Laid { front, mut back, .. } = self.lay();
        black_box(sweep(&front, &mut back, &mut [], rounding, 1));
    }

    fn sweep_winners(&mut self) {
        let rounding = self.settings.rounding;
        let Laid { front, mut back, scratch } = self.lay();
        black_box(sweep(&front, &mut back, scratch.winners, rounding, 1));
    }

    fn edge(&mut self) {
        let threshold = self.settings.edge_threshold;
        let Laid { front, scratch, .. } = self.lay();
        black_box(mark(&front, threshold, scratch.edges));
    }

    fn edge_and_sweep(&mut self) {
        self.edge();
        self.sweep_winners();
    }

    fn fill(&mut self) {
        let (settings, mut tally) = (self.settings, Tally::default());
        let Laid { front, mut back, mut scratch } = self.lay();
        fill(&front, &mut back, &mut scratch, &settings, &mut tally);
        black_box(tally);
    }

    fn step(&mut self) {
        let settings = self.settings;
        let Laid { front, back, scratch } = self.lay();
        let mut controller = Controller::new(front, back, scratch).expect("maps of one grid");
        controller.set_frame(1);
        black_box(controller.step(&settings));
    }

    /// Makes the disocclusion map for an update every 16 frames.
    fn disocclusion(&mut self) {
        let mut extents = std::mem::take(&mut self.extents);
        let front = self.lay().front;
        let reach = Reach::new(16, front.record().depth().bits.into());
        black_box(disocclusion::map(&front, &mut extents, &reach));
        self.extents = extents;
    }

    /// Writes all rows as colour words, each into the memory of the same line.
    fn scan_out(&mut self) {
        let mut line = std::mem::take(&mut self.line);
        let front = self.lay().front;
        for y in 0..front.grid().display_height() {
            for (word, colour) in line.iter_mut().zip(scan_out::row(&front, y)) {
                *word = colour;
            }
            black_box(&mut line);
        }
        self.line = line;
    }
}

/// What is timed, and what must be done before each time.
pub struct Stage<F> {
    /// As in the names of benches.
    pub name: &'static str,
    /// Not timed.
    pub before: Option<fn(&mut Maps<F>)>,
    /// Timed.
    pub run: fn(&mut Maps<F>),
}
