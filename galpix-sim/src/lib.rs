//! The host simulator: scenes with exact truth, importers, the engine on a lent memory, metrics and reports.

pub mod certificate;
pub mod engine;
pub mod film;
pub mod metric;
pub mod picture;
pub mod report;
pub mod scene;
pub mod update;
