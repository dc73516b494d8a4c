//! Steps samples in place and shows them, chunk by chunk.
//!
//! Neighbours mostly move alike: a run of samples with equal displacements is shown as a whole. A chunk that a step
//! does not change is not written back. The places of two rows are kept, so that of all quads only the stretched ones
//! are looked at.

use core::ops::Range;

use crate::fast::wide::planes::unpack;
use crate::fast::wide::{CHUNK, Chunk, is_unchanged, lanes_of, motion_bits, run_length, step_chunk};
use crate::format::Format;
use crate::format::record::{MAX_WORDS, Words};
use crate::format::rounding::Rounding;
use crate::frame::resolve;
use crate::frame::step::{advance, parts, thresholds};
use crate::frame::tally::Tally;
use crate::layers::displacement;
use crate::map::grid::Grid;
use crate::source::Source;
use crate::source::layer::{CORNER_PARTS, moved};
use crate::source::quads::{self, STRETCHED};
use crate::source::visibility::{EMPTY, FARTHEST, Kind, PARTS, RESIDUAL_BITS, Visibility, depth, threshold};

/// What a chunk shows. The memory is reused for all chunks.
struct Shown {
    /// All ones for galpixels, else 0.
    there: [u32; CHUNK],
    /// Displacements after the step.
    displacements: [u32; CHUNK],
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
    source: &'s mut Source<'p, F>,
    visibility: &'v mut Visibility<'w>,
    grid: Grid<'p>,
    /// The number of the first sample.
    first: u32,
    /// How far points lie behind quads.
    behind: u16,
    thresholds: Option<[i32; 3]>,
    motion_bits: Words,
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
    let format = source.map.format();
    let record = format.record();
    let grid = *source.map.grid();
    let mut pass = Pass {
        grid,
        first,
        behind: (threshold(edge_threshold, record.depth().bits.into()) >> 1) as u16,
        thresholds: step.map(|(rounding, frame)| thresholds(record, rounding, frame)),
        motion_bits: motion_bits(record),
        tally: Tally::default(),
        source,
        visibility,
    };
    let mut chunk = Chunk::new();
    let mut tail = [[0; CHUNK]; MAX_WORDS];
    let mut shown = Shown {
        there: [0; CHUNK],
        displacements: [0; CHUNK],
        field: [0; CHUNK],
        places: [0; CHUNK],
        keys: [0; CHUNK],
        words: [0; CHUNK],
        boundary: [0; CHUNK],
    };
    for (y, &start) in grid.starts().iter().enumerate() {
        let mut x = 0;
        while x < grid.width() {
            let cells = (grid.width() - x).min(CHUNK as u32);
            (chunk.x, chunk.y, chunk.source, chunk.cells) = (x as i32, y as i32, start + x, cells as usize);
            pass.chunk(&mut chunk, &mut shown, &mut tail);
            x += cells;
        }
        if let Some(above) = y.checked_sub(1) {
            pass.quads(above);
        }
    }
    pass.tally
}

impl<F: Format> Pass<'_, '_, '_, '_, F> {
    /// Steps and shows the samples of a chunk.
    #[inline(always)]
    fn chunk(&mut self, chunk: &mut Chunk, shown: &mut Shown, tail: &mut [[u32; CHUNK]; MAX_WORDS]) {
        if self.source.map.all_empty(chunk.range()) {
            return;
        }
        let stepped = self.step(chunk, tail);
        let depth_bits = self.source.map.record().depth().bits;
        let classes = chunk.keys.iter().fold(0, |any, key| any | key);
        let mixed = chunk.cells < CHUNK || classes >> depth_bits != 0;
        if mixed {
            for (lane, (there, key)) in shown.there.iter_mut().zip(&chunk.keys).enumerate() {
                *there = if key >> depth_bits == 0 && lane < chunk.cells { u32::MAX } else { 0 };
            }
        } else {
            shown.there = [u32::MAX; CHUNK];
        }
        if let Some(overflowed) = stepped {
            if overflowed != 0 {
                self.step_clamped(chunk, shown);
            }
            self.write_back(chunk, shown, mixed);
        }
        self.displace(chunk, shown, stepped.is_some());
        if mixed {
            self.entries::<true>(chunk, shown);
        } else {
            self.entries::<false>(chunk, shown);
        }
        self.show_runs(chunk, shown);
    }

    /// Steps a chunk, whose words and keys are then known. Returns `None` if a step changes nothing, else a number that
    /// is not 0 if a field of any sample overflowed.
    #[inline(always)]
    fn step(&mut self, chunk: &mut Chunk, tail: &mut [[u32; CHUNK]; MAX_WORDS]) -> Option<i32> {
        let format = self.source.map.format();
        let record = format.record();
        let mut sources = [&[0; CHUNK]; MAX_WORDS];
        for ((lanes, plane), tail) in sources.iter_mut().zip(self.source.map.planes()).zip(tail).take(record.words()) {
            *lanes = lanes_of(plane, chunk.source, chunk.cells, tail);
        }
        if let Some(thresholds) = &self.thresholds
            && !is_unchanged(record, &sources, &self.motion_bits, chunk.cells)
        {
            return Some(step_chunk::<F>(record, thresholds, &sources, chunk));
        }
        chunk.set_unchanged(record, &sources);
        None
    }

    /// Writes the words of a chunk, if it is `mixed` only those of galpixels.
    #[inline(always)]
    fn write_back(&mut self, chunk: &Chunk, shown: &Shown, mixed: bool) {
        let words = self.source.map.record().words();
        for (plane, lanes) in self.source.map.planes_mut().iter_mut().zip(&chunk.words).take(words) {
            let Some(plane) = plane.get_mut(chunk.range()) else { return };
            match plane.first_chunk_mut::<CHUNK>() {
                Some(plane) if !mixed => *plane = *lanes,
                _ => {
                    for ((to, &lane), &there) in plane.iter_mut().zip(lanes).zip(&shown.there) {
                        *to = *to & !there | lane & there;
                    }
                }
            }
        }
    }

    /// Adds the cells that a chunk moved to its displacements.
    #[inline(always)]
    fn displace(&mut self, chunk: &Chunk, shown: &mut Shown, stepped: bool) {
        /// The signs of the two numbers of a word.
        const SIGNS: u32 = 0x8000_8000;
        let Some(displacements) = self.source.displacements.get_mut(chunk.range()) else { return };
        match displacements.first_chunk::<CHUNK>() {
            Some(chunk) => shown.displacements = *chunk,
            None => {
                for (to, &word) in shown.displacements.iter_mut().zip(&*displacements) {
                    *to = word;
                }
            }
        }
        if !stepped {
            return;
        }
        let mut overflowed = 0;
        for lane in 0..CHUNK {
            // Both numbers of a word at once: the sum of all bits but the signs, and then the signs.
            let word = shown.displacements[lane];
            let step = (chunk.dx[lane] as u32 & 0xffff | (chunk.dy[lane] as u32) << 16) & shown.there[lane];
            let sum = (word & !SIGNS).wrapping_add(step & !SIGNS) ^ (word ^ step) & SIGNS;
            overflowed |= (word ^ sum) & !(word ^ step) & SIGNS;
            // A step of more cells than a number holds.
            let far = chunk.dx[lane].wrapping_add(1 << 15) | chunk.dy[lane].wrapping_add(1 << 15);
            overflowed |= far as u32 >> 16 & shown.there[lane];
            shown.displacements[lane] = sum;
        }
        if overflowed != 0 {
            self.displace_clamped(chunk, shown);
        }
        let Some(displacements) = self.source.displacements.get_mut(chunk.range()) else { return };
        match displacements.first_chunk_mut::<CHUNK>() {
            Some(chunk) => *chunk = shown.displacements,
            None => {
                for (to, &word) in displacements.iter_mut().zip(&shown.displacements) {
                    *to = word;
                }
            }
        }
    }

    /// Repeats [`Self::displace`] with clamps. Rare.
    #[cold]
    #[inline(never)]
    fn displace_clamped(&mut self, chunk: &Chunk, shown: &mut Shown) {
        let before = self.source.displacements.get(chunk.range()).unwrap_or_default();
        let lanes = before.iter().zip(&mut shown.displacements).zip(&shown.there).zip(chunk.dx.iter().zip(&chunk.dy));
        for (((&before, after), &there), (dx, dy)) in lanes {
            if there == 0 {
                continue;
            }
            let [x, y] = displacement(before);
            let clamped;
            (*after, clamped) = moved([x + dx, y + dy]);
            self.tally.saturated += clamped;
        }
    }

    /// Repeats the steps of a chunk with clamps. The displacements are already correct. Rare.
    #[cold]
    #[inline(never)]
    fn step_clamped(&mut self, chunk: &mut Chunk, shown: &Shown) {
        let format = self.source.map.format();
        let record = format.record();
        let Some(thresholds) = &self.thresholds else { return };
        for (lane, cell) in (chunk.source..).take(chunk.cells).enumerate() {
            let Some(mut words) = self.source.map.words_at(cell) else { return };
            if shown.there.get(lane).is_none_or(|&there| there == 0) {
                continue;
            }
            let step = advance::<true>(record, thresholds, &mut words);
            self.tally.saturated += step.saturated();
            if let Some(key) = chunk.keys.get_mut(lane) {
                *key = resolve::key(record, &words);
            }
            for (word, lanes) in words.iter().zip(&mut chunk.words) {
                if let Some(to) = lanes.get_mut(lane) {
                    *to = *word;
                }
            }
        }
    }

    /// Makes the entries of a chunk, and keeps the places of its samples.
    #[inline(always)]
    fn entries<const MIXED: bool>(&mut self, chunk: &Chunk, shown: &mut Shown) {
        let format = self.source.map.format();
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
            for (key, there) in shown.keys.iter_mut().zip(&shown.there) {
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
                let cells = displacement(shown.displacements[lane])[component];
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
    fn show_runs(&mut self, chunk: &Chunk, shown: &mut Shown) {
        let cells = chunk.cells;
        let (first, first_there) = (shown.displacements[0], shown.there[0]);
        let mut apart = 0;
        for lane in 0..CHUNK {
            apart |= shown.displacements[lane] ^ first | shown.there[lane] ^ first_there;
        }
        if apart == 0 && cells == CHUNK {
            self.show_run(chunk, shown, 0..cells);
            return;
        }
        let Shown { displacements, there, boundary, .. } = &mut *shown;
        for lane in 1..CHUNK {
            boundary[lane] =
                (displacements[lane] ^ displacements[lane - 1]) as i32 | (there[lane] ^ there[lane - 1]) as i32;
        }
        let mut lane = 0;
        while lane < cells {
            let end = lane + 1 + run_length(shown.boundary.get(lane + 1..cells).unwrap_or_default());
            self.show_run(chunk, shown, lane..end);
            lane = end;
        }
    }

    /// Shows a run of samples with equal displacements.
    #[inline(always)]
    fn show_run(&mut self, chunk: &Chunk, shown: &Shown, lanes: Range<usize>) {
        let (Some(&there), Some(&word)) = (shown.there.get(lanes.start), shown.displacements.get(lanes.start)) else {
            return;
        };
        if there == 0 {
            return;
        }
        let count = lanes.len();
        self.tally.moved += count as u32;
        let [dx, dy] = displacement(word);
        let to_x = chunk.x + lanes.start as i32 + dx;
        let Some(row) = self.grid.row(chunk.y + dy) else {
            self.tally.lost += count as u32;
            return;
        };
        // Lanes that leave the map at the left and at the right are cut off.
        let before = (-to_x).max(0) as usize;
        let beyond = (to_x + count as i32 - self.grid.width() as i32).max(0) as usize;
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
                    if self.source.links().quad(cell) {
                        let place = [(x + lane) as i32, y as i32];
                        quads::draw_one(self.source, self.visibility, self.first, place, cell);
                    }
                }
            }
            x += run;
        }
    }
}
