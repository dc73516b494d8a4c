//! The renderer on the device: delivers an update of a built-in scene every [`EVERY`] frames, some rows a frame.
//!
//! A whole update takes [`TAKES`] frames, as it would over a line, so that no frame has to make room for all of it.
//! Each row is exact when it enters the map. All rows of an update carry its number as their tag.

use fixed::types::I32F32;
use galpix_core::record::MAX_WORDS;
use galpix_core::{Delay, Format, Galpixel, Galpixmap, Rounding, graft};
use heapless::Vec;

use crate::scene::{Body, Number, Scene};

/// Frames from the begin of one update to the next. A power of two.
pub const EVERY: u32 = 16;
/// Frames that an update takes. A power of two.
pub const TAKES: u32 = 16;

/// The most bodies of a scene.
const MOST: usize = 8;

/// What all galpixels of a body have in common at a time.
struct Model {
    body: &'static Body,
    place: [Number; 2],
    words: [u32; MAX_WORDS],
    colours: [u32; 2],
}

/// A scene that is shown since a frame.
#[derive(Clone, Copy, Debug)]
pub struct Renderer {
    scene: &'static Scene,
    since: u32,
}

impl Renderer {
    /// A scene that begins when the frame counter is `now`.
    #[must_use]
    pub const fn new(scene: &'static Scene, now: u32) -> Self {
        Self { scene, since: now }
    }

    /// Puts the scene's first update into a map, as a whole.
    pub fn begin<F: Format>(&self, map: &mut Galpixmap<'_, F>) {
        map.clear();
        self.rows(map, 0, map.grid().display_height(), self.since);
    }

    /// Puts the rows whose turn it is into a map whose frame counter is `now`.
    pub fn next<F: Format>(&self, map: &mut Galpixmap<'_, F>, now: u32) {
        let (age, height) = (now.wrapping_sub(self.since), map.grid().display_height());
        let turn = age & (EVERY - 1);
        if age != 0 && turn < TAKES {
            let row = |turn: u32| height * turn / TAKES;
            self.rows(map, row(turn), row(turn + 1), now);
        }
    }

    fn rows<F: Format>(&self, map: &mut Galpixmap<'_, F>, from: u32, to: u32, now: u32) {
        let age = now.wrapping_sub(self.since);
        let (width, height) = (map.grid().display_width() as i32, map.grid().display_height() as i32);
        let zoom = (height >> 6).max(1);
        let models: Vec<Model, MOST> =
            self.scene.bodies.iter().take(MOST).map(|body| model(map, body, age, zoom)).collect();
        for y in from as i32..to as i32 {
            for x in 0..width {
                let from_centre = [x - (width >> 1), y - (height >> 1)].map(Number::from_num::<i32>);
                let seen = models.iter().find_map(|model| {
                    let place = [from_centre[0] - model.place[0], from_centre[1] - model.place[1]];
                    Some((model, model.body.seen(place, zoom)?))
                });
                let Some((model, colour)) = seen else { continue };
                let words = map.recoloured(model.words, model.colours[colour & 1]);
                graft(map, (x, y), &words, Delay { stamp: now, now, rounding: Rounding::LowDiscrepancy });
            }
        }
    }
}

/// A body at frame `age` of its scene, as this map stores it.
fn model<F: Format>(map: &Galpixmap<'_, F>, body: &'static Body, age: u32, zoom: i32) -> Model {
    let placed = body.at(age, zoom);
    let [x, y] = placed.velocity.map(I32F32::from_num::<Number>);
    let [x_change, y_change] = placed.acceleration.map(I32F32::from_num::<Number>);
    let (words, _) = map.stored(&Galpixel {
        depth: I32F32::from_num(body.depth) >> 4,
        velocity: [x, y, I32F32::ZERO],
        acceleration: [x_change, y_change, I32F32::ZERO],
        tag: age / EVERY,
        ..Galpixel::default()
    });
    let colour = map.record().colour_format();
    Model { body, place: placed.place, words, colours: body.texture.colours.map(|rgb| colour.from_rgb888(rgb)) }
}
