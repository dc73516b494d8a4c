//! Section 10 of the specification, cell by cell, for a map of which some cells belong to others: slow, from the text
//! alone.

use galpix_core::record::Field;
use galpix_core::stages::{FILLED, NO_WINNER};
use galpix_core::{FillMode, Record, Tally};
use galpix_tests::packed;

/// The words of a cell.
pub type Cell = Vec<u32>;

/// What a bullet hole becomes.
const DEBRIS: i64 = 2;
pub const EMPTY: i64 = 3;

pub fn class(record: &Record, cell: &Cell) -> i64 {
    packed::unsigned(record.class(), cell)
}

pub fn depth(record: &Record, cell: &Cell) -> i64 {
    packed::unsigned(record.depth(), cell)
}

/// Returns the edge map of section 8 by cells.
pub fn edges(record: &Record, cells: &[Cell], columns: usize, threshold: u32) -> Vec<bool> {
    let rows = cells.len() / columns;
    let threshold = i64::from(threshold.min(i32::MAX as u32));
    (0..cells.len())
        .map(|cell| {
            let (x, y) = (cell % columns, cell / columns);
            let beside = [
                if x > 0 { cell - 1 } else { cell },
                if x + 1 < columns { cell + 1 } else { cell },
                if y > 0 { cell - columns } else { cell },
                if y + 1 < rows { cell + columns } else { cell },
            ];
            let laplacian =
                beside.iter().map(|&cell| depth(record, &cells[cell])).sum::<i64>() - 4 * depth(record, &cells[cell]);
            let empty = beside.iter().chain([&cell]).any(|&cell| class(record, &cells[cell]) == EMPTY);
            empty || laplacian.abs() > threshold
        })
        .collect()
}

/// What the holes of a map are decided from.
pub struct Holes<'h> {
    pub record: &'h Record,
    pub columns: usize,
    pub fill_mode: FillMode,
    pub reach: u32,
    /// An edge bit for each cell of the map before; without it no cell is inside a surface.
    pub edges: Option<&'h [bool]>,
    /// Whether there is a winner map.
    pub winners_known: bool,
    /// The cells that show what is not the map's own.
    pub foreign: &'h [bool],
    /// What was shown before; nothing if bullet holes alone are filled.
    pub before: Option<&'h [Cell]>,
}

impl Holes<'_> {
    /// Fills `cells`, whose winners are `winners`.
    pub fn fill(&self, cells: &mut [Cell], winners: &mut [u32], tally: &mut Tally) {
        let rounds = if self.fill_mode.uses_edges() { self.reach.clamp(1, 16) } else { 1 };
        for round in 0..rounds {
            let (was, had) = (cells.to_vec(), winners.to_vec());
            for cell in (0..was.len()).filter(|&cell| class(self.record, &was[cell]) == EMPTY) {
                if let Some(mut words) = self.bullet(&was, &had, cell, round) {
                    packed::set(self.record.class(), &mut words, DEBRIS);
                    (cells[cell], winners[cell]) = (words, FILLED + round);
                    tally.bullets += 1;
                } else if let (Some(before), true) = (self.before, round + 1 == rounds) {
                    cells[cell] = self.unobscured(&was, &before[cell], cell, tally);
                    winners[cell] = NO_WINNER;
                } else {
                    continue;
                }
                tally.holes += 1;
            }
        }
    }

    fn at(&self, cell: usize, count: usize, [dx, dy]: [i32; 2]) -> Option<usize> {
        let (x, y) = ((cell % self.columns) as i32 + dx, (cell / self.columns) as i32 + dy);
        let rows = count / self.columns;
        ((0..self.columns as i32).contains(&x) && (0..rows as i32).contains(&y))
            .then(|| y as usize * self.columns + x as usize)
    }

    fn bullet(&self, was: &[Cell], had: &[u32], cell: usize, round: u32) -> Option<Cell> {
        if !self.fill_mode.uses_edges() || !self.winners_known {
            return None;
        }
        let inside = |step: [i32; 2]| {
            let cell = self.at(cell, was.len(), step)?;
            let winner = had[cell];
            let inside = if winner < FILLED {
                self.edges.is_some_and(|edges| !edges[winner as usize])
            } else {
                winner < FILLED + round
            };
            (inside && !self.foreign[cell]).then(|| &was[cell])
        };
        let vacant = |step: [i32; 2]| match self.at(cell, was.len(), step) {
            None => true,
            Some(cell) => !self.foreign[cell] && had[cell] >= FILLED + round,
        };
        let sides = [[-1, 0], [1, 0], [0, -1], [0, 1]];
        let corners = [[-1, -1], [1, 1], [1, -1], [-1, 1]];
        let mut beside = sides.map(inside);
        if beside.iter().all(Option::is_none) && sides.into_iter().all(vacant) {
            beside = corners.map(inside);
        }
        match beside {
            [Some(a), Some(b), Some(c), Some(d)] => Some(self.mean(&[a, b, c, d])),
            [Some(a), Some(b), _, _] | [_, _, Some(a), Some(b)] => Some(self.mean(&[a, b])),
            [a, b, c, d] => match (a.or(b), c.or(d)) {
                (Some(a), Some(c)) => Some(self.mean(&[a, c])),
                (one, other) => one.or(other).cloned(),
            },
        }
    }

    fn mean(&self, cells: &[&Cell]) -> Cell {
        let record = self.record;
        let mut mean = cells[0].clone();
        let count = cells.len() as i64;
        let rounded = |sum: i64| (sum + count / 2).div_euclid(count);
        let mut signed = |field: Field| {
            packed::set(field, &mut mean, rounded(cells.iter().map(|cell| packed::signed(field, cell)).sum()));
        };
        signed(record.offset_x());
        signed(record.offset_y());
        for component in 0..3 {
            signed(record.velocity(component));
            signed(record.acceleration(component));
        }
        signed(record.luminosity_rate());
        packed::set(record.depth(), &mut mean, rounded(cells.iter().map(|cell| depth(record, cell)).sum()));
        let colours: Vec<_> = cells.iter().map(|cell| packed::unsigned(record.colour(), cell) as u32).collect();
        let colour = match colours[..] {
            [a, b] => record.colour_format().mean4([a, b, a, b]),
            [a, b, c, d] => record.colour_format().mean4([a, b, c, d]),
            _ => unreachable!("means are taken of two or four"),
        };
        packed::set(record.colour(), &mut mean, colour.into());
        mean
    }

    fn unobscured(&self, was: &[Cell], before: &Cell, cell: usize, tally: &mut Tally) -> Cell {
        let record = self.record;
        let known = class(record, before) != EMPTY;
        if known && self.fill_mode >= FillMode::Galdebris {
            tally.galdebris += 1;
            let start = cell - cell % self.columns;
            let there = |cell: &usize| class(record, &was[*cell]) != EMPTY;
            let left = (start..cell).rev().find(there);
            let right = (cell + 1..start + self.columns).find(there);
            let beside = match (left, right) {
                (Some(left), Some(right)) if depth(record, &was[right]) > depth(record, &was[left]) => Some(right),
                (left, right) => left.or(right),
            };
            let mut words = match beside {
                Some(beside) if self.fill_mode == FillMode::Extend => was[beside].clone(),
                _ => before.clone(),
            };
            packed::set(record.class(), &mut words, 1);
            return words;
        }
        let mut words = vec![0; before.len()];
        if self.fill_mode != FillMode::None {
            packed::set(record.colour(), &mut words, packed::unsigned(record.colour(), before));
        }
        if known && self.fill_mode >= FillMode::Debris {
            tally.debris += 1;
            packed::set(record.class(), &mut words, if self.fill_mode == FillMode::Debris { 2 } else { 1 });
            packed::set(record.depth(), &mut words, -1);
        } else {
            tally.empty += 1;
            packed::set(record.class(), &mut words, EMPTY);
        }
        words
    }
}

/// Returns the words of the edge map as the engine keeps them.
pub fn packed_edges(edges: &[bool]) -> Vec<u32> {
    edges.chunks(32).map(|bits| (0..).zip(bits).fold(0, |word, (bit, &set)| word | u32::from(set) << bit)).collect()
}

/// Returns how many bits are set, where an edge map is made.
pub fn count(edges: &[bool]) -> u32 {
    edges.iter().filter(|&&edge| edge).count() as u32
}
