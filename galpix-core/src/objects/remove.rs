//! Removal of all galpixels with a tag.

use core::ops::Range;

use crate::format::Format;
use crate::format::record::MAX_WORDS;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// Cells that are searched at once: as many as a word has bits.
const RUN: u32 = 32;

/// Makes every cell with this tag empty, whatever its class; returns their number. The cells keep their colours,
/// because the display shows what was there until something else is stored there.
pub(super) fn by_tag<F: Format>(map: &mut Galpixmap<'_, F>, tag: u32) -> u32 {
    let format = map.format();
    let record = format.record();
    let cells = map.grid().cells();
    let (mut removed, mut start) = (0, 0);
    while start < cells {
        let end = cells.min(start + RUN);
        let found = tagged(map, start as usize..end as usize, tag);
        if found != 0 {
            for cell in start..end {
                if found >> (cell - start) & 1 != 0 {
                    let mut empty = [0; MAX_WORDS];
                    record.class().set(&mut empty, Class::Empty as u32);
                    record.colour().set(&mut empty, map.colour(cell));
                    map.put(cell, &empty);
                    removed += 1;
                }
            }
        }
        start = end;
    }
    removed
}

/// Returns a bit for each of at most [`RUN`] cells: whether it holds a galpixel or debris of this tag.
#[inline(always)]
fn tagged<F: Format>(map: &Galpixmap<'_, F>, cells: Range<usize>, tag: u32) -> u32 {
    let record = map.record();
    let plane = |word: usize| map.planes().get(word).and_then(|plane| plane.get(cells.clone())).unwrap_or_default();
    let (class_word, _) = record.class().words();
    let (upper, lower) = record.tag().words();
    let (class, field) = (record.class().extract(), record.tag().extract());
    let mut found = 0;
    for (lane, ((&top, &upper), &lower)) in plane(class_word).iter().zip(plane(upper)).zip(plane(lower)).enumerate() {
        let there = class.unsigned(top, top) != Class::Empty as u32;
        found |= ((there & (field.unsigned(upper, lower) == tag)) as u32) << lane;
    }
    found
}
