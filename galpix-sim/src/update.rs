//! A rendered picture with the motion of each pixel, as a renderer or a capture delivers it: in floating point, before
//! a bit budget is chosen.
//!
//! *Units:* positions in pixels, x to the right, y down, sample (i, j) at the integer point (i, j). Time in display
//! frames. *Depth* is normalised: 0 is the nearest depth that can be stored, 1 the farthest, and in between it is
//! linear in *inverse* distance (`depth = 1 - near / z`), as in a z-buffer. Planes are then exactly linear in x and y,
//! so that their Laplacian vanishes at any slant.

use crate::overlay::Overlay;
use crate::picture::Picture;

/// What is known of one sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Known {
    /// Depth and motion are known: becomes a galpixel.
    #[default]
    Motion,
    /// Depth or motion is unknown, NaN or infinite: the cell starts empty; its colour is still known.
    ColourOnly,
}

/// One rendered sample and its motion.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Sample {
    /// sRGB, 8 bits per channel.
    pub colour: [u8; 3],
    /// Whether the motion may be believed.
    pub known: Known,
    /// Normalised depth, see the module's text.
    pub depth: f64,
    /// Velocity in x and y (pixels per frame) and of the depth (normalised depth per frame).
    pub velocity: [f64; 3],
    /// Acceleration in x and y (pixels per frame²) and of the depth (normalised depth per frame²).
    pub acceleration: [f64; 3],
    /// Change of luminosity, in 8-bit code values per frame (shading inertia).
    pub luminosity_rate: f64,
    /// Object tag; 0 where there are no objects.
    pub tag: u8,
}

/// How the depth of an update came about; decides the default threshold of the edge map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum DepthKind {
    /// Metric distance along the optical axis, turned into inverse distance.
    Z,
    /// Disparity: larger is nearer.
    Disparity,
    /// No depth is known: the faster sample counts as nearer.
    Speed,
}

/// How many samples the galpixmap has beyond the display on each side (Costella: "in the wings").
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, serde::Serialize, schemars::JsonSchema)]
pub struct Margin {
    /// Columns left of the display.
    pub left: usize,
    /// Columns right of the display.
    pub right: usize,
    /// Rows above the display.
    pub top: usize,
    /// Rows below the display.
    pub bottom: usize,
}

impl Margin {
    /// Creates the same margin on all four sides.
    #[must_use]
    pub const fn all(cells: usize) -> Self {
        Self { left: cells, right: cells, top: cells, bottom: cells }
    }
}

/// One update: everything that a renderer hands over at once.
#[derive(Clone, Debug)]
pub struct Update {
    /// Columns of `samples`, margin included.
    pub width: usize,
    /// Rows of `samples`, margin included.
    pub height: usize,
    /// The part of `width` x `height` that lies outside of the display.
    pub margin: Margin,
    /// Row-major, `width * height`.
    pub samples: Vec<Sample>,
    /// Where the depth came from.
    pub depth_kind: DepthKind,
    /// What is pinned over the picture; of the display's size.
    pub overlay: Option<Overlay>,
}

impl Update {
    /// Returns the columns of the display.
    #[must_use]
    pub fn display_width(&self) -> usize {
        self.width - self.margin.left - self.margin.right
    }

    /// Returns the rows of the display.
    #[must_use]
    pub fn display_height(&self) -> usize {
        self.height - self.margin.top - self.margin.bottom
    }

    /// Returns the colours inside the display, under what is pinned.
    #[must_use]
    pub fn picture(&self) -> Picture {
        let whole =
            Picture { width: self.width, height: self.height, pixels: self.samples.iter().map(|s| s.colour).collect() };
        let display = whole.crop(self.margin.left, self.margin.top, self.display_width(), self.display_height());
        match &self.overlay {
            Some(overlay) => overlay.over(display),
            None => display,
        }
    }
}

/// A true later picture to compare with.
#[derive(Clone, Debug)]
pub struct Truth {
    /// Display frames after the update.
    pub frame: u32,
    /// The picture, of the display's size.
    pub picture: Picture,
    /// Where the comparison counts; everywhere if absent. Row-major, of the display's size.
    pub mask: Option<Vec<bool>>,
}
