//! Which cases of layers there are: every layout under its budget, with one to three hidden layers.

use galpix_core::stages::threshold_for_depth;
use galpix_core::{FillMode, Rounding, Settings};

use crate::case::{Case, GridSize};
use crate::choice::grid;
use crate::layered::Hidden;
use crate::maps::{Picture, Random};
use crate::run::{Model, Plan, RunError};

/// A word of flags and its neighbours; margin.
const SHAPES: [GridSize; 5] = [
    grid(16, 12, [0; 4]),
    grid(7, 5, [2, 1, 3, 0]),
    grid(33, 6, [1, 0, 0, 1]),
    grid(1, 1, [0; 4]),
    grid(12, 9, [0; 4]),
];

/// A moving layer with all its memory; the others lack some of it, or are stationary.
const KINDS: [[bool; 3]; 5] =
    [[false, true, true], [true, true, false], [false, true, false], [true, false, false], [false, false, true]];

/// What the base and up to three layers show.
const PICTURES: [[Picture; 4]; 6] = [
    [Picture::Uncover, Picture::Random, Picture::Zoom, Picture::Random],
    [Picture::Random, Picture::Random, Picture::Random, Picture::Collide],
    [Picture::Zoom, Picture::Uncover, Picture::Random, Picture::Empty],
    [Picture::Quarters, Picture::Collide, Picture::Quarters, Picture::Random],
    [Picture::Blocks, Picture::Extreme, Picture::Uncover, Picture::Still],
    [Picture::Empty, Picture::Blocks, Picture::Random, Picture::Extreme],
];

/// Returns all cases over the layouts of the others.
pub fn cases(seed: u64, models: &[Model]) -> Result<Vec<Case>, RunError> {
    let mut cases = Vec::new();
    for (place, model) in models.iter().enumerate() {
        for (index, pictures) in PICTURES.into_iter().enumerate() {
            // Coprime to the numbers of fill modes and roundings, so that all of them meet.
            let turn = place * PICTURES.len() + index;
            let hidden: Vec<Hidden> = (0..1 + turn % 3)
                .map(|layer| {
                    let [stationary, winners, edges] = KINDS[(turn + 2 * layer) % KINDS.len()];
                    Hidden { picture: pictures[layer + 1], stationary, winners, edges }
                })
                .collect();
            let settings = Settings {
                rounding: Rounding::ALL[turn % Rounding::ALL.len()],
                // The richest fill mode in every other case.
                fill_mode: match turn % 2 {
                    0 => FillMode::Extend,
                    _ => FillMode::ALL[turn / 2 % FillMode::ALL.len()],
                },
                reach: [1, 2, 3][turn / 2 % 3],
                edge_threshold: [threshold_for_depth(model.depth_bits()), u32::MAX][turn / 3 % 2],
            };
            let grid = SHAPES[turn % SHAPES.len()];
            let plan = Plan {
                picture: pictures[0],
                grid,
                settings,
                constant_time: turn / 5 % 2 == 1,
                frame: [0, u32::MAX][turn % 2],
                frames: 3,
            };
            let (of, size) = (model.name, format!("{}x{}", grid.width, grid.height));
            let name = format!("layers-{of}-{}-{}-{size}", pictures[0].name(), hidden.len());
            let content = model.layered(&plan, &hidden, &mut Random::new(seed, &name))?;
            let about = format!("{} frames of a base and {} further layers", plan.frames, hidden.len());
            cases.push(Case { name, about, content });
        }
    }
    Ok(cases)
}
