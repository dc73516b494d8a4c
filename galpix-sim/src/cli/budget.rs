//! `galpix budget`.

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use galpix_core::record::{Component, Shave};
use galpix_core::{Bits, BudgetError, Demand, Layout, Record, Rounding};
use schemars::JsonSchema;
use serde::Serialize;

use super::choices::{RoundingChoice, pixels};
use super::logic::{self, Display, LogicReport};
use super::{CliError, print, print_json};
use crate::certificate::{Certificate, Method, shown_off_px, smallest};
use crate::engine::ScanOut;
use crate::study::job::finer;
use crate::study::run::BudgetReport;

/// A layout by its name, with what it carries in words.
#[derive(Clone, Copy, Debug)]
struct LayoutChoice(&'static str, Layout, &'static str);

/// All of them, the default first.
const LAYOUTS: [LayoutChoice; 7] = [
    LayoutChoice("full", Layout::FULL, "x, y, z with velocity and acceleration, RGB888, 16-bit z"),
    LayoutChoice("tagged", Layout::TAGGED, "Full with an 8-bit object tag"),
    LayoutChoice("shaded", Layout::SHADED, "Tagged with shading inertia"),
    LayoutChoice("flat565", Layout::FLAT565, "x and y with velocity and acceleration, RGB565, 16-bit z"),
    LayoutChoice("velocity565", Layout::VELOCITY565, "x and y with velocity only, RGB565, 16-bit z"),
    LayoutChoice("velocity-gray8", Layout::VELOCITY_GRAY8, "x and y with velocity only, 8-bit gray, 8-bit z"),
    LayoutChoice("velocity-gray4", Layout::VELOCITY_GRAY4, "x and y with velocity only, 4-bit gray, 4-bit z"),
];

/// Returns a layout by its name.
pub fn layout(name: &str) -> Option<Layout> {
    LAYOUTS.iter().find(|choice| choice.0 == name).map(|choice| choice.1)
}

impl Default for LayoutChoice {
    fn default() -> Self {
        LAYOUTS[0]
    }
}

impl ValueEnum for LayoutChoice {
    fn value_variants<'a>() -> &'a [Self] {
        &LAYOUTS
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.0).help(self.2))
    }
}

/// Arguments of `galpix budget`.
#[derive(Debug, Default, Args)]
#[command(allow_negative_numbers = true)]
pub struct Budget {
    /// D, the extent of the display in pixels
    #[arg(long, value_name = "PX", default_value_t = 1024)]
    extent: u32,
    /// tau_recog, the shortest recognisable time in frames
    #[arg(long, value_name = "FRAMES", default_value_t = 8)]
    recog: u32,
    /// tau_prop, the frames to survive without an update
    #[arg(long, value_name = "FRAMES", default_value_t = 16)]
    prop: u32,
    /// Fraction bits of positions in x and y, where tau_prop asks for less: sub-cell scan-out shows 4
    #[arg(long, value_name = "BITS", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=16))]
    #[arg(conflicts_with = "max_error")]
    position_frac: u32,
    /// How positions are rounded
    #[arg(long, value_enum, value_name = "ROUNDING", default_value_t)]
    rounding: RoundingChoice,
    /// Which fields a galpixel carries
    #[arg(long, value_enum, value_name = "LAYOUT", default_value_t)]
    layout: LayoutChoice,
    /// Bits to take off in x and y, for example velocity-int=1; may be given several times
    #[arg(long, value_name = "FIELD=BITS", value_parser = shaving)]
    shave: Vec<(ShavedField, u32)>,
    /// Bits to take off in depth
    #[arg(long, value_name = "FIELD=BITS", value_parser = shaving)]
    shave_z: Vec<(ShavedField, u32)>,
    /// Instead of the equations' fraction bits, the fewest whose certificate is at most this, in pixels
    #[arg(long, value_name = "PX", value_parser = pixels, conflicts_with = "shave")]
    max_error: Option<f64>,
    /// Integer bits of the motion in y so that no galpixel moves by more rows in a frame: the band that logic keeps
    #[arg(long, value_name = "ROWS", value_parser = clap::value_parser!(u32).range(1..))]
    limit_y: Option<u32>,
    /// The map that memory and traffic are printed for
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = size)]
    size: Option<[u32; 2]>,
    /// Frames a second for them
    #[arg(long, value_name = "HZ", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    rate: u32,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Reads a size in cells.
fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').map(|(width, height)| [width, height].map(|side| side.parse::<u32>().ok()));
    match sides {
        Some([Some(width @ 1..=32768), Some(height @ 1..=32768)]) => Ok([width, height]),
        _ => Err("give columns and rows, for example 320x240, each 1 to 32768".to_owned()),
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ShavedField {
    PositionFrac,
    VelocityInt,
    VelocityFrac,
    AccelerationInt,
    AccelerationFrac,
}

fn shaving(text: &str) -> Result<(ShavedField, u32), String> {
    let parsed = text.split_once('=').and_then(|(field, bits)| {
        Some((ShavedField::from_str(field, true).ok()?, bits.parse::<u32>().ok().filter(|&bits| bits <= 32)?))
    });
    parsed.ok_or_else(|| {
        "give FIELD=BITS with FIELD one of position-frac, velocity-int, velocity-frac, acceleration-int, \
         acceleration-frac, and BITS from 0 to 32"
            .to_owned()
    })
}

fn shave(list: &[(ShavedField, u32)]) -> Shave {
    let mut shave = Shave::default();
    for &(field, bits) in list {
        *match field {
            ShavedField::PositionFrac => &mut shave.position_frac,
            ShavedField::VelocityInt => &mut shave.velocity_int,
            ShavedField::VelocityFrac => &mut shave.velocity_frac,
            ShavedField::AccelerationInt => &mut shave.acceleration_int,
            ShavedField::AccelerationFrac => &mut shave.acceleration_frac,
        } += bits;
    }
    shave
}

#[derive(Serialize, JsonSchema)]
pub struct Printed {
    #[serde(flatten)]
    report: BudgetReport,
    used_bits_per_galpixel: u32,
    layout: &'static str,
    rounding: &'static str,
    depth: DepthReport,
    /// The error that the fraction bits were chosen for, in pixels; null where the equations chose.
    max_error_px: Option<f64>,
    certificate: Certificate,
    keeps_one_pixel: bool,
    displayed: DisplayedReport,
    /// The same widths with each rounding.
    roundings: Vec<RoundingReport>,
    /// The widths in y: those of x, above, unless its reach is limited.
    y: ComponentReport,
    /// What it asks of logic.
    logic: LogicReport,
}

/// Widths of a component.
#[derive(Serialize, JsonSchema)]
struct ComponentReport {
    position_frac_bits: u32,
    velocity_int_bits: u32,
    velocity_frac_bits: u32,
    acceleration_int_bits: u32,
    acceleration_frac_bits: u32,
}

/// How far in x and in y a galpixel is shown at most from where it should be, in pixels: the certificate's total and
/// what scan-out adds.
#[derive(Serialize, JsonSchema)]
pub struct DisplayedReport {
    nearest_px: f64,
    sub_cell_px: f64,
}

#[derive(Serialize, JsonSchema)]
pub struct RoundingReport {
    rounding: &'static str,
    drift_px: f64,
    total_px: f64,
    keeps_one_pixel: bool,
}

#[derive(Serialize, JsonSchema)]
pub struct DepthReport {
    moves: bool,
    stored_bits: u32,
    bins_bits: u32,
    position_frac_bits: u32,
    velocity_int_bits: u32,
    velocity_frac_bits: u32,
    acceleration_int_bits: u32,
    acceleration_frac_bits: u32,
}

impl Budget {
    /// Prints the budget.
    pub fn run(&self) -> Result<(), CliError> {
        let printed = self.printed()?;
        if self.json { print_json("budget", &printed) } else { print(&text(&printed)) }
    }

    fn printed(&self) -> Result<Printed, CliError> {
        let LayoutChoice(name, layout, _) = self.layout;
        let impossible = |error: BudgetError| CliError::Unusable(format!("this budget cannot exist: {error}"));
        let demand = Demand { extent: self.extent, recog: self.recog, prop: self.prop };
        let rounding = self.rounding.into();
        if !self.shave_z.is_empty() && !layout.depth_motion {
            let sentence =
                format!("depth does not move in the layout {name}, so `--shave-z` shaves nothing: leave it out");
            return Err(CliError::Unusable(sentence));
        }
        let bits = if layout.acceleration { Bits::derive(demand) } else { Bits::derive_without_acceleration(demand) };
        let bits = finer(bits.map_err(impossible)?, self.position_frac);
        let plane: Component = match self.max_error {
            Some(error) => smallest(bits.x, rounding, self.prop, error).map_err(CliError::unusable)?.0,
            None => bits.x.shaved(shave(&self.shave)).map_err(impossible)?,
        };
        let z = bits.z.shaved(shave(&self.shave_z)).map_err(impossible)?;
        let mut bits = bits.with_xy(plane, plane).with_z(z, bits.depth_int);
        if let Some(limit) = self.limit_y {
            bits = logic::limited(bits, limit, |bits| Record::plan(bits, layout).ok()).map_err(CliError::Unusable)?;
        }
        let record = Record::plan(bits, layout).map_err(impossible)?;
        let [columns, rows] = self.size.unwrap_or([1024, 768]);
        let certify = |rounding| Certificate::of(&record.scales[0], layout.acceleration, rounding, self.prop);
        let certificate = certify(rounding);
        let roundings = Rounding::ALL.map(|rounding| {
            let certificate = certify(rounding);
            RoundingReport {
                rounding: rounding.name(),
                drift_px: certificate.drift_px,
                total_px: certificate.total_px,
                keeps_one_pixel: certificate.keeps_one_pixel(),
            }
        });
        Ok(Printed {
            report: BudgetReport::of(demand, bits, &record),
            used_bits_per_galpixel: record.bits(),
            layout: name,
            rounding: rounding.name(),
            depth: DepthReport {
                moves: layout.depth_motion,
                stored_bits: u32::from(record.depth().bits),
                bins_bits: bits.depth_int,
                position_frac_bits: record.scales[2].position_frac,
                velocity_int_bits: z.velocity_int,
                velocity_frac_bits: z.velocity_frac,
                acceleration_int_bits: z.acceleration_int,
                acceleration_frac_bits: z.acceleration_frac,
            },
            max_error_px: self.max_error,
            keeps_one_pixel: certificate.keeps_one_pixel(),
            displayed: DisplayedReport {
                nearest_px: certificate.total_px + shown_off_px(ScanOut::Nearest, plane.position_frac),
                sub_cell_px: certificate.total_px + shown_off_px(ScanOut::SubCell, plane.position_frac),
            },
            certificate,
            roundings: roundings.into(),
            y: ComponentReport {
                position_frac_bits: bits.y.position_frac,
                velocity_int_bits: bits.y.velocity_int,
                velocity_frac_bits: bits.y.velocity_frac,
                acceleration_int_bits: bits.y.acceleration_int,
                acceleration_frac_bits: bits.y.acceleration_frac,
            },
            logic: LogicReport::of(&record, Display { columns, rows, rate: self.rate }),
        })
    }
}

fn text(printed: &Printed) -> String {
    let report = &printed.report;
    let certificate = &printed.certificate;
    let mut rows = vec![("position, fraction", report.position_frac_bits.to_string(), "(11)")];
    // Without acceleration a galpixel is at most a quarter as fast, and its velocity as fine as its position.
    let accelerates = report.acceleration_int_bits > 0;
    let [fastest, slowest] = if accelerates { ["(8)", "(13)"] } else { ["(8) less 2: no acceleration", "as (11)"] };
    rows.push(("velocity, integer with sign", report.velocity_int_bits.to_string(), fastest));
    rows.push(("velocity, fraction", report.velocity_frac_bits.to_string(), slowest));
    if accelerates {
        rows.push(("acceleration, integer with sign", report.acceleration_int_bits.to_string(), "(9)"));
        rows.push(("acceleration, fraction", report.acceleration_frac_bits.to_string(), "(12)"));
    }
    let sum = if accelerates { "(14)" } else { "position, velocity" };
    rows.push(("motion, bits a component", report.motion_bits_per_component.to_string(), sum));
    let components = if printed.depth.moves { "x, y and z" } else { "x and y" };
    rows.push(("motion, bytes a galpixel", report.motion_bytes_per_galpixel.to_string(), components));
    rows.push(("stored, bytes a galpixel", report.stored_bytes_per_galpixel.to_string(), printed.layout));
    rows.push(("of these bits in use", printed.used_bits_per_galpixel.to_string(), ""));
    let mut text = format!(
        "D = {} px, tau_recog = {} frames, tau_prop = {} frames, x and y:\n",
        report.extent, report.recog, report.prop
    );
    for (name, value, source) in rows {
        text.push_str(&format!("  {name:<33}{value:>6}  {source}\n"));
    }
    if let Some(error) = printed.max_error_px {
        text.push_str(&format!("the fewest bits whose certificate is at most {error} px\n"));
    }
    text.push_str(&format!(
        "certificate with {} rounding, worst case over all states, in pixels\n  frame   position  velocity  acceleration     drift     \
         total\n",
        printed.rounding
    ));
    for bound in certificate.frames.iter().filter(|bound| is_listed(bound.frame, report.prop)) {
        text.push_str(&format!(
            "  {:>5} {:>10.4} {:>9.4} {:>13.4} {:>9.4} {:>9.4}\n",
            bound.frame,
            bound.position_px,
            bound.velocity_px,
            bound.acceleration_px,
            bound.drift_px,
            bound.total_px()
        ));
    }
    text.push_str(&format!(
        "up to tau_prop, from {}\n  quantisation of r, v, a  {:.4} px\n  rounding drift           {:.4} px\n  total                    \
         {:.4} px\n",
        method(certificate),
        certificate.quantisation_px,
        certificate.drift_px,
        certificate.total_px,
    ));
    text.push_str("the same widths with each rounding\n");
    for other in &printed.roundings {
        let promise = if other.keeps_one_pixel { "keeps one pixel" } else { "does not keep one pixel" };
        text.push_str(&format!(
            "  {:<16} drift {:.4}  total {:.4} px  {promise}\n",
            other.rounding, other.drift_px, other.total_px
        ));
    }
    let y = &printed.y;
    if (y.velocity_int_bits, y.acceleration_int_bits) != (report.velocity_int_bits, report.acceleration_int_bits) {
        text.push_str(&format!(
            "in y the integer bits are {} of the velocity and {} of the acceleration; fractions and certificate are \
             those of x\n",
            y.velocity_int_bits, y.acceleration_int_bits
        ));
    }
    text.push_str(&printed.logic.text());
    let promise = if printed.keeps_one_pixel { "holds" } else { "does not hold" };
    text.push_str(&format!(
        "The paper's promise of one pixel for {} frames {promise}. On the screen: {:.4} px in whole cells (nearest), {:.4} \
         px with sub-cell scan-out.",
        report.prop, printed.displayed.nearest_px, printed.displayed.sub_cell_px
    ));
    text
}

/// Returns whether a frame is listed: the first, the powers of two, the last.
fn is_listed(frame: u32, prop: u32) -> bool {
    prop <= 32 || frame.is_power_of_two() || frame == prop
}

/// Returns how a certificate was found, in words.
fn method(certificate: &Certificate) -> String {
    let Certificate { classes, phases, .. } = certificate;
    match certificate.method {
        Method::Enumerated => {
            format!("all {classes} residue classes of velocity and acceleration, from {phases} phases")
        }
        Method::Bounded => {
            format!("{classes} residue classes from {phases} phases are too many to run: an upper bound")
        }
    }
}
