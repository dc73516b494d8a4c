//! Links the samples of a map, many pairs at a time.

use super::RUN;
use crate::format::Format;
use crate::format::record::{Extract, Field};
use crate::map::Galpixmap;
use crate::map::galpixel::Class;
use crate::source::links::{FIRST, LINKED, SECOND, Value, WORD, values};

/// Samples of a run and its neighbours: one before it and two after it.
const AROUND: usize = RUN + 3;

/// Links the samples of a map, see [`crate::source::links`].
pub(crate) fn link<F: Format>(map: &Galpixmap<'_, F>, edge_threshold: u32, links: &mut [u32]) {
    links.fill(0);
    let (grid, values) = (*map.grid(), values(map.record(), edge_threshold));
    let (mut along, mut down) = (Samples::<AROUND>::new(), [const { Samples::<RUN>::new() }; 4]);
    for (y, &start) in (0..).zip(grid.starts()) {
        for x in (0..grid.width()).step_by(RUN) {
            along.read(map, &values, Some(start), x as i32 - 1);
            for (samples, y) in down.iter_mut().zip(y - 1..) {
                samples.read(map, &values, grid.row(y), x as i32);
            }
            let [mut right, mut below] = [[0; RUN]; 2];
            pair(&values, [0, 1, 2, 3].map(|place| along.from(place)), &mut right);
            pair(&values, down.each_ref().map(|samples| samples.from(0)), &mut below);
            let cells = start + x..start + grid.width();
            for ((cell, right), below) in cells.zip(right).zip(below) {
                if let Some(word) = links.get_mut((cell / WORD) as usize) {
                    *word |= (right | below << 2) << ((cell % WORD) << 2);
                }
            }
        }
    }
}

/// What links depend on, of some samples of a row.
struct Samples<const N: usize> {
    /// All ones for galpixels, else 0.
    there: [u32; N],
    values: [[i32; N]; 3],
}

/// The same of a run.
struct Run<'s> {
    there: &'s [u32],
    values: [&'s [i32]; 3],
}

impl<const N: usize> Samples<N> {
    const fn new() -> Self {
        Self { there: [0; N], values: [[0; N]; 3] }
    }

    /// Reads the samples from column `x` on of the row that begins with cell `row`.
    #[inline(always)]
    fn read<F: Format>(&mut self, map: &Galpixmap<'_, F>, values: &[Value; 3], row: Option<u32>, x: i32) {
        self.there = [0; N];
        let Some(row) = row else { return };
        let before = (-x).max(0) as usize;
        let end = (map.grid().width() as i32 - x).min(N as i32) as usize;
        let first = (row as i32 + x.max(0)) as usize;
        let record = map.record();
        read_field(map, record.class(), first, self.there.get_mut(before..end), |extract, upper, lower| {
            if extract.unsigned(upper, lower) == Class::Galpixel as u32 { u32::MAX } else { 0 }
        });
        for (value, to) in values.iter().zip(&mut self.values) {
            let to = to.get_mut(before..end);
            if value.signed {
                read_field(map, value.field, first, to, Extract::signed);
            } else {
                read_field(map, value.field, first, to, |extract, upper, lower| extract.unsigned(upper, lower) as i32);
            }
        }
    }

    /// Returns the samples of a run from a place on.
    #[inline(always)]
    fn from(&self, place: usize) -> Run<'_> {
        fn run<T>(lanes: &[T], place: usize) -> &[T] {
            lanes.get(place..place + RUN).unwrap_or_default()
        }
        Run { there: run(&self.there, place), values: self.values.each_ref().map(|values| run(values, place)) }
    }
}

/// Reads a field of the samples from `first` on.
#[inline(always)]
fn read_field<F: Format, T>(
    map: &Galpixmap<'_, F>,
    field: Field,
    first: usize,
    to: Option<&mut [T]>,
    value: impl Fn(Extract, u32, u32) -> T,
) {
    let ((upper, lower), extract) = (field.words(), field.extract());
    let plane = |word: usize| map.planes()[word].get(first..).unwrap_or_default();
    for ((to, &upper), &lower) in to.unwrap_or_default().iter_mut().zip(plane(upper)).zip(plane(lower)) {
        *to = value(extract, upper, lower);
    }
}

/// Sets the two bits of each pair of a run, of which the samples are the second and the third of four in a row or
/// column, see [`crate::source::links`].
#[inline(always)]
fn pair(values: &[Value; 3], [before, first, second, after]: [Run<'_>; 4], bits: &mut [u32; RUN]) {
    let mut steps = [0; RUN];
    for (i, value) in values.iter().enumerate() {
        let lanes = before.values[i].iter().zip(first.values[i]).zip(second.values[i]).zip(after.values[i]);
        let there = before.there.iter().zip(after.there);
        for (((((&before, &a), &b), &after), (&before_there, &after_there)), steps) in lanes.zip(there).zip(&mut steps)
        {
            let slope = b - a;
            let exceeds = |difference: u32| if difference > value.threshold { u32::MAX } else { 0 };
            *steps |= exceeds(slope.unsigned_abs())
                & (exceeds(slope.abs_diff(a - before)) | !before_there)
                & (exceeds(slope.abs_diff(after - b)) | !after_there);
        }
    }
    let there = first.there.iter().zip(second.there);
    let depths = first.values[0].iter().zip(second.values[0]);
    for (((bits, &steps), (&first, &second)), (&a, &b)) in bits.iter_mut().zip(&steps).zip(there).zip(depths) {
        let nearer = if a < b { FIRST } else { 0 } | if b < a { SECOND } else { 0 };
        *bits = (LINKED & !steps | nearer & steps) & first & second;
    }
}
