//! The passes over stationary sources, for a layout and each picture.

use core::hint::black_box;

use galpix_core::source::{Gather, Source, Sources, Visibility, link_words};
use galpix_core::{FillMode, Galpixmap, Grid, Profile, Settings, Static};

use crate::bench::Bench;
use crate::machine::Psram;
use crate::pictures::Picture;
use crate::report::{Row, SKIPPING, print};

/// Frames that a picture goes on for: counts are their means.
const FRAMES: u32 = 4;

/// Memory for sources of any layout, besides that of the samples.
pub struct Memory {
    displacements: &'static mut [u32],
    links: &'static mut [u32],
    keys: &'static mut [u16],
    words: &'static mut [u32],
    line: &'static mut [u16],
    /// Gathered rows: the row above, the row itself, the row below; and the finished one.
    rows: [&'static mut [u32]; 4],
}

impl Memory {
    /// Takes memory for a grid; `None` if there is not so much left.
    pub fn new(psram: &mut Psram, grid: &Grid<'_>) -> Option<Self> {
        let (cells, width) = (grid.cells() as usize, grid.width() as usize);
        let mut row = || psram.lend(width, 0);
        let rows = [row()?, row()?, row()?, row()?];
        Some(Self {
            displacements: psram.lend(cells, 0)?,
            links: psram.lend(link_words(grid), 0)?,
            keys: psram.lend(cells, 0)?,
            words: psram.lend(cells, 0)?,
            line: psram.lend(Visibility::line_half_words(grid), 0)?,
            rows,
        })
    }
}

/// Ticks of each pass.
#[derive(Default)]
struct Ticks {
    link: u64,
    step: u64,
    gather: u64,
    finish: u64,
}

impl Bench {
    /// Measures the passes over sources.
    pub fn sources<P: Profile>(&mut self, layout: &'static str, picture: Picture) {
        let Self { clock, grid, maps, sources: memory, .. } = self;
        let (clock, mut ticks) = (*clock, Ticks::default());
        let Memory { displacements, links, keys, words, line, rows } = memory;
        let mut map = Galpixmap::new(*grid, Static::<P>::new(), maps[0]).expect("memory enough");
        picture.paint(&mut map);
        let settings = Settings::for_depth(map.record().depth().bits.into());
        let mut layers = [Source::new(map, displacements, links).expect("memory enough")];
        ticks.link = FRAMES as u64 * clock.time(|| layers[0].begin(black_box(settings.edge_threshold))).0;
        let visibility = Visibility::new(grid, keys, words, line).expect("memory enough");
        let mut sources = Sources::new(&mut layers, visibility).expect("a layer");
        let gather =
            Gather { fill_mode: FillMode::Extend, sub_cell: true, edge_threshold: black_box(settings.edge_threshold) };
        for _ in 0..FRAMES {
            ticks.step += clock.time(|| sources.step(black_box(&settings))).0;
            let [above, row, below, finished] = rows.each_mut();
            for y in 0..grid.height() {
                let mut take =
                    |y: u32, row: &mut [u32]| ticks.gather += clock.time(|| sources.gather(y, gather, row)).0;
                if y == 0 {
                    take(0, row);
                }
                take(y + 1, below);
                let around =
                    [if y == 0 { &[] } else { &**above }, row, if y + 1 == grid.height() { &[] } else { below }];
                let work = || sources.finish(y, gather.edge_threshold, around, finished);
                ticks.finish += clock.time(work).0;
                core::mem::swap(above, row);
                core::mem::swap(row, below);
            }
        }
        let row = Row { layout, picture: picture.name(), mode: SKIPPING, stage: "", rung: "-" };
        let say = |stage, ticks| print(&Row { stage, ..row }, ticks, grid.cells() * FRAMES);
        say("source-link", ticks.link);
        say("source-step", ticks.step);
        say("source-gather", ticks.gather);
        say("source-finish", ticks.finish);
    }
}
