//! Golden vectors: inputs and outputs of every kernel and of whole frames, for other implementations and for test benches in
//! logic. The files are described in `docs/vectors.md`.
//!
//! ```text
//! choice, inpaint, layers, objects, disocclusion (which cases) ─▶ maps (what is in them) ─▶ run, layered (the core) ─▶ case (what is written down) ─▶ write (JSON, hex, hashes)
//! ```

mod case;
mod choice;
mod disocclusion;
mod hash;
mod inpaint;
mod layered;
mod layers;
mod maps;
mod objects;
mod run;
mod write;

pub use case::{Case, Manifest, schema};
pub use choice::cases;
pub use hash::hashes;
pub use write::{FORMAT, write};
