//! The simulator's golden vectors, compiled without the simulator.

pub mod vectors;
