//! The Rust code of a plan.

use std::fmt::Write as _;

use galpix_core::record::{Component, Record};
use galpix_core::{Layout, Settings};

use super::Build;

/// Returns the profile and settings of a plan.
pub fn text(source: &str, build: &Build, record: &Record, settings: Settings) -> String {
    let name = type_name(source);
    let mut text = format!(
        "use galpix_core::record::Component;\n\
         use galpix_core::{{Bits, FillMode, Layout, Profile, Rounding, Settings}};\n\n\
         /// {} bits in {} words per galpixel.\n\
         pub enum {name} {{}}\n\
         impl Profile for {name} {{\n    const LAYOUT: Layout = {};\n    const BITS: Bits = Bits {{\n",
        record.bits(),
        record.words(),
        layout_text(build.layout)
    );
    for (axis, component) in [("x", build.bits.x), ("y", build.bits.y), ("z", build.bits.z)] {
        let Component { position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac } = component;
        let _ = writeln!(
            text,
            "        {axis}: Component {{ position_frac: {position_frac}, velocity_int: {velocity_int}, velocity_frac: \
             {velocity_frac}, acceleration_int: {acceleration_int}, acceleration_frac: {acceleration_frac} }},"
        );
    }
    let Settings { rounding, fill_mode, edge_threshold, reach } = settings;
    let _ = write!(
        text,
        "        depth_int: {}, luminosity_int: {}, luminosity_frac: {},\n    }};\n}}\n\
         pub const SETTINGS: Settings = Settings {{\n    rounding: Rounding::{rounding:?}, fill_mode: \
         FillMode::{fill_mode:?}, edge_threshold: {edge_threshold}, reach: {reach},\n}};\n",
        build.bits.depth_int, build.bits.luminosity_int, build.bits.luminosity_frac,
    );
    text
}

/// Returns a layout of RGB888 by what it has beyond [`Layout::STILL`].
fn layout_text(layout: Layout) -> String {
    let Layout { colour: _, depth_bits, velocity, acceleration, depth_motion, luminosity, tag_bits: _ } = layout;
    let mut kept = String::new();
    if depth_bits > 0 {
        kept += &format!("depth_bits: {depth_bits}, ");
    }
    for (field, there) in [
        ("velocity", velocity),
        ("acceleration", acceleration),
        ("depth_motion", depth_motion),
        ("luminosity", luminosity),
    ] {
        if there {
            kept += &format!("{field}: true, ");
        }
    }
    if kept.is_empty() { "Layout::STILL".to_owned() } else { format!("Layout {{ {kept}..Layout::STILL }}") }
}

/// Returns the source's name as that of a type.
fn type_name(source: &str) -> String {
    let mut name = String::from("Planned");
    let mut capital = true;
    for c in source.chars().take(64) {
        if !c.is_ascii_alphanumeric() {
            capital = true;
        } else {
            name.push(if capital { c.to_ascii_uppercase() } else { c });
            capital = false;
        }
    }
    name
}
