//! Sub-cell scan-out: rows of colour that are resampled by the sub-cell offsets of the galpixels.
//!
//! A cell shows the galpixel that is nearest to it. Where exactly that galpixel is, its *offset* says: up to half a
//! cell from the centre. [`row`](crate::scan_out::row) does not look at it, so that what moves slowly steps from cell
//! to cell. Here every row of the display is made from three rows of any map, in two steps:
//!
//! 1. **Bilinear.** A galpixel right of its centre leaves the left part of its cell to the neighbour on the left. So
//!    the neighbours across the centre, in x, in y and diagonally, are mixed in by the size of the offset. A neighbour
//!    counts if it is of the same surface and has moved alike; else the cell itself stands in for it.
//! 2. **Silhouettes by coverage.** Where one of two neighbours is nearer by more than a threshold, the nearer surface
//!    ends half a cell beyond its galpixel. If that is within the farther cell, the nearer colour covers a part of the
//!    farther cell; if it is within the nearer cell, the farther colour is seen there.
//!
//! Offset 0 is exact: what does not move, cells without a galpixel beside it and [overlays](crate::overlay) keep every
//! bit. The map is only read, so that frames do not depend on how they are shown.
//!
//! *Cost* per cell: five fields of it are read, three of each of the two rows beside it; one product for the weights of
//! four neighbours and eight for their colours (four for gray), because two channels share a word. Repeated halving by
//! weights of 8 bits would take 24 means of 4 operations each in their place. At a silhouette four products more.

use crate::format::Format;
use crate::format::budget::WIDEST_FIELD;
use crate::format::colour::WEIGHTS;
use crate::format::record::Field;
use crate::frame::reference::{choose, negative};
use crate::frame::step::parts;
use crate::map::Galpixmap;
use crate::output::scan_out::Sampling;

/// The base-2 logarithm of the parts of a cell in which offsets weigh.
const PARTS: u32 = WEIGHTS.trailing_zeros();

/// Neighbours whose offsets differ by more have not moved alike: three eighths of a cell.
const ALIKE: i32 = 3 << (PARTS - 3);

/// Cells that are resampled at a time, without branches and over arrays, so that the work becomes vector code.
const RUN: usize = 16;

/// A run with the columns before and after it.
type Lane<T> = [T; RUN + 2];

/// Sub-cell scan-out, for a [`View`](crate::scan_out::View).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SubCell {
    /// The largest difference of the depths of two neighbours of one surface, in units of the depth's last bit. That of
    /// the frames, [`Settings::edge_threshold`](crate::Settings), serves.
    pub edge_threshold: u32,
}

impl Sampling for SubCell {
    #[inline(always)]
    fn span<F: Format>(self, map: &Galpixmap<'_, F>, y: u32, x: u32, width: u32) -> impl ExactSizeIterator<Item = u32> {
        let grid = map.grid();
        let (x, y) = (x.min(grid.display_width()), y.min(grid.display_height()));
        let shown = if y < grid.display_height() { width.min(grid.display_width() - x) } else { 0 };
        let (first, y) = (grid.margin().left + x, (grid.margin().top + y) as i32);
        let here = grid.row(y).unwrap_or_default();
        // Beyond the border of the map the row itself takes the place of a row.
        let row = |y| grid.row(y).unwrap_or(here);
        // No depths differ by more.
        let threshold = self.edge_threshold.min(1 << WIDEST_FIELD) as i32;
        Resampled {
            rows: Rows { map, starts: [row(y - 1), here, row(y + 1)], threshold },
            next: first,
            end: first + shown,
            run: [0; RUN],
            left: 0,
        }
    }
}

/// Returns the colour words of row `y` of the display, resampled by the offsets of the galpixels; none below the
/// display. `edge_threshold` is that of [`SubCell`].
pub fn row<'m, F: Format>(
    map: &'m Galpixmap<'_, F>,
    edge_threshold: u32,
    y: u32,
) -> impl ExactSizeIterator<Item = u32> + 'm {
    SubCell { edge_threshold }.span(map, y, 0, map.grid().display_width())
}

/// The colours of a part of a row, made run by run.
struct Resampled<'m, 'p, F> {
    rows: Rows<'m, 'p, F>,
    /// The next column to be made, margin included, and the one after the last.
    next: u32,
    end: u32,
    /// The last run that was made, of which the last `left` colours are still to be returned.
    run: [u32; RUN],
    left: usize,
}

impl<F: Format> Iterator for Resampled<'_, '_, F> {
    type Item = u32;

    #[inline(always)]
    fn next(&mut self) -> Option<u32> {
        if self.left == 0 {
            let count = (self.end - self.next).min(RUN as u32);
            if count == 0 {
                return None;
            }
            self.rows.make(self.next, count, &mut self.run);
            (self.next, self.left) = (self.next + count, count as usize);
        }
        let colour = self.run.get(RUN - self.left).copied();
        self.left -= 1;
        colour
    }

    #[inline(always)]
    fn size_hint(&self) -> (usize, Option<usize>) {
        let len = (self.end - self.next) as usize + self.left;
        (len, Some(len))
    }
}

impl<F: Format> ExactSizeIterator for Resampled<'_, '_, F> {}

/// What is read of a run of cells of one row.
struct Lanes {
    /// The depth, and above it a bit that is set if the cell is empty: smaller is nearer.
    keys: Lane<u32>,
    colours: Lane<u32>,
    /// Offsets along the column, in parts of a cell.
    down: Lane<i32>,
}

/// What is read of a run of cells and the cells around it.
struct Around {
    above: Lanes,
    row: Lanes,
    below: Lanes,
    /// Offsets along the row, in parts of a cell.
    right: Lane<i32>,
}

impl Around {
    #[inline(always)]
    const fn new() -> Self {
        const LANES: Lanes = Lanes { keys: [0; RUN + 2], colours: [0; RUN + 2], down: [0; RUN + 2] };
        Self { above: LANES, row: LANES, below: LANES, right: [0; RUN + 2] }
    }
}

/// `count` cells from `x` on, and one before and one after them, if there are such cells in the row (1) or not (0).
struct Part {
    x: u32,
    before: u32,
    count: u32,
    after: u32,
}

impl Part {
    /// Returns the cells of these columns in the row that begins with cell `start`.
    #[inline(always)]
    const fn of(&self, start: u32) -> Self {
        Self { x: start + self.x, ..*self }
    }
}

/// A row of a map and those around it. Beyond the border of the map the row itself and its first and last column take
/// the place of what is not there: a cell is of one surface with itself, and does not cover itself.
struct Rows<'m, 'p, F> {
    map: &'m Galpixmap<'p, F>,
    /// The first cells of the row above, of the row itself and of the row below.
    starts: [u32; 3],
    threshold: i32,
}

impl<F: Format> Rows<'_, '_, F> {
    /// Makes `count` colours from column `x` on, at the end of `run`.
    #[inline(never)]
    fn make(&self, x: u32, count: u32, run: &mut [u32; RUN]) {
        let record = self.map.record();
        let after = (self.map.grid().width() - (x + count)).min(1);
        let part = Part { x, before: x.min(1), count, after };
        // Filled in place: arrays that are returned are copied.
        let mut around = Around::new();
        let Around { above, row, below, right } = &mut around;
        let [_, start, _] = self.starts;
        self.read_offsets(&part.of(start), record.offset_x(), right);
        let mut any = right.iter().fold(0, |any, offset| any | offset);
        for (lanes, start) in [&mut *above, &mut *row, &mut *below].into_iter().zip(self.starts) {
            self.read_offsets(&part.of(start), record.offset_y(), &mut lanes.down);
            any |= lanes.down.iter().fold(0, |any, offset| any | offset);
        }
        if any == 0 {
            // Nothing reaches out of its cell.
            self.read_unsigned(&part.of(start), record.colour(), &mut row.colours);
            for (to, colour) in run.iter_mut().zip(row.colours.iter().skip(1)) {
                *to = *colour;
            }
            return;
        }
        for (lanes, start) in [above, row, below].into_iter().zip(self.starts) {
            self.read_keys(&part.of(start), &mut lanes.keys);
            self.read_unsigned(&part.of(start), record.colour(), &mut lanes.colours);
        }
        let mut inside = [0; RUN];
        self.bilinear(&around, run, &mut inside);
        for index in 0..RUN {
            if inside[index] == 0 {
                self.silhouettes(&around, index, &mut run[index]);
            }
        }
    }

    /// Makes the colours between cells and their neighbours across the centre. Sets all ones in `inside` for cells that
    /// are of one surface with each of the four neighbours that share a side with them, else 0.
    #[inline(always)]
    fn bilinear(&self, around: &Around, run: &mut [u32; RUN], inside: &mut [u32; RUN]) {
        let Around { above, row, below, right } = around;
        let format = self.map.record().colour_format();
        let end = self.end() as i32;
        for index in 0..RUN {
            let [l, c, r] = [index, index + 1, index + 2];
            // Keys and threshold have 30 bits, so that no difference overflows.
            let key = row.keys[c] as i32;
            let (first, last) = (key - self.threshold, (key + self.threshold).min(end - 1));
            let is_there = negative(key - end);
            let joins = |other: u32| !negative((other as i32 - first) | (last - other as i32)) & is_there;
            let (x, y) = (right[c], row.down[c]);
            let [to_left, to_top] = [negative(-x), negative(-y)];
            let side = |lane: &Lane<u32>| choose(to_left, lane[l], lane[r]);
            let vertical = |of: fn(&Lanes) -> &Lane<u32>| choose(to_top, of(above)[c], of(below)[c]);
            let corner = |of: fn(&Lanes) -> &Lane<u32>| choose(to_top, side(of(above)), side(of(below)));
            let [keys, colours]: [fn(&Lanes) -> &Lane<u32>; 2] = [|lanes| &lanes.keys, |lanes| &lanes.colours];
            let counted = |key: u32, own: i32, its: u32| {
                joins(key) & !negative(ALIKE - (its as i32 - own).abs()) & own.unsigned_abs()
            };
            let x = counted(side(&row.keys), x, choose(to_left, right[l] as u32, right[r] as u32));
            let y = counted(vertical(keys), y, choose(to_top, above.down[c] as u32, below.down[c] as u32));
            let both = joins(corner(keys)) & (x * y + (WEIGHTS >> 1)) >> PARTS;
            // Each neighbour has a weight of its own; what is left of `WEIGHTS` is the cell's.
            run[index] = format.weighted(
                [row.colours[c], side(&row.colours), vertical(colours), corner(colours)],
                [WEIGHTS + both - x - y, x - both, y - both, both],
            );
            inside[index] = joins(row.keys[l]) & joins(row.keys[r]) & joins(above.keys[c]) & joins(below.keys[c]);
        }
    }

    /// Covers the colour of a cell, which is number `index` of the run, by what reaches over it. Few cells need it.
    #[inline(always)]
    fn silhouettes(&self, around: &Around, index: usize, colour: &mut u32) {
        let Around { above, row, below, right } = around;
        let [l, c, r] = [index, index + 1, index + 2];
        let key = row.keys[c];
        let of = |lanes: &Lanes, place: usize| (lanes.keys[place], lanes.colours[place]);
        for ((its_key, its_colour), own, its) in [
            (of(row, l), right[c], right[l]),
            (of(row, r), -right[c], -right[r]),
            (of(above, c), row.down[c], above.down[c]),
            (of(below, c), -row.down[c], -below.down[c]),
        ] {
            // How far the nearer surface ends beyond the border of the two cells, towards this one.
            let part = if self.covers(its_key, key) {
                its
            } else if self.covers(key, its_key) {
                own
            } else {
                continue;
            };
            if part > 0 {
                let (format, part) = (self.map.record().colour_format(), part as u32);
                *colour = format.weighted([*colour, its_colour], [WEIGHTS - part, part]);
            }
        }
    }

    /// Reads a part of a row to the end of a lane: its last cell to the last place but one. `read` makes something of
    /// the word of a field's upper part and of the one with its spilled bits.
    #[inline(always)]
    fn read<T: Copy>(&self, part: &Part, field: Field, lane: &mut Lane<T>, read: impl Fn(u32, u32) -> T) {
        let cells = (part.x - part.before) as usize..(part.x + part.count + part.after) as usize;
        let (upper, lower) = field.words();
        let plane = |word: usize| self.map.planes()[word].get(cells.clone()).unwrap_or_default();
        // From the column before the part on.
        let lane = lane.get_mut(RUN - part.count as usize..).unwrap_or_default();
        let places = lane.get_mut(1 - part.before as usize..).unwrap_or_default();
        for (to, (&upper, &lower)) in places.iter_mut().zip(plane(upper).iter().zip(plane(lower))) {
            *to = read(upper, lower);
        }
        if let ([beyond, first, ..], 0) = (&mut *lane, part.before) {
            *beyond = *first;
        }
        if let ([.., last, beyond], 0) = (lane, part.after) {
            *beyond = *last;
        }
    }

    #[inline(always)]
    fn read_unsigned(&self, part: &Part, field: Field, lane: &mut Lane<u32>) {
        let how = field.extract();
        self.read(part, field, lane, |upper, lower| how.unsigned(upper, lower));
    }

    #[inline(always)]
    fn read_offsets(&self, part: &Part, field: Field, lane: &mut Lane<i32>) {
        let how = field.extract();
        self.read(part, field, lane, |upper, lower| parts::<PARTS>(how.signed(upper, lower), field.bits.into()));
    }

    #[inline(always)]
    fn read_keys(&self, part: &Part, lane: &mut Lane<u32>) {
        let record = self.map.record();
        let surface = record.surface(F::FIXED);
        if let (Some(key), true) = (record.key_field(), F::FIXED) {
            return self.read(part, key, lane, |word, _| surface.of(word, word, word));
        }
        let mut depths = [0; RUN + 2];
        self.read(part, record.class(), lane, |word, _| surface.empty(word));
        self.read_unsigned(part, record.depth(), &mut depths);
        for (key, depth) in lane.iter_mut().zip(depths) {
            *key |= depth;
        }
    }

    /// Returns the key after the last one of a cell that is not empty.
    #[inline(always)]
    fn end(&self) -> u32 {
        1 << self.map.record().depth().bits
    }

    /// Returns whether a key is that of something in front of what has the other key.
    #[inline(always)]
    fn covers(&self, key: u32, other: u32) -> bool {
        other < self.end() && other.saturating_sub(key) > self.threshold as u32
    }
}

#[cfg(test)]
mod tests;
