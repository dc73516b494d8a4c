//! Which cases of inpainting there are: every layout under its budget, with pictures that leave holes.

use galpix_core::inpaint::{Gamma, Inpainting};
use galpix_core::stages::threshold_for_depth;
use galpix_core::{Bits, Colour, Demand, FillMode, Layout, Rounding, Settings};

use crate::case::{Case, GridSize};
use crate::choice::grid;
use crate::maps::{Picture, Random};
use crate::run::{Model, Paint, Plan, RunError};

/// Sides that halve to odd ones, and runs that are wider than what an engine may take at once.
const SHAPES: [GridSize; 7] = [
    grid(16, 13, [2, 3, 0, 4]),
    grid(12, 9, [0; 4]),
    grid(33, 6, [1, 0, 0, 1]),
    grid(7, 5, [2, 1, 3, 0]),
    grid(1, 18, [0; 4]),
    grid(27, 1, [0; 4]),
    grid(5, 22, [0, 4, 1, 0]),
];

/// Pictures after whose frames cells are uncovered, some of them twice: what a case has besides is drawn.
const PICTURES: [Picture; 8] = [
    Picture::Random,
    Picture::Uncover,
    Picture::Random,
    Picture::Blocks,
    Picture::Extreme,
    Picture::Uncover,
    Picture::Tear,
    Picture::Slide,
];

/// A depth wider than push-pull takes: its low bits are dropped.
const DEEP: Layout = Layout { depth_bits: 24, depth_motion: true, ..Layout::VELOCITY_GRAY8 };

/// No depth: nothing is foreground.
const FLAT: Layout = Layout { colour: Colour::RGB888, velocity: true, tag_bits: 5, ..Layout::STILL };

/// Returns all cases over those layouts of the others in which something moves, and over two layouts more.
pub fn cases(seed: u64, models: &[Model]) -> Result<Vec<Case>, RunError> {
    let bits = Bits::derive_without_acceleration(Demand { extent: 1024, recog: 8, prop: 16 })?;
    let more = [Model::new("deep", DEEP, bits)?, Model::new("flat", FLAT, bits)?];
    let mut cases = Vec::new();
    for (place, model) in models.iter().filter(|model| model.name != "still").chain(&more).enumerate() {
        for (index, picture) in PICTURES.into_iter().enumerate() {
            let shape = match picture {
                // The halves end 63 to 66 cells apart where velocities go so far.
                Picture::Tear => [grid(70, 4, [0; 4]), grid(4, 70, [0; 4])][place % 2],
                Picture::Slide => grid(70, 8, [0; 4]),
                _ => SHAPES[(index + place) % SHAPES.len()],
            };
            cases.push(case(seed, model, picture, shape)?);
        }
        // Few levels, so that more often a cell has no sample of its own, but of those beside it.
        for shape in [grid(5, 5, [0; 4]), grid(8, 8, [0; 4])] {
            cases.push(case(seed, model, Picture::Random, shape)?);
        }
        // A map without a level above it.
        cases.push(case(seed, model, Picture::Leave, grid(1, 1, [0; 4]))?);
    }
    Ok(cases)
}

fn case(seed: u64, model: &Model, picture: Picture, grid: GridSize) -> Result<Case, RunError> {
    let name = format!("inpaint-{}-{}-{}x{}", model.name, picture.name(), grid.width, grid.height);
    // The same for every seed, so that each seed has every rule.
    let mut drawn = Random::new(0, &name);
    let mut one_of = |choices: [u32; 6]| choices[drawn.below(6) as usize];
    let default = threshold_for_depth(model.depth_bits());
    let settings = Settings {
        rounding: Rounding::ALL[one_of([0, 1, 2, 2, 3, 3]) as usize],
        fill_mode: FillMode::Extend,
        reach: one_of([1, 1, 1, 2, 2, 3]),
        edge_threshold: one_of([default, default, default, 0, 0, u32::MAX]),
    };
    let constant_time = one_of([0, 0, 0, 1, 1, 1]) == 1;
    let gamma = Gamma::ALL[one_of([0, 0, 1, 1, 2, 2]) as usize];
    let by_default = Inpainting::for_depth(model.depth_bits(), gamma).threshold;
    // The distance between depths of the random map.
    let quarter = 1 << model.depth_bits().saturating_sub(2).min(Inpainting::DEPTH_BITS - 2);
    let paint = Paint {
        gamma,
        threshold: one_of([by_default, by_default, by_default, 0, u32::MAX, quarter]),
        background: picture == Picture::Tear || one_of([0, 0, 1, 1, 1, 1]) == 1,
        motion: one_of([0, 0, 1, 1, 1, 1]) == 1,
        masked_quarters: one_of([0, 0, 0, 0, 3, 4]),
        edges: one_of([0, 1, 1, 1, 1, 1]) == 1,
    };
    let frame = one_of([0, 1, 5, 6, 13, u32::MAX]);
    let plan = Plan { picture, grid, settings, constant_time, frame, frames: 1 };
    let content = model.painted(&plan, &paint, &mut Random::new(seed, &name))?;
    let about = format!("one frame of a map that shows {}, inpainted", picture.name());
    Ok(Case { name, about, content })
}
