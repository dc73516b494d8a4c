//! The edge map for processors without vector registers: cell by cell, each key of a row read once.

use crate::format::Format;
use crate::format::record::{MAX_WORDS, Record};
use crate::frame::edge::{laplacian, set};
use crate::map::Galpixmap;

/// Cells of a word of the edge map.
const WORD: u32 = 32;

/// Cells of a run that are looked at before all of it is.
const GLANCE: u32 = 4;

/// No Laplacian of galpixels is larger, and none differs from it by more than a word holds.
const LARGEST: u32 = (1 << 30) - 1;

/// [`super::mark`] for processors without vector registers: the same arguments, the same bits.
///
/// Strip by strip of a word's width, down the rows: so each row of a strip is looked at once for being of one depth.
pub fn mark<F: Format>(front: &Galpixmap<'_, F>, threshold: u32, edges: &mut [u32]) -> u32 {
    mark_strips::<F, true>(front, threshold, edges)
}

/// [`mark`] with the same work for every picture.
pub fn mark_all<F: Format>(front: &Galpixmap<'_, F>, threshold: u32, edges: &mut [u32]) -> u32 {
    mark_strips::<F, false>(front, threshold, edges)
}

/// `GLANCES`: whether what is of one depth is looked for, and left out.
fn mark_strips<F: Format, const GLANCES: bool>(front: &Galpixmap<'_, F>, threshold: u32, edges: &mut [u32]) -> u32 {
    edges.fill(0);
    let grid = *front.grid();
    let threshold = threshold.min(LARGEST) as i32;
    let (mut count, mut x) = (0, 0);
    while x < grid.width() {
        let cells = (grid.width() - x).min(WORD);
        let mut rows = grid.starts().iter().map(|&row| Strip::of::<F, GLANCES>(front, row + x, cells));
        // What lies beyond the map is like the row itself.
        let (mut up, mut row) = (None, rows.next());
        while let Some(strip) = row {
            let down = rows.next();
            let beside = [up.unwrap_or(strip), down.unwrap_or(strip)];
            count += strip.mark(front, beside, (x, cells), threshold, edges);
            (up, row) = (row, down);
        }
        x += cells;
    }
    count
}

/// A row of a strip.
#[derive(Clone, Copy)]
struct Strip {
    /// Its first cell.
    start: u32,
    /// The key of all its cells, if they are galpixels and have the same one.
    key: Option<u32>,
}

impl Strip {
    #[inline(always)]
    fn of<F: Format, const GLANCES: bool>(front: &Galpixmap<'_, F>, start: u32, cells: u32) -> Self {
        if !GLANCES {
            return Self { start, key: None };
        }
        let key = front.key_at(start).filter(|&key| front.class_of(key) == 0);
        let even = key.is_some() && is_even(front, start, cells.min(GLANCE)) && is_even(front, start, cells);
        Self { start, key: key.filter(|_| even) }
    }

    /// Marks what is on an edge of a row whose neighbours are `beside`; how many cells that are.
    #[inline(always)]
    fn mark<F: Format>(
        self,
        front: &Galpixmap<'_, F>,
        [up, down]: [Self; 2],
        (x, cells): (u32, u32),
        threshold: i32,
        edges: &mut [u32],
    ) -> u32 {
        let (first, width) = (self.start, front.grid().width());
        // The first and the last column lack a neighbour: they are their own.
        let z0 = front.key_at(first).unwrap_or_default();
        let left = if x == 0 { Some(z0) } else { front.key_at(first - 1) };
        let ends = x + cells == width;
        if self.key.is_some()
            && up.key == self.key
            && down.key == self.key
            && left == self.key
            && (ends || front.key_at(first + cells) == self.key)
        {
            return 0;
        }
        let paired = cells - u32::from(ends);
        let run = Run { right: first + 1, up: up.start, down: down.start };
        let (mut flags, last) = run.flags(front, paired, threshold, left.unwrap_or(z0), z0);
        if ends {
            flags = flags >> 1 | run.next(paired).flag_of_last(front, threshold, last);
        }
        flags >>= WORD - cells;
        set(edges, first, flags);
        ones(flags)
    }
}

/// Whether `cells` cells all have the key of the first one.
#[inline(never)]
fn is_even<F: Format>(front: &Galpixmap<'_, F>, start: u32, cells: u32) -> bool {
    let record = *front.record();
    let mut ones = [0; MAX_WORDS];
    record.class().set(&mut ones, u32::MAX);
    record.depth().set(&mut ones, u32::MAX);
    let mut even = true;
    for (plane, ones) in front.planes().iter().zip(ones).take(record.words()) {
        if ones != 0 {
            let cells = plane.get(start as usize..(start + cells) as usize).unwrap_or_default();
            let first = cells.first().copied().unwrap_or_default();
            even &= cells.iter().fold(0, |differ, cell| differ | cell ^ first) & ones == 0;
        }
    }
    even
}

/// Some cells of a row: where the neighbours of the first one are.
#[derive(Clone, Copy)]
struct Run {
    right: u32,
    up: u32,
    down: u32,
}

impl Run {
    const fn next(self, cells: u32) -> Self {
        Self { right: self.right + cells, up: self.up + cells, down: self.down + cells }
    }

    /// The flags of `cells` cells, the last one in the highest bit, from the key left of them and that of the first one; and
    /// these two for what comes next.
    #[inline(never)]
    fn flags<F: Format>(
        self,
        front: &Galpixmap<'_, F>,
        cells: u32,
        threshold: i32,
        mut left: u32,
        mut z0: u32,
    ) -> (u32, [u32; 2]) {
        let record = *front.record();
        let count = cells as usize;
        // Class, depth and its spill of each of the three rows, cut to one length.
        let (class, (depth, spill)) = (record.class().words().0, record.depth().words());
        let cut = |word: usize, start: u32| front.planes()[word].get(start as usize..)?.get(..count);
        let rows = |start: u32| Some([cut(class, start)?, cut(depth, start)?, cut(spill, start)?]);
        let (Some(rights), Some(ups), Some(downs)) = (rows(self.right), rows(self.up), rows(self.down)) else {
            return (0, [left, z0]);
        };
        let mut flags = 0;
        let mut lane = 0;
        while lane < count {
            let right = key::<F>(&record, &rights, lane);
            let (up, down) = (key::<F>(&record, &ups, lane), key::<F>(&record, &downs, lane));
            flags = flags >> 1 | flag(front, threshold, z0, [left, right, up, down]);
            (left, z0) = (z0, right);
            lane += 1;
        }
        (flags, [left, z0])
    }

    /// The flag of a cell that has nothing to its right.
    fn flag_of_last<F: Format>(self, front: &Galpixmap<'_, F>, threshold: i32, [left, z0]: [u32; 2]) -> u32 {
        let (up, down) = (front.key_at(self.up).unwrap_or(z0), front.key_at(self.down).unwrap_or(z0));
        flag(front, threshold, z0, [left, z0, up, down])
    }
}

/// Class and depth of a lane as one number, from its words with class, depth and what of it spills.
#[inline(always)]
fn key<F: Format>(record: &Record, [class, depth, spill]: &[&[u32]; 3], lane: usize) -> u32 {
    match record.key_field() {
        Some(key) if F::FIXED => key.extract().unsigned(class[lane], class[lane]),
        _ => {
            record.class().extract().unsigned(class[lane], class[lane]) << record.depth().bits
                | record.depth().extract().unsigned(depth[lane], spill[lane])
        }
    }
}

/// The highest bit if a cell is on the edge: the sign of a number tells, no comparison has to become a bit.
#[inline(always)]
fn flag<F: Format>(front: &Galpixmap<'_, F>, threshold: i32, z0: u32, others: [u32; 4]) -> u32 {
    let [left, right, up, down] = others;
    let source = laplacian(z0 as i32, left as i32, right as i32, up as i32, down as i32);
    let (below, above) = (threshold.wrapping_add(source), threshold.wrapping_sub(source));
    // Class 0 is a galpixel, and the class stands above the depth.
    let deepest = (1 << front.record().depth().bits) - 1;
    let classes = deepest - (z0 | left | right | up | down) as i32;
    (below | above | classes) as u32 & 1 << (WORD - 1)
}

/// How many bits are set, without the multiplication of `count_ones`.
pub(crate) const fn ones(bits: u32) -> u32 {
    let pairs = bits - (bits >> 1 & 0x5555_5555);
    let fours = (pairs & 0x3333_3333) + (pairs >> 2 & 0x3333_3333);
    let eights = (fours + (fours >> 4)) & 0x0f0f_0f0f;
    let sixteens = eights + (eights >> 8);
    (sixteens + (sixteens >> 16)) & 63
}
