//! A galpixmap as a picture with holes, and how its holes are filled.

use super::kernel::{Known, each};
use super::mean::tie;
use super::metamer::Metamer;
#[cfg(feature = "check")]
use super::metamer::reference::metamers as metamers_by_reference;
use super::metamer::tone::Tone;
use super::paint::{Moving, OfCell, Tint};
use super::push_pull::{Holed, Motion, PushPull, RUN};
use super::pyramid::DEPTH_BITS;
#[cfg(feature = "check")]
use super::reference;
use super::settings::Inpainting;
use super::validity::FULL;
use crate::error::SetupError;
#[cfg(feature = "check")]
use crate::fast::check;
use crate::format::Format;
use crate::format::record::Words;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// Cells that are looked at once.
const LOOK: usize = 32;

/// Fills the holes of a map by push-pull: how many were filled.
pub(crate) fn push_pull<F: Format>(
    map: &mut Galpixmap<'_, F>,
    inpainting: &Inpainting<'_>,
    push_pull: &mut PushPull<'_>,
) -> u32 {
    match push_pull.motion() {
        Motion::Kept => fill::<F, Tint>(map, inpainting, push_pull),
        Motion::Inpainted => fill::<F, Moving>(map, inpainting, push_pull),
    }
}

fn fill<F: Format, V: OfCell>(
    map: &mut Galpixmap<'_, F>,
    inpainting: &Inpainting<'_>,
    push_pull: &mut PushPull<'_>,
) -> u32 {
    #[cfg(feature = "check")]
    let expected = check::due(map.grid().cells()).then(|| {
        check::on_copy(map, |copy| {
            reference::push_pull(&mut Uncovered::<F, V>::new(copy, inpainting.mask), push_pull.levels(), inpainting)
        })
    });
    let filled = push_pull.fill(&mut Uncovered::<F, V>::new(map, inpainting.mask), inpainting);
    #[cfg(feature = "check")]
    assert!(expected.is_none_or(|made| made == (check::words(map), filled)), "push-pull of a map: {inpainting:?}");
    filled
}

/// Fills the holes of a map by metamers, `age` frames after it was updated: how many were filled.
///
/// *Errors:* memory that is too short for the map; then nothing is filled.
pub(crate) fn metamers<F: Format>(
    map: &mut Galpixmap<'_, F>,
    inpainting: &Inpainting<'_>,
    metamer: &mut Metamer<'_>,
    age: u32,
) -> Result<u32, SetupError> {
    #[cfg(feature = "check")]
    let expected = check::due(map.grid().cells()).then(|| {
        check::on_copy(map, |copy| {
            let mut scene = Uncovered::<F, Tone>::new(copy, inpainting.mask);
            metamers_by_reference(&mut scene, inpainting, metamer.recipe(), age)
        })
    });
    let filled = metamer.fill(&mut Uncovered::<F, Tone>::new(map, inpainting.mask), inpainting, age)?;
    #[cfg(feature = "check")]
    assert!(expected.is_none_or(|made| made == (check::words(map), filled)), "metamers in a map: {inpainting:?}");
    Ok(filled)
}

/// Returns the words of a galpixel with class and depth of the hole that held `words`.
#[inline(always)]
fn moving_as<F: Format>(map: &Galpixmap<'_, F>, source: u32, words: Words) -> Words {
    let record = map.record();
    let mut moving = map.words_at(source).unwrap_or(words);
    for field in [record.class(), record.depth()] {
        field.set(&mut moving, field.unsigned(&words));
    }
    moving
}

/// A galpixmap whose cells of class just unobscured are its holes.
pub struct Uncovered<'m, 'p, F, V: OfCell> {
    pub(super) map: &'m mut Galpixmap<'p, F>,
    /// A bit for each cell; empty for all of them.
    mask: &'m [u32],
    /// The colour format, looked up.
    table: V::Table,
}

impl<'m, 'p, F: Format, V: OfCell> Uncovered<'m, 'p, F, V> {
    /// Takes the holes of `map` whose bit of `mask` is set: bit `c mod 32` of word `c / 32` for cell `c`. An empty mask
    /// stands for all of them, and beyond the end of one no hole is filled.
    pub fn new(map: &'m mut Galpixmap<'p, F>, mask: &'m [u32]) -> Self {
        let table = V::table(map.record().colour_format());
        Self { map, mask, table }
    }

    /// Returns how the value of a cell is taken from its colour.
    #[inline(always)]
    pub(super) fn reader(&self) -> impl Fn(u32, u32) -> V {
        let (format, table) = (self.map.record().colour_format(), self.table);
        move |colour, cell| if F::FIXED { V::of(format, colour, cell) } else { V::looked_up(&table, colour, cell) }
    }

    /// Returns what is known of a cell with this class and depth.
    #[inline(always)]
    fn known_of(&self, cell: u32, key: u32) -> Known<V> {
        let bits = u32::from(self.map.record().depth().bits);
        let class = self.map.class_of(key);
        if class == Class::Empty as u32 {
            return Known::default();
        }
        let depth = pyramid_depth(key & ((1 << bits) - 1), bits);
        if class != Class::JustUnobscured as u32 {
            Known { validity: FULL, depth, value: self.reader()(self.map.colour(cell), cell) }
        } else {
            Known { validity: 0, depth, value: V::default() }
        }
    }

    #[inline(always)]
    fn is_to_be_filled(&self, cell: u32) -> bool {
        let in_mask =
            || self.mask.get((cell / u32::BITS) as usize).is_some_and(|word| word >> (cell % u32::BITS) & 1 != 0);
        self.map.class(cell) == Class::JustUnobscured && (self.mask.is_empty() || in_mask())
    }

    /// Gives a hole a colour, and with one that has a source position in the cell, motion and tag of that galpixel.
    #[inline(always)]
    pub(super) fn set(&mut self, cell: u32, value: V) {
        let record = self.map.record();
        let words = self.map.words_at(cell).unwrap_or_default();
        let mut words = value.source().map_or(words, |source| moving_as(self.map, source, words));
        record.colour().set(&mut words, value.colour(record.colour_format()));
        self.map.put(cell, &words);
    }

    /// Calls `hole` with column, row and cell of each hole that is to be filled, row by row.
    #[inline(always)]
    pub(super) fn each_hole(&mut self, mut hole: impl FnMut(&mut Self, u32, u32, u32)) {
        let grid = *self.map.grid();
        for (y, &row) in (0..).zip(grid.starts()) {
            let end = row + grid.width();
            let mut cell = row + self.map.cells_before_just_unobscured::<LOOK>(row..end);
            while cell < end {
                let next = (cell + LOOK as u32).min(end);
                for cell in cell..next {
                    if self.is_to_be_filled(cell) {
                        hole(self, cell - row, y, cell);
                    }
                }
                cell = next + self.map.cells_before_just_unobscured::<LOOK>(next..end);
            }
        }
    }
}

/// Returns the depth of a galpixel as a pyramid has it.
#[inline(always)]
pub(super) fn pyramid_depth(depth: u32, bits: u32) -> u32 {
    depth >> bits.saturating_sub(DEPTH_BITS)
}

impl<F: Format, V: OfCell> Holed for Uncovered<'_, '_, F, V> {
    type Value = V;

    fn size(&self) -> [u32; 2] {
        [self.map.grid().width(), self.map.grid().height()]
    }

    #[inline(always)]
    fn known(&self, x: u32, y: u32) -> Known<V> {
        let Some(cell) = self.map.grid().cell(x as i32, y as i32) else { return Known::default() };
        self.known_of(cell, self.map.key_at(cell).unwrap_or(u32::MAX))
    }

    #[inline(always)]
    fn block(&self, x: u32, y: u32) -> [Known<V>; 4] {
        let grid = self.map.grid();
        let (left, top) = (x << 1, y << 1);
        let inside = left + 1 < grid.width();
        let (Some(upper), Some(lower), true) = (grid.row(top as i32), grid.row(top as i32 + 1), inside) else {
            return self.cell_by_cell(x, y);
        };
        let two = |cell: u32| {
            let mut keys = self.map.keys(cell as usize..cell as usize + 2);
            let mut next = || keys.next().unwrap_or(u32::MAX);
            [self.known_of(cell, next()), self.known_of(cell + 1, next())]
        };
        let ([a, b], [c, d]) = (two(upper + left), two(lower + left));
        [a, b, c, d]
    }

    #[inline(always)]
    fn even_run(&self, x: u32, y: u32, threshold: u32) -> Option<[(u32, V); RUN]> {
        const CELLS: usize = 2 * RUN;
        let grid = self.map.grid();
        let (left, top) = (x << 1, y << 1);
        if left + CELLS as u32 > grid.width() {
            return None;
        }
        let (upper, lower) = (grid.cell(left as i32, top as i32)?, grid.cell(left as i32, top as i32 + 1)?);
        let bits = u32::from(self.map.record().depth().bits);
        let keys = |cell: u32| {
            let mut keys = [u32::MAX; CELLS];
            let cell = cell as usize;
            for (to, key) in keys.iter_mut().zip(self.map.half_keys(cell..cell + CELLS)) {
                *to = key;
            }
            keys
        };
        let (upper_keys, lower_keys) = (keys(upper), keys(lower));
        let mut run = [(0, V::default()); RUN];
        let (mut all, mut uneven) = (0, 0);
        for (i, (depth, _)) in run.iter_mut().enumerate() {
            let [a, b, c, d] = [upper_keys[2 * i], upper_keys[2 * i + 1], lower_keys[2 * i], lower_keys[2 * i + 1]];
            all |= a | b | c | d;
            let [a, b, c, d] = each([a, b, c, d], |depth| pyramid_depth(depth, bits) as i32);
            let (farthest, nearest) = (a.max(b).max(c.max(d)), a.min(b).min(c.min(d)));
            uneven |= u32::from((farthest - nearest) as u32 > threshold);
            *depth = farthest as u32;
        }
        // What stands above the depth is 0 for galpixels and debris.
        if all >> bits != 0 || uneven != 0 {
            return None;
        }
        let read = self.reader();
        let values = |cell: u32| {
            let mut values = [V::default(); CELLS];
            let colours = self.map.colours(cell as usize..cell as usize + CELLS);
            for ((value, colour), cell) in values.iter_mut().zip(colours).zip(cell..) {
                *value = read(colour, cell);
            }
            values
        };
        let (upper, lower) = (values(upper), values(lower));
        for (i, (_, value)) in run.iter_mut().enumerate() {
            let four = [upper[2 * i], upper[2 * i + 1], lower[2 * i], lower[2 * i + 1]];
            *value = V::plain_mean(&four, tie(x + i as u32, y, 1));
        }
        Some(run)
    }

    fn fill_holes(&mut self, mut value: impl FnMut(&Self, u32, u32) -> Option<V>) -> u32 {
        let mut filled = 0;
        self.each_hole(|uncovered, x, y, cell| {
            if let Some(value) = value(uncovered, x, y) {
                uncovered.set(cell, value);
                filled += 1;
            }
        });
        filled
    }
}
