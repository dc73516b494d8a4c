//! Cases of stationary sources: which there are, what they say, and the core run over their inputs.

use galpix_core::layers::displacement_word;
use galpix_core::source::{Gather, Source, Sources, Visibility, link_words};
use galpix_core::stages::threshold_for_depth;
use galpix_core::{Bits, Demand, Dynamic, FillMode, Galpixmap, Grid, Layout, Rounding, Settings, SetupError, Tally};
use schemars::JsonSchema;
use serde::Serialize;

use crate::case::{Case, Content, Counts, GridSize, Setting};
use crate::choice::grid;
use crate::maps::{Picture, Random, size};
use crate::run::{GridMemory, Model, RunError, planes};
use crate::scenes::{Ground, Scene};
use crate::sub_cell;
use inpainted::{Inpainted, Paint};

mod inpainted;

/// Layers of samples, some frames of them, and what the last one shows.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct StationarySources {
    /// Widths, fields, places, size.
    #[serde(flatten)]
    pub setting: Setting,
    /// The edge threshold, in units of the depth's last bit.
    pub threshold: u32,
    /// The rounding's name.
    pub rounding: String,
    /// The frame counter of the first step.
    pub frame: u32,
    /// Steps; with 0 the samples are shown as they are given.
    pub frames: u32,
    /// None, hold or extend.
    pub fill_mode: String,
    /// Whether colours are resampled.
    pub sub_cell: bool,
    /// The layers, the base first.
    pub layers: Vec<SourceLayer>,
    /// What each cell of the map shows after cracks are closed: depth and kind, 65535 without an entry.
    pub keys: Vec<u32>,
    /// Number and residual of the sample, 4294967295 without an entry.
    pub entries: Vec<u32>,
    /// How cells without an entry are inpainted; left out where they are not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inpaint: Option<Inpainted>,
    /// A colour word for each cell of the map, inpainted, before silhouettes.
    pub gathered: Vec<u32>,
    /// The colour words after silhouettes; empty without sub-cell scan-out.
    pub shown: Vec<u32>,
    /// Of the last step.
    pub counts: Counts,
}

/// One layer, before the first step and after the last one.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SourceLayer {
    /// Its grid; left out where it has the columns and rows of the map.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grid: Option<LayerGrid>,
    /// Its galpixels.
    pub galpixels: Vec<u32>,
    /// The word of the displacement of each cell.
    pub displacements: Vec<u32>,
    /// The links of each cell, two bits for the pair with its right neighbour and two above them for the lower one: 3
    /// linked, 1 the first one ends, 2 the second one does.
    pub links: Vec<u32>,
    /// Its galpixels after the last step.
    pub galpixels_after: Vec<u32>,
    /// Its displacements after the last step.
    pub displacements_after: Vec<u32>,
}

/// The grid of a layer, which has no margin.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct LayerGrid {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl StationarySources {
    /// Returns the arrays of a case by their names.
    pub fn arrays(&self) -> Vec<(String, Vec<u32>)> {
        let mut arrays = Vec::new();
        for (k, layer) in self.layers.iter().enumerate() {
            let SourceLayer { grid: _, galpixels, displacements, links, galpixels_after, displacements_after } = layer;
            arrays.extend([
                (format!("galpixels_{k}"), galpixels.clone()),
                (format!("displacements_{k}"), displacements.clone()),
                (format!("links_{k}"), links.clone()),
                (format!("galpixels_after_{k}"), galpixels_after.clone()),
                (format!("displacements_after_{k}"), displacements_after.clone()),
            ]);
        }
        for (name, words) in [("keys", &self.keys), ("entries", &self.entries), ("gathered", &self.gathered)] {
            arrays.push((name.to_owned(), words.clone()));
        }
        if let Some(Inpainted { mask, known, depths, moved, .. }) = &self.inpaint {
            for (name, words) in [("mask", mask), ("known", known), ("depths", depths), ("moved", moved)] {
                if !words.is_empty() {
                    arrays.push((name.to_owned(), words.clone()));
                }
            }
        }
        if self.sub_cell {
            arrays.push(("shown".to_owned(), self.shown.clone()));
        }
        arrays
    }
}

/// How a case is made.
struct Plan {
    settings: Settings,
    map_size: GridSize,
    frame: u32,
    frames: u32,
    sub_cell: bool,
    paint: Option<Paint>,
}

/// What a layer shows at first.
#[derive(Clone, Copy)]
struct Drawn {
    scene: Scene,
    /// A grid of its own, and where on the map its first cell lies.
    own: Option<(LayerGrid, [i32; 2])>,
}

impl Drawn {
    /// Returns the layer's size, of a map of `map_size`.
    fn size(&self, map_size: GridSize) -> GridSize {
        self.own.map_or(map_size, |(LayerGrid { width, height }, _)| grid(width, height, [0; 4]))
    }

    /// Returns the words of its galpixels and its displacements.
    fn words(&self, model: &Model, map_size: GridSize, random: &mut Random) -> [Vec<u32>; 2] {
        let [map, mut displacements] = self.scene.layer(model.record(), &self.size(map_size), random);
        if let Some((_, place)) = self.own {
            for word in &mut displacements {
                let [x, y] = [*word as i16, (*word >> 16) as i16].map(i32::from);
                *word = displacement_word([x + place[0], y + place[1]]);
            }
        }
        [map, displacements]
    }
}

/// Memory of a layer.
struct LayerMemory {
    map: Vec<u32>,
    displacements: Vec<u32>,
    links: Vec<u32>,
}

impl LayerMemory {
    fn new([map, displacements]: [Vec<u32>; 2]) -> Self {
        Self { map, displacements, links: Vec::new() }
    }

    /// Makes a layer that is linked where its samples are stored, and then lies where it is given.
    fn layer<'m>(
        &'m mut self,
        grid: Grid<'m>,
        format: Dynamic,
        edge_threshold: u32,
    ) -> Result<Source<'m, Dynamic>, SetupError> {
        let displacements = self.displacements.clone();
        self.links.resize(link_words(&grid), 0);
        let map = Galpixmap::over(grid, format, &mut self.map)?;
        let mut source = Source::new(map, &mut self.displacements, &mut self.links)?;
        source.begin(edge_threshold);
        source.displacements_mut().copy_from_slice(&displacements);
        Ok(source)
    }
}

impl Model {
    /// Makes frames of layers of stationary sources, and shows the last one.
    fn sources(&self, plan: &Plan, drawn: &[Drawn], random: &mut Random) -> Result<Content, RunError> {
        let mut starts = GridMemory::new(plan.map_size);
        let grid = starts.grid()?;
        let cells = grid.cells() as usize;
        let at_first: Vec<[Vec<u32>; 2]> = drawn.iter().map(|drawn| drawn.words(self, plan.map_size, random)).collect();
        let mut layer_starts: Vec<_> = drawn.iter().map(|drawn| GridMemory::new(drawn.size(plan.map_size))).collect();
        let mut memories: Vec<_> = at_first.iter().cloned().map(LayerMemory::new).collect();
        let mut layers = Vec::new();
        for (memory, starts) in memories.iter_mut().zip(&mut layer_starts) {
            layers.push(memory.layer(starts.grid()?, self.format, plan.settings.edge_threshold)?);
        }
        let (mut keys, mut words, mut line) =
            (vec![0; cells], vec![0; cells], vec![0; Visibility::line_half_words(&grid)]);
        let visibility = Visibility::new(&grid, &mut keys, &mut words, &mut line)?;
        let mut sources = Sources::new(&mut layers, visibility)?;
        sources.set_frame(plan.frame);
        let counts = match plan.frames {
            0 => sources.show(&plan.settings),
            frames => (0..frames).fold(Tally::default(), |_, _| sources.step(&plan.settings)),
        };
        let mut gathered = plan.gathered(&sources, &grid);
        let inpaint = match &plan.paint {
            Some(paint) => Some(self.inpainted(plan, paint, (&sources, &mut gathered), random)?),
            None => None,
        };
        let shown = plan.shown(&sources, &gathered);
        let entries = || (0..grid.cells()).map(|cell| sources.entry(cell).unwrap_or((u16::MAX, u32::MAX)));
        let layers = sources.layers().iter().zip(at_first).zip(drawn);
        let layers = layers.map(|((source, [galpixels, displacements]), drawn)| SourceLayer {
            grid: drawn.own.map(|(grid, _)| grid),
            galpixels,
            displacements,
            links: (0..source.map().grid().cells()).map(|cell| source.link(cell)).collect(),
            galpixels_after: planes(source.map()),
            displacements_after: (0..source.map().grid().cells())
                .map(|cell| displacement_word(source.displacement(cell)))
                .collect(),
        });
        Ok(Content::Source(StationarySources {
            setting: self.setting(plan.map_size),
            threshold: plan.settings.edge_threshold,
            rounding: plan.settings.rounding.name().to_owned(),
            frame: plan.frame,
            frames: plan.frames,
            fill_mode: plan.settings.fill_mode.name().to_owned(),
            sub_cell: plan.sub_cell,
            layers: layers.collect(),
            keys: entries().map(|(key, _)| key.into()).collect(),
            entries: entries().map(|(_, word)| word).collect(),
            inpaint,
            gathered,
            shown,
            counts: counts.into(),
        }))
    }
}

impl Plan {
    /// Returns the colours of all cells before silhouettes.
    fn gathered(&self, sources: &Sources<'_, '_, Dynamic>, grid: &Grid<'_>) -> Vec<u32> {
        let Settings { fill_mode, edge_threshold, .. } = self.settings;
        let gather = Gather { fill_mode, sub_cell: self.sub_cell, edge_threshold };
        let width = grid.width() as usize;
        let mut gathered = vec![0; grid.cells() as usize];
        for (y, row) in (0..).zip(gathered.chunks_mut(width)) {
            sources.gather(y, gather, row);
        }
        gathered
    }

    /// Returns the colours after silhouettes; none without sub-cell scan-out.
    fn shown(&self, sources: &Sources<'_, '_, Dynamic>, gathered: &[u32]) -> Vec<u32> {
        let width = size(&self.map_size).0 as usize;
        let mut shown = vec![0; if self.sub_cell { gathered.len() } else { 0 }];
        let row = |y: Option<usize>| y.and_then(|y| gathered.chunks(width).nth(y)).unwrap_or_default();
        for (y, colours) in shown.chunks_mut(width).enumerate() {
            let around = [row(y.checked_sub(1)), row(Some(y)), row(Some(y + 1))];
            sources.finish(y as u32, self.settings.edge_threshold, around, colours);
        }
        shown
    }
}

/// Mostly with room for surfaces; rows longer than any run that an engine may take at once, lines along either side,
/// margins, and a single cell.
const SHAPES: [GridSize; 9] = [
    grid(24, 14, [0; 4]),
    grid(70, 4, [0; 4]),
    grid(17, 11, [2, 1, 3, 0]),
    grid(12, 9, [0; 4]),
    grid(1, 23, [0; 4]),
    grid(40, 7, [1, 0, 0, 1]),
    grid(21, 1, [0; 4]),
    grid(15, 15, [0; 4]),
    grid(1, 1, [0; 4]),
];

/// The first shapes, for scenes that need room.
const WIDE: [GridSize; 3] = [SHAPES[0], SHAPES[2], SHAPES[1]];

/// Where what happens in the first and in the last column counts.
const HIGH: GridSize = grid(5, 96, [0; 4]);

const fn placed(name: &'static str, matrix: [i32; 4], noise: u32) -> Scene {
    Scene::Placed { name, matrix, noise, ground: Ground::Level }
}

const fn rough(name: &'static str, matrix: [i32; 4], noise: u32) -> Scene {
    Scene::Placed { name, matrix, noise, ground: Ground::Rough }
}

/// Scenes of the base over all layouts, by the number of layers.
const SCENES: [(Scene, usize); 14] = [
    (Scene::Slide, 1),
    (Scene::Driven { name: "expand", matrix: [40, 0, 0, 40] }, 2),
    (Scene::Drawn(Picture::Random), 2),
    (placed("crumpled", [40, 0, 0, 40], 14), 1),
    (Scene::Steps, 1),
    (Scene::Driven { name: "rotate", matrix: [10, -50, 50, 10] }, 2),
    (Scene::Slant, 1),
    (Scene::Drawn(Picture::Extreme), 1),
    (Scene::Fence { upright: true }, 2),
    (placed("cracks", [43, 0, 0, 40], 2), 2),
    (Scene::Patches, 2),
    (rough("torn-rough", [42, 0, 4, 40], 6), 3),
    (placed("turned", [50, -44, 40, 52], 5), 1),
    (Scene::Fence { upright: false }, 1),
];

/// Quads of every form, cracks, rims, and displacements at their limits, over few layouts.
const SPECIAL: [(Scene, usize); 42] = [
    (placed("at-limit", [44, 0, 0, 44], 0), 2),
    (placed("beyond-across", [45, 0, 0, 32], 0), 1),
    (placed("beyond-down", [32, 0, 0, 45], 0), 2),
    (placed("skewed", [34, 45, 0, 34], 0), 1),
    (Scene::Slide, 1),
    (Scene::Slide, 2),
    (placed("four-wide", [128, 0, 0, 64], 0), 1),
    (Scene::Slide, 1),
    (placed("skewed-back", [34, 0, -45, 34], 0), 1),
    (placed("wider", [129, 0, 0, 50], 9), 2),
    (placed("higher", [50, 0, 0, 133], 9), 1),
    (Scene::Swell, 1),
    (placed("folded", [-60, 0, 0, 60], 0), 1),
    (placed("edge-on", [60, 2, 10, 1], 0), 1),
    (placed("flat", [48, 2, 16, 1], 0), 1),
    (placed("thin", [46, 0, 0, 1], 1), 1),
    (Scene::Placed { name: "torn", matrix: [40, 0, 0, 40], noise: 50, ground: Ground::Holes }, 2),
    (Scene::Placed { name: "farthest", matrix: [46, 0, 0, 46], noise: 6, ground: Ground::Farthest }, 1),
    (placed("across", [42, 0, 0, 32], 0), 2),
    (rough("rough", [43, 0, 0, 43], 3), 2),
    (rough("rough-crumpled", [40, 8, -8, 40], 20), 2),
    (placed("down", [32, 0, 0, 42], 0), 2),
    (Scene::Limits, 2),
    (Scene::Diagonal { falls: true }, 2),
    (Scene::Drawn(Picture::Empty), 1),
    (Scene::Diagonal { falls: false }, 2),
    (Scene::Speckle, 1),
    (Scene::Speckle, 1),
    (Scene::Speckle, 1),
    (Scene::Hurried, 1),
    (placed("sheared", [64, 48, 0, 64], 0), 1),
    (Scene::Speckle, 2),
    (Scene::Swell, 2),
    (Scene::Swell, 1),
    (Scene::Rims { few: false }, 1),
    (Scene::Rims { few: true }, 1),
    (Scene::Rims { few: false }, 2),
    (Scene::Rims { few: false }, 1),
    (Scene::Rims { few: true }, 1),
    (Scene::Rims { few: false }, 1),
    (Scene::Rims { few: false }, 1),
    (Scene::Rims { few: false }, 1),
];

/// Returns all cases, over the layouts of the others and three more.
pub fn cases(seed: u64, models: &[Model]) -> Result<Vec<Case>, RunError> {
    let demand = Demand { extent: 64, recog: 8, prop: 8 };
    let more = [
        Model::new("finest", Layout { depth_bits: 28, ..Layout::VELOCITY565 }, sub_cell::finest()?)?,
        Model::new("level", sub_cell::LEVEL, Bits::derive(demand)?)?,
        Model::new("plain565", Layout::VELOCITY565, Bits::derive_without_acceleration(demand)?)?,
    ];
    let models: Vec<&Model> = models.iter().chain(&more).collect();
    let mut cases = Vec::new();
    for (place, model) in models.iter().enumerate() {
        for index in 0..4 {
            let turn = place * 4 + index;
            let (scene, layers) = SCENES[turn * 3 % SCENES.len()];
            cases.push(case(seed, model, (scene, layers), turn)?);
        }
    }
    let special = models.iter().filter(|model| ["velocity565", "gray8", "straddle", "finest"].contains(&model.name));
    for (turn, ((scene, layers), model)) in SPECIAL.into_iter().zip(special.cycle()).enumerate() {
        cases.push(case(seed, model, (scene, layers), 1000 + turn)?);
    }
    cases.extend(inpainted::cases(seed, &models)?);
    let few = models.iter().filter(|model| ["paper", "velocity565", "gray8", "finest"].contains(&model.name));
    for (turn, (objects, model)) in OBJECTS.into_iter().zip(few.cycle()).enumerate() {
        cases.push(object_case(seed, model, objects, turn)?);
    }
    Ok(cases)
}

const fn object(scene: Scene, [width, height]: [u32; 2], place: [i32; 2]) -> Drawn {
    Drawn { scene, own: Some((LayerGrid { width, height }, place)) }
}

/// Objects in layers of their own grids, before a base of 40x24 cells: inside and across each border, of one column, of
/// one row, as wide as the map and higher than it.
const OBJECTS: [[Drawn; 2]; 10] = [
    [object(Scene::Slide, [13, 9], [11, 8]), object(Scene::Background, [7, 5], [20, 2])],
    [object(placed("grows", [44, 0, 0, 44], 4), [12, 12], [22, 9]), object(Scene::Slide, [40, 3], [0, 17])],
    [object(Scene::Swell, [17, 11], [-6, -4]), object(Scene::Swell, [17, 11], [31, 18])],
    [object(Scene::Slant, [1, 20], [19, 1]), object(Scene::Slant, [33, 1], [3, 12])],
    [object(Scene::Drawn(Picture::Random), [16, 9], [9, 7]), object(Scene::Patches, [20, 14], [8, 6])],
    [
        object(rough("torn", [42, 0, 4, 40], 6), [21, 10], [9, 9]),
        object(Scene::Drawn(Picture::Random), [9, 30], [4, -3]),
    ],
    [object(Scene::Hurried, [19, 8], [10, 10]), object(Scene::Limits, [24, 14], [8, 5])],
    [object(Scene::Fence { upright: true }, [24, 14], [9, 4]), object(Scene::Steps, [31, 13], [5, 5])],
    [object(placed("turned", [50, -44, 40, 52], 5), [15, 15], [12, 4]), object(Scene::Speckle, [11, 17], [14, 3])],
    [object(Scene::Diagonal { falls: true }, [24, 14], [8, 5]), object(Scene::CloseBackground, [24, 14], [8, 5])],
];

fn object_case(seed: u64, model: &Model, objects: [Drawn; 2], turn: usize) -> Result<Case, RunError> {
    let plan = Plan {
        settings: Settings {
            rounding: Rounding::ALL[turn % Rounding::ALL.len()],
            fill_mode: FillMode::Extend,
            reach: 1,
            edge_threshold: threshold_for_depth(model.depth_bits()),
        },
        map_size: if turn % 3 == 2 { grid(36, 22, [3, 1, 2, 0]) } else { grid(40, 24, [0; 4]) },
        frame: turn as u32,
        frames: [2, 0, 3, 1][turn % 4],
        sub_cell: turn != 6,
        paint: None,
    };
    let [one, other] = objects;
    let base = Drawn { scene: if turn.is_multiple_of(2) { Scene::Background } else { Scene::Slant }, own: None };
    let (one_name, other_name) = (one.scene.name(), other.scene.name());
    let name = format!("source-{}-objects-{one_name}-{other_name}", model.name);
    let about =
        format!("{} steps of a base and two objects of their own size, {one_name} and {other_name}", plan.frames);
    let content = model.sources(&plan, &[base, one, other], &mut Random::new(seed, &name))?;
    Ok(Case { name, about, content })
}

fn case(seed: u64, model: &Model, (scene, layers): (Scene, usize), turn: usize) -> Result<Case, RunError> {
    let special = turn >= 1000;
    let map_size = match scene {
        Scene::Speckle if turn.is_multiple_of(2) => HIGH,
        _ if special => WIDE[turn / 2 % WIDE.len()],
        _ => SHAPES[(turn + turn / 9) % SHAPES.len()],
    };
    let default = threshold_for_depth(model.depth_bits());
    let plan = Plan {
        settings: Settings {
            rounding: Rounding::ALL[turn % Rounding::ALL.len()],
            fill_mode: [FillMode::Extend, FillMode::Hold, FillMode::Extend, FillMode::None][turn / 2 % 4],
            reach: 1,
            edge_threshold: match turn % 11 {
                4 => 0,
                9 => u32::MAX,
                7 => default * 3,
                _ => default,
            },
        },
        map_size,
        frame: [0, u32::MAX - 1, 5][turn % 3],
        frames: match scene {
            Scene::Slide | Scene::Swell | Scene::Speckle => 3,
            Scene::Rims { .. } => 1 + turn as u32 % 3,
            _ if special => turn as u32 % 2,
            _ => [3, 4, 2, 0, 3][turn % 5],
        },
        sub_cell: turn % 7 != 3,
        paint: None,
    };
    // Behind the base: a background, the same once more at the same depths, or anything.
    let behind = [Scene::Background, scene, Scene::CloseBackground, Scene::Drawn(Picture::Random)];
    let drawn: Vec<Drawn> = (0..layers)
        .map(|layer| Drawn { scene: if layer == 0 { scene } else { behind[(turn + layer) % 4] }, own: None })
        .collect();
    let GridSize { width, height, .. } = map_size;
    let name = format!("source-{}-{}-{layers}-{width}x{height}", model.name, scene.name());
    let about =
        format!("{} steps of {layers} layers of samples, the first of which shows {}", plan.frames, scene.name());
    let content = model.sources(&plan, &drawn, &mut Random::new(seed, &name))?;
    Ok(Case { name, about, content })
}

#[cfg(test)]
mod tests;
