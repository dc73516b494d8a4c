//! See `galpix_sim::vectors`.
#![allow(dead_code, missing_docs)]

#[path = "../../../galpix-sim/src/vectors/case.rs"]
pub mod case;
#[path = "../../../galpix-sim/src/vectors/choice.rs"]
mod choice;
#[path = "../../../galpix-sim/src/vectors/disocclusion.rs"]
mod disocclusion;
#[path = "../../../galpix-sim/src/vectors/hash.rs"]
mod hash;
#[path = "../../../galpix-sim/src/vectors/inpaint.rs"]
mod inpaint;
#[path = "../../../galpix-sim/src/vectors/layered.rs"]
mod layered;
#[path = "../../../galpix-sim/src/vectors/layers.rs"]
mod layers;
#[path = "../../../galpix-sim/src/vectors/maps.rs"]
mod maps;
#[path = "../../../galpix-sim/src/vectors/objects.rs"]
mod objects;
#[path = "../../../galpix-sim/src/vectors/run.rs"]
mod run;

pub use choice::cases;
pub use hash::hashes;
