//! Rows of colour for a display, and what is pinned over them.

pub mod overlay;
pub mod scan_out;
