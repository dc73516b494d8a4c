//! The report: one self-contained HTML page with animated pictures, plots and tables.
//!
//! Nothing is loaded from anywhere: pictures are data URIs, plots are inline SVG, the style is in the page. It reads
//! without a script; a small one adds play, pause and stepping to the films.
//!
//! ```text
//! Report ─▶ report (page: head, facts) ─▶ overview (one line per scene)
//!                     └─▶ story (film, certificate, table) ─▶ figures (which lines) ─▶ plot (SVG)
//! ```

pub(crate) mod axis;
mod canvas;
mod figures;
mod overview;
mod page;
pub(crate) mod plot;
mod report;
pub(crate) mod scatter;
pub(crate) mod stack;
mod story;
pub(crate) mod style;
pub(crate) mod text;

pub use super::save::write_atomically;
use crate::metric::measures::Measures;
use crate::picture::Picture;
pub(crate) use overview::cell;
pub(crate) use page::line_key;
pub use page::{Fact, Head, document, list, notes, picture, plot as plotted, reading, source};
pub use report::html;

/// The content of a report. All text is plain; it is escaped where it meets HTML.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Heading and window title.
    pub title: String,
    /// Paragraphs below the heading.
    pub intro: Vec<String>,
    /// Names and values about the run: version, machine, options.
    pub facts: Vec<Fact>,
    /// One per scene, in order.
    pub stories: Vec<Story>,
}

/// One scene extrapolated from one update.
#[derive(Clone, Debug, Default)]
pub struct Story {
    /// The scene's name; its heading and anchor.
    pub name: String,
    /// What the scene shows and stresses, one or two sentences.
    pub about: String,
    /// Columns of the display.
    pub width: usize,
    /// Rows of the display.
    pub height: usize,
    /// The bit budget in one line.
    pub budget_line: String,
    /// Name of the rounding.
    pub rounding: String,
    /// Name of the fill mode.
    pub fill: String,
    /// What the budget promises, where that was computed.
    pub certificate: Option<CertificateLine>,
    /// An animated PNG of the panels truth, sample-and-hold, galpix, difference; empty if there is none.
    pub film_apng: Vec<u8>,
    /// Where the error of a frame is seen, if that was worked out.
    pub heat: Option<Heat>,
    /// One per frame, frames ascending.
    pub rows: Vec<Row>,
    /// Remarks, one sentence or two each.
    pub notes: Vec<String>,
}

/// Where the error of a frame is seen.
#[derive(Clone, Debug)]
pub struct Heat {
    /// Frames since the update.
    pub frame: u32,
    /// FLIP of each pixel as a colour: black for equals, by red and orange to white.
    pub picture: Picture,
}

/// The certified error bound of a budget and a rounding, in pixels, without the snap to a cell.
#[derive(Clone, Debug, Default)]
pub struct CertificateLine {
    /// Share of the quantisation of position, velocity and acceleration.
    pub quantisation_px: f64,
    /// Share of the rounding drift.
    pub drift_px: f64,
    /// The bound at the budget's horizon.
    pub total_px: f64,
    /// Whether `total_px` keeps the paper's promise of one pixel.
    pub holds: bool,
    /// The bound after frame `n` at index `n`; index 0 is the update itself. May be empty.
    pub per_frame_px: Vec<f64>,
    /// The horizon, in frames.
    pub prop: u32,
}

/// What was measured in one frame. Figures that were not measured, or are not finite, are shown as a dash.
#[derive(Clone, Debug, Default)]
pub struct Row {
    /// Display frames after the update.
    pub frame: u32,
    /// FLIP of the shown frame against the truth.
    pub flip: Option<f64>,
    /// Shown frame against the truth.
    pub measures: Measures,
    /// Sample-and-hold against the truth, decibels.
    pub psnr_hold_db: Option<f64>,
    /// Shown frame against the truth, decibels, over the cells that a galpixel reached.
    pub psnr_known_db: Option<f64>,
    /// Worst measured position error of a galpixel against the exact second-order path, pixels.
    pub position_error_px: Option<f64>,
    /// Mean of the same, pixels.
    pub mean_position_error_px: Option<f64>,
    /// Worst position error against the true motion, with what second order cannot know, pixels.
    pub truth_error_px: Option<f64>,
    /// Cells that no galpixel reached.
    pub holes: u64,
    /// Holes that the fill mode filled.
    pub filled: u64,
    /// Galpixels that left the map.
    pub lost: u64,
    /// Galpixels that met a nearer one.
    pub collided: u64,
    /// Galpixels that a range had to stop.
    pub saturated: u64,
    /// Bullet holes filled.
    pub bullets: u64,
    /// Just-unobscured cells filled.
    pub unobscured: u64,
    /// Time of the frame, nanoseconds per galpixel.
    pub ns_per_galpixel: Option<f64>,
}

#[cfg(test)]
mod tests;
