//! Frames in constant time.

use super::*;
use crate::format::rounding::Rounding;
use crate::frame::Settings;
use crate::frame::tally::Tally;
use crate::source::{Budget, quads};

/// What a frame stores, shows and counts.
#[derive(PartialEq, Eq)]
struct Frame {
    layers: Vec<(Vec<Vec<u32>>, Vec<u32>)>,
    entries: Vec<Option<(u16, u32)>>,
    tally: Tally,
}

fn frame<F: Format>(
    sources: &mut Sources<'_, '_, F>,
    step: impl FnOnce(&mut Sources<'_, '_, F>) -> (Tally, u32),
) -> (Frame, u32) {
    let (tally, left_out) = step(sources);
    let layers = sources.layers.iter().map(|layer| {
        let planes = layer.map.planes().iter().take(layer.map.record().words());
        (planes.map(|plane| plane.to_vec()).collect(), layer.displacements.to_vec())
    });
    let layers = layers.collect();
    let entries = (0..sources.visibility.grid().cells()).map(|cell| sources.entry(cell)).collect();
    (Frame { layers, entries, tally }, left_out)
}

const ALL: Budget = Budget { quads: u32::MAX, cracks: u32::MAX };

/// Lends layers that are linked as they are stored and lie where they are given, and a number for each case.
fn each_case(mut work: impl FnMut(&mut dyn FnMut(&mut dyn FnMut(&mut Sources<'_, '_, Dynamic>)), Settings)) {
    let mut random = Random(21);
    for (turn, (frac, layout)) in FORMATS.into_iter().enumerate() {
        let format = format(frac, layout);
        for shape in SHAPES {
            for look in LOOKS {
                let layers = [look, Look::Grown].map(|look| random_layer(&mut random, shape, format, look));
                let mut settings = Settings::for_depth(format.record().depth().bits.into());
                settings.rounding = Rounding::ALL[turn % Rounding::ALL.len()];
                let mut lend = |use_them: &mut dyn FnMut(&mut Sources<'_, '_, Dynamic>)| {
                    with_sources(shape, format, &mut layers.clone(), &mut Random(9), |sources| {
                        for layer in sources.layers.iter_mut() {
                            let displacements = layer.displacements.to_vec();
                            layer.begin(settings.edge_threshold);
                            layer.displacements.copy_from_slice(&displacements);
                        }
                        use_them(sources);
                    });
                };
                work(&mut lend, settings);
            }
        }
    }
}

#[test]
fn frames_within_the_budget_have_the_bits_of_others() {
    let mut rare = [0; 2];
    each_case(|lend, settings| {
        let (mut expected, mut made) = (Vec::new(), Vec::new());
        lend(&mut |sources| {
            expected = (0..3).map(|_| frame(sources, |sources| (sources.step(&settings), 0))).collect()
        });
        lend(&mut |sources| {
            made = (0..3).map(|_| frame(sources, |sources| sources.step_constant_time(&settings, &ALL))).collect();
        });
        assert!(made == expected, "{settings:?}");
        let is_quad = |entry: &&Option<(u16, u32)>| entry.is_some_and(|(key, _)| key & 1 == 0);
        rare[0] += made.iter().map(|(frame, _)| frame.entries.iter().filter(is_quad).count()).sum::<usize>();
        rare[1] += made.iter().map(|(frame, _)| frame.tally.bullets as usize).sum::<usize>();
    });
    assert!(rare.iter().all(|&count| count > 1000), "quads and cracks: {rare:?}");
}

/// Of each row the first ones of a list are drawn, the others counted.
#[test]
fn what_is_beyond_the_budget_is_left_out_and_counted() {
    let mut seen = [0; 2];
    each_case(|lend, settings| {
        let with = |quads: u32, cracks: u32| Budget { quads, cracks };
        let mut counts = Vec::new();
        for budget in [with(0, 0), with(1, u32::MAX), with(u32::MAX, 0), with(u32::MAX, 1), ALL] {
            lend(&mut |sources| {
                let (frame, left_out) = frame(sources, |sources| sources.step_constant_time(&settings, &budget));
                let stretched = sources.layers.iter().flat_map(|layer| {
                    let grid = *layer.map.grid();
                    let (columns, rows) = (grid.width() - 1, grid.height() as usize - 1);
                    let of = move |start: u32| {
                        (start..start + columns).filter(|&cell| quads::stretched(layer, cell) != 0).count() as u32
                    };
                    grid.starts().iter().take(rows).map(move |&start| of(start)).collect::<Vec<_>>()
                });
                let quads: u32 = stretched.map(|count| count.saturating_sub(budget.quads)).sum();
                counts.push((left_out - quads, frame.tally.bullets, quads));
            });
        }
        let [none, one_quad, no_crack, one_crack, all] = counts[..] else { panic!("five budgets") };
        assert_eq!((none.1, no_crack.1), (0, 0), "no crack is closed");
        assert_eq!((one_quad.0, all.0, all.2, no_crack.2), (0, 0, 0, 0), "within the budget nothing is left out");
        assert!(one_crack.0 <= no_crack.0 && one_crack.1 <= all.1);
        seen[0] += none.2 - one_quad.2;
        seen[1] += no_crack.0 - one_crack.0;
    });
    assert!(seen.iter().all(|&count| count > 1000), "{seen:?}");
}
