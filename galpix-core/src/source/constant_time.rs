//! Frames by instructions that do not depend on the picture: see [`crate::frame::reference`], which does so for maps.
//!
//! Every sample makes a step and challenges one cell. Of each row only a budget of stretched quads is drawn, and only a
//! budget of cells that may be cracks is looked at; both are first listed, and the list is worked through as if it were
//! full.

use core::cell::Cell;

use super::drawn;
use super::layer::{Source, moved};
use super::quads::{Quad, draw_one, stretched};
use super::visibility::{Entry, Kind, PARTS, Visibility, depth, threshold};
use crate::fast;
use crate::format::Format;
use crate::format::rounding::Rounding;
use crate::frame::Settings;
use crate::frame::reference::{below, beyond, choose, merge, merge_word, not_zero, opaque};
use crate::frame::step::{advance, parts, thresholds};
use crate::frame::tally::Tally;
use crate::layers::displacement;

/// How much of what is rare a frame in constant time does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Budget {
    /// Stretched quads that are drawn of each row of samples, from the left.
    pub quads: u32,
    /// Cells of each row of the display that are looked at for cracks, from the left: those between two that show
    /// something nearer.
    pub cracks: u32,
}

/// Finds out what every cell shows, after a step; returns also how much was beyond the budget.
pub(crate) fn draw<F: Format>(
    layers: &mut [Source<'_, F>],
    visibility: &mut Visibility<'_>,
    settings: &Settings,
    (frame, budget): (u32, &Budget),
) -> (Tally, u32) {
    let (left_out, step) = (Cell::new(0), Some((settings.rounding, frame)));
    let show = |source: &mut Source<'_, F>, visibility: &mut Visibility<'_>, first| {
        let tally = samples(source, visibility, first, settings.edge_threshold, step);
        left_out.set(left_out.get() + quads(source, visibility, first, budget.quads as usize));
        tally
    };
    let tally = drawn(layers, visibility, settings.edge_threshold, show, |layers, visibility, threshold| {
        let (closed, cracks) = fast::close_cracks_constant_time(layers, visibility, threshold, budget.cracks as usize);
        left_out.set(left_out.get() + cracks);
        closed
    });
    (tally, left_out.get())
}

/// Steps the samples of a layer, if a rounding and a frame counter are given, and shows them. `first` is the number of
/// the layer's first sample.
///
/// Points lie behind quads of the same surface by half of the edge threshold, which is in units of the depth's last
/// bit.
pub(crate) fn samples<F: Format>(
    source: &mut Source<'_, F>,
    visibility: &mut Visibility<'_>,
    first: u32,
    edge_threshold: u32,
    step: Option<(Rounding, u32)>,
) -> Tally {
    let format = source.map.format();
    let record = format.record();
    let (grid, display) = (*source.map.grid(), visibility.grid());
    let thresholds = step.map(|(rounding, frame)| thresholds(record, rounding, frame));
    let depth_bits = u32::from(record.depth().bits);
    let behind = threshold(edge_threshold, depth_bits) as u32 >> 1;
    let fracs = [record.offset_x().bits.into(), record.offset_y().bits.into()];
    let mut tally = Tally::default();
    for (y, &start) in (0..).zip(grid.starts()) {
        for (x, cell) in (0..grid.width() as i32).zip(start..) {
            let mut words = source.map.words_at(cell).unwrap_or_default();
            let there = opaque(!not_zero(record.class().unsigned(&words)));
            let mut place = source.displacements.get(cell as usize).copied().unwrap_or(0);
            if let Some(thresholds) = &thresholds {
                let step = advance::<true>(record, thresholds, &mut words);
                let [dx, dy] = displacement(place);
                let (after, clamped) = moved([dx + step.dx, dy + step.dy]);
                tally.saturated += (step.saturated() + clamped) & there;
                place = choose(there, after, place);
                merge_word(source.displacements, cell, place, there);
                merge(&mut source.map, cell, &words, there);
            }
            let [dx, dy] = displacement(place);
            let target = [x + dx, y + dy];
            tally.moved += there & 1;
            tally.lost += there & beyond(&display, target) & 1;
            let offset = [record.offset_x().signed(&words), record.offset_y().signed(&words)];
            let depth = depth(record.depth().unsigned(&words), depth_bits) + behind;
            let entry = Entry::new(depth, Kind::Point, first + cell, residual(offset, fracs));
            visibility.challenge_where(there, target, entry);
        }
    }
    tally
}

/// Shows of each row of a layer `most` stretched quads; returns how many are left out.
pub(crate) fn quads<F: Format>(
    source: &Source<'_, F>,
    visibility: &mut Visibility<'_>,
    first: u32,
    most: usize,
) -> u32 {
    let grid = *source.map.grid();
    let most = most.min(grid.width() as usize - 1);
    let mut left_out = 0;
    for (y, &start) in grid.starts().iter().enumerate().take(grid.height() as usize - 1) {
        let mut listed = 0;
        for x in 0..grid.width() as usize - 1 {
            visibility.list(y, listed, x);
            listed += (stretched(source, start + x as u32) & 1) as usize;
        }
        for slot in 0..most {
            let mask = opaque(below(slot as u32, listed as u32));
            let x = visibility.listed(y, slot) & mask;
            let quad = Quad { first, place: [x as i32, y as i32], cell: start + x, mask };
            draw_one::<F, true>(source, visibility, quad);
        }
        left_out += listed.saturating_sub(most) as u32;
    }
    left_out
}

/// Returns the residual of the cell that is nearest to a sample with these offsets, in sixteenths of a cell.
pub(crate) const fn residual(offset: [i32; 2], frac: [u32; 2]) -> [i32; 2] {
    [-parts::<PARTS>(offset[0], frac[0]), -parts::<PARTS>(offset[1], frac[1])]
}
