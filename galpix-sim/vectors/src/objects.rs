//! Cases of objects that are grafted by their tags: which there are, their content, and the core run over their inputs.

use galpix_core::objects::{Object, ObjectsTally, replace};
use galpix_core::{Bits, Colour, Demand, Galpixmap, Layout, Rounding};
use schemars::JsonSchema;
use serde::Serialize;

use crate::case::{Case, Content, GridSize, Setting};
use crate::choice::grid;
use crate::maps::{Picture, Random, size, words};
use crate::run::{GridMemory, Model, RunError, planes};

/// A map and renderings that enter it at one frame boundary.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Objects {
    /// Widths, fields, places, size.
    #[serde(flatten)]
    pub setting: Setting,
    /// The rounding's name.
    pub rounding: String,
    /// The frame counter of the map.
    pub frame: u32,
    /// The map.
    pub front: Vec<u32>,
    /// In the order in which they enter.
    pub renderings: Vec<Rendering>,
}

/// A rendering, and what it makes of the map.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Rendering {
    /// The object's tag.
    pub tag: u32,
    /// The frame counter that it is exact at.
    pub stamp: u32,
    /// Column and row of the rectangle in the map, margin included.
    pub place: [u32; 2],
    /// Columns and rows of the rectangle.
    pub size: [u32; 2],
    /// The words of its cells, one cell after the other.
    pub galpixels: Vec<u32>,
    /// What became of it.
    pub grafted: Grafted,
    /// The map afterwards.
    pub map: Vec<u32>,
}

/// Counts of a rendering.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Grafted {
    removed: u32,
    put: u32,
    behind: u32,
    lost: u32,
    empty: u32,
    replaced: u32,
    saturated: u32,
}

impl From<ObjectsTally> for Grafted {
    fn from(tally: ObjectsTally) -> Self {
        let ObjectsTally { removed, put, behind, lost, empty, replaced, saturated, .. } = tally;
        Self { removed, put, behind, lost, empty, replaced, saturated }
    }
}

impl Objects {
    /// Returns the arrays of a case by their names.
    pub fn arrays(&self) -> Vec<(String, Vec<u32>)> {
        let mut arrays = vec![("front".to_owned(), self.front.clone())];
        for (n, rendering) in (1..).zip(&self.renderings) {
            arrays.push((format!("galpixels_{n}"), rendering.galpixels.clone()));
            arrays.push((format!("map_{n}"), rendering.map.clone()));
        }
        arrays
    }
}

/// Every field, and so few tags that a random map has many galpixels of each.
const FEW: Layout = Layout { luminosity: true, tag_bits: 2, ..Layout::FULL };

/// Without acceleration.
const FEW_SLIDE: Layout = Layout { tag_bits: 2, ..Layout::VELOCITY_GRAY8 };

/// What does not move and has no depth is decided by its class.
const FEW_FLAT: Layout = Layout { colour: Colour::GRAY4, tag_bits: 1, ..Layout::STILL };

/// What the map shows, the rendering shows, and how many frames late each of the renderings is.
const PICTURES: [(Picture, Picture, [u32; 3]); 5] = [
    (Picture::Random, Picture::Random, [0, 1, 2]),
    (Picture::Uncover, Picture::Collide, [1, 0, 3]),
    (Picture::Blocks, Picture::Random, [2, 5, 0]),
    (Picture::Extreme, Picture::Extreme, [1, 1, 0]),
    (Picture::Empty, Picture::Zoom, [4, 0, 1]),
];

/// Wider than a word has bits, margin, and a single cell.
const SHAPES: [GridSize; 4] =
    [grid(33, 6, [1, 0, 0, 1]), grid(12, 9, [0; 4]), grid(7, 5, [2, 1, 3, 0]), grid(1, 1, [0; 4])];

/// Returns all cases.
pub fn cases(seed: u64) -> Result<Vec<Case>, RunError> {
    let bits = Bits::derive(Demand { extent: 64, recog: 8, prop: 8 })?;
    let slide = Bits::derive_without_acceleration(Demand { extent: 128, recog: 4, prop: 16 })?;
    let models = [
        Model::new("few", FEW, bits)?,
        Model::new("few-slide", FEW_SLIDE, slide)?,
        Model::new("few-flat", FEW_FLAT, bits)?,
    ];
    let mut cases = Vec::new();
    for turn in 0..PICTURES.len() {
        for (place, model) in models.iter().enumerate() {
            cases.push(case(model, turn + place, seed)?);
        }
    }
    Ok(cases)
}

fn case(model: &Model, turn: usize, seed: u64) -> Result<Case, RunError> {
    let (shown, rendered, late) = PICTURES[turn % PICTURES.len()];
    let map_size = SHAPES[turn % SHAPES.len()];
    let rounding = Rounding::ALL[turn % Rounding::ALL.len()];
    let frame = [2, u32::MAX, 100][turn % 3];
    let (of, GridSize { width, height, .. }) = (model.name, map_size);
    let name = format!("objects-{of}-{}-{}-{width}x{height}", shown.name(), rendered.name());
    let random = &mut Random::new(seed, &name);
    let record = model.record();
    let mut starts = GridMemory::new(map_size);
    let front = words(shown, record, &map_size, random);
    let mut memory = front.clone();
    let mut map = Galpixmap::over(starts.grid()?, model.format, &mut memory)?;
    let (columns, rows) = size(&map_size);
    let renderings = late
        .into_iter()
        .map(|late| {
            let place = [random.below(columns), random.below(rows)];
            let size = [random.below(columns - place[0]) + 1, random.below(rows - place[1]) + 1];
            let (count, cells) = (record.words(), (size[0] * size[1]) as usize);
            let drawn = words(rendered, record, &grid(size[0], size[1], [0; 4]), random);
            let galpixels: Vec<u32> = (0..cells)
                .flat_map(|cell| (0..count).map(move |word| word * cells + cell))
                .map(|at| drawn[at])
                .collect();
            let (tag, stamp) = (random.below(1 << record.layout().tag_bits), frame.wrapping_sub(late));
            let object = Object { tag, layer: 0, stamp, place, size };
            let grafted = replace(&mut map, &object, galpixels.iter().copied(), rounding, frame).into();
            Rendering { tag, stamp, place, size, galpixels, grafted, map: planes(&map) }
        })
        .collect();
    let setting = model.setting(map_size);
    let objects = Objects { setting, rounding: rounding.name().to_owned(), frame, front, renderings };
    let about = format!("three renderings that show {} enter a map that shows {}", rendered.name(), shown.name());
    Ok(Case { name, about, content: Content::Objects(objects) })
}
