//! Gathers the colours of a row, many cells at a time.
//!
//! Neighbouring cells mostly show neighbouring samples: then the colours that are mixed lie in four runs.

use core::ops::Range;

use super::RUN;
use crate::fast::wide::run_length;
use crate::format::Format;
use crate::format::colour::{Channel, Colour, WEIGHTS};
use crate::source::row::{self, GatherRow, gather_cell};
use crate::source::visibility::{EMPTY, PARTS, RESIDUAL_BITS, Visibility};
use crate::source::{Source, layer_of};

/// A cell in the parts in which residuals count.
const CELL: u32 = 1 << PARTS;

/// Gathers the colours of the cells from `start` on that show a sample, see [`crate::source::row::gather_row`].
pub(crate) fn gather_row<F: Format>(
    layers: &[Source<'_, F>],
    visibility: &Visibility<'_>,
    start: u32,
    gather: &GatherRow,
    colours: &mut [u32],
) {
    if !gather.sub_cell {
        return row::gather_row(layers, visibility, start, gather, colours);
    }
    let Some(format) = layers.first().map(|layer| *layer.map.record().colour_format()) else { return };
    let mut run = Run { quads: [0; RUN], across: [0; RUN], down: [0; RUN], samples: [[0; RUN]; 4] };
    for (cell, colours) in (start..).step_by(RUN).zip(colours.chunks_mut(RUN)) {
        let (keys, words) = visibility.cells_from(cell, colours.len());
        let alone = run.look(layers, keys, words);
        run.mix(&format, colours);
        let mut left = alone;
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            let place = [start, cell - start + lane as u32];
            if let (Some(to), Some(colour)) = (colours.get_mut(lane), gather_cell(layers, visibility, place, gather)) {
                *to = colour;
            }
        }
    }
}

/// A run of cells.
struct Run {
    /// The first sample of the quad in which each cell lies, and where in it, in parts of a cell.
    quads: [u32; RUN],
    across: [u32; RUN],
    down: [u32; RUN],
    /// The colours of the quads' samples: the first one, the ones right of it and below it, and the fourth.
    samples: [[u32; RUN]; 4],
}

impl Run {
    /// Finds the samples of a run. Returns a bit for each cell whose colour is not that of a quad; empty cells have
    /// none.
    #[inline(always)]
    fn look<F: Format>(&mut self, layers: &[Source<'_, F>], keys: &[u16], words: &[u32]) -> u32 {
        let Some(width) = layers.first().map(|layer| layer.map.grid().width()) else { return 0 };
        let lanes = self.quads.iter_mut().zip(&mut self.across).zip(&mut self.down);
        for (((quad, across), down), &word) in lanes.zip(words) {
            let (u, v) = (word >> RESIDUAL_BITS, word);
            // A negative residual is that of the quad on the other side.
            let negative = |part: u32| (part >> PARTS & 1).wrapping_neg();
            *quad = (word >> (2 * RESIDUAL_BITS)).wrapping_sub(negative(u) & 1).wrapping_sub(negative(v) & width);
            (*across, *down) = (u & (CELL - 1), v & (CELL - 1));
        }
        let (mut apart, mut all) = (0, 0);
        for lane in 0..RUN {
            apart |= self.quads[lane].wrapping_sub(lane as u32) ^ self.quads[0];
        }
        if let Some(keys) = keys.first_chunk::<RUN>() {
            all = keys.iter().fold(0, |any, &key| any | u16::from(key == EMPTY));
        }
        if apart == 0 && all == 0 && keys.len() == RUN {
            let word = words.first().copied().unwrap_or_default();
            return if self.read_all(layers, word) { 0 } else { u32::MAX };
        }
        self.look_at_each(layers, keys, words)
    }

    /// As [`Self::look`], for cells some of which are empty or do not lie in neighbouring quads.
    #[inline(never)]
    fn look_at_each<F: Format>(&mut self, layers: &[Source<'_, F>], keys: &[u16], words: &[u32]) -> u32 {
        // All ones for cells that are empty, or beyond the end of the row.
        let mut empty = [u32::MAX; RUN];
        for (empty, &key) in empty.iter_mut().zip(keys) {
            *empty = if key == EMPTY { u32::MAX } else { 0 };
        }
        // Not 0 for cells that are not of a run with the cell before: of empty ones, or of quads side by side.
        let mut boundary = [0; RUN];
        for lane in 1..RUN {
            let apart = self.quads[lane].wrapping_sub(self.quads[lane - 1]).wrapping_sub(1);
            let both_empty = empty[lane] & empty[lane - 1];
            boundary[lane] = (apart & !both_empty | empty[lane] ^ empty[lane - 1]) as i32;
        }
        let (mut alone, mut lane) = (0, 0);
        while lane < RUN {
            let end = lane + 1 + run_length(boundary.get(lane + 1..).unwrap_or_default());
            if empty[lane] == 0 {
                let word = words.get(lane).copied().unwrap_or_default();
                if !self.read(layers, word, self.quads[lane], lane..end) {
                    alone |= u32::MAX >> (RUN - (end - lane)) << lane;
                }
            }
            lane = end;
        }
        alone
    }

    /// Reads the samples of neighbouring quads in which all cells of the run lie; returns whether they are quads.
    /// `word` is that of the first cell.
    #[inline(always)]
    fn read_all<F: Format>(&mut self, layers: &[Source<'_, F>], word: u32) -> bool {
        let Some((layer, first, _)) = layer_of(layers, word >> (2 * RESIDUAL_BITS)) else { return false };
        let (quad, width) = (self.quads[0].wrapping_sub(first), layer.map.grid().width());
        if !layer.links().quads_inside(quad, RUN as u32) {
            return false;
        }
        let field = layer.map.record().colour();
        let ((upper, lower), extract) = (field.words(), field.extract());
        for (samples, from) in self.samples.iter_mut().zip([quad, quad + 1, quad + width, quad + width + 1]) {
            let plane = |word: usize| layer.map.planes()[word].get(from as usize..)?.first_chunk::<RUN>();
            let (Some(upper), Some(lower)) = (plane(upper), plane(lower)) else { return false };
            for lane in 0..RUN {
                samples[lane] = extract.unsigned(upper[lane], lower[lane]);
            }
        }
        true
    }

    /// Reads the samples of neighbouring quads; returns whether they are quads. `word` is that of the first cell.
    #[inline(always)]
    fn read<F: Format>(&mut self, layers: &[Source<'_, F>], word: u32, quad: u32, lanes: Range<usize>) -> bool {
        let Some((layer, first, _)) = layer_of(layers, word >> (2 * RESIDUAL_BITS)) else { return false };
        let (quad, count, width) = (quad.wrapping_sub(first), lanes.len() as u32, layer.map.grid().width());
        if !layer.links().quads_inside(quad, count) {
            return false;
        }
        for (samples, from) in self.samples.iter_mut().zip([quad, quad + 1, quad + width, quad + width + 1]) {
            let colours = layer.map.colours(from as usize..(from + count) as usize);
            for (to, colour) in samples.get_mut(lanes.clone()).unwrap_or_default().iter_mut().zip(colours) {
                *to = colour;
            }
        }
        true
    }

    /// Mixes the samples of all cells.
    #[inline(always)]
    fn mix(&self, format: &Colour, colours: &mut [u32]) {
        let [first, second, third] = format.three_channels();
        let mut weights = [[0u16; RUN]; 4];
        let [own_weight, beside_weight, under_weight, corner_weight] = &mut weights;
        for lane in 0..RUN {
            let (x, y) = ((self.across[lane] & (CELL - 1)) as u16, (self.down[lane] & (CELL - 1)) as u16);
            let cell = CELL as u16;
            own_weight[lane] = (cell - x) * (cell - y);
            beside_weight[lane] = x * (cell - y);
            under_weight[lane] = (cell - x) * y;
            corner_weight[lane] = x * y;
        }
        let mut mixed = [0; RUN];
        add_channel(second, &self.samples, &weights, &mut mixed);
        if !format.is_gray() {
            add_channel(first, &self.samples, &weights, &mut mixed);
            add_channel(third, &self.samples, &weights, &mut mixed);
        }
        for (to, &colour) in colours.iter_mut().zip(&mixed) {
            *to = colour;
        }
    }
}

/// Adds the mean of a channel of four colours, by weights.
#[inline(always)]
fn add_channel(channel: Channel, samples: &[[u32; RUN]; 4], weights: &[[u16; RUN]; 4], mixed: &mut [u32; RUN]) {
    const LOG: u32 = WEIGHTS.trailing_zeros();
    let [own, beside, under, corner] = samples;
    let [own_weight, beside_weight, under_weight, corner_weight] = weights;
    // A channel has at most 8 bits, so that its sum has 16.
    let of = |colour: u32| channel.of(colour) as u16;
    for lane in 0..RUN {
        let sum = (WEIGHTS as u16 >> 1)
            .wrapping_add(of(own[lane]).wrapping_mul(own_weight[lane]))
            .wrapping_add(of(beside[lane]).wrapping_mul(beside_weight[lane]))
            .wrapping_add(of(under[lane]).wrapping_mul(under_weight[lane]))
            .wrapping_add(of(corner[lane]).wrapping_mul(corner_weight[lane]));
        mixed[lane] |= u32::from(sum >> LOG) << channel.shift;
    }
}
