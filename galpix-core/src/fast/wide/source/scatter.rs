//! Steps samples in place and shows them, chunk by chunk.
//!
//! Neighbours mostly move alike: a run of samples with equal displacements is shown as a whole. The places of two rows
//! are kept, so that of all quads only the stretched ones are looked at.

use core::ops::Range;

use super::step::{Samples, Steps};
use crate::fast::wide::planes::unpack;
use crate::fast::wide::{CHUNK, Chunk, run_length};
use crate::format::Format;
use crate::format::rounding::Rounding;
use crate::frame::step::parts;
use crate::frame::tally::Tally;
use crate::layers::displacement;
use crate::map::grid::Grid;
use crate::source::Source;
use crate::source::layer::CORNER_PARTS;
use crate::source::quads::{Quad, STRETCHED, draw_one};
use crate::source::visibility::{EMPTY, FARTHEST, Kind, PARTS, RESIDUAL_BITS, Visibility, depth, threshold};

/// What a chunk shows. The memory is reused for all chunks.
struct Shown {
    /// Fields of the chunk, one after the other.
    field: [i32; CHUNK],
    /// Places in x or in y in [`CORNER_PARTS`] parts of a cell, modulo 2^16.
    places: [u16; CHUNK],
    keys: [u16; CHUNK],
    words: [u32; CHUNK],
    /// Not 0 for lanes that are not of a run with the lane before.
    boundary: [i32; CHUNK],
}

/// A pass over the samples of a layer.
struct Pass<'s, 'p, 'v, 'w, F> {
    steps: Steps<'s, 'p, F>,
    visibility: &'v mut Visibility<'w>,
    /// The grid of the samples.
    grid: Grid<'p>,
    display: Grid<'w>,
    /// The number of the first sample.
    first: u32,
    /// How far points lie behind quads.
    behind: u16,
    tally: Tally,
}

/// Steps and shows the samples of a layer, see [`crate::source::draw`].
pub(crate) fn scatter<F: Format>(
    source: &mut Source<'_, F>,
    visibility: &mut Visibility<'_>,
    first: u32,
    edge_threshold: u32,
    step: Option<(Rounding, u32)>,
) -> Tally {
    let grid = *source.map.grid();
    let mut pass = Pass {
        grid,
        display: visibility.grid(),
        first,
        behind: (threshold(edge_threshold, source.map.record().depth().bits.into()) >> 1) as u16,
        tally: Tally::default(),
        steps: Steps::new(source, step),
        visibility,
    };
    let (mut chunk, mut samples) = (Chunk::new(), Samples::new());
    let mut shown =
        Shown { field: [0; CHUNK], places: [0; CHUNK], keys: [0; CHUNK], words: [0; CHUNK], boundary: [0; CHUNK] };
    for (y, &start) in grid.starts().iter().enumerate() {
        let mut x = 0;
        while x < grid.width() {
            let cells = (grid.width() - x).min(CHUNK as u32);
            (chunk.x, chunk.y, chunk.source, chunk.cells) = (x as i32, y as i32, start + x, cells as usize);
            pass.chunk(&mut chunk, &mut samples, &mut shown);
            x += cells;
        }
        if let Some(above) = y.checked_sub(1) {
            pass.quads(above);
        }
    }
    Tally { saturated: pass.steps.saturated, ..pass.tally }
}

impl<F: Format> Pass<'_, '_, '_, '_, F> {
    /// Steps and shows the samples of a chunk.
    #[inline(always)]
    fn chunk(&mut self, chunk: &mut Chunk, samples: &mut Samples, shown: &mut Shown) {
        let Some(mixed) = self.steps.chunk(chunk, samples) else { return };
        if mixed {
            self.entries::<true>(chunk, samples, shown);
        } else {
            self.entries::<false>(chunk, samples, shown);
        }
        self.show_runs(chunk, samples, shown);
    }

    /// Makes the entries of a chunk, and keeps the places of its samples.
    #[inline(always)]
    fn entries<const MIXED: bool>(&mut self, chunk: &Chunk, samples: &Samples, shown: &mut Shown) {
        let format = self.steps.source.map.format();
        let record = format.record();
        let depth_bits = u32::from(record.depth().bits);
        let deepest = (1 << depth_bits) - 1;
        let behind = self.behind;
        for lane in 0..CHUNK {
            shown.keys[lane] = depth(chunk.keys[lane] & deepest, depth_bits) as u16;
        }
        for key in &mut shown.keys {
            // Neither the sum nor twice the smaller one has more than 16 bits.
            let depth = *key + behind;
            let depth = depth - depth.saturating_sub(FARTHEST as u16);
            *key = depth << 1 | Kind::Point as u16;
        }
        if MIXED {
            for (key, there) in shown.keys.iter_mut().zip(&samples.there) {
                *key |= !there as u16;
            }
        }
        let number = self.first + chunk.source;
        let width = self.grid.width() as usize;
        let (x, half) = (chunk.x as usize, (chunk.y as usize & 1) * 2 * width);
        let (_, _, line) = self.visibility.planes();
        const MASK: u32 = (1 << RESIDUAL_BITS) - 1;
        for (component, field) in [record.offset_x(), record.offset_y()].into_iter().enumerate() {
            let frac = u32::from(field.bits);
            unpack(field, &chunk.words, &mut shown.field, |extract, upper, lower| extract.signed(upper, lower));
            for lane in 0..CHUNK {
                let offset = shown.field[lane];
                let residual = parts::<PARTS>(offset, frac).wrapping_neg() as u32 & MASK;
                shown.words[lane] = if component == 0 {
                    number.wrapping_add(lane as u32) << (2 * RESIDUAL_BITS) | residual << RESIDUAL_BITS
                } else {
                    shown.words[lane] | residual
                };
                let cells = displacement(samples.displacements[lane])[component];
                shown.places[lane] = ((cells << CORNER_PARTS) + parts::<CORNER_PARTS>(offset, frac)) as u16;
            }
            let at = half + component * width + x;
            let places = line.get_mut(at..at + chunk.cells).unwrap_or_default();
            for (to, &place) in places.iter_mut().zip(&shown.places) {
                *to = place;
            }
        }
    }

    /// Shows a chunk run by run.
    #[inline(always)]
    fn show_runs(&mut self, chunk: &Chunk, samples: &Samples, shown: &mut Shown) {
        let cells = chunk.cells;
        let Samples { there, displacements, .. } = samples;
        let (first, first_there) = (displacements[0], there[0]);
        let mut apart = 0;
        for lane in 0..CHUNK {
            apart |= displacements[lane] ^ first | there[lane] ^ first_there;
        }
        if apart == 0 && cells == CHUNK {
            self.show_run(chunk, samples, shown, 0..cells);
            return;
        }
        let boundary = &mut shown.boundary;
        for lane in 1..CHUNK {
            boundary[lane] =
                (displacements[lane] ^ displacements[lane - 1]) as i32 | (there[lane] ^ there[lane - 1]) as i32;
        }
        let mut lane = 0;
        while lane < cells {
            let end = lane + 1 + run_length(shown.boundary.get(lane + 1..cells).unwrap_or_default());
            self.show_run(chunk, samples, shown, lane..end);
            lane = end;
        }
    }

    /// Shows a run of samples with equal displacements.
    #[inline(always)]
    fn show_run(&mut self, chunk: &Chunk, samples: &Samples, shown: &Shown, lanes: Range<usize>) {
        let (Some(&there), Some(&word)) = (samples.there.get(lanes.start), samples.displacements.get(lanes.start))
        else {
            return;
        };
        if there == 0 {
            return;
        }
        let count = lanes.len();
        self.tally.moved += count as u32;
        let [dx, dy] = displacement(word);
        let to_x = chunk.x + lanes.start as i32 + dx;
        let Some(row) = self.display.row(chunk.y + dy) else {
            self.tally.lost += count as u32;
            return;
        };
        // Lanes that leave the map at the left and at the right are cut off.
        let before = (-to_x).max(0) as usize;
        let beyond = (to_x + count as i32 - self.display.width() as i32).max(0) as usize;
        if before + beyond >= count {
            self.tally.lost += count as u32;
            return;
        }
        self.tally.lost += (before + beyond) as u32;
        let lanes = lanes.start + before..lanes.end - beyond;
        let cell = (row + (to_x + before as i32) as u32) as usize;
        let cells = cell..cell + lanes.len();
        let (keys, words, _) = self.visibility.planes();
        let (Some(keys), Some(words)) = (keys.get_mut(cells.clone()), words.get_mut(cells)) else { return };
        let (Some(own_keys), Some(own_words)) = (shown.keys.get(lanes.clone()), shown.words.get(lanes)) else { return };
        if keys.iter().fold(EMPTY, |all, key| all & key) == EMPTY {
            for (to, &key) in keys.iter_mut().zip(own_keys) {
                *to = key;
            }
            for (to, &word) in words.iter_mut().zip(own_words) {
                *to = word;
            }
            return;
        }
        // In raster order the incumbent of an equal key has the smaller number.
        for (((to_key, to_word), &key), &word) in keys.iter_mut().zip(words).zip(own_keys).zip(own_words) {
            let wins = key < *to_key;
            *to_word = if wins { word } else { *to_word };
            *to_key = if wins { key } else { *to_key };
        }
    }

    /// Shows the stretched quads between row `y` and the next one.
    #[inline(always)]
    fn quads(&mut self, y: usize) {
        /// Quads that are looked at at a time.
        const RUN: usize = 32;
        const CELL: u16 = 1 << CORNER_PARTS;
        const LONGEST: u16 = STRETCHED as u16;
        let width = self.grid.width() as usize;
        let Some(start) = self.grid.row(y as i32) else { return };
        let mut x = 0;
        while x + 1 < width {
            let run = (width - 1 - x).min(RUN);
            let (_, _, line) = self.visibility.planes();
            let places = |y: usize, component: usize, x: usize| {
                let at = (y & 1) * 2 * width + component * width + x;
                line.get(at..at + run).unwrap_or_default()
            };
            let mut flags = [0; RUN];
            for component in 0..2 {
                let lanes =
                    places(y, component, x).iter().zip(places(y, component, x + 1)).zip(places(y + 1, component, x));
                // How much a side may differ from that of a quad of one cell. A side that is longer by a multiple of
                // 2^16 parts is not flagged: such a quad is too large to be drawn.
                let [across, down] = if component == 0 { [CELL, 0] } else { [0, CELL] };
                for (((&own, &right), &below), flag) in lanes.zip(&mut flags) {
                    let beyond = |side: u16| side.wrapping_add(LONGEST).saturating_sub(2 * LONGEST);
                    *flag |= beyond(right.wrapping_sub(own).wrapping_add(across));
                    *flag |= beyond(below.wrapping_sub(own).wrapping_add(down));
                }
            }
            let any = flags.iter().fold(0, |any, flag| any | flag);
            if any != 0 {
                for (lane, _) in flags.iter().enumerate().take(run).filter(|(_, flag)| **flag != 0) {
                    let cell = start + (x + lane) as u32;
                    if self.steps.source.links().quad::<false>(cell) {
                        let place = [(x + lane) as i32, y as i32];
                        let quad = Quad { first: self.first, place, cell, mask: u32::MAX };
                        draw_one::<F, false>(self.steps.source, self.visibility, quad);
                    }
                }
            }
            x += run;
        }
    }
}
