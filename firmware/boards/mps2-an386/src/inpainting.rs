//! Push-pull after a frame: stretched quads, then colours, then colours with their motion.

use core::hint::black_box;

use galpix_core::inpaint::{Gamma, Motion, PushPull};
use galpix_core::stages::lay_background;
use galpix_core::{Controller, Galpixmap, Inpainting, Profile, Scratch, Settings, Static};

use crate::bench::Bench;
use crate::pictures::Picture;
use crate::report::{Row, SKIPPING, print, print_hundredths};

/// Ticks and holes over some frames.
#[derive(Default)]
pub struct Counts {
    frames: u32,
    holes: u32,
    quads: u64,
    moving: u64,
    colours: u64,
}

impl Bench {
    /// Inpaints the second map and leaves it as it was: with quads, if it is the frame after the first one.
    pub fn inpaint<P: Profile>(&mut self, frame: Option<u32>, words: usize, counts: &mut Counts) {
        let Self { clock, grid, maps: [front, back], scratch, swept: [kept, _], push_pull: memory, .. } = self;
        let (clock, format) = (*clock, Static::<P>::new());
        kept[..words].copy_from_slice(&back[..words]);
        {
            let front = Galpixmap::over(*grid, format, front).expect("memory enough");
            let mut map = Galpixmap::over(*grid, format, back).expect("memory enough");
            let bits = map.record().depth().bits.into();
            let settings = Settings::for_depth(bits);
            if let Some(frame) = frame {
                let (rounding, frame) = (black_box(settings.rounding), black_box(frame));
                counts.quads += clock.time(|| lay_background(&front, &mut map, scratch.edges, rounding, frame)).0;
            }
            let inpainting = Inpainting { quads: false, ..Inpainting::for_depth(bits, Gamma::Zero) };
            let mut controller = Controller::new(map, front, Scratch::default()).expect("maps of one grid");
            // What is put into holes is asked by nobody: the second finds what the first has found.
            for motion in [Motion::Kept, Motion::Inpainted] {
                let mut push_pull = PushPull::new(grid.width(), grid.height(), motion, memory).expect("memory enough");
                let (settings, inpainting) = (black_box(&settings), black_box(&inpainting));
                let (ticks, holes) = clock.time(|| controller.inpaint(settings, inpainting, &mut push_pull));
                match motion {
                    Motion::Kept => counts.colours += ticks,
                    Motion::Inpainted => {
                        counts.moving += ticks;
                        counts.holes += holes;
                    }
                }
            }
            counts.frames += 1;
        }
        back[..words].copy_from_slice(&kept[..words]);
    }

    /// Inpaints a picture of which a twentieth is holes.
    pub fn torn<P: Profile>(&mut self, layout: &'static str, words: usize) {
        let mut map = Galpixmap::new(self.grid, Static::<P>::new(), self.maps[1]).expect("memory enough");
        Picture::Torn.paint(&mut map);
        let mut counts = Counts::default();
        self.inpaint::<P>(None, words, &mut counts);
        let (picture, mode) = (Picture::Torn.name(), SKIPPING);
        counts.print(Row { layout, picture, mode, stage: "", rung: "-" }, self.grid.cells());
    }
}

impl Counts {
    /// A row for each kind: a galpixel of the whole map, and a hole.
    pub fn print(&self, row: Row, galpixels: u32) {
        let Self { frames, holes, quads, moving, colours } = *self;
        let all = galpixels * frames;
        print_hundredths(&Row { stage: "holes-%", ..row }, u64::from(holes) * 10_000 / u64::from(all));
        if quads > 0 {
            print(&Row { stage: "quads", ..row }, quads, all);
        }
        print(&Row { stage: "push-pull", ..row }, moving, all);
        print(&Row { stage: "push-pull-colour", ..row }, colours, all);
        if holes > 0 {
            print(&Row { stage: "push-pull-a-hole", ..row }, moving, holes);
        }
    }
}
