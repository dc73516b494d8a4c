//! Metamers: holes get a texture of the statistics of what surrounds them.
//!
//! ```text
//! r = mu_l + sum over levels i < l and bands j of (mu_ij + xi_ij sigma_ij)         (section 3.4 of the paper)
//! ```
//!
//! Push-pull makes `mu_l`, and from the responses of the bands and their squares, known by a mask of their own, `mu` and `sigma`. Sums go
//! down level by level, as in push-pull: a cell takes its own tone by its validity, and the rest from the linear sample of the level
//! above with the detail of its own level added. So what is known is left as it is at every level and not only in
//! the picture, and with no detail this is push-pull.
//!
//! `xi` is white noise through the same bands, see [`super::noise`]. It is taken where the surface was when the map was updated: a
//! cell less the way its motion has brought it since (section 3.4.1). So the noise of an area moves with it, and what opens next to it in the
//! next frame fits.
//!
//! Between places, mean and deviation are interpolated as such: the last linear sample takes them, and the moments go as
//! far as the level above.

use super::below::Below;
use super::demand::{Demand, sample};
use super::features::{Responses, Workspace};
use super::levels::{Levels, cells};
use super::mean::tie;
use super::needs::{self, Needs};
use super::noise::{self, Scale};
use super::push_pull::{Picture, Rule, above, pushed};
use super::pyramid::{Cell, Known, Pyramid, State, state_words};
use super::statistics::{BANDS, Moments, Statistics};
use super::steerable::{self, COLUMNS};
use super::tile::Row;
use super::tone::Tone;
use super::validity::{FULL, Gamma};
use super::ycbcr;
use crate::error::SetupError;

/// The most levels that have bands.
pub const MOST_LEVELS: u32 = 8;

/// A picture with holes, and with motion.
pub trait Scene: Picture<Value = Tone> {
    /// Names each hole that is to be filled, row by row.
    fn holes(&self, hole: impl FnMut(u32, u32));

    /// The cells of a row from `left` on, as many as there are; those of `cells` beyond the picture's border may hold anything.
    #[inline]
    fn row(&self, left: u32, y: u32, cells: &mut Row) {
        let [width, _] = self.size();
        for x in left..width.min(left + COLUMNS as u32) {
            let Known { validity, depth, value } = self.known(x, y);
            cells.set((x - left) as usize, validity, depth, &value);
        }
    }

    /// The depth of a cell.
    #[inline]
    fn depth(&self, x: u32, y: u32) -> u32 {
        self.known(x, y).depth
    }

    /// The source of a cell's tone.
    #[inline]
    fn source(&self, x: u32, y: u32) -> u32 {
        self.known(x, y).value.source
    }

    /// How far what a cell holds has moved in the last `age` frames, in cells to the right and down, to the nearest.
    fn displacement(&self, source: u32, age: u32) -> [i32; 2];

    /// Fills a hole. What [`Picture::known`] says of it does not change, but for its tone.
    fn put(&mut self, x: u32, y: u32, tone: Tone);
}

/// How holes are filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Recipe {
    /// Push-pull of tones and of moments.
    pub rule: Rule,
    /// Levels that have bands, 1 to [`MOST_LEVELS`]; no more than the picture has.
    pub levels: u32,
    /// To what the noise is scaled.
    pub noise: Scale,
    /// Whether colours get noise of their own beside that of the luma. The chroma of a texture mostly goes with its luma; noise
    /// that does not looks like coloured snow.
    pub coloured: bool,
    /// Which noise.
    pub seed: u32,
    /// Frames since the picture was updated: how long it has moved. Beyond 65535 as 65535.
    pub age: u32,
}

impl Recipe {
    /// Gamma 1/2 and four levels, as the paper's; noise of full deviation, in the luma.
    #[must_use]
    pub const fn new(threshold: u32, age: u32) -> Self {
        Self {
            rule: Rule { gamma: Gamma::Half, threshold },
            levels: 4,
            noise: Scale::Deviation,
            coloured: false,
            seed: 0,
            age,
        }
    }
}

/// Memory, lent.
#[derive(Debug)]
pub struct Scratch<'s> {
    /// [`cells`] of them.
    pub tones: &'s mut [Cell<Tone>],
    /// As many.
    pub moments: &'s mut [Cell<Moments>],
    /// [`state_words`] of these for each of them.
    pub states: [&'s mut [u32]; 2],
    /// [`needs::tiles`] of them, up to the level of the recipe.
    pub needs: &'s mut [needs::Tile],
    /// Where tiles are worked out.
    pub workspace: &'s mut Workspace,
    /// The noise that was last made.
    pub noise: &'s mut noise::Tiles,
}

/// Bytes of scratch memory for a picture of `width` x `height` cells and up to `levels` levels: for four of them 179 KiB for
/// 128 x 64 cells, 1453 KiB for 320 x 240 and 19483 KiB for 1024 x 1024 (`memory_is_as_stated` in the tests of this module).
#[must_use]
pub const fn bytes(width: u32, height: u32, levels: u32) -> usize {
    let cells = cells(width, height);
    cells * (size_of::<Cell<Tone>>() + size_of::<Cell<Moments>>())
        + 2 * state_words(cells) * size_of::<u32>()
        + needs::tiles(width, height, levels) * size_of::<needs::Tile>()
        + size_of::<Workspace>()
        + size_of::<noise::Tiles>()
}

/// Fills the holes of a scene, and works out only what they need: how many were filled.
///
/// *Errors:* memory that is too short.
pub fn sparse<S: Scene>(scene: &mut S, scratch: &mut Scratch<'_>, recipe: &Recipe) -> Result<u32, SetupError> {
    synthesise::<S, false>(scene, scratch, recipe)
}

/// [`sparse`], with all cells of all levels pulled: for comparison.
pub fn dense<S: Scene>(scene: &mut S, scratch: &mut Scratch<'_>, recipe: &Recipe) -> Result<u32, SetupError> {
    synthesise::<S, true>(scene, scratch, recipe)
}

fn synthesise<S: Scene, const DENSE: bool>(
    scene: &mut S,
    scratch: &mut Scratch<'_>,
    recipe: &Recipe,
) -> Result<u32, SetupError> {
    let [width, height] = scene.size();
    let rule = &recipe.rule;
    let levels = Levels::new(width, height);
    let last = recipe.levels.clamp(1, MOST_LEVELS).min(levels.top());
    let mut needs = Needs::new(levels, last, scratch.needs)?;
    let [of_tones, of_moments] = &mut scratch.states;
    let mut tones = Pyramid::new(width, height, scratch.tones, of_tones)?;
    let mut holes = 0u32;
    scene.holes(|x, y| {
        needs.ask(0, x, y);
        holes += 1;
    });
    if holes == 0 || last == 0 {
        return Ok(0);
    }
    scratch.noise.sow(recipe.seed);

    let mut demand = Demand { pyramid: &mut tones, rule, base: Below(&*scene) };
    if DENSE {
        each_cell(&levels, levels.top(), |x, y| demand.want_pulled(levels.top(), x, y));
    }
    for level in 0..last {
        let mut from = 0;
        while let Some((left, top, tile, next)) = needs.next(level, from) {
            needs::in_tile(left, top, tile, |x, y| {
                if level == 0 || demand.pyramid.validity(demand.pyramid.index(level, x, y)) < FULL {
                    for (x, y) in above(x, y) {
                        needs.ask(level + 1, x, y);
                        demand.want_pulled(level + 1, x, y);
                    }
                }
            });
            from = next;
        }
    }
    needs.each(last, |x, y| demand.want_completed(last, x, y));

    let mut filled = 0;
    for level in (0..last).rev() {
        let size = levels.level(level);
        let mut moments = Pyramid::new(size.width, size.height, scratch.moments, of_moments)?;
        let mut tone_demand = Demand { pyramid: &mut tones, rule, base: Below(&*scene) };
        let responses = Responses { tones: &mut tone_demand, level, needs: &needs, workspace: &mut *scratch.workspace };
        let mut demand = Demand { pyramid: &mut moments, rule, base: responses };
        if DENSE {
            let top = demand.pyramid.levels().top();
            demand.want_pulled(top, 0, 0);
        }
        needs.each(level, |x, y| {
            let tones = &demand.base.tones.pyramid;
            if level == 0 || tones.validity(tones.index(level, x, y)) < FULL {
                for (x, y) in above(x, y) {
                    finish(&mut demand, x, y);
                }
            }
        });
        let mut moved = (u32::MAX, [0; 2]);
        needs.each(level, |x, y| {
            if level > 0 && tones.validity(tones.index(level, x, y)) == FULL {
                return;
            }
            let own = if level == 0 {
                let depth = scene.depth(x, y);
                Known { validity: 0, depth, value: Tone::default() }
            } else {
                tones.known(tones.index(level, x, y))
            };
            let tone = sample(&tones, level, x, y, own.depth, rule, |tone| *tone);
            let tone = tone.map(|tone| {
                let statistics = sample(&moments, 0, x, y, own.depth, rule, Moments::finished);
                let Some(statistics) = statistics else { return tone };
                // Neighbours often have their motion from the same cell.
                if moved.0 != tone.source {
                    moved = (tone.source, scene.displacement(tone.source, recipe.age));
                }
                let motion = moved.1;
                // To the nearest cell of this level.
                let at = [x, y].map(|place| place as i32);
                let half = (1 << level) >> 1;
                let from = |place: i32, way: i32| place.wrapping_sub(way.saturating_add(half) >> level);
                let noise = scratch.noise.at(level, from(at[0], motion[0]), from(at[1], motion[1]));
                tone.detailed(detail(&statistics, noise, recipe))
            });
            if level == 0 {
                if let Some(tone) = tone {
                    scene.put(x, y, tone);
                    filled += 1;
                }
            } else {
                let index = tones.index(level, x, y);
                tones.set(index, State::Completed, pushed(own, tone, tie(x, y, level)));
            }
        });
    }
    Ok(filled)
}

/// Completes a cell of the level above the responses, and turns its moments into what is asked of it. What is pulled from it, is
/// before.
fn finish<P: Scene>(demand: &mut Demand<'_, '_, Moments, Responses<'_, '_, '_, P>>, x: u32, y: u32) {
    let index = demand.pyramid.index(1, x, y);
    if demand.pyramid.state(index) == State::Completed {
        return;
    }
    demand.want_completed(1, x, y);
    if demand.pyramid.levels().top() > 1 {
        demand.want_pulled(2, x >> 1, y >> 1);
    }
    let Known { validity, depth, value } = demand.pyramid.known(index);
    let value = Moments::finish(value.statistics());
    demand.pyramid.set(index, State::Completed, Known { validity, depth, value });
}

/// What a level adds to the three channels: the sum of both bands, in quarters, to the nearest.
#[inline(always)]
fn detail(statistics: &Statistics, noise: [[i16; 2]; 3], recipe: &Recipe) -> [i32; 3] {
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

fn each_cell(levels: &Levels, level: u32, mut each: impl FnMut(u32, u32)) {
    let size = levels.level(level);
    for y in 0..size.height {
        for x in 0..size.width {
            each(x, y);
        }
    }
}

#[cfg(test)]
mod tests;
