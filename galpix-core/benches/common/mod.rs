//! What the benches share: a scene, maps to lay it into, and the obvious way in floats.

#![allow(dead_code, reason = "each bench uses its part of it")]
pub mod holes;
pub mod naive;
pub mod race;
pub mod scene;
pub mod textbook;

use std::hint::black_box;

use galpix_core::budget::{Bits, Demand};
use galpix_core::frame::{Scratch, Settings, step};
use galpix_core::galpixel::{Budget, Profile};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::{Grid, Wings};
use galpix_core::layout::Layout;
use galpix_core::sweep::sweep;
use galpix_core::tally::Tally;
use galpix_core::{disocclusion, edge};
use galpix_core::{fill, scan_out};

use scene::Sample;

/// Up to 1024 pixels a side, recognition in 8 frames, an update every 16.
const DEMAND: Demand = Demand { extent: 1024, recog: 8, prop: 16 };

/// The widths of [`DEMAND`].
#[derive(Debug)]
pub struct Panel;

impl Profile for Panel {
    const BITS: Bits = Bits::must(Bits::derive(DEMAND));
}

/// The widths of [`DEMAND`] without acceleration.
#[derive(Debug)]
pub struct PanelVelocity;

impl Profile for PanelVelocity {
    const BITS: Bits = Bits::must(Bits::derive_without_acceleration(DEMAND));
}

/// Two maps, scratch memory and settings. The memory is never given back: a bench lives as long as its program.
pub struct Maps<L: 'static, B: 'static> {
    /// The map that holds the scene.
    pub front: Galpixmap<'static, L, B>,
    /// The map that is made from it.
    pub back: Galpixmap<'static, L, B>,
    /// Winner map and edge map.
    pub scratch: Scratch<'static>,
    /// How a step is made.
    pub settings: Settings,
    line: Vec<u32>,
    extents: Vec<u32>,
}

fn lent(words: usize) -> &'static mut [u32] {
    vec![0; words].leak()
}

impl<L: Layout, B: Budget<L>> Maps<L, B> {
    /// Maps of `width` x `height` cells with the scene in the front one.
    pub fn new(width: u32, height: u32, budget: B, samples: &[Sample]) -> Self {
        let starts = lent(Grid::rows(height, Wings::NONE));
        let grid = Grid::new(width, height, Wings::NONE, starts).expect("a size that can be laid out");
        let words = Galpixmap::words(&grid, budget);
        let mut front = Galpixmap::new(grid, budget, lent(words)).expect("memory enough");
        let back = Galpixmap::new(grid, budget, lent(words)).expect("memory enough");
        for (row, y) in samples.chunks(width as usize).zip(0..) {
            for (sample, x) in row.iter().zip(0..) {
                front.store(x, y, &sample.galpixel());
            }
        }
        let scratch = Scratch { winners: lent(grid.cells() as usize), edges: lent(edge::words(&grid)) };
        let settings = Settings::for_depth(front.record().depth().bits.into());
        Self { front, back, scratch, settings, line: vec![0; width as usize], extents: vec![0; grid.cells() as usize] }
    }

    /// The stages, in the order of the frame. `sweep` is propagation and resolution.
    pub fn stages() -> [Stage<L, B>; 7] {
        let stage = |name, run| Stage { name, before: None, run };
        [
            stage("sweep", |maps| {
                black_box(sweep(&maps.front, &mut maps.back, &mut [], maps.settings.rounding, 1));
            }),
            stage("sweep-winners", Self::sweep_winners),
            stage("edge", Self::edge),
            // Holes are filled once and then there are none left: each fill has its own sweep before it.
            Stage { name: "fill", before: Some(Self::edge_and_sweep), run: Self::fill },
            stage("step", |maps| {
                black_box(step(&maps.front, &mut maps.back, &mut maps.scratch, &maps.settings, 1));
            }),
            stage("scan-out", Self::scan_out),
            stage("disocclusion", Self::disocclusion),
        ]
    }

    fn sweep_winners(&mut self) {
        black_box(sweep(&self.front, &mut self.back, self.scratch.winners, self.settings.rounding, 1));
    }

    fn edge(&mut self) {
        black_box(edge::mark(&self.front, self.settings.edge_threshold, self.scratch.edges));
    }

    fn edge_and_sweep(&mut self) {
        self.edge();
        self.sweep_winners();
    }

    fn fill(&mut self) {
        let (scratch, settings, mut tally) = (&mut self.scratch, &self.settings, Tally::default());
        let (rung, reach) = (settings.rung, settings.reach);
        fill::fill(&self.front, &mut self.back, scratch.winners, scratch.edges, rung, reach, &mut tally);
        black_box(tally);
    }

    /// The disocclusion map for an update every 16 frames.
    fn disocclusion(&mut self) {
        let reach = disocclusion::Reach::new(16, self.front.record().depth().bits.into());
        black_box(disocclusion::map(&self.front, &mut self.extents, &reach));
    }

    /// All rows as colour words, each into the memory of the same line.
    fn scan_out(&mut self) {
        for y in 0..self.front.grid().display_height() {
            for (word, colour) in self.line.iter_mut().zip(scan_out::row(&self.front, y)) {
                *word = colour;
            }
            black_box(&mut self.line);
        }
    }
}

/// What is timed, and what must be done before each time.
pub struct Stage<L: 'static, B: 'static> {
    /// As in the names of benches.
    pub name: &'static str,
    /// Not timed.
    pub before: Option<fn(&mut Maps<L, B>)>,
    /// Timed.
    pub run: fn(&mut Maps<L, B>),
}
