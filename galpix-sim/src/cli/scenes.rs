//! `galpix scenes`.

use clap::Args;
use serde::Serialize;

use super::{CliError, print, print_json};
use crate::source::scene;

/// Arguments of `galpix scenes`.
#[derive(Debug, Default, Args)]
pub struct Scenes {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct SceneLine {
    name: &'static str,
    about: &'static str,
    width: usize,
    height: usize,
    frames: u32,
    second_order: bool,
}

impl Scenes {
    /// Lists the scenes.
    pub fn run(&self) -> Result<(), CliError> {
        let lines: Vec<SceneLine> = scene::all()
            .iter()
            .map(|scene| SceneLine {
                name: scene.name(),
                about: scene.about(),
                width: scene.width(),
                height: scene.height(),
                frames: scene.frames(),
                second_order: scene.second_order(),
            })
            .collect();
        if self.json {
            return print_json(&lines);
        }
        for line in lines {
            let order = if line.second_order { "second order" } else { "beyond second order" };
            print(&format!("{:<11} {:>2} frames, {order:<19}  {}", line.name, line.frames, line.about))?;
        }
        Ok(())
    }
}
