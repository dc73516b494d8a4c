//! Stages 1 and 2 fused: propagates a whole map and resolves it, in raster order, with no buffer between.
//!
//! Neighbours mostly move alike. A run of [`RUN`] neighbours whose displacements are equal is stored as a whole; any other
//! run goes galpixel by galpixel. Both do what [`crate::propagate::arrivals`] and [`crate::resolve::settle`] define, bit by
//! bit: in raster order an incumbent has the smaller source, so that comparing keys alone decides.
//!
//! Rows of the new map are cleared just before they are first needed, while the old map's neighbourhood is in the cache.

use crate::galpixel::{Budget, Class};
use crate::galpixmap::Galpixmap;
use crate::layout::Layout;
use crate::propagate::{Moved, advance, thresholds};
use crate::record::{Block, MAX_WORDS};
use crate::resolve::{NOBODY, keys};
use crate::rounding::Rounding;
use crate::tally::Tally;

/// Neighbours that are treated at once.
pub const RUN: usize = 8;

/// Rows that are cleared at once.
const ROWS_AHEAD: i32 = 4;

/// The new map while it is filled.
struct Target<'t, 'p, L, B> {
    back: &'t mut Galpixmap<'p, L, B>,
    winners: &'t mut [u32],
    /// Cells before this one are cleared or hold arrivals.
    cleared: u32,
    tally: Tally,
}

/// Propagates `front` by one frame into `back` and resolves collisions.
///
/// `frame` is the frame counter of `front`; it may wrap. `winners` is either empty, and then nobody's origin is kept, or
/// has a word for each cell. Cells that nothing reached are of class empty; their other fields are not defined before
/// [`crate::fill`] has gone over them. Both maps must have the same grid, else nothing is done.
pub fn sweep<L: Layout, B: Budget<L>>(
    front: &Galpixmap<'_, L, B>,
    back: &mut Galpixmap<'_, L, B>,
    winners: &mut [u32],
    rounding: Rounding,
    frame: u32,
) -> Tally {
    let grid = *front.grid();
    if grid != *back.grid() {
        return Tally::default();
    }
    let thresholds = thresholds(front.record(), rounding, frame);
    let mut target = Target { back, winners, cleared: 0, tally: Tally::default() };
    for (y, &start) in grid.starts().iter().enumerate() {
        let mut x = 0;
        while x + RUN as u32 <= grid.width() {
            target.take::<RUN>(front, &thresholds, x as i32, y as i32, start + x);
            x += RUN as u32;
        }
        while x < grid.width() {
            target.take::<1>(front, &thresholds, x as i32, y as i32, start + x);
            x += 1;
        }
    }
    target.clear_to(grid.cells());
    target.tally
}

impl<L: Layout, B: Budget<L>> Target<'_, '_, L, B> {
    /// Takes the `N` galpixels from column `x` of row `y` on; `source` is the cell of the first.
    ///
    /// In smooth motion a run goes one way, or its first part goes one way and its last part another.
    #[inline(always)]
    fn take<const N: usize>(
        &mut self,
        front: &Galpixmap<'_, L, B>,
        thresholds: &[i32; 3],
        x: i32,
        y: i32,
        source: u32,
    ) {
        let record = front.record();
        let Some(block) = front.block::<N>(source) else { return };
        let class = record.class().unsigned(&block);
        let moved = advance::<L, N>(record, thresholds, block);
        // `plain` is 0 if all lanes are galpixels within their fields; `apart` if all go the way of the first,
        // `split` if each goes the way of the first or of the last.
        let (mut plain, mut apart, mut split) = (0, 0, 0);
        let (mut first, mut last) = ([0; N], [0; N]);
        for lane in 0..N {
            plain |= class[lane] as i32;
            plain |= moved.strayed[0][lane] | moved.strayed[1][lane] | moved.strayed[2][lane] | moved.strayed[3][lane];
            let from_first = (moved.dx[lane] ^ moved.dx[0]) | (moved.dy[lane] ^ moved.dy[0]);
            let from_last = (moved.dx[lane] ^ moved.dx[N - 1]) | (moved.dy[lane] ^ moved.dy[N - 1]);
            first[lane] = if from_first == 0 { u32::MAX } else { 0 };
            last[lane] = if from_first == 0 { 0 } else { u32::MAX };
            apart |= from_first;
            split |= if from_first == 0 { 0 } else { from_last };
        }
        if plain != 0 || split != 0 {
            self.scatter(&moved, &class, &[u32::MAX; N], x, y, source);
        } else if apart == 0 {
            self.store_run(&moved, &class, &[u32::MAX; N], 0, x, y, source);
        } else {
            self.store_run(&moved, &class, &first, 0, x, y, source);
            self.store_run(&moved, &class, &last, N - 1, x, y, source);
        }
    }

    /// Stores those lanes of a run, all galpixels, that are `chosen` and go the way of lane `guide`.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "the run, the choice, and where it comes from")]
    fn store_run<const N: usize>(
        &mut self,
        moved: &Moved<N>,
        class: &[u32; N],
        chosen: &[u32; N],
        guide: usize,
        x: i32,
        y: i32,
        source: u32,
    ) {
        let grid = self.back.grid();
        let (to_x, to_y) = (x + moved.dx[guide], y + moved.dy[guide]);
        let row = if to_x >= 0 && to_x <= grid.width() as i32 - N as i32 { grid.row(to_y) } else { None };
        let Some(row) = row else { return self.scatter(moved, class, chosen, x, y, source) };
        let cell = row + to_x as u32;
        self.clear_for(row, to_y);
        let Some(incumbent) = self.back.keys::<N>(cell) else { return };
        let depth_bits = self.back.record().depth().bits;
        let vacant = chosen.iter().zip(&incumbent).fold(u32::MAX, |vacant, (chosen, key)| vacant & chosen & key);
        if vacant >> depth_bits == Class::Empty as u32 {
            self.tally.moved += N as u32;
            self.back.put_block(cell, &moved.block);
            if let Some(winners) = self.winners.get_mut(cell as usize..).and_then(|rest| rest.first_chunk_mut::<N>()) {
                for lane in 0..N {
                    winners[lane] = source + lane as u32;
                }
            }
        } else {
            self.merge(moved, chosen, &incumbent, cell, source);
        }
    }

    /// Stores those chosen lanes of a run that are nearer than the incumbents.
    #[inline(always)]
    fn merge<const N: usize>(
        &mut self,
        moved: &Moved<N>,
        chosen: &[u32; N],
        incumbent: &[u32; N],
        cell: u32,
        source: u32,
    ) {
        let record = self.back.record();
        let (words, depth_bits) = (record.words(), record.depth().bits);
        let key = keys(record, &moved.block);
        let mut wins = [0; N];
        let (mut arrived, mut collided) = (0, 0);
        for lane in 0..N {
            wins[lane] = if key[lane] < incumbent[lane] { chosen[lane] } else { 0 };
            arrived += chosen[lane] & 1;
            collided += if incumbent[lane] >> depth_bits == Class::Empty as u32 { 0 } else { chosen[lane] & 1 };
        }
        self.tally.moved += arrived;
        self.tally.collided += collided;
        for (plane, lanes) in self.back.planes_mut().iter_mut().zip(&moved.block).take(words) {
            if let Some(target) = plane.get_mut(cell as usize..).and_then(|rest| rest.first_chunk_mut::<N>()) {
                for lane in 0..N {
                    target[lane] = target[lane] & !wins[lane] | lanes[lane] & wins[lane];
                }
            }
        }
        if let Some(winners) = self.winners.get_mut(cell as usize..).and_then(|rest| rest.first_chunk_mut::<N>()) {
            for lane in 0..N {
                winners[lane] = winners[lane] & !wins[lane] | (source + lane as u32) & wins[lane];
            }
        }
    }

    /// Stores each chosen lane of a block for itself.
    fn scatter<const N: usize>(
        &mut self,
        moved: &Moved<N>,
        class: &[u32; N],
        chosen: &[u32; N],
        x: i32,
        y: i32,
        source: u32,
    ) {
        let key = keys(self.back.record(), &moved.block);
        for lane in 0..N {
            if class[lane] == Class::Empty as u32 || chosen[lane] == 0 {
                continue;
            }
            self.tally.moved += 1;
            self.tally.saturated += moved.saturated(lane);
            let (x, y) = (x + lane as i32 + moved.dx[lane], y + moved.dy[lane]);
            let grid = self.back.grid();
            let row = if (x as u32) < grid.width() { grid.row(y) } else { None };
            let Some(row) = row else {
                self.tally.lost += 1;
                continue;
            };
            self.clear_for(row, y);
            let cell = row + x as u32;
            let Some([incumbent]) = self.back.keys::<1>(cell) else { continue };
            self.tally.collided += (incumbent >> self.back.record().depth().bits != Class::Empty as u32) as u32;
            if key[lane] < incumbent {
                self.back.put_lane(cell, &moved.block, lane);
                if let Some(winner) = self.winners.get_mut(cell as usize) {
                    *winner = source + lane as u32;
                }
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

    /// Clears up to, but without, the cell `end`: class empty, no winner.
    fn clear_to(&mut self, end: u32) {
        let cells = self.cleared as usize..end as usize;
        let record = *self.back.record();
        let mut empty: Block<1> = Default::default();
        record.class().set(&mut empty, &[Class::Empty as u32]);
        for word in [record.class().word, record.class().word + (record.class().spill > 0) as u8] {
            let word = word as usize & (MAX_WORDS - 1);
            if let Some(cells) = self.back.planes_mut()[word].get_mut(cells.clone()) {
                cells.fill(empty[word][0]);
            }
        }
        if let Some(cells) = self.winners.get_mut(cells) {
            cells.fill(NOBODY);
        }
        self.cleared = self.cleared.max(end);
    }
}
