//! Steps samples where they are, and shows each in the cell that is nearest to it.

use super::layer::{Source, residual};
use super::visibility::{Entry, Kind, Visibility, depth, threshold};
use crate::format::Format;
use crate::format::rounding::Rounding;
use crate::frame::step::{advance, thresholds};
use crate::frame::tally::Tally;
use crate::layers::{displacement, displacement_word};
use crate::map::galpixel::Class;

/// Steps the samples of a layer, if a rounding and a frame counter are given, and shows them. `first` is the number of
/// the layer's first sample.
///
/// Points lie behind quads of the same surface by half of the edge threshold, which is in units of the depth's last bit.
pub(crate) fn scatter<F: Format>(
    source: &mut Source<'_, F>,
    visibility: &mut Visibility<'_>,
    first: u32,
    edge_threshold: u32,
    step: Option<(Rounding, u32)>,
) -> Tally {
    let format = source.map.format();
    let record = format.record();
    let grid = *source.map.grid();
    let thresholds = step.map(|(rounding, frame)| thresholds(record, rounding, frame));
    let depth_bits = u32::from(record.depth().bits);
    let behind = threshold(edge_threshold, depth_bits) as u32 >> 1;
    let fracs = [record.offset_x().bits.into(), record.offset_y().bits.into()];
    let mut tally = Tally::default();
    for (y, &start) in (0..).zip(grid.starts()) {
        for (x, cell) in (0..grid.width() as i32).zip(start..) {
            let Some(mut words) = source.map.words_at(cell) else { continue };
            if record.class().unsigned(&words) != Class::Galpixel as u32 {
                continue;
            }
            let Some(place) = source.displacements.get_mut(cell as usize) else { continue };
            if let Some(thresholds) = &thresholds {
                let step = advance::<true>(record, thresholds, &mut words);
                let [dx, dy] = displacement(*place);
                let moved = displacement_word([dx + step.dx, dy + step.dy]);
                tally.saturated += step.saturated() + u32::from(displacement(moved) != [dx + step.dx, dy + step.dy]);
                *place = moved;
                source.map.put(cell, &words);
            }
            tally.moved += 1;
            let [dx, dy] = displacement(*place);
            let Some(target) = grid.cell(x + dx, y + dy) else {
                tally.lost += 1;
                continue;
            };
            let offset = [record.offset_x().signed(&words), record.offset_y().signed(&words)];
            let depth = depth(record.depth().unsigned(&words), depth_bits) + behind;
            let entry = Entry::new(depth, Kind::Point, first + cell, residual(offset, fracs));
            visibility.challenge(target, entry);
        }
    }
    tally
}
