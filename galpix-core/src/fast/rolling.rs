//! A frame with one map: the new map is made in a window of a few rows that rolls down the old one.
//!
//! A galpixel moves by a bounded number of rows in a frame, by the width of its velocity. So once the rows down to `y` have
//! been taken, row `y - reach` of the new map is complete, and the old row in that place is needed no more. The window holds
//! the rows between: those that galpixels still may reach, and those whose holes are not filled yet.
//!
//! ```text
//!  old map            window                     map afterwards
//!  row y - reach - 1  filled, and copied back ─▶ new
//!  row y - reach      complete
//!  row y              taken now
//!  row y + reach      the first arrivals
//! ```
//!
//! The result is that of [`crate::frame::step`] bit by bit, in little more than half
//! the memory.

use crate::error::SetupError;
use crate::fast;
use crate::fast::fill::RowFill;
use crate::fast::narrow::{clear, sweep_row};
use crate::format::Format;
use crate::format::record::Record;
use crate::frame::edge;
use crate::frame::step::thresholds;
use crate::frame::tally::Tally;
use crate::frame::{Scratch, Settings};
use crate::inpaint::{Inpainting, PushPull};
use crate::map::Galpixmap;

/// The most rows that a galpixel moves in a frame.
#[must_use]
pub const fn reach(record: &Record) -> u32 {
    let scale = &record.scales[1];
    let (velocity, acceleration) = (record.velocity(1).bits as u32, record.acceleration(1).bits as u32);
    if velocity == 0 {
        return 0;
    }
    // The lowest and the highest step, of fields that all are at their ends.
    let v = 1i64 << (velocity - 1);
    let a = if acceleration == 0 { 0 } else { 1i64 << (acceleration - 1) };
    let a_top = if acceleration == 0 { 0 } else { a - 1 };
    let half = (1i64 << scale.position_frac) >> 1;
    let offset_top = if half == 0 { 0 } else { half - 1 };
    let lowest = ((-(v << 1) - (a << scale.acceleration_up)) >> scale.down) << scale.up;
    let threshold = (1i64 << scale.down) - 1;
    let highest = ((((v - 1) << 1) + (a_top << scale.acceleration_up) + threshold) >> scale.down) << scale.up;
    let (down, up) = (-(lowest >> scale.position_frac), (highest + offset_top + half) >> scale.position_frac);
    if down > up { down as u32 } else { up as u32 }
}

/// The rows that a window needs for `rounds` rounds of bullet filling, for maps that are not lower than that.
#[must_use]
pub const fn rows(record: &Record, rounds: u32) -> u32 {
    (reach(record) << 1) + 2 + if rounds == 0 { 1 } else { rounds }
}

/// A map that is propagated in place, and the window for it.
#[derive(Debug)]
pub struct Rolling<'p, F> {
    map: Galpixmap<'p, F>,
    window: Galpixmap<'p, F>,
    scratch: Scratch<'p>,
    reach: u32,
    rounds: u32,
    frame: u32,
}

/// Makes the next frame of a rolling map.
pub(crate) fn make<F: Format>(rolling: &mut Rolling<'_, F>, settings: &Settings) -> Tally {
    let mut tally = Tally::default();
    if settings.fill_mode.uses_edges() && !rolling.scratch.edges.is_empty() {
        tally.edges = fast::mark(&rolling.map, settings.edge_threshold, rolling.scratch.edges);
    }
    let thresholds = thresholds(rolling.map.record(), settings.rounding, rolling.frame);
    let rounds = settings.fill_mode.rounds(settings.reach).min(rolling.rounds);
    let (height, reach) = (rolling.map.grid().height() as i32, rolling.reach as i32);
    for y in 0..reach.min(height) {
        rolling.clear_row(y);
    }
    // Where the last rows are filled there are no more to take.
    for y in 0..height + reach + rounds as i32 {
        rolling.clear_row(y + reach);
        let Rolling { map, window, scratch, .. } = rolling;
        sweep_row(map, y, &thresholds, window, scratch.winners, &mut tally);
        // A round sees the rows above and below as the round before has left them: each follows one row behind.
        let complete = y - reach;
        for round in 0..rounds {
            let (last, y) = (round + 1 == rounds, complete - 1 - round as i32);
            let row = RowFill { fill_mode: settings.fill_mode, y, round, last };
            row.fill(map, window, scratch, &mut tally);
        }
        rolling.copy_back(complete - rounds as i32);
    }
    rolling.frame = rolling.frame.wrapping_add(1);
    tally
}

impl<'p, F: Format> Rolling<'p, F> {
    /// A map, and a map over [`crate::map::grid::Grid::window`] of its grid with at least [`rows`] rows, or with all of them.
    ///
    /// `scratch` is for the rungs that tell surfaces apart: a word for each cell *of the window*, and the edge map of the
    /// whole map; or empty slices.
    ///
    /// *Errors:* a window of another width or height, or with too few rows; scratch memory that is neither empty nor long
    /// enough.
    pub fn new(map: Galpixmap<'p, F>, window: Galpixmap<'p, F>, scratch: Scratch<'p>) -> Result<Self, SetupError> {
        let (grid, rolls) = (*map.grid(), *window.grid());
        if (grid.width(), grid.height(), grid.margin()) != (rolls.width(), rolls.height(), rolls.margin()) {
            return Err(SetupError::GridsDiffer);
        }
        // The rows that the window has, found without a division.
        let again = (1..grid.height()).find(|&y| rolls.row(y as i32) == Some(0));
        let have = again.unwrap_or(grid.height());
        let reach = reach(map.record());
        let need = rows(map.record(), 1).min(grid.height());
        if have < need {
            let cells = grid.row(need as i32).unwrap_or(grid.cells());
            return Err(SetupError::TooShort { plane: "window", need: cells as usize, have: rolls.cells() as usize });
        }
        scratch.check(rolls.cells(), edge::words(&grid))?;
        let rounds = if again.is_none() { u32::MAX } else { have - (reach << 1) - 2 };
        Ok(Self { map, window, scratch, reach, rounds, frame: 0 })
    }

    /// Makes the next frame. [`Settings::reach`] is lowered to what the window has rows for.
    pub fn step(&mut self, settings: &Settings) -> Tally {
        F::rolling_step(self, settings)
    }

    /// Fills what the last step uncovered, by push-pull: how many cells. [`crate::frame::Controller::inpaint`] gives the same bits
    /// without quads: of the map before nothing is left to draw them from, and the depth that the fill mode gave the holes
    /// serves. [`Inpainting::quads`] does not matter.
    pub fn inpaint(&mut self, inpainting: &Inpainting<'_>, push_pull: &mut PushPull<'_>) -> u32 {
        F::push_pull(&mut self.map, inpainting, push_pull)
    }

    /// Makes a row of the window empty, if there is one.
    fn clear_row(&mut self, y: i32) {
        let Some(row) = self.window.grid().row(y) else { return };
        let cells = row as usize..(row + self.window.grid().width()) as usize;
        clear(&mut self.window, self.scratch.winners, cells);
    }

    /// Copies a row of the window to where it belongs, if there is one.
    fn copy_back(&mut self, y: i32) {
        let width = self.map.grid().width() as usize;
        let (Some(from), Some(to)) = (self.window.grid().row(y), self.map.grid().row(y)) else { return };
        let words = self.map.record().words();
        for (plane, rows) in self.map.planes_mut().iter_mut().zip(self.window.planes()).take(words) {
            let (from, to) = (from as usize..from as usize + width, to as usize..to as usize + width);
            if let (Some(to), Some(from)) = (plane.get_mut(to), rows.get(from)) {
                to.copy_from_slice(from);
            }
        }
    }

    /// The caller-provided buffers.
    #[cfg(feature = "check")]
    pub(crate) const fn scratch(&self) -> &Scratch<'p> {
        &self.scratch
    }

    /// The rounds of bullet filling that the window has rows for.
    #[cfg(feature = "check")]
    pub(crate) const fn rounds(&self) -> u32 {
        self.rounds
    }

    /// The map as it is shown.
    #[must_use]
    pub const fn map(&self) -> &Galpixmap<'p, F> {
        &self.map
    }

    /// The map as it is shown, to write an update into.
    pub const fn map_mut(&mut self) -> &mut Galpixmap<'p, F> {
        &mut self.map
    }

    /// The frame counter, see [`crate::frame::Controller::frame`].
    #[must_use]
    pub const fn frame(&self) -> u32 {
        self.frame
    }

    /// Sets the frame counter, see [`crate::frame::Controller::set_frame`].
    pub const fn set_frame(&mut self, frame: u32) {
        self.frame = frame;
    }
}
