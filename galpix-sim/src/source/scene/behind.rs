//! What a scene has behind what is seen: layers of depth, as a renderer that peels them off delivers them.
//!
//! Along the line of sight through a cell the surfaces are met in order of depth. Layer 0 is the update; each further
//! layer takes the first surface that lies behind the one before by a least separation. Where there is none the cell is
//! empty. A solid is met twice, where the line enters it and where it leaves: its own back is never uncovered before
//! its front is, so a renderer that tells them apart leaves the backs out, and one that does not needs a separation
//! that is larger than the solids are thick.

use rayon::prelude::*;

use super::surface::{Hit, Surface};
use super::{Scene, seen};
use crate::update::{Known, Sample, Update};

/// How layers are peeled off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peel {
    /// Layers behind the first one, at most.
    pub layers: usize,
    /// How far a layer lies behind the one before at least, in normalised depth; 0: any surface behind.
    pub separation: f64,
    /// Whether the backs of solids are surfaces too.
    pub backs: bool,
}

/// A cell behind which nothing is.
const EMPTY: Sample = Sample {
    colour: [0; 3],
    known: Known::ColourOnly,
    depth: 1.0,
    velocity: [0.0; 3],
    acceleration: [0.0; 3],
    luminosity_rate: 0.0,
    tag: 0,
};

/// Returns the layers behind the update of a scene at time `t`, over the same cells, from near to far; without those
/// that are empty.
#[must_use]
pub fn behind(scene: &dyn Scene, t: f64, peel: &Peel) -> Vec<Update> {
    let cells = cells(scene, |place| peeled(scene.surfaces(), place, t, peel));
    let deepest = cells.iter().map(Vec::len).max().unwrap_or(0);
    let layer = |layer: usize| cells.iter().map(|cell| cell.get(layer).copied().unwrap_or(EMPTY)).collect();
    (0..deepest).map(|number| update_of(scene, layer(number))).collect()
}

/// What there is at each place of the display, row by row, margin included.
fn cells<T: Send>(scene: &dyn Scene, at: impl Fn([f64; 2]) -> T + Sync) -> Vec<T> {
    let margin = scene.margin();
    let columns = 0..margin.left + scene.width() + margin.right;
    let rows = 0..margin.top + scene.height() + margin.bottom;
    let place = |x: usize, y: usize| [x as f64 - margin.left as f64, y as f64 - margin.top as f64];
    let at = &at;
    rows.into_par_iter().flat_map_iter(|y| columns.clone().map(move |x| at(place(x, y)))).collect()
}

/// Returns the samples of all cells as an update.
fn update_of(scene: &dyn Scene, samples: Vec<Sample>) -> Update {
    let margin = scene.margin();
    Update {
        width: margin.left + scene.width() + margin.right,
        height: margin.top + scene.height() + margin.bottom,
        margin,
        samples,
        depth_kind: scene.depth_kind(),
        overlay: None,
    }
}

/// Returns each surface of a scene at time `t` by itself, as if no other one were in front of it: the layers that
/// nothing is missing in.
#[must_use]
pub fn each(scene: &dyn Scene, t: f64) -> Vec<Update> {
    let seen_alone = |index: usize| {
        let surface = scene.surfaces()[index];
        move |[x, y]: [f64; 2]| surface.hit(x, y, t).map_or(EMPTY, |hit| seen(surface, index, &hit, t))
    };
    (0..scene.surfaces().len()).map(|index| update_of(scene, cells(scene, seen_alone(index)))).collect()
}

/// The samples of one cell behind the first, from near to far.
fn peeled(surfaces: &[&dyn Surface], [x, y]: [f64; 2], t: f64, peel: &Peel) -> Vec<Sample> {
    let mut hits = all(surfaces, x, y, t, peel.backs).into_iter();
    let Some((_, first)) = hits.next() else { return Vec::new() };
    let mut last = first.depth;
    let separate = hits.filter(|(_, hit)| {
        let behind = hit.depth >= last + peel.separation;
        if behind {
            last = hit.depth;
        }
        behind
    });
    separate.take(peel.layers).map(|(index, hit)| seen(surfaces[index], index, &hit, t)).collect()
}

/// Returns all surfaces at a place of the display in order of depth; of two at the same depth the earlier one first.
fn all(surfaces: &[&dyn Surface], x: f64, y: f64, t: f64, backs: bool) -> Vec<(usize, Hit)> {
    let mut hits: Vec<(usize, Hit)> = Vec::new();
    for (index, surface) in surfaces.iter().enumerate() {
        let back = if backs { surface.behind(x, y, t) } else { None };
        hits.extend(surface.hit(x, y, t).into_iter().chain(back).map(|hit| (index, hit)));
    }
    hits.sort_by(|(_, a), (_, b)| a.depth.total_cmp(&b.depth));
    hits
}

#[cfg(test)]
mod tests {
    use super::super::surface::{Card, everywhere};
    use super::super::{all as scenes, find, update};
    use super::*;

    fn paint(u: f64, _: f64) -> [f64; 3] {
        [u; 3]
    }

    #[test]
    fn layers_are_apart_by_the_separation_and_in_order() {
        let cards = [0.5, 0.1, 0.55, 0.9, 0.5].map(|depth| Card::still(depth, everywhere, paint));
        let surfaces: Vec<&dyn Surface> = cards.iter().map(|card| card as &dyn Surface).collect();
        let depths = |layers, separation| {
            let peel = Peel { layers, separation, backs: true };
            peeled(&surfaces, [3.0, 4.0], 0.0, &peel).iter().map(|s| (s.depth, s.tag)).collect::<Vec<_>>()
        };
        assert_eq!(depths(9, 0.0), [(0.5, 1), (0.5, 5), (0.55, 3), (0.9, 4)]);
        assert_eq!(depths(9, 0.04), [(0.5, 1), (0.55, 3), (0.9, 4)]);
        assert_eq!(depths(9, 0.1), [(0.5, 1), (0.9, 4)]);
        assert_eq!(depths(1, 0.45), [(0.55, 3)]);
        assert_eq!(depths(9, 0.81), []);
    }

    /// The same point seen again must say the same of itself, and whatever is behind is farther.
    #[test]
    fn what_is_behind_is_farther_and_moves_like_its_surface() {
        for scene in scenes() {
            let first = update(*scene, 0.0);
            for backs in [false, true] {
                let layers = behind(*scene, 0.0, &Peel { layers: 16, separation: 1.0 / 64.0, backs });
                let mut before = first.clone();
                for layer in &layers {
                    assert_eq!((layer.width, layer.height, layer.margin), (first.width, first.height, first.margin));
                    assert!(layer.samples.iter().any(|sample| sample.known == Known::Motion), "{}", scene.name());
                    for (sample, before) in layer.samples.iter().zip(&before.samples) {
                        if sample.known == Known::Motion {
                            assert!(before.known == Known::Motion, "{}: a cell in front is empty", scene.name());
                            assert!(sample.depth >= before.depth + 1.0 / 64.0 - 1e-12, "{}", scene.name());
                            assert!(backs || sample.tag != before.tag, "{}: its own back", scene.name());
                        }
                    }
                    before = layer.clone();
                }
            }
        }
        assert_eq!(behind(find("still").unwrap(), 0.0, &Peel { layers: 0, separation: 0.0, backs: true }).len(), 0);
    }

    /// Behind each cell of the ball is the park; nothing is behind the park.
    #[test]
    fn the_park_goes_on_behind_the_ball() {
        let ball = find("ball").unwrap();
        let first = update(ball, 0.0);
        let layers = behind(ball, 0.0, &Peel { layers: 16, separation: 0.0, backs: true });
        assert_eq!(layers.len(), 1);
        for (sample, front) in layers[0].samples.iter().zip(&first.samples) {
            assert_eq!(sample.known == Known::Motion, front.tag == 2);
            assert!(sample.known != Known::Motion || sample.tag == 1);
        }
    }

    #[test]
    fn a_globe_has_a_back_where_the_line_of_sight_leaves_it() {
        let sphere = find("sphere").unwrap();
        let globe = sphere.surfaces()[2];
        let mut met = 0;
        for (x, y) in (0..144).flat_map(|y| (0..192).map(move |x| (f64::from(x), f64::from(y)))) {
            let (front, back) = (globe.hit(x, y, 0.0), globe.behind(x, y, 0.0));
            assert_eq!(front.is_some(), back.is_some());
            if let (Some(front), Some(back)) = (front, back) {
                met += 1;
                assert!(front.depth <= back.depth);
                let place = globe.place(back.point, super::super::jet::Jet::constant(0.0)).map(|place| place.value);
                assert!((place[0] - x).abs() < 1e-9 && (place[1] - y).abs() < 1e-9, "{place:?}");
                assert!((place[2] - back.depth).abs() < 1e-12);
            }
        }
        assert!(met > 1000, "{met}");
    }
}
