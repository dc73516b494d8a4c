//! The stages of a frame, one by one and together, for a layout and each picture.

use core::hint::black_box;

use galpix_core::edge;
use galpix_core::fill::{Rung, fill};
use galpix_core::frame::{Scratch, Settings, Work, step};
use galpix_core::galpixel::{Fixed, Profile, Static};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::Grid;
use galpix_core::layout::Layout;
use galpix_core::rolling::{self, Rolling};
use galpix_core::scan_out;
use galpix_core::sweep::sweep;
use galpix_core::tally::Tally;

use crate::clock::Clock;
use crate::inpainting::{Counts, Pyramids};
use crate::pictures::Picture;
use crate::report::{Row, print};

/// Frames that a picture goes on for with skipping: counts are their means.
const FRAMES: u32 = 4;

/// A clock, and memory for the largest layout.
pub struct Bench {
    /// What counts.
    pub clock: Clock,
    /// The grid of all maps.
    pub grid: Grid<'static>,
    /// A smaller one, as wide, for constant work, which takes long and is the same for every row.
    pub band: Grid<'static>,
    /// Two maps that take turns.
    pub maps: [&'static mut [u32]; 2],
    /// Winner map and edge map.
    pub scratch: Scratch<'static>,
    /// The picture as it was painted.
    pub painted: &'static mut [u32],
    /// A map and its winners between sweep and fill.
    pub swept: [&'static mut [u32]; 2],
    /// Memory for push-pull.
    pub pyramids: Pyramids,
    /// Row starts of a window.
    pub window_rows: &'static mut [u32],
}

/// Ticks of each stage.
#[derive(Default)]
struct Ticks {
    edge: u64,
    sweep: u64,
    sweep_alone: u64,
    fill: [u64; Rung::ALL.len()],
    frame: u64,
    rolling: u64,
}

impl Bench {
    /// Measures a layout under the budget of a profile.
    pub fn measure<L: Layout, P: Profile>(&mut self, layout: &'static str)
    where
        Static<P>: Fixed<L>,
    {
        let words = <Static<P> as Fixed<L>>::RECORD.words() * self.grid.cells() as usize;
        for picture in Picture::ALL {
            let budget = Static::<P>::new();
            let mut map = Galpixmap::<L, _>::new(self.grid, budget, self.painted).expect("memory enough");
            picture.paint(&mut map);
            self.skipping::<L, P>(layout, picture, words);
        }
        self.torn::<L, P>(layout, words);
        for picture in Picture::ALL.into_iter().chain(Picture::EXTREMES) {
            self.constant::<L, P>(layout, picture);
        }
        self.whatever_the_picture::<L, P>(layout, words);
    }

    fn skipping<L: Layout, P: Profile>(&mut self, layout: &'static str, picture: Picture, words: usize) {
        let (mut ticks, mut inpainted) = (Ticks::default(), Counts::default());
        self.maps[0][..words].copy_from_slice(&self.painted[..words]);
        for frame in 0..FRAMES {
            self.frame::<L, P>(frame, words, &mut ticks);
            self.inpaint::<L, P>(Some(frame), words, &mut inpainted);
            self.maps.swap(0, 1);
        }
        let row = Row { layout, picture: picture.name(), mode: Work::Skipping.name(), stage: "", rung: "-" };
        let say = |row: Row, ticks: u64| print(&row, ticks, self.grid.cells() * FRAMES);
        say(Row { stage: "edge", ..row }, ticks.edge);
        say(Row { stage: "sweep", ..row }, ticks.sweep);
        say(Row { stage: "sweep-alone", ..row }, ticks.sweep_alone);
        for (rung, ticks) in Rung::ALL.into_iter().zip(ticks.fill) {
            say(Row { stage: "fill", rung: rung.name(), ..row }, ticks);
        }
        say(Row { stage: "frame", rung: Rung::default().name(), ..row }, ticks.frame);
        say(Row { stage: "rolling", rung: Rung::default().name(), ..row }, ticks.rolling);
        inpainted.print(row, self.grid.cells());
    }

    /// One frame in one map, then stage by stage, then as a whole, which is what stays.
    fn frame<L: Layout, P: Profile>(&mut self, frame: u32, words: usize, ticks: &mut Ticks) {
        let Self { clock, grid, maps, scratch, swept, window_rows, .. } = self;
        let (clock, budget) = (*clock, Static::<P>::new());
        let [front_memory, back_memory] = maps;
        back_memory[..words].copy_from_slice(&front_memory[..words]);
        let map = Galpixmap::<L, _>::over(*grid, budget, back_memory).expect("memory enough");
        let settings = Settings::for_depth(map.record().depth().bits.into());
        {
            let rows = rolling::rows(map.record(), settings.reach);
            let rolls = Grid::window(grid, rows, window_rows).expect("a row at least");
            let window = Galpixmap::over(rolls, budget, swept[0]).expect("memory enough");
            let scratch = Scratch { winners: scratch.winners, edges: scratch.edges };
            let mut rolling = Rolling::new(map, window, scratch).expect("rows and memory enough");
            rolling.set_frame(black_box(frame));
            ticks.rolling += clock.time(|| rolling.step(black_box(&settings))).0;
        }
        let front = Galpixmap::<L, _>::over(*grid, budget, front_memory).expect("memory enough");
        {
            let mut back = Galpixmap::<L, _>::over(*grid, budget, back_memory).expect("memory enough");
            let (rounding, frame) = (black_box(settings.rounding), black_box(frame));
            ticks.edge += clock.time(|| edge::mark(&front, black_box(settings.edge_threshold), scratch.edges)).0;
            ticks.sweep_alone += clock.time(|| sweep(&front, &mut back, black_box(&mut []), rounding, frame)).0;
            ticks.sweep += clock.time(|| sweep(&front, &mut back, scratch.winners, rounding, frame)).0;
        }
        let [swept, swept_winners] = swept;
        swept[..words].copy_from_slice(&back_memory[..words]);
        swept_winners.copy_from_slice(scratch.winners);
        for (rung, ticks) in Rung::ALL.into_iter().zip(&mut ticks.fill) {
            back_memory[..words].copy_from_slice(&swept[..words]);
            scratch.winners.copy_from_slice(swept_winners);
            let mut back = Galpixmap::<L, _>::over(*grid, budget, back_memory).expect("memory enough");
            let (rung, reach, mut tally) = (black_box(rung), black_box(settings.reach), Tally::default());
            let work = || fill(&front, &mut back, scratch.winners, scratch.edges, rung, reach, &mut tally);
            *ticks += clock.time(work).0;
            black_box(tally);
        }
        let mut back = Galpixmap::<L, _>::over(*grid, budget, back_memory).expect("memory enough");
        let work = || step(&front, &mut back, scratch, black_box(&settings), black_box(frame));
        ticks.frame += clock.time(work).0;
    }

    fn constant<L: Layout, P: Profile>(&mut self, layout: &'static str, picture: Picture) {
        let Self { clock, band, maps: [front, back], scratch, .. } = self;
        let budget = Static::<P>::new();
        let mut front = Galpixmap::<L, _>::new(*band, budget, front).expect("memory enough");
        picture.paint(&mut front);
        for rung in [Rung::Bullet, Rung::Extend] {
            let mut back = Galpixmap::<L, _>::new(*band, budget, back).expect("memory enough");
            let depth_bits = front.record().depth().bits.into();
            let settings = Settings { work: Work::Constant, rung, ..Settings::for_depth(depth_bits) };
            let work = || step(&front, &mut back, scratch, black_box(&settings), black_box(1));
            let (ticks, _) = clock.time(work);
            let (picture, mode) = (picture.name(), settings.work.name());
            print(&Row { layout, picture, mode, stage: "frame", rung: rung.name() }, ticks, band.cells());
        }
    }

    /// Scan-out, and a copy of the map's words.
    fn whatever_the_picture<L: Layout, P: Profile>(&mut self, layout: &'static str, words: usize) {
        let row = Row { layout, picture: "any", mode: "-", stage: "", rung: "-" };
        let [front, back] = &mut self.maps;
        let (ticks, ()) = self.clock.time(|| {
            black_box(&mut back[..words]).copy_from_slice(black_box(&front[..words]));
        });
        print(&Row { stage: "copy", ..row }, ticks, self.grid.cells());
        let map = Galpixmap::<L, _>::over(self.grid, Static::<P>::new(), front).expect("memory enough");
        let (ticks, _) = self.clock.time(|| {
            let rows = 0..map.grid().display_height();
            rows.map(|y| scan_out::row(&map, y).fold(0, u32::wrapping_add)).fold(0, u32::wrapping_add)
        });
        print(&Row { stage: "scan-out", ..row }, ticks, self.grid.cells());
    }
}
