//! The legends of the plots: rungs by colour, roundings by shape, bytes by size.

use galpix_core::{FillMode, Rounding};

use super::report::{Point, Scheme, SourceReport};
use crate::engine::fill::{Fill, Inpaint, Kind};
use crate::output::html::scatter::{self, Shape};
use crate::output::html::style::Ink;
use crate::output::html::text::Text;

/// The colour of a point.
pub fn ink(point: &Point) -> Ink {
    if point.scheme == Scheme::F32 {
        return Ink::Label;
    }
    fill_ink(Fill::all().into_iter().find(|fill| fill.name() == point.rung).unwrap_or_default())
}

/// The colour of what is put into holes.
pub(crate) const fn fill_ink(fill: Fill) -> Ink {
    let rung = match fill {
        Fill::Inpaint(Inpaint { kind: Kind::PushPull, .. }) => return Ink::Bound,
        Fill::Inpaint(Inpaint { kind: Kind::Metamer, .. }) => return Ink::Lost,
        Fill::Rung(rung) => rung,
    };
    match rung {
        FillMode::None => Ink::Collided,
        FillMode::Hold => Ink::Hold,
        FillMode::Debris => Ink::Holes,
        FillMode::Bullet => Ink::Known,
        FillMode::Galdebris => Ink::Filled,
        FillMode::Extend => Ink::Galpix,
    }
}

/// The shape of a point.
pub fn shape(point: &Point) -> Shape {
    let rounding = Rounding::ALL.into_iter().find(|rounding| Some(rounding.name()) == point.rounding);
    rounding.map_or(Shape::Cross, rounding_shape)
}

const fn rounding_shape(rounding: Rounding) -> Shape {
    match rounding {
        Rounding::Truncate => Shape::Triangle,
        Rounding::Nearest => Shape::Square,
        Rounding::LowDiscrepancy => Shape::Disc,
        Rounding::Searched => Shape::Diamond,
    }
}

/// The area of a mark grows with the bytes.
pub fn radius(bytes: usize) -> f64 {
    1.35 * (bytes as f64).sqrt()
}

/// A line in a legend.
pub fn line_key(name: &str, ink: Ink, dashed: bool) -> String {
    let kind = if dashed { "key dashed" } else { "key" };
    format!("<span><i class=\"{kind}\" style=\"--ink:var(--{})\"></i>{}</span> ", ink.name(), Text(name))
}

/// A layer in a legend.
pub fn block_key(name: &str, ink: Ink) -> String {
    format!("<span>{}{}</span> ", scatter::key(Shape::Square, ink, 6.0), Text(name))
}

/// The legend of the points: rungs by colour, roundings by shape, bytes by size.
pub fn key(source: &SourceReport, bounds: bool) -> String {
    let entry =
        |shape, ink, radius, name: &str| format!("<span>{}{}</span> ", scatter::key(shape, ink, radius), Text(name));
    let mut legend = String::new();
    for fill in Fill::all() {
        if source.points.iter().any(|point| point.scheme == Scheme::Galpix && point.rung == fill.name()) {
            legend += &entry(Shape::Disc, fill_ink(fill), 5.0, fill.name());
        }
    }
    for rounding in Rounding::ALL {
        if source.points.iter().any(|point| point.rounding == Some(rounding.name())) {
            legend += &entry(rounding_shape(rounding), Ink::Axis, 5.0, rounding.name());
        }
    }
    if source.points.iter().any(|point| point.scheme == Scheme::F32) {
        legend += &entry(Shape::Cross, Ink::Label, 5.0, "f32");
    }
    let sizes = source.points.iter().map(|point| point.bytes);
    if let (Some(least), Some(most)) = (sizes.clone().min(), sizes.max()) {
        for bytes in [least, most] {
            legend += &entry(Shape::Disc, Ink::Axis, radius(bytes), &format!("{bytes} bytes"));
        }
    }
    legend += &line_key("front", Ink::Guide, false);
    if bounds {
        legend += &line_key("at most", Ink::Bound, false);
    }
    legend
}
