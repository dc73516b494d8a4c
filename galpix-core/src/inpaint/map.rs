//! A galpixmap as a picture with holes.

use core::marker::PhantomData;

use super::mean::tie;
use super::metamer::{self, Recipe};
use super::paint::{Moving, Tint};
use super::push_pull::{Picture, RUN, Value, each, sparse};
use super::pyramid::{DEPTH_BITS, Known, Pyramid};
use super::tone::Tone;
use super::validity::FULL;
use crate::error::SetupError;
use crate::format::Format;
use crate::format::colour::Colour;
use crate::format::record::Words;
use crate::frame::Inpainting;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// Cells that are looked at once.
pub(super) const LOOK: u32 = 32;

/// What of a galpixel is filled in.
pub trait OfGalpixel: Value {
    /// Returns what a cell of this colour holds.
    fn of(format: &Colour, colour: u32, cell: u32) -> Self;

    /// Returns the words of a hole that held `words` and gets this.
    fn put_into<F: Format>(self, map: &Galpixmap<'_, F>, words: Words) -> Words;
}

/// What push-pull fills in.
pub trait Filling: OfGalpixel {
    /// Fills the holes of a map, whose depth is the one that they are to be filled at; how many were filled.
    fn push_pull<F: Format>(
        map: &mut Galpixmap<'_, F>,
        inpainting: &Inpainting<'_>,
        pyramid: &mut Pyramid<'_, Self>,
    ) -> u32;
}

/// The colour alone: the motion stays the one that the fill ladder gave.
impl OfGalpixel for Tint {
    #[inline(always)]
    fn of(format: &Colour, colour: u32, _: u32) -> Self {
        Self::of(format, colour)
    }

    #[inline(always)]
    fn put_into<F: Format>(self, map: &Galpixmap<'_, F>, mut words: Words) -> Words {
        map.record().colour().set(&mut words, self.colour(map.record().colour_format()));
        words
    }
}

impl Filling for Tint {
    fn push_pull<F: Format>(
        map: &mut Galpixmap<'_, F>,
        inpainting: &Inpainting<'_>,
        pyramid: &mut Pyramid<'_, Self>,
    ) -> u32 {
        F::push_pull_tint(map, inpainting, pyramid)
    }
}

/// The colour, and position in the cell, motion and tag of a galpixel of the same surface.
impl OfGalpixel for Moving {
    #[inline(always)]
    fn of(format: &Colour, colour: u32, cell: u32) -> Self {
        Self { tint: Tint::of(format, colour), source: cell }
    }

    #[inline(always)]
    fn put_into<F: Format>(self, map: &Galpixmap<'_, F>, words: Words) -> Words {
        OfGalpixel::put_into(self.tint, map, moving_as(map, self.source, words))
    }
}

impl Filling for Moving {
    fn push_pull<F: Format>(
        map: &mut Galpixmap<'_, F>,
        inpainting: &Inpainting<'_>,
        pyramid: &mut Pyramid<'_, Self>,
    ) -> u32 {
        F::push_pull_moving(map, inpainting, pyramid)
    }
}

/// Fills the holes of a map by push-pull.
pub(crate) fn push_pull<F: Format, V: OfGalpixel>(
    map: &mut Galpixmap<'_, F>,
    inpainting: &Inpainting<'_>,
    pyramid: &mut Pyramid<'_, V>,
) -> u32 {
    sparse(&mut Uncovered::<F, V>::new(map, inpainting.mask), pyramid, &inpainting.rule)
}

/// Fills the holes of a map by metamers.
pub(crate) fn metamers<F: Format>(
    map: &mut Galpixmap<'_, F>,
    inpainting: &Inpainting<'_>,
    scratch: &mut metamer::Scratch<'_>,
    recipe: &Recipe,
) -> Result<u32, SetupError> {
    metamer::sparse(&mut Uncovered::<F, Tone>::new(map, inpainting.mask), scratch, recipe)
}

/// The words of a galpixel with class and depth of the hole that held `words`.
#[inline(always)]
pub(super) fn moving_as<F: Format>(map: &Galpixmap<'_, F>, source: u32, words: Words) -> Words {
    let record = map.record();
    let mut moving = map.words_at(source).unwrap_or(words);
    for field in [record.class(), record.depth()] {
        field.set(&mut moving, field.unsigned(&words));
    }
    moving
}

/// A galpixmap whose cells of class just unobscured are its holes.
#[derive(Debug)]
pub struct Uncovered<'m, 'p, F, V> {
    pub(super) map: &'m mut Galpixmap<'p, F>,
    /// A bit for each cell; empty for all of them.
    mask: &'m [u32],
    value: PhantomData<V>,
}

impl<'m, 'p, F: Format, V: OfGalpixel> Uncovered<'m, 'p, F, V> {
    /// The holes of `map` whose bit of `mask` is set: bit `c mod 32` of word `c / 32` for cell `c`. An empty mask stands for all
    /// of them, and beyond the end of one no hole is filled.
    pub const fn new(map: &'m mut Galpixmap<'p, F>, mask: &'m [u32]) -> Self {
        Self { map, mask, value: PhantomData }
    }

    /// What is known of a cell with this class and depth.
    #[inline(always)]
    fn known_of(&self, cell: u32, key: u32) -> Known<V> {
        let bits = u32::from(self.map.record().depth().bits);
        let class = self.map.class_of(key);
        if class == Class::Empty as u32 {
            return Known::default();
        }
        let depth = pyramid_depth(key & ((1 << bits) - 1), bits);
        if class == Class::Galpixel as u32 {
            Known {
                validity: FULL,
                depth,
                value: V::of(self.map.record().colour_format(), self.map.colour(cell), cell),
            }
        } else {
            Known { validity: 0, depth, value: V::default() }
        }
    }

    #[inline(always)]
    pub(super) fn is_asked_for(&self, cell: u32) -> bool {
        self.mask.is_empty()
            || self.mask.get((cell / u32::BITS) as usize).is_some_and(|word| word >> (cell % u32::BITS) & 1 != 0)
    }
}

/// The depth of a galpixel as a pyramid has it.
#[inline(always)]
pub(super) fn pyramid_depth(depth: u32, bits: u32) -> u32 {
    depth >> bits.saturating_sub(DEPTH_BITS)
}

impl<F: Format, V: OfGalpixel> Picture for Uncovered<'_, '_, F, V> {
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
            for (to, key) in keys.iter_mut().zip(self.map.keys(cell..cell + CELLS)) {
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
        // Galpixels are of class 0, which stands above the depth.
        if all >> bits != 0 || uneven != 0 {
            return None;
        }
        let values = |cell: u32| {
            let mut values = [V::default(); CELLS];
            let colours = self.map.colours(cell as usize..cell as usize + CELLS);
            for ((value, colour), cell) in values.iter_mut().zip(colours).zip(cell..) {
                *value = V::of(self.map.record().colour_format(), colour, cell);
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
        let grid = *self.map.grid();
        let mut filled = 0;
        for (y, &row) in (0..).zip(grid.starts()) {
            let mut x = 0;
            while x < grid.width() {
                let run = (grid.width() - x).min(LOOK);
                if self.map.any_just_unobscured(row + x, run) {
                    for x in x..x + run {
                        let cell = row + x;
                        if self.map.class(cell) != Class::JustUnobscured || !self.is_asked_for(cell) {
                            continue;
                        }
                        let Some(value) = value(self, x, y) else { continue };
                        let words = self.map.words_at(cell).unwrap_or_default();
                        let words = value.put_into(self.map, words);
                        self.map.put(cell, &words);
                        filled += 1;
                    }
                }
                x += run;
            }
        }
        filled
    }
}
