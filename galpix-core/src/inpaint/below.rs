//! The tones of a picture, pulled where they are asked for.

use super::block::{ACROSS, HALF, LEVELS, Part, halved, keep, pull_up};
use super::demand::Base;
use super::mean::tie;
use super::metamer::Scene;
use super::push_pull::{Rule, pulled};
use super::pyramid::{Known, Pyramid};
use super::tile::Row;
use super::tone::Tone;
use super::validity::FULL;

/// Level 0 of the tones: the picture.
#[derive(Debug)]
pub struct Below<'p, P>(pub &'p P);

impl<P: Scene> Below<'_, P> {
    /// Eight cells of level 1, from `left` on.
    #[inline(always)]
    fn line(&self, left: u32, y: u32, rule: &Rule, cells: &mut [Known<Tone>]) {
        let [width, height] = self.0.size();
        let top = y << 1;
        if top >= height {
            return;
        }
        let (mut upper, mut lower) = (Row::default(), Row::default());
        self.0.row(2 * left, top, &mut upper);
        if top + 1 < height {
            self.0.row(2 * left, top + 1, &mut lower);
        }
        for ((i, x), to) in (left..width.div_ceil(2)).enumerate().zip(cells) {
            let (left, right) = (2 * i, 2 * i + 1);
            let [a, b, c, d] = [upper.depths[left], upper.depths[right], lower.depths[left], lower.depths[right]];
            let depth = a.max(b).max(c.max(d)) as u32;
            let known = upper.known[left] & upper.known[right] & lower.known[left] & lower.known[right];
            let inside = 2 * x + 1 < width && top + 1 < height;
            *to = if inside && known != 0 && depth - a.min(b).min(c.min(d)) as u32 <= rule.threshold {
                let mut tone = Tone { channels: [0; 3], source: self.0.source(2 * x, top) };
                for ((to, upper), lower) in tone.channels.iter_mut().zip(&upper.channels).zip(&lower.channels) {
                    let sum = upper[left] + upper[right] + lower[left] + lower[right];
                    *to = (sum + 1 + tie(x, y, 1) as i16) >> 2;
                }
                Known { validity: FULL, depth, value: tone }
            } else {
                let child =
                    |x: u32, y: u32| if x < width && y < height { self.0.known(x, y) } else { Known::default() };
                let (x0, x1) = (2 * x, 2 * x + 1);
                pulled(&[child(x0, top), child(x1, top), child(x0, top + 1), child(x1, top + 1)], rule, tie(x, y, 1))
            };
        }
    }
}

impl<P: Scene> Base<Tone> for Below<'_, P> {
    const LEVELS: u32 = LEVELS;

    /// Pulls some tiles of 8 x 8 cells of level 1 that lie in a row, up to one of level 4 for each. Rows of the picture are long in
    /// memory: that is why they are read far along before the next one is.
    #[inline(never)]
    fn pull(&mut self, pyramid: &mut Pyramid<'_, Tone>, rule: &Rule, x: u32, y: u32) {
        let (start, top) = (x / ACROSS * ACROSS, y >> 3 << 3);
        let end = (start + ACROSS).min(pyramid.levels().level(1).width);
        let tiles = || (start..end).step_by(HALF);
        for y in top..top + HALF as u32 {
            for left in tiles() {
                let mut cells: Part<Tone, 8> = [Known::default(); 8];
                self.line(left, y, rule, &mut cells);
                keep(pyramid, 1, (left, y), 8, &cells);
            }
        }
        for left in tiles() {
            let mut first: Part<Tone, 64> = [Known::default(); 64];
            for (line, y) in first.chunks_exact_mut(8).zip(top..) {
                for (cell, x) in line.iter_mut().zip(left..) {
                    *cell = pyramid.known(pyramid.index(1, x, y));
                }
            }
            let second: Part<Tone, 16> = halved(&first, 4, (left >> 1, top >> 1), 2, rule);
            pull_up(pyramid, rule, (left, top), &second);
        }
    }
}
