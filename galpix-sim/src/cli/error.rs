//! `galpix error`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use galpix_core::{FillMode, Rounding};

use super::choices::{
    AccelerationChoice, FillChoice, Inpainting, RoundingChoice, SchemeChoice, not_of_sources, part, schemes,
};
use super::drive::{Publication, drive};
use super::{CliError, call};
use crate::engine::fill::Fill;
use crate::study::error::design::{Extent, Kept};
use crate::study::error::{self, Plan, Shard};
use crate::study::job::Request;

/// Which fields a galpixel carries besides class and colour.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum FieldChoice {
    /// None: the picture stands still
    Still,
    /// Velocity in x and y, depth that does not move
    Velocity,
    /// Velocity in x, y and depth
    VelocityDepth,
    /// Velocity and acceleration in x and y, depth that does not move
    Acceleration,
    /// Velocity and acceleration in x, y and depth
    Full,
    /// Full, and the rate of the luminosity; only where the source has one
    Luminosity,
}

impl From<FieldChoice> for Kept {
    fn from(choice: FieldChoice) -> Self {
        match choice {
            FieldChoice::Still => Self::Still,
            FieldChoice::Velocity => Self::Velocity,
            FieldChoice::VelocityDepth => Self::VelocityDepth,
            FieldChoice::Acceleration => Self::Acceleration,
            FieldChoice::Full => Self::Full,
            FieldChoice::Luminosity => Self::Luminosity,
        }
    }
}

/// Arguments of `galpix error`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_long_help = error::legend())]
pub struct Error {
    /// Built-in scenes' names, or paths of a capture.toml or of its folder
    #[arg(required = true, value_name = "SOURCE")]
    sources: Vec<String>,
    /// Few points: the derived budget and two more, two fill modes
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// Many points: all fields by all roundings by all fill modes, all budgets by all roundings
    #[arg(long)]
    full: bool,
    /// Fields to choose from [default: all that the source has a use for]
    #[arg(long = "lanes", value_enum, value_name = "FIELDS", value_delimiter = ',')]
    fields: Vec<FieldChoice>,
    /// Roundings to choose from [default: all]
    #[arg(long, value_enum, value_name = "ROUNDINGS", value_delimiter = ',')]
    roundings: Vec<RoundingChoice>,
    /// Fill modes to choose from [default: all that do not inpaint]
    #[arg(long = "rungs", value_enum, value_name = "MODES", value_delimiter = ',')]
    fills: Vec<FillChoice>,
    /// How galpixels move: the same points for each scheme, with the fill modes that it takes
    #[arg(long, value_enum, value_name = "SCHEMES", value_delimiter = ',', default_value = "map")]
    scheme: Vec<SchemeChoice>,
    #[command(flatten)]
    inpainting: Inpainting,
    /// Frames to extrapolate [default: what the source is meant for]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    frames: Option<u32>,
    /// D, the extent of the display in pixels [default: the next power of two of the larger side]
    #[arg(long, value_name = "PX")]
    extent: Option<u32>,
    /// tau_recog, the shortest recognisable time in frames [default: 8]
    #[arg(long, value_name = "FRAMES")]
    recog: Option<u32>,
    /// tau_prop, the frames to survive without an update [default: the next power of two of the frames that the source
    /// is meant for, whatever --frames asks for]
    #[arg(long, value_name = "FRAMES")]
    prop: Option<u32>,
    /// Laplacian beyond which a cell is on an edge, as a part of the depth range [default: 1/64, without depth 1/128]
    #[arg(long, value_name = "PART", value_parser = part)]
    edge_threshold: Option<f64>,
    /// What is done with the accelerations of a capture
    #[arg(long, value_enum, value_name = "POLICY", default_value_t)]
    acceleration: AccelerationChoice,
    /// Measure the K-th of N parts of the points, so that several machines share them: a point has the same number and
    /// the same errors in every call
    #[arg(long, value_name = "K/N", default_value = "1/1")]
    shard: Shard,
    /// Folder for error.html, error.csv and error.json [default: galpix-out/error; with --json nothing is written
    /// without it]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Error {
    /// Measures the sources and writes the report.
    pub fn run(&self) -> Result<(), CliError> {
        let plan = self.plan();
        if !plan.fills.iter().any(|&fill| plan.schemes.iter().any(|scheme| scheme.takes(fill))) {
            let names: Vec<&str> = plan.fills.iter().map(|fill| fill.name()).collect();
            return Err(not_of_sources("--rungs", &names.join(",")));
        }
        self.inpainting.check(plan.fills.iter().copied())?;
        let sources = call::sources(&self.sources, self.acceleration)?;
        let to = Publication::usual(self.out.as_ref(), self.json, "error").reading(&self.sources).of(&sources);
        drive(&plan, &sources, &to)
    }

    fn plan(&self) -> Plan {
        let mut fills: Vec<Fill> = self.fills.iter().map(|&fill| self.inpainting.of(fill.into())).collect();
        let mut roundings: Vec<Rounding> = self.roundings.iter().map(|&rounding| rounding.into()).collect();
        let mut kept: Vec<Kept> = self.fields.iter().map(|&fields| fields.into()).collect();
        let place = |rounding: &Rounding| Rounding::ALL.iter().position(|other| other == rounding);
        fills.sort_unstable_by_key(|fill| Fill::all().iter().position(|other| other.name() == fill.name()));
        fills.dedup();
        roundings.sort_unstable_by_key(place);
        roundings.dedup();
        kept.sort_unstable();
        kept.dedup();
        let all = |none: bool| none.then_some(());
        let extent = match (self.quick, self.full) {
            (true, _) => Extent::Quick,
            (_, true) => Extent::Full,
            _ => Extent::Sensible,
        };
        Plan {
            request: Request {
                frames: self.frames,
                extent: self.extent,
                recog: self.recog,
                prop: self.prop,
                edge_threshold: self.edge_threshold,
                ..Request::default()
            },
            kept: all(kept.is_empty()).map_or(kept, |()| Kept::ALL.to_vec()),
            roundings: all(roundings.is_empty()).map_or(roundings, |()| Rounding::ALL.to_vec()),
            fills: all(fills.is_empty()).map_or(fills, |()| FillMode::ALL.map(Fill::from).to_vec()),
            schemes: schemes(&self.scheme),
            extent,
            shard: self.shard,
        }
    }
}
