//! The parameters of the reference design in `firmware/rtl`, as SystemVerilog.

use galpix_core::record::{Channel, Component, Field, Record};
use galpix_core::rolling::reach_along;
use galpix_core::{Bits, Rounding};

use crate::case::{GridSize, fields};

/// Components by the first letter of their parameters.
const COMPONENTS: [&str; 3] = ["X", "Y", "Z"];

/// Returns the package `galpixel` of a layout under a budget, after a comment.
#[must_use]
pub fn package(bits: Bits, record: &Record, about: &str) -> String {
    let lines: String = parameters(bits, record).iter().map(|line| format!("  {line}\n")).collect();
    format!(
        "// {about}\n// Written by `galpix rtl`. docs/vectors.md says what the parameters are.\npackage galpixel;\n{lines}endpackage\n"
    )
}

/// Returns the lines that declare the parameters of a record.
pub fn parameters(bits: Bits, record: &Record) -> Vec<String> {
    let words = record.words();
    // With word 0 as the most significant one every field is one slice, also one that spills into the next word.
    let lowest = |field: Field| match field.bits {
        0 => 0,
        _ => 32 * (words - 1 - usize::from(field.word)) + usize::from(field.shift) - usize::from(field.spill),
    };
    let mut lines =
        vec![format!("localparam int WORDS = {words};"), format!("localparam int RECORD = {};", 32 * words)];
    let mut used = vec![false; 32 * words];
    for (name, field) in fields(record) {
        let (name, bits, lowest) = (name.to_uppercase(), usize::from(field.bits), lowest(field));
        used[lowest..lowest + bits].fill(true);
        lines.push(format!("localparam int {name}_BITS = {bits};"));
        lines.push(format!("localparam int {name}_LSB = {lowest};"));
    }
    let used: String = used.iter().rev().map(|&used| if used { '1' } else { '0' }).collect();
    lines.push(format!("localparam logic [{}:0] USED = {}'b{used};", 32 * words - 1, 32 * words));
    for (index, component) in [bits.x, bits.y, bits.z].into_iter().enumerate() {
        let accelerates = record.acceleration(index).bits > 0;
        let Component { velocity_int, velocity_frac, acceleration_int, acceleration_frac, .. } = component;
        let carried = if accelerates { [acceleration_int, acceleration_frac] } else { [0, 0] };
        let values = [record.scales[index].position_frac, velocity_int, velocity_frac, carried[0], carried[1]];
        for (what, value) in ["P", "VI", "VF", "AI", "AF"].into_iter().zip(values) {
            lines.push(format!("localparam int {}_{what} = {value};", COMPONENTS[index]));
        }
    }
    for (index, name) in COMPONENTS.into_iter().enumerate().take(2) {
        let reach = reach_along(record, index);
        lines.push(format!("localparam int {name}_REACH = {reach};"));
        lines.push(format!("localparam int {name}_CELLS = {};", u32::BITS - reach.leading_zeros() + 1));
    }
    let layout = record.layout();
    let channels: Vec<Channel> = layout.colour.channels().collect();
    let flags = [("MOTION", layout.velocity), ("DEPTH_MOTION", layout.depth_motion), ("SHADING", layout.luminosity)];
    lines.extend(flags.map(|(name, set)| format!("localparam bit {name} = {};", u8::from(set))));
    for index in 0..3 {
        let Channel { bits, shift } = channels.get(index).copied().unwrap_or(Channel { bits: 0, shift: 0 });
        lines.push(format!("localparam int CHANNEL_{index}_BITS = {bits};"));
        lines.push(format!("localparam int CHANNEL_{index}_LSB = {shift};"));
    }
    lines.push(format!("localparam int CHANNELS = {};", channels.len()));
    lines.push(format!(
        "localparam int NARROWEST = {};",
        channels.iter().map(|channel| channel.bits).min().unwrap_or_default()
    ));
    lines
}

/// Returns the number by which the reference design knows a rounding.
pub fn rounding_number(name: &str) -> usize {
    Rounding::ALL.iter().position(|rounding| rounding.name() == name).unwrap_or_default()
}

/// Returns the number by which the reference design knows a fill mode.
pub fn fill_number(name: &str) -> usize {
    galpix_core::FillMode::ALL.iter().position(|mode| mode.name() == name).unwrap_or_default()
}

/// Returns the lines that declare a grid.
pub fn grid(grid: &GridSize) -> Vec<String> {
    let GridSize { width, height, left, right, top, bottom } = grid;
    let sizes =
        [("WIDTH", width), ("HEIGHT", height), ("LEFT", left), ("RIGHT", right), ("TOP", top), ("BOTTOM", bottom)];
    sizes.map(|(name, size)| declared(name, *size)).into()
}

/// Returns the line that declares one number.
pub fn declared(name: &str, value: u32) -> String {
    format!("localparam logic [31:0] {name} = 32'd{value};")
}
