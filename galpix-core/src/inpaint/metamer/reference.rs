//! The reference of metamers: all cells of all levels, in plain loops, response by response.

extern crate std;

use std::vec::Vec;

use super::noise::white;
use super::scene::Scene;
use super::statistics::{Moments, Statistics};
use super::steerable::response;
use super::synthesis::{Rule, detail};
use super::tone::Tone;
use super::{Metamer, Recipe};
use crate::inpaint::kernel::{Known, pushed};
use crate::inpaint::mean::tie;
use crate::inpaint::reference::{Plane, pulled_up, push_down};
use crate::inpaint::settings::Inpainting;
use crate::inpaint::validity::FULL;

/// Fills the holes of a scene by metamers, `age` frames after it was updated: how many were filled.
pub fn metamers<S: Scene>(scene: &mut S, inpainting: &Inpainting<'_>, recipe: &Recipe, age: u32) -> u32 {
    let rule = Rule { inpainting, recipe, age };
    let base = Plane::new(scene.size(), |x, y| scene.known(x, y));
    let mut tones = pulled_up(base, inpainting);
    let last = recipe.levels.clamp(1, Metamer::MOST_LEVELS).min(tones.len() as u32 - 1);
    if last == 0 {
        return 0;
    }
    let statistics: Vec<_> = tones.iter().take(last as usize).map(|tones| statistics(tones, inpainting)).collect();
    push_down(&mut tones, last, inpainting);
    for level in (1..last).rev() {
        let (above, statistics) = (&tones[level as usize + 1], &statistics[level as usize]);
        tones[level as usize] = tones[level as usize].map(|x, y, own| {
            if own.validity == FULL {
                return own;
            }
            let from = Level { above, statistics, level };
            pushed(own, from.tone(scene, rule, (x, y), own.depth), tie(x, y, level))
        });
    }
    let mut holes = Vec::new();
    scene.each_hole(|x, y| holes.push((x, y)));
    let from = Level { above: &tones[1], statistics: &statistics[0], level: 0 };
    let filled: Vec<_> = holes.iter().map(|&(x, y)| from.tone(scene, rule, (x, y), scene.known(x, y).depth)).collect();
    let mut count = 0;
    for (&(x, y), tone) in holes.iter().zip(&filled) {
        if let Some(tone) = tone {
            scene.put(x, y, *tone);
            count += 1;
        }
    }
    count
}

/// Returns the five by five cells around one; beyond the border the nearest one counts.
fn window(tones: &Plane<Tone>, x: u32, y: u32) -> [[Known<Tone>; 5]; 5] {
    let [width, height] = tones.size();
    let near = |at: u32, by: usize, side: u32| (at + by as u32).saturating_sub(2).min(side - 1);
    core::array::from_fn(|j| core::array::from_fn(|i| tones.at((near(x, i, width), near(y, j, height)))))
}

/// Returns mean and deviation of each band above a level of the tones.
fn statistics(tones: &Plane<Tone>, inpainting: &Inpainting<'_>) -> Plane<Statistics> {
    let responses = tones.map(|x, y, own| {
        let window = window(tones, x, y);
        let mut responses = [0; 6];
        for channel in 0..3 {
            let bands = response(&window.map(|row| row.map(|cell| cell.value.channels[channel])));
            responses[2 * channel..2 * channel + 2].copy_from_slice(&bands);
        }
        let cells = || window.as_flattened().iter();
        let nearest = cells().map(|cell| cell.depth).min().unwrap_or_default();
        let farthest = cells().map(|cell| cell.depth).max().unwrap_or_default();
        let counts = cells().all(|cell| cell.validity == FULL) && farthest - nearest <= inpainting.threshold;
        Known { validity: if counts { FULL } else { 0 }, depth: own.depth, value: Moments::of(responses) }
    });
    let mut moments = pulled_up(responses, inpainting);
    push_down(&mut moments, 1, inpainting);
    moments[1].map(|_, _, moments| moments.map(|moments| moments.statistics()))
}

/// What a level takes from above.
struct Level<'l> {
    above: &'l Plane<Tone>,
    statistics: &'l Plane<Statistics>,
    level: u32,
}

impl Level<'_> {
    /// Returns the tone that a cell gets, with the level's detail.
    fn tone(&self, scene: &impl Scene, rule: Rule<'_>, place: (u32, u32), depth: u32) -> Option<Tone> {
        let tone = self.above.sampled(self.level, place, depth, rule.inpainting)?;
        let Some(statistics) = self.statistics.sampled(0, place, depth, rule.inpainting) else { return Some(tone) };
        let moved = scene.displacement(tone.source, rule.age);
        let from = |place: u32, moved: i32| {
            let moved = (i64::from(moved) + (1i64 << self.level >> 1)).min(i32::MAX.into()) >> self.level;
            (i64::from(place) - moved) as i32
        };
        let (x, y) = (from(place.0, moved[0]), from(place.1, moved[1]));
        let noise = [0, 1, 2].map(|channel| {
            response(&core::array::from_fn(|j| {
                core::array::from_fn(|i| {
                    let (x, y) = (x.wrapping_add(i as i32 - 2), y.wrapping_add(j as i32 - 2));
                    white(x, y, self.level, rule.recipe.seed)[channel]
                })
            }))
        });
        Some(tone.detailed(detail(&statistics, noise, rule.recipe)))
    }
}
