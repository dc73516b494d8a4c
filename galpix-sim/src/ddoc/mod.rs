//! The depth discontinuity occlusion camera on worlds of triangles: reference images, frames warped from them, and what those
//! frames lack. The distortion is `galpix_core::ddoc`'s; what is drawn with it is drawn here.

pub mod distortion;
pub mod hidden;
pub mod missing;
pub mod raster;
pub mod reference;
pub mod sheet;
pub mod view;
pub mod warp;
pub mod world;
