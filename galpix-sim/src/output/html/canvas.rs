//! What the plots share: their resolution, their pens, and axes with chosen ticks. Only the plots and this file know
//! `plotters`.

use super::axis::Axis;
use super::style::Ink;
use super::text::Text;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::prelude::*;

/// Units of the drawing for each unit of the page: `plotters` places in whole units.
pub const FINE: u32 = 4;

/// Returns the colour of a role in the light scheme; the style sheet turns it into the reader's.
pub fn colour(ink: Ink) -> RGBColor {
    let [r, g, b] = ink.light();
    RGBColor(r, g, b)
}

/// Returns a line of `width` units of the page.
pub fn pen(ink: Ink, width: u32) -> ShapeStyle {
    colour(ink).stroke_width(width * FINE)
}

/// Returns a drawing of `width` x `height` units of the page as an element of a page, with its own opening tag instead
/// of the backend's, which fixes a size and names a namespace that HTML does not need.
pub fn element(drawing: &str, width: u32, height: u32, description: &str) -> Option<String> {
    let body = drawing.split_once('>')?.1;
    Some(format!(
        "<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">{body}",
        width * FINE,
        height * FINE,
        Text(description)
    ))
}

/// An axis as `plotters` wants it.
pub struct Ticked {
    ends: std::ops::Range<f64>,
    ticks: Vec<f64>,
}

impl Ticked {
    /// With these ends and ticks.
    pub fn new(ends: std::ops::Range<f64>, ticks: Vec<f64>) -> Self {
        Self { ends, ticks }
    }
}

impl From<&Axis> for Ticked {
    fn from(axis: &Axis) -> Self {
        Self::new(axis.ends.clone(), axis.ticks.clone())
    }
}

impl Ranged for Ticked {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let part = (value - self.ends.start) / (self.ends.end - self.ends.start);
        limit.0 + (part * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.ends.clone()
    }
}
