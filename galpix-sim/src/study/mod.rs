//! Studies: what is run over sources, and what is said of it.

pub mod ddoc;
pub mod error;
pub mod fills;
pub mod graft;
pub mod layers;
pub mod plan;
pub mod run;
pub mod stability;
