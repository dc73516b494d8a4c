//! The colours of what is put into holes, the same in all plots.

use galpix_core::FillMode;

use crate::engine::fill::{Fill, Inpaint, Kind};
use crate::output::html::style::Ink;

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
