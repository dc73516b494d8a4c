//! Resolution does not depend on the order of arrivals, and the fused pass is propagation and resolution.

use galpix_core::stages::sweep;
use galpix_core::{Class, Dynamic, Format, Galpixmap, Layout, Margin, Rounding, Tally};
use galpix_tests::layouts::{DEEP, FLAT565_WITHOUT_DEPTH, TINY_PLANE};
use galpix_tests::memory::{Shape, cell_words, with_maps, words};
use galpix_tests::profiles::{PAPER, SCENE, SLIDE, UNEVEN, dynamic};
use galpix_tests::{packed, random, stage};
use galpix_vectors::arrivals::{Arrival, arrivals, resolve};

type Reorder = fn(&mut Vec<Arrival>);

/// Orders in which arrivals may come.
const ORDERS: [(&str, Reorder); 5] = [
    ("raster", |_| {}),
    ("reversed", |arrivals| arrivals.reverse()),
    ("shuffled", |arrivals| random::shuffle(1, arrivals)),
    ("shuffled again", |arrivals| random::shuffle(2, arrivals)),
    ("banded", |arrivals| {
        // Four bands that take turns, as four threads would.
        let band = arrivals.len().div_ceil(4).max(1);
        let bands: Vec<Vec<Arrival>> = arrivals.chunks(band).map(<[_]>::to_vec).collect();
        arrivals.clear();
        arrivals.extend((0..band).flat_map(|n| bands.iter().filter_map(move |band| band.get(n))).copied());
    }),
];

/// Settles a map in every order and sweeps it; all must agree. Returns what was counted.
fn check(
    what: &str,
    front: &Galpixmap<'_, Dynamic>,
    back: &mut Galpixmap<'_, Dynamic>,
    rounding: Rounding,
    frame: u32,
) -> Tally {
    let cells = front.grid().cells();
    let raster: Vec<Arrival> = arrivals(front, rounding, frame);
    let mut winners = vec![0; cells as usize];
    let tally = resolve(raster.clone(), back, &mut winners);
    let (resolved, won) = (words(back), winners.clone());
    let reached: Vec<Option<Vec<u32>>> =
        (0..cells).map(|cell| (back.class(cell) != Class::Empty).then(|| cell_words(back, cell))).collect();
    for (name, order) in ORDERS {
        let mut ordered = raster.clone();
        order(&mut ordered);
        assert_eq!(ordered.len(), raster.len());
        assert_eq!(resolve(ordered, back, &mut winners), tally, "{what}: tally of {name} order");
        assert!(words(back) == resolved, "{what}: {name} order gives other bits");
        assert!(winners == won, "{what}: {name} order gives other winners");
    }
    let swept = sweep(front, back, &mut winners, rounding, frame);
    for (cell, expected) in (0..cells).zip(&reached) {
        let at = || format!("{what}: cell {cell} of {}x{}", front.grid().width(), front.grid().height());
        match expected {
            Some(words) => {
                assert_eq!(&cell_words(back, cell), words, "{}", at());
                assert_eq!(winners[cell as usize], won[cell as usize], "{}: swept and resolved winner", at());
            }
            // The other fields of a cell that nothing reached, and its winner, are not defined before the fill.
            None => assert_eq!(back.class(cell), Class::Empty, "{}", at()),
        }
    }
    assert_eq!(swept, tally, "{what}: swept tally and resolved tally");
    let without_winners = sweep(front, back, &mut [], rounding, frame);
    assert_eq!(without_winners, tally, "{what}: a winner map changes nothing");
    for (cell, expected) in (0..cells).zip(&reached) {
        assert!(expected.as_ref().is_none_or(|words| *words == cell_words(back, cell)), "{what}: without winner map");
    }
    tally
}

const SHAPES: [Shape; 9] = [
    Shape::plain(1, 1),
    Shape::plain(23, 1),
    Shape::plain(1, 23),
    Shape::plain(17, 5),
    Shape::plain(8, 8),
    Shape::plain(41, 37),
    Shape { width: 1, height: 1, margin: Margin::all(1) },
    Shape { width: 9, height: 7, margin: Margin { left: 0, right: 13, top: 3, bottom: 0 } },
    Shape { width: 16, height: 3, margin: Margin { left: 20, right: 1, top: 0, bottom: 9 } },
];

/// Returns maps of random words.
fn any_words(format: Dynamic) -> Tally {
    let mut total = Tally::default();
    for (seed, shape) in (0..).zip(SHAPES.into_iter().cycle().take(3 * SHAPES.len())) {
        let content = random::words(seed, shape.cells() as usize * format.record().words());
        total = sum(total, over(shape, format, &content, seed as u32));
    }
    total
}

fn over(shape: Shape, format: Dynamic, content: &[u32], frame: u32) -> Tally {
    let mut total = Tally::default();
    for rounding in Rounding::ALL {
        let what = format!("{shape:?} {rounding:?} frame {frame}");
        total = sum(
            total,
            with_maps(shape, format, Some(content), |front, mut back| check(&what, &front, &mut back, rounding, frame)),
        );
    }
    total
}

fn sum(a: Tally, b: Tally) -> Tally {
    Tally {
        moved: a.moved + b.moved,
        lost: a.lost + b.lost,
        collided: a.collided + b.collided,
        saturated: a.saturated + b.saturated,
        ..a
    }
}

/// Returns maps that are hard on a pass that treats neighbours at once: galpixels that mostly move alike by a few
/// cells, with few different depths, a hole or a piece of debris here and there, and every pattern of two velocities
/// within a run.
fn nearly_alike(format: Dynamic, depth_levels: u32) -> Tally {
    let record = format.record();
    let mut total = Tally::default();
    for seed in 0..300 {
        let mut generator = random::generator(seed);
        let mut below = |end| random::below(&mut generator, end);
        let shape = SHAPES[2 + below(7) as usize];
        let (cells, oddities) = (shape.cells(), [0, 0, 5, 30][below(4) as usize]);
        let reach = 1 + below(3) as i64;
        let velocities: Vec<[i64; 2]> =
            (0..2).map(|_| [0, 0].map(|_| i64::from(below(2 * reach as u32 + 1)) - reach)).collect();
        let period = 1 + below(12);
        let mut content = vec![0; cells as usize * record.words()];
        for cell in 0..cells {
            let mut words = vec![0; record.words()];
            let class = if below(100) < oddities { below(4) } else { 0 };
            packed::set(record.class(), &mut words, class.into());
            packed::set(record.depth(), &mut words, below(depth_levels).into());
            packed::set(record.colour(), &mut words, cell.into());
            packed::set(record.tag(), &mut words, cell.into());
            let velocity =
                if period > 8 { velocities[below(2) as usize] } else { velocities[(cell / period % 2) as usize] };
            for (component, scale) in record.scales[..2].iter().enumerate() {
                packed::set(record.velocity(component), &mut words, velocity[component] << scale.velocity_frac);
            }
            for (plane, word) in words.into_iter().enumerate() {
                content[plane * cells as usize + cell as usize] = word;
            }
        }
        total = sum(total, over(shape, format, &content, seed as u32));
    }
    total
}

#[test]
fn any_words_of_the_papers_layout() {
    let total = any_words(dynamic(Layout::FULL, PAPER));
    assert!(total.lost > 0 && total.saturated > 0, "{total:?}");
}

#[test]
fn any_words_of_every_other_layout() {
    any_words(dynamic(Layout::SHADED, UNEVEN));
    any_words(dynamic(Layout::FLAT565, SCENE));
    any_words(dynamic(Layout::VELOCITY565, SLIDE));
    any_words(dynamic(Layout::VELOCITY_GRAY4, SLIDE));
    any_words(dynamic(TINY_PLANE, UNEVEN));
    any_words(dynamic(DEEP, SLIDE));
    any_words(dynamic(Layout::STILL, PAPER));
}

#[test]
fn neighbours_that_move_nearly_alike() {
    for total in [
        nearly_alike(dynamic(Layout::FULL, PAPER), 3),
        nearly_alike(dynamic(Layout::FLAT565, SCENE), 1),
        nearly_alike(dynamic(FLAT565_WITHOUT_DEPTH, UNEVEN), 1),
        nearly_alike(dynamic(Layout::VELOCITY565, SLIDE), 2),
    ] {
        assert!(total.collided > 1000 && total.lost > 1000, "{total:?}");
    }
}

/// Two velocities that alternate within a run and meet in one cell at one depth: the smaller source wins.
#[test]
fn ties_between_the_ways_of_a_run_go_to_the_smaller_source() {
    let format = dynamic(Layout::VELOCITY565, SLIDE);
    let (record, shape) = (format.record(), Shape::plain(16, 1));
    for pattern in 0..1 << 8 {
        let mut content = vec![0; shape.cells() as usize * record.words()];
        for cell in 0..shape.cells() {
            let mut words = vec![0; record.words()];
            packed::set(record.colour(), &mut words, cell.into());
            let right = cell >= 8 || pattern >> cell & 1 == 1;
            packed::set(record.velocity(0), &mut words, i64::from(right) << record.scales[0].velocity_frac);
            for (plane, word) in words.into_iter().enumerate() {
                content[(plane as u32 * shape.cells() + cell) as usize] = word;
            }
        }
        over(shape, format, &content, pattern);
    }
}

#[test]
fn the_built_in_scenes() {
    let format = dynamic(Layout::FULL, SCENE);
    for stage in stage::all() {
        with_maps(stage.shape, format, None, |mut front, mut back| {
            stage.load(&mut front, |_| ());
            for frame in 0..4 {
                let what = format!("{} frame {frame}", stage.scene.name());
                check(&what, &front, &mut back, Rounding::LowDiscrepancy, frame);
                // Holes stay holes here: what the fill makes of them is another test's.
                let mut winners = vec![0; stage.shape.cells() as usize];
                resolve(arrivals(&front, Rounding::LowDiscrepancy, frame), &mut back, &mut winners);
                std::mem::swap(&mut front, &mut back);
            }
        });
    }
}

/// A winner map that is shorter than the map, and maps that do not belong together.
#[test]
fn maps_that_do_not_belong_together_are_left_alone() {
    let format = dynamic(Layout::FULL, PAPER);
    with_maps(Shape::plain(5, 5), format, None, |front, _| {
        with_maps(Shape::plain(5, 4), format, None, |mut other, _| {
            other.store(1, 1, &Default::default());
            let before = words(&other);
            assert_eq!(sweep(&front, &mut other, &mut [], Rounding::Truncate, 0), Tally::default());
            assert_eq!(words(&other), before);
        });
    });
}
