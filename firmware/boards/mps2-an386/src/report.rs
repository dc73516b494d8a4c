//! Lines for whoever reads the run: a table as CSV, remarks behind `#`.

use semihosting::println;

use crate::clock::hundredths;

/// The mode of frames whose work depends on the picture.
pub const SKIPPING: &str = "skipping";
/// The mode of frames whose work does not.
pub const CONSTANT_TIME: &str = "constant";

/// What was measured.
#[derive(Clone, Copy)]
pub struct Row {
    /// The layout, or the name of a kernel that is not the engine's.
    pub layout: &'static str,
    /// The picture.
    pub picture: &'static str,
    /// The mode of work: [`SKIPPING`], [`CONSTANT_TIME`], or none.
    pub mode: &'static str,
    /// The stage.
    pub stage: &'static str,
    /// The fill mode.
    pub rung: &'static str,
}

/// Prints the columns' names.
pub fn print_head() {
    println!("# {}", env!("GALPIX_RUSTC"));
    println!("target,layout,picture,mode,stage,rung,hundredths");
}

/// Prints a row: hundredths of an instruction a galpixel.
pub fn print(row: &Row, ticks: u64, galpixels: u32) {
    print_hundredths(row, hundredths(ticks, galpixels));
}

/// Prints a row of another count: hundredths of it.
pub fn print_hundredths(row: &Row, count: u64) {
    let Row { layout, picture, mode, stage, rung } = row;
    println!("{},{layout},{picture},{mode},{stage},{rung},{count}", env!("GALPIX_TARGET"));
}
