//! The fast passes give the bits of the references.

use super::*;
use crate::fast;
use crate::format::rounding::Rounding;
use crate::frame::tally::Tally;
use crate::source::cracks::Closed;
use crate::source::reference;
use crate::source::row::{self, Finish, GatherRow};
use crate::source::visibility::{Entry, threshold};

type Scatter<F> = fn(&mut Source<'_, F>, &mut Visibility<'_>, u32, u32, Option<(Rounding, u32)>) -> Tally;

type GatherForm<F> = fn(&[Source<'_, F>], &Visibility<'_>, u32, &GatherRow, &mut [u32]);

/// All passes of a frame in one form.
struct Forms<F> {
    scatter: Scatter<F>,
    close: fn(&[Source<'_, F>], &mut Visibility<'_>, i32) -> Closed,
    gather: GatherForm<F>,
    finish: fn(&Sources<'_, '_, F>, &Finish<'_>, &mut [u32]),
}

impl<F: Format> Forms<F> {
    fn fast() -> Self {
        Self { scatter: fast::scatter, close: fast::close_cracks, gather: fast::gather_row, finish: fast::finish_row }
    }

    fn reference() -> Self {
        Self {
            scatter: reference::scatter,
            close: reference::close,
            gather: row::gather_row,
            finish: reference::finish_row,
        }
    }
}

/// What a frame stores and shows.
#[derive(PartialEq, Eq)]
struct Frame {
    layers: Vec<(Vec<u32>, Vec<u32>, Tally)>,
    entries: Vec<Entry>,
    closed: Vec<Entry>,
    counts: Closed,
    /// Without and with sub-cell scan-out.
    gathered: [Vec<Option<u32>>; 2],
    finished: Vec<u32>,
}

/// The words of a map.
fn words<F: Format>(map: &Galpixmap<'_, F>) -> Vec<u32> {
    map.planes().iter().take(map.record().words()).flat_map(|plane| plane.iter().copied()).collect()
}

fn entries(visibility: &Visibility<'_>) -> Vec<Entry> {
    (0..visibility.grid().cells()).map(|cell| visibility.at(cell)).collect()
}

/// Colours of all rows, those of cells that show nothing left out, and the same rows finished.
fn shown<F: Format>(
    forms: &Forms<F>,
    sources: &Sources<'_, '_, F>,
    threshold: i32,
) -> ([Vec<Option<u32>>; 2], Vec<u32>) {
    let grid = *sources.base().unwrap().grid();
    let width = grid.width() as usize;
    let rows: [Vec<Option<u32>>; 2] = [false, true].map(|sub_cell| {
        let mut colours = vec![0; grid.cells() as usize];
        for (&start, row) in grid.starts().iter().zip(colours.chunks_mut(width)) {
            (forms.gather)(sources.layers, &sources.visibility, start, &GatherRow { sub_cell, threshold }, row);
        }
        (0..).zip(colours).map(|(cell, colour)| sources.visibility.at(cell).is_some().then_some(colour)).collect()
    });
    let filled: Vec<u32> = (0u32..).zip(&rows[1]).map(|(cell, colour)| colour.unwrap_or(cell * 977)).collect();
    let mut finished = vec![7; grid.cells() as usize];
    let row = |y: usize| filled.chunks(width).nth(y).unwrap_or_default();
    for (y, to) in finished.chunks_mut(width).enumerate() {
        let gathered = [row(y.wrapping_sub(1)), row(y), row(y + 1)];
        let finish = Finish { grid, y: y as u32, threshold: threshold >> 1, gathered };
        (forms.finish)(sources, &finish, to);
    }
    (rows, finished)
}

/// Makes a frame.
fn frame<F: Format>(
    forms: &Forms<F>,
    sources: &mut Sources<'_, '_, F>,
    edge_threshold: u32,
    step: Option<(Rounding, u32)>,
) -> Frame {
    let (mut layers, mut first) = (Vec::new(), 0);
    sources.visibility.clear();
    for layer in sources.layers.iter_mut() {
        let tally = (forms.scatter)(layer, &mut sources.visibility, first, edge_threshold, step);
        first += layer.map.grid().cells();
        layers.push((words(&layer.map), layer.displacements.to_vec(), tally));
    }
    let threshold = threshold(edge_threshold, sources.base().unwrap().record().depth().bits.into());
    let entries_before = entries(&sources.visibility);
    let counts = (forms.close)(sources.layers, &mut sources.visibility, threshold);
    let (gathered, finished) = shown(forms, sources, threshold);
    Frame { layers, entries: entries_before, closed: entries(&sources.visibility), counts, gathered, finished }
}

/// How often what is rare happened, so that a test can say that it did.
#[derive(Debug, Default)]
struct Seen {
    lost: u32,
    saturated: u32,
    quads: usize,
    closed: usize,
    mixed: usize,
    finished: usize,
}

/// Makes some frames in both forms and compares them.
fn compare<F: Format>(shapes: &[Shape], format: F, layers: &[[Vec<u32>; 2]], edge_threshold: u32, seen: &mut Seen) {
    let roundings = [None, Some(Rounding::LowDiscrepancy), Some(Rounding::Nearest), Some(Rounding::Truncate)];
    let steps: Vec<_> =
        (5..).zip(roundings).map(|(frame, rounding)| rounding.map(|rounding| (rounding, frame))).collect();
    let made = |forms: Forms<F>| {
        let mut layers = layers.to_vec();
        with_shapes(shapes, format, &mut layers, &mut Random(9), |sources| {
            for layer in sources.layers.iter_mut() {
                let displacements = layer.displacements.to_vec();
                layer.begin(edge_threshold);
                layer.displacements.copy_from_slice(&displacements);
            }
            steps.iter().map(|&step| frame(&forms, sources, edge_threshold, step)).collect::<Vec<_>>()
        })
    };
    for (made, expected) in made(Forms::fast()).iter().zip(&made(Forms::reference())) {
        let what = (shapes, edge_threshold);
        assert!(made.layers == expected.layers, "words, displacements and tallies: {what:?}");
        assert!(made.entries == expected.entries, "entries: {what:?}");
        assert!(made.closed == expected.closed, "entries after cracks are closed: {what:?}");
        assert_eq!(made.counts, expected.counts, "counts: {what:?}");
        assert!(made.gathered == expected.gathered, "gathered rows: {what:?}");
        assert!(made.finished == expected.finished, "finished rows: {what:?}");
        assert!(made == expected);
        seen.lost += expected.layers.iter().map(|(_, _, tally)| tally.lost).sum::<u32>();
        seen.saturated += expected.layers.iter().map(|(_, _, tally)| tally.saturated).sum::<u32>();
        seen.quads += expected.entries.iter().filter(|entry| entry.is_some() && !entry.is_point()).count();
        seen.closed += expected.entries.iter().zip(&expected.closed).filter(|(before, after)| before != after).count();
        let colours = expected.gathered[0].iter().zip(&expected.gathered[1]);
        seen.mixed += colours.filter(|(stored, mixed)| stored != mixed).count();
        let colours = expected.gathered[1].iter().zip(&expected.finished);
        seen.finished += colours.filter(|(gathered, finished)| gathered.is_some_and(|it| it != **finished)).count();
    }
}

fn columns((width, _, margin): Shape) -> u32 {
    width + margin.left + margin.right
}

/// The thresholds that are tried.
const THRESHOLDS: [u32; 5] = [0, 1, 16, 1024, u32::MAX];

#[test]
fn fast_passes_equal_the_references_over_any_maps() {
    let (mut random, mut seen) = (Random(1), Seen::default());
    for (frac, layout) in FORMATS {
        let format = format(frac, layout);
        for shape in SHAPES {
            for (turn, look) in LOOKS.into_iter().cycle().take(15).enumerate() {
                let other = LOOKS[random.below(LOOKS.len() as u32) as usize];
                let looks = [look, other, Look::Tame];
                // Some layers have grids of their own, which are not wider.
                let shapes = [0, 1, 2].map(|layer| {
                    let own = SHAPES[random.below(SHAPES.len() as u32) as usize];
                    if layer > 0 && random.below(2) == 0 && columns(own) <= columns(shape) { own } else { shape }
                });
                let layers: Vec<_> = (looks.into_iter().zip(shapes))
                    .take(turn % 3 + 1)
                    .map(|(look, shape)| random_layer(&mut random, shape, format, look))
                    .collect();
                let threshold = THRESHOLDS[random.below(THRESHOLDS.len() as u32) as usize];
                compare(&shapes, format, &layers, threshold, &mut seen);
            }
        }
    }
    let Seen { lost, saturated, quads, closed, mixed, finished } = seen;
    assert!(lost > 1000 && saturated > 1000, "{lost} {saturated}");
    assert!(quads > 1000 && closed > 1000 && mixed > 1000 && finished > 1000, "{quads} {closed} {mixed} {finished}");
}

#[test]
fn formats_fixed_at_compile_time_give_the_same_bits() {
    let (mut random, mut seen) = (Random(2), Seen::default());
    for shape in SHAPES {
        for (turn, look) in LOOKS.into_iter().cycle().take(15).enumerate() {
            let threshold = THRESHOLDS[turn % THRESHOLDS.len()];
            let full = Dynamic::new(BITS, Layout::FULL).unwrap();
            let layers = [look, Look::Tame].map(|look| random_layer(&mut random, shape, full, look));
            compare(&[shape], Static::<Full>::new(), &layers, threshold, &mut seen);
            let small = Dynamic::new(BITS, Layout::VELOCITY_GRAY4).unwrap();
            let layers = [random_layer(&mut random, shape, small, look)];
            compare(&[shape], Static::<Small>::new(), &layers, threshold, &mut seen);
        }
    }
}

/// Velocities of up to 2^22 cells a frame: a step may be of more cells than a displacement holds.
#[test]
fn steps_of_any_number_of_cells_give_the_same_bits() {
    let (mut random, mut seen) = (Random(4), Seen::default());
    let component = Component { position_frac: 3, velocity_int: 23, ..BITS.x };
    let format = Dynamic::new(BITS.with_xy(component, component), Layout::FULL).unwrap();
    for shape in SHAPES {
        for look in LOOKS.into_iter().cycle().take(10) {
            let layers = [random_layer(&mut random, shape, format, look)];
            compare(&[shape], format, &layers, 1024, &mut seen);
        }
    }
    // In x, 2^16 and one cell, which is one cell but for the bits that a displacement lacks; in y none.
    for (cells, ends) in [(65537, 32767), (-65535, -32768), (32768, 32767), (-32769, -32768), (32767, 32767)] {
        let shape = (65, 2, Margin::NONE);
        let mut layers = [drawn(shape, format, |_, _| gray(9, 0.5, [f64::from(cells), 0.0]))];
        compare(&[shape], format, &layers, 1024, &mut seen);
        with_sources(shape, format, &mut layers, &mut Random(1), |sources| {
            sources.layers[0].begin(1024);
            let tally = sources.step(&crate::Settings::for_depth(16));
            let clamped = u32::from(cells != ends) * 130;
            assert_eq!((tally.moved, tally.lost, tally.saturated), (130, 130, clamped));
            assert!((0..130).all(|cell| sources.layers[0].displacement(cell) == [ends, 0]));
        });
    }
}

/// A near block leaves a picture whose samples beside it a renderer has mixed: at each of the block's sides, with
/// residuals of all signs.
#[test]
fn samples_beside_a_surface_that_has_gone_are_unmixed_alike() {
    let format = format(4, Layout { colour: Colour::GRAY8, ..Layout::FULL });
    let shape = (110, 40, Margin::NONE);
    let (block_x, block_y) = (30..80, 15..25);
    let mut seen = Seen::default();
    for slides in [[0.3, 0.3], [-0.3, 0.3], [0.3, -0.3], [-0.3, -0.3], [0.0, 0.3], [0.0, -0.3], [0.3, 0.0]] {
        let picture = |x: i32, y: i32| {
            let is_near = |x, y| block_x.contains(&x) && block_y.contains(&y);
            let is_beside = is_near(x - 1, y) || is_near(x + 1, y) || is_near(x, y - 1) || is_near(x, y + 1);
            match (is_near(x, y), is_beside) {
                (true, _) => gray(220, 0.25, [-20.0, 24.0]),
                (false, true) => gray(150, 0.75, slides),
                (false, false) => gray(100, 0.75, slides),
            }
        };
        let mut layers = [drawn(shape, format, picture)];
        compare(&[shape], format, &layers, 1024, &mut seen);
        with_sources(shape, format, &mut layers, &mut Random(1), |sources| {
            sources.layers[0].begin(1024);
            sources.step(&crate::Settings::for_depth(16));
            let threshold = threshold(1024, 16);
            let (rows, _) = shown(&Forms::fast(), sources, threshold);
            // A sample that is unmixed has at least half of the weight.
            let brightest = rows[1].iter().flatten().filter(|&&colour| colour != 220).max();
            assert!(brightest.is_some_and(|&brightest| brightest <= 125), "{slides:?}: {brightest:?}");
        });
    }
}

/// What is stored in links is only written by `begin`, but whatever it is, nothing panics; and as long as no link leads
/// out of the map, rows are gathered, closed and finished alike.
#[test]
fn any_links_give_the_bits_of_the_references_and_no_panic() {
    let mut random = Random(3);
    for (frac, layout) in FORMATS {
        let format = format(frac, layout);
        for shape in SHAPES {
            for look in [Look::Tame, Look::Grown, Look::Hostile] {
                let mut layers = [look, Look::Grown].map(|look| random_layer(&mut random, shape, format, look));
                // The feature `check` compares what is not compared here.
                let inside = cfg!(feature = "check") || random.below(4) > 0;
                let edge_threshold = THRESHOLDS[random.below(5) as usize];
                with_sources(shape, format, &mut layers, &mut Random(9), |sources| {
                    scramble(&mut random, sources, inside);
                    compare_links(sources, edge_threshold, inside);
                });
            }
        }
    }
}

/// Fills links by random words. With `inside` none of them leads out of the map.
fn scramble<F: Format>(random: &mut Random, sources: &mut Sources<'_, '_, F>, inside: bool) {
    for layer in sources.layers.iter_mut() {
        let grid = *layer.map.grid();
        for word in layer.links.iter_mut() {
            // Mostly linked; and rims mostly mixed.
            *word = random.next() | random.next() | if random.below(3) > 0 { random.next() | random.next() } else { 0 };
        }
        if !inside {
            continue;
        }
        for cell in 0..links::pair_words(&grid) as u32 * 8 {
            let (x, y) = (cell % grid.width(), cell / grid.width());
            let right = if x + 1 < grid.width() && y < grid.height() { 3 } else { 0 };
            let below = if y + 1 < grid.height() { 12 } else { 0 };
            layer.links[cell as usize / 8] &= !(15 << (cell % 8 * 4)) | (right | below) << (cell % 8 * 4);
        }
    }
}

/// Shows the samples with the links there are, and compares all passes that only read them.
fn compare_links(sources: &mut Sources<'_, '_, Dynamic>, edge_threshold: u32, inside: bool) {
    let (fast, reference) = (Forms::fast(), Forms::reference());
    let threshold = threshold(edge_threshold, sources.base().unwrap().record().depth().bits.into());
    let mut closed = [&fast, &reference].map(|forms| {
        sources.visibility.clear();
        let mut first = 0;
        for layer in sources.layers.iter_mut() {
            reference::scatter(layer, &mut sources.visibility, first, edge_threshold, None);
            first += layer.map.grid().cells();
        }
        let counts = (forms.close)(sources.layers, &mut sources.visibility, threshold);
        (entries(&sources.visibility), counts)
    });
    assert!(closed[0] == closed[1], "entries after cracks are closed");
    closed.reverse();
    let (made, expected) = (shown(&fast, sources, threshold), shown(&reference, sources, threshold));
    if inside {
        assert!(made == expected, "gathered and finished rows");
    }
    if cfg!(not(feature = "check")) {
        for layer in sources.layers.iter_mut() {
            (fast.scatter)(layer, &mut sources.visibility, 0, edge_threshold, Some((Rounding::Nearest, 1)));
        }
    }
}
