//! Arguments for hidden layers.

use clap::{Args, ValueEnum};

use super::CliError;
use crate::engine::Scheme;
use crate::source::hidden::{Arrangement, Kind, RADIUS, SEPARATION, Strategy};

/// What is known behind the first layer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum HiddenChoice {
    /// Nothing: one layer
    #[default]
    None,
    /// A second layer of depth
    Second,
    /// What a depth discontinuity occlusion camera sees around the edges
    Ddoc,
    /// Every surface, whole, in a layer of its own
    Unlimited,
}

/// Which hidden layers are handed over, and how.
#[derive(Clone, Debug, Default, Args)]
pub struct HiddenArguments {
    /// Which hidden samples are handed over
    #[arg(long, value_enum, value_name = "KIND", default_value_t)]
    hidden: HiddenChoice,
    /// For second: how far it lies behind the first layer at least, as a part of the depth range [default: 1/64]
    #[arg(long, value_name = "PART", value_parser = separation)]
    separation: Option<f64>,
    /// Hand over what cannot be uncovered before the next update, too
    #[arg(long)]
    uncut: bool,
}

impl HiddenArguments {
    /// Returns the strategy that these arguments mean in a scheme. In a map a surface that covers something is in a
    /// layer of its own, for what it passes in front of would be lost; stationary sources lose nothing, and what is
    /// seen stays one source.
    ///
    /// *Errors:* what does nothing for the kind.
    pub fn strategy(&self, scheme: Scheme) -> Result<Strategy, CliError> {
        if self.separation.is_some() && self.hidden != HiddenChoice::Second {
            return Err(CliError::unusable("`--separation` is for `--hidden second`: add that, or leave it out"));
        }
        if self.uncut && self.hidden == HiddenChoice::None {
            return Err(CliError::unusable("`--uncut` is for hidden samples: add `--hidden KIND`, or leave it out"));
        }
        let separation = self.separation.unwrap_or(SEPARATION);
        let kind = match self.hidden {
            HiddenChoice::None => return Ok(Strategy::ONE),
            HiddenChoice::Second => Kind::Second { separation },
            HiddenChoice::Ddoc => Kind::Ddoc { radius: RADIUS },
            HiddenChoice::Unlimited => Kind::Unlimited,
        };
        let arrangement = match scheme {
            Scheme::Map => Arrangement::Farther,
            Scheme::Source => Arrangement::Nearer,
        };
        Ok(Strategy { kind, arrangement, culled: !self.uncut })
    }
}

/// Returns a part of the depth range that two layers are apart, from an argument.
pub fn separation(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(part) if (0.0..1.0).contains(&part) => Ok(part),
        _ => Err("give a number from 0 to below 1".to_owned()),
    }
}
