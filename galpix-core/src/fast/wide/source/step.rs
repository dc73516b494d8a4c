//! Steps samples in place, chunk by chunk. A chunk that a step does not change is not written back.

use crate::fast::wide::{CHUNK, Chunk, is_unchanged, lanes_of, motion_bits, step_chunk};
use crate::format::Format;
use crate::format::record::{MAX_WORDS, Words};
use crate::format::rounding::Rounding;
use crate::frame::resolve;
use crate::frame::step::{advance, thresholds};
use crate::frame::tally::Tally;
use crate::layers::displacement;
use crate::source::Source;
use crate::source::layer::moved;

/// The samples of a chunk. The memory is reused for all chunks.
pub(super) struct Samples {
    /// All ones for galpixels, else 0.
    pub there: [u32; CHUNK],
    /// Displacements after the step.
    pub displacements: [u32; CHUNK],
    /// Words of a chunk at the end of a row.
    tail: [[u32; CHUNK]; MAX_WORDS],
}

impl Samples {
    pub(super) const fn new() -> Self {
        Self { there: [0; CHUNK], displacements: [0; CHUNK], tail: [[0; CHUNK]; MAX_WORDS] }
    }
}

/// Steps of the samples of a layer.
pub(super) struct Steps<'s, 'p, F> {
    pub source: &'s mut Source<'p, F>,
    thresholds: Option<[i32; 3]>,
    motion_bits: Words,
    /// Fields and components of displacements that were clamped.
    pub saturated: u32,
}

/// Steps the samples of a layer without showing them, see [`Source::step`].
pub(crate) fn step<F: Format>(source: &mut Source<'_, F>, rounding: Rounding, frame: u32) -> Tally {
    let grid = *source.map.grid();
    let mut steps = Steps::new(source, Some((rounding, frame)));
    let (mut chunk, mut samples) = (Chunk::new(), Samples::new());
    let mut moved = 0;
    for (y, &start) in (0..).zip(grid.starts()) {
        let mut x = 0;
        while x < grid.width() {
            let cells = (grid.width() - x).min(CHUNK as u32);
            (chunk.x, chunk.y, chunk.source, chunk.cells) = (x as i32, y, start + x, cells as usize);
            if steps.chunk(&mut chunk, &mut samples).is_some() {
                moved += samples.there.iter().map(|there| there & 1).sum::<u32>();
            }
            x += cells;
        }
    }
    Tally { moved, saturated: steps.saturated, ..Tally::default() }
}

impl<'s, 'p, F: Format> Steps<'s, 'p, F> {
    /// Steps, if a rounding and a frame counter are given.
    pub(super) fn new(source: &'s mut Source<'p, F>, step: Option<(Rounding, u32)>) -> Self {
        let format = source.map.format();
        let record = format.record();
        let thresholds = step.map(|(rounding, frame)| thresholds(record, rounding, frame));
        Self { source, thresholds, motion_bits: motion_bits(record), saturated: 0 }
    }

    /// Steps the samples of a chunk, whose words and keys are then known. Returns whether some of its lanes hold no
    /// samples; `None` if none of them does.
    #[inline(always)]
    pub(super) fn chunk(&mut self, chunk: &mut Chunk, samples: &mut Samples) -> Option<bool> {
        if self.source.map.all_empty(chunk.range()) {
            return None;
        }
        let stepped = self.step(chunk, &mut samples.tail);
        let depth_bits = self.source.map.record().depth().bits;
        let classes = chunk.keys.iter().fold(0, |any, key| any | key);
        let mixed = chunk.cells < CHUNK || classes >> depth_bits != 0;
        if mixed {
            for (lane, (there, key)) in samples.there.iter_mut().zip(&chunk.keys).enumerate() {
                *there = if key >> depth_bits == 0 && lane < chunk.cells { u32::MAX } else { 0 };
            }
        } else {
            samples.there = [u32::MAX; CHUNK];
        }
        if let Some(overflowed) = stepped {
            if overflowed != 0 {
                self.step_clamped(chunk, samples);
            }
            self.write_back(chunk, samples, mixed);
        }
        self.displace(chunk, samples, stepped.is_some());
        Some(mixed)
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
    fn write_back(&mut self, chunk: &Chunk, samples: &Samples, mixed: bool) {
        let words = self.source.map.record().words();
        for (plane, lanes) in self.source.map.planes_mut().iter_mut().zip(&chunk.words).take(words) {
            let Some(plane) = plane.get_mut(chunk.range()) else { return };
            match plane.first_chunk_mut::<CHUNK>() {
                Some(plane) if !mixed => *plane = *lanes,
                _ => {
                    for ((to, &lane), &there) in plane.iter_mut().zip(lanes).zip(&samples.there) {
                        *to = *to & !there | lane & there;
                    }
                }
            }
        }
    }

    /// Adds the cells that a chunk moved to its displacements.
    #[inline(always)]
    fn displace(&mut self, chunk: &Chunk, samples: &mut Samples, stepped: bool) {
        /// The signs of the two numbers of a word.
        const SIGNS: u32 = 0x8000_8000;
        let Some(displacements) = self.source.displacements.get_mut(chunk.range()) else { return };
        match displacements.first_chunk::<CHUNK>() {
            Some(chunk) => samples.displacements = *chunk,
            None => {
                for (to, &word) in samples.displacements.iter_mut().zip(&*displacements) {
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
            let word = samples.displacements[lane];
            let step = (chunk.dx[lane] as u32 & 0xffff | (chunk.dy[lane] as u32) << 16) & samples.there[lane];
            let sum = (word & !SIGNS).wrapping_add(step & !SIGNS) ^ (word ^ step) & SIGNS;
            overflowed |= (word ^ sum) & !(word ^ step) & SIGNS;
            // A step of more cells than a number holds.
            let far = chunk.dx[lane].wrapping_add(1 << 15) | chunk.dy[lane].wrapping_add(1 << 15);
            overflowed |= far as u32 >> 16 & samples.there[lane];
            samples.displacements[lane] = sum;
        }
        if overflowed != 0 {
            self.displace_clamped(chunk, samples);
        }
        let Some(displacements) = self.source.displacements.get_mut(chunk.range()) else { return };
        match displacements.first_chunk_mut::<CHUNK>() {
            Some(chunk) => *chunk = samples.displacements,
            None => {
                for (to, &word) in displacements.iter_mut().zip(&samples.displacements) {
                    *to = word;
                }
            }
        }
    }

    /// Repeats [`Self::displace`] with clamps. Rare.
    #[cold]
    #[inline(never)]
    fn displace_clamped(&mut self, chunk: &Chunk, samples: &mut Samples) {
        let before = self.source.displacements.get(chunk.range()).unwrap_or_default();
        let lanes =
            before.iter().zip(&mut samples.displacements).zip(&samples.there).zip(chunk.dx.iter().zip(&chunk.dy));
        for (((&before, after), &there), (dx, dy)) in lanes {
            if there == 0 {
                continue;
            }
            let [x, y] = displacement(before);
            let clamped;
            (*after, clamped) = moved([x + dx, y + dy]);
            self.saturated += clamped;
        }
    }

    /// Repeats the steps of a chunk with clamps. The displacements are already correct. Rare.
    #[cold]
    #[inline(never)]
    fn step_clamped(&mut self, chunk: &mut Chunk, samples: &Samples) {
        let format = self.source.map.format();
        let record = format.record();
        let Some(thresholds) = &self.thresholds else { return };
        for (lane, cell) in (chunk.source..).take(chunk.cells).enumerate() {
            let Some(mut words) = self.source.map.words_at(cell) else { return };
            if samples.there.get(lane).is_none_or(|&there| there == 0) {
                continue;
            }
            let step = advance::<true>(record, thresholds, &mut words);
            self.saturated += step.saturated();
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
}
