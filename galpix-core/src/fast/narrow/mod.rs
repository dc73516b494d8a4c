//! Propagation and resolution for processors without vector registers, where a buffer between the two stages costs more
//! than it saves.
//!
//! Neighbours mostly move alike. A **run** is a sequence of adjacent galpixels and debris with the same displacement,
//! whose fields do not overflow and whose new cells are still empty. A run is stepped directly from the old map into
//! the new one, part by part: a loop over its cells for x, one for y, and one for class and depth, so that everything a
//! loop needs stays in registers. If class or depth share a word with x or y, a single loop steps all three. A loop
//! that meets a galpixel that does not belong to the run ends the run there. A last loop steps the luminosity of what
//! belongs to it. All other galpixels are stepped one by one.

pub(crate) mod edge;

use core::ops::Range;

use crate::format::Format;
use crate::format::record::{MAX_WORDS, Record, Words};
use crate::format::rounding::Rounding;
use crate::frame::resolve::{self, NO_WINNER};
use crate::frame::step::{advance, step_depth_within, step_luminosity, step_plane_to, thresholds};
use crate::frame::tally::Tally;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// Propagates `front` by one frame into `back` and resolves collisions, see [`crate::frame::resolve::sweep`].
pub fn sweep<F: Format>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    winners: &mut [u32],
    rounding: Rounding,
    frame: u32,
) -> Tally {
    let grid = *front.grid();
    if grid != *back.grid() {
        return Tally::default();
    }
    let mut tally = Tally::default();
    let thresholds = thresholds(front.record(), rounding, frame);
    clear(back, winners, 0..grid.cells() as usize);
    let mut target = Target { back, winners, tally: &mut tally };
    for y in 0..grid.height() as i32 {
        sweep_row(front, y, &thresholds, &mut target);
    }
    tally
}

/// Makes some cells empty. Their other fields are not changed, except for those in the word of the class.
pub(crate) fn clear<F: Format>(back: &mut Galpixmap<'_, F>, winners: &mut [u32], cells: Range<usize>) {
    let record = *back.record();
    let (word, _) = record.class().words();
    let mut empty = [0; MAX_WORDS];
    record.class().set(&mut empty, Class::Empty as u32);
    if let Some(cells) = back.planes_mut()[word].get_mut(cells.clone()) {
        cells.fill(empty[word]);
    }
    if let Some(cells) = winners.get_mut(cells) {
        cells.fill(NO_WINNER);
    }
}

/// What a sweep writes. The rows of `back` may have other first cells than those of the old map.
pub(crate) struct Target<'t, 'p, F> {
    pub back: &'t mut Galpixmap<'p, F>,
    pub winners: &'t mut [u32],
    pub tally: &'t mut Tally,
}

/// Propagates row `y` of `front` into `target` and resolves collisions.
pub(crate) fn sweep_row<F: Format>(
    front: &Galpixmap<'_, F>,
    y: i32,
    thresholds: &[i32; 3],
    target: &mut Target<'_, '_, F>,
) {
    let width = front.grid().width();
    let Some(start) = front.grid().row(y) else { return };
    let mut x = 0;
    while x < width {
        let (source, place) = (start + x, [x as i32, y]);
        let class = front.class(source);
        if class == Class::Empty {
            x += 1;
            continue;
        }
        let mut stepped = 0;
        // Just-unobscured becomes debris in this step; it is rare, and runs do not support it.
        if class != Class::JustUnobscured
            && let Some(run) = run_at(front, source, place, thresholds, target.back)
        {
            stepped = step_run(front, &run, thresholds, target).unwrap_or(0);
            target.tally.moved += stepped;
        }
        if stepped == 0 {
            step_one(front, source, place, thresholds, target);
            stepped = 1;
        }
        x += stepped;
    }
}

/// A sequence of adjacent cells of a row that may have the same displacement.
struct Run {
    /// The first cell, in the old map.
    source: u32,
    /// The cell of the new map at which the galpixel of the first cell arrives.
    cell: u32,
    /// The largest number of cells, limited by the ends of the rows in the old and in the new map.
    most: u32,
    /// The lowest positions in x and y of a galpixel with the run's displacement, relative to its own cell.
    lowest: [i32; 2],
}

/// Returns the run that may begin with the galpixel of the cell `source` in column `x` of row `y`; `None` if it leaves
/// the map.
#[inline(always)]
fn run_at<F: Format>(
    front: &Galpixmap<'_, F>,
    source: u32,
    [x, y]: [i32; 2],
    thresholds: &[i32; 3],
    back: &Galpixmap<'_, F>,
) -> Option<Run> {
    let width = front.grid().width();
    let step = advance::<false>(front.record(), thresholds, &mut front.words_at(source)?);
    let moved = [step.dx, step.dy];
    let to_x = x + moved[0];
    let cell = back.grid().cell(to_x, y + moved[1])?;
    let lowest = |component: usize| {
        let frac = front.record().scales[component].position_frac;
        (moved[component] << frac) - ((1 << frac) >> 1)
    };
    let lowest = [lowest(0), lowest(1)];
    Some(Run { source, cell, most: width - x.max(to_x) as u32, lowest })
}

/// Repeats a block for each word, with its number as a constant, so that blocks of words that a record lacks are
/// removed at compile time.
macro_rules! each_word {
    ($word:ident => $block:block) => {
        const { assert!(MAX_WORDS == 8) }
        each_word!($word => $block: 0, 1, 2, 3, 4, 5, 6, 7);
    };
    ($word:ident => $block:block: $($number:literal),*) => {
        $({
            let $word: usize = $number;
            $block
        })*
    };
}

/// The part that a loop over the cells of a run steps: offset, velocity and acceleration in x.
const X: usize = 0;
/// Offset, velocity and acceleration in y.
const Y: usize = 1;
/// Class, and depth with its velocity and acceleration.
const DEPTH: usize = 2;
/// The three parts before, on which the end of a run depends.
const ALL: usize = 3;
/// Luminosity, its rate, and the colour.
const LUMINOSITY: usize = 4;

/// Steps a part of at most `count` galpixels of a run from the old map into the new one. Stops at the first one that
/// has another displacement, overflows, is empty or just unobscured, or arrives at an occupied cell. Returns how many
/// were stepped.
///
/// Not inlined: each part gets all registers for its loop.
#[inline(never)]
fn step_part<F: Format, const PART: usize>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    run: &Run,
    count: u32,
    thresholds: &[i32; 3],
) -> u32 {
    let record = *front.record();
    let stepped = words_of(&record, PART);
    let (class_word, _) = record.class().words();
    // Words that parts share: a later part continues with what an earlier one has written.
    let written = match PART {
        Y => words_of(&record, X),
        LUMINOSITY => words_of(&record, ALL),
        _ => 0,
    };
    let checks_class = PART == X || PART == ALL;
    let accessed = stepped | if checks_class { 1 << class_word } else { 0 };
    let from = run.source as usize..(run.source + count) as usize;
    let to = run.cell as usize..(run.cell + count) as usize;
    let mut sources: [&[u32]; MAX_WORDS] = [&[]; MAX_WORDS];
    let mut targets: [&mut [u32]; MAX_WORDS] = Default::default();
    let count = from.len();
    for (word, (source, target)) in front.planes().iter().zip(back.planes_mut()).enumerate() {
        if accessed >> word & 1 != 0 {
            match (source.get(from.clone()), target.get_mut(to.clone())) {
                (Some(source), Some(target)) if target.len() == count => {
                    (sources[word], targets[word]) = (source, target)
                }
                _ => return 0,
            }
        }
    }
    let (thresholds, lowest) = (*thresholds, run.lowest);
    let mut lane = 0;
    while lane < count {
        let mut words = [0; MAX_WORDS];
        each_word!(word => {
            if stepped >> word & 1 != 0 {
                words[word] = if written >> word & 1 != 0 { at(targets[word], lane) } else { at(sources[word], lane) };
            }
        });
        if checks_class {
            // The lower bit of the class is set if a cell is empty or just unobscured. A sweep stores nothing that is
            // just unobscured, so that in the new map the bit marks the empty cells.
            let free = at(targets[class_word], lane) & !at(sources[class_word], lane);
            if free >> record.class().shift & 1 == 0 {
                break;
            }
        }
        let mut belongs = true;
        if (PART == X || PART == ALL) && record.layout().velocity {
            belongs = belongs && step_plane_to::<0>(&record, thresholds[0], lowest[0], &mut words);
        }
        if (PART == Y || PART == ALL) && record.layout().velocity {
            belongs = belongs && step_plane_to::<1>(&record, thresholds[1], lowest[1], &mut words);
        }
        if (PART == DEPTH || PART == ALL) && record.layout().depth_motion {
            belongs = belongs && step_depth_within(&record, thresholds[2], &mut words);
        }
        if PART == LUMINOSITY {
            step_luminosity(&record, &mut words);
        }
        if !belongs {
            break;
        }
        each_word!(word => {
            if stepped >> word & 1 != 0
                && let Some(target) = targets[word].get_mut(lane)
            {
                *target = words[word];
            }
        });
        lane += 1;
    }
    lane as u32
}

/// Returns a word of a slice that is long enough.
///
/// With an index instead of `get`, rustc 1.95 for thumbv6m and thumbv7m leaves bounds checks and panics in the
/// [`step_part`] of [`crate::Dynamic`].
#[inline(always)]
fn at(words: &[u32], lane: usize) -> u32 {
    words.get(lane).copied().unwrap_or_default()
}

/// Returns the set of words with the fields of a part, as a bit for each word.
#[inline(always)]
fn words_of(record: &Record, part: usize) -> u32 {
    let moving = |component: usize| record.velocity(component).word_set() | record.acceleration(component).word_set();
    let plane = |component: usize| {
        if record.layout().velocity { record.offset(component).word_set() | moving(component) } else { 0 }
    };
    let depth = if record.layout().depth_motion { record.depth().word_set() | moving(2) } else { 0 };
    let class = record.class().word_set();
    let luminosity = if record.layout().luminosity {
        record.luminosity().word_set() | record.luminosity_rate().word_set() | record.colour().word_set()
    } else {
        0
    };
    match part {
        X | Y => plane(part),
        DEPTH => class | depth,
        LUMINOSITY => luminosity,
        _ => class | depth | plane(X) | plane(Y),
    }
}

/// Steps the galpixels of a run; returns how many belong to it.
fn step_run<F: Format>(
    front: &Galpixmap<'_, F>,
    run: &Run,
    thresholds: &[i32; 3],
    target: &mut Target<'_, '_, F>,
) -> Option<u32> {
    let record = front.record();
    let (back, winners) = (&mut *target.back, &mut *target.winners);
    let mut count = run.most;
    if (words_of(record, X) | words_of(record, Y)) & words_of(record, DEPTH) == 0 {
        // A new cell stays empty until its class is written, so that a later part may still shorten the run.
        count = step_part::<F, X>(front, back, run, count, thresholds);
        count = step_part::<F, Y>(front, back, run, count, thresholds);
        count = step_part::<F, DEPTH>(front, back, run, count, thresholds);
    } else {
        count = step_part::<F, ALL>(front, back, run, count, thresholds);
    }
    if record.layout().luminosity {
        count = step_part::<F, LUMINOSITY>(front, back, run, count, thresholds);
    }
    let from = run.source as usize..(run.source + count) as usize;
    let to = run.cell as usize..(run.cell + count) as usize;
    let unchanged = !(words_of(record, ALL) | words_of(record, LUMINOSITY));
    for (word, (source, target)) in front.planes().iter().zip(back.planes_mut()).enumerate().take(record.words()) {
        if unchanged >> word & 1 != 0 {
            target.get_mut(to.clone())?.copy_from_slice(source.get(from.clone())?);
        }
    }
    if let Some(winners) = winners.get_mut(to) {
        let (fours, remainder) = winners.as_chunks_mut::<4>();
        let mut source = run.source;
        for four in fours {
            *four = [source, source + 1, source + 2, source + 3];
            source += 4;
        }
        for winner in remainder {
            *winner = source;
            source += 1;
        }
    }
    Some(count)
}

/// Steps the galpixel or debris of the cell `source` in column `x` of row `y`, and resolves a collision.
#[inline(never)]
fn step_one<F: Format>(
    front: &Galpixmap<'_, F>,
    source: u32,
    [x, y]: [i32; 2],
    thresholds: &[i32; 3],
    target: &mut Target<'_, '_, F>,
) {
    let (back, tally) = (&mut *target.back, &mut *target.tally);
    let Some(mut words) = front.words_at(source) else { return };
    let step = advance::<true>(front.record(), thresholds, &mut words);
    tally.moved += 1;
    tally.saturated += step.saturated();
    let Some(cell) = back.grid().cell(x + step.dx, y + step.dy) else {
        tally.lost += 1;
        return;
    };
    if challenge(back, cell, &words, tally)
        && let Some(winner) = target.winners.get_mut(cell as usize)
    {
        *winner = source;
    }
}

/// Stores a galpixel in a cell if it is nearer than what the cell holds. Returns whether it is.
///
/// A function, whose arguments have no alias: in [`step_one`], where they are fields, rustc 1.95 for thumbv7m reads the
/// planes' addresses again after each count, 3 % of a sweep of noise.
#[inline(always)]
fn challenge<F: Format>(back: &mut Galpixmap<'_, F>, cell: u32, words: &Words, tally: &mut Tally) -> bool {
    let Some(incumbent) = back.key_at(cell) else { return false };
    tally.collided += (back.class_of(incumbent) != Class::Empty as u32) as u32;
    // In raster order the incumbent has the smaller source, so that it wins if the keys are equal.
    let nearer = resolve::key(back.record(), words) < incumbent;
    if nearer {
        back.put(cell, words);
    }
    nearer
}
