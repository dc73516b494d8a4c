//! Galpixmaps in fixed point: pixels that carry their own motion.
//!
//! A renderer delivers a few images a second; a display shows a hundred. Between two images every pixel of a
//! *galpixmap* keeps moving: it carries position, velocity and acceleration (a *galpixel*, J. P. Costella, "Motion
//! Extrapolation at the Pixel Level", 1993), and each frame moves all galpixels with additions and shifts only.
//!
//! A frame has these stages; the module [`stages`] exports each of them separately:
//!
//! 1. **propagate** applies `r += v + a/2` and `v += a`, and finds the best-fitting cell.
//! 2. **resolve** keeps the nearest of the galpixels that arrive at the same cell.
//! 3. **edge** marks the cells on the edge of a surface.
//! 4. **fill** fills the cells at which nothing arrived, as the [`FillMode`] says.
//! 5. [`inpaint`] is optional: it fills what was just unobscured from all that is known around it.
//! 6. [`scan_out`] delivers rows of colour to a display, with an [`overlay`] if one is pinned; [`sub_cell`] resamples
//!    them, so that what moves slowly slides.
//!
//! A [`Controller`] makes frames with two maps that it swaps, [`rolling::Rolling`] with one map and a window of rows,
//! and [`layers::Layers`] composes several maps. `Controller` and `Layers` also have a constant-time step, whose
//! instructions do not depend on the picture. A map is a [`Galpixmap`] over a [`Grid`] in a caller-provided buffer. A
//! [`Layout`] says which fields its galpixels carry, [`Bits`] says how wide they are, and a [`Format`] combines both:
//! [`Static`] at compile time or [`Dynamic`] at run time, with the same results. [`objects`] replaces objects one by
//! one, [`disocclusion`] finds the hidden samples that an update needs, and [`ddoc`] renders an image that contains
//! some of them.
//!
//! The crate does not allocate and uses no floating point. Setup functions return errors; after setup nothing panics
//! and no field wraps: what is out of the ordinary is counted in a [`Tally`].
//!
//! ```
//! use galpix_core::fixed::types::I32F32;
//! use galpix_core::{
//!     Bits, Controller, Demand, Galpixel, Galpixmap, Grid, Layout, Margin, Profile, Scratch, Settings, SetupError,
//!     Static,
//! };
//!
//! /// A panel of 64 pixels, recognition in 8 frames, an update every 16.
//! struct Panel;
//! impl Profile for Panel {
//!     const LAYOUT: Layout = Layout::VELOCITY565;
//!     const BITS: Bits = Bits::must(Bits::derive_without_acceleration(Demand { extent: 64, recog: 8, prop: 16 }));
//! }
//!
//! fn main() -> Result<(), SetupError> {
//!     // The table of row starts, and two maps of 64 x 4 cells with two words per cell.
//!     let (mut rows, mut front, mut back) = ([0; 4], [0; 2 * 64 * 4], [0; 2 * 64 * 4]);
//!     let grid = Grid::new(64, 4, Margin::NONE, &mut rows)?;
//!     let mut front = Galpixmap::new(grid, Static::<Panel>::new(), &mut front)?;
//!     let back = Galpixmap::new(grid, Static::<Panel>::new(), &mut back)?;
//!
//!     // A white galpixel that moves right by three quarters of a cell in each frame.
//!     let velocity = [I32F32::lit("0.75"), I32F32::ZERO, I32F32::ZERO];
//!     front.store(10, 2, &Galpixel { colour: [255; 3], velocity, ..Galpixel::default() });
//!
//!     let mut controller = Controller::new(front, back, Scratch::default())?;
//!     let tally = controller.step(&Settings::for_depth(16));
//!     assert_eq!((tally.moved, tally.lost), (1, 0));
//!     assert_eq!(controller.front().rgb888(11, 2), Some([255; 3]));
//!     Ok(())
//! }
//! ```

#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod error;
mod fast;
mod format;
mod frame;
mod map;
mod maps;
mod output;
#[cfg(test)]
mod random;

pub mod ddoc;
pub mod disocclusion;
pub mod inpaint;
pub mod layers;
pub mod objects;
pub mod source;

/// The parts of a format: components of a budget, channels of a colour, fields and arithmetic of a record.
pub mod record {
    pub use crate::format::budget::{Component, Shave, WIDEST_FIELD};
    pub use crate::format::colour::{Channel, luminosity};
    pub use crate::format::record::{Field, MAX_WORDS, Record, Scale};
}

/// The stages of a frame as separate functions, and their arithmetic.
pub mod stages {
    pub use crate::frame::edge::{laplacian, mark, on_edge, threshold_for_depth, threshold_for_speed, words};
    pub use crate::frame::fill::{FILLED, fill};
    pub use crate::frame::resolve::{Candidate, NO_WINNER, nearer, sweep};
    pub use crate::frame::step::{clamp_velocity, snap, step_position, step_velocity};
    pub use crate::inpaint::lay_background;
}

/// Rows of colour for a display.
pub mod scan_out {
    pub use crate::output::scan_out::{Bare, Nearest, Over, Sampling, row};
    #[cfg(feature = "embedded-graphics")]
    pub use crate::output::scan_out::{PanelColour, View};
}

/// Rows of colour that are resampled by where in its cell each galpixel is.
pub mod sub_cell {
    pub use crate::output::sub_cell::{SubCell, row};
}

/// Cells that are pinned over the picture.
pub mod overlay {
    #[cfg(feature = "embedded-graphics")]
    pub use crate::output::overlay::Canvas;
    pub use crate::output::overlay::{Overlay, row};
}

/// Frames with a single map, in little more than half the memory of two.
pub mod rolling {
    pub use crate::fast::rolling::{Rolling, reach, reach_along, rows};
}

pub use error::{BudgetError, SetupError};
pub use fixed;
pub use format::budget::{Bits, Demand};
pub use format::colour::Colour;
pub use format::layout::Layout;
pub use format::record::Record;
pub use format::rounding::Rounding;
pub use format::{Dynamic, Format, Profile, Static};
pub use frame::fill::FillMode;
pub use frame::tally::Tally;
pub use frame::{Controller, Scratch, Settings};
pub use inpaint::Inpainting;
pub use map::Galpixmap;
pub use map::galpixel::{Class, Galpixel};
pub use map::grid::{Grid, Margin};
pub use maps::Maps;
pub use objects::graft::{Delay, Grafted, graft};
