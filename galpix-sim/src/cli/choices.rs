//! Arguments that several commands share.

use clap::{Args, ValueEnum};
use galpix_core::{FillMode, Rounding};

use super::CliError;
use crate::engine::fill::{Fill, Gamma, Inpaint, Kind};
use crate::engine::{ScanOut, Scheme};
use crate::source::capture::{AccelerationPolicy, ImportOptions};
use crate::source::hidden::Strategy;
use crate::study::job::Request;

/// How positions are rounded.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum RoundingChoice {
    /// Plain right shift
    Truncate,
    /// To nearest, halves upwards
    Nearest,
    /// By the frame counter read backwards
    #[default]
    LowDiscrepancy,
    /// By a table found by search
    Searched,
}

impl From<RoundingChoice> for Rounding {
    fn from(choice: RoundingChoice) -> Self {
        match choice {
            RoundingChoice::Truncate => Self::Truncate,
            RoundingChoice::Nearest => Self::Nearest,
            RoundingChoice::LowDiscrepancy => Self::LowDiscrepancy,
            RoundingChoice::Searched => Self::Searched,
        }
    }
}

/// What is put into holes. Each mode includes the cheaper ones that it builds on.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum FillChoice {
    /// Holes are shown black
    None,
    /// The display keeps showing what it showed there
    Hold,
    /// What was there stays as debris, without motion
    Debris,
    /// Holes inside of surfaces take the mean of their neighbours, the rest is debris
    Bullet,
    /// As bullet, and debris keeps its motion, one frame late
    Galdebris,
    /// As bullet, and what was uncovered continues the farther of the surfaces next to it, along its row
    Extend,
    /// As extend, and what was uncovered takes the colours around it that are no nearer, the finer the closer
    PushPull,
    /// As push-pull, with a texture that has the statistics of that around it
    Metamer,
}

impl From<FillChoice> for Fill {
    fn from(choice: FillChoice) -> Self {
        match choice {
            FillChoice::None => FillMode::None.into(),
            FillChoice::Hold => FillMode::Hold.into(),
            FillChoice::Debris => FillMode::Debris.into(),
            FillChoice::Bullet => FillMode::Bullet.into(),
            FillChoice::Galdebris => FillMode::Galdebris.into(),
            FillChoice::Extend => FillMode::Extend.into(),
            FillChoice::PushPull => Kind::PushPull.into(),
            FillChoice::Metamer => Kind::Metamer.into(),
        }
    }
}

/// How galpixels move.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum SchemeChoice {
    /// From map to map: the paper's galpixmap
    Map,
    /// They stay where the update put them, and each frame finds out where they are seen
    Source,
}

impl From<SchemeChoice> for Scheme {
    fn from(choice: SchemeChoice) -> Self {
        match choice {
            SchemeChoice::Map => Self::Map,
            SchemeChoice::Source => Self::Source,
        }
    }
}

/// Returns each of some schemes once, the map first.
pub fn schemes(choices: &[SchemeChoice]) -> Vec<Scheme> {
    let chosen = |scheme: &Scheme| choices.iter().any(|&choice| Scheme::from(choice) == *scheme);
    [Scheme::Map, Scheme::Source].into_iter().filter(chosen).collect()
}

/// What a pixel shows of the galpixels around it.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum ScanOutChoice {
    /// The colour of its own cell
    Nearest,
    /// Colours of its surface resampled by where in their cells the galpixels are, silhouettes by coverage
    SubCell,
}

impl From<ScanOutChoice> for ScanOut {
    fn from(choice: ScanOutChoice) -> Self {
        match choice {
            ScanOutChoice::Nearest => Self::Nearest,
            ScanOutChoice::SubCell => Self::SubCell,
        }
    }
}

/// How much a cell counts of which only a part is known: that part to this power.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum GammaChoice {
    /// As much as any other: sharp
    #[value(name = "0")]
    Zero,
    /// In between
    #[value(name = "1/2", alias = "0.5")]
    Half,
    /// In proportion: smooth in space and steady in time
    #[value(name = "1")]
    One,
}

impl From<GammaChoice> for Gamma {
    fn from(choice: GammaChoice) -> Self {
        match choice {
            GammaChoice::Zero => Self::Zero,
            GammaChoice::Half => Self::Half,
            GammaChoice::One => Self::One,
        }
    }
}

/// How push-pull and metamer inpaint.
#[derive(Clone, Copy, Debug, Default, Args)]
pub struct Inpainting {
    /// For push-pull and metamer: the power of the share that is known, by which partly known areas count [default: 0
    /// for push-pull, 1/2 for metamer]
    #[arg(long, value_enum, value_name = "GAMMA")]
    pub gamma: Option<GammaChoice>,
    /// For push-pull and metamer: leave a disc of this radius in the middle of the display to the fill mode extend
    #[arg(long, value_name = "PX", value_parser = clap::value_parser!(u32).range(1..=32_768))]
    pub fovea: Option<u32>,
}

impl Inpainting {
    /// Refuses what asks for another inpainting where none of the fills inpaints.
    pub fn check(&self, fills: impl IntoIterator<Item = Fill>) -> Result<(), CliError> {
        let given = self.gamma.map(|_| "--gamma").or(self.fovea.map(|_| "--fovea"));
        let fills: Vec<Fill> = fills.into_iter().collect();
        match given {
            Some(option) if fills.iter().all(|fill| fill.inpaint().is_none()) => {
                let names: Vec<&str> = fills.iter().map(|fill| fill.name()).collect();
                let names = names.join(", ");
                Err(CliError::Unusable(format!(
                    "`{option}` is for push-pull and metamer, and does nothing for {names}"
                )))
            }
            _ => Ok(()),
        }
    }

    /// Returns a fill as these arguments want it; a fill without inpainting is left as it is.
    pub fn of(&self, fill: Fill) -> Fill {
        match fill {
            Fill::Mode(_) => fill,
            Fill::Inpaint(inpaint) => Fill::Inpaint(Inpaint {
                gamma: self.gamma.map_or(inpaint.gamma, Gamma::from),
                fovea: self.fovea,
                ..inpaint
            }),
        }
    }
}

/// What is done with accelerations of captures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum AccelerationChoice {
    /// As the capture gives them
    #[default]
    Given,
    /// Left out
    Off,
    /// Limited so that they never outweigh the velocity
    Clamp,
    /// Smoothed over neighbours of the same surface
    Smooth,
}

impl From<AccelerationChoice> for ImportOptions {
    fn from(choice: AccelerationChoice) -> Self {
        let acceleration = match choice {
            AccelerationChoice::Given => AccelerationPolicy::AsGiven,
            AccelerationChoice::Off => AccelerationPolicy::Off,
            AccelerationChoice::Clamp => AccelerationPolicy::Clamp,
            AccelerationChoice::Smooth => AccelerationPolicy::Smooth,
        };
        Self { acceleration }
    }
}

/// How an update is extrapolated.
#[derive(Clone, Debug, Default, Args)]
#[command(allow_negative_numbers = true)]
pub struct Extrapolation {
    /// Frames to extrapolate [default: what the source is meant for]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub frames: Option<u32>,
    /// What is put into holes [default: push-pull for source, extend for map]
    #[arg(long, value_enum, value_name = "MODE")]
    pub fill: Option<FillChoice>,
    #[command(flatten)]
    pub inpainting: Inpainting,
    /// Rounds of bullet filling: each closes one cell more from each side
    #[arg(long, value_name = "ROUNDS", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=16))]
    pub reach: u32,
    /// How positions are rounded
    #[arg(long, value_enum, value_name = "ROUNDING", default_value_t)]
    pub rounding: RoundingChoice,
    /// D, the extent of the display in pixels [default: the next power of two of the larger side]
    #[arg(long, value_name = "PX")]
    pub extent: Option<u32>,
    /// tau_recog, the shortest recognisable time in frames [default: 8]
    #[arg(long, value_name = "FRAMES")]
    pub recog: Option<u32>,
    /// tau_prop, the frames to survive without an update [default: the next power of two of the frames that the source
    /// is meant for, whatever --frames asks for]
    #[arg(long, value_name = "FRAMES")]
    pub prop: Option<u32>,
    /// Fraction bits of positions, where tau_prop asks for less: sub-cell scan-out shows 4
    #[arg(long, value_name = "BITS", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=16))]
    pub position_frac: u32,
    /// Laplacian beyond which a cell is on an edge, as a part of the depth range [default: 1/64, without depth 1/128]
    #[arg(long, value_name = "PART", value_parser = part)]
    pub edge_threshold: Option<f64>,
    /// How galpixels move [default: source; map where --fill or --reach ask for what only the map has]
    #[arg(long, value_enum, value_name = "SCHEME")]
    pub scheme: Option<SchemeChoice>,
    /// How cells become pixels [default: sub-cell for source, nearest for map]
    #[arg(long, value_enum, value_name = "MODE")]
    pub scan_out: Option<ScanOutChoice>,
    /// What is done with the accelerations of a capture
    #[arg(long, value_enum, value_name = "POLICY", default_value_t)]
    pub acceleration: AccelerationChoice,
}

/// Returns a part of the depth range, from an argument.
pub fn part(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(part) if (0.0..=8.0).contains(&part) => Ok(part),
        _ => Err("give a number from 0 to 8".to_owned()),
    }
}

impl Extrapolation {
    /// Returns the request that these arguments make.
    ///
    /// *Errors:* what stationary sources do not have.
    pub fn request(&self) -> Result<Request, CliError> {
        let fill = self.fill.map(Fill::from);
        let only_map = self.reach != 1 || fill.is_some_and(|fill| !Scheme::Source.takes(fill));
        let usual = if only_map { Scheme::Map } else { Scheme::Source };
        let scheme = self.scheme.map_or(usual, Scheme::from);
        let fill = fill.unwrap_or_else(|| scheme.fill());
        if scheme == Scheme::Source {
            if !scheme.takes(fill) {
                return Err(not_of_sources("--fill", fill.name()));
            }
            if self.reach != 1 {
                let sentence = "`--reach` is for `--scheme map`: stationary sources close cracks without rounds";
                return Err(CliError::unusable(sentence));
            }
        }
        self.inpainting.check([fill])?;
        let scan_out = self.scan_out.map_or(scheme.scan_out(), ScanOut::from);
        // Stationary sources and resampling tell surfaces apart whatever is put into holes.
        let uses_edges = scheme == Scheme::Source || scan_out == ScanOut::SubCell || fill.mode().uses_edges();
        for (option, given, used) in [
            ("--reach", self.reach != 1, fill.mode().uses_edges()),
            ("--edge-threshold", self.edge_threshold.is_some(), uses_edges),
        ] {
            if given && !used {
                let fill = fill.name();
                return Err(CliError::Unusable(format!("`{option}` does nothing for `--fill {fill}`: leave it out")));
            }
        }
        Ok(Request {
            frames: self.frames,
            extent: self.extent,
            recog: self.recog,
            prop: self.prop,
            position_frac: self.position_frac,
            rounding: self.rounding.into(),
            fill: self.inpainting.of(fill),
            reach: self.reach,
            edge_threshold: self.edge_threshold,
            scheme,
            scan_out,
            perceptual: true,
            strategy: Strategy::ONE,
        })
    }
}

/// Returns the error of fills that stationary sources do not have, as they were given.
pub fn not_of_sources(option: &str, fills: &str) -> CliError {
    CliError::unusable(format!(
        "`{option} {fills}` is for `--scheme map`: stationary sources take none, hold, extend, push-pull or metamer"
    ))
}

/// Returns a positive number of pixels.
pub fn pixels(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(error) if error > 0.0 && error.is_finite() => Ok(error),
        _ => Err("give a positive number of pixels".to_owned()),
    }
}
