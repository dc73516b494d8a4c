//! `galpix graft`.

use std::path::PathBuf;

use clap::Args;

use super::call;
use super::progress;
use super::{CliError, print, print_json, printable};
use crate::source::scene;
use crate::study::graft::{self, GraftsError, Plan, report};

/// Arguments of `galpix graft`.
#[derive(Debug, Args)]
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
    /// Folder for graft.json and the last picture of each way [default: nothing is written]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Graft {
    /// Compares the ways.
    pub fn run(&self) -> Result<(), CliError> {
        let Some(scene) = scene::find(&self.scene) else {
            let name = printable(&self.scene);
            return Err(CliError::unusable(format!("there is no scene `{name}`: `galpix scenes` lists them")));
        };
        if let Some(out) = &self.out {
            call::writable(out)?;
        }
        let plan = Plan { frames: self.frames, global_every: self.global, objects_every: self.objects };
        let bar = progress::bar(graft::WAYS, scene.name());
        let compared = graft::study(scene, &plan, || bar.inc(1));
        bar.finish_and_clear();
        let (found, pictures) = compared.map_err(|error| match error {
            GraftsError::Engine(_) => CliError::Failed(error.to_string()),
            _ => CliError::unusable(error),
        })?;
        if let Some(out) = &self.out {
            for (name, picture) in &pictures.pictures {
                let path = out.join(format!("{name}.png"));
                picture.write_png(&path).map_err(|error| CliError::unwritable(&path, &error))?;
            }
            call::write(out, &[("graft.json", call::json(&found)?)])?;
        }
        if self.json { print_json(&found) } else { print(&format!("{}\n{}", report::table(&found), report::LEGEND)) }
    }
}
