//! Level 0 of the tones: the picture, pulled tile by tile where it is needed.

use super::block::{ACROSS, HALF, LEVELS, Part, halved, keep, pull_up};
use super::scene::Scene;
use super::surroundings::Row;
use super::tone::Tone;
use crate::inpaint::kernel::{Known, pulled};
use crate::inpaint::lazy::Base;
use crate::inpaint::mean::tie;
use crate::inpaint::pyramid::Pyramid;
use crate::inpaint::settings::Inpainting;
use crate::inpaint::validity::FULL;

/// A scene under the pyramid of its tones.
#[derive(Debug)]
pub struct Tones<'p, S> {
    /// The scene.
    pub scene: &'p S,
    /// By what tones are pulled and pushed.
    pub inpainting: &'p Inpainting<'p>,
}

impl<S: Scene> Tones<'_, S> {
    /// Pulls eight cells of level 1, from `left` on.
    #[inline(always)]
    fn pull_line(&self, left: u32, y: u32, cells: &mut [Known<Tone>]) {
        let Self { scene, inpainting } = self;
        let [width, height] = scene.size();
        let top = y << 1;
        if top >= height {
            return;
        }
        let (mut upper, mut lower) = (Row::default(), Row::default());
        scene.row(2 * left, top, &mut upper);
        if top + 1 < height {
            scene.row(2 * left, top + 1, &mut lower);
        }
        for ((i, x), to) in (left..width.div_ceil(2)).enumerate().zip(cells) {
            let (left, right) = (2 * i, 2 * i + 1);
            let [a, b, c, d] = [upper.depths[left], upper.depths[right], lower.depths[left], lower.depths[right]];
            let depth = a.max(b).max(c.max(d)) as u32;
            let known = upper.known[left] & upper.known[right] & lower.known[left] & lower.known[right];
            let inside = 2 * x + 1 < width && top + 1 < height;
            *to = if inside && known != 0 && depth - a.min(b).min(c.min(d)) as u32 <= inpainting.threshold {
                let mut tone = Tone { channels: [0; 3], source: scene.source(2 * x, top) };
                for ((to, upper), lower) in tone.channels.iter_mut().zip(&upper.channels).zip(&lower.channels) {
                    let sum = upper[left] + upper[right] + lower[left] + lower[right];
                    *to = (sum + 1 + tie(x, y, 1) as i16) >> 2;
                }
                Known { validity: FULL, depth, value: tone }
            } else {
                let child = |x: u32, y: u32| if x < width && y < height { scene.known(x, y) } else { Known::default() };
                let (x0, x1) = (2 * x, 2 * x + 1);
                pulled(
                    &[child(x0, top), child(x1, top), child(x0, top + 1), child(x1, top + 1)],
                    inpainting,
                    tie(x, y, 1),
                )
            };
        }
    }
}

impl<S: Scene> Base<Tone> for Tones<'_, S> {
    const LEVELS: u32 = LEVELS;

    #[inline(always)]
    fn inpainting(&self) -> &Inpainting<'_> {
        self.inpainting
    }

    /// Pulls some tiles of 8 x 8 cells of level 1 that lie in a row, up to one of level 4 for each. Rows of the picture
    /// are long in memory: that is why they are read far along before the next one is.
    #[inline(never)]
    fn pull(&mut self, pyramid: &mut Pyramid<'_, Tone>, level: u32, x: u32, y: u32) {
        let (x, y) = (x << (level - 1), y << (level - 1));
        let (start, top) = (x / ACROSS * ACROSS, y >> 3 << 3);
        let end = (start + ACROSS).min(pyramid.levels().level(1).width);
        let tiles = || (start..end).step_by(HALF);
        for y in top..top + HALF as u32 {
            for left in tiles() {
                let mut cells: Part<Tone, 8> = [Known::default(); 8];
                self.pull_line(left, y, &mut cells);
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
            let second: Part<Tone, 16> = halved(&first, 4, (left >> 1, top >> 1), 2, self.inpainting);
            pull_up(pyramid, self.inpainting, (left, top), &second);
        }
    }
}
