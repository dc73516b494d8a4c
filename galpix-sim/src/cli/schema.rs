//! `galpix schema`: what the keys of the documents of `--json` are, derived from the types that are written.

use clap::{Args, ValueEnum};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema as Derived};

use super::document::Failure;
use super::{CliError, budget, init, print, rtl, scenes, vectors};
use crate::send;
use crate::study::{self, Headed, check, compare, ddoc, demo, error, fills, fit, graft, layers, plan, run, stability};

/// A kind of document.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    Demo,
    Run,
    Check,
    Init,
    Compare,
    Error,
    Fills,
    Layers,
    Graft,
    Ddoc,
    Budget,
    Fit,
    Plan,
    Stability,
    Send,
    Scenes,
    Vectors,
    Rtl,
    /// What a command prints that failed, whichever it was
    Failure,
}

/// Arguments of `galpix schema`.
#[derive(Debug, Args)]
pub struct Schema {
    /// The command whose document it is
    #[arg(value_enum, value_name = "COMMAND")]
    kind: Kind,
}

impl Schema {
    /// Prints the schema.
    pub fn run(&self) -> Result<(), CliError> {
        let schema = match self.kind {
            Kind::Demo => of::<study::Document<study::NoExtra, demo::Demonstration>>(),
            Kind::Run => of::<Headed<'_, run::RunReport>>(),
            Kind::Check => of::<Headed<'_, check::CheckReport>>(),
            Kind::Init => of::<Headed<'_, init::Initialised>>(),
            Kind::Compare => of::<Headed<'_, compare::Comparison>>(),
            Kind::Error => of::<error::Document>(),
            Kind::Fills => of::<fills::Document>(),
            Kind::Layers => of::<layers::Document>(),
            Kind::Graft => of::<Headed<'_, graft::report::GraftReport>>(),
            Kind::Ddoc => of::<ddoc::Document>(),
            Kind::Budget => of::<Headed<'_, budget::Printed>>(),
            Kind::Fit => of::<Headed<'_, fit::Fitting>>(),
            Kind::Plan => of::<Headed<'_, plan::Planning>>(),
            Kind::Stability => of::<Headed<'_, stability::Report>>(),
            Kind::Send => of::<Headed<'_, send::Report>>(),
            Kind::Scenes => of::<Headed<'_, scenes::List>>(),
            Kind::Vectors => of::<Headed<'_, vectors::Written>>(),
            Kind::Rtl => of::<Headed<'_, rtl::Package>>(),
            Kind::Failure => of::<Headed<'_, Failure>>(),
        };
        print(&serde_json::to_string_pretty(&schema).map_err(|error| CliError::Failed(error.to_string()))?)
    }
}

/// Returns the schema of what is written of a type.
fn of<D: JsonSchema>() -> Derived {
    SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<D>()
}
