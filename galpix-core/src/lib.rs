#![no_std]
#![forbid(unsafe_code)]
pub mod budget;
pub mod colour;
pub mod edge;
pub mod error;
pub mod fill;
pub mod frame;
pub mod galpixel;
pub mod galpixmap;
pub mod grid;
pub mod layout;
pub mod propagate;
pub mod record;
pub mod resolve;
pub mod rounding;
pub mod scan_out;
pub mod sweep;
pub mod tally;
