//! Stages 1 and 2 fused: propagates a whole map and resolves it, in raster order, with no buffer between.
//!
//! Neighbours mostly move alike. A row is taken in chunks of 64 cells; all of a chunk's galpixels are moved at
//! once, and then each run of neighbours with equal displacements is stored as a whole, wherever it goes. The result is
//! what [`crate::frame::step::arrivals`] and [`crate::frame::resolve::settle`] define, bit by bit: in raster order an incumbent has
//! the smaller source, so that comparing keys alone decides.
//!
//! A chunk that is all empty is skipped, and one that holds only what neither moves nor changes is stored as it is: its step
//! would give the same words. The first galpixel of a chunk mostly tells that it is neither.
//!
//! Rows of the new map are cleared just before they are first needed, while the old map's neighbourhood is in the cache.

pub(crate) mod edge;
mod planes;

use core::ops::Range;

use crate::format::Format;
use crate::format::record::{MAX_WORDS, Record, Words};
use crate::format::rounding::Rounding;
use crate::frame::resolve::{self, NO_WINNER};
use crate::frame::step::{advance, thresholds};
use crate::frame::tally::Tally;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;
use planes::Planes;

/// Cells that are moved at once: enough for vector code, few enough to stay in the first cache.
const CHUNK: usize = 64;

/// Empty cells go a way of their own, and no galpixel does: no budget has velocities of 2^30.
const NOWHERE: u32 = 30;

/// Shorter runs go galpixel by galpixel.
const SHORT_RUN: usize = 4;

/// Rows that are cleared at once.
const ROWS_AHEAD: i32 = 4;

/// The new map while it is filled.
struct Target<'t, 'p, F> {
    back: &'t mut Galpixmap<'p, F>,
    winners: &'t mut [u32],
    /// Cells before this one are cleared or hold arrivals.
    cleared: u32,
    /// The bits that are 0 in what neither moves nor changes.
    motion_bits: Words,
    tally: Tally,
}

/// A chunk on its way: its galpixels after the step, and where they were. Made once for all chunks.
struct Chunk {
    /// `words[word][lane]`.
    words: [[u32; CHUNK]; MAX_WORDS],
    keys: [u32; CHUNK],
    /// Cells moved.
    dx: [i32; CHUNK],
    dy: [i32; CHUNK],
    /// Cells that the lane before moved; the first lane's own for the first.
    before_dx: [i32; CHUNK],
    before_dy: [i32; CHUNK],
    /// Not 0 where a lane does not go with the one before it: there a run ends.
    turns: [i32; CHUNK],
    x: i32,
    y: i32,
    source: u32,
}

/// Propagates `front` by one frame into `back` and resolves collisions.
///
/// `frame` is the frame counter of `front`; it may wrap. `winners` is either empty, and then nobody's origin is kept, or
/// has a word for each cell. Cells that nothing reached are of class empty; their other fields and their winner are
/// not defined before [`crate::frame::fill`] has gone over them. Both maps must have the same grid, else nothing is done.
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
    let thresholds = thresholds(front.record(), rounding, frame);
    let motion_bits = motion_bits(front.record());
    let mut target = Target { back, winners, cleared: 0, motion_bits, tally: Tally::default() };
    let mut chunk = Chunk {
        words: [[0; CHUNK]; MAX_WORDS],
        keys: [0; CHUNK],
        dx: [0; CHUNK],
        dy: [0; CHUNK],
        before_dx: [0; CHUNK],
        before_dy: [0; CHUNK],
        turns: [0; CHUNK],
        x: 0,
        y: 0,
        source: 0,
    };
    // The words before the step, at the end of a row.
    let mut rest = [[0; CHUNK]; MAX_WORDS];
    for (y, &start) in grid.starts().iter().enumerate() {
        let mut x = 0;
        while x < grid.width() {
            let cells = (grid.width() - x).min(CHUNK as u32);
            (chunk.x, chunk.y, chunk.source) = (x as i32, y as i32, start + x);
            target.take(front, &thresholds, &mut chunk, &mut rest, cells as usize);
            x += cells;
        }
    }
    target.clear_to(grid.cells());
    target.tally
}

/// All bits of velocities and accelerations, and the one of the class that empty cells and what was just unobscured have: where
/// these are 0, a step changes nothing. Without them the position's threshold is dropped again, and the rest of the position
/// is less than half a cell.
fn motion_bits(record: &Record) -> Words {
    let mut motion_bits = [0; MAX_WORDS];
    for component in 0..3 {
        record.velocity(component).set(&mut motion_bits, u32::MAX);
        record.acceleration(component).set(&mut motion_bits, u32::MAX);
    }
    record.class().set(&mut motion_bits, Class::Empty as u32 & Class::JustUnobscured as u32);
    motion_bits
}

/// The chunk of a plane that begins at `source`; where fewer than [`CHUNK`] cells are left of the row, their copy in `rest`.
#[inline(always)]
fn lanes_of<'l>(plane: &'l [u32], source: u32, cells: usize, rest: &'l mut [u32; CHUNK]) -> &'l [u32; CHUNK] {
    let plane = plane.get(source as usize..).unwrap_or_default();
    if cells == CHUNK
        && let Some(lanes) = plane.first_chunk::<CHUNK>()
    {
        return lanes;
    }
    for (to, &from) in rest.iter_mut().zip(plane).take(cells) {
        *to = from;
    }
    rest
}

/// The step of a chunk, galpixel by galpixel: by which bits fields of any of them overflowed.
#[inline(always)]
fn step_lanes(record: &Record, thresholds: &[i32; 3], sources: &[&[u32; CHUNK]; MAX_WORDS], chunk: &mut Chunk) -> i32 {
    let mut overflowed = 0;
    for lane in 0..CHUNK {
        let mut words = [0; MAX_WORDS];
        for (word, lanes) in words.iter_mut().zip(sources).take(record.words()) {
            *word = lanes[lane];
        }
        let step = advance::<false>(record, thresholds, &mut words);
        for (word, lanes) in words.iter().zip(&mut chunk.words).take(record.words()) {
            lanes[lane] = *word;
        }
        let key = resolve::key(record, &words);
        chunk.keys[lane] = key;
        overflowed |= step.overflowed[0] | step.overflowed[1] | step.overflowed[2] | step.overflowed[3];
        let empty = (key >> record.depth().bits == Class::Empty as u32) as i32;
        chunk.dx[lane] = step.dx ^ (empty << NOWHERE);
        chunk.dy[lane] = step.dy;
    }
    overflowed
}

/// `lanes` moved up by one lane; the first stays.
#[inline(always)]
fn shift_in(shifted: &mut [i32; CHUNK], lanes: &[i32; CHUNK]) {
    shifted[0] = lanes[0];
    for (to, &from) in shifted.iter_mut().skip(1).zip(lanes) {
        *to = from;
    }
}

/// How many lanes from the first on go straight on.
#[inline(always)]
fn straight(turns: &[i32]) -> usize {
    let (eights, _) = turns.as_chunks::<8>();
    let straight = eights.iter().take_while(|turns| turns.iter().fold(0, |any, turn| any | turn) == 0).count() << 3;
    straight + turns.iter().skip(straight).take_while(|&&turn| turn == 0).count()
}

impl<F: Format> Target<'_, '_, F> {
    /// Takes the galpixels of the `cells` cells from where `chunk` stands.
    #[inline(always)]
    fn take(
        &mut self,
        front: &Galpixmap<'_, F>,
        thresholds: &[i32; 3],
        chunk: &mut Chunk,
        rest: &mut [[u32; CHUNK]; MAX_WORDS],
        cells: usize,
    ) {
        let record = front.record();
        let mut sources = [&[0; CHUNK]; MAX_WORDS];
        for ((lanes, plane), rest) in sources.iter_mut().zip(front.planes()).zip(rest).take(record.words()) {
            *lanes = lanes_of(plane, chunk.source, cells, rest);
        }
        if front.class(chunk.source) == Class::Empty {
            let source = chunk.source as usize;
            if front.all_empty(source..source + cells) {
                return;
            }
        } else if self.rests(record, &sources, cells) {
            self.store_resting(record, &sources, chunk, cells);
            return;
        }
        let overflowed = if F::FIXED {
            step_lanes(record, thresholds, &sources, chunk)
        } else {
            for (to, from) in chunk.words.iter_mut().zip(sources).take(record.words()) {
                *to = *from;
            }
            let Chunk { words, dx, dy, keys, .. } = chunk;
            Planes::new(record, thresholds, words).step(dx, dy, keys)
        };
        if overflowed != 0 {
            self.retake(front, thresholds, chunk, cells);
        }
        let (first_dx, first_dy) = (chunk.dx[0], chunk.dy[0]);
        let mut apart = 0;
        for lane in 0..CHUNK {
            apart |= (chunk.dx[lane] ^ first_dx) | (chunk.dy[lane] ^ first_dy);
        }
        if apart == 0 {
            self.store_unless_empty(chunk, 0..cells);
        } else {
            self.store_runs(chunk, cells);
        }
    }

    /// Whether a step changes nothing in a chunk.
    #[inline(always)]
    fn rests(&self, record: &Record, sources: &[&[u32; CHUNK]; MAX_WORDS], cells: usize) -> bool {
        // A colour format of one's own need not leave a colour alone that is brightened by nothing.
        if record.layout().luminosity && record.luminosity_rate().present() {
            return false;
        }
        let motion_bits = |cells: usize| {
            let words = sources.iter().zip(self.motion_bits).take(record.words());
            words.fold(0, |any, (lanes, bits)| any | lanes.iter().take(cells).fold(0, |any, lane| any | lane) & bits)
        };
        motion_bits(1) == 0 && motion_bits(cells) == 0
    }

    /// Stores a chunk in which a step changes nothing.
    fn store_resting(
        &mut self,
        record: &Record,
        sources: &[&[u32; CHUNK]; MAX_WORDS],
        chunk: &mut Chunk,
        cells: usize,
    ) {
        for (to, from) in chunk.words.iter_mut().zip(sources).take(record.words()) {
            *to = **from;
        }
        for lane in 0..CHUNK {
            let mut words = [0; MAX_WORDS];
            for (word, lanes) in words.iter_mut().zip(sources).take(record.words()) {
                *word = lanes[lane];
            }
            chunk.keys[lane] = resolve::key(record, &words);
        }
        (chunk.dx[0], chunk.dy[0]) = (0, 0);
        self.store_run(chunk, 0..cells);
    }

    /// Stores a run of lanes that go the same way, unless that is nowhere.
    #[inline(always)]
    fn store_unless_empty(&mut self, chunk: &Chunk, lanes: Range<usize>) {
        if chunk.keys.get(lanes.start).is_some_and(|&key| self.back.class_of(key) != Class::Empty as u32) {
            self.store_run(chunk, lanes);
        }
    }

    /// Stores a chunk run by run.
    fn store_runs(&mut self, chunk: &mut Chunk, cells: usize) {
        shift_in(&mut chunk.before_dx, &chunk.dx);
        shift_in(&mut chunk.before_dy, &chunk.dy);
        for lane in 0..CHUNK {
            chunk.turns[lane] = (chunk.dx[lane] ^ chunk.before_dx[lane]) | (chunk.dy[lane] ^ chunk.before_dy[lane]);
        }
        let mut first = 0;
        while first < cells {
            let end = first + 1 + straight(chunk.turns.get(first + 1..cells).unwrap_or_default());
            self.store_unless_empty(chunk, first..end);
            first = end;
        }
    }

    /// Takes the steps of a chunk again, with clamps: rare.
    #[cold]
    fn retake(&mut self, front: &Galpixmap<'_, F>, thresholds: &[i32; 3], chunk: &mut Chunk, cells: usize) {
        for (lane, cell) in (chunk.source..).take(cells).enumerate() {
            let (Some(mut words), Some(key)) = (front.words_at(cell), chunk.keys.get_mut(lane)) else { return };
            let step = advance::<true>(front.record(), thresholds, &mut words);
            *key = resolve::key(front.record(), &words);
            if front.class(cell) != Class::Empty {
                self.tally.saturated += step.saturated();
            }
            for (word, lanes) in words.iter().zip(&mut chunk.words) {
                if let Some(to) = lanes.get_mut(lane) {
                    *to = *word;
                }
            }
        }
    }

    /// Stores a run: galpixels, none of them empty, with one displacement.
    #[inline(always)]
    fn store_run(&mut self, chunk: &Chunk, lanes: Range<usize>) {
        let Chunk { dx, dy, keys, x, y, source, .. } = chunk;
        let (Some(&dx), Some(&dy), Some(keys)) = (dx.get(lanes.start), dy.get(lanes.start), keys.get(lanes.clone()))
        else {
            return;
        };
        self.tally.moved += keys.len() as u32;
        let grid = self.back.grid();
        let (to_x, to_y) = (x + lanes.start as i32 + dx, y + dy);
        let Some(row) = grid.row(to_y) else {
            self.tally.lost += keys.len() as u32;
            return;
        };
        // Cut off what leaves the map at the left and at the right.
        let before = (-to_x).max(0) as usize;
        let beyond = (to_x + keys.len() as i32 - grid.width() as i32).max(0) as usize;
        if before + beyond >= keys.len() {
            self.tally.lost += keys.len() as u32;
            return;
        }
        self.tally.lost += (before + beyond) as u32;
        let lanes = lanes.start + before..lanes.end - beyond;
        let cell = row + (to_x + before as i32) as u32;
        self.clear_for(row, to_y);
        self.put_run(chunk, lanes.clone(), cell, source + lanes.start as u32);
    }

    /// Puts the lanes of a run into the cells from `cell` on, where they are nearer than what is there.
    #[inline(always)]
    fn put_run(&mut self, chunk: &Chunk, lanes: Range<usize>, cell: u32, source: u32) {
        if lanes.len() < SHORT_RUN {
            for (lane, offset) in lanes.zip(0..) {
                self.put_one(chunk, lane, cell + offset, source + offset);
            }
            return;
        }
        let words = self.back.record().words();
        let cells = cell as usize..cell as usize + lanes.len();
        if self.back.all_empty(cells.clone()) {
            for (plane, words) in self.back.planes_mut().iter_mut().zip(&chunk.words).take(words) {
                if let (Some(to), Some(from)) = (plane.get_mut(cells.clone()), words.get(lanes.clone())) {
                    for (to, &from) in to.iter_mut().zip(from) {
                        *to = from;
                    }
                }
            }
            if let Some(winners) = self.winners.get_mut(cells) {
                for (winner, source) in winners.iter_mut().zip(source..) {
                    *winner = source;
                }
            }
        } else {
            self.merge_run(chunk, lanes, cells, source);
        }
    }

    /// Puts the lanes of a run into cells some of which are occupied.
    fn merge_run(&mut self, chunk: &Chunk, lanes: Range<usize>, cells: Range<usize>, source: u32) {
        let mut wins = [0; CHUNK];
        let (Some(keys), Some(wins)) = (chunk.keys.get(lanes.clone()), wins.get_mut(..lanes.len())) else { return };
        let mut occupied = 0;
        for ((incumbent, &challenger), win) in self.back.keys(cells.clone()).zip(keys).zip(&mut *wins) {
            *win = if challenger < incumbent { u32::MAX } else { 0 };
            occupied += (self.back.class_of(incumbent) != Class::Empty as u32) as u32;
        }
        self.tally.collided += occupied;
        let words = self.back.record().words();
        for (plane, words) in self.back.planes_mut().iter_mut().zip(&chunk.words).take(words) {
            if let (Some(to), Some(from)) = (plane.get_mut(cells.clone()), words.get(lanes.clone())) {
                for ((to, &from), &win) in to.iter_mut().zip(from).zip(&*wins) {
                    *to = *to & !win | from & win;
                }
            }
        }
        if let Some(winners) = self.winners.get_mut(cells) {
            for ((winner, source), &win) in winners.iter_mut().zip(source..).zip(&*wins) {
                *winner = *winner & !win | source & win;
            }
        }
    }

    /// Puts one lane into one cell, if it is nearer than what is there.
    #[inline(always)]
    fn put_one(&mut self, chunk: &Chunk, lane: usize, cell: u32, source: u32) {
        let (Some(incumbent), Some(&key)) = (self.back.key_at(cell), chunk.keys.get(lane)) else { return };
        self.tally.collided += (self.back.class_of(incumbent) != Class::Empty as u32) as u32;
        if key < incumbent {
            let words = self.back.record().words();
            for (plane, lanes) in self.back.planes_mut().iter_mut().zip(&chunk.words).take(words) {
                if let (Some(to), Some(word)) = (plane.get_mut(cell as usize), lanes.get(lane)) {
                    *to = *word;
                }
            }
            if let Some(winner) = self.winners.get_mut(cell as usize) {
                *winner = source;
            }
        }
    }

    /// Makes sure that row `y`, which starts at cell `row`, is cleared.
    #[inline(always)]
    fn clear_for(&mut self, row: u32, y: i32) {
        if row >= self.cleared {
            let end = self.back.grid().row(y + ROWS_AHEAD).unwrap_or(self.back.grid().cells());
            self.clear_to(end);
        }
    }

    /// Clears up to, but without, the cell `end`.
    fn clear_to(&mut self, end: u32) {
        let cells = self.cleared as usize..end as usize;
        let record = *self.back.record();
        let mut empty = [0; MAX_WORDS];
        record.class().set(&mut empty, Class::Empty as u32);
        let words = record.words();
        for (plane, word) in self.back.planes_mut().iter_mut().zip(empty).take(words) {
            if let Some(cells) = plane.get_mut(cells.clone()) {
                cells.fill(word);
            }
        }
        if let Some(cells) = self.winners.get_mut(cells) {
            cells.fill(NO_WINNER);
        }
        self.cleared = self.cleared.max(end);
    }
}
