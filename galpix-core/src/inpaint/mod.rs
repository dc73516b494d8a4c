//! Stage 5: what is shown where nothing is known, from what is known around it.
//!
//! After a frame of fill mode [`Extend`](crate::FillMode::Extend) the cells of class
//! [`JustUnobscured`](crate::Class::JustUnobscured) are exactly those that this frame uncovered: the *holes* of this
//! stage. What it puts into them they carry with them as debris, so that an uncovered area is filled once, when it
//! opens, and moves on with the picture. Galpixels and debris of earlier frames are *known*, so that what opens beside
//! what was filled before is filled alike.
//!
//! 1. Stretched quads, where [`Inpainting::quads`] asks for them, give the holes the depth of the background.
//! 2. [`PushPull`] pulls known cells into a pyramid and pushes what is missing down from it; foreground keeps out.
//! 3. [`Metamer`], where a texture is wanted, adds to the same push-pull noise of the mean and the deviation that the
//!    bands of each level have around the hole. The noise moves with the picture.
//!
//! 2. and 3. fill a plain [`Picture`] too, as it is gathered from [stationary sources](crate::source).
//!
//! After R. Kuffner dos Anjos et al., "Metameric Inpainting for Image Warping", 2021. Unlike propagation these stages
//! multiply; they never divide.
//!
//! ```
//! use galpix_core::Colour;
//! use galpix_core::inpaint::{Inpainting, Motion, Picture, PushPull};
//!
//! // A row of four pixels. The two in the middle are holes.
//! let (mut colours, known) = ([0x10_0000, 0, 0, 0x30_0000], [0b1001]);
//! let mut memory = [0; PushPull::words(4, 1, Motion::Kept)];
//! let mut push_pull = PushPull::new(4, 1, Motion::Kept, &mut memory)?;
//! let mut picture = Picture::new(4, 1, Colour::RGB888, &mut colours, &known)?;
//! assert_eq!(push_pull.fill_picture(&mut picture, &Inpainting::classic()), 2);
//! assert_eq!(colours, [0x10_0000, 0x18_0000, 0x28_0000, 0x30_0000]);
//! # Ok::<(), galpix_core::SetupError>(())
//! ```

mod kernel;
mod lazy;
mod levels;
pub(crate) mod map;
mod mean;
mod metamer;
mod paint;
mod picture;
mod push_pull;
mod pyramid;
pub(crate) mod quads;
#[cfg(any(test, feature = "check"))]
mod reference;
pub(crate) mod root;
mod settings;
mod validity;

#[cfg(test)]
mod tests;

pub use metamer::noise::Scale;
pub use metamer::{Metamer, MetamerWorkspace, Recipe};
pub use picture::Picture;
pub use push_pull::{Motion, PushPull};
pub use settings::Inpainting;
pub use validity::Gamma;

use crate::format::Format;
use crate::format::rounding::Rounding;
use crate::map::Galpixmap;

/// Gives the holes of `map` the depth of the background, from stretched quads of the map `before`; returns how often
/// one got deeper. It is what [`crate::Controller::inpaint`] begins with.
///
/// `edges` is the edge map of the map before, `rounding` and `frame` are those of the step from one to the other.
pub fn lay_background<F: Format>(
    before: &Galpixmap<'_, F>,
    map: &mut Galpixmap<'_, F>,
    edges: &[u32],
    rounding: Rounding,
    frame: u32,
) -> u32 {
    F::lay_background(before, map, edges, rounding, frame)
}
