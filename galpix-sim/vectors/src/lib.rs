//! Golden vectors: inputs and outputs of every kernel and of whole frames, for other implementations and for test
//! benches in logic. The files are described in `docs/vectors.md`.
//!
//! ```text
//! which cases there are        what is in them   the core      what is written down   JSON, hex, hashes
//! choice, inpaint, layers,  ─▶ maps, scenes   ─▶ run,       ─▶ case                ─▶ write
//! objects, disocclusion,                         layered
//! sub_cell, source
//! ```
//!
//! [`arrivals`] has the rules of propagation and resolution once more, slow and short, to compare the core's passes
//! with.

#![forbid(unsafe_code)]

pub mod arrivals;
mod case;
mod choice;
mod disocclusion;
mod field;
mod hash;
mod inpaint;
mod layered;
mod layers;
mod logic;
mod maps;
mod objects;
pub mod rtl;
mod run;
mod scenes;
mod source;
mod sub_cell;
mod write;

pub use case::{Case, Manifest, schema};
pub use choice::cases;
pub use hash::hashes;
pub use run::RunError;
pub use write::{Choice, FORMAT, write};
