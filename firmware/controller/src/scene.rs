//! Built-in scenes: a few bodies and how they move, evaluated in fixed point on the device, as a renderer would do it.
//!
//! *Units:* lengths in 64ths of the display's height, from its centre, x to the right and y down; times in frames. A
//! display of `h` rows has `h / 64` cells to the unit, rounded down: [`Placed`] is in cells.

mod body;
mod list;

pub use body::{Body, Number, Outline, Path, Pattern, Placed, Scene, Texture};
pub use list::ALL;
