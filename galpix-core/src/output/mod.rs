//! Rows of colour for a display, and overlays that are pinned over them.

pub mod overlay;
pub mod scan_out;
pub mod sub_cell;
