//! The sweep for processors without vector registers, where a buffer between the two stages costs more than it saves.
//!
//! Neighbours mostly move alike. A **stretch** is a run of galpixels and debris with one displacement, whose fields do not
//! stray and whose new cells are still empty. It is taken straight from the old map into the new one, part by part: a loop
//! over its cells for x, one for y, one for class and depth, so that what a loop needs stays in registers; one loop for all
//! three where class or depth share a word with x or y. A loop that meets a galpixel of another kind ends the stretch there. All else
//! goes galpixel by galpixel.

pub(crate) mod edge;

use core::ops::Range;

use crate::format::Format;
use crate::format::record::{MAX_WORDS, Record};
use crate::format::rounding::Rounding;
use crate::frame::resolve::{self, NO_WINNER};
use crate::frame::step::{advance, depth_within, plane_along, step_luminosity, thresholds};
use crate::frame::tally::Tally;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// [`super::sweep`] for processors without vector registers: the same arguments, the same bits.
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
    for y in 0..grid.height() as i32 {
        sweep_row(front, y, &thresholds, back, winners, &mut tally);
    }
    tally
}

/// Makes some cells empty. Their other fields stay what they were, unless they share the class's word.
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

/// Takes row `y` of `front` to where its galpixels go in `back`, whose rows may lie elsewhere.
pub(crate) fn sweep_row<F: Format>(
    front: &Galpixmap<'_, F>,
    y: i32,
    thresholds: &[i32; 3],
    back: &mut Galpixmap<'_, F>,
    winners: &mut [u32],
    tally: &mut Tally,
) {
    let width = front.grid().width();
    let Some(start) = front.grid().row(y) else { return };
    let mut x = 0;
    while x < width {
        let source = start + x;
        let class = front.class(source);
        if class == Class::Empty {
            x += 1;
            continue;
        }
        let mut taken = 0;
        // What was just unobscured becomes debris in this step: it is no common case.
        if class != Class::JustUnobscured
            && let Some(stretch) = stretch(front, source, x, y, thresholds, back)
        {
            taken = take_stretch(front, &stretch, thresholds, back, winners).unwrap_or(0);
            tally.moved += taken;
        }
        if taken == 0 {
            take_one(front, source, x, y, thresholds, back, winners, tally);
            taken = 1;
        }
        x += taken;
    }
}

/// Neighbours that go the same way, at most so many as stay in their row and in the map.
struct Stretch {
    /// The first cell that they come from.
    source: u32,
    /// The first cell that they go to.
    cell: u32,
    /// How many there are at most.
    most: u32,
    /// The lowest positions in x and y that are in the cell to which they go.
    lowest: [i32; 2],
}

/// The stretch that may begin with the galpixel at `source`; nothing if that leaves the map.
#[inline(always)]
fn stretch<F: Format>(
    front: &Galpixmap<'_, F>,
    source: u32,
    x: u32,
    y: i32,
    thresholds: &[i32; 3],
    back: &Galpixmap<'_, F>,
) -> Option<Stretch> {
    let width = front.grid().width();
    let step = advance::<false>(front.record(), thresholds, &mut front.words_at(source)?);
    let moved = [step.dx, step.dy];
    let to_x = x as i32 + moved[0];
    let cell = back.grid().cell(to_x, y + moved[1])?;
    let lowest = |component: usize| {
        let frac = front.record().scales[component].position_frac;
        (moved[component] << frac) - ((1 << frac) >> 1)
    };
    let lowest = [lowest(0), lowest(1)];
    Some(Stretch { source, cell, most: width - x.max(to_x as u32), lowest })
}

/// The block for each word, one after the other: what a record does not have falls away.
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

/// What a loop over the cells of a stretch takes along.
const X: usize = 0;
/// See [`X`].
const Y: usize = 1;
/// See [`X`].
const DEPTH: usize = 2;
/// See [`X`].
const ALL: usize = 3;

/// Takes the words of a part of what moves from where a stretch is to where it goes, a step further: of at most `count`
/// galpixels, up to the first that goes another way, is empty or just unobscured, or goes to a cell that is taken. Returns how many.
#[inline(never)]
fn pass<F: Format, const PART: usize>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    stretch: &Stretch,
    count: u32,
    thresholds: &[i32; 3],
) -> u32 {
    let record = *front.record();
    let set = words_of(&record, PART);
    let (class_word, _) = record.class().words();
    // What x has written, y takes on from there.
    let written = if PART == Y { words_of(&record, X) } else { 0 };
    let looks = PART == X || PART == ALL;
    let looked_at = set | if looks { 1 << class_word } else { 0 };
    let from = stretch.source as usize..(stretch.source + count) as usize;
    let to = stretch.cell as usize..(stretch.cell + count) as usize;
    let mut sources: [&[u32]; MAX_WORDS] = [&[]; MAX_WORDS];
    let mut targets: [&mut [u32]; MAX_WORDS] = Default::default();
    let count = from.len();
    for (word, (source, target)) in front.planes().iter().zip(back.planes_mut()).enumerate() {
        if looked_at >> word & 1 != 0 {
            match (source.get(from.clone()), target.get_mut(to.clone())) {
                (Some(source), Some(target)) if target.len() == count => {
                    (sources[word], targets[word]) = (source, target)
                }
                _ => return 0,
            }
        }
    }
    let (thresholds, lowest) = (*thresholds, stretch.lowest);
    let mut lane = 0;
    while lane < count {
        let mut words = [0; MAX_WORDS];
        each_word!(word => {
            if set >> word & 1 != 0 {
                words[word] = if written >> word & 1 != 0 { at(targets[word], lane) } else { at(sources[word], lane) };
            }
        });
        if looks {
            // The lower bit of the class: what was just unobscured and what is empty has it. Of what a sweep puts into
            // cells nothing has, so that it tells a cell that is empty.
            let open = at(targets[class_word], lane) & !at(sources[class_word], lane);
            if open >> record.class().shift & 1 == 0 {
                break;
            }
        }
        let mut along = true;
        if (PART == X || PART == ALL) && record.layout().velocity {
            along = along && plane_along::<0>(&record, thresholds[0], lowest[0], &mut words);
        }
        if (PART == Y || PART == ALL) && record.layout().velocity {
            along = along && plane_along::<1>(&record, thresholds[1], lowest[1], &mut words);
        }
        if (PART == DEPTH || PART == ALL) && record.layout().depth_motion {
            along = along && depth_within(&record, thresholds[2], &mut words);
        }
        if !along {
            break;
        }
        each_word!(word => {
            if set >> word & 1 != 0
                && let Some(target) = targets[word].get_mut(lane)
            {
                *target = words[word];
            }
        });
        lane += 1;
    }
    lane as u32
}

/// A word of a slice that is long enough. Not every level of optimisation sees that it is, and an index would leave a panic.
#[inline(always)]
fn at(words: &[u32], lane: usize) -> u32 {
    words.get(lane).copied().unwrap_or_default()
}

/// The words of all that moves in a part. The class goes with the depth.
#[inline(always)]
fn words_of(record: &Record, part: usize) -> u32 {
    let moving = |component: usize| record.velocity(component).word_set() | record.acceleration(component).word_set();
    let plane = |component: usize| {
        if record.layout().velocity { record.offset(component).word_set() | moving(component) } else { 0 }
    };
    let depth = if record.layout().depth_motion { record.depth().word_set() | moving(2) } else { 0 };
    let class = record.class().word_set();
    match part {
        X | Y => plane(part),
        DEPTH => class | depth,
        _ => class | depth | plane(X) | plane(Y),
    }
}

/// Takes the galpixels of a stretch: how many they are.
fn take_stretch<F: Format>(
    front: &Galpixmap<'_, F>,
    stretch: &Stretch,
    thresholds: &[i32; 3],
    back: &mut Galpixmap<'_, F>,
    winners: &mut [u32],
) -> Option<u32> {
    let record = front.record();
    let mut count = stretch.most;
    if (words_of(record, X) | words_of(record, Y)) & words_of(record, DEPTH) == 0 {
        // Until the class is written a cell is empty, whatever its other fields hold.
        count = pass::<F, X>(front, back, stretch, count, thresholds);
        count = pass::<F, Y>(front, back, stretch, count, thresholds);
        count = pass::<F, DEPTH>(front, back, stretch, count, thresholds);
    } else {
        count = pass::<F, ALL>(front, back, stretch, count, thresholds);
    }
    let from = stretch.source as usize..(stretch.source + count) as usize;
    let to = stretch.cell as usize..(stretch.cell + count) as usize;
    let rest = !words_of(record, ALL);
    for (word, (source, target)) in front.planes().iter().zip(back.planes_mut()).enumerate().take(record.words()) {
        if rest >> word & 1 != 0 {
            target.get_mut(to.clone())?.copy_from_slice(source.get(from.clone())?);
        }
    }
    if record.layout().luminosity {
        for cell in to.start as u32..to.end as u32 {
            let mut words = back.words_at(cell)?;
            step_luminosity(record, &mut words);
            back.put(cell, &words);
        }
    }
    if let Some(winners) = winners.get_mut(to) {
        let (fours, rest) = winners.as_chunks_mut::<4>();
        let mut source = stretch.source;
        for four in fours {
            *four = [source, source + 1, source + 2, source + 3];
            source += 4;
        }
        for winner in rest {
            *winner = source;
            source += 1;
        }
    }
    Some(count)
}

/// Takes one galpixel or piece of debris, whatever it is and wherever it goes.
#[inline(never)]
#[allow(clippy::too_many_arguments)]
fn take_one<F: Format>(
    front: &Galpixmap<'_, F>,
    source: u32,
    x: u32,
    y: i32,
    thresholds: &[i32; 3],
    back: &mut Galpixmap<'_, F>,
    winners: &mut [u32],
    tally: &mut Tally,
) {
    let Some(mut words) = front.words_at(source) else { return };
    let step = advance::<true>(front.record(), thresholds, &mut words);
    tally.moved += 1;
    tally.saturated += step.saturated();
    let Some(cell) = back.grid().cell(x as i32 + step.dx, y + step.dy) else {
        tally.lost += 1;
        return;
    };
    let Some(incumbent) = back.key_at(cell) else { return };
    tally.collided += (back.class_of(incumbent) != Class::Empty as u32) as u32;
    // In raster order the incumbent has the smaller source: of equal keys it stays.
    if resolve::key(back.record(), &words) < incumbent {
        back.put(cell, &words);
        if let Some(winner) = winners.get_mut(cell as usize) {
            *winner = source;
        }
    }
}
