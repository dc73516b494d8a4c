//! The stages of a frame, one by one and together, for a layout and each picture.

use core::hint::black_box;

use galpix_core::rolling::{self, Rolling};
use galpix_core::stages::{fill, mark, sweep};
use galpix_core::{
    Controller, FillMode, Galpixmap, Grid, Profile, Scratch, Settings, Static, Tally, scan_out, sub_cell,
};

use crate::bench::Bench;
use crate::inpainting::Counts;
use crate::pictures::Picture;
use crate::report::{CONSTANT_TIME, Row, SKIPPING, print};

/// Frames that a picture goes on for with skipping: counts are their means.
const FRAMES: u32 = 4;

/// Ticks of each stage.
#[derive(Default)]
struct Ticks {
    edge: u64,
    sweep: u64,
    sweep_alone: u64,
    fill: [u64; FillMode::ALL.len()],
    frame: u64,
    rolling: u64,
    sub_cell: u64,
}

impl Bench {
    /// Measures a format.
    pub fn measure<P: Profile>(&mut self, layout: &'static str) {
        let words = Static::<P>::RECORD.words() * self.grid.cells() as usize;
        for picture in Picture::ALL {
            let mut map = Galpixmap::new(self.grid, Static::<P>::new(), self.painted).expect("memory enough");
            picture.paint(&mut map);
            self.skipping::<P>(layout, picture, words);
            self.sources::<P>(layout, picture);
        }
        self.torn::<P>(layout, words);
        for picture in Picture::ALL.into_iter().chain(Picture::EXTREMES) {
            self.constant_time::<P>(layout, picture);
        }
        self.whatever_the_picture::<P>(layout, words);
    }

    fn skipping<P: Profile>(&mut self, layout: &'static str, picture: Picture, words: usize) {
        let (mut ticks, mut inpainted) = (Ticks::default(), Counts::default());
        self.maps[0][..words].copy_from_slice(&self.painted[..words]);
        for frame in 0..FRAMES {
            self.frame::<P>(frame, words, &mut ticks);
            self.inpaint::<P>(Some(frame), words, &mut inpainted);
            self.maps.swap(0, 1);
        }
        let row = Row { layout, picture: picture.name(), mode: SKIPPING, stage: "", rung: "-" };
        let say = |row: Row, ticks: u64| print(&row, ticks, self.grid.cells() * FRAMES);
        say(Row { stage: "edge", ..row }, ticks.edge);
        say(Row { stage: "sweep", ..row }, ticks.sweep);
        say(Row { stage: "sweep-alone", ..row }, ticks.sweep_alone);
        for (fill_mode, ticks) in FillMode::ALL.into_iter().zip(ticks.fill) {
            say(Row { stage: "fill", rung: fill_mode.name(), ..row }, ticks);
        }
        say(Row { stage: "frame", rung: FillMode::default().name(), ..row }, ticks.frame);
        say(Row { stage: "rolling", rung: FillMode::default().name(), ..row }, ticks.rolling);
        say(Row { stage: "sub-cell", rung: FillMode::default().name(), ..row }, ticks.sub_cell);
        inpainted.print(row, self.grid.cells());
    }

    /// One frame in one map, then stage by stage, then as a whole, which is what stays.
    fn frame<P: Profile>(&mut self, frame: u32, words: usize, ticks: &mut Ticks) {
        let Self { clock, grid, maps, scratch, swept, window_rows, .. } = self;
        let (clock, format) = (*clock, Static::<P>::new());
        let [front_memory, back_memory] = maps;
        back_memory[..words].copy_from_slice(&front_memory[..words]);
        let map = Galpixmap::over(*grid, format, back_memory).expect("memory enough");
        let settings = Settings::for_depth(map.record().depth().bits.into());
        {
            let rows = rolling::rows(map.record(), settings.reach);
            let rolls = Grid::window(grid, rows, window_rows).expect("a row at least");
            let window = Galpixmap::over(rolls, format, swept[0]).expect("memory enough");
            let scratch = Scratch { winners: scratch.winners, edges: scratch.edges };
            let mut rolling = Rolling::new(map, window, scratch).expect("rows and memory enough");
            rolling.set_frame(black_box(frame));
            ticks.rolling += clock.time(|| rolling.step(black_box(&settings))).0;
        }
        let front = Galpixmap::over(*grid, format, front_memory).expect("memory enough");
        {
            let mut back = Galpixmap::over(*grid, format, back_memory).expect("memory enough");
            let (rounding, frame) = (black_box(settings.rounding), black_box(frame));
            ticks.edge += clock.time(|| mark(&front, black_box(settings.edge_threshold), scratch.edges)).0;
            ticks.sweep_alone += clock.time(|| sweep(&front, &mut back, black_box(&mut []), rounding, frame)).0;
            ticks.sweep += clock.time(|| sweep(&front, &mut back, scratch.winners, rounding, frame)).0;
        }
        let [swept, swept_winners] = swept;
        swept[..words].copy_from_slice(&back_memory[..words]);
        swept_winners.copy_from_slice(scratch.winners);
        for (fill_mode, ticks) in FillMode::ALL.into_iter().zip(&mut ticks.fill) {
            back_memory[..words].copy_from_slice(&swept[..words]);
            scratch.winners.copy_from_slice(swept_winners);
            let mut back = Galpixmap::over(*grid, format, back_memory).expect("memory enough");
            let (settings, mut tally) = (black_box(Settings { fill_mode, ..settings }), Tally::default());
            let work = || fill(&front, &mut back, scratch, &settings, &mut tally);
            *ticks += clock.time(work).0;
            black_box(tally);
        }
        let back = Galpixmap::over(*grid, format, back_memory).expect("memory enough");
        let scratch = Scratch { winners: scratch.winners, edges: scratch.edges };
        let mut controller = Controller::new(front, back, scratch).expect("maps of one grid");
        controller.set_frame(black_box(frame));
        ticks.frame += clock.time(|| controller.step(black_box(&settings))).0;
        let (map, threshold) = (controller.front(), black_box(settings.edge_threshold));
        let row = |y| sub_cell::row(map, threshold, y).fold(0, u32::wrapping_add);
        ticks.sub_cell += clock.time(|| (0..map.grid().display_height()).map(row).fold(0, u32::wrapping_add)).0;
    }

    fn constant_time<P: Profile>(&mut self, layout: &'static str, picture: Picture) {
        let Self { clock, band, maps: [front, back], scratch, .. } = self;
        let format = Static::<P>::new();
        picture.paint(&mut Galpixmap::new(*band, format, front).expect("memory enough"));
        for fill_mode in [FillMode::Bullet, FillMode::Extend] {
            let front = Galpixmap::over(*band, format, front).expect("memory enough");
            let back = Galpixmap::new(*band, format, back).expect("memory enough");
            let settings = Settings { fill_mode, ..Settings::for_depth(front.record().depth().bits.into()) };
            let scratch = Scratch { winners: scratch.winners, edges: scratch.edges };
            let mut controller = Controller::new(front, back, scratch).expect("maps of one grid");
            controller.set_frame(black_box(1));
            let (ticks, _) = clock.time(|| controller.step_constant_time(black_box(&settings)));
            let (picture, mode, rung) = (picture.name(), CONSTANT_TIME, fill_mode.name());
            print(&Row { layout, picture, mode, stage: "frame", rung }, ticks, band.cells());
        }
    }

    /// Scan-out, and a copy of the map's words.
    fn whatever_the_picture<P: Profile>(&mut self, layout: &'static str, words: usize) {
        let row = Row { layout, picture: "any", mode: "-", stage: "", rung: "-" };
        let [front, back] = &mut self.maps;
        let (ticks, ()) = self.clock.time(|| {
            black_box(&mut back[..words]).copy_from_slice(black_box(&front[..words]));
        });
        print(&Row { stage: "copy", ..row }, ticks, self.grid.cells());
        let map = Galpixmap::over(self.grid, Static::<P>::new(), front).expect("memory enough");
        let (ticks, _) = self.clock.time(|| {
            let rows = 0..map.grid().display_height();
            rows.map(|y| scan_out::row(&map, y).fold(0, u32::wrapping_add)).fold(0, u32::wrapping_add)
        });
        print(&Row { stage: "scan-out", ..row }, ticks, self.grid.cells());
    }
}
