//! The feature `check`: runs each fast pass and its reference on copies, and compares the results.
//!
//! Runs both the wide and the narrow form, whichever the machine uses. Panics if results differ. For tests on a host.
//! Of many passes, and of passes over large maps, a sample is compared, see [`due`].

extern crate std;

use core::cell::Cell;
use std::vec;
use std::vec::Vec;

use super::rolling::Rolling;
use super::{narrow, wide};
use crate::format::Format;
use crate::format::rounding::Rounding;
use crate::frame::fill::Around;
use crate::frame::tally::Tally;
use crate::frame::{self, Scratch, Settings, edge, reference};
use crate::map::Galpixmap;
use crate::map::galpixel::Class;
use crate::source::row::{self, Finish, GatherRow};
use crate::source::visibility::EMPTY;
use crate::source::{self, Source, Sources, Visibility};

/// Maps of up to this number of cells are small.
const SMALL: u32 = 1 << 13;

/// Of the passes over small maps, the first ones of each thread are all compared.
const ALL: usize = 1 << 12;

/// Of the others, one in this number: a prime, so that all passes of a frame take turns.
const SAMPLE: usize = 13;

/// Returns whether a pass over a map of this number of cells is to be compared with its reference. A test has a thread
/// of its own, and with it a count of its own. Comparing every pass of the tests that enumerate millions of maps, or
/// run captures, would take up to ten times their time.
pub(crate) fn due(cells: u32) -> bool {
    std::thread_local! { static PASSES: Cell<usize> = const { Cell::new(0) }; }
    let passes = PASSES.get();
    PASSES.set(passes.wrapping_add(1));
    cells <= SMALL && passes < ALL || passes.is_multiple_of(SAMPLE)
}

/// Returns the words of a map, plane by plane.
pub(crate) fn words<F: Format>(map: &Galpixmap<'_, F>) -> Vec<u32> {
    map.planes().iter().take(map.record().words()).flat_map(|plane| plane.iter().copied()).collect()
}

/// Runs a pass on a copy of a map. Returns the words of the copy afterwards, and what the pass returned.
pub(crate) fn on_copy<F: Format, R>(
    map: &Galpixmap<'_, F>,
    pass: impl FnOnce(&mut Galpixmap<'_, F>) -> R,
) -> (Vec<u32>, R) {
    let mut memory = words(map);
    let mut copy = Galpixmap::over(*map.grid(), map.format(), &mut memory).expect("a copy has the words of its map");
    let result = pass(&mut copy);
    (words(&copy), result)
}

/// Compares the edge maps that all forms make.
pub(crate) fn mark<F: Format>(front: &Galpixmap<'_, F>, threshold: u32, edges: &[u32]) {
    if !due(front.grid().cells()) {
        return;
    }
    let made = |mark: fn(&Galpixmap<'_, F>, u32, &mut [u32]) -> u32| {
        let mut edges = edges.to_vec();
        let count = mark(front, threshold, &mut edges);
        (edges, count)
    };
    let expected = made(reference::edge::mark);
    assert_eq!(made(wide::edge::mark), expected, "the wide form of the edge map");
    assert_eq!(made(narrow::edge::mark), expected, "the narrow form of the edge map");
}

/// A form of [`super::sweep`].
type Sweep<F> = fn(&Galpixmap<'_, F>, &mut Galpixmap<'_, F>, &mut [u32], Rounding, u32) -> Tally;

/// Compares what all forms of propagation and resolution store in the cells that something reached.
pub(crate) fn sweep<F: Format>(
    front: &Galpixmap<'_, F>,
    back: &Galpixmap<'_, F>,
    winners: &[u32],
    rounding: Rounding,
    frame: u32,
) {
    if front.grid() != back.grid() || !due(front.grid().cells()) {
        return;
    }
    let made = |sweep: Sweep<F>| {
        let mut winners = winners.to_vec();
        on_copy(back, |back| {
            let tally = sweep(front, back, &mut winners, rounding, frame);
            let cells = (0..back.grid().cells()).map(|cell| {
                let reached = back.class(cell) != Class::Empty;
                let winner = winners.get(cell as usize).copied();
                reached.then(|| (back.words_at(cell), winner))
            });
            (cells.collect::<Vec<_>>(), tally)
        })
        .1
    };
    let expected = made(reference::sweep);
    assert_eq!(made(wide::sweep), expected, "the wide form of propagation and resolution");
    assert_eq!(made(narrow::sweep), expected, "the narrow form of propagation and resolution");
}

/// A form of a fill.
type Fill<'f, F> = dyn Fn(&mut Galpixmap<'_, F>, &mut Scratch<'_>, &mut Tally) + 'f;

/// Compares the results of both forms of a fill.
fn compare_fills<F: Format>(
    back: &Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    tally: &Tally,
    fills: [&Fill<'_, F>; 2],
) {
    if !due(back.grid().cells()) {
        return;
    }
    let [expected, made] = fills.map(|fill| {
        let (mut winners, mut edges, mut tally) = (scratch.winners.to_vec(), scratch.edges.to_vec(), *tally);
        let mut scratch = Scratch { winners: &mut winners, edges: &mut edges };
        let (words, ()) = on_copy(back, |back| fill(back, &mut scratch, &mut tally));
        (words, winners, tally)
    });
    assert_eq!(made, expected, "the fast form of the fill");
}

/// Compares both forms of the fill of all holes.
pub(crate) fn fill<F: Format>(
    around: &impl Around,
    back: &Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    tally: &Tally,
) {
    compare_fills(
        back,
        scratch,
        tally,
        [&|back, scratch, tally| reference::fill(around, back, scratch, settings, tally), &|back, scratch, tally| {
            super::fill::fill(around, back, scratch, settings, tally)
        }],
    );
}

/// Compares both forms of the fill of bullet holes.
pub(crate) fn fill_bullets<F: Format>(back: &Galpixmap<'_, F>, scratch: &mut Scratch<'_>, reach: u32, tally: &Tally) {
    compare_fills(
        back,
        scratch,
        tally,
        [&|back, scratch, tally| reference::fill_bullets(back, scratch, reach, tally), &|back, scratch, tally| {
            super::fill::fill_bullets(back, scratch, reach, tally)
        }],
    );
}

/// Compares the links of the samples of a map, which were made with `edge_threshold`, with those of the reference.
pub(crate) fn link<F: Format>(map: &Galpixmap<'_, F>, edge_threshold: u32, links: &[u32]) {
    if !due(map.grid().cells()) {
        return;
    }
    let mut expected = links.to_vec();
    source::reference::link(map, edge_threshold, &mut expected);
    assert_eq!(links, expected, "the fast form of links");
}

/// A form of [`super::scatter`].
type Scatter<F> = fn(&mut Source<'_, F>, &mut Visibility<'_>, u32, u32, Option<(Rounding, u32)>) -> Tally;

/// Runs a pass on a copy of a visibility buffer. Returns keys and words of the copy afterwards, and what the pass
/// returned.
fn on_copied_visibility<R>(
    visibility: &mut Visibility<'_>,
    pass: impl FnOnce(&mut Visibility<'_>) -> R,
) -> (Vec<u16>, Vec<u32>, R) {
    let grid = visibility.grid();
    let (keys, words, line) = visibility.planes();
    let (mut keys, mut words, mut line) = (keys.to_vec(), words.to_vec(), line.to_vec());
    let mut copy = Visibility::new(&grid, &mut keys, &mut words, &mut line).expect("a copy is as long");
    let result = pass(&mut copy);
    (keys, words, result)
}

/// Compares what both forms store and show of the samples of a layer.
pub(crate) fn scatter<F: Format>(
    source: &Source<'_, F>,
    visibility: &mut Visibility<'_>,
    first: u32,
    edge_threshold: u32,
    step: Option<(Rounding, u32)>,
) {
    let map = source.map();
    if !due(map.grid().cells()) {
        return;
    }
    let mut made = |scatter: Scatter<F>| {
        on_copied_visibility(visibility, |visibility| {
            let (mut memory, mut displacements) = (words(map), source.displacements.to_vec());
            let mut links = source.links.to_vec();
            let copy = Galpixmap::over(*map.grid(), map.format(), &mut memory).expect("a copy is as long");
            let mut copy = Source::new(copy, &mut displacements, &mut links).expect("a copy is as long");
            let tally = scatter(&mut copy, visibility, first, edge_threshold, step);
            (memory, displacements, links, tally)
        })
    };
    let expected = made(source::reference::scatter);
    assert_eq!(made(wide::source::scatter::scatter), expected, "the fast form of the steps and entries of samples");
}

/// Compares what both forms show where cracks are closed.
pub(crate) fn close_cracks<F: Format>(sources: &[Source<'_, F>], visibility: &mut Visibility<'_>, threshold: i32) {
    if !due(visibility.grid().cells()) {
        return;
    }
    let expected = on_copied_visibility(visibility, |copy| source::reference::close(sources, copy, threshold));
    let made = on_copied_visibility(visibility, |copy| wide::source::cracks::close(sources, copy, threshold));
    assert_eq!(made, expected, "the fast form of closing cracks");
}

/// Compares the colours that both forms gather in the cells of a row that show a sample.
pub(crate) fn gather_row<F: Format>(
    layers: &[Source<'_, F>],
    visibility: &Visibility<'_>,
    start: u32,
    gather: &GatherRow,
    colours: &[u32],
) {
    if !due(colours.len() as u32) {
        return;
    }
    let (keys, _) = visibility.cells_from(start, colours.len());
    let shown = |colours: Vec<u32>| -> Vec<_> {
        keys.iter().zip(colours).map(|(&key, colour)| (key != EMPTY).then_some(colour)).collect()
    };
    let (mut expected, mut made) = (colours.to_vec(), colours.to_vec());
    row::gather_row(layers, visibility, start, gather, &mut expected);
    wide::source::gather::gather_row(layers, visibility, start, gather, &mut made);
    assert_eq!(shown(made), shown(expected), "the fast form of a gathered row");
}

/// Compares the colours of a row that both forms finish.
pub(crate) fn finish_row<F: Format>(sources: &Sources<'_, '_, F>, finish: &Finish<'_>, colours: &[u32]) {
    if !due(colours.len() as u32) {
        return;
    }
    let (mut expected, mut made) = (colours.to_vec(), colours.to_vec());
    source::reference::finish_row(sources, finish, &mut expected);
    wide::source::finish::finish(sources, finish, &mut made);
    assert_eq!(made, expected, "the fast form of a finished row");
}

/// The next frame of a [`Rolling`] map, made with two maps.
pub(crate) struct Expected(Option<(Vec<u32>, Tally)>);

/// Makes the next frame of a rolling map with two maps. Expects nothing if the window reduces the reach, or if the pass
/// is not [`due`].
pub(crate) fn rolling<F: Format>(rolling: &Rolling<'_, F>, settings: &Settings) -> Expected {
    let map = rolling.map();
    let provided = rolling.scratch();
    if settings.fill_mode.rounds(settings.reach) > rolling.rounds() || !due(map.grid().cells()) {
        return Expected(None);
    }
    let cells = if provided.winners.is_empty() { 0 } else { map.grid().cells() as usize };
    let words = if provided.edges.is_empty() { 0 } else { edge::words(map.grid()) };
    let (mut winners, mut edges) = (vec![0; cells], vec![0; words]);
    let mut scratch = Scratch { winners: &mut winners, edges: &mut edges };
    let made = |back: &mut Galpixmap<'_, F>| frame::make::<F, true>(map, back, &mut scratch, settings, rolling.frame());
    Expected(Some(on_copy(map, made)))
}

impl Expected {
    /// Compares the expected frame with the map of the rolling map.
    pub(crate) fn compare<F: Format>(self, map: &Galpixmap<'_, F>, tally: &Tally) {
        if let Some(expected) = self.0 {
            assert_eq!((words(map), *tally), expected, "a frame of one map and a window");
        }
    }
}
