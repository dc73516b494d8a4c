//! Cases of sub-cell scan-out: which there are, what they say, and the core run over their inputs.

use galpix_core::stages::threshold_for_depth;
use galpix_core::{Bits, Colour, Demand, Galpixmap, Layout, sub_cell};
use schemars::JsonSchema;
use serde::Serialize;

use crate::case::{Case, Content, GridSize, Setting};
use crate::choice::{component, grid};
use crate::maps::{Picture, Random, words};
use crate::run::{GridMemory, Model, RunError};

/// A map, and what a display shows of it.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SubCell {
    /// Widths, fields, places, size.
    #[serde(flatten)]
    pub setting: Setting,
    /// The largest difference of depths within a surface, in units of the depth's last bit.
    pub threshold: u32,
    /// The map.
    pub front: Vec<u32>,
    /// A colour word for each cell of the display, row by row.
    pub shown: Vec<u32>,
}

/// Rows longer than any run that an engine may take at once, lines along either side, margins, and a single cell.
const SHAPES: [GridSize; 7] = [
    grid(12, 9, [0; 4]),
    grid(70, 3, [0; 4]),
    grid(7, 5, [2, 1, 3, 0]),
    grid(1, 9, [0; 4]),
    grid(33, 6, [1, 0, 0, 1]),
    grid(13, 1, [0; 4]),
    grid(1, 1, [0; 4]),
];

const PICTURES: [Picture; 5] =
    [Picture::Surfaces, Picture::Random, Picture::Surfaces, Picture::Extreme, Picture::Surfaces];

/// No depth: one surface.
pub const LEVEL: Layout = Layout { colour: Colour::RGB888, velocity: true, acceleration: true, ..Layout::STILL };

/// Offsets of more bits than scan-out weighs by, along a row just one more, before the widest depth.
pub fn finest() -> Result<Bits, RunError> {
    let bits = Bits::derive_without_acceleration(Demand { extent: 64, recog: 8, prop: 8 })?;
    Ok(bits.with_xy(component(9, [4, 8], [0, 0]).checked()?, component(13, [4, 12], [0, 0]).checked()?))
}

/// Offsets of just as many bits as scan-out weighs by, and along a column two more.
fn fine() -> Result<Bits, RunError> {
    let bits = Bits::derive_without_acceleration(Demand { extent: 64, recog: 8, prop: 8 })?;
    Ok(bits.with_xy(component(8, [4, 7], [0, 0]).checked()?, component(10, [4, 9], [0, 0]).checked()?))
}

/// Offsets at the limits, and thresholds about as large as the widest depth and larger.
const LIMITS: [(Picture, Option<u32>, GridSize); 5] = [
    (Picture::Limits, None, grid(33, 6, [1, 0, 0, 1])),
    (Picture::Random, Some(1 << 26), grid(33, 6, [0; 4])),
    (Picture::Limits, Some(0), grid(12, 9, [0; 4])),
    (Picture::Extreme, Some(1 << 28), grid(12, 9, [0; 4])),
    (Picture::Limits, Some(1 << 31), grid(70, 3, [0; 4])),
];

/// Returns all cases, over the layouts of the others and three more.
pub fn cases(seed: u64, models: &[Model]) -> Result<Vec<Case>, RunError> {
    let more = [
        Model::new("finest", Layout { depth_bits: 28, ..Layout::VELOCITY565 }, finest()?)?,
        Model::new("level", LEVEL, Bits::derive(Demand { extent: 64, recog: 8, prop: 8 })?)?,
    ];
    let mut cases = Vec::new();
    for (place, model) in models.iter().chain(&more).enumerate() {
        for (index, picture) in PICTURES.into_iter().enumerate() {
            let turn = place * PICTURES.len() + index;
            let map_size = SHAPES[turn % SHAPES.len()];
            let default = threshold_for_depth(model.depth_bits());
            let threshold = [default, default, 0, default, u32::MAX][(turn + place) % 5];
            cases.push(case(seed, model, (picture, threshold), map_size)?);
        }
    }
    let fine = Model::new("fine", Layout { depth_bits: 28, ..Layout::VELOCITY565 }, fine()?)?;
    for (picture, threshold, map_size) in LIMITS {
        let threshold = threshold.unwrap_or(threshold_for_depth(fine.depth_bits()));
        cases.push(case(seed, &fine, (picture, threshold), map_size)?);
    }
    Ok(cases)
}

fn case(seed: u64, model: &Model, (picture, threshold): (Picture, u32), map_size: GridSize) -> Result<Case, RunError> {
    let GridSize { width, height, .. } = map_size;
    let name = format!("subcell-{}-{}-{width}x{height}", model.name, picture.name());
    let front = words(picture, model.record(), &map_size, &mut Random::new(seed, &name));
    let mut starts = GridMemory::new(map_size);
    let mut memory = front.clone();
    let map = Galpixmap::over(starts.grid()?, model.format, &mut memory)?;
    let shown = (0..height).flat_map(|y| sub_cell::row(&map, threshold, y)).collect();
    let about = format!("what a display shows of a map that shows {}, resampled by the offsets", picture.name());
    let content = Content::SubCell(SubCell { setting: model.setting(map_size), threshold, front, shown });
    Ok(Case { name, about, content })
}
