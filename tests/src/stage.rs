//! The built-in scenes as maps.

use fixed::types::I32F32;
use galpix_core::{FillMode, Format, Galpixel, Galpixmap, Margin, Rounding, Settings};
use galpix_sim::engine::galpixel;
use galpix_sim::source::scene::{self, Scene};
use galpix_sim::update::Update;

use crate::memory::{Shape, with_maps, words};

/// The update of a scene at its beginning, and the shape of its maps.
pub struct Stage {
    /// The scene.
    pub scene: &'static dyn Scene,
    /// Its update.
    pub update: Update,
    /// What a map of it looks like.
    pub shape: Shape,
}

/// Returns all built-in scenes.
pub fn all() -> impl Iterator<Item = Stage> {
    scene::all().iter().map(|&scene| {
        let update = scene::update(scene, 0.0);
        let margin = update.margin;
        let [left, right, top, bottom] = [margin.left, margin.right, margin.top, margin.bottom].map(|n| n as u32);
        let shape = Shape {
            width: update.display_width() as u32,
            height: update.display_height() as u32,
            margin: Margin { left, right, top, bottom },
        };
        Stage { scene, update, shape }
    })
}

impl Stage {
    /// Returns the words of the update, each galpixel after `change`, in a format.
    pub fn content<F: Format>(&self, format: F, change: impl Fn(&mut Galpixel)) -> Vec<u32> {
        with_maps(self.shape, format, None, |mut front, _| {
            self.load(&mut front, change);
            words(&front)
        })
    }

    /// Stores the update, each galpixel after `change`.
    pub fn load<F: Format>(&self, map: &mut Galpixmap<'_, F>, change: impl Fn(&mut Galpixel)) {
        for (y, row) in (0..).zip(self.update.samples.chunks(self.update.width)) {
            for (x, sample) in (0..).zip(row) {
                let mut stored = galpixel(sample);
                change(&mut stored);
                map.store(x, y, &stored).expect("the update has the size of the map");
            }
        }
    }
}

/// Returns every fill mode, and a rounding with each: over three turns, every fill mode with every rounding.
pub fn settings_in_turn(turn: usize, depth_bits: u8) -> impl Iterator<Item = Settings> {
    (turn..).zip(FillMode::ALL).map(move |(turn, fill_mode)| {
        let rounding = Rounding::ALL[turn % Rounding::ALL.len()];
        // More rounds of bullet filling for one of the roundings.
        let reach = if rounding == Rounding::Nearest { 3 } else { 1 };
        Settings { rounding, fill_mode, reach, ..Settings::for_depth(depth_bits.into()) }
    })
}

/// Returns the settings for a map's own depth.
#[must_use]
pub fn settings<F: Format>(map: &Galpixmap<'_, F>) -> Settings {
    Settings::for_depth(u32::from(map.record().depth().bits))
}

/// Returns a number with units, from a decimal that is a multiple of `2^-32`.
#[must_use]
pub fn number(value: f64) -> I32F32 {
    let number = I32F32::from_num(value);
    assert!(number == value, "{value} is no multiple of 2^-32");
    number
}
