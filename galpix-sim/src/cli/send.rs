//! `galpix send`.

use clap::{Args, ValueEnum};
use galpix_link::panel::{Description, Lcd, Oled, Panel, Tft};

use super::{CliError, note, print, print_json, printable};
use crate::cli::progress;
use crate::send::{self, Address, Report, Request};
use crate::source::Source;
use crate::source::capture::ImportOptions;

/// A display that galpix knows.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum PanelChoice {
    /// 128 x 64, 4-bit gray, velocity
    Oled,
    /// 160 x 120, RGB565, velocity
    Tft,
    /// 320 x 240, RGB565, velocity and acceleration
    Lcd,
}

impl From<PanelChoice> for Description {
    fn from(choice: PanelChoice) -> Self {
        match choice {
            PanelChoice::Oled => Oled::DESCRIPTION,
            PanelChoice::Tft => Tft::DESCRIPTION,
            PanelChoice::Lcd => Lcd::DESCRIPTION,
        }
    }
}

/// Arguments of `galpix send`.
#[derive(Debug, Args)]
pub struct Send {
    /// A built-in scene's name, or the path of a capture.toml or of its folder
    source: String,
    /// Where the device is: tcp:HOST:PORT, unix:PATH, the path of a serial device, or file:PATH to keep the stream
    #[arg(long, value_name = "DEVICE")]
    to: Address,
    /// The panel [default: the device's own]
    #[arg(long, value_enum, value_name = "PANEL")]
    panel: Option<PanelChoice>,
    /// Updates to send; a capture has one
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=65_535))]
    updates: u32,
    /// Frames of the device between two updates [default: 8]
    #[arg(long, value_name = "FRAMES", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    every: Option<u32>,
    /// Leave the device's built-in scene on, and send into it; else only what is sent is seen
    #[arg(long)]
    over_scene: bool,
    /// Bits a second of a serial device [default: 115200]
    #[arg(long, value_name = "BITS", value_parser = clap::value_parser!(u32).range(1..))]
    baud: Option<u32>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Send {
    /// Sends the source.
    pub fn run(&self) -> Result<(), CliError> {
        let unusable = |error: &dyn std::fmt::Display| CliError::Unusable(printable(&error.to_string()));
        let source = Source::open(&self.source, &ImportOptions::default()).map_err(CliError::unusable)?;
        if source.update().overlay.is_some() {
            note(&format!(
                "{}: what is pinned over the picture is not sent, the line has no message for it",
                printable(source.name())
            ));
        }
        let Self { updates, every, over_scene, .. } = *self;
        if every.is_some() && updates == 1 {
            return Err(CliError::unusable(
                "`--every` is for more than one update: add `--updates N`, or leave it out",
            ));
        }
        let every = every.unwrap_or(8);
        let request = Request { panel: self.panel.map(Description::from), updates, every, over_scene };
        // Before a file is made.
        request.check(&source, &self.to).map_err(|error| unusable(&error))?;
        let mut line = self.to.open(self.baud).map_err(|error| unusable(&error))?;
        let bar = progress::bar(1, &printable(source.name()));
        let report = send::send(&source, &request, line.as_mut(), &self.to, |done, all| {
            bar.set_length(all);
            bar.set_position(done);
        });
        bar.finish_and_clear();
        let report = report.map_err(|error| {
            if error.unusable() { unusable(&error) } else { CliError::Failed(printable(&error.to_string())) }
        })?;
        super::remark(&source);
        if self.json { print_json("send", &report) } else { print(&text(&report)) }
    }
}

fn text(report: &Report) -> String {
    let mut lines = vec![format!(
        "{} to {} ({}x{}): {} frames of galpixels, {} bytes in {:.1} s",
        printable(&report.source),
        report.panel,
        report.width,
        report.height,
        report.frames,
        report.bytes,
        report.seconds
    )];
    for sent in &report.updates {
        lines.push(format!(
            "update {}, exact at frame {}: {} galpixels, {} cells empty, {} fields clamped",
            sent.update, sent.stamp, sent.galpixels, sent.empty, sent.saturated
        ));
    }
    lines.push(match &report.device {
        None => "nothing answers here: what arrives is not known".to_owned(),
        Some(device) => {
            let causes = device.rejected.iter().filter(|(_, count)| **count > 0);
            let causes: Vec<_> = causes.map(|(cause, count)| format!("{count} {}", cause.replace('_', " "))).collect();
            format!(
                "the device, at frame {}: {} of {} accepted, {} refused{}{}, {} frames late",
                device.frame,
                device.accepted,
                report.frames,
                device.refused,
                if causes.is_empty() { "" } else { ": " },
                causes.join(", "),
                device.late
            )
        }
    });
    lines.join("\n")
}
