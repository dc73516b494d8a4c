//! The disocclusion map against brute force, against the algorithms as printed, and its forms against each other.
//!
//! ```sh
//! # Prints what docs/notes/disocclusion.md cites.
//! cargo test --locked --workspace --all-features --test all disocclusion:: -- --nocapture
//! ```

mod doubling;
mod forms;
mod literal;
mod printed;
mod surfaces;
mod tiny;
mod two;
