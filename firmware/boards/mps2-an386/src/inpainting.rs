//! Push-pull after a frame: stretched quads, then sparse and dense, for colours and for colours with their motion.

use core::hint::black_box;

use galpix_core::inpaint::map::{OfGalpixel, Uncovered};
use galpix_core::inpaint::paint::{Moving, Tint};
use galpix_core::inpaint::push_pull::{Rule, dense, sparse};
use galpix_core::inpaint::pyramid::{Cell, Pyramid};
use galpix_core::inpaint::quads::lay_background;
use galpix_core::inpaint::validity::Gamma;
use galpix_core::{Format, Galpixmap, Inpainting, Profile, Settings, Static};

use crate::bench::Bench;
use crate::clock::Clock;
use crate::pictures::Picture;
use crate::report::{Row, SKIPPING, print, print_hundredths};

/// Memory of the pyramids, and of their states.
pub struct Pyramids {
    /// For colours.
    pub tints: &'static mut [Cell<Tint>],
    /// For colours and motion.
    pub moving: &'static mut [Cell<Moving>],
    /// For either.
    pub states: &'static mut [u32],
}

/// Ticks and holes over some frames.
#[derive(Default)]
pub struct Counts {
    frames: u32,
    holes: u32,
    quads: u64,
    moving: u64,
    colours: u64,
    dense: u64,
}

/// Which cells of a pyramid push-pull completes.
enum Arrangement {
    /// Those that some hole needs.
    Sparse,
    /// All.
    Dense,
}

/// Times one arrangement of push-pull.
fn filled<F: Format, V: OfGalpixel>(
    clock: Clock,
    map: &mut Galpixmap<'_, F>,
    (cells, states): (&mut [Cell<V>], &mut [u32]),
    rule: &Rule,
    arrangement: Arrangement,
) -> (u64, u32) {
    let [width, height] = [map.grid().width(), map.grid().height()];
    let mut pyramid = Pyramid::new(width, height, cells, states).expect("memory enough");
    let mut picture = Uncovered::<F, V>::new(map, &[]);
    let rule = black_box(rule);
    match arrangement {
        Arrangement::Sparse => clock.time(|| sparse(&mut picture, &mut pyramid, rule)),
        Arrangement::Dense => clock.time(|| dense(&mut picture, &mut pyramid, rule)),
    }
}

impl Bench {
    /// Inpaints the second map and leaves it as it was: with quads, if it is the frame after the first one.
    pub fn inpaint<P: Profile>(&mut self, frame: Option<u32>, words: usize, counts: &mut Counts) {
        let Self { clock, grid, maps: [front, back], scratch, swept: [kept, _], pyramids, .. } = self;
        let (clock, format) = (*clock, Static::<P>::new());
        kept[..words].copy_from_slice(&back[..words]);
        {
            let front = Galpixmap::over(*grid, format, front).expect("memory enough");
            let mut map = Galpixmap::over(*grid, format, back).expect("memory enough");
            let bits = map.record().depth().bits.into();
            let (settings, rule) = (Settings::for_depth(bits), Inpainting::for_depth(bits, Gamma::Zero).rule);
            if let Some(frame) = frame {
                let (rounding, frame) = (black_box(settings.rounding), black_box(frame));
                counts.quads += clock.time(|| lay_background(&front, &mut map, scratch.edges, rounding, frame)).0;
            }
            let Pyramids { tints, moving, states } = pyramids;
            // What is put into holes is asked by nobody: each arrangement finds what the one before has found.
            let (ticks, _) = filled(clock, &mut map, (tints, states), &rule, Arrangement::Sparse);
            counts.colours += ticks;
            let (ticks, holes) = filled(clock, &mut map, (moving, states), &rule, Arrangement::Sparse);
            counts.moving += ticks;
            counts.holes += holes;
            let (ticks, _) = filled(clock, &mut map, (moving, states), &rule, Arrangement::Dense);
            counts.dense += ticks;
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
    /// A row for each arrangement: a galpixel of the whole map, and a hole.
    pub fn print(&self, row: Row, galpixels: u32) {
        let Self { frames, holes, quads, moving, colours, dense } = *self;
        let all = galpixels * frames;
        print_hundredths(&Row { stage: "holes-%", ..row }, u64::from(holes) * 10_000 / u64::from(all));
        if quads > 0 {
            print(&Row { stage: "quads", ..row }, quads, all);
        }
        print(&Row { stage: "push-pull", ..row }, moving, all);
        print(&Row { stage: "push-pull-colour", ..row }, colours, all);
        print(&Row { stage: "push-pull-dense", ..row }, dense, all);
        if holes > 0 {
            print(&Row { stage: "push-pull-a-hole", ..row }, moving, holes);
        }
    }
}
