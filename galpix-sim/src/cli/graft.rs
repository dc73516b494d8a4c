//! `galpix graft`.

use std::path::PathBuf;

use clap::Args;

use super::drive::{Publication, drive};
use super::{CliError, printable};
use crate::source::scene;
use crate::study::graft::{self, Plan};
use crate::suggest;

/// Arguments of `galpix graft`.
#[derive(Debug, Args)]
#[command(after_long_help = graft::LEGEND)]
pub struct Graft {
    /// A built-in scene's name
    #[arg(value_name = "SCENE", default_value = "hud")]
    scene: String,
    /// Frames of each run
    #[arg(long, value_name = "N", default_value_t = Plan::default().frames, value_parser = clap::value_parser!(u32).range(8..=128))]
    frames: u32,
    /// Frames from one update of the whole view to the next
    #[arg(long, value_name = "N", default_value_t = Plan::default().global_every, value_parser = clap::value_parser!(u32).range(2..=64))]
    global: u32,
    /// Frames from one rendering of an object to the next; the background gets what is left of the rate
    #[arg(long, value_name = "N", default_value_t = Plan::default().objects_every, value_parser = clap::value_parser!(u32).range(1..=64))]
    objects: u32,
    /// Folder for graft.json and the last picture of each strategy [default: nothing is written]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Graft {
    /// Compares the strategies.
    pub fn run(&self) -> Result<(), CliError> {
        let Some(scene) = scene::find(&self.scene) else {
            let hint = suggest::hint(&self.scene, scene::all().iter().map(|scene| scene.name()));
            let name = printable(&self.scene);
            return Err(CliError::unusable(format!("there is no scene `{name}`{hint}: `galpix scenes` lists them")));
        };
        let plan = Plan { frames: self.frames, global_every: self.global, objects_every: self.objects };
        drive(&plan, &[scene], &Publication::to(self.out.as_ref(), self.json))
    }
}
