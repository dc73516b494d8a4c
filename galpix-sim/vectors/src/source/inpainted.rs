//! Cases of stationary sources whose cells without an entry are inpainted, by push-pull or metamers.

use galpix_core::inpaint::{
    Gamma, Inpainting, Metamer, MetamerWorkspace, Motion, Picture as Holed, PushPull, Recipe, Scale,
};
use galpix_core::source::Sources;
use galpix_core::stages::threshold_for_depth;
use galpix_core::{Dynamic, FillMode, Rounding, Settings};
use schemars::JsonSchema;
use serde::Serialize;

use super::{Drawn, Plan};
use crate::case::{Case, GridSize};
use crate::choice::grid;
use crate::maps::{Picture, Random, size};
use crate::run::{Model, RunError};
use crate::scenes::Scene;

/// How cells without an entry are inpainted, and by what.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Inpainted {
    /// The power of the validity: 0, 1/2 or 1.
    pub gamma: String,
    /// Between foreground and background, for depths of 15 bits.
    pub threshold: u32,
    /// A bit for each cell; empty for all of them.
    pub mask: Vec<u32>,
    /// That of metamers; null for push-pull.
    pub texture: Option<Texture>,
    /// A bit for each cell that is known.
    pub known: Vec<u32>,
    /// The depth of each cell.
    pub depths: Vec<u32>,
    /// The word of the displacement of what each cell shows.
    pub moved: Vec<u32>,
}

/// With what metamers are made.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Texture {
    /// Levels with bands.
    pub levels: u32,
    /// The scale: interval or deviation.
    pub noise: String,
    /// Whether chroma gets noise.
    pub coloured: bool,
    /// Which noise.
    pub seed: u32,
}

/// How cells without an entry are inpainted.
#[derive(Clone, Copy)]
pub(super) struct Paint {
    gamma: Gamma,
    /// Eighths of the edge threshold; none for an unlimited one.
    eighths: Option<u32>,
    masked: bool,
    /// That of metamers; none for push-pull.
    recipe: Option<Recipe>,
}

impl Model {
    /// Inpaints the cells without an entry, and says by what.
    pub(super) fn inpainted(
        &self,
        plan: &Plan,
        paint: &Paint,
        (sources, gathered): (&Sources<'_, '_, Dynamic>, &mut [u32]),
        random: &mut Random,
    ) -> Result<Inpainted, RunError> {
        let [width, height] = [size(&plan.map_size).0, size(&plan.map_size).1];
        let cells = gathered.len();
        let bits = cells.div_ceil(u32::BITS as usize);
        let (mut known, mut depths, mut moved) = (vec![0; bits], vec![0; cells], vec![0; cells]);
        let rows = depths.chunks_mut(width as usize).zip(moved.chunks_mut(width as usize));
        for (y, (depths, moved)) in (0..).zip(rows) {
            sources.known(y, &mut known, depths);
            sources.moved(y, moved);
        }
        let usual = sources.depth_threshold(plan.settings.edge_threshold);
        let threshold = paint.eighths.map_or(u32::MAX, |eighths| (usual * eighths) >> 3);
        let length = if paint.masked { bits } else { 0 };
        let mask: Vec<u32> = (0..length).map(|_| random.next() as u32 | random.next() as u32).collect();
        let inpainting = Inpainting { gamma: paint.gamma, threshold, mask: &mask, ..Inpainting::classic() };
        let colour = *self.record().colour_format();
        let mut picture = Holed::new(width, height, colour, gathered, &known)?.with_depths(&depths)?;
        match paint.recipe {
            None => {
                let mut memory = vec![0; PushPull::words(width, height, Motion::Kept)];
                PushPull::new(width, height, Motion::Kept, &mut memory)?.fill_picture(&mut picture, &inpainting);
            }
            Some(recipe) => {
                let mut memory = vec![0; Metamer::words(width, height, recipe.levels)];
                let mut workspace = MetamerWorkspace::new();
                let mut metamer = Metamer::new(width, height, recipe, &mut memory, &mut workspace)?;
                metamer.fill_picture(&mut picture, &inpainting, &moved)?;
            }
        }
        let texture = paint.recipe.map(|Recipe { levels, noise, coloured, seed }| Texture {
            levels,
            noise: noise.name().to_owned(),
            coloured,
            seed,
        });
        Ok(Inpainted { gamma: paint.gamma.name().to_owned(), threshold, mask, texture, known, depths, moved })
    }
}

/// Push-pull, for a layout and a scene.
const PUSH_PULL: Paint = Paint { gamma: Gamma::Zero, eighths: Some(8), masked: false, recipe: None };

/// Metamers as they are by default.
const METAMER: Paint = Paint {
    gamma: Gamma::Half,
    recipe: Some(Recipe { levels: 4, noise: Scale::Deviation, coloured: false, seed: 0 }),
    ..PUSH_PULL
};

const fn metamer(levels: u32, noise: Scale, coloured: bool, seed: u32) -> Paint {
    Paint { recipe: Some(Recipe { levels, noise, coloured, seed }), ..METAMER }
}

/// What uncovers much, and has holes of class 3 and of others, and how that is inpainted.
const INPAINTED: [(Scene, GridSize, Paint); 16] = [
    (Scene::Slide, grid(40, 24, [0; 4]), PUSH_PULL),
    (Scene::Slide, grid(40, 24, [0; 4]), METAMER),
    (Scene::Slide, grid(26, 30, [3, 2, 1, 0]), Paint { gamma: Gamma::One, ..metamer(3, Scale::Interval, false, 77) }),
    (Scene::Swell, grid(33, 21, [0; 4]), METAMER),
    (Scene::Swell, grid(33, 21, [1, 0, 0, 2]), Paint { gamma: Gamma::Half, masked: true, ..PUSH_PULL }),
    (Scene::Patches, grid(24, 14, [0; 4]), Paint { gamma: Gamma::One, eighths: None, ..PUSH_PULL }),
    (Scene::Slide, grid(45, 20, [0; 4]), Paint { masked: true, ..metamer(1, Scale::Deviation, true, u32::MAX) }),
    (
        Scene::Slide,
        grid(70, 11, [0; 4]),
        Paint { gamma: Gamma::Zero, eighths: None, ..metamer(8, Scale::Deviation, true, 5) },
    ),
    (Scene::Speckle, grid(21, 40, [0; 4]), Paint { eighths: None, ..METAMER }),
    (Scene::Patches, grid(24, 14, [0; 4]), METAMER),
    (Scene::Hurried, grid(36, 18, [0; 4]), metamer(0, Scale::Deviation, false, 9)),
    (Scene::Slide, grid(8, 7, [0; 4]), METAMER),
    (Scene::Slide, grid(1, 1, [0; 4]), METAMER),
    (Scene::Drawn(Picture::Empty), grid(12, 9, [0; 4]), METAMER),
    (Scene::Speckle, grid(1, 290, [0; 4]), Paint { eighths: Some(0), ..metamer(9, Scale::Interval, true, 3) }),
    (
        Scene::Drawn(Picture::Random),
        grid(30, 20, [0; 4]),
        Paint { eighths: None, ..metamer(4, Scale::Deviation, true, 11) },
    ),
];

/// Returns the cases, over layouts of one word and of several, of little depth and of much.
pub fn cases(seed: u64, models: &[&Model]) -> Result<Vec<Case>, RunError> {
    let models = models.iter().filter(|model| ["paper", "velocity565", "gray8", "finest"].contains(&model.name));
    let mut cases = Vec::new();
    for (turn, ((scene, map_size, paint), model)) in INPAINTED.into_iter().zip(models.cycle()).enumerate() {
        let plan = Plan {
            settings: Settings {
                rounding: Rounding::LowDiscrepancy,
                fill_mode: FillMode::Extend,
                reach: 1,
                edge_threshold: threshold_for_depth(model.depth_bits()),
            },
            map_size,
            frame: 0,
            frames: [5, 3, 7][turn % 3],
            sub_cell: turn % 4 != 2,
            paint: Some(paint),
        };
        let fill = if paint.recipe.is_some() { "metamer" } else { "push-pull" };
        let name = format!("source-{}-{}-{fill}-{turn}", model.name, scene.name());
        let about = format!("{} steps of samples that show {}, inpainted by {fill}", plan.frames, scene.name());
        let content = model.sources(&plan, &[Drawn { scene, own: None }], &mut Random::new(seed, &name))?;
        cases.push(Case { name, about, content });
    }
    Ok(cases)
}
