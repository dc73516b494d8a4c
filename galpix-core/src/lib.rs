//! Galpixmaps in fixed point: pixels that carry their own motion.
//!
//! A renderer delivers a few pictures a second; a display shows a hundred. Between two pictures every pixel of a
//! *galpixmap* goes on moving by itself: it carries position, velocity and acceleration (a *galpixel*, J. P. Costella,
//! "Motion Extrapolation at the Pixel Level", 1993), and each frame moves all of them with additions and shifts only.
//!
//! One frame, stage by stage and file by file:
//!
//! 1. [`propagate`]: `r += v + a/2`, `v += a`, the best-fitting cell
//! 2. [`resolve`]: who gets a cell that several want; [`sweep`] does both stages in one pass
//! 3. [`edge`]: which cells are on the edge of a surface
//! 4. [`fill`]: what is put where nothing arrived
//! 5. [`inpaint`]: what is put there instead where a controller asks for more, from all that is known around it
//! 6. [`scan_out`]: rows of colour for a display, under an [`overlay`] where one is pinned
//!
//! [`layers`] lets several maps move apart and shows them together. [`frame`] is their order; in the mode of [`constant`] work the instructions of 2 and 4 do not depend on the picture. Before it: [`budget`] gives every width, [`layout`] says which lanes there are, [`record`]
//! packs them into words, [`grid`] and [`galpixmap`] lay them over memory that the caller lends, and [`galpixel`] is one of
//! them with units.
//!
//! [`disocclusion`] says, before an update is shown, which hidden samples it needs.
//!
//! Nothing here allocates, floats, panics or wraps once a map is set up: errors at the border, counts inside.
//!
//! ```
//! use fixed::types::I32F32;
//! use galpix_core::budget::{Bits, Demand};
//! use galpix_core::frame::{Controller, Scratch, Settings};
//! use galpix_core::galpixel::{Galpixel, Profile, Static};
//! use galpix_core::galpixmap::Galpixmap;
//! use galpix_core::grid::{Grid, Margin};
//! use galpix_core::layout::Velocity565;
//!
//! /// A panel of 64 pixels, recognition in 8 frames, an update every 16.
//! struct Panel;
//! impl Profile for Panel {
//!     const BITS: Bits = Bits::must(Bits::derive_without_acceleration(Demand { extent: 64, recog: 8, prop: 16 }));
//! }
//!
//! let (mut rows, mut front, mut back) = ([0; 4], [0; 2 * 64 * 4], [0; 2 * 64 * 4]);
//! let grid = Grid::new(64, 4, Margin::NONE, &mut rows)?;
//! let mut front = Galpixmap::<Velocity565, _>::new(grid, Static::<Panel>::new(), &mut front)?;
//! let back = Galpixmap::new(grid, Static::<Panel>::new(), &mut back)?;
//!
//! // A white galpixel that moves right by three quarters of a cell a frame.
//! let velocity = [I32F32::lit("0.75"), I32F32::ZERO, I32F32::ZERO];
//! front.store(10, 2, &Galpixel { colour: [255; 3], velocity, ..Galpixel::default() });
//!
//! let mut controller = Controller::new(front, back, Scratch::default())?;
//! let tally = controller.step(&Settings::for_depth(16));
//! assert_eq!((tally.moved, tally.lost), (1, 0));
//! assert_eq!(controller.front().rgb888(11, 2), Some([255; 3]));
//! # Ok::<(), galpix_core::error::SetupError>(())
//! ```

#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod error;
mod fast;
mod format;
mod frame;
mod map;
mod output;

pub mod ddoc;
pub mod disocclusion;
pub mod inpaint;
pub mod layers;
pub mod objects;

/// Formats in full: components of a budget, channels of a colour, fields and arithmetic of a record.
pub mod record {
    pub use crate::format::budget::{Component, Shave, WIDEST_FIELD};
    pub use crate::format::colour::{Channel, luminosity};
    pub use crate::format::record::{Field, MAX_WORDS, Record, Scale};
}

/// The stages of a frame one by one, and their arithmetic.
pub mod stages {
    pub use crate::frame::edge::{laplacian, mark, on_edge, threshold_for_depth, threshold_for_speed, words};
    pub use crate::frame::fill::{FILLED, fill};
    pub use crate::frame::resolve::{Candidate, NO_WINNER, nearer, sweep};
    pub use crate::frame::step::{clamp_velocity, snap, step_position, step_velocity};
}

/// Rows of colour for a display.
pub mod scan_out {
    pub use crate::output::scan_out::{Bare, Over, row};
    #[cfg(feature = "embedded-graphics")]
    pub use crate::output::scan_out::{PanelColour, View};
}

/// Cells pinned over the picture.
pub mod overlay {
    #[cfg(feature = "embedded-graphics")]
    pub use crate::output::overlay::Canvas;
    pub use crate::output::overlay::{Overlay, row};
}

/// One map in little more than half the memory.
pub mod rolling {
    pub use crate::fast::rolling::{Rolling, reach, rows};
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
pub use objects::graft::{Grafted, graft};
