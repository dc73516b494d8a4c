//! Propagation and resolution for processors with vector registers: both stages fused, in raster order, without a
//! buffer between them.
//!
//! Neighbours mostly move alike. The chunks of 64 cells of a row are stepped as a whole, and then each run of adjacent
//! cells with equal displacements is stored as a whole. In raster order an incumbent has the smaller source, so that
//! comparing the keys resolves collisions.
//!
//! A chunk of empty cells is skipped. A chunk that a step does not change is stored without a step. Most other chunks
//! fail these tests at their first galpixel.
//!
//! Rows of the new map are cleared just before the first galpixel arrives, while the rows around are in the cache.

pub(crate) mod edge;
mod planes;
pub(crate) mod source;

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

/// Cells of a chunk: enough for vector code, and few enough for the first-level cache.
const CHUNK: usize = 64;

/// The bit of the displacement in x that is inverted for empty cells, so that they form runs of their own. No galpixel
/// moves that far.
const EMPTY_BIT: u32 = 30;

/// Shorter runs are stored galpixel by galpixel.
const SHORT_RUN: usize = 4;

/// Rows that are cleared at once.
const ROWS_AHEAD: i32 = 4;

/// The new map while it is made.
struct Target<'t, 'p, F> {
    back: &'t mut Galpixmap<'p, F>,
    winners: &'t mut [u32],
    /// The first cell that is not yet cleared.
    cleared: u32,
    /// The bits that are all 0 in galpixels that a step does not change, see [`motion_bits`].
    motion_bits: Words,
    tally: Tally,
}

/// The galpixels of a chunk after the step, and where they came from. The memory is reused for all chunks.
struct Chunk {
    /// `words[word][lane]`.
    words: [[u32; CHUNK]; MAX_WORDS],
    keys: [u32; CHUNK],
    /// Displacements in cells.
    dx: [i32; CHUNK],
    dy: [i32; CHUNK],
    /// Displacements of the lane before; for the first lane its own.
    previous_dx: [i32; CHUNK],
    previous_dy: [i32; CHUNK],
    /// Not 0 for lanes whose displacement differs from that of the lane before: a run boundary.
    boundary: [i32; CHUNK],
    /// Column and row of the first cell.
    x: i32,
    y: i32,
    /// The first cell.
    source: u32,
    /// Cells of the chunk; less than [`CHUNK`] at the end of a row.
    cells: usize,
}

impl Chunk {
    /// Returns the cells.
    #[inline(always)]
    const fn range(&self) -> Range<usize> {
        self.source as usize..self.source as usize + self.cells
    }

    /// Takes words that a step does not change, and their keys.
    #[inline(always)]
    fn set_unchanged(&mut self, record: &Record, sources: &[&[u32; CHUNK]; MAX_WORDS]) {
        for (to, from) in self.words.iter_mut().zip(sources).take(record.words()) {
            *to = **from;
        }
        for lane in 0..CHUNK {
            let mut words = [0; MAX_WORDS];
            for (word, lanes) in words.iter_mut().zip(sources).take(record.words()) {
                *word = lanes[lane];
            }
            self.keys[lane] = resolve::key(record, &words);
        }
    }

    const fn new() -> Self {
        Self {
            words: [[0; CHUNK]; MAX_WORDS],
            keys: [0; CHUNK],
            dx: [0; CHUNK],
            dy: [0; CHUNK],
            previous_dx: [0; CHUNK],
            previous_dy: [0; CHUNK],
            boundary: [0; CHUNK],
            x: 0,
            y: 0,
            source: 0,
            cells: 0,
        }
    }
}

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
    let thresholds = thresholds(front.record(), rounding, frame);
    let motion_bits = motion_bits(front.record());
    let mut target = Target { back, winners, cleared: 0, motion_bits, tally: Tally::default() };
    let mut chunk = Chunk::new();
    // Copies of the words of the last chunk of a row.
    let mut tail = [[0; CHUNK]; MAX_WORDS];
    for (y, &start) in grid.starts().iter().enumerate() {
        let mut x = 0;
        while x < grid.width() {
            let cells = (grid.width() - x).min(CHUNK as u32);
            (chunk.x, chunk.y, chunk.source, chunk.cells) = (x as i32, y as i32, start + x, cells as usize);
            target.sweep_chunk(front, &thresholds, &mut chunk, &mut tail);
            x += cells;
        }
    }
    target.clear_to(grid.cells());
    target.tally
}

/// Returns the bits of velocities and accelerations, and the bit of the class that is set for empty and just-unobscured
/// cells.
///
/// If all of them are 0, a step changes nothing: the rounding threshold alone is less than what is dropped, and the
/// offset is within the cell.
fn motion_bits(record: &Record) -> Words {
    let mut motion_bits = [0; MAX_WORDS];
    for component in 0..3 {
        record.velocity(component).set(&mut motion_bits, u32::MAX);
        record.acceleration(component).set(&mut motion_bits, u32::MAX);
    }
    record.class().set(&mut motion_bits, Class::Empty as u32 & Class::JustUnobscured as u32);
    motion_bits
}

/// Returns the chunk of a plane that begins at cell `source`. If it has less than [`CHUNK`] cells, copies them into
/// `tail`.
#[inline(always)]
fn lanes_of<'l>(plane: &'l [u32], source: u32, cells: usize, tail: &'l mut [u32; CHUNK]) -> &'l [u32; CHUNK] {
    let plane = plane.get(source as usize..).unwrap_or_default();
    if cells == CHUNK
        && let Some(lanes) = plane.first_chunk::<CHUNK>()
    {
        return lanes;
    }
    for (to, &from) in tail.iter_mut().zip(plane).take(cells) {
        *to = from;
    }
    tail
}

/// Steps a chunk galpixel by galpixel. Returns a number that is not 0 if a field of any of them overflowed.
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
        chunk.dx[lane] = step.dx ^ (empty << EMPTY_BIT);
        chunk.dy[lane] = step.dy;
    }
    overflowed
}

/// Steps a chunk. Returns a number that is not 0 if a field of any galpixel overflowed.
#[inline(always)]
fn step_chunk<F: Format>(
    record: &Record,
    thresholds: &[i32; 3],
    sources: &[&[u32; CHUNK]; MAX_WORDS],
    chunk: &mut Chunk,
) -> i32 {
    if F::FIXED {
        return step_lanes(record, thresholds, sources, chunk);
    }
    for (to, from) in chunk.words.iter_mut().zip(sources).take(record.words()) {
        *to = **from;
    }
    let Chunk { words, dx, dy, keys, .. } = chunk;
    Planes::new(record, thresholds, words).step(dx, dy, keys)
}

/// Returns whether a step changes nothing in a chunk.
#[inline(always)]
fn is_unchanged(record: &Record, sources: &[&[u32; CHUNK]; MAX_WORDS], motion_bits: &Words, cells: usize) -> bool {
    // With shading inertia a colour may change although its galpixel does not move.
    if record.layout().luminosity && record.luminosity_rate().present() {
        return false;
    }
    let any = |cells: usize| {
        let words = sources.iter().zip(motion_bits).take(record.words());
        words.fold(0, |any, (lanes, bits)| any | lanes.iter().take(cells).fold(0, |any, lane| any | lane) & bits)
    };
    any(1) == 0 && any(cells) == 0
}

/// Sets each lane of `shifted` to the lane before it of `lanes`, and the first one to the first one.
#[inline(always)]
fn shift_in(shifted: &mut [i32; CHUNK], lanes: &[i32; CHUNK]) {
    shifted[0] = lanes[0];
    for (to, &from) in shifted.iter_mut().skip(1).zip(lanes) {
        *to = from;
    }
}

/// Returns the number of lanes before the first run boundary.
#[inline(always)]
fn run_length(boundary: &[i32]) -> usize {
    let (eights, _) = boundary.as_chunks::<8>();
    let length = eights.iter().take_while(|lanes| lanes.iter().fold(0, |any, lane| any | lane) == 0).count() << 3;
    length + boundary.iter().skip(length).take_while(|&&lane| lane == 0).count()
}

impl<F: Format> Target<'_, '_, F> {
    /// Steps and stores the galpixels of the cells of `chunk`.
    #[inline(always)]
    fn sweep_chunk(
        &mut self,
        front: &Galpixmap<'_, F>,
        thresholds: &[i32; 3],
        chunk: &mut Chunk,
        tail: &mut [[u32; CHUNK]; MAX_WORDS],
    ) {
        let record = front.record();
        let cells = chunk.cells;
        let mut sources = [&[0; CHUNK]; MAX_WORDS];
        for ((lanes, plane), tail) in sources.iter_mut().zip(front.planes()).zip(tail).take(record.words()) {
            *lanes = lanes_of(plane, chunk.source, cells, tail);
        }
        if front.class(chunk.source) == Class::Empty {
            let source = chunk.source as usize;
            if front.all_empty(source..source + cells) {
                return;
            }
        } else if is_unchanged(record, &sources, &self.motion_bits, cells) {
            self.store_unchanged(record, &sources, chunk);
            return;
        }
        let overflowed = step_chunk::<F>(record, thresholds, &sources, chunk);
        if overflowed != 0 {
            self.step_clamped(front, thresholds, chunk);
        }
        let (first_dx, first_dy) = (chunk.dx[0], chunk.dy[0]);
        let mut apart = 0;
        for lane in 0..CHUNK {
            apart |= (chunk.dx[lane] ^ first_dx) | (chunk.dy[lane] ^ first_dy);
        }
        if apart == 0 {
            self.store_unless_empty(chunk, 0..cells);
        } else {
            self.store_runs(chunk);
        }
    }

    /// Stores a chunk in which a step changes nothing.
    fn store_unchanged(&mut self, record: &Record, sources: &[&[u32; CHUNK]; MAX_WORDS], chunk: &mut Chunk) {
        chunk.set_unchanged(record, sources);
        (chunk.dx[0], chunk.dy[0]) = (0, 0);
        self.store_run(chunk, 0..chunk.cells);
    }

    /// Stores a run of lanes, unless their cells are empty.
    #[inline(always)]
    fn store_unless_empty(&mut self, chunk: &Chunk, lanes: Range<usize>) {
        if chunk.keys.get(lanes.start).is_some_and(|&key| self.back.class_of(key) != Class::Empty as u32) {
            self.store_run(chunk, lanes);
        }
    }

    /// Stores a chunk run by run.
    fn store_runs(&mut self, chunk: &mut Chunk) {
        let cells = chunk.cells;
        shift_in(&mut chunk.previous_dx, &chunk.dx);
        shift_in(&mut chunk.previous_dy, &chunk.dy);
        for lane in 0..CHUNK {
            let (dx, dy) = (chunk.dx[lane] ^ chunk.previous_dx[lane], chunk.dy[lane] ^ chunk.previous_dy[lane]);
            chunk.boundary[lane] = dx | dy;
        }
        let mut first = 0;
        while first < cells {
            let end = first + 1 + run_length(chunk.boundary.get(first + 1..cells).unwrap_or_default());
            self.store_unless_empty(chunk, first..end);
            first = end;
        }
    }

    /// Repeats the steps of a chunk with clamps. The displacements are already correct. Rare.
    #[cold]
    fn step_clamped(&mut self, front: &Galpixmap<'_, F>, thresholds: &[i32; 3], chunk: &mut Chunk) {
        for (lane, cell) in (chunk.source..).take(chunk.cells).enumerate() {
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

    /// Stores a run of galpixels with equal displacements; none of its cells is empty.
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
        // Lanes that leave the map at the left and at the right are cut off.
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

    /// Stores the lanes of a run in the cells from `cell` on, where they are nearer than the incumbents.
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

    /// Stores the lanes of a run in cells of which some are occupied.
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

    /// Stores a lane in a cell, if it is nearer than the incumbent.
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

    /// Ensures that row `y`, whose first cell is `row`, is cleared.
    #[inline(always)]
    fn clear_for(&mut self, row: u32, y: i32) {
        if row >= self.cleared {
            let end = self.back.grid().row(y + ROWS_AHEAD).unwrap_or(self.back.grid().cells());
            self.clear_to(end);
        }
    }

    /// Clears all cells before `end` that are not yet cleared.
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
