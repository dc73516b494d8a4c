//! Frames with a single map: the new map is made in a window of a few rows that moves down the old one.
//!
//! The width of the velocity bounds the number of rows that a galpixel moves in a frame, the reach. So once the rows up
//! to `y` have been propagated, row `y - reach` of the new map is complete, and the same row of the old map is not
//! needed any more. The window holds the rows between: those at which galpixels may still arrive, and those whose holes
//! are not filled yet.
//!
//! ```text
//!  old map            window                     map afterwards
//!  row y - reach - 1  filled, copied back ────▶ new
//!  row y - reach      complete
//!  row y              propagated now
//!  row y + reach      the first arrivals
//! ```
//!
//! The result is that of [`crate::Controller::step`], bit by bit, in little more than half the memory.

use crate::error::SetupError;
use crate::fast;
use crate::fast::fill::RowFill;
use crate::fast::narrow::{Target, clear, sweep_row};
use crate::format::Format;
use crate::format::record::Record;
use crate::frame::edge;
use crate::frame::step::thresholds;
use crate::frame::tally::Tally;
use crate::frame::{Scratch, Settings};
use crate::inpaint::{Inpainting, Metamer, PushPull};
use crate::map::Galpixmap;

/// Returns the largest number of rows that a galpixel moves in a frame.
#[must_use]
pub const fn reach(record: &Record) -> u32 {
    reach_along(record, 1)
}

/// Returns the largest number of cells that a galpixel moves in a frame along x (0) or y (1).
#[must_use]
pub const fn reach_along(record: &Record, component: usize) -> u32 {
    let scale = &record.scales[component];
    let velocity = record.velocity(component).bits as u32;
    let acceleration = record.acceleration(component).bits as u32;
    if velocity == 0 {
        return 0;
    }
    // The lowest and the highest step occur where all fields are at the ends of their ranges.
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

/// Returns the rows that a window needs for `rounds` rounds of bullet filling; at least one round is assumed. A map
/// with fewer rows needs a window of all its rows.
#[must_use]
pub const fn rows(record: &Record, rounds: u32) -> u32 {
    (reach(record) << 1) + 2 + if rounds == 0 { 1 } else { rounds }
}

/// A map that is propagated in place, and its window.
#[derive(Debug)]
pub struct Rolling<'p, F> {
    map: Galpixmap<'p, F>,
    window: Galpixmap<'p, F>,
    scratch: Scratch<'p>,
    reach: u32,
    rounds: u32,
    frame: u32,
}

/// Makes the next frame in place.
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
    // The last rows are filled after all rows have been propagated.
    for y in 0..height + reach + rounds as i32 {
        rolling.clear_row(y + reach);
        let Rolling { map, window, scratch, .. } = rolling;
        let mut target = Target { back: window, winners: scratch.winners, tally: &mut tally };
        sweep_row(map, y, &thresholds, &mut target);
        // A round reads the rows above and below as the round before has left them, so that it follows one row behind.
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
    /// Makes a rolling map of a map and a window, which is a map over a [`Grid::window`](crate::Grid::window) of the
    /// map's grid with at least [`rows`] rows, or with all rows if the map has fewer.
    ///
    /// `scratch` has a winner map with a word for each cell *of the window*, and the edge map of the whole map. For
    /// fill modes that do not use edges, both may be empty.
    ///
    /// *Errors:* a window of another width, height or margin, a window with too few rows, or a scratch buffer that is
    /// neither empty nor long enough.
    pub fn new(map: Galpixmap<'p, F>, window: Galpixmap<'p, F>, scratch: Scratch<'p>) -> Result<Self, SetupError> {
        let (grid, windowed) = (*map.grid(), *window.grid());
        if (grid.width(), grid.height(), grid.margin()) != (windowed.width(), windowed.height(), windowed.margin()) {
            return Err(SetupError::GridsDiffer);
        }
        // The window has as many rows as there are before cell 0 is reused. A division would call a library function on
        // processors that have no such instruction.
        let reused = (1..grid.height()).find(|&y| windowed.row(y as i32) == Some(0));
        let have = reused.unwrap_or(grid.height());
        let reach = reach(map.record());
        let need = rows(map.record(), 1).min(grid.height());
        if have < need {
            let cells = grid.row(need as i32).unwrap_or(grid.cells());
            return Err(SetupError::TooShort {
                plane: "window",
                need: cells as usize,
                have: windowed.cells() as usize,
            });
        }
        scratch.check(windowed.cells(), edge::words(&grid))?;
        let rounds = if reused.is_none() { u32::MAX } else { have - (reach << 1) - 2 };
        Ok(Self { map, window, scratch, reach, rounds, frame: 0 })
    }

    /// Makes the next frame. Reduces [`Settings::reach`] to the rounds for which the window has rows.
    pub fn step(&mut self, settings: &Settings) -> Tally {
        F::rolling_step(self, settings)
    }

    /// Inpaints the cells that the last step unobscured, by push-pull; returns how many.
    ///
    /// The result is that of [`crate::Controller::inpaint`] without quads, bit by bit. [`Inpainting::quads`] is
    /// ignored, because the map before no longer exists; holes keep the depth that the fill mode gave them.
    pub fn inpaint(&mut self, inpainting: &Inpainting<'_>, push_pull: &mut PushPull<'_>) -> u32 {
        F::push_pull(&mut self.map, inpainting, push_pull)
    }

    /// Inpaints the cells that the last step unobscured by metamers: as [`Self::inpaint`], with a texture.
    ///
    /// *Errors:* memory that is too short for the map; then nothing is filled.
    pub fn synthesise(&mut self, inpainting: &Inpainting<'_>, metamer: &mut Metamer<'_>) -> Result<u32, SetupError> {
        F::metamers(&mut self.map, inpainting, metamer, self.frame)
    }

    /// Makes row `y` of the window empty, if there is such a row.
    fn clear_row(&mut self, y: i32) {
        let Some(row) = self.window.grid().row(y) else { return };
        let cells = row as usize..(row + self.window.grid().width()) as usize;
        clear(&mut self.window, self.scratch.winners, cells);
    }

    /// Copies row `y` of the window into the map, if there is such a row.
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

    /// Returns the scratch buffers.
    #[cfg(feature = "check")]
    pub(crate) const fn scratch(&self) -> &Scratch<'p> {
        &self.scratch
    }

    /// Returns the largest number of rounds of bullet filling for which the window has rows.
    #[cfg(feature = "check")]
    pub(crate) const fn rounds(&self) -> u32 {
        self.rounds
    }

    /// Returns the map, which is what is shown.
    #[must_use]
    pub const fn map(&self) -> &Galpixmap<'p, F> {
        &self.map
    }

    /// Returns the map, for writing an update into it.
    pub const fn map_mut(&mut self) -> &mut Galpixmap<'p, F> {
        &mut self.map
    }

    /// Returns the frame counter, see [`crate::Controller::frame`].
    #[must_use]
    pub const fn frame(&self) -> u32 {
        self.frame
    }

    /// Sets the frame counter, see [`crate::Controller::set_frame`].
    pub const fn set_frame(&mut self, frame: u32) {
        self.frame = frame;
    }
}
