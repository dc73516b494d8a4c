//! Sub-cell scan-out: rows of colour that are resampled by the sub-cell offsets of the galpixels.
//!
//! A cell shows the galpixel that is nearest to it. Where exactly that galpixel is, its *offset* says: up to half a cell
//! from the centre. [`row`](crate::scan_out::row) does not look at it, so that what moves slowly steps from cell to
//! cell. Here every row of the display is made from three rows of any map, in two steps:
//!
//! 1. **Bilinear.** A galpixel right of its centre leaves the left part of its cell to the neighbour on the left. So the
//!    neighbours across the centre, in x, in y and diagonally, are mixed in by the size of the offset. A neighbour counts
//!    if it is of the same surface and has moved alike; else the cell itself stands in for it.
//! 2. **Silhouettes by coverage.** Where one of two neighbours is nearer by more than a threshold, the nearer surface
//!    ends half a cell beyond its galpixel. If that lies within the farther cell, the nearer colour covers a part of
//!    it; if it lies within the nearer cell, the farther colour shows there.
//!
//! Offset 0 is exact: what does not move, cells without a galpixel beside it and [overlays](crate::overlay) keep every
//! bit. The map is only read, so that frames do not depend on how they are shown.
//!
//! *Cost* per cell: two words a colour, one product for the weights of four neighbours, eight for their colours (four
//! for gray); four of two colours more for each side at which a silhouette runs. Repeated halving by 8-bit weights would
//! take 24 means in place of the eight products.

use crate::format::Format;
use crate::format::colour::{Colour, WEIGHTS};
use crate::format::record::{Extract, Field, MAX_WORDS};
use crate::map::Galpixmap;
use crate::map::galpixel::Class;
use crate::output::scan_out::Sampling;

/// The base-2 logarithm of the parts of a cell in which offsets weigh.
const PARTS: u32 = WEIGHTS.trailing_zeros();

/// Neighbours whose offsets differ by more have not moved alike: three eighths of a cell.
const ALIKE: u32 = 3 << (PARTS - 3);

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
        let (x, y) = ((grid.margin().left + x) as usize, (grid.margin().top + y) as i32);
        let rows = Rows { above: Row::of(map, y - 1), here: Row::of(map, y), below: Row::of(map, y + 1) };
        let (reader, colour) = (Reader::of(map), *map.record().colour_format());
        // Left of column 0 the number wraps to a column that no map has.
        let mut left = rows.column(&reader, x.wrapping_sub(1));
        let mut here = rows.column(&reader, x);
        (1..shown as usize + 1).map(move |next| {
            let right = rows.column(&reader, x + next);
            let word = Around { left, here, right }.colour(&colour, self.edge_threshold);
            (left, here) = (here, right);
            word
        })
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

/// What scan-out needs of a galpixel.
#[derive(Clone, Copy)]
struct Cell {
    class: u32,
    depth: u32,
    /// Right and down from the centre, in parts of a cell.
    offset: [i32; 2],
    colour: u32,
}

impl Cell {
    /// What is outside of the map: it covers nothing and is not covered.
    const NONE: Self = Self { class: Class::Empty as u32, depth: 0, offset: [0; 2], colour: 0 };

    /// Returns whether this is a galpixel.
    #[inline(always)]
    const fn is_galpixel(&self) -> bool {
        self.class == Class::Galpixel as u32
    }

    /// Returns whether both are galpixels of one surface.
    #[inline(always)]
    const fn joins(&self, other: &Self, threshold: u32) -> bool {
        self.class | other.class == Class::Galpixel as u32 && self.depth.abs_diff(other.depth) <= threshold
    }

    /// Returns whether this is a galpixel in front of what the other holds.
    #[inline(always)]
    const fn covers(&self, other: &Self, threshold: u32) -> bool {
        self.is_galpixel()
            && other.class != Class::Empty as u32
            && (!other.is_galpixel() || other.depth.saturating_sub(self.depth) > threshold)
    }
}

/// Where the fields are that [`Cell`] has.
#[derive(Clone, Copy)]
struct Reader {
    class: Place,
    depth: Place,
    offset: [Place; 2],
    colour: Place,
    /// The fraction bits of the offsets.
    frac: [u32; 2],
}

/// The words of a field, and how it is extracted from them.
#[derive(Clone, Copy)]
struct Place {
    words: (usize, usize),
    extract: Extract,
}

impl Place {
    #[inline(always)]
    fn of(field: Field) -> Self {
        Self { words: field.words(), extract: field.extract() }
    }
}

impl Reader {
    #[inline(always)]
    fn of<F: Format>(map: &Galpixmap<'_, F>) -> Self {
        let record = map.record();
        let offset = [record.offset_x(), record.offset_y()];
        Self {
            class: Place::of(record.class()),
            depth: Place::of(record.depth()),
            offset: offset.map(Place::of),
            colour: Place::of(record.colour()),
            frac: offset.map(|field| field.bits.into()),
        }
    }
}

/// Returns an offset with `frac` fraction bits in parts of a cell, from -128 to 128.
///
/// *Rounding:* to nearest, halves upwards; exact with up to 8 fraction bits.
#[inline(always)]
const fn parts(offset: i32, frac: u32) -> i32 {
    if frac <= PARTS { offset << (PARTS - frac) } else { (offset + (1 << (frac - PARTS) >> 1)) >> (frac - PARTS) }
}

/// A row of a map.
#[derive(Clone, Copy)]
struct Row<'m> {
    words: [&'m [u32]; MAX_WORDS],
}

impl<'m> Row<'m> {
    /// Returns row `y` of the map, margin included; an empty row above and below it.
    #[inline(always)]
    fn of<F: Format>(map: &'m Galpixmap<'_, F>, y: i32) -> Self {
        let mut words: [&[u32]; MAX_WORDS] = [&[]; MAX_WORDS];
        if let Some(start) = map.grid().row(y) {
            let cells = start as usize..(start + map.grid().width()) as usize;
            for (word, plane) in words.iter_mut().zip(map.planes()) {
                *word = plane.get(cells.clone()).unwrap_or_default();
            }
        }
        Self { words }
    }

    /// Returns a cell; [`Cell::NONE`] outside of the row.
    #[inline(always)]
    fn cell(&self, reader: &Reader, x: usize) -> Cell {
        self.read(reader, x).unwrap_or(Cell::NONE)
    }

    #[inline(always)]
    fn read(&self, reader: &Reader, x: usize) -> Option<Cell> {
        let word = |word: usize| self.words[word].get(x).copied();
        let unsigned = |place: &Place| Some(place.extract.unsigned(word(place.words.0)?, word(place.words.1)?));
        let signed = |place: &Place| Some(place.extract.signed(word(place.words.0)?, word(place.words.1)?));
        Some(Cell {
            class: unsigned(&reader.class)?,
            depth: unsigned(&reader.depth)?,
            offset: [
                parts(signed(&reader.offset[0])?, reader.frac[0]),
                parts(signed(&reader.offset[1])?, reader.frac[1]),
            ],
            colour: unsigned(&reader.colour)?,
        })
    }
}

/// A row and its neighbours.
struct Rows<'m> {
    above: Row<'m>,
    here: Row<'m>,
    below: Row<'m>,
}

impl Rows<'_> {
    #[inline(always)]
    fn column(&self, reader: &Reader, x: usize) -> Column {
        Column { above: self.above.cell(reader, x), here: self.here.cell(reader, x), below: self.below.cell(reader, x) }
    }
}

/// Three cells, one below the other.
#[derive(Clone, Copy)]
struct Column {
    above: Cell,
    here: Cell,
    below: Cell,
}

/// A cell and those around it.
struct Around {
    left: Column,
    here: Column,
    right: Column,
}

impl Around {
    /// Returns what the cell in the middle shows.
    #[inline(always)]
    fn colour(&self, format: &Colour, threshold: u32) -> u32 {
        let here = &self.here.here;
        let mut colour = self.bilinear(format, threshold);
        let sides = [
            (&self.left.here, here.offset[0], self.left.here.offset[0]),
            (&self.right.here, -here.offset[0], -self.right.here.offset[0]),
            (&self.here.above, here.offset[1], self.here.above.offset[1]),
            (&self.here.below, -here.offset[1], -self.here.below.offset[1]),
        ];
        for (beside, own, its) in sides {
            // How far the end of the nearer surface is beyond the border of the two cells, towards this one.
            let part = if beside.covers(here, threshold) {
                its
            } else if here.covers(beside, threshold) {
                own
            } else {
                0
            };
            if part > 0 {
                let part = part as u32;
                colour = format.weighted([colour, beside.colour], [WEIGHTS - part, part]);
            }
        }
        colour
    }

    /// Returns the colour between the cell and its neighbours across the centre.
    #[inline(always)]
    fn bilinear(&self, format: &Colour, threshold: u32) -> u32 {
        let here = &self.here.here;
        let [x, y] = here.offset;
        let across = if x > 0 { &self.left } else { &self.right };
        let vertical = |column: &Column| if y > 0 { column.above } else { column.below };
        let (beside, along, diagonal) = (&across.here, &vertical(&self.here), &vertical(across));
        let counts = |other: &Cell, axis: usize| {
            here.joins(other, threshold) && other.offset[axis].abs_diff(here.offset[axis]) <= ALIKE
        };
        // Each neighbour has a weight of its own; what is left of `WEIGHTS` is the cell's.
        let x = if counts(beside, 0) { x.unsigned_abs() } else { 0 };
        let y = if counts(along, 1) { y.unsigned_abs() } else { 0 };
        let both = if here.joins(diagonal, threshold) { (x * y + (WEIGHTS >> 1)) >> PARTS } else { 0 };
        format.weighted(
            [here.colour, beside.colour, along.colour, diagonal.colour],
            [WEIGHTS + both - x - y, x - both, y - both, both],
        )
    }
}

#[cfg(test)]
mod tests;
