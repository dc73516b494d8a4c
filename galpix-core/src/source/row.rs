//! Rows of colour from a visibility buffer.

use super::gather::{Cell, colour, covered};
use super::links::{Links, Side};
use super::visibility::{EMPTY, PARTS, Visibility, threshold};
use super::{Source, Sources, layer_of, visibility};
use crate::fast;
use crate::format::Format;
use crate::format::colour::WEIGHTS;
use crate::frame::fill::FillMode;
use crate::layers::displacement_word;
use crate::map::galpixel::Class;
use crate::map::grid::Grid;

/// How a row is gathered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Gather {
    /// What cells hold that show no sample: with [`FillMode::None`] black; with [`FillMode::Extend`] the colour of the
    /// farther of the two surfaces at the ends of their run of holes in the row; with all others, in rows without a
    /// sample, and where the update knew nothing, the colour that the update had there.
    pub fill_mode: FillMode,
    /// Whether colours are resampled at the centre of the cell; else a cell has the colour of its sample.
    pub sub_cell: bool,
    /// That of [`Settings`](crate::Settings).
    pub edge_threshold: u32,
}

/// How the cells of a row are gathered that show a sample.
pub(crate) struct GatherRow {
    pub sub_cell: bool,
    /// For depths of an entry.
    pub threshold: i32,
}

impl<F: Format> Sources<'_, '_, F> {
    /// Gathers the colour words of row `y` of the map, margin included, into `colours`; returns how many cells show no
    /// sample. Nothing is written if there is no such row, or if `colours` is too short.
    pub fn gather(&self, y: u32, gather: Gather, colours: &mut [u32]) -> u32 {
        F::sources_gather(self, y, gather, colours)
    }

    /// Sets the bits of the cells of row `y` of the map that show a sample or of which the update knew nothing, in a
    /// mask of all cells of the map, whose other bits stay; and writes the depths of all cells of the row: that of a
    /// hole is the farther one of the two ends of its run. For [`Picture`](crate::inpaint::Picture), so that the other
    /// cells are inpainted.
    pub fn known(&self, y: u32, known: &mut [u32], depths: &mut [u32]) {
        F::sources_known(self, y, known, depths);
    }

    /// Writes for each cell of row `y` of the map how far from where it is stored the sample that the cell shows is
    /// seen: column and row of the cell less those of the sample's own cell, as a [`displacement_word`]; 0 for a cell
    /// that shows no sample. For [`Metamer::fill_picture`](crate::inpaint::Metamer::fill_picture), so that a texture
    /// moves with the picture. Nothing is written if there is no such row, or if `moved` is too short; a longer one
    /// keeps what is beyond.
    ///
    /// *Cost:* a load and an addition for each cell, and a search in the table of row starts wherever a neighbour shows
    /// a sample of another row.
    pub fn moved(&self, y: u32, moved: &mut [u32]) {
        F::sources_moved(self, y, moved);
    }

    /// Returns the colour words of row `y` of the map from the gathered and filled ones of the row above, the row
    /// itself and the row below: where a surface ends within a cell, what is beside or behind it covers a part of the
    /// cell. Beyond the border of the map a row is empty. Nothing is written if there is no such row, or if the row
    /// itself or `colours` is too short.
    pub fn finish(&self, y: u32, edge_threshold: u32, gathered: [&[u32]; 3], colours: &mut [u32]) {
        F::sources_finish(self, y, edge_threshold, gathered, colours);
    }
}

/// Gathers a row, see [`Sources::gather`].
pub(crate) fn gather<F: Format>(sources: &Sources<'_, '_, F>, y: u32, gather: Gather, colours: &mut [u32]) -> u32 {
    let Some((map, start)) = sources.base().and_then(|map| Some((map, map.grid().row(y as i32)?))) else { return 0 };
    let Some(colours) = colours.get_mut(..map.grid().width() as usize) else { return 0 };
    let threshold = threshold(gather.edge_threshold, map.record().depth().bits.into());
    let how = GatherRow { sub_cell: gather.sub_cell, threshold };
    fast::gather_row(sources.layers, &sources.visibility, start, &how, colours);
    fill_row(sources, start, gather.fill_mode, colours)
}

/// The reference of [`fast::gather_row`]: gathers the colours of the cells from `start` on that show a sample.
pub(crate) fn gather_row<F: Format>(
    layers: &[Source<'_, F>],
    visibility: &Visibility<'_>,
    start: u32,
    gather: &GatherRow,
    colours: &mut [u32],
) {
    for (to, x) in colours.iter_mut().zip(0..) {
        if let Some(colour) = gather_cell(layers, visibility, [start, x], gather) {
            *to = colour;
        }
    }
}

/// Returns the colour of the cell in a column of the row that begins with cell `start`; `None` if it shows no sample.
#[inline(always)]
pub(crate) fn gather_cell<F: Format>(
    layers: &[Source<'_, F>],
    visibility: &Visibility<'_>,
    [start, x]: [u32; 2],
    gather: &GatherRow,
) -> Option<u32> {
    let entry = visibility.at(start + x);
    let (layer, first, _) = layer_of(layers, entry.sample()).filter(|_| entry.is_some())?;
    let sample = entry.sample() - first;
    if !gather.sub_cell {
        return Some(layer.map.colour(sample));
    }
    let display = Links { words: &[], width: visibility.grid().width() };
    let depth = |layer: &Source<'_, F>, sample: u32| {
        let field = layer.map.record().depth();
        visibility::depth(layer.map.unsigned(field, sample), field.bits.into()) as i32
    };
    let in_front = |nearer: u32, side: Side| {
        let own = depth(layer, sample);
        let [dx, _] = side.towards();
        // Beyond the border nothing is shown.
        let inside = x.wrapping_add_signed(dx) < display.width;
        let beside = visibility.at(display.beyond(start + x, side));
        let shown = layer_of(layers, beside.sample()).filter(|_| inside && beside.is_some());
        shown.is_some_and(|(layer, first, _)| depth(layer, beside.sample() - first) + gather.threshold < own)
            || depth(layer, nearer) + gather.threshold >= own
    };
    Some(colour(layer, sample, entry.residual(), in_front))
}

/// Fills the cells of a row that show no sample; returns how many.
fn fill_row<F: Format>(sources: &Sources<'_, '_, F>, start: u32, fill_mode: FillMode, colours: &mut [u32]) -> u32 {
    let Some(map) = sources.base() else { return 0 };
    let (keys, _) = sources.visibility.cells_from(start, colours.len());
    let depth = |x: usize| sources.visibility.at(start + x as u32).depth();
    let (mut x, mut holes) = (0, 0);
    loop {
        let first = x + before_hole(keys.get(x..).unwrap_or_default());
        let run = keys.get(first..).unwrap_or_default().iter().take_while(|&&key| key == EMPTY).count();
        if run == 0 {
            return holes;
        }
        x = first + run;
        holes += run as u32;
        // Depth and colour at the two ends.
        let at = |x: usize| colours.get(x).map(|&colour| (depth(x), colour));
        let farther = match (first.checked_sub(1).and_then(at), at(x)) {
            (Some(left), Some(right)) => Some(if right.0 > left.0 { right.1 } else { left.1 }),
            (left, right) => left.or(right).map(|(_, colour)| colour),
        };
        for (to, cell) in colours.get_mut(first..x).unwrap_or_default().iter_mut().zip(start + first as u32..) {
            *to = match (fill_mode, farther) {
                (FillMode::None, _) => 0,
                (FillMode::Extend, Some(colour)) if map.class(cell) != Class::Empty => colour,
                _ => map.colour(cell),
            };
        }
    }
}

/// Returns how many cells with these keys come before the first one that shows no sample.
fn before_hole(keys: &[u16]) -> usize {
    const RUN: usize = 32;
    let runs = keys.chunks_exact(RUN);
    let full =
        runs.take_while(|keys| keys.iter().fold(0, |any, &key| any | u16::from(key == EMPTY)) == 0).count() * RUN;
    full + keys.get(full..).unwrap_or_default().iter().take_while(|&&key| key != EMPTY).count()
}

/// What the colours of a row are finished from.
pub(crate) struct Finish<'r> {
    pub grid: Grid<'r>,
    pub y: u32,
    /// For depths of an entry.
    pub threshold: i32,
    /// The colours of the row above, the row itself and the row below.
    pub gathered: [&'r [u32]; 3],
}

/// Finishes a row, see [`Sources::finish`].
pub(crate) fn finish<F: Format>(
    sources: &Sources<'_, '_, F>,
    y: u32,
    edge_threshold: u32,
    gathered: [&[u32]; 3],
    colours: &mut [u32],
) {
    let Some(map) = sources.base().filter(|map| map.grid().row(y as i32).is_some()) else { return };
    let width = map.grid().width() as usize;
    let Some(colours) = colours.get_mut(..width).filter(|_| gathered[1].len() >= width) else { return };
    let threshold = threshold(edge_threshold, map.record().depth().bits.into()) >> 1;
    fast::finish_row(sources, &Finish { grid: *map.grid(), y, threshold, gathered }, colours);
}

/// Returns the colour of a cell after [`Sources::finish`].
#[inline(always)]
pub(crate) fn finish_cell<F: Format>(sources: &Sources<'_, '_, F>, finish: &Finish<'_>, x: u32) -> u32 {
    let Finish { grid, y, threshold, gathered: [above, row, below] } = *finish;
    let none = Links { words: &[], width: grid.width() };
    let look = |dx: i32, dy: i32, colours: &[u32]| -> Option<Cell<'_>> {
        let cell = grid.cell(x as i32 + dx, y as i32 + dy)?;
        let colour = *colours.get(x.wrapping_add_signed(dx) as usize)?;
        let entry = sources.visibility.at(cell);
        let (links, sample) = match layer_of(sources.layers, entry.sample()).filter(|_| entry.is_some()) {
            Some((layer, first, _)) => (layer.links(), entry.sample() - first),
            None => (none, 0),
        };
        Some(Cell { entry, links, sample, colour })
    };
    let Some(own) = look(0, 0, row) else { return 0 };
    let mut colour = own.colour;
    for (side, neighbour) in [
        (Side::Left, look(-1, 0, row)),
        (Side::Right, look(1, 0, row)),
        (Side::Above, look(0, -1, above)),
        (Side::Below, look(0, 1, below)),
    ] {
        let Some(neighbour) = neighbour else { continue };
        let part = covered(&own, &neighbour, side, threshold) << (WEIGHTS.trailing_zeros() - PARTS);
        if part > 0
            && let Some(map) = sources.base()
        {
            colour = map.record().colour_format().weighted([colour, neighbour.colour], [WEIGHTS - part, part]);
        }
    }
    colour
}

/// Says how far what a row shows has moved, see [`Sources::moved`].
pub(crate) fn moved<F: Format>(sources: &Sources<'_, '_, F>, y: u32, moved: &mut [u32]) {
    let grid = sources.visibility.grid();
    let Some(start) = grid.row(y as i32) else { return };
    let Some(moved) = moved.get_mut(..grid.width() as usize) else { return };
    // Neighbours mostly show samples of one row: number of its first sample, its samples, and where it is stored.
    let (mut row, mut count, mut stored) = (0, 0, 0);
    for (to, x) in moved.iter_mut().zip(0..) {
        let entry = sources.visibility.at(start + x);
        if !entry.is_some() {
            *to = 0;
            continue;
        }
        if entry.sample().wrapping_sub(row) >= count {
            let Some((layer, first, _)) = layer_of(sources.layers, entry.sample()) else { continue };
            let (number, cell) = layer.map.grid().row_of(entry.sample() - first);
            (row, count, stored) = (first + cell, layer.map.grid().width(), number);
        }
        *to = displacement_word([x.wrapping_sub(entry.sample() - row) as i32, y.wrapping_sub(stored) as i32]);
    }
}

/// Says what is known of a row, see [`Sources::known`].
pub(crate) fn known<F: Format>(sources: &Sources<'_, '_, F>, y: u32, known: &mut [u32], depths: &mut [u32]) {
    let Some((map, start)) = sources.base().and_then(|map| Some((map, map.grid().row(y as i32)?))) else { return };
    let width = map.grid().width();
    let entry = |x: u32| sources.visibility.at(start + x);
    let (mut left, mut x) = (0, 0);
    while x < width {
        let shown = entry(x).is_some();
        let run = (x..width).take_while(|&x| entry(x).is_some() == shown).count() as u32;
        let right = if x + run < width && !shown { entry(x + run).depth() } else { 0 };
        for x in x..x + run {
            let cell = start + x;
            let depth = if shown { entry(x).depth() } else { right.max(left) };
            if let Some(to) = depths.get_mut(x as usize) {
                *to = depth as u32;
            }
            if (shown || map.class(cell) == Class::Empty)
                && let Some(word) = known.get_mut((cell / u32::BITS) as usize)
            {
                *word |= 1 << (cell % u32::BITS);
            }
            left = depth;
        }
        x += run;
    }
}
