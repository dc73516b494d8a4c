//! Gathers the colours of a row, many cells at a time.
//!
//! Neighbouring cells mostly show neighbouring samples: then all colours that are mixed lie in two runs, one below the
//! other. Each is split into its channels once, for both cells that a sample takes part in.

use core::ops::Range;

use super::RUN;
use crate::format::Format;
use crate::format::colour::WEIGHTS;
use crate::source::row::{self, GatherRow, gather_cell};
use crate::source::visibility::{EMPTY, PARTS, RESIDUAL_BITS, Visibility};
use crate::source::{Source, layer_of};

/// A cell in the parts in which residuals count.
const SIDE: u16 = 1 << PARTS;

/// Cells that are looked at at a time where those of a run do not show neighbours.
const PART: usize = 8;

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
    let mut pass = Pass { layers, samples: [[[0; RUN + 1]; 3]; 2] };
    let count = colours.len();
    let mut x = 0;
    while x < count {
        let end = (x + RUN).min(count);
        let Some(run) = colours.get_mut(x..end) else { return };
        let (keys, words) = visibility.cells_from(start + x as u32, run.len());
        if pass.whole(keys, words, run) {
            x = end;
        }
        while x < end {
            let Some(part) = colours.get_mut(x..(x + PART).min(end)) else { return };
            let (keys, words) = visibility.cells_from(start + x as u32, part.len());
            let alone = pass.in_runs(keys, words, part);
            for (lane, to) in (0..).zip(part).filter(|(lane, _)| alone >> lane & 1 != 0) {
                if let Some(colour) = gather_cell(layers, visibility, [start, x as u32 + lane], gather) {
                    *to = colour;
                }
            }
            x += PART;
        }
    }
}

/// Some cells, each within a quad of four samples.
struct Cells<const N: usize> {
    /// The first sample of the quad.
    quads: [u32; N],
    /// The low halves of the words, with the residuals.
    residuals: [u16; N],
    /// The columns of the layer whose samples they are taken for. Of a run that proves to lie inside of that layer all
    /// are.
    width: u32,
}

impl<const N: usize> Cells<N> {
    /// Takes the words of their entries, as those of samples of a layer.
    #[inline(always)]
    fn new<F: Format>(words: &[u32; N], layer: &Source<'_, F>) -> Self {
        let width = layer.map.grid().width();
        let mut cells = Self { quads: [0; N], residuals: [0; N], width };
        for (quad, &word) in cells.quads.iter_mut().zip(words) {
            // A negative residual is that of the quad on the other side.
            let negative = |bit: u32| (word >> bit & 1).wrapping_neg();
            let right = (word >> (2 * RESIDUAL_BITS)).wrapping_add(negative(RESIDUAL_BITS + PARTS));
            *quad = right.wrapping_sub(negative(PARTS) & width);
        }
        for (residuals, &word) in cells.residuals.iter_mut().zip(words) {
            *residuals = word as u16;
        }
        cells
    }

    /// Returns the weights of the four samples of each cell's quad.
    #[inline(always)]
    fn weights(&self) -> [[u16; N]; 4] {
        let mut weights = [[0; N]; 4];
        let [own, beside, under, corner] = &mut weights;
        for lane in 0..N {
            let part = |residual: u16| residual & (SIDE - 1);
            let (x, y) = (part(self.residuals[lane] >> RESIDUAL_BITS), part(self.residuals[lane]));
            corner[lane] = x * y;
            own[lane] = SIDE * SIDE + corner[lane] - SIDE * (x + y);
            beside[lane] = SIDE * x - corner[lane];
            under[lane] = SIDE * y - corner[lane];
        }
        weights
    }

    /// Returns whether the cells lie in neighbouring quads.
    #[inline(always)]
    fn are_neighbours(&self) -> bool {
        let mut apart = 0;
        for lane in 0..N {
            apart |= self.quads[lane].wrapping_sub(lane as u32) ^ self.quads[0];
        }
        apart == 0
    }
}

/// A pass over the cells of a row.
struct Pass<'r, 'p, F> {
    layers: &'r [Source<'p, F>],
    /// Samples of two rows that lie one below the other, by row, channel and column.
    samples: [[[u16; RUN + 1]; 3]; 2],
}

impl<F: Format> Pass<'_, '_, F> {
    /// Gathers a run, if all cells show samples and lie in neighbouring quads; returns whether it did.
    #[inline(always)]
    fn whole(&mut self, keys: &[u16], words: &[u32], colours: &mut [u32]) -> bool {
        let (Some(keys), Some(words), Some(colours)) =
            (keys.first_chunk::<RUN>(), words.first_chunk::<RUN>(), colours.first_chunk_mut::<RUN>())
        else {
            return false;
        };
        let Some((layer, first, _)) = layer_of(self.layers, words[0] >> (2 * RESIDUAL_BITS)) else { return false };
        let cells = Cells::new(words, layer);
        let empty = keys.iter().fold(0, |any, &key| any | u16::from(key == EMPTY));
        empty == 0 && cells.are_neighbours() && self.mix(&cells, (layer, first), 0..RUN, colours)
    }

    /// Gathers a part of a run; returns a bit for each cell that must be gathered alone.
    #[inline(never)]
    fn in_runs(&mut self, keys: &[u16], words: &[u32], colours: &mut [u32]) -> u32 {
        let (Some(keys), Some(words), Some(colours)) =
            (keys.first_chunk::<PART>(), words.first_chunk::<PART>(), colours.first_chunk_mut::<PART>())
        else {
            return u32::MAX >> (u32::BITS as usize - keys.len());
        };
        let Some(base) = self.layers.first() else { return 0 };
        let mut cells = Cells::new(words, base);
        let (mut alone, mut lane) = (0, 0);
        while let (Some(&key), Some(&word)) = (keys.get(lane), words.get(lane)) {
            let Some((layer, first, _)) = layer_of(self.layers, word >> (2 * RESIDUAL_BITS)).filter(|_| key != EMPTY)
            else {
                lane += 1;
                continue;
            };
            if layer.map.grid().width() != cells.width {
                cells = Cells::new(words, layer);
            }
            let next = |&end: &usize| match (cells.quads.get(end - 1), cells.quads.get(end), keys.get(end)) {
                (Some(before), Some(quad), Some(&key)) => quad.wrapping_sub(*before) == 1 && key != EMPTY,
                _ => false,
            };
            let end = lane + 1 + (lane + 1..PART).take_while(next).count();
            if !self.mix(&cells, (layer, first), lane..end, colours) {
                alone |= (1 << end) - (1 << lane);
            }
            lane = end;
        }
        alone
    }

    /// Gathers the cells of some lanes, which lie in neighbouring quads of a layer; returns whether these are quads.
    /// `first` is the number of the layer's first sample.
    #[inline(never)]
    fn mix<const N: usize>(
        &mut self,
        cells: &Cells<N>,
        (layer, first): (&Source<'_, F>, u32),
        lanes: Range<usize>,
        colours: &mut [u32; N],
    ) -> bool {
        let quad = cells.quads.get(lanes.start).copied().unwrap_or_default().wrapping_sub(first);
        if !layer.links().quads_inside(quad, lanes.len() as u32) {
            return false;
        }
        let quad = quad.wrapping_sub(lanes.start as u32);
        if !self.read::<N>(layer, quad) {
            return false;
        }
        let [own_weight, beside_weight, under_weight, corner_weight] = cells.weights();
        let [upper, lower] = &self.samples;
        let format = layer.map.record().colour_format();
        let channels = if format.is_gray() { 1 } else { 3 };
        let mut means = [[0u16; N]; 3];
        for ((upper, lower), means) in upper.iter().zip(lower).zip(&mut means).take(channels) {
            let (Some(own), Some(under)) = (upper.first_chunk::<N>(), lower.first_chunk::<N>()) else { return false };
            let [_, upper @ ..] = upper;
            let [_, lower @ ..] = lower;
            let (Some(beside), Some(corner)) = (upper.first_chunk::<N>(), lower.first_chunk::<N>()) else {
                return false;
            };
            for lane in 0..N {
                // A channel has at most 8 bits, so that the sum has 16.
                let sum = (WEIGHTS as u16 >> 1)
                    .wrapping_add(own[lane].wrapping_mul(own_weight[lane]))
                    .wrapping_add(beside[lane].wrapping_mul(beside_weight[lane]))
                    .wrapping_add(under[lane].wrapping_mul(under_weight[lane]))
                    .wrapping_add(corner[lane].wrapping_mul(corner_weight[lane]));
                means[lane] = sum >> WEIGHTS.trailing_zeros();
            }
        }
        let mut mixed = [0; N];
        let [first, second, third] = format.three_channels().map(|channel| channel.shift);
        let [firsts, seconds, thirds] = &means;
        for lane in 0..N {
            let word = |means: &[u16; N], shift: u32| u32::from(means[lane]) << shift;
            let one = word(firsts, first);
            mixed[lane] = if channels == 1 { one } else { one | word(seconds, second) | word(thirds, third) };
        }
        match (lanes.len() == N, colours.get_mut(lanes.clone()), mixed.get(lanes)) {
            (false, Some(colours), Some(mixed)) => {
                for (to, &colour) in colours.iter_mut().zip(mixed) {
                    *to = colour;
                }
            }
            _ => *colours = mixed,
        }
        true
    }

    /// Reads the samples of `N` neighbouring quads; returns whether all lie in the map.
    #[inline(always)]
    fn read<const N: usize>(&mut self, layer: &Source<'_, F>, quad: u32) -> bool {
        let field = layer.map.record().colour();
        let ((upper, lower), extract) = (field.words(), field.extract());
        let channels = layer.map.record().colour_format().three_channels();
        for (samples, from) in self.samples.iter_mut().zip([quad, quad.wrapping_add(layer.map.grid().width())]) {
            let plane = |word: usize| layer.map.planes().get(word)?.get(from as usize..)?.split_first_chunk::<N>();
            let (Some((upper, [upper_last, ..])), Some((lower, [lower_last, ..]))) = (plane(upper), plane(lower))
            else {
                return false;
            };
            let mut colours = [0; RUN + 1];
            for lane in 0..N {
                colours[lane] = extract.unsigned(upper[lane], lower[lane]);
            }
            colours[N] = extract.unsigned(*upper_last, *lower_last);
            for (channel, samples) in channels.into_iter().zip(samples) {
                for lane in 0..N {
                    samples[lane] = channel.of(colours[lane]) as u16;
                }
                samples[N] = channel.of(colours[N]) as u16;
            }
        }
        true
    }
}
