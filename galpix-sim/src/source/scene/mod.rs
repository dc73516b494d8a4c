//! The built-in scenes: small worlds whose truth is known exactly.
//!
//! A scene is a list of [`Surface`]s. What is seen at a place and time, how it moves there, and where it is at any
//! other time all follow from the same closed formulas, so that an extrapolated picture can be compared with a picture
//! that was rendered for real at the later time, and every galpixel with the place where its point of the surface truly
//! is.

mod ball;
mod behind;
mod crossing;
mod disc;
mod drift;
mod fovea;
mod hud;
pub mod jet;
mod near_plane;
mod pan;
mod pillars;
mod ramp;
pub mod solid;
mod sphere;
mod still;
pub mod surface;
pub mod texture;

#[cfg(test)]
mod tests;

pub use behind::{Peel, behind, each};

use crate::overlay::Overlay;
use crate::picture::Picture;
use crate::update::{DepthKind, Known, Margin, Sample, Update};
use jet::Jet;
use rayon::prelude::*;
use surface::{Hit, Surface};
use texture::{Rgb, round};

/// A world with exact truth. Positions are display pixels, times are frames after the update.
pub trait Scene: Sync {
    /// Returns what it is called on the command line.
    fn name(&self) -> &'static str;

    /// Returns one line: what it shows and what it stresses.
    fn about(&self) -> &'static str;

    /// Returns the columns of the display.
    fn width(&self) -> usize {
        192
    }

    /// Returns the rows of the display.
    fn height(&self) -> usize {
        144
    }

    /// Returns what an update renders beyond the display.
    fn margin(&self) -> Margin {
        Margin::default()
    }

    /// Returns how many frames it is meant to be extrapolated from the update at t = 0.
    fn frames(&self) -> u32;

    /// Returns whether every visible point moves exactly by `r + v t + a t² / 2` in x and y, so that second order knows
    /// it all.
    fn second_order(&self) -> bool;

    /// Returns how its depths came about.
    fn depth_kind(&self) -> DepthKind {
        DepthKind::Z
    }

    /// Returns what is pinned over the picture and never moves: of the display's size.
    fn overlay(&self) -> Option<Overlay> {
        None
    }

    /// Returns what the world is built of. Surface `i` has the tag `i + 1`; of two at the same depth the earlier one is
    /// seen.
    fn surfaces(&self) -> &[&dyn Surface];

    /// Returns the surface point seen at (`x`, `y`) at time `t`, with its motion there and then. Where no surface is,
    /// the world is black, still and infinitely far.
    fn sample(&self, x: f64, y: f64, t: f64) -> Sample {
        let Some((index, hit)) = nearest(self.surfaces(), x, y, t) else {
            return Sample { depth: 1.0, ..Sample::default() };
        };
        seen(self.surfaces()[index], index, &hit, t)
    }

    /// Returns where the surface point that is seen at (`x`, `y`) at time `t0` is at time `t`, be it visible then or
    /// not: x, y and normalised depth.
    fn track(&self, x: f64, y: f64, t0: f64, t: f64) -> [f64; 3] {
        match nearest(self.surfaces(), x, y, t0) {
            Some((index, hit)) => self.surfaces()[index].place(hit.point, Jet::constant(t)).map(|place| place.value),
            None => [x, y, 1.0],
        }
    }
}

/// The point of one surface, its back's if `back`, that is seen or hidden at (`x`, `y`) at time `t`; nothing if the
/// surface is not there. As [`Scene::sample`] has it where it is seen.
#[must_use]
pub fn sample_of(scene: &dyn Scene, surface: usize, back: bool, [x, y]: [f64; 2], t: f64) -> Option<Sample> {
    let on = *scene.surfaces().get(surface)?;
    let hit = if back { on.behind(x, y, t) } else { on.hit(x, y, t) };
    Some(seen(on, surface, &hit?, t))
}

/// Returns what is known of a point of surface `index` at time `t`.
pub(crate) fn seen(surface: &dyn Surface, index: usize, hit: &Hit, t: f64) -> Sample {
    let place = surface.place(hit.point, Jet::time(t));
    Sample {
        colour: round(colour(surface, hit, t)),
        known: Known::Motion,
        depth: hit.depth,
        velocity: place.map(|coordinate| coordinate.velocity),
        acceleration: place.map(|coordinate| coordinate.acceleration),
        luminosity_rate: surface.luminosity_rate(hit.point),
        tag: index as u8 + 1,
    }
}

/// Returns the foremost surface at a place of the display.
fn nearest(surfaces: &[&dyn Surface], x: f64, y: f64, t: f64) -> Option<(usize, Hit)> {
    let hits = surfaces.iter().enumerate().filter_map(|(index, surface)| Some((index, surface.hit(x, y, t)?)));
    hits.min_by(|(_, a), (_, b)| a.depth.total_cmp(&b.depth))
}

/// Returns the colour of a point at time `t`: luminosity is added alike to each of the three channels.
fn colour(surface: &dyn Surface, hit: &Hit, t: f64) -> Rgb {
    let gained = surface.luminosity_rate(hit.point) * t;
    surface.colour(hit.point).map(|channel| channel + gained)
}

/// Returns the update that a renderer would deliver at time `t`: one point sample per cell, margin included. Cell (i,
/// j) of the map is at the display position (i - `margin.left`, j - `margin.top`).
#[must_use]
pub fn update(scene: &dyn Scene, t: f64) -> Update {
    let margin = scene.margin();
    let width = margin.left + scene.width() + margin.right;
    let height = margin.top + scene.height() + margin.bottom;
    let row = |j: usize| {
        let y = j as f64 - margin.top as f64;
        (0..width).map(move |i| scene.sample(i as f64 - margin.left as f64, y, t))
    };
    let samples = (0..height).into_par_iter().flat_map_iter(row).collect();
    Update { width, height, margin, samples, depth_kind: scene.depth_kind(), overlay: scene.overlay() }
}

/// Returns the true picture on the display at time `t`, sampled anew from the world under what is pinned; nothing is
/// warped.
#[must_use]
pub fn render(scene: &dyn Scene, t: f64) -> Picture {
    let (width, height) = (scene.width(), scene.height());
    let pixel = |x: usize, y: usize| match nearest(scene.surfaces(), x as f64, y as f64, t) {
        Some((index, hit)) => round(colour(scene.surfaces()[index], &hit, t)),
        None => [0; 3],
    };
    let pixels = (0..height).into_par_iter().flat_map_iter(|y| (0..width).map(move |x| pixel(x, y))).collect();
    let picture = Picture { width, height, pixels };
    match scene.overlay() {
        Some(overlay) => overlay.over(picture),
        None => picture,
    }
}

/// Returns every built-in scene, from the calmest to the wildest.
#[must_use]
pub fn all() -> &'static [&'static dyn Scene] {
    &[
        &still::Still,
        &drift::Drift,
        &pan::Pan,
        &ramp::Ramp,
        &pillars::Pillars,
        &crossing::Crossing,
        &disc::Disc,
        &sphere::Sphere,
        &near_plane::NearPlane,
        &ball::Ball,
        &fovea::Fovea,
        &hud::Hud,
    ]
}

/// Returns the built-in scene called `name`.
#[must_use]
pub fn find(name: &str) -> Option<&'static dyn Scene> {
    all().iter().copied().find(|scene| scene.name() == name)
}
