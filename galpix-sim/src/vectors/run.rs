//! The core, run over a case's inputs.

use galpix_core::budget::{Bits, Component};
use galpix_core::colour::Colour;
use galpix_core::disocclusion::Reach;
use galpix_core::edge;
use galpix_core::error::{BudgetError, SetupError};
use galpix_core::fill::{Rung, fill};
use galpix_core::frame::{Controller, Inpainting, Scratch, Settings};
use galpix_core::galpixel::{Budget as _, Chosen};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::{Grid, Wings};
use galpix_core::inpaint::levels;
use galpix_core::inpaint::map::OfGalpixel;
use galpix_core::inpaint::paint::{Moving, Tint};
use galpix_core::inpaint::push_pull::Rule;
use galpix_core::inpaint::pyramid::{Cell, Pyramid, state_words};
use galpix_core::layout::Layout;
use galpix_core::propagate::{Arrival, arrivals, clamp_velocity, snap, step_position, step_velocity};
use galpix_core::record::{Record, Scale};
use galpix_core::resolve::settle;
use galpix_core::rounding::Rounding;
use galpix_core::tally::Tally;

use super::case::{
    ArrivalWords, Content, Edge, Fill, FrameAfter, Frames, GridSize, Inpaint, Making, Resolve, Setting, Step,
};
use super::disocclusion::{Shown, uncovered};
use super::hash;
use super::layered::{Hidden, layered};
use super::maps::{Picture, Random, size, words};

/// Why a case could not be made.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// Its budget does not fit its layout.
    #[error("{0}")]
    Budget(#[from] BudgetError),
    /// Its map cannot be laid out.
    #[error("{0}")]
    Setup(#[from] SetupError),
}

/// What is run over a picture.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// What the map shows.
    pub picture: Picture,
    /// Its size.
    pub grid: GridSize,
    /// Rounding, rung, reach, edge threshold.
    pub settings: Settings,
    /// The frame counter of the first map.
    pub frame: u32,
    /// Frames that are made of it.
    pub frames: u32,
}

impl Plan {
    /// How its frames are made. Rungs that know no surfaces look at no edge map.
    pub fn making(&self) -> Making {
        let Settings { rounding, rung, edge_threshold, reach, .. } = self.settings;
        Making {
            rounding: rounding.name().to_owned(),
            rung: rung.name().to_owned(),
            reach,
            threshold: if rung >= Rung::Bullet { edge_threshold } else { 0 },
            frame: self.frame,
        }
    }
}

/// How a frame is painted.
#[derive(Clone, Copy, Debug)]
pub struct Paint {
    /// Validity, and what foreground is.
    pub rule: Rule,
    /// The depth of the background first.
    pub background: bool,
    /// Motion and not colour alone.
    pub motion: bool,
    /// Parts of the map that a random mask covers, of 4; 0 for no mask.
    pub masked_quarters: u32,
    /// Whether the frame has an edge map.
    pub edges: bool,
}

/// Frames of some layers.
type RunLayers = fn(Bits, &Plan, &[Hidden], &mut Random) -> Result<Content, RunError>;

/// The disocclusion map of a picture.
type RunUncovered = fn(Bits, GridSize, Shown, &Reach, &mut Random) -> Result<Content, RunError>;

/// A layout under a budget, and what can be run with it.
#[derive(Clone, Copy)]
pub struct Model {
    /// Its part of a case's name.
    pub name: &'static str,
    /// Bits of the depth field.
    pub depth_bits: u32,
    bits: Bits,
    stages: fn(Bits, &Plan, &mut Random) -> Result<[Content; 3], RunError>,
    frames: fn(Bits, &Plan, &mut Random) -> Result<Content, RunError>,
    painted: fn(Bits, &Plan, &Paint, &mut Random) -> Result<Content, RunError>,
    /// With one to three layers beside the base.
    layered: [RunLayers; 3],
    uncovered: RunUncovered,
}

impl Model {
    /// A layout under a budget.
    pub fn of<L: Layout>(name: &'static str, bits: Bits) -> Result<Self, RunError> {
        let depth_bits = Chosen::<L>::new(bits)?.record().depth().bits.into();
        Ok(Self {
            name,
            depth_bits,
            bits,
            stages: stages::<L>,
            frames: frames::<L>,
            painted: painted::<L>,
            layered: [layered::<L, 1>, layered::<L, 2>, layered::<L, 3>],
            uncovered: uncovered::<L>,
        })
    }

    /// Resolve, edge and fill of one frame.
    pub fn stages(&self, plan: &Plan, random: &mut Random) -> Result<[Content; 3], RunError> {
        (self.stages)(self.bits, plan, random)
    }

    /// Whole frames.
    pub fn frames(&self, plan: &Plan, random: &mut Random) -> Result<Content, RunError> {
        (self.frames)(self.bits, plan, random)
    }

    /// One frame, and what is painted after it.
    pub fn painted(&self, plan: &Plan, paint: &Paint, random: &mut Random) -> Result<Content, RunError> {
        (self.painted)(self.bits, plan, paint, random)
    }

    /// Frames of a base and one to three layers beside it.
    pub fn layered(&self, plan: &Plan, hidden: &[Hidden], random: &mut Random) -> Result<Content, RunError> {
        self.layered[hidden.len() - 1](self.bits, plan, hidden, random)
    }

    /// What a map may uncover.
    pub fn uncovered(
        &self,
        map_size: GridSize,
        shown: Shown,
        reach: &Reach,
        random: &mut Random,
    ) -> Result<Content, RunError> {
        (self.uncovered)(self.bits, map_size, shown, reach, random)
    }
}

/// The step kernel over some states of a component.
pub fn step(component: Component, rounding: Rounding, steps: Vec<(u32, i32, i32, i32)>) -> Content {
    let scale = Scale::new(component, component.position_frac);
    let result = |&(frame, r, v, a): &(u32, i32, i32, i32)| {
        let position = step_position(&scale, rounding.threshold(frame, scale.down), r, v, a);
        let cells = snap(&scale, position);
        let raised = step_velocity(&scale, v, a);
        let velocity = if component.has_acceleration() { clamp_velocity(&scale, raised) } else { v };
        (position, cells, position - (cells << scale.position_frac), velocity, u32::from(velocity != raised))
    };
    let results = steps.iter().map(result).collect();
    Content::Step(Step { component: component.into(), rounding: rounding.name().to_owned(), steps, results })
}

/// Memory for a map and what belongs to it.
pub struct Lent {
    starts: Vec<u32>,
    grid: GridSize,
}

impl Lent {
    /// For a map of this size.
    pub fn new(grid: GridSize) -> Self {
        Self { starts: vec![0; size(&grid).1 as usize], grid }
    }

    /// The map's grid.
    pub fn grid(&mut self) -> Result<Grid<'_>, SetupError> {
        let GridSize { width, height, left, right, top, bottom } = self.grid;
        Grid::new(width, height, Wings { left, right, top, bottom }, &mut self.starts)
    }
}

/// All planes of a map, one after the other.
pub fn planes<L: Layout>(map: &Galpixmap<'_, L, Chosen<L>>) -> Vec<u32> {
    (0..).map_while(|word| map.plane(word)).flatten().copied().collect()
}

/// What all cases over a map have.
pub fn setting<L: Layout>(bits: Bits, record: &Record, grid: GridSize) -> Setting {
    let colour = match L::Colour::BITS {
        24 => "rgb888",
        16 => "rgb565",
        8 => "gray8",
        _ => "gray4",
    };
    Setting::of::<L>(bits, record, colour, grid)
}

fn stages<L: Layout>(bits: Bits, plan: &Plan, random: &mut Random) -> Result<[Content; 3], RunError> {
    let budget = Chosen::<L>::new(bits)?;
    let record = *budget.record();
    let mut lent = Lent::new(plan.grid);
    let grid = lent.grid()?;
    let front_words = words(plan.picture, &record, &plan.grid, random);
    let (mut front, mut back) = (front_words.clone(), vec![0; front_words.len()]);
    let front = Galpixmap::<L, _>::over(grid, budget, &mut front)?;
    let mut back = Galpixmap::<L, _>::new(grid, budget, &mut back)?;
    let Settings { rounding, rung, edge_threshold, reach, .. } = plan.settings;

    let mut edges = vec![0; edge::words(&grid)];
    let marked = edge::mark(&front, edge_threshold, &mut edges);
    let mut arrived: Vec<Arrival> = arrivals(&front, rounding, plan.frame).collect();
    for end in (1..arrived.len()).rev() {
        arrived.swap(end, random.below(end as u32 + 1) as usize);
    }
    let mut winners = vec![0; grid.cells() as usize];
    let settled = settle(arrived.iter().copied(), &mut back, &mut winners);
    let setting = setting::<L>(bits, &record, plan.grid);
    let resolve = Resolve {
        setting: setting.clone(),
        arrivals: arrived
            .iter()
            .map(|arrival| ArrivalWords {
                source: arrival.source,
                cell: arrival.cell,
                words: arrival.words[..record.words()].to_vec(),
            })
            .collect(),
        map: planes(&back),
        winners: winners.clone(),
        // Fields saturate on the way, not when they settle.
        counts: Tally { saturated: 0, ..settled }.into(),
    };
    let edge = Edge {
        setting: setting.clone(),
        threshold: edge_threshold,
        front: front_words.clone(),
        edges: edges.clone(),
        counts: Tally { edges: marked, ..Tally::default() }.into(),
    };
    let (resolved, before) = (planes(&back), winners.clone());
    let mut tally = Tally::default();
    fill(&front, &mut back, &mut winners, &edges, rung, reach, &mut tally);
    let fill = Fill {
        setting,
        rung: rung.name().to_owned(),
        reach,
        edges,
        front: front_words,
        resolved,
        winners: before,
        map: planes(&back),
        winners_after: winners,
        counts: tally.into(),
    };
    Ok([Content::Resolve(resolve), Content::Edge(edge), Content::Fill(fill)])
}

fn frames<L: Layout>(bits: Bits, plan: &Plan, random: &mut Random) -> Result<Content, RunError> {
    let budget = Chosen::<L>::new(bits)?;
    let record = *budget.record();
    let mut lent = Lent::new(plan.grid);
    let grid = lent.grid()?;
    let front_words = words(plan.picture, &record, &plan.grid, random);
    let (mut front, mut back) = (front_words.clone(), vec![0; front_words.len()]);
    let (mut winners, mut edges) = (vec![0; grid.cells() as usize], vec![0; edge::words(&grid)]);
    let mut controller = Controller::new(
        Galpixmap::<L, _>::over(grid, budget, &mut front)?,
        Galpixmap::new(grid, budget, &mut back)?,
        Scratch { winners: &mut winners, edges: &mut edges },
    )?;
    controller.set_frame(plan.frame);
    let frames = (0..plan.frames)
        .map(|_| {
            let counts = controller.step(&plan.settings).into();
            let map = planes(controller.front());
            FrameAfter { sha256: hash::frame(&map), counts, map }
        })
        .collect();
    Ok(Content::Frame(Frames {
        setting: setting::<L>(bits, &record, plan.grid),
        making: plan.making(),
        front: front_words,
        frames,
    }))
}

fn painted<L: Layout>(bits: Bits, plan: &Plan, paint: &Paint, random: &mut Random) -> Result<Content, RunError> {
    let budget = Chosen::<L>::new(bits)?;
    let record = *budget.record();
    let mut lent = Lent::new(plan.grid);
    let grid = lent.grid()?;
    let front_words = words(plan.picture, &record, &plan.grid, random);
    let (mut front, mut back) = (front_words.clone(), vec![0; front_words.len()]);
    let mut winners = vec![0; grid.cells() as usize];
    let mut edges = vec![0; if paint.edges { edge::words(&grid) } else { 0 }];
    // A mask ends where it likes: the cells beyond are not in it.
    let mask: Vec<u32> = match paint.masked_quarters {
        0 => Vec::new(),
        quarters => {
            let length = (edge::words(&grid) * quarters as usize).div_ceil(4);
            (0..length).map(|_| random.next() as u32 | random.next() as u32).collect()
        }
    };
    let mut controller = Controller::new(
        Galpixmap::<L, _>::over(grid, budget, &mut front)?,
        Galpixmap::new(grid, budget, &mut back)?,
        Scratch { winners: &mut winners, edges: &mut edges },
    )?;
    controller.set_frame(plan.frame);
    controller.step(&plan.settings);
    let after = planes(controller.front());
    let edges = controller.edges().to_vec();
    let inpainting = Inpainting { rule: paint.rule, quads: paint.background, mask: &mask };
    if paint.motion {
        inpaint::<L, Moving>(&mut controller, &plan.settings, &inpainting)?;
    } else {
        inpaint::<L, Tint>(&mut controller, &plan.settings, &inpainting)?;
    }
    let map = planes(controller.front());
    let Settings { rounding, edge_threshold, reach, .. } = plan.settings;
    Ok(Content::Inpaint(Inpaint {
        setting: setting::<L>(bits, &record, plan.grid),
        rounding: rounding.name().to_owned(),
        reach,
        threshold: edge_threshold,
        frame: plan.frame,
        gamma: paint.rule.gamma.name().to_owned(),
        inpaint_threshold: paint.rule.threshold,
        motion: paint.motion,
        background: paint.background,
        mask,
        front: front_words,
        edges,
        after,
        map,
    }))
}

fn inpaint<L: Layout, V: OfGalpixel<L>>(
    controller: &mut Controller<'_, L, Chosen<L>>,
    settings: &Settings,
    inpainting: &Inpainting<'_>,
) -> Result<(), SetupError> {
    let (columns, rows) = (controller.front().grid().width(), controller.front().grid().height());
    let mut cells = vec![Cell::default(); levels::cells(columns, rows)];
    let mut states = vec![0; state_words(cells.len())];
    controller.inpaint(settings, inpainting, &mut Pyramid::<V>::new(columns, rows, &mut cells, &mut states)?);
    Ok(())
}
