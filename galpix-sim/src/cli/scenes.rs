//! `galpix scenes`.

use clap::Args;
use schemars::JsonSchema;
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

#[derive(Serialize, JsonSchema)]
pub struct List {
    scenes: Vec<SceneLine>,
}

#[derive(Serialize, JsonSchema)]
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
        let scenes: Vec<SceneLine> = scene::all()
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
            return print_json("scenes", &List { scenes });
        }
        for line in scenes {
            let order = if line.second_order { "second order" } else { "beyond second order" };
            print(&format!("{:<11} {:>2} frames, {order:<19}  {}", line.name, line.frames, line.about))?;
        }
        Ok(())
    }
}
