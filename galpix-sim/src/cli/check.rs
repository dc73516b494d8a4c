//! `galpix check`.

use std::path::{Path, PathBuf};

use clap::Args;

use super::choices::AccelerationChoice;
use super::{CliError, call, note, print, print_json, printable, printable_lines};
use crate::output::save::file_name;
use crate::study::check::{self, CheckReport, Spread};

/// Characters of the longest bar of a histogram.
const LONGEST: usize = 40;

/// Arguments of `galpix check`.
#[derive(Debug, Args)]
pub struct Check {
    /// A built-in scene's name, or the path of a capture.toml or of its folder
    source: String,
    /// What becomes of accelerations
    #[arg(long, value_enum, default_value_t)]
    acceleration: AccelerationChoice,
    /// Folder for motion.png: hue is the direction, strength the speed [default: galpix-out/check/NAME; with --json
    /// nothing is written without it]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Check {
    /// Loads the source and says what was read.
    pub fn run(&self) -> Result<(), CliError> {
        let source = call::open(&self.source, self.acceleration)?;
        let usual = || Path::new("galpix-out").join("check").join(file_name(source.name()));
        let out = self.out.clone().or_else(|| (!self.json).then(usual));
        let picture = out.map(|out| out.join("motion.png"));
        call::spare(&self.source, picture.clone())?;
        let report = check::check(&source).map_err(CliError::unusable)?;
        if let Some(path) = picture {
            let written = std::fs::create_dir_all(path.parent().unwrap_or(Path::new(".")))
                .and_then(|()| check::motion(&source.update()).write_png(&path));
            written.map_err(|error| CliError::unwritable(&path, &error))?;
            note(&format!("the motion as colours is in {}", path.display()));
        }
        if self.json { print_json("check", &report) } else { print(&printable_lines(&text(&report))) }
    }
}

/// Returns a report as text.
fn text(report: &CheckReport) -> String {
    let CheckReport { width, height, margin, known, colour_only, .. } = report;
    let mut lines = vec![format!("{}: {}", report.source, report.about)];
    let around = [margin.left, margin.right, margin.top, margin.bottom];
    let margin = if around == [0; 4] {
        String::new()
    } else {
        format!(", and {} left, {} right, {} above, {} below", around[0], around[1], around[2], around[3])
    };
    lines.push(format!("{width}x{height} pixels{margin}; {} frames", report.frames));
    lines.push(format!("cells with depth and motion: {known}; with a colour alone: {colour_only}"));
    for (what, spread) in [
        ("speed, px a frame", &report.speed_px),
        ("depth, 0 nearest to 1 farthest", &report.depth),
        ("acceleration, px a frame each frame", &report.acceleration_px),
    ] {
        lines.extend(spread.iter().flat_map(|spread| histogram(what, spread)));
    }
    let frames: Vec<String> = report.truths.iter().map(u32::to_string).collect();
    lines.push(match frames.len() {
        0 => "\nno truth: nothing to compare with".to_owned(),
        _ => format!("\ntruth at frames {}", frames.join(" ")),
    });
    if let Some(first) = &report.first {
        let db = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.2} dB"));
        lines.push(format!(
            "frame {}: {}, sample-and-hold {}, reached cells {}",
            first.frame,
            db(first.psnr_db),
            db(first.psnr_hold_db),
            db(first.psnr_known_db)
        ));
    }
    lines.extend(report.notes.iter().map(|text| format!("note: {}", printable(text))));
    if let Some(manifest) = &report.manifest {
        lines.push(format!("\nthe manifest, with the keys that are not given:\n\n{}", manifest.trim_end()));
    }
    lines.join("\n")
}

/// Returns the lines of a histogram.
fn histogram(what: &str, spread: &Spread) -> Vec<String> {
    let Spread { least, quarter, median, three_quarters, ninety_nine, most, counts } = spread;
    let mut lines = vec![format!(
        "\n{what}: {least:.3} to {most:.3}; a quarter to {quarter:.3}, half to {median:.3}, three quarters to \
         {three_quarters:.3}, 99 % to {ninety_nine:.3}"
    )];
    if least == most {
        return lines;
    }
    let (step, largest) = ((most - least) / counts.len() as f64, counts.iter().max().copied().unwrap_or(1).max(1));
    for (bin, count) in counts.iter().enumerate() {
        let from = least + step * bin as f64;
        let bar = "#".repeat((count * LONGEST).div_ceil(largest));
        lines.push(format!("{from:>10.3} to {:>9.3} {count:>9} {bar}", from + step));
    }
    lines
}
