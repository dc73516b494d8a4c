//! The built-in scenes as maps.

use fixed::types::I32F32;
use galpix_core::frame::Settings;
use galpix_core::galpixel::{Budget, Galpixel};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::Wings;
use galpix_core::layout::Layout;
use galpix_sim::engine::galpixel;
use galpix_sim::scene::{self, Scene};
use galpix_sim::update::Update;

use crate::lent::Shape;

/// The update of a scene at its beginning, and the shape of its maps.
pub struct Stage {
    /// The scene.
    pub scene: &'static dyn Scene,
    /// Its update.
    pub update: Update,
    /// What a map of it looks like.
    pub shape: Shape,
}

/// All built-in scenes.
pub fn all() -> impl Iterator<Item = Stage> {
    scene::all().iter().map(|&scene| {
        let update = scene::update(scene, 0.0);
        let wings = update.wings;
        let [left, right, top, bottom] = [wings.left, wings.right, wings.top, wings.bottom].map(|n| n as u32);
        let shape = Shape {
            width: update.display_width() as u32,
            height: update.display_height() as u32,
            wings: Wings { left, right, top, bottom },
        };
        Stage { scene, update, shape }
    })
}

impl Stage {
    /// Stores the update, each galpixel after `change`.
    pub fn load<L: Layout, B: Budget<L>>(&self, map: &mut Galpixmap<'_, L, B>, change: impl Fn(&mut Galpixel)) {
        for (y, row) in (0..).zip(self.update.samples.chunks(self.update.width)) {
            for (x, sample) in (0..).zip(row) {
                let mut stored = galpixel(sample);
                change(&mut stored);
                map.store(x, y, &stored).expect("the update has the size of the map");
            }
        }
    }
}

/// The settings for a map's own depth.
#[must_use]
pub fn settings<L: Layout, B: Budget<L>>(map: &Galpixmap<'_, L, B>) -> Settings {
    Settings::for_depth(u32::from(map.record().depth().bits))
}

/// A number with units, from a decimal that is a multiple of `2^-32`.
#[must_use]
pub fn number(value: f64) -> I32F32 {
    let number = I32F32::from_num(value);
    assert!(number == value, "{value} is no multiple of 2^-32");
    number
}
