//! The exhaustive tests of resolve and edge, which need nothing but the core: for the functions that no frame calls.

#[path = "../../tests/exhaustive/resolve.rs"]
mod resolve;
