//! The passes over stationary sources, many cells at a time.

pub(crate) mod cracks;
pub(crate) mod finish;
pub(crate) mod gather;
pub(crate) mod scatter;
