//! The host simulator of galpixmaps.
//!
//! An update comes from a built-in [`scene`] with exact truth or from a [`capture`]; the [`engine`] runs `galpix-core` over
//! it; an [`experiment`] compares each frame with the truth and with sample-and-hold; [`metric`], [`film`] and `report`
//! turn that into numbers, moving pictures and a page.

pub mod area;
pub mod capture;
pub mod certificate;
pub mod cli;
pub mod ddoc;
pub mod engine;
pub mod experiment;
pub mod figure;
pub mod fill;
pub mod fills;
pub mod film;
pub mod fit;
pub mod grafts;
pub mod hidden;
pub mod layers;
pub mod metric;
pub mod overlay;
pub mod picture;
pub mod plan;
pub mod progress;
pub mod report;
pub mod scene;
pub mod send;
pub mod stability;
pub mod tradeoff;
pub mod update;

pub use galpix_vectors as vectors;
