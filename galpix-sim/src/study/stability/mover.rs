//! What moves a galpixel: the engine itself, on a strip of cells that is just long enough for one step.

use galpix_core::{
    BudgetError, Controller, Dynamic, FillMode, Galpixel, Galpixmap, Grid, Layout, Margin, Rounding, Scratch, Settings,
};

use super::path::Given;
use super::setting::Setting;

/// One component of a galpixel as it is stored, in units of the fields' last bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct State {
    /// The cell that shows it; in depth 0.
    pub cell: i64,
    /// The position, its cell included.
    pub position: i64,
    /// The velocity.
    pub velocity: i64,
    /// The acceleration.
    pub acceleration: i64,
}

/// Where something is after it was loaded or moved, and how many of its fields were clamped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moved {
    /// The state.
    pub state: State,
    /// Fields that were clamped.
    pub clamped: u32,
}

/// Something that stores a galpixel and moves it on, frame by frame.
pub trait Mover {
    /// Stores what an update hands over.
    fn load(&mut self, given: &Given) -> Moved;
    /// Makes a frame; `None` if the galpixel is nowhere to be found.
    fn step(&mut self, counter: u32) -> Option<Moved>;
}

/// The engine: each step is a frame of a map of one row (x), one column (y) or one cell (depth).
///
/// Between two steps the galpixel is put back to the end of its strip, which changes no bit of it: a stored galpixel
/// does not know its cell.
pub struct Strip {
    setting: Setting,
    format: Dynamic,
    component: usize,
    settings: Settings,
    galpixel: Galpixel,
    cell: i64,
    memory: [Vec<u32>; 4],
}

impl Strip {
    /// Creates the engine for one component.
    ///
    /// *Errors:* a budget that does not fit the layout.
    pub fn new(setting: &Setting, component: usize, rounding: Rounding) -> Result<Self, BudgetError> {
        Ok(Self {
            setting: *setting,
            format: Dynamic::new(setting.bits, Layout::FULL)?,
            component,
            settings: Settings {
                rounding,
                fill_mode: FillMode::None,
                ..Settings::for_depth(setting.record.depth().bits.into())
            },
            galpixel: Galpixel::default(),
            cell: 0,
            memory: Default::default(),
        })
    }

    fn state(&self) -> State {
        let (scale, unit) = (self.setting.record.scales[self.component], self.setting.unit(self.component));
        let raw = |value: fixed::types::I32F32, frac: u32| match 32i32 - (frac + unit) as i32 {
            down @ 0.. => value.to_bits() >> down,
            up => value.to_bits() << -up,
        };
        let position = match self.component {
            2 => self.galpixel.depth.to_bits() >> (32 - u32::from(self.setting.record.depth().bits)),
            plane => (self.cell << scale.position_frac) + raw(self.galpixel.offset[plane], scale.position_frac),
        };
        State {
            cell: self.cell,
            position,
            velocity: raw(self.galpixel.velocity[self.component], scale.velocity_frac),
            acceleration: raw(self.galpixel.acceleration[self.component], scale.acceleration_frac),
        }
    }

    /// Returns the cells of a strip that holds the next step, and the cell to start from.
    fn strip(&self) -> (u32, i32) {
        if self.component == 2 {
            return (1, 0);
        }
        let step = self.galpixel.velocity[self.component].to_num::<f64>()
            + self.galpixel.acceleration[self.component].to_num::<f64>() / 2.0;
        let cells = step.abs().ceil() as u32 + 4;
        (cells, if step < 0.0 { cells as i32 - 2 } else { 1 })
    }

    /// Runs one frame on a strip, or none: stores the galpixel and reads it where it then is.
    fn run(&mut self, counter: Option<u32>) -> Option<Moved> {
        let (cells, from) = if counter.is_some() { self.strip() } else { (1, 0) };
        let (width, height) = if self.component == 1 { (1, cells) } else { (cells, 1) };
        let at = |cell: i32| if self.component == 1 { (0, cell) } else { (cell, 0) };
        let [starts, front, back, winners] = &mut self.memory;
        starts.resize(cells as usize, 0);
        let grid = Grid::new(width, height, Margin::NONE, starts).ok()?;
        let words = Galpixmap::words(&grid, self.format);
        front.resize(words, 0);
        back.resize(words, 0);
        winners.resize(cells as usize, 0);
        let mut front = Galpixmap::new(grid, self.format, front).ok()?;
        let mut clamped = front.store(at(from).0, at(from).1, &self.galpixel)?;
        let mut to = from;
        match counter {
            None => self.galpixel = front.load(at(from).0, at(from).1)?,
            Some(counter) => {
                let back = Galpixmap::over(grid, self.format, back).ok()?;
                let winners = winners.get_mut(..cells as usize)?;
                let mut controller = Controller::new(front, back, Scratch { winners, edges: &mut [] }).ok()?;
                controller.set_frame(counter);
                clamped += controller.step(&self.settings).saturated;
                to = controller.winners().iter().position(|&source| source == from as u32)? as i32;
                self.galpixel = controller.front().load(at(to).0, at(to).1)?;
            }
        }
        self.cell += i64::from(to - from);
        Some(Moved { state: self.state(), clamped })
    }
}

impl Mover for Strip {
    fn load(&mut self, given: &Given) -> Moved {
        (self.cell, self.galpixel) = (given.cell, given.galpixel);
        self.run(None).unwrap_or(Moved { state: self.state(), clamped: u32::MAX })
    }

    fn step(&mut self, counter: u32) -> Option<Moved> {
        self.run(Some(counter))
    }
}
