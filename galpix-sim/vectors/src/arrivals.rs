//! Propagation and resolution written slowly, galpixel by galpixel: a text of the rules, with which the passes of the
//! core are compared. From the core it takes the arithmetic of one component ([`galpix_core::stages`]) and the order of
//! candidates.

use galpix_core::record::{MAX_WORDS, Record};
use galpix_core::stages::{Candidate, NO_WINNER, clamp_velocity, nearer, snap, step_position, step_velocity};
use galpix_core::{Class, Delay, Format, Galpixmap, Rounding, Tally, graft};

use crate::field::{Words, set, signed, unsigned};

/// A galpixel after its step: all that propagation hands to resolution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrival {
    /// The cell that it wants; `None` if it left the map over its border.
    pub cell: Option<u32>,
    /// The cell that it comes from.
    pub source: u32,
    /// Its words as they will be stored.
    pub words: [u32; MAX_WORDS],
    /// Its fields that were clamped.
    pub saturated: u32,
}

/// Moves all galpixels and debris of a map whose frame counter is `frame`; returns their arrivals in raster order.
pub fn arrivals<F: Format>(front: &Galpixmap<'_, F>, rounding: Rounding, frame: u32) -> Vec<Arrival> {
    let (grid, record) = (front.grid(), front.record());
    let thresholds = record.scales.map(|scale| rounding.threshold(frame, scale.down));
    let mut arrivals = Vec::new();
    for (x, y, source) in places(front) {
        let mut words = [0; MAX_WORDS];
        for (word, plane) in words.iter_mut().zip((0..).map_while(|word| front.plane(word))) {
            *word = plane[source as usize];
        }
        if unsigned(&words, record.class()) != Class::Empty as u32 {
            let mut step = Step { record, thresholds, words, saturated: 0 };
            let [dx, dy] = step.advance();
            let Step { words, saturated, .. } = step;
            arrivals.push(Arrival { cell: grid.cell(x + dx, y + dy), source, words, saturated });
        }
    }
    arrivals
}

/// Returns a galpixel after its step, the cells that it moves along x and y, and its fields that were clamped.
pub fn moved(record: &Record, rounding: Rounding, frame: u32, words: Words) -> (Words, [i32; 2], u32) {
    let thresholds = record.scales.map(|scale| rounding.threshold(frame, scale.down));
    let mut step = Step { record, thresholds, words, saturated: 0 };
    let cells = step.advance();
    (step.words, cells, step.saturated)
}

/// Settles arrivals into a map, whatever order they come in. Both `back` and `winners` are cleared first.
///
/// `winners` has a word for each cell: the source of the galpixel that got the cell, [`NO_WINNER`] where none did.
pub fn resolve<F: Format>(
    arrivals: impl IntoIterator<Item = Arrival>,
    back: &mut Galpixmap<'_, F>,
    winners: &mut [u32],
) -> Tally {
    let record = *back.record();
    let mut tally = Tally::default();
    let mut nearest: Vec<Option<Arrival>> = vec![None; back.grid().cells() as usize];
    for arrival in arrivals {
        tally.moved += 1;
        tally.saturated += arrival.saturated;
        let Some(cell) = arrival.cell else {
            tally.lost += 1;
            continue;
        };
        let incumbent = &mut nearest[cell as usize];
        tally.collided += u32::from(incumbent.is_some());
        if incumbent.is_none_or(|incumbent| nearer(candidate(&record, &arrival), candidate(&record, &incumbent))) {
            *incumbent = Some(arrival);
        }
    }
    back.clear();
    winners.fill(NO_WINNER);
    for (x, y, cell) in places(back) {
        if let Some(Arrival { source, words, .. }) = nearest[cell as usize] {
            winners[cell as usize] = source;
            // Into an empty cell, and without a frame between: the words are put as they are.
            graft(back, (x, y), &words, Delay { stamp: 0, now: 0, rounding: Rounding::Truncate });
        }
    }
    tally
}

/// Returns column, row and number of all cells of a map, in raster order.
fn places<F: Format>(map: &Galpixmap<'_, F>) -> Vec<(i32, i32, u32)> {
    let grid = map.grid();
    let columns = 0..grid.width() as i32;
    let places = (0..grid.height() as i32).flat_map(|y| columns.clone().map(move |x| (x, y)));
    places.filter_map(|(x, y)| Some((x, y, grid.cell(x, y)?))).collect()
}

fn candidate(record: &Record, arrival: &Arrival) -> Candidate {
    let (class, depth) = (unsigned(&arrival.words, record.class()), unsigned(&arrival.words, record.depth()));
    Candidate { key: class << record.depth().bits | depth, source: arrival.source }
}

/// One galpixel while it moves forward by one frame.
struct Step<'r> {
    record: &'r Record,
    thresholds: [i32; 3],
    words: Words,
    /// Fields that were clamped.
    saturated: u32,
}

impl Step<'_> {
    /// Moves the galpixel; returns the cells that it moves along the row and along the column.
    fn advance(&mut self) -> [i32; 2] {
        let (record, layout, mut cells) = (self.record, self.record.layout(), [0; 2]);
        if layout.velocity {
            for (component, offset) in [record.offset_x(), record.offset_y()].into_iter().enumerate() {
                let scale = &record.scales[component];
                let position = self.component(component, signed(&self.words, offset));
                cells[component] = snap(scale, position);
                set(&mut self.words, offset, position - (cells[component] << scale.position_frac));
            }
        }
        if layout.depth_motion {
            let position = self.component(2, unsigned(&self.words, record.depth()) as i32);
            let within = position.clamp(0, (1 << record.depth().bits) - 1);
            set(&mut self.words, record.depth(), within);
            self.saturated += u32::from(within != position);
        }
        if layout.luminosity {
            self.brighten();
        }
        // What was just unobscured is debris from now on.
        if unsigned(&self.words, record.class()) == Class::JustUnobscured as u32 {
            set(&mut self.words, record.class(), Class::Debris as i32);
        }
        cells
    }

    /// Makes the step of one component from this position; returns the position after it. The velocity saturates.
    fn component(&mut self, component: usize, position: i32) -> i32 {
        let (scale, field) = (&self.record.scales[component], self.record.velocity(component));
        let (v, a) = (signed(&self.words, field), signed(&self.words, self.record.acceleration(component)));
        let raised = step_velocity(scale, v, a);
        let velocity = clamp_velocity(scale, raised);
        set(&mut self.words, field, velocity);
        self.saturated += u32::from(velocity != raised);
        step_position(scale, self.thresholds[component], position, v, a)
    }

    /// Moves the luminosity by its rate; whole steps go into the colour.
    fn brighten(&mut self) {
        let (record, words) = (self.record, &mut self.words);
        let level = unsigned(words, record.luminosity()) as i32 + signed(words, record.luminosity_rate());
        set(words, record.luminosity(), level);
        let colour = unsigned(words, record.colour());
        let brighter = record.colour_format().brightened(colour, level >> record.luminosity_frac);
        set(words, record.colour(), brighter as i32);
    }
}
