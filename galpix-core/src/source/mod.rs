//! Stationary sources: samples stay where an update put them, and each frame finds out which of them every cell shows.
//!
//! In a map that moves, the galpixel that loses a collision is gone for good, so that a surface wears out. Here a
//! sample keeps its place in a [`Source`] for as long as it lives: a step changes its words and its *displacement*. The
//! frame itself is a [`Visibility`] buffer. It says for each cell which sample is seen there, and where beside it.
//!
//! ```text
//! update ─▶ link        which neighbours are of one surface                    once
//! frame  ─▶ scatter     step every sample; show it in the cell nearest to it   every sample
//!           quads       cells within stretched surfaces                        few
//!           cracks      cells between two samples of one surface               every cell
//! show   ─▶ gather      bilinear between linked samples                        every cell
//!           fill        cells that show no sample                              few
//!           silhouettes by coverage                                            few
//! ```
//!
//! Samples of several layers compete for the same cells, so that what is covered now is seen as soon as it is not.
//! Which one wins is a total order: (depth, quad before point, layer, cell). The result does not depend on the order
//! in which samples arrive.
//!
//! *Memory* per sample: the galpixel, a word for its displacement, and half a byte for its links; per cell of the
//! display 6 bytes.
//!
//! ```
//! use galpix_core::fixed::types::I32F32;
//! use galpix_core::source::{Gather, Source, Sources, Visibility};
//! use galpix_core::{Bits, Demand, Dynamic, FillMode, Galpixel, Galpixmap, Grid, Layout, Margin, Settings};
//!
//! # const BITS: Bits = Bits::must(Bits::derive(Demand { extent: 64, recog: 8, prop: 16 }));
//! # let format = Dynamic::new(BITS, Layout::FULL).expect("these widths can be stored");
//! let (mut rows, mut galpixels) = ([0; 1], [0; 8 * 6]);
//! let grid = Grid::new(6, 1, Margin::NONE, &mut rows)?;
//! let mut map = Galpixmap::new(grid, format, &mut galpixels)?;
//! for x in 0..6 {
//!     // A near white galpixel moves right before a gray picture that is still.
//!     let background = Galpixel { colour: [100; 3], depth: I32F32::lit("0.75"), ..Galpixel::default() };
//!     let velocity = [I32F32::ONE, I32F32::ZERO, I32F32::ZERO];
//!     let near = Galpixel { colour: [255; 3], velocity, ..Galpixel::default() };
//!     map.store(x, 0, if x == 1 { &near } else { &background });
//! }
//!
//! let (mut displacements, mut links, mut keys, mut words, mut line) = ([0; 6], [0; 2], [0; 6], [0; 6], [0; 48]);
//! let settings = Settings::for_depth(16);
//! let mut layers = [Source::new(map, &mut displacements, &mut links)?];
//! layers[0].begin(settings.edge_threshold);
//! let mut sources = Sources::new(&mut layers, Visibility::new(&grid, &mut keys, &mut words, &mut line)?)?;
//!
//! // In two frames it has passed over one galpixel, which is seen again. What was behind it is not known.
//! sources.step(&settings);
//! let tally = sources.step(&settings);
//! assert_eq!((tally.moved, tally.collided, tally.holes), (6, 1, 1));
//! assert_eq!([sources.shown(2), sources.shown(3), sources.shown(1)], [Some((0, 2)), Some((0, 1)), None]);
//!
//! let gather = Gather { fill_mode: FillMode::Extend, sub_cell: true, edge_threshold: settings.edge_threshold };
//! let mut colours = [0; 6];
//! assert_eq!(sources.gather(0, gather, &mut colours), 1);
//! assert_eq!(colours, [0x646464, 0x646464, 0x646464, 0xffffff, 0x646464, 0x646464]);
//! # Ok::<(), galpix_core::SetupError>(())
//! ```

pub(crate) mod constant_time;
pub(crate) mod cracks;
pub(crate) mod gather;
pub(crate) mod layer;
pub(crate) mod links;
pub(crate) mod quads;
#[cfg(any(test, feature = "check"))]
pub(crate) mod reference;
pub(crate) mod row;
pub(crate) mod visibility;

#[cfg(test)]
mod tests;

pub use constant_time::Budget;
pub use layer::Source;
pub use links::words as link_words;
pub use row::Gather;
pub use visibility::{MOST_SAMPLES, Visibility};

use crate::error::SetupError;
use crate::fast;
use crate::format::Format;
use crate::format::rounding::Rounding;
use crate::frame::Settings;
use crate::frame::reference::{below, choose, opaque};
use crate::frame::tally::Tally;
use crate::map::Galpixmap;
use cracks::Closed;
use visibility::threshold;

/// Layers of stationary sources, and what of them is shown.
#[derive(Debug)]
pub struct Sources<'p, 'l, F> {
    pub(crate) layers: &'l mut [Source<'p, F>],
    pub(crate) visibility: Visibility<'p>,
    frame: u32,
}

impl<'p, 'l, F: Format> Sources<'p, 'l, F> {
    /// Shows layers, the first of which is the base: its grid is that of the display. The others may have grids of
    /// their own, see [`Source::begin_at`]. [`Self::show`] must follow.
    ///
    /// *Errors:* no layer, a base over another grid than the visibility buffer's, a layer of more columns than the
    /// base, more than [`MOST_SAMPLES`] samples together.
    pub fn new(layers: &'l mut [Source<'p, F>], visibility: Visibility<'p>) -> Result<Self, SetupError> {
        check(layers.iter(), &visibility)?;
        Ok(Self { layers, visibility, frame: 0 })
    }

    /// Replaces a layer, as a whole and at once: `source` holds afterwards what the layer was. So an update that
    /// arrives bit by bit, or late, is written into a spare source, and nothing of it is shown before it is complete;
    /// frames that it missed meanwhile are made up for by [`Source::step`]. Nothing happens if there is no such layer.
    ///
    /// *Errors:* those of [`Self::new`]; then nothing is replaced. *Cost:* that of a check, and no sample is moved.
    pub fn replace(&mut self, layer: usize, source: &mut Source<'p, F>) -> Result<(), SetupError> {
        let others = self.layers.iter().enumerate();
        check(others.map(|(number, old)| if number == layer { &*source } else { old }), &self.visibility)?;
        if let Some(old) = self.layers.get_mut(layer) {
            core::mem::swap(old, source);
        }
        Ok(())
    }

    /// Makes the next frame: every sample makes a step.
    ///
    /// Of the counts, `moved` and `lost` are those of samples, `collided` the samples whose cell shows another one,
    /// `holes` the cells that no sample and no quad reached, `bullets` those of them that were closed as cracks, and
    /// `empty` the others. A sample that is lost has no cell at the moment, and may come back.
    pub fn step(&mut self, settings: &Settings) -> Tally {
        let step = Some((settings.rounding, self.frame));
        self.frame = self.frame.wrapping_add(1);
        F::sources_draw(self.layers, &mut self.visibility, settings.edge_threshold, step)
    }

    /// Makes the next frame as [`Self::step`], by instructions that do not depend on the picture. Returns with the
    /// counts how much of what is rare was left out, because it was beyond the budget: quads that were not drawn, and
    /// cells that were not looked at for cracks. If that is 0, the frame is that of [`Self::step`], bit by bit.
    ///
    /// *Cost:* each quad and each crack of the budget takes about as many instructions as four samples.
    pub fn step_constant_time(&mut self, settings: &Settings, budget: &Budget) -> (Tally, u32) {
        let frame = self.frame;
        self.frame = self.frame.wrapping_add(1);
        F::sources_draw_constant_time(self.layers, &mut self.visibility, settings, (frame, budget))
    }

    /// Shows the samples where they are, without a step: after an update.
    pub fn show(&mut self, settings: &Settings) -> Tally {
        F::sources_draw(self.layers, &mut self.visibility, settings.edge_threshold, None)
    }

    /// Returns a layer, to write an update; 0 is the base.
    pub fn layer_mut(&mut self, layer: usize) -> Option<&mut Source<'p, F>> {
        self.layers.get_mut(layer)
    }

    /// Returns the layers.
    #[must_use]
    pub const fn layers(&self) -> &[Source<'p, F>] {
        self.layers
    }

    /// The bits of the depths that [`Self::known`] writes, and of an edge threshold for them.
    pub const DEPTH_BITS: u32 = visibility::DEPTH_BITS;

    /// Returns an edge threshold for depths of [`Self::DEPTH_BITS`] bits.
    #[must_use]
    pub fn depth_threshold(&self, edge_threshold: u32) -> u32 {
        threshold(edge_threshold, self.base().map_or(0, |map| map.record().depth().bits.into())) as u32
    }

    /// Returns the base's samples.
    #[must_use]
    pub fn base(&self) -> Option<&Galpixmap<'p, F>> {
        self.layers.first().map(|layer| &layer.map)
    }

    /// Returns the frame counter, see [`Controller::frame`](crate::Controller::frame).
    #[must_use]
    pub const fn frame(&self) -> u32 {
        self.frame
    }

    /// Sets the frame counter, see [`Controller::set_frame`](crate::Controller::set_frame).
    pub const fn set_frame(&mut self, frame: u32) {
        self.frame = frame;
    }

    /// Returns the sample that a cell of the map shows: its layer, and the cell where it is stored. `None` if it shows
    /// none.
    #[must_use]
    pub fn shown(&self, cell: u32) -> Option<(usize, u32)> {
        let entry = self.visibility.at(cell);
        let (_, first, layer) = layer_of(self.layers, entry.sample()).filter(|_| entry.is_some())?;
        Some((layer, entry.sample() - first))
    }

    /// Returns the key and the word of the entry that a cell of the map shows: (depth | kind), 15 bits and 1, and
    /// (number of the sample | residual in x | residual in y), 22, 5 and 5 bits. `None` if it shows no sample.
    #[must_use]
    pub fn entry(&self, cell: u32) -> Option<(u16, u32)> {
        self.visibility.at(cell).parts()
    }
}

/// Checks whether layers can be shown together.
fn check<'s, 'p: 's, F: Format + 's>(
    layers: impl Iterator<Item = &'s Source<'p, F>>,
    visibility: &Visibility<'_>,
) -> Result<(), SetupError> {
    let (display, mut samples, mut is_base) = (visibility.grid(), 0, true);
    for layer in layers {
        let grid = layer.map.grid();
        if is_base && *grid != display {
            return Err(SetupError::GridsDiffer);
        }
        if grid.width() > display.width() {
            return Err(SetupError::LayerTooWide { width: grid.width(), most: display.width() });
        }
        samples += u64::from(grid.cells());
        is_base = false;
    }
    match samples {
        0 => Err(SetupError::Size { width: 0, height: 0 }),
        _ if samples > u64::from(MOST_SAMPLES) => Err(SetupError::TooManySamples { samples, most: MOST_SAMPLES }),
        _ => Ok(()),
    }
}

/// Finds out what every cell shows, after a step if a rounding and a frame counter are given.
pub(crate) fn draw<F: Format>(
    layers: &mut [Source<'_, F>],
    visibility: &mut Visibility<'_>,
    edge_threshold: u32,
    step: Option<(Rounding, u32)>,
) -> Tally {
    let show = |layer: &mut Source<'_, F>, visibility: &mut Visibility<'_>, first| {
        fast::scatter(layer, visibility, first, edge_threshold, step)
    };
    drawn(layers, visibility, edge_threshold, show, fast::close_cracks)
}

/// Shows all layers, given the number of the first sample of each, and closes cracks; returns the counts.
#[inline(always)]
fn drawn<'p, 'v, F: Format>(
    layers: &mut [Source<'p, F>],
    visibility: &mut Visibility<'v>,
    edge_threshold: u32,
    show: impl Fn(&mut Source<'p, F>, &mut Visibility<'v>, u32) -> Tally,
    close: impl FnOnce(&[Source<'p, F>], &mut Visibility<'v>, i32) -> Closed,
) -> Tally {
    visibility.clear();
    let mut tally = Tally::default();
    let mut first = 0;
    for layer in layers.iter_mut() {
        let own = show(layer, visibility, first);
        tally.moved += own.moved;
        tally.lost += own.lost;
        tally.saturated += own.saturated;
        first += layer.map.grid().cells();
    }
    let bits = layers.first().map_or(0, |layer| layer.map.record().depth().bits.into());
    let closed = close(layers, visibility, threshold(edge_threshold, bits));
    Tally {
        collided: tally.moved - tally.lost - closed.points,
        holes: closed.holes + closed.empty,
        bullets: closed.holes,
        empty: closed.empty,
        ..tally
    }
}

/// Returns the layer of a sample and the number of its first sample, looking at all layers. Of a number that no sample
/// has it is the last layer.
#[inline(always)]
pub(crate) fn layer_of_any<'s, 'p, F: Format>(
    layers: &'s [Source<'p, F>],
    sample: u32,
) -> Option<(&'s Source<'p, F>, u32)> {
    let (mut first, mut index, mut start) = (0, 0, 0);
    for (number, layer) in (0..).zip(layers) {
        let here = opaque(!below(sample, start));
        (first, index) = (choose(here, start, first), choose(here, number, index));
        start += layer.map.grid().cells();
    }
    Some((layers.get(index as usize)?, first))
}

/// Returns the layer of a sample, the number of its first sample, and its own number.
#[inline(always)]
pub(crate) fn layer_of<'s, 'p, F: Format>(
    layers: &'s [Source<'p, F>],
    sample: u32,
) -> Option<(&'s Source<'p, F>, u32, usize)> {
    let mut first = 0;
    for (number, layer) in layers.iter().enumerate() {
        let end = first + layer.map.grid().cells();
        if sample < end {
            return Some((layer, first, number));
        }
        first = end;
    }
    None
}
