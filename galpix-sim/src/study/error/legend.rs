//! The legends of the plots: fill modes by colour, roundings by shape, bytes by size.

use galpix_core::Rounding;
use maud::{Markup, PreEscaped, html};

use super::report::{Point, Scheme, SourceReport};
use crate::engine::fill::Fill;
use crate::output::html::line_key;
use crate::output::html::scatter::{self, Shape};
use crate::output::html::style::Ink;
use crate::output::html::text::Text;
use crate::study::ink;

/// Returns the colour of a point.
pub fn ink(point: &Point) -> Ink {
    if point.scheme == Scheme::F32 {
        return Ink::Label;
    }
    ink::named(point.fill).unwrap_or_else(|| ink::of(Fill::default()))
}

/// Returns the shape of a point.
pub fn shape(point: &Point) -> Shape {
    if point.scheme == Scheme::Source {
        return Shape::Cross;
    }
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

/// Returns the radius of a mark, whose area grows with the bytes.
pub fn radius(bytes: usize) -> f64 {
    1.35 * (bytes as f64).sqrt()
}

/// Returns a layer in a legend.
pub fn block_key(name: &str, ink: Ink) -> Markup {
    mark_key(name, Shape::Square, ink, 6.0)
}

fn mark_key(name: &str, shape: Shape, ink: Ink, radius: f64) -> Markup {
    html! { span { (PreEscaped(scatter::key(shape, ink, radius))) (Text(name)) } " " }
}

/// Returns the legend of the points: fill modes by colour, roundings by shape, bytes by size.
pub fn key(source: &SourceReport, bounds: bool) -> Markup {
    let points = &source.points;
    let used = |fill: &Fill| points.iter().any(|p| p.scheme != Scheme::F32 && p.fill == fill.name());
    let rounded =
        |rounding: &Rounding| points.iter().any(|p| p.scheme == Scheme::Galpix && p.rounding == Some(rounding.name()));
    let sizes = points.iter().map(|point| point.bytes);
    let ends = sizes.clone().min().into_iter().chain(sizes.max());
    html! {
        @for fill in Fill::all().into_iter().filter(used) { (mark_key(fill.name(), Shape::Disc, ink::of(fill), 5.0)) }
        @for rounding in Rounding::ALL.into_iter().filter(rounded) {
            (mark_key(rounding.name(), rounding_shape(rounding), Ink::Axis, 5.0))
        }
        @if points.iter().any(|point| point.scheme == Scheme::F32) { (mark_key("f32", Shape::Cross, Ink::Label, 5.0)) }
        @if points.iter().any(|point| point.scheme == Scheme::Source) {
            (mark_key("stationary sources", Shape::Cross, Ink::Axis, 5.0))
        }
        @for bytes in ends { (mark_key(&format!("{bytes} bytes"), Shape::Disc, Ink::Axis, radius(bytes))) }
        (line_key("front", Ink::Guide, false))
        @if bounds { (line_key("worst measured", Ink::Bound, false)) }
    }
}
