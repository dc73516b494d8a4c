//! Frames of stationary sources over memory of the host.

use std::time::Duration;

use cpu_time::ThreadTime;
use galpix_core::inpaint::{Inpainting, Motion, Picture, PushPull};
use galpix_core::source::{Gather, Source, Sources, Visibility, link_words};
use galpix_core::{Dynamic, Format, Galpixmap, Grid, Settings, Tally};

use super::frame::{Frame, Shown, display_cells, places_of};
use super::load::{grid, margin};
use super::{Delivered, Engine, EngineError, HiddenLayer, NO_ORIGIN, Pins, Ran, ScanOut, Visit, load};

/// The memory of a layer.
struct Memory {
    map: Vec<u32>,
    displacements: Vec<u32>,
    links: Vec<u32>,
}

/// A picture of all cells of a map.
struct Canvas {
    /// Colour words, gathered and filled, and the finished ones.
    gathered: Vec<u32>,
    finished: Vec<u32>,
    /// For push-pull, whose memory is its own; empty without.
    known: Vec<u32>,
    depths: Vec<u32>,
    pyramid: Vec<u32>,
}

impl Canvas {
    fn new(grid: &Grid<'_>, inpaints: bool) -> Self {
        let cells = grid.cells() as usize;
        let of = |words: usize| vec![0; if inpaints { words } else { 0 }];
        Self {
            gathered: vec![0; cells],
            finished: vec![0; cells],
            known: of(cells.div_ceil(u32::BITS as usize)),
            depths: of(cells),
            pyramid: of(PushPull::words(grid.width(), grid.height(), Motion::Kept)),
        }
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
        let mut memory: Vec<Memory> = (0..=hidden.len())
            .map(|_| Memory {
                map: vec![0; Galpixmap::words(&grid, self.format)],
                displacements: vec![0; cells],
                links: vec![0; link_words(&grid)],
            })
            .collect();
        let mut layers = memory
            .iter_mut()
            .map(|Memory { map, displacements, links }| {
                Source::new(Galpixmap::new(grid, self.format, map)?, displacements, links)
            })
            .collect::<Result<Vec<Source<'_, Dynamic>>, _>>()?;
        let (mut keys, mut words, mut line) = (vec![0; cells], vec![0; cells], vec![0; Visibility::line_words(&grid)]);
        let visibility = Visibility::new(&grid, &mut keys, &mut words, &mut line)?;
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
        let mut pins = Pins::new(update, &grid, *self.format.record().colour_format());
        let overlay = pins.overlay()?;
        let mut canvas = Canvas::new(&grid, self.inpaint.is_some());
        let mut used = vec![false; cells * (1 + hidden.len())];
        let mut origins = vec![NO_ORIGIN; cells];
        for number in 0..=frames {
            let started = ThreadTime::now();
            let tally = if number > 0 { sources.step(&self.settings) } else { sources.show(&self.settings) };
            let holes = self.paint(&sources, &grid, &mut canvas);
            let (tally, time) = if number > 0 {
                (
                    Tally { galdebris: if self.fills() { tally.empty } else { 0 }, empty: holes, ..tally },
                    started.elapsed(),
                )
            } else {
                (Tally::default(), Duration::ZERO)
            };
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
            let shown = Shown::Sources { grid, format: &self.format, colours: &canvas.finished, places: &places };
            visit(&Frame { number, tally, time, shown, overlay: overlay.as_ref(), origins: &origins });
        }
        let base = loaded.remove(0);
        Ok(Ran { loaded: base, hidden: loaded, used })
    }

    /// Whether holes are filled by what is around them.
    fn fills(&self) -> bool {
        self.settings.fill_mode == galpix_core::FillMode::Extend
    }

    /// Makes the picture of a frame; returns the cells that show no sample.
    fn paint(&self, sources: &Sources<'_, '_, Dynamic>, grid: &Grid<'_>, canvas: &mut Canvas) -> u32 {
        let Canvas { gathered, finished, known, depths, pyramid } = canvas;
        let width = grid.width() as usize;
        let gather = Gather {
            fill_mode: self.settings.fill_mode,
            sub_cell: self.scan_out == ScanOut::SubCell,
            edge_threshold: self.settings.edge_threshold,
        };
        let holes: u32 = (0..).zip(gathered.chunks_mut(width)).map(|(y, row)| sources.gather(y, gather, row)).sum();
        if let Some(inpaint) = self.inpaint {
            known.fill(0);
            for (y, depths) in (0..).zip(depths.chunks_mut(width)) {
                sources.known(y, known, depths);
            }
            let bits = Sources::<Dynamic>::DEPTH_BITS;
            let own = u32::from(self.format.record().depth().bits);
            let Settings { edge_threshold, .. } = self.settings;
            let threshold = if own > bits { edge_threshold >> (own - bits) } else { edge_threshold << (bits - own) };
            let inpainting = if inpaint.depth_aware {
                Inpainting::for_edge_threshold(threshold, bits, inpaint.gamma)
            } else {
                Inpainting { gamma: inpaint.gamma, ..Inpainting::classic() }
            };
            let colour = *self.format.record().colour_format();
            let (width, height) = (grid.width(), grid.height());
            if let Ok(mut push_pull) = PushPull::new(width, height, Motion::Kept, pyramid)
                && let Ok(picture) = Picture::new(width, height, colour, gathered, known)
                && let Ok(mut picture) = picture.with_depths(depths)
            {
                push_pull.fill_picture(&mut picture, &inpainting);
            }
        }
        if gather.sub_cell {
            let row = |y: Option<usize>| y.and_then(|y| gathered.chunks(width).nth(y)).unwrap_or_default();
            for (y, to) in finished.chunks_mut(width).enumerate() {
                let around = [row(y.checked_sub(1)), row(Some(y)), row(Some(y + 1))];
                sources.finish(y as u32, self.settings.edge_threshold, around, to);
            }
        } else {
            finished.copy_from_slice(gathered);
        }
        holes
    }
}
