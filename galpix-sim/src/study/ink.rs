//! The colours of what is put into holes, the same in all plots, and of directions, the same in all pictures.

use galpix_core::FillMode;

use crate::engine::fill::{Fill, Inpaint, Kind};
use crate::output::html::style::Ink;

/// Returns the direction of a vector as a hue; the lighter the smaller beside the longest one, and grey where there is
/// none.
pub(crate) fn direction([x, y]: [f64; 2], longest: f64) -> [u8; 3] {
    let length = x.hypot(y);
    if length == 0.0 {
        return [96; 3];
    }
    let (angle, strength) = (y.atan2(x), 0.35 + 0.65 * (length / longest).min(1.0));
    [0.0, 1.0, 2.0].map(|third| {
        let hue = 0.5 + 0.5 * (angle - third * std::f64::consts::TAU / 3.0).cos();
        (255.0 * (1.0 - strength + strength * hue)).round() as u8
    })
}

/// Returns the colour of a fill.
pub(crate) const fn of(fill: Fill) -> Ink {
    let mode = match fill {
        Fill::Inpaint(Inpaint { kind: Kind::PushPull, .. }) => return Ink::Bound,
        Fill::Inpaint(Inpaint { kind: Kind::Metamer, .. }) => return Ink::Lost,
        Fill::Mode(mode) => mode,
    };
    match mode {
        FillMode::None => Ink::Collided,
        FillMode::Hold => Ink::Hold,
        FillMode::Debris => Ink::Holes,
        FillMode::Bullet => Ink::Known,
        FillMode::Galdebris => Ink::Filled,
        FillMode::Extend => Ink::Galpix,
    }
}

/// Returns the colour of the fill with this name, if there is one.
pub(crate) fn named(name: &str) -> Option<Ink> {
    Fill::all().into_iter().find(|fill| fill.name() == name).map(of)
}
