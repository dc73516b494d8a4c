//! The sum of the bands, level by level: up from the holes to what they need, and down again.

use super::active::{self, ActiveTiles};
use super::noise::{self, Tiles};
use super::responses::Responses;
use super::scene::Scene;
use super::statistics::{BANDS, Moments, Statistics};
use super::tone::Tone;
use super::tones::Tones;
use super::{MetamerWorkspace, Recipe, steerable, ycbcr};
use crate::inpaint::kernel::{Known, above, each, pushed, sampled};
use crate::inpaint::lazy::Lazy;
use crate::inpaint::levels::Levels;
use crate::inpaint::mean::tie;
use crate::inpaint::pyramid::{Pyramid, State, Stored};
use crate::inpaint::settings::Inpainting;
use crate::inpaint::validity::FULL;

/// By what a texture is made.
#[derive(Clone, Copy, Debug)]
pub struct Rule<'r> {
    /// Push-pull of tones and of moments.
    pub inpainting: &'r Inpainting<'r>,
    /// The texture.
    pub recipe: &'r Recipe,
    /// Frames since the scene was updated: how long it has moved. Beyond 65535 as 65535.
    pub age: u32,
}

/// The memory of a texture, laid out for a scene.
#[derive(Debug)]
pub struct Synthesis<'m> {
    /// The highest level that is requested: that above the last one with bands.
    pub last: u32,
    /// The cells that the holes need.
    pub active: ActiveTiles<'m>,
    /// The tones of the scene.
    pub tones: Pyramid<'m, Tone>,
    /// Memory of the moments, which serves one level after the other.
    pub moments: &'m mut [u32],
}

impl<'m> Synthesis<'m> {
    /// Lays a texture whose `last` first levels have bands over memory. Returns nothing if that is too short.
    pub fn over(levels: Levels, last: u32, memory: &'m mut [u32]) -> Option<Self> {
        let (cells, last) = (levels.cells(), last.min(levels.top()));
        let (tones, rest) = memory.split_at_mut_checked(Pyramid::<Tone>::words(cells))?;
        let (moments, active) = rest.split_at_mut_checked(Pyramid::<Moments>::words(cells))?;
        let (active, tones) = (ActiveTiles::new(levels, last, active)?, Pyramid::over(levels, tones)?);
        Some(Self { last, active, tones, moments })
    }

    /// Fills the holes of a scene: how many were filled.
    pub fn fill<S: Scene>(&mut self, scene: &mut S, rule: Rule<'_>, workspace: &mut MetamerWorkspace) -> u32 {
        let Self { last, active, tones, moments } = self;
        let (last, inpainting) = (*last, rule.inpainting);
        let mut holes = 0u32;
        scene.each_hole(|x, y| {
            active.request(0, x, y);
            holes += 1;
        });
        if holes == 0 || last == 0 {
            return 0;
        }
        workspace.noise.reseed(rule.recipe.seed);
        pull_up(&mut Lazy { pyramid: tones, base: Tones { scene: &*scene, inpainting } }, active, last);
        let mut filled = 0;
        for level in (0..last).rev() {
            let size = tones.levels().level(level);
            let Some(mut moments) = Pyramid::over(Levels::new(size.width, size.height), moments) else { break };
            let mut lazy = Lazy { pyramid: tones, base: Tones { scene: &*scene, inpainting } };
            let base = Responses { tones: &mut lazy, level, active, workspace: &mut workspace.responses };
            finish_level(&mut Lazy { pyramid: &mut moments, base });
            let noise = &mut workspace.noise;
            let mut sum = Sum { rule, level, tones, moments: &moments, noise, moved: (u32::MAX, [0; 2]) };
            if level > 0 {
                active.each(level, |x, y| sum.push(scene, x, y));
            } else {
                active.each(0, |x, y| {
                    if let Some(tone) = sum.tone(scene, x, y, scene.depth(x, y)) {
                        scene.put(x, y, tone);
                        filled += 1;
                    }
                });
            }
        }
        filled
    }
}

/// Requests what the holes need of each level up to `last` and pulls it, and completes that of level `last`.
fn pull_up<S: Scene>(tones: &mut Lazy<'_, '_, Tone, Tones<'_, S>>, active: &mut ActiveTiles<'_>, last: u32) {
    for level in 0..last {
        let mut from = 0;
        while let Some((left, top, tile, next)) = active.next(level, from) {
            active::in_tile(left, top, tile, |x, y| {
                if level == 0 || tones.pyramid.validity(tones.pyramid.index(level, x, y)) < FULL {
                    for (x, y) in above(x, y) {
                        active.request(level + 1, x, y);
                        tones.ensure_pulled(level + 1, x, y);
                    }
                }
            });
            from = next;
        }
    }
    active.each(last, |x, y| tones.ensure_completed(last, x, y));
}

/// Finishes what the requested cells of a level are sampled from.
fn finish_level<S: Scene>(moments: &mut Lazy<'_, '_, Moments, Responses<'_, '_, '_, S>>) {
    let (level, active) = (moments.base.level, moments.base.active);
    active.each(level, |x, y| {
        let tones = &moments.base.tones.pyramid;
        if level == 0 || tones.validity(tones.index(level, x, y)) < FULL {
            for (x, y) in above(x, y) {
                finish(moments, x, y);
            }
        }
    });
}

/// Completes a cell of the level above the responses, and turns its moments into statistics. What is pulled from it, is
/// before.
fn finish<S: Scene>(moments: &mut Lazy<'_, '_, Moments, Responses<'_, '_, '_, S>>, x: u32, y: u32) {
    let index = moments.pyramid.index(1, x, y);
    if moments.pyramid.state(index) == State::Completed {
        return;
    }
    moments.ensure_completed(1, x, y);
    if moments.pyramid.levels().top() > 1 {
        moments.ensure_pulled(2, x >> 1, y >> 1);
    }
    let known = moments.pyramid.known(index).map(|moments| Moments::finish(moments.statistics()));
    moments.pyramid.set(index, State::Completed, known);
}

/// The sum of a level.
struct Sum<'a, 's> {
    rule: Rule<'a>,
    level: u32,
    tones: &'a mut Pyramid<'s, Tone>,
    /// Those of the level, finished.
    moments: &'a Pyramid<'a, Moments>,
    noise: &'a mut Tiles,
    /// How far a source has moved. Neighbours often have their motion from the same cell.
    moved: (u32, [i32; 2]),
}

impl Sum<'_, '_> {
    /// Pushes a cell of a level from 1 on with the level's detail.
    #[inline]
    fn push(&mut self, scene: &impl Scene, x: u32, y: u32) {
        let index = self.tones.index(self.level, x, y);
        let own = self.tones.known(index);
        if own.validity < FULL {
            let tone = self.tone(scene, x, y, own.depth);
            self.tones.set(index, State::Completed, pushed(own, tone, tie(x, y, self.level)));
        }
    }

    /// Returns the tone that a cell gets from above, with the level's detail.
    #[inline]
    fn tone(&mut self, scene: &impl Scene, x: u32, y: u32, depth: u32) -> Option<Tone> {
        let (level, inpainting) = (self.level, self.rule.inpainting);
        let coarse = coarse(self.tones, level, x, y, |tone| tone);
        let tone = sampled(&coarse, depth, inpainting, tie(x, y, level))?;
        let statistics = self::coarse(self.moments, 0, x, y, Moments::finished);
        let Some(statistics) = sampled(&statistics, depth, inpainting, tie(x, y, 0)) else { return Some(tone) };
        if self.moved.0 != tone.source {
            self.moved = (tone.source, scene.displacement(tone.source, self.rule.age));
        }
        let [right, down] = self.moved.1;
        // To the nearest cell of this level.
        let half = (1 << level) >> 1;
        let from = |place: u32, way: i32| (place as i32).wrapping_sub(way.saturating_add(half) >> level);
        let noise = self.noise.at(level, from(x, right), from(y, down));
        Some(tone.detailed(detail(&statistics, noise, self.rule.recipe)))
    }
}

/// Returns what is known of the four cells that a cell is sampled from, of which `of` is taken.
#[inline(always)]
fn coarse<V: Stored, W>(pyramid: &Pyramid<'_, V>, level: u32, x: u32, y: u32, of: impl Fn(V) -> W) -> [Known<W>; 4] {
    each(pyramid.indices(level + 1, above(x, y)), |index| pyramid.known(index).map(&of))
}

/// Returns what a level adds to the three channels: the sum of both bands, in quarters, to the nearest.
#[inline(always)]
pub fn detail(statistics: &Statistics, noise: [[i16; 2]; 3], recipe: &Recipe) -> [i32; 3] {
    const DOWN: u32 = noise::FRACTION_BITS + steerable::FRACTION_BITS - ycbcr::FRACTION_BITS;
    let mut detail = [0; BANDS / 2];
    for (channel, (to, noise)) in detail.iter_mut().zip(noise).enumerate() {
        let mut sum = 1 << (DOWN - 1);
        let noisy = channel == 0 || recipe.coloured;
        for (band, response) in noise.into_iter().enumerate() {
            let at = 2 * channel + band;
            if noisy {
                sum += i32::from(statistics.deviations[at]) * recipe.noise.scaled(response);
            }
            sum += i32::from(statistics.means[at]) << noise::FRACTION_BITS;
        }
        *to = sum >> DOWN;
    }
    detail
}
