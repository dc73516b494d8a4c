//! The depth discontinuity occlusion camera on worlds of triangles: reference images, frames warped from them, and what
//! those frames lack. The distortion map is that of [`crate::source::ddoc`].
//!
//! ```text
//! scene, file ─▶ world ─▶ reference (plain, DDOC) ─▶ warp ─▶ missing ─▶ report, pictures, page
//!                            distortion ─┘
//! ```

mod columns;
pub mod import;
pub mod missing;
mod page;
pub mod pictures;
pub mod reference;
pub mod report;
pub mod view;
pub mod warp;
pub mod world;
pub mod worlds;

use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;

use galpix_core::SetupError;
use galpix_core::ddoc::{MOST_RADIUS, SYMMETRIC, Settings};

pub use self::columns::LEGEND;
use self::import::ImportError;
use self::missing::Missing;
use self::pictures::Pictures;
use self::report::SourceReport;
use self::view::View;
use self::warp::Joint;
use self::world::World;
use super::{File, Found, NoExtra, Silent, Stage, Study, StudyError, Work};
use crate::output::column::Table;
use crate::output::save::file_name;
use crate::source::ddoc::distortion;
use crate::source::scene;
use crate::suggest;

/// The sides of reference images that are possible, pixels.
pub const SIZES: std::ops::RangeInclusive<usize> = 64..=2048;

/// The mesh of samples is cut where the inverse distance changes by this part of its range over a 512th of the image: a
/// pixel of an image of 512.
pub const STEP: f32 = 1.0 / 64.0;

/// How an image is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// Side of the reference images, pixels.
    pub size: usize,
    /// D, pixels.
    pub radius: u32,
    /// a_f, 1 to 15.
    pub asymmetry: f64,
}

impl Request {
    /// Returns the default request: D is a 32nd of the image, a_f is 2.
    #[must_use]
    pub fn new(size: usize) -> Self {
        Self { size, radius: (size as u32 / 32).clamp(1, MOST_RADIUS), asymmetry: 2.0 }
    }

    /// Returns the settings of the distortion map.
    #[must_use]
    pub fn settings(&self) -> Settings {
        let sixteenths = (self.asymmetry * f64::from(SYMMETRIC)).round() as u32;
        Settings { radius: self.radius, asymmetry: sixteenths, ..distortion::settings() }
    }

    /// Returns what joins the samples of the plain image, and of the DDOC image.
    ///
    /// The first are a pixel apart. The second are squeezed, at most by twice the asymmetry along the distortion; and
    /// the direction of neighbouring splats differs by a little, which moves what is far from the edge by some pixels
    /// more.
    #[must_use]
    pub fn joints(&self) -> [Joint; 2] {
        let step = STEP * 512.0 / self.size as f32;
        [1.5, 2.0 * self.asymmetry as f32 + 4.0].map(|reach| Joint { step, reach })
    }
}

/// A world as it was seen.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Seen {
    /// Its figures.
    #[serde(flatten)]
    pub report: SourceReport,
    /// Its pictures.
    #[serde(skip)]
    pub pictures: Pictures,
}

/// The whole study.
pub type Document = super::Document<NoExtra, Seen>;

impl Study for Request {
    type Source = World;
    type Job<'s> = &'s World;
    type Report = Seen;
    type Extra = NoExtra;

    const NAME: &'static str = "ddoc";
    const SECONDS: bool = false;

    fn name<'a>(&self, world: &'a World) -> &'a str {
        &world.name
    }

    fn resolve<'s>(&self, world: &'s World) -> Result<&'s World, StudyError> {
        Ok(world)
    }

    fn pieces(&self, _world: &&World) -> u64 {
        1
    }

    fn study(&self, world: &&World, stage: &Stage<'_>) -> Result<Found<Seen>, StudyError> {
        let (report, pictures) = study(world, self).map_err(StudyError::unusable)?;
        (stage.notify)(Work::Done);
        Ok(Found::Report(Seen { report, pictures }))
    }

    fn head(&self) -> Option<String> {
        Some(Table::new(&columns::columns(), &[]).heading())
    }

    fn legends(&self) -> Vec<String> {
        vec![columns::LEGEND.to_owned()]
    }

    fn text(&self, seen: &Seen) -> String {
        Table::new(&columns::columns(), &[]).line(&seen.report)
    }

    fn extra(&self, _silent: &Silent) -> NoExtra {
        NoExtra {}
    }

    fn files(&self, document: &Document) -> Result<Vec<File>, StudyError> {
        let mut files = Vec::new();
        for Seen { report, pictures } in &document.sources {
            for (name, _, picture) in &pictures.all {
                let png = picture.png().map_err(StudyError::failed)?;
                files.push((format!("{}-{name}.png", file_name(&report.source)), png));
            }
        }
        let json = self.json(document).map_err(StudyError::failed)? + "\n";
        files.push(("ddoc.json".to_owned(), json.into_bytes()));
        files.push(("ddoc.html".to_owned(), page::html(document).into_bytes()));
        Ok(files)
    }
}

/// Why there is no study.
#[derive(Debug, thiserror::Error)]
pub enum DdocError {
    /// No world, scene or file has the name.
    #[error("`{name}` is no world{hint}: give a built-in scene, one of {known}, or the path of an OBJ file")]
    Unknown {
        /// What was asked for.
        name: String,
        /// What may have been meant, if anything.
        hint: String,
        /// The worlds that are no scenes.
        known: String,
    },
    /// A file cannot be used.
    #[error("{0}")]
    Import(#[from] ImportError),
    /// The image cannot exist.
    #[error("{0}")]
    Setup(#[from] SetupError),
}

/// Returns the worlds that are studied if none is named.
#[must_use]
pub fn defaults() -> &'static [&'static str] {
    &["pillars", "sphere", "crossing", "near-plane", "portal", "knot"]
}

/// Returns the world of a name: one of [`worlds::names`], a built-in scene, or the path of an OBJ file.
///
/// *Errors:* one sentence that says what, where and how to correct it.
pub fn open(name: &str) -> Result<World, DdocError> {
    if let Some(world) = worlds::find(name) {
        return Ok(world);
    }
    if let Some(scene) = scene::find(name) {
        return Ok(World::of_scene(scene));
    }
    if import::is_object(name) {
        return Ok(import::obj(Path::new(name))?);
    }
    let name: String = name.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
    let hint =
        suggest::hint(&name, worlds::names().iter().copied().chain(scene::all().iter().map(|scene| scene.name())));
    Err(DdocError::Unknown { name, hint, known: worlds::names().join(", ") })
}

/// Takes both images of a world, warps them to the views of the cube, and counts what is missing.
///
/// *Errors:* a size that a distortion map cannot have.
pub fn study(world: &World, request: &Request) -> Result<(SourceReport, Pictures), DdocError> {
    let plain = reference::plain(world, &View::reference(request.size));
    let ddoc = reference::ddoc(world, request.size, &request.settings())?;
    let [plain_joint, ddoc_joint] = request.joints();
    let references = [(&plain, plain_joint), (&ddoc.image, ddoc_joint)];
    let views = missing::count(world, request.size, &references);
    let report = SourceReport::new(world, request, &ddoc, &views);
    // The view that shows most of what the plain image lacks.
    let worst = views.iter().max_by_key(|view| view.missing[0]).map_or([0.0; 3], |view: &Missing| view.eye);
    let pictures = Pictures::new(world, &missing::desired(worst, request.size), &references, &ddoc);
    Ok((report, pictures))
}
