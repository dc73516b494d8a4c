//! Which cases there are: budgets, roundings, fill modes, pictures and shapes, so chosen that every rule of the
//! specification is used by one of them.

use galpix_core::record::Component;
use galpix_core::stages::threshold_for_depth;
use galpix_core::{Bits, BudgetError, Colour, Demand, FillMode, Layout, Rounding, Settings};

use crate::case::{Case, Content, GridSize};
use crate::maps::{Picture, Random};
use crate::run::{self, Model, Plan, RunError};
use crate::{disocclusion, inpaint, layers, objects, source, sub_cell};

/// Frames of a frame case.
const FRAMES: u32 = 5;

/// Steps that are drawn for a wide component.
const STEPS: u32 = 600;

pub const fn grid(width: u32, height: u32, margin: [u32; 4]) -> GridSize {
    let [left, right, top, bottom] = margin;
    GridSize { width, height, left, right, top, bottom }
}

/// The last one is wider than any run or chunk that an engine may take at once.
const SHAPES: [GridSize; 9] = [
    grid(12, 9, [0; 4]),
    grid(7, 5, [2, 1, 3, 0]),
    grid(1, 1, [0; 4]),
    grid(16, 12, [0; 4]),
    grid(1, 9, [0; 4]),
    grid(13, 1, [0; 4]),
    grid(5, 5, [0, 4, 0, 4]),
    grid(33, 6, [1, 0, 0, 1]),
    grid(70, 4, [0; 4]),
];

pub const fn component(position_frac: u32, velocity: [u32; 2], acceleration: [u32; 2]) -> Component {
    Component {
        position_frac,
        velocity_int: velocity[0],
        velocity_frac: velocity[1],
        acceleration_int: acceleration[0],
        acceleration_frac: acceleration[1],
    }
}

/// Components that differ: a position finer than its step, an acceleration coarser than its velocity, none dropped.
fn uneven() -> Result<Bits, BudgetError> {
    let bits = Bits::derive(Demand { extent: 64, recog: 8, prop: 8 })?;
    Ok(bits
        .with_xy(component(7, [6, 4], [4, 2]).checked()?, component(3, [6, 5], [4, 3]).checked()?)
        .with_z(component(2, [4, 9], [3, 9]).checked()?, 6))
}

/// Returns a position without a fraction along a row, and one exactly as fine as its step along a column.
fn coarse() -> Result<Bits, BudgetError> {
    let bits = Bits::derive(Demand { extent: 64, recog: 8, prop: 8 })?;
    Ok(bits.with_xy(component(0, [5, 3], [3, 3]).checked()?, component(4, [5, 3], [3, 3]).checked()?))
}

/// Shading inertia where one channel is wider than the others.
const BRIGHT565: Layout = Layout { colour: Colour::RGB565, luminosity: true, tag_bits: 3, ..Layout::FULL };

/// Layouts and budgets: between them every field, every colour format, packing with and without fields that straddle
/// words.
pub fn models() -> Result<Vec<Model>, RunError> {
    let demand = |extent, recog, prop| Demand { extent, recog, prop };
    Ok(vec![
        Model::new("paper", Layout::FULL, Bits::derive(demand(1024, 8, 16))?)?,
        Model::new("shaded", Layout::SHADED, Bits::derive(demand(200, 7, 11))?)?,
        Model::new("uneven", Layout::SHADED, uneven()?)?,
        Model::new("flat565", Layout::FLAT565, Bits::derive(demand(256, 8, 32))?)?,
        Model::new("velocity565", Layout::VELOCITY565, Bits::derive_without_acceleration(demand(320, 8, 16))?)?,
        Model::new("gray8", Layout::VELOCITY_GRAY8, Bits::derive_without_acceleration(demand(128, 4, 64))?)?,
        Model::new("gray4", Layout::VELOCITY_GRAY4, Bits::derive_without_acceleration(demand(128, 8, 16))?)?,
        Model::new("coarse", Layout::FLAT565, coarse()?)?,
        Model::new("straddle", Layout::FULL, Bits::derive(demand(200, 4, 32))?)?,
        Model::new("bright565", BRIGHT565, Bits::derive(demand(128, 4, 32))?)?,
        Model::new("still", Layout::STILL, Bits::derive(demand(16, 4, 4))?)?,
    ])
}

/// Returns all cases of a seed, in order.
///
/// *Errors:* none that the choice below runs into; they are passed on all the same.
pub fn cases(seed: u64) -> Result<Vec<Case>, RunError> {
    let mut cases = steps(seed)?;
    let models = models()?;
    for (turn, model) in models.iter().enumerate() {
        for (index, picture) in Picture::ALL.into_iter().enumerate() {
            // Coprime strides: over models and pictures every fill mode meets every rounding, shape and reach.
            let turn = turn * Picture::ALL.len() + index;
            let settings = Settings {
                rounding: Rounding::ALL[turn % Rounding::ALL.len()],
                fill_mode: FillMode::ALL[(turn * 5 + turn / 6) % FillMode::ALL.len()],
                reach: [1, 3, 2, 0, 17][turn / 3 % 5],
                edge_threshold: [threshold_for_depth(model.depth_bits()), 0, u32::MAX][turn / 4 % 3],
            };
            let plan = Plan {
                picture,
                grid: SHAPES[(turn * 2 + turn / 9) % SHAPES.len()],
                settings,
                constant_time: false,
                frame: [0, u32::MAX - 2, 5][turn % 3],
                frames: FRAMES,
            };
            frame_case(&mut cases, seed, model, &plan)?;
            // The shapes in which holes have neighbours on all sides, with the richest fill mode.
            if matches!(
                picture,
                Picture::Random
                    | Picture::Zoom
                    | Picture::Quarters
                    | Picture::Blocks
                    | Picture::Uncover
                    | Picture::Curtain
            ) {
                let reach = 1 + index as u32 % 3;
                let edge_threshold = threshold_for_depth(model.depth_bits());
                let settings = Settings { fill_mode: FillMode::Extend, reach, edge_threshold, ..settings };
                frame_case(&mut cases, seed, model, &Plan { grid: SHAPES[3], settings, ..plan })?;
            }
        }
        stage_cases(&mut cases, seed, model)?;
        threshold_cases(&mut cases, seed, model)?;
    }
    cases.extend(inpaint::cases(seed, &models)?);
    cases.extend(layers::cases(seed, &models)?);
    cases.extend(objects::cases(seed)?);
    cases.extend(disocclusion::cases(seed, &models)?);
    cases.extend(sub_cell::cases(seed, &models)?);
    cases.extend(source::cases(seed, &models)?);
    propagate_cases(&mut cases, seed, &models);
    varied_cases(&mut cases, seed, &models)?;
    display_cases(&mut cases, seed, &models)?;
    Ok(cases)
}

/// The step of whole galpixels, which is what a lane in logic computes.
fn propagate_cases(cases: &mut Vec<Case>, seed: u64, models: &[Model]) {
    for model in models {
        for rounding in Rounding::ALL {
            let name = format!("propagate-{}-{}", model.name, rounding.name());
            let content = model.propagate(rounding, &mut Random::new(seed, &name));
            cases.push(Case { name, about: "the step of single galpixels".to_owned(), content });
        }
    }
}

/// Bullets between galpixels no two of whose fields are the same, alone and in whole frames: what the mean of each
/// field is.
fn varied_cases(cases: &mut Vec<Case>, seed: u64, models: &[Model]) -> Result<(), RunError> {
    for (index, model) in models.iter().enumerate() {
        let rounding = Rounding::ALL[index % Rounding::ALL.len()];
        let edge_threshold = threshold_for_depth(model.depth_bits());
        let settings = Settings { rounding, fill_mode: FillMode::Extend, reach: 2, edge_threshold };
        let plan =
            Plan { picture: Picture::Varied, grid: SHAPES[3], settings, constant_time: false, frame: 1, frames: 3 };
        frame_case(cases, seed, model, &plan)?;
        let suffix = format!("{}-{}", model.name, Picture::Varied.name());
        let plan = Plan { frames: 1, ..plan };
        let [.., content] = model.stages(&plan, &mut Random::new(seed, &suffix))?;
        let about = "one frame of a map all of whose fields differ from cell to cell: fill alone".to_owned();
        cases.push(Case { name: format!("fill-{suffix}"), about, content });
    }
    Ok(())
}

/// A map as wide as a display, for line buffers and counters of columns, and a test pattern on a panel.
fn display_cases(cases: &mut Vec<Case>, seed: u64, models: &[Model]) -> Result<(), RunError> {
    let Some(model) = models.iter().find(|model| model.name == "velocity565") else { return Ok(()) };
    let settings = Settings {
        rounding: Rounding::Searched,
        fill_mode: FillMode::Extend,
        reach: 1,
        edge_threshold: threshold_for_depth(model.depth_bits()),
    };
    let grid = grid(1024, 8, [0; 4]);
    let plan = Plan { picture: Picture::Uncover, grid, settings, constant_time: false, frame: 0, frames: 2 };
    frame_case(cases, seed, model, &plan)?;
    // What `firmware/rtl/src/galpix_panel.sv` shows.
    let grid = self::grid(60, 46, [2, 2, 1, 1]);
    frame_case(cases, seed, model, &Plan { picture: Picture::Pattern, grid, frames: 4, ..plan })
}

fn frame_case(cases: &mut Vec<Case>, seed: u64, model: &Model, plan: &Plan) -> Result<(), RunError> {
    let Settings { rounding, fill_mode, reach, .. } = plan.settings;
    let grid = plan.grid;
    let name = format!(
        "frame-{}-{}-{}-{}-{}x{}-{reach}",
        model.name,
        plan.picture.name(),
        rounding.name(),
        fill_mode.name(),
        grid.width,
        grid.height
    );
    if cases.iter().any(|case| case.name == name) {
        return Ok(());
    }
    let content = model.frames(plan, &mut Random::new(seed, &name))?;
    let about = format!("{} frames of a map that shows {}, from the first map on", plan.frames, plan.picture.name());
    cases.push(Case { name, about, content });
    Ok(())
}

/// Resolve, edge and fill, apart, over the pictures in which they have most to do.
fn stage_cases(cases: &mut Vec<Case>, seed: u64, model: &Model) -> Result<(), RunError> {
    let pictures = [
        (Picture::Random, FillMode::Extend, 1),
        (Picture::Zoom, FillMode::Bullet, 2),
        (Picture::Quarters, FillMode::Galdebris, 1),
        (Picture::Uncover, FillMode::Extend, 1),
        (Picture::Collide, FillMode::Debris, 1),
    ];
    for (index, (picture, fill_mode, reach)) in pictures.into_iter().enumerate() {
        let rounding = Rounding::ALL[index % Rounding::ALL.len()];
        let settings = Settings { rounding, fill_mode, reach, ..Settings::for_depth(model.depth_bits()) };
        let grid = SHAPES[if index == 1 { 7 } else { 0 }];
        let plan = Plan { picture, grid, settings, constant_time: false, frame: 3, frames: 1 };
        let suffix = format!("{}-{}", model.name, picture.name());
        let contents = model.stages(&plan, &mut Random::new(seed, &suffix))?;
        for (kind, content) in ["resolve", "edge", "fill"].into_iter().zip(contents) {
            let about = format!("one frame of a map that shows {}: {kind} alone", picture.name());
            cases.push(Case { name: format!("{kind}-{suffix}"), about, content });
        }
    }
    Ok(())
}

/// Edge maps with the least and the greatest threshold: what is an edge by its class alone, and what by any bend.
fn threshold_cases(cases: &mut Vec<Case>, seed: u64, model: &Model) -> Result<(), RunError> {
    for (word, edge_threshold) in [("any-bend", 0), ("class-alone", u32::MAX)] {
        let settings = Settings { edge_threshold, ..Settings::for_depth(model.depth_bits()) };
        let (picture, grid) = (Picture::Random, SHAPES[3]);
        let plan = Plan { picture, grid, settings, constant_time: false, frame: 0, frames: 1 };
        let name = format!("edge-{}-{word}", model.name);
        let [_, content, _] = model.stages(&plan, &mut Random::new(seed, &name))?;
        let about = format!("the edge map of a random map with the threshold {edge_threshold}");
        cases.push(Case { name, about, content });
    }
    Ok(())
}

/// Returns the cases of the step kernel: all states of a tiny component, and ends, neighbours of ends and random states
/// of wide ones.
fn steps(seed: u64) -> Result<Vec<Case>, RunError> {
    let paper = Component::derive(Demand { extent: 1024, recog: 8, prop: 16 })?;
    let components = [
        ("tiny", component(1, [2, 2], [2, 1])),
        ("paper", paper),
        ("slide", Component::derive_without_acceleration(Demand { extent: 320, recog: 8, prop: 16 })?),
        ("long", Component::derive(Demand { extent: 512, recog: 8, prop: 64 })?),
        ("fine", component(7, [6, 4], [4, 2])),
        ("widest", component(16, [14, 16], [14, 16])),
    ];
    let mut cases = Vec::new();
    for (name, component) in components {
        let component = component.checked()?;
        for rounding in Rounding::ALL {
            let name = format!("step-{name}-{}", rounding.name());
            let states = if name.contains("tiny") {
                every_state(component)
            } else {
                let mut random = Random::new(seed, &name);
                some_states(component, &mut random)
            };
            let content: Content = run::step(component, rounding, states);
            cases.push(Case { name, about: "the step kernel of one component".to_owned(), content });
        }
    }
    for down in 1..=8 {
        let component = component(4, [4, 3 + down], [2, 3 + down]).checked()?;
        for rounding in [Rounding::LowDiscrepancy, Rounding::Searched] {
            let content = run::step(component, rounding, around_thresholds(component, rounding, down));
            let name = format!("step-thresholds-{down}-{}", rounding.name());
            let about =
                format!("each threshold of {down} dropped bits, by steps that just miss and just reach the next one");
            cases.push(Case { name, about, content });
        }
    }
    Ok(cases)
}

/// For every frame of a period, steps `2v + a` whose dropped bits are just below and just at what the threshold lifts
/// over.
fn around_thresholds(component: Component, rounding: Rounding, down: u32) -> Vec<(u32, i32, i32, i32)> {
    debug_assert!(component.acceleration_frac == component.velocity_frac);
    let period = 1u32 << down;
    let frames = (0..period).map(|n| if n % 2 == 0 { n } else { n.wrapping_sub(period) });
    let steps = frames.flat_map(|frame| {
        let lifted = (period as i32) - rounding.threshold(frame, down);
        [lifted - 1, lifted, 0, period as i32 - 1].map(|step| (frame, 0, step >> 1, step & 1))
    });
    steps.collect()
}

/// Returns the bits of position, velocity and acceleration.
fn widths(component: Component) -> [u32; 3] {
    [component.position_frac, component.velocity_bits(), component.acceleration_bits()]
}

fn every_state(component: Component) -> Vec<(u32, i32, i32, i32)> {
    let all = |bits: u32| if bits == 0 { 0..1 } else { -(1 << (bits - 1))..1 << (bits - 1) };
    let [r_bits, v_bits, a_bits] = widths(component);
    let states = all(r_bits).flat_map(|r| all(v_bits).flat_map(move |v| all(a_bits).map(move |a| (r, v, a))));
    states.flat_map(|(r, v, a)| [0, 1, u32::MAX - 1].map(|frame| (frame, r, v, a))).collect()
}

fn some_states(component: Component, random: &mut Random) -> Vec<(u32, i32, i32, i32)> {
    let ends = |bits: u32| match bits {
        0 => vec![0],
        _ => vec![-(1 << (bits - 1)), -1, 0, 1.min((1 << (bits - 1)) - 1), ((1i64 << (bits - 1)) - 1) as i32],
    };
    let [r, v, a] = widths(component);
    let mut states = Vec::new();
    for r in ends(r) {
        for v in ends(v) {
            for a in ends(a) {
                states.push((random.below(64), r, v, a));
            }
        }
    }
    states.extend((0..STEPS).map(|_| (random.next() as u32, random.signed(r), random.signed(v), random.signed(a))));
    states
}
