//! The core, run over a case's inputs.

use galpix_core::inpaint::{Gamma, Inpainting, Motion, PushPull};
use galpix_core::record::{Component, Scale};
use galpix_core::stages::{self, clamp_velocity, snap, step_position, step_velocity};
use galpix_core::{
    Bits, BudgetError, Controller, Dynamic, Format, Galpixmap, Grid, Layout, Margin, Record, Rounding, Scratch,
    Settings, SetupError, Tally,
};

use crate::arrivals::{Arrival, arrivals, moved, resolve};
use crate::case::{
    ArrivalWords, Content, Edge, Fill, FrameAfter, Frames, GridSize, Inpaint, Making, Moved, Propagate, Resolve,
    Setting, Stages, Stamped, Step,
};
use crate::hash;
use crate::maps::{Picture, Random, each_field, extreme_field, random_field, size, words};

/// Galpixels of a `propagate` case.
const GALPIXELS: u32 = 80;

/// Why a case could not be made.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// Its layout cannot be stored under its budget.
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
    /// Rounding, fill mode, reach, edge threshold.
    pub settings: Settings,
    /// Whether frames are made by instructions that do not depend on the picture.
    pub constant_time: bool,
    /// The frame counter of the first map.
    pub frame: u32,
    /// Frames that are made of it.
    pub frames: u32,
}

impl Plan {
    /// Describes how frames are made. Fill modes that know no surfaces look at no edge map.
    pub fn making(&self) -> Making {
        let Settings { rounding, fill_mode, edge_threshold, reach } = self.settings;
        Making {
            rounding: rounding.name().to_owned(),
            fill_mode: fill_mode.name().to_owned(),
            reach,
            threshold: if fill_mode.uses_edges() { edge_threshold } else { 0 },
            frame: self.frame,
        }
    }
}

/// How a frame is painted.
#[derive(Clone, Copy, Debug)]
pub struct Paint {
    /// The power of the validity.
    pub gamma: Gamma,
    /// How much nearer than the background foreground is at least.
    pub threshold: u32,
    /// The depth of the background first.
    pub background: bool,
    /// Motion and not colour alone.
    pub motion: bool,
    /// Parts of the map that a random mask covers, of 4; 0 for no mask.
    pub masked_quarters: u32,
    /// Whether the frame has an edge map.
    pub edges: bool,
}

/// A layout under a budget, and what can be run with it.
#[derive(Clone, Copy)]
pub struct Model {
    /// Its part of a case's name.
    pub name: &'static str,
    /// The form of its galpixels.
    pub format: Dynamic,
    bits: Bits,
}

impl Model {
    /// Plans the form of a layout under a budget.
    pub fn new(name: &'static str, layout: Layout, bits: Bits) -> Result<Self, RunError> {
        Ok(Self { name, format: Dynamic::new(bits, layout)?, bits })
    }

    /// Returns where its fields are.
    pub fn record(&self) -> &Record {
        self.format.record()
    }

    /// Returns the bits of its depth field.
    pub fn depth_bits(&self) -> u32 {
        self.record().depth().bits.into()
    }

    /// Returns what all cases over a map have.
    pub fn setting(&self, grid: GridSize) -> Setting {
        Setting::of(self.bits, self.record(), grid)
    }

    /// Runs resolve, edge and fill of one frame.
    pub fn stages(&self, plan: &Plan, random: &mut Random) -> Result<[Content; 3], RunError> {
        let mut starts = GridMemory::new(plan.grid);
        let grid = starts.grid()?;
        let front_words = words(plan.picture, self.record(), &plan.grid, random);
        let (mut front, mut back) = (front_words.clone(), vec![0; front_words.len()]);
        let front = Galpixmap::over(grid, self.format, &mut front)?;
        let mut back = Galpixmap::new(grid, self.format, &mut back)?;
        let Settings { rounding, fill_mode, edge_threshold, reach } = plan.settings;

        let mut edges = vec![0; stages::words(&grid)];
        let marked = stages::mark(&front, edge_threshold, &mut edges);
        let mut arrived = arrivals(&front, rounding, plan.frame);
        for end in (1..arrived.len()).rev() {
            arrived.swap(end, random.below(end as u32 + 1) as usize);
        }
        let mut winners = vec![0; grid.cells() as usize];
        let resolved = resolve(arrived.iter().copied(), &mut back, &mut winners);
        let setting = self.setting(plan.grid);
        let arrival_words = |&Arrival { source, cell, words, .. }: &Arrival| {
            let words = words[..self.record().words()].to_vec();
            ArrivalWords { source, cell, words }
        };
        let resolve = Resolve {
            setting: setting.clone(),
            arrivals: arrived.iter().map(arrival_words).collect(),
            map: planes(&back),
            winners: winners.clone(),
            // Fields saturate in the step, not in the resolution.
            counts: Tally { saturated: 0, ..resolved }.into(),
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
        let mut scratch = Scratch { winners: &mut winners, edges: &mut edges };
        stages::fill(&front, &mut back, &mut scratch, &plan.settings, &mut tally);
        let fill = Fill {
            setting,
            fill_mode: fill_mode.name().to_owned(),
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

    /// Makes whole frames.
    pub fn frames(&self, plan: &Plan, random: &mut Random) -> Result<Content, RunError> {
        let mut starts = GridMemory::new(plan.grid);
        let grid = starts.grid()?;
        let front = words(plan.picture, self.record(), &plan.grid, random);
        let mut memory = Memory::new(&front, &grid, true);
        let mut controller = memory.controller(grid, self.format)?;
        controller.set_frame(plan.frame);
        let (mut frames, mut before) = (Vec::new(), front.clone());
        for n in 0..plan.frames {
            let stages = self.stages_of(plan, &before, plan.frame.wrapping_add(n))?;
            let counts = controller.step(&plan.settings).into();
            let map = planes(controller.front());
            before.clone_from(&map);
            frames.push(FrameAfter { sha256: hash::frame(&map), counts, map, stages });
        }
        Ok(Content::Frame(Frames { setting: self.setting(plan.grid), making: plan.making(), front, frames }))
    }

    /// Returns what the stages of a frame give for the map before it.
    fn stages_of(&self, plan: &Plan, before: &[u32], frame: u32) -> Result<Stages, RunError> {
        let mut starts = GridMemory::new(plan.grid);
        let grid = starts.grid()?;
        let (mut front, mut back) = (before.to_vec(), vec![0; before.len()]);
        let front = Galpixmap::over(grid, self.format, &mut front)?;
        let mut back = Galpixmap::new(grid, self.format, &mut back)?;
        let mut edges = vec![0; stages::words(&grid)];
        stages::mark(&front, plan.making().threshold, &mut edges);
        let arrived = arrivals(&front, plan.settings.rounding, frame);
        let mut winners = vec![0; grid.cells() as usize];
        resolve(arrived.iter().copied(), &mut back, &mut winners);
        Ok(Stages {
            edges,
            sources: arrived.iter().map(|arrival| arrival.source).collect(),
            cells: arrived.iter().map(|arrival| arrival.cell.unwrap_or(u32::MAX)).collect(),
            arrivals: arrived.iter().flat_map(|arrival| arrival.words[..self.record().words()].to_vec()).collect(),
            winners,
            resolved: planes(&back),
        })
    }

    /// Makes the step of single galpixels: half of them with random fields, half with fields at an end of their range.
    pub fn propagate(&self, rounding: Rounding, random: &mut Random) -> Content {
        let record = self.record();
        let stored = |words: &[u32]| words[..record.words()].to_vec();
        let (mut galpixels, mut results) = (Vec::new(), Vec::new());
        for turn in 0..GALPIXELS {
            let frame = random.next() as u32;
            let before = if turn % 2 == 0 {
                each_field(record, |name, field| random_field(name, field, record, random))
            } else {
                each_field(record, |name, field| extreme_field(name, field, random))
            };
            let (after, cells, saturated) = moved(record, rounding, frame, before);
            galpixels.push(Stamped { frame, words: stored(&before) });
            results.push(Moved { words: stored(&after), cells, saturated });
        }
        let setting = self.setting(GridSize { width: 1, height: 1, left: 0, right: 0, top: 0, bottom: 0 });
        Content::Propagate(Propagate { setting, rounding: rounding.name().to_owned(), galpixels, results })
    }

    /// Makes one frame, and paints what it uncovered.
    pub fn painted(&self, plan: &Plan, paint: &Paint, random: &mut Random) -> Result<Content, RunError> {
        let mut starts = GridMemory::new(plan.grid);
        let grid = starts.grid()?;
        let front = words(plan.picture, self.record(), &plan.grid, random);
        let mut memory = Memory::new(&front, &grid, paint.edges);
        // A mask ends where it likes: the cells beyond are not in it.
        let mask: Vec<u32> = match paint.masked_quarters {
            0 => Vec::new(),
            quarters => {
                let length = (stages::words(&grid) * quarters as usize).div_ceil(4);
                (0..length).map(|_| random.next() as u32 | random.next() as u32).collect()
            }
        };
        let mut controller = memory.controller(grid, self.format)?;
        controller.set_frame(plan.frame);
        if plan.constant_time {
            controller.step_constant_time(&plan.settings);
        } else {
            controller.step(&plan.settings);
        }
        let after = planes(controller.front());
        let edges = controller.edges().to_vec();
        let Paint { gamma, threshold, background: quads, .. } = *paint;
        let motion = if paint.motion { Motion::Inpainted } else { Motion::Kept };
        let mut words = vec![0; PushPull::words(grid.width(), grid.height(), motion)];
        let mut push_pull = PushPull::new(grid.width(), grid.height(), motion, &mut words)?;
        controller.inpaint(&plan.settings, &Inpainting { gamma, threshold, quads, mask: &mask }, &mut push_pull);
        let map = planes(controller.front());
        let Settings { rounding, edge_threshold, reach, .. } = plan.settings;
        Ok(Content::Inpaint(Inpaint {
            setting: self.setting(plan.grid),
            rounding: rounding.name().to_owned(),
            reach,
            threshold: edge_threshold,
            frame: plan.frame,
            gamma: paint.gamma.name().to_owned(),
            inpaint_threshold: paint.threshold,
            motion: paint.motion,
            background: paint.background,
            mask,
            front,
            edges,
            after,
            map,
        }))
    }
}

/// Runs the step kernel over some states of a component.
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

/// Memory for the grid of a map.
pub struct GridMemory {
    starts: Vec<u32>,
    grid: GridSize,
}

impl GridMemory {
    /// Makes memory for a map of this size.
    pub fn new(grid: GridSize) -> Self {
        Self { starts: vec![0; size(&grid).1 as usize], grid }
    }

    /// Lays the grid over it.
    pub fn grid(&mut self) -> Result<Grid<'_>, SetupError> {
        let GridSize { width, height, left, right, top, bottom } = self.grid;
        Grid::new(width, height, Margin { left, right, top, bottom }, &mut self.starts)
    }
}

/// Memory for the maps of a controller and its scratch buffers.
pub struct Memory {
    maps: [Vec<u32>; 2],
    winners: Vec<u32>,
    edges: Vec<u32>,
}

impl Memory {
    /// Makes memory that holds this map, with or without an edge map.
    pub fn new(front: &[u32], grid: &Grid<'_>, edges: bool) -> Self {
        Self {
            maps: [front.to_vec(), vec![0; front.len()]],
            winners: vec![0; grid.cells() as usize],
            edges: vec![0; if edges { stages::words(grid) } else { 0 }],
        }
    }

    /// Lays a controller over it.
    pub fn controller<'m>(
        &'m mut self,
        grid: Grid<'m>,
        format: Dynamic,
    ) -> Result<Controller<'m, Dynamic>, SetupError> {
        let Self { maps: [front, back], winners, edges } = self;
        Controller::new(
            Galpixmap::over(grid, format, front)?,
            Galpixmap::new(grid, format, back)?,
            Scratch { winners, edges },
        )
    }
}

/// Returns all planes of a map, one after the other.
pub fn planes(map: &Galpixmap<'_, Dynamic>) -> Vec<u32> {
    (0..).map_while(|word| map.plane(word)).flatten().copied().collect()
}
