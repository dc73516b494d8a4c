//! Kernels over all their inputs, against references that are spelled like the equations.

mod budget;
mod colour;
mod kernels;
mod whole;
