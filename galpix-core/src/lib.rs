//! Galpixmaps in fixed point.
#![no_std]
#![forbid(unsafe_code)]
