//! A tile and what lies around it: cells that are worked on side by side.

use super::steerable::{APRON, COLUMNS, Cells, ROWS, TILE};
use super::tone::Tone;
use crate::inpaint::kernel::Known;
use crate::inpaint::validity::FULL;

/// Neighbours of a row.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row {
    /// Luma and chroma.
    pub channels: [[i16; COLUMNS]; 3],
    /// Depths.
    pub depths: [i32; COLUMNS],
    /// -1 for a cell that is known, or else 0.
    pub known: [i32; COLUMNS],
}

impl Row {
    /// Sets a cell; none beyond the last.
    #[inline(always)]
    pub fn set(&mut self, column: usize, known: &Known<Tone>) {
        if column >= COLUMNS {
            return;
        }
        for (channel, level) in self.channels.iter_mut().zip(known.value.channels) {
            channel[column] = level;
        }
        self.depths[column] = known.depth as i32;
        self.known[column] = -((known.validity == FULL) as i32);
    }

    /// Moves all cells to the right and repeats the first one.
    #[inline(always)]
    fn shifted(&mut self, by: usize) {
        fn lane<T: Copy>(lane: &mut [T; COLUMNS], by: usize) {
            lane.copy_within(0..COLUMNS - by, by);
            let first = lane[by];
            lane.iter_mut().take(by).for_each(|cell| *cell = first);
        }
        self.channels.iter_mut().for_each(|channel| lane(channel, by));
        lane(&mut self.depths, by);
        lane(&mut self.known, by);
    }

    /// Repeats the last one of `count` cells.
    #[inline(always)]
    fn extended(&mut self, count: usize) {
        fn lane<T: Copy>(lane: &mut [T; COLUMNS], count: usize) {
            if let Some(&last) = lane.get(count.wrapping_sub(1)) {
                lane.iter_mut().skip(count).for_each(|cell| *cell = last);
            }
        }
        self.channels.iter_mut().for_each(|channel| lane(channel, count));
        lane(&mut self.depths, count);
        lane(&mut self.known, count);
    }
}

/// A tile and what lies around it.
#[derive(Debug)]
pub struct Surroundings {
    /// Luma and chroma.
    pub channels: [Cells; 3],
    /// Depths.
    pub depths: [[i32; COLUMNS]; ROWS],
    /// -1 for a cell that is known, or else 0.
    known: [[i32; COLUMNS]; ROWS],
}

/// A bit for each cell of a row of a tile.
pub type RowBits = u32;

/// The bits of all of them.
pub const ALL: RowBits = (1 << TILE) - 1;

impl Surroundings {
    /// Makes room for a tile.
    pub const fn new() -> Self {
        Self { channels: [[[0; COLUMNS]; ROWS]; 3], depths: [[0; COLUMNS]; ROWS], known: [[0; COLUMNS]; ROWS] }
    }

    /// Copies the surroundings of the tile that begins at `left`, `top` in a level of `width` x `height` cells. `row`
    /// copies the cells of a row from a column on; the border is repeated.
    #[inline(always)]
    pub fn load(&mut self, left: u32, top: u32, [width, height]: [u32; 2], mut row: impl FnMut(u32, u32, &mut Row)) {
        let first = left.saturating_sub(APRON as u32);
        let missing = APRON - (left - first) as usize;
        let mut cells = Row::default();
        let mut last = u32::MAX;
        for line in 0..ROWS {
            let y = (top + line as u32).saturating_sub(APRON as u32).min(height - 1);
            if y != last {
                row(first, y, &mut cells);
                if missing > 0 {
                    cells.shifted(missing);
                }
                let count = (width - first) as usize + missing;
                if count < COLUMNS {
                    cells.extended(count);
                }
                last = y;
            }
            for (channel, of_row) in self.channels.iter_mut().zip(&cells.channels) {
                channel[line] = *of_row;
            }
            self.depths[line] = cells.depths;
            self.known[line] = cells.known;
        }
    }

    /// Returns for each cell of the tile whether all cells under its kernel are known and within `threshold` of each
    /// other's depth.
    #[inline]
    #[must_use]
    pub fn whole(&self, threshold: u32) -> [RowBits; TILE] {
        let threshold = threshold.min(1 << 27) as i32;
        let (mut low, mut high, mut known) = ([i32::MAX; COLUMNS], [i32::MIN; COLUMNS], [-1; COLUMNS]);
        for (depths, of_row) in self.depths.iter().zip(&self.known) {
            widen(&mut low, &mut high, depths);
            for (known, of_row) in known.iter_mut().zip(of_row) {
                *known &= of_row;
            }
        }
        let (mut lowest, mut highest, mut all) = (i32::MAX, i32::MIN, -1);
        for x in 0..TILE + 2 * APRON {
            lowest = lowest.min(low[x]);
            highest = highest.max(high[x]);
            all &= known[x];
        }
        let mut whole = [ALL; TILE];
        if all == 0 {
            self.without_unknown(&mut whole);
        }
        if highest - lowest > threshold {
            self.without_edges(threshold, &mut whole);
        }
        whole
    }

    /// Clears the bits of cells with something unknown under their kernel.
    #[inline(never)]
    fn without_unknown(&self, whole: &mut [RowBits; TILE]) {
        let mut along = [0; ROWS];
        for (along, known) in along.iter_mut().zip(&self.known) {
            let mut unknown: u32 = 0;
            for (x, known) in known.iter().enumerate() {
                unknown |= u32::from(*known == 0) << x;
            }
            *along = unknown | unknown >> 1 | unknown >> 2 | unknown >> 3 | unknown >> 4;
        }
        for (whole, rows) in whole.iter_mut().zip(along.windows(1 + 2 * APRON)) {
            *whole &= !rows.iter().fold(0, |unknown, row| unknown | row);
        }
    }

    /// Clears the bits of cells with several surfaces under their kernel.
    #[inline(never)]
    fn without_edges(&self, threshold: i32, whole: &mut [RowBits; TILE]) {
        for (y, whole) in whole.iter_mut().enumerate() {
            let (mut low, mut high) = ([i32::MAX; COLUMNS], [i32::MIN; COLUMNS]);
            for line in y..y + 1 + 2 * APRON {
                widen(&mut low, &mut high, &self.depths[line]);
            }
            for x in 0..TILE {
                let (mut lowest, mut highest) = (low[x], high[x]);
                for column in x + 1..x + 1 + 2 * APRON {
                    lowest = lowest.min(low[column]);
                    highest = highest.max(high[column]);
                }
                *whole &= !(u32::from(highest - lowest > threshold) << x);
            }
        }
    }
}

/// Widens the range of depths of each column by those of another row.
#[inline(always)]
fn widen(low: &mut [i32; COLUMNS], high: &mut [i32; COLUMNS], depths: &[i32; COLUMNS]) {
    for x in 0..COLUMNS {
        low[x] = low[x].min(depths[x]);
        high[x] = high[x].max(depths[x]);
    }
}
