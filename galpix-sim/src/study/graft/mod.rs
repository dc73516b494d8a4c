//! What object grafts buy: each object of a scene updated at a rate of its own against updates of the whole view, at
//! the same number of cells a second; and what pinning does for instruments over the picture.
//!
//! Each surface of a scene is an object with a tag and a layer of its own, the first one the background in the base. A
//! *rendering* is the rectangle of the cells that a surface covers, also where another one hides it; all its cells are
//! counted as sent, also empty ones.

mod columns;
mod pinned;
pub mod report;
mod run;
mod stationary;
mod world;

use schemars::JsonSchema;
use serde::Serialize;

use galpix_core::objects::Limits;
use galpix_core::{Bits, Demand};

pub use columns::LEGEND;
pub use pinned::PinnedReport;
use report::{GraftReport, StrategyReport};
use run::{Deliver, Strategy};
use world::World;

use super::{File, Found, NoExtra, PathPrinted, Silent, Stage, Study, StudyError, Work};
use crate::engine::{EngineError, Scheme};
use crate::picture::Picture;
use crate::source::scene::Scene;

/// Objects of a scene at most, the background included.
pub const MOST_OBJECTS: usize = 8;

/// What is compared.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Frames of a run.
    pub frames: u32,
    /// Frames from one update of the whole view to the next.
    pub global_every: u32,
    /// Frames from one rendering of an object to the next; the background gets what is left of the rate.
    pub objects_every: u32,
}

impl Default for Plan {
    fn default() -> Self {
        Self { frames: 64, global_every: 16, objects_every: 4 }
    }
}

/// Why there is nothing to compare.
#[derive(Debug, thiserror::Error)]
pub enum GraftsError {
    /// One surface is no picture of several objects.
    #[error("scene {0} has no objects before a background: choose another one, `galpix graft hud` for instance")]
    NoObjects(&'static str),
    /// More objects than layers.
    #[error("scene {0} has {1} objects and at most {MOST_OBJECTS} are compared: choose another one")]
    TooManyObjects(&'static str, usize),
    /// The objects alone take the whole rate.
    #[error(
        "objects every {objects_every} frames are {objects} cells a frame, and the whole view every {global_every} frames \
         is only {global}: raise --objects or lower --global"
    )]
    Rate {
        /// The plan's.
        objects_every: u32,
        /// Cells a frame.
        objects: u32,
        /// The plan's.
        global_every: u32,
        /// Cells a frame.
        global: u32,
    },
    /// Too little is left of the rate for the background.
    #[error(
        "the objects leave so little that the background comes every {every} frames, and a run has {frames}: raise --objects or \
         --frames, or lower --global"
    )]
    Rarely {
        /// Frames from one rendering of the background to the next.
        every: u64,
        /// The plan's.
        frames: u32,
    },
    /// The engine cannot be set up.
    #[error("{0}")]
    Engine(#[from] EngineError),
}

/// A scene as it was compared.
#[derive(Serialize, JsonSchema)]
pub struct Seen {
    /// Its figures.
    #[serde(flatten)]
    report: GraftReport,
    #[serde(skip)]
    pictures: Pictures,
}

impl Study for Plan {
    type Source = &'static dyn Scene;
    type Job<'s> = &'static dyn Scene;
    type Report = Seen;
    type Extra = NoExtra;

    const NAME: &'static str = "graft";
    const PATH: PathPrinted = PathPrinted::Nowhere;

    fn name<'a>(&self, scene: &'a &'static dyn Scene) -> &'a str {
        scene.name()
    }

    fn resolve(&self, scene: &&'static dyn Scene) -> Result<&'static dyn Scene, StudyError> {
        Ok(*scene)
    }

    fn pieces(&self, _scene: &&'static dyn Scene) -> u64 {
        WAYS
    }

    fn study(&self, scene: &&'static dyn Scene, stage: &Stage<'_>) -> Result<Found<Seen>, StudyError> {
        let (report, pictures) = study(*scene, self, || (stage.notify)(Work::Done)).map_err(|error| match error {
            GraftsError::Engine(_) => StudyError::failed(error),
            _ => StudyError::unusable(error),
        })?;
        Ok(Found::Report(Seen { report, pictures }))
    }

    fn legends(&self) -> Vec<String> {
        vec![columns::LEGEND.to_owned()]
    }

    fn text(&self, seen: &Seen) -> String {
        columns::text(&seen.report)
    }

    fn extra(&self, _silent: &Silent) -> NoExtra {
        NoExtra {}
    }

    /// Returns the figures of the one scene, without anything around them.
    fn json(&self, document: &super::Document<NoExtra, Seen>) -> serde_json::Result<String> {
        serde_json::to_string_pretty(&document.sources.first().map(|seen| document.headed(&seen.report)))
    }

    fn files(&self, document: &super::Document<NoExtra, Seen>) -> Result<Vec<File>, StudyError> {
        let mut files = Vec::new();
        for (name, picture) in document.sources.iter().flat_map(|seen| &seen.pictures.pictures) {
            files.push((format!("{name}.png"), picture.png().map_err(StudyError::failed)?));
        }
        let json = self.json(document).map_err(StudyError::failed)? + "\n";
        files.push(("graft.json".to_owned(), json.into_bytes()));
        Ok(files)
    }
}

/// The last picture of each strategy.
pub struct Pictures {
    /// Name and picture, the truth last.
    pub pictures: Vec<(String, Picture)>,
}

/// Compares the strategies for a scene; `done` is called after each of them.
///
/// *Errors:* a scene without objects or with too many, rates that leave nothing for the background.
pub fn study(
    scene: &'static dyn Scene,
    plan: &Plan,
    mut done: impl FnMut(),
) -> Result<(GraftReport, Pictures), GraftsError> {
    let world = World::of(scene);
    let objects = scene.surfaces().len();
    if objects < 2 {
        return Err(GraftsError::NoObjects(scene.name()));
    }
    if objects > MOST_OBJECTS {
        return Err(GraftsError::TooManyObjects(scene.name(), objects));
    }
    let strategies = strategies(&world, plan)?;
    let longest = strategies.iter().map(|strategy| strategy.deliver.longest()).max().unwrap_or(1);
    let side = scene.width().max(scene.height()).next_power_of_two();
    let demand = Demand { extent: side as u32, recog: 8, prop: longest.next_power_of_two().max(2) };
    let bits = Bits::derive(demand).map_err(EngineError::from)?;
    let mut pictures = Vec::new();
    let mut reports: Vec<StrategyReport> = Vec::new();
    for strategy in &strategies {
        let (report, picture) = run::run(&world, strategy, plan.frames, bits)?;
        pictures.push((strategy.name.to_owned(), picture));
        reports.push(report);
        done();
    }
    pictures.push(("truth".to_owned(), crate::source::scene::render(scene, f64::from(plan.frames))));
    let pinned = match scene.overlay() {
        Some(overlay) => Some(pinned::compare(scene, &overlay)?),
        None => None,
    };
    let report = GraftReport {
        scene: scene.name(),
        frames: plan.frames,
        objects: world.cells().iter().zip(scene.surfaces()).map(|(&cells, _)| cells).collect(),
        cells: world.all_cells(),
        strategies: reports,
        pinned,
    };
    Ok((report, Pictures { pictures }))
}

/// How many strategies [`study`] compares.
pub const WAYS: u64 = 9;

/// Returns the strategies, from the paper's "global update" on, all with at most its rate.
fn strategies(world: &World, plan: &Plan) -> Result<Vec<Strategy>, GraftsError> {
    let Plan { global_every, objects_every, .. } = *plan;
    let all_cells = world.all_cells();
    let (background, objects) = (all_cells, world.cells().iter().skip(1).sum::<u32>());
    // In cells for a period of the one times a period of the other, so that nothing is rounded.
    let left =
        (u64::from(all_cells) * u64::from(objects_every)).checked_sub(u64::from(objects) * u64::from(global_every));
    let period = u64::from(global_every) * u64::from(objects_every);
    let background_every = match left {
        Some(left @ 1..) => (u64::from(background) * period).div_ceil(left),
        _ => u64::MAX,
    };
    if left.is_some_and(|left| left > 0) && background_every > u64::from(plan.frames) {
        return Err(GraftsError::Rarely { every: background_every, frames: plan.frames });
    }
    if background_every > u64::from(plan.frames) {
        let (objects, global) = (objects / objects_every, all_cells / global_every);
        return Err(GraftsError::Rate { objects_every, objects, global_every, global });
    }
    let background_every = background_every as u32;
    let all = background + objects;
    let layered_every = (u64::from(all) * u64::from(global_every)).div_ceil(u64::from(all_cells)) as u32;
    let late = 4;
    let roomy = Limits { cells_each: background, cells: all, age: 2 * late };
    let grafts = Deliver::Objects { objects_every, background_every, late: 0, limits: roomy, updates: 8 };
    let graft = |late, limits, updates| Deliver::Objects { objects_every, background_every, late, limits, updates };
    // One rendering may wait, and it may not be the background.
    let small = Limits { cells_each: background / 2, cells: background / 2, age: 2 * late };
    let view = Deliver::View { every: global_every };
    let all_objects = Deliver::Objects {
        objects_every: layered_every,
        background_every: layered_every,
        late: 0,
        limits: roomy,
        updates: 8,
    };
    Ok([
        ("whole-view", Scheme::Map, view),
        ("whole-layers", Scheme::Map, Deliver::Layers { every: layered_every }),
        ("all-objects", Scheme::Map, all_objects),
        ("grafts", Scheme::Map, grafts),
        ("grafts-late", Scheme::Map, graft(late, roomy, 8)),
        ("grafts-small-queue", Scheme::Map, graft(0, small, 1)),
        ("whole-view-sources", Scheme::Source, view),
        ("grafts-sources", Scheme::Source, grafts),
        ("grafts-late-sources", Scheme::Source, graft(late, roomy, 8)),
    ]
    .map(|(name, scheme, deliver)| Strategy { name, scheme, deliver })
    .into())
}
