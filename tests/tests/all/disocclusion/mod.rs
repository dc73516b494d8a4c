//! The disocclusion map against brute force, against the algorithms as printed, and its forms against each other.
//!
//! ```sh
//! cargo test --locked --workspace --all-features --test all disocclusion:: -- --nocapture    # prints what docs/notes/disocclusion.md cites
//! ```

mod doubling;
mod forms;
mod literal;
mod printed;
mod surfaces;
mod tiny;
mod two;
