//! Samples put into layers, without those that cannot be uncovered.

use super::offered::empty;
use super::{Arrangement, Carried, Culling, Layer, surfaces};
use crate::update::{Known, Sample, Update};

/// Returns a first layer and what is behind it, put into layers.
pub(super) fn arranged(
    update: &Update,
    mut layers: Vec<Layer>,
    arrangement: Arrangement,
    culling: Option<Culling>,
) -> Carried {
    let cells = update.samples.len();
    let covering = covering(&layers, cells);
    let offered = count(&layers);
    if let Some(culling) = &culling {
        layers.iter_mut().for_each(|layer| cull(layer, culling, &[]));
    }
    let kept = count(&layers);
    let mut base = update.clone();
    let mut hidden = vec![false; cells];
    hidden.resize(cells * (1 + layers.len()), true);
    match (arrangement, layers.first_mut()) {
        (Arrangement::Farther, Some(Layer::Moving(second))) => {
            let leaves: Vec<bool> = second.samples.iter().map(|sample| sample.known == Known::Motion).collect();
            let (of_base, of_layer) = hidden.split_at_mut(cells);
            for cell in surfaces::that_leave(update, &covering, &leaves) {
                std::mem::swap(&mut base.samples[cell], &mut second.samples[cell]);
                std::mem::swap(&mut of_base[cell], &mut of_layer[cell]);
            }
        }
        (Arrangement::Farther, Some(Layer::Stationary { .. })) => {
            // What lies around its edges covers only a part of a surface; the whole of it leaves.
            let leaves = self::covering(&layers, cells);
            let mut covers = empty(update);
            for cell in surfaces::that_leave(update, &vec![true; cells], &leaves) {
                std::mem::swap(&mut base.samples[cell], &mut covers.samples[cell]);
            }
            layers.insert(0, Layer::Moving(covers));
            hidden.splice(cells..cells, std::iter::repeat_n(false, cells));
        }
        _ => {}
    }
    Carried { base, offered, kept, layers, culling, hidden }
}

/// Surfaces that are whole: what is seen of them is not hidden, and never left out. The largest one is the base.
pub(super) fn unlimited(update: &Update, mut surfaces: Vec<Layer>, culling: Option<Culling>) -> Carried {
    surfaces.sort_by_key(|surface| std::cmp::Reverse(count(std::slice::from_ref(surface))));
    let seen = |surface: &Layer| -> Vec<bool> {
        let samples = surface.update().samples.iter().zip(&update.samples);
        samples.map(|(own, seen)| own.known == Known::Motion && own.tag == seen.tag).collect()
    };
    let seen: Vec<Vec<bool>> = surfaces.iter().map(seen).collect();
    let first: u32 = seen.iter().flatten().map(|&seen| u32::from(seen)).sum();
    let offered = count(&surfaces) - first;
    if let Some(culling) = &culling {
        for (surface, seen) in surfaces.iter_mut().zip(&seen) {
            cull(surface, culling, seen);
        }
    }
    let kept = count(&surfaces) - first;
    let mut base = surfaces.remove(0).into_update();
    // Where no surface is, the world is black and infinitely far.
    for (own, seen) in base.samples.iter_mut().zip(&update.samples).filter(|(_, seen)| seen.tag == 0) {
        *own = *seen;
    }
    let hidden = seen.into_iter().flatten().map(|seen| !seen).collect();
    Carried { base, offered, kept, layers: surfaces, culling, hidden }
}

fn count(layers: &[Layer]) -> u32 {
    let known = |layer: &Layer| layer.update().samples.iter().filter(|s| s.known == Known::Motion).count() as u32;
    layers.iter().map(known).sum()
}

/// Returns which cells have something behind what is seen.
fn covering(layers: &[Layer], cells: usize) -> Vec<bool> {
    let mut covering = vec![false; cells];
    for layer in layers {
        for (stored, _) in layer.update().samples.iter().enumerate().filter(|(_, s)| s.known == Known::Motion) {
            if let Some(cell) = layer.seen_at(stored).and_then(|cell| covering.get_mut(cell)) {
                *cell = true;
            }
        }
    }
    covering
}

/// Leaves out what cannot be uncovered, but for what is `seen`.
fn cull(layer: &mut Layer, culling: &Culling, seen: &[bool]) {
    let cells = 0..layer.update().samples.len();
    let keep = |stored: usize| {
        seen.get(stored) == Some(&true) || layer.seen_at(stored).is_some_and(|cell| culling.covers(cell))
    };
    let keep: Vec<bool> = cells.map(keep).collect();
    for (sample, keep) in layer.update_mut().samples.iter_mut().zip(keep) {
        if !keep {
            *sample = Sample { known: Known::ColourOnly, ..*sample };
        }
    }
}
