//! `galpix rtl`: a budget as parameters of the reference design in `firmware/rtl`.

use std::path::{Path, PathBuf};

use clap::Args;
use galpix_core::record::Component;
use galpix_core::{Bits, Demand, Record, rolling};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use super::{CliError, budget, note, print, print_json};
use crate::output::save::write_atomically;
use crate::vectors::rtl;

/// Arguments of `galpix rtl`.
#[derive(Debug, Args)]
pub struct Rtl {
    /// What `galpix budget --json` printed
    #[arg(long, value_name = "FILE")]
    budget: PathBuf,
    /// Folder for the package, galpixel.sv
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// What was written.
#[derive(Serialize, JsonSchema)]
pub struct Package {
    /// The file of the package.
    package: String,
    /// The layout's name.
    layout: String,
    /// Bits of a record.
    record_bits: usize,
    /// The most columns by which a galpixel moves in a frame.
    reach_columns: u32,
    /// The most rows by which a galpixel moves in a frame.
    reach_rows: u32,
}

impl Rtl {
    /// Reads the budget and writes the package.
    pub fn run(&self) -> Result<(), CliError> {
        let unusable = |reason: &dyn std::fmt::Display| {
            let path = self.budget.display();
            CliError::Unusable(format!("{path} is no budget ({reason}): write one with `galpix budget --json`"))
        };
        let text = std::fs::read_to_string(&self.budget).map_err(|error| unusable(&error))?;
        let document: Value = serde_json::from_str(&text).map_err(|error| unusable(&error))?;
        let (layout, bits, record) = read(&document).map_err(|reason| unusable(&reason))?;
        let about = format!("The layout {layout} in {} words, {} bits in use.", record.words(), record.bits());
        let path = self.out.join("galpixel.sv");
        save(&path, &rtl::package(bits, &record, &about))?;
        let package = Package {
            package: path.display().to_string(),
            layout,
            record_bits: 32 * record.words(),
            reach_columns: rolling::reach_along(&record, 0),
            reach_rows: rolling::reach(&record),
        };
        note(&format!("{} bits a galpixel, reach {} rows", package.record_bits, package.reach_rows));
        if self.json { print_json("rtl", &package) } else { print(&package.package) }
    }
}

fn save(path: &Path, text: &str) -> Result<(), CliError> {
    let folder = path.parent().map_or(Ok(()), std::fs::create_dir_all);
    folder.and_then(|()| write_atomically(path, text.as_bytes())).map_err(|error| CliError::unwritable(path, &error))
}

/// Returns the layout's name, the widths and the stored form that a document of `galpix budget` says.
fn read(document: &Value) -> Result<(String, Bits, Record), String> {
    if document["kind"] != "budget" {
        return Err("its `kind` is not `budget`".to_owned());
    }
    let number = |of: &Value, key: &str| -> Result<u32, String> {
        let number = of[key].as_u64().and_then(|number| u32::try_from(number).ok());
        number.ok_or_else(|| format!("`{key}` is not a whole number"))
    };
    let component = |of: &Value| -> Result<Component, String> {
        Ok(Component {
            position_frac: number(of, "position_frac_bits")?,
            velocity_int: number(of, "velocity_int_bits")?,
            velocity_frac: number(of, "velocity_frac_bits")?,
            acceleration_int: number(of, "acceleration_int_bits")?,
            acceleration_frac: number(of, "acceleration_frac_bits")?,
        })
    };
    let name = document["layout"].as_str().ok_or("`layout` is not a name")?;
    let layout = budget::layout(name).ok_or_else(|| format!("there is no layout {name}"))?;
    let demand = Demand {
        extent: number(document, "extent")?,
        recog: number(document, "recog")?,
        prop: number(document, "prop")?,
    };
    let bits = if layout.acceleration { Bits::derive(demand) } else { Bits::derive_without_acceleration(demand) };
    let bits = bits.map_err(|error| error.to_string())?;
    let depth = &document["depth"];
    // The document has the fraction that section 5 counts with; the budget's is what depth motion adds to the field.
    let position_frac = match layout.depth_motion {
        true => number(depth, "stored_bits")?.checked_sub(layout.depth_bits).ok_or("the depth has too few bits")?,
        false => bits.z.position_frac,
    };
    let z = Component { position_frac, ..component(depth)? };
    let bits = bits.with_xy(component(document)?, component(&document["y"])?).with_z(z, number(depth, "bins_bits")?);
    let record = Record::plan(bits, layout).map_err(|error| error.to_string())?;
    Ok((name.to_owned(), bits, record))
}
