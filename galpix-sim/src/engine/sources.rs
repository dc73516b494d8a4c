//! Frames of stationary sources over memory of the host.

use std::time::Duration;

use cpu_time::ThreadTime;
use galpix_core::inpaint::Picture;
use galpix_core::source::{Gather, Source, Sources, Visibility, link_words};
use galpix_core::{Dynamic, FillMode, Format, Galpixmap, Grid, SetupError, Tally};

use super::fill::{Inpaint, Inpainter, Kind};
use super::frame::{Frame, Shown, display_cells, places_of};
use super::load::{grid, margin};
use super::{Delivered, Engine, EngineError, HiddenLayer, NO_ORIGIN, Pins, Ran, ScanOut, Visit, load};
use crate::update::Update;

/// The memory of sources over one grid.
pub(super) struct Memory {
    layers: Vec<LayerMemory>,
    keys: Vec<u16>,
    words: Vec<u32>,
    line: Vec<u16>,
}

/// The memory of a layer.
struct LayerMemory {
    map: Vec<u32>,
    displacements: Vec<u32>,
    links: Vec<u32>,
}

impl Memory {
    /// Makes memory for so many layers.
    pub(super) fn new(grid: &Grid<'_>, format: Dynamic, layers: usize) -> Self {
        let cells = grid.cells() as usize;
        let layer = || LayerMemory {
            map: vec![0; Galpixmap::words(grid, format)],
            displacements: vec![0; cells],
            links: vec![0; link_words(grid)],
        };
        Self {
            layers: std::iter::repeat_with(layer).take(layers).collect(),
            keys: vec![0; cells],
            words: vec![0; cells],
            line: vec![0; Visibility::line_half_words(grid)],
        }
    }

    /// Lays layers and a visibility buffer over the memory.
    pub(super) fn lay<'p>(
        &'p mut self,
        grid: Grid<'p>,
        format: Dynamic,
    ) -> Result<(Vec<Source<'p, Dynamic>>, Visibility<'p>), SetupError> {
        let Self { layers, keys, words, line } = self;
        let visibility = Visibility::new(&grid, keys, words, line)?;
        let layers = layers.iter_mut().map(|LayerMemory { map, displacements, links }| {
            Source::new(Galpixmap::new(grid, format, map)?, displacements, links)
        });
        Ok((layers.collect::<Result<_, _>>()?, visibility))
    }
}

/// A picture of all cells of a map.
pub(crate) struct Canvas {
    /// Colour words, gathered and filled, and the finished ones.
    gathered: Vec<u32>,
    finished: Vec<u32>,
    /// For inpainting: what is known and its depths; for metamers, how far it has moved. Empty without.
    known: Vec<u32>,
    depths: Vec<u32>,
    moved: Vec<u32>,
    inpainter: Option<Inpainter>,
}

impl Canvas {
    /// Makes a canvas whose cells that show no sample are inpainted after they are filled, if `inpaint` says how.
    pub(crate) fn new(grid: &Grid<'_>, inpaint: Option<Inpaint>) -> Self {
        let cells = grid.cells() as usize;
        let of = |words: usize| vec![0; if inpaint.is_some() { words } else { 0 }];
        Self {
            gathered: vec![0; cells],
            finished: vec![0; cells],
            known: of(cells.div_ceil(u32::BITS as usize)),
            depths: of(cells),
            moved: of(if inpaint.is_some_and(|inpaint| inpaint.kind == Kind::Metamer) { cells } else { 0 }),
            inpainter: inpaint.map(|inpaint| Inpainter::new(grid, inpaint)),
        }
    }

    /// Paints what sources show; returns the colour words of all cells.
    pub(crate) fn paint(&mut self, sources: &Sources<'_, '_, Dynamic>, gather: Gather) -> &[u32] {
        let Some(map) = sources.base() else { return &[] };
        let Self { gathered, finished, known, depths, moved, inpainter } = self;
        let (grid, colour) = (*map.grid(), *map.record().colour_format());
        let width = grid.width() as usize;
        for (y, row) in (0..).zip(gathered.chunks_mut(width)) {
            sources.gather(y, gather, row);
        }
        if let Some(inpainter) = inpainter {
            known.fill(0);
            for (y, depths) in (0..).zip(depths.chunks_mut(width)) {
                sources.known(y, known, depths);
            }
            for (y, moved) in (0..).zip(moved.chunks_mut(width)) {
                sources.moved(y, moved);
            }
            let threshold = [sources.depth_threshold(gather.edge_threshold), Sources::<Dynamic>::DEPTH_BITS];
            if let Ok(picture) = Picture::new(grid.width(), grid.height(), colour, gathered, known)
                && let Ok(mut picture) = picture.with_depths(depths)
            {
                inpainter.paint_picture(&mut picture, threshold, moved);
            }
        }
        if !gather.sub_cell {
            return gathered;
        }
        let row = |y: Option<usize>| y.and_then(|y| gathered.chunks(width).nth(y)).unwrap_or_default();
        for (y, to) in finished.chunks_mut(width).enumerate() {
            let around = [row(y.checked_sub(1)), row(Some(y)), row(Some(y + 1))];
            sources.finish(y as u32, gather.edge_threshold, around, to);
        }
        finished
    }
}

impl Engine {
    /// Extrapolates an update as stationary sources, see [`Engine::run_layers`].
    pub(super) fn run_sources(
        &self,
        Delivered { update, hidden }: Delivered<'_>,
        frames: u32,
        visit: Visit<'_>,
    ) -> Result<Ran, EngineError> {
        let mut starts = vec![0; Grid::rows(update.display_height() as u32, margin(update.margin))];
        let grid = grid(update, &mut starts)?;
        let cells = grid.cells() as usize;
        let mut memory = Memory::new(&grid, self.format, 1 + hidden.len());
        let (mut layers, visibility) = memory.lay(grid, self.format)?;
        let mut loaded = Vec::new();
        for (index, source) in layers.iter_mut().enumerate() {
            let layer = index.checked_sub(1).map(|hidden_index| &hidden[hidden_index]);
            loaded.push(match layer {
                None => load(update, source.map_mut()),
                Some(layer) => layer.load(source.map_mut()),
            });
            source.begin(self.settings.edge_threshold);
            if let Some(HiddenLayer::Stationary { displacements, .. }) = layer {
                for (word, &place) in source.displacements_mut().iter_mut().zip(*displacements) {
                    *word = galpix_core::layers::displacement_word(place);
                }
            }
        }
        let mut sources = Sources::new(&mut layers, visibility)?;
        // Without hidden layers what is shown is the outline.
        let mut own = Memory::new(&grid, self.format, usize::from(self.outlined && !hidden.is_empty()));
        let (mut own_layers, own_visibility) = own.lay(grid, self.format)?;
        let mut outline = match own_layers.is_empty() {
            true => None,
            false => Some(self.outline_of(update, (&mut own_layers, own_visibility))?),
        };
        let mut pins = Pins::new(update, &grid, *self.format.record().colour_format());
        let overlay = pins.overlay()?;
        let mut canvas = Canvas::new(&grid, self.inpaint);
        let gather = Gather {
            fill_mode: self.settings.fill_mode,
            sub_cell: self.scan_out == ScanOut::SubCell,
            edge_threshold: self.settings.edge_threshold,
        };
        let mut used = vec![false; cells * (1 + hidden.len())];
        let mut origins = vec![NO_ORIGIN; cells];
        for number in 0..=frames {
            let started = ThreadTime::now();
            let tally = if number > 0 { sources.step(&self.settings) } else { sources.show(&self.settings) };
            let colours = canvas.paint(&sources, gather);
            let time = started.elapsed();
            let (tally, time) = match number {
                0 => (Tally::default(), Duration::ZERO),
                _ if self.settings.fill_mode == FillMode::Extend => {
                    (Tally { galdebris: tally.empty, empty: 0, ..tally }, time)
                }
                _ => (tally, time),
            };
            let outline = outline.as_mut().map(|outline| self.outline(outline, number));
            for (cell, origin) in (0..).zip(&mut origins) {
                let sample = |(layer, sample): (usize, u32)| layer as u32 * grid.cells() + sample;
                *origin = sources.shown(cell).map_or(NO_ORIGIN, sample);
            }
            for cell in display_cells(&grid) {
                if let Some(used) = used.get_mut(origins[cell as usize] as usize) {
                    *used = true;
                }
            }
            let places = || places_of(&sources);
            let shown = Shown::Sources { grid, format: &self.format, colours, places: &places };
            visit(&Frame { number, tally, time, shown, overlay: overlay.as_ref(), origins: &origins, outline });
        }
        let base = loaded.remove(0);
        Ok(Ran { loaded: base, hidden: loaded, used })
    }

    /// Makes the next frame of the update's samples alone, and returns for each cell whether it shows one.
    pub(super) fn outline(&self, sources: &mut Sources<'_, '_, Dynamic>, number: u32) -> Vec<bool> {
        if number > 0 {
            sources.step(&self.settings);
        } else {
            sources.show(&self.settings);
        }
        let cells = sources.base().map_or(0, |map| map.grid().cells());
        (0..cells).map(|cell| sources.shown(cell).is_some()).collect()
    }

    /// Returns the update's samples alone over this memory.
    pub(super) fn outline_of<'p, 'l>(
        &self,
        update: &Update,
        (layers, visibility): (&'l mut [Source<'p, Dynamic>], Visibility<'p>),
    ) -> Result<Sources<'p, 'l, Dynamic>, SetupError> {
        for source in layers.iter_mut() {
            load(update, source.map_mut());
            source.begin(self.settings.edge_threshold);
        }
        Sources::new(layers, visibility)
    }
}
