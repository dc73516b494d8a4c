//! Stage 5: what is shown where nothing is known, from what is known around it.
//!
//! After a frame of fill_mode [`crate::frame::fill::FillMode::Extend`] the cells of class [`crate::map::galpixel::Class::JustUnobscured`] are
//! exactly those that this frame uncovered: the *holes* of this stage. What it puts into them they carry with them as debris,
//! so that an uncovered area is filled once, when it opens, and moves on with the picture. Fully-fledged galpixels are
//! *known*; debris is not, so that nothing is made from what was made up.
//!
//! 1. [`quads`]: which depth the background has in the holes
//! 2. [`push_pull`]: known cells are pulled into a pyramid, what is missing is pushed down from it; foreground keeps out
//! 3. [`metamer`], where a texture is wanted: push-pull of tones, and of the moments of what [`steerable`] bands respond to, and
//!    [`noise`] of these moments that moves with the picture
//!
//! After R. Kuffner dos Anjos et al., "Metameric Inpainting for Image Warping", 2021. Unlike propagation these stages
//! multiply; they never divide.

pub mod below;
mod block;
pub mod demand;
pub mod features;
pub mod levels;
pub mod map;
pub mod mean;
pub mod metamer;
pub mod needs;
pub mod noise;
pub mod paint;
pub mod picture;
pub mod push_pull;
pub mod pyramid;
pub mod quads;
pub mod root;
pub mod statistics;
pub mod steerable;
pub mod tile;
pub mod tone;
pub mod validity;
pub mod ycbcr;
