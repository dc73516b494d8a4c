//! What the cross-crate tests share: memory, exact reference arithmetic, maps drawn as text, scenes as maps.
//!
//! Nothing here calls the code it is used to check: [`exact`] and [`packed`] compute the same things again, slowly.

pub mod art;
pub mod captures;
pub mod exact;
pub mod layouts;
pub mod memory;
pub mod packed;
pub mod profiles;
pub mod random;
pub mod stage;

/// README's program, compiled and run as a doctest.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;
