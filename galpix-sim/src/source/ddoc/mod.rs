//! What a depth discontinuity occlusion camera sees of a built-in scene, as samples for a hidden layer.
//!
//! The distortion is `galpix_core::ddoc`'s; [`distortion`] gives it memory and floating-point places, [`sheet`] makes
//! meshes of a scene's surfaces, [`raster`] draws them, and [`hidden`] reads the samples.

pub mod distortion;
pub mod hidden;
pub mod raster;
pub mod sheet;
