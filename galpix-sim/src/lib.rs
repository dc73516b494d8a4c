//! The host simulator of galpixmaps.
//!
//! ```text
//! source (scene, capture) ─▶ update ─▶ engine ─▶ metric ─▶ study ─▶ output (table, CSV, page, film)
//! ```
//!
//! A [`source`] is a built-in scene with exact truth or a capture; the [`engine`] runs `galpix-core` over its update; a
//! [`study`] compares frames with the truth and with sample-and-hold, by [`metric`] and [`certificate`]; [`output`]
//! turns its rows into tables, files and pages. [`cli`] resolves what the command line asks for.

pub mod certificate;
pub mod cli;
pub mod engine;
pub mod figure;
pub mod metric;
pub mod output;
pub mod overlay;
pub mod picture;
pub mod send;
pub mod source;
pub mod study;
pub mod suggest;
pub mod update;

pub use galpix_vectors as vectors;
