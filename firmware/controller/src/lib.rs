//! A display controller of galpixmaps: the program that all boards share.
//!
//! ```text
//!  host ──line──▶ session ──graft──▶ map ──step──▶ map ──bands──▶ panel
//!  renderer (built-in scenes) ──────▲                   ▲ overlay
//! ```
//!
//! - [`board`]: the seam, what a board gives
//! - [`session`]: a frame at every vsync, and what the host says between them
//! - [`inpainted`]: maps whose frames are followed by push-pull
//! - [`renderer`], [`scene`]: built-in scenes, evaluated in fixed point, that deliver updates row by row
//! - [`overlay`]: a line of text over the picture
//! - [`log`]: what is said with the feature `defmt`

#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod board;
pub mod inpainted;
pub mod log;
pub mod overlay;
pub mod renderer;
pub mod scene;
pub mod session;
