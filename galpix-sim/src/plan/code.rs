//! The lines of Rust that make a plan so.

use std::fmt::Write as _;

use galpix_core::budget::Component;
use galpix_core::frame::Settings;
use galpix_core::record::Record;

use super::Build;

/// Layout, profile and settings of a plan.
pub fn text(source: &str, build: &Build, record: &Record, settings: Settings) -> String {
    let name = type_name(source);
    let lanes = build.lanes;
    let mut kept = Vec::new();
    if lanes.depth_bits > 0 {
        kept.push(format!("depth_bits: {}", lanes.depth_bits));
    }
    for (lane, there) in [
        ("velocity", lanes.velocity),
        ("acceleration", lanes.acceleration),
        ("depth_motion", lanes.depth_motion),
        ("luminosity", lanes.luminosity),
    ] {
        if there {
            kept.push(format!("{lane}: true"));
        }
    }
    kept.push("..Lanes::NONE".to_owned());
    let lanes = if kept.len() == 1 { "Lanes::NONE".to_owned() } else { format!("Lanes {{ {} }}", kept.join(", ")) };
    let mut text = format!(
        "/// {} bits in {} words a galpixel.\n\
         pub enum {name} {{}}\n\
         impl Layout for {name} {{\n    type Colour = Rgb888;\n    const LANES: Lanes = {lanes};\n}}\n\
         pub struct {name}Budget;\n\
         impl Profile for {name}Budget {{\n    const BITS: Bits = Bits {{\n",
        record.bits(),
        record.words()
    );
    for (axis, component) in [("x", build.bits.x), ("y", build.bits.y), ("z", build.bits.z)] {
        let Component { position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac } = component;
        let _ = writeln!(
            text,
            "        {axis}: Component {{ position_frac: {position_frac}, velocity_int: {velocity_int}, velocity_frac: \
             {velocity_frac}, acceleration_int: {acceleration_int}, acceleration_frac: {acceleration_frac} }},"
        );
    }
    let _ = write!(
        text,
        "        depth_int: {}, luminosity_int: {}, luminosity_frac: {},\n    }};\n}}\n\
         pub const SETTINGS: Settings = Settings {{\n    rounding: Rounding::{:?}, rung: Rung::{:?}, edge_threshold: {}, reach: {},\n    \
         ..Settings::for_depth({})\n}};\n",
        build.bits.depth_int,
        build.bits.luminosity_int,
        build.bits.luminosity_frac,
        settings.rounding,
        settings.rung,
        settings.edge_threshold,
        settings.reach,
        record.depth().bits
    );
    text
}

/// The source's name as that of a type.
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
