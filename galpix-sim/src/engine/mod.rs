//! The engine over memory of the host: one update in, with hidden layers or without, frames out, with what is needed
//! to judge them.

mod base;
pub mod fill;
mod layer;
mod load;
mod origins;
mod scan_out;

use std::time::Duration;

use cpu_time::ThreadTime;
use galpix_core::layers::{Layer, Layers};
use galpix_core::overlay::Overlay;
use galpix_core::{BudgetError, Controller, Dynamic, Galpixmap, Grid, Maps, Margin, Settings, SetupError, Tally};

pub use layer::HiddenLayer;
pub use load::{LoadTally, galpixel, load};
pub(crate) use load::{grid, margin};
pub use origins::NO_ORIGIN;
pub use scan_out::ScanOut;

use crate::picture::Picture;
use crate::update::Update;
use base::Base;
use fill::{Inpaint, Inpainter};
use load::load_at;
use origins::Origins;

/// The most hidden layers of an update.
pub const MAX_HIDDEN: usize = 8;

/// Why a run could not be set up.
#[derive(Debug, thiserror::Error)]
pub enum EngineError {
    /// The budget does not fit the layout.
    #[error("{0}")]
    Budget(#[from] BudgetError),
    /// The map cannot be laid out.
    #[error("{0}")]
    Setup(#[from] SetupError),
    /// A layer that does not lie over the update.
    #[error("a layer of {width}x{height} samples does not lie over an update of {}x{}: deliver both at the same size", of[0], of[1])]
    LayerSize {
        /// Its columns.
        width: usize,
        /// Its rows.
        height: usize,
        /// Those of the update.
        of: [usize; 2],
    },
    /// More layers than there is room for.
    #[error("{0} hidden layers are more than the {MAX_HIDDEN} that there is room for: leave the farthest out")]
    TooManyLayers(usize),
}

/// What a run reports besides its frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ran {
    /// What entered with the update.
    pub loaded: LoadTally,
    /// What entered with each hidden layer.
    pub hidden: Vec<LoadTally>,
    /// For each sample, by its number in [`Frame::origins`], whether the display ever showed it.
    pub used: Vec<bool>,
}

/// One frame as the display shows it, and what is known about it.
pub struct Frame<'f> {
    /// Frames since the update.
    pub number: u32,
    /// What the engine counted; all zero for the update itself.
    pub tally: Tally,
    /// The processor time of the engine's own work: what else runs on the machine does not count.
    pub time: Duration,
    map: &'f Galpixmap<'f, Dynamic>,
    overlay: Option<&'f Overlay<'f>>,
    settings: &'f Settings,
    scan_out: ScanOut,
    origins: &'f [u32],
}

/// The engine over owned memory.
pub struct Engine {
    format: Dynamic,
    settings: Settings,
    inpaint: Option<Inpaint>,
    constant_time: bool,
    scan_out: ScanOut,
}

/// An update and its hidden layers, the first of which is layer 1.
#[derive(Clone, Copy)]
struct Delivered<'u> {
    update: &'u Update,
    hidden: &'u [HiddenLayer<'u>],
}

impl Engine {
    /// Makes an engine for maps of a format.
    #[must_use]
    pub const fn new(format: Dynamic, settings: Settings) -> Self {
        Self { format, settings, inpaint: None, constant_time: false, scan_out: ScanOut::Nearest }
    }

    /// Returns the same with inpainting after each frame; its fill mode should be
    /// [`crate::engine::fill::Fill::mode`]'s.
    #[must_use]
    pub const fn inpainting(self, inpaint: Option<Inpaint>) -> Self {
        Self { inpaint, ..self }
    }

    /// Returns the same with pictures that are made in another way.
    #[must_use]
    pub const fn scanning_out(self, scan_out: ScanOut) -> Self {
        Self { scan_out, ..self }
    }

    /// Returns the same by instructions that do not depend on the picture, if `constant_time`.
    #[must_use]
    pub const fn constant_time(self, constant_time: bool) -> Self {
        Self { constant_time, ..self }
    }

    /// Extrapolates an update by `frames` frames; `visit` sees the update itself (frame 0) and every frame.
    ///
    /// *Errors:* an update that cannot be laid out.
    pub fn run(&self, update: &Update, frames: u32, visit: impl FnMut(&Frame<'_>)) -> Result<LoadTally, EngineError> {
        Ok(self.run_layers(update, &[], frames, visit)?.loaded)
    }

    /// Returns the same with hidden layers, the first of which is layer 1.
    ///
    /// *Errors:* an update that cannot be laid out, layers of another size, more than [`MAX_HIDDEN`] of them.
    pub fn run_layers(
        &self,
        update: &Update,
        hidden: &[HiddenLayer<'_>],
        frames: u32,
        mut visit: impl FnMut(&Frame<'_>),
    ) -> Result<Ran, EngineError> {
        let of = [update.width, update.height];
        let size = |update: &Update| [update.width, update.height];
        if let Some(other) =
            hidden.iter().map(HiddenLayer::update).find(|other| size(other) != of || other.margin != update.margin)
        {
            return Err(EngineError::LayerSize { width: other.width, height: other.height, of });
        }
        if hidden.len() > MAX_HIDDEN {
            return Err(EngineError::TooManyLayers(hidden.len()));
        }
        let delivered = Delivered { update, hidden };
        let mut memory = Base::new(update, self.format)?;
        if hidden.is_empty() {
            let mut controller = memory.controller(update, self.format)?;
            let loaded = load(update, controller.front_mut());
            let step = if self.constant_time { Controller::step_constant_time } else { Controller::step };
            let used = self.frames(Stepped { maps: controller, step }, delivered, frames, &mut visit)?;
            return Ok(Ran { loaded, hidden: Vec::new(), used });
        }
        let mut starts = memory.starts.clone();
        let grid = grid(update, &mut starts)?;
        let mut own: Vec<layer::Memory> =
            hidden.iter().map(|hidden| layer::Memory::new(&grid, self.format, hidden)).collect();
        let base = memory.controller(update, self.format)?;
        let mut own_layers: Vec<Layer<'_, Dynamic>> =
            own.iter_mut().map(|memory| memory.layer(grid, self.format)).collect::<Result<_, _>>()?;
        let mut layers = Layers::new(base, &mut own_layers)?;
        let loaded = layers.layer_mut(0).map(|map| load(update, map)).unwrap_or_default();
        let store = |(layer, hidden): (usize, &HiddenLayer<'_>)| layers.layer_mut(layer).map(|map| hidden.load(map));
        let loaded_hidden = (1..).zip(hidden).filter_map(store).collect();
        layers.composite();
        let used = self.frames(Stepped { maps: layers, step: Maps::step }, delivered, frames, &mut visit)?;
        Ok(Ran { loaded, hidden: loaded_hidden, used })
    }

    /// Shows the update and `frames` frames; returns which samples were ever shown.
    fn frames<'p>(
        &self,
        Stepped { mut maps, step }: Stepped<impl Maps<'p, Format = Dynamic>>,
        Delivered { update, hidden }: Delivered<'_>,
        frames: u32,
        visit: Visit<'_>,
    ) -> Result<Vec<bool>, EngineError> {
        let grid = *maps.shown().grid();
        let colour = *maps.shown().record().colour_format();
        let mut rows = vec![0; Grid::rows(grid.display_height(), Margin::NONE)];
        let display = Grid::new(grid.display_width(), grid.display_height(), Margin::NONE, &mut rows)?;
        let mut pinned = vec![0; if update.overlay.is_some() { Overlay::words(&display) } else { 0 }];
        let overlay = match &update.overlay {
            Some(given) => {
                let mut overlay = Overlay::new(display, colour, &mut pinned)?;
                given.pin(&mut overlay);
                Some(overlay)
            }
            None => None,
        };
        let overlay = overlay.as_ref();
        let mut inpainter = self.inpaint.map(|inpaint| Inpainter::new(&grid, inpaint));
        let mut origins = Origins::new(update, hidden);
        let mut tally = Tally::default();
        let mut time = Duration::ZERO;
        for number in 0..=frames {
            if number > 0 {
                let started = ThreadTime::now();
                tally = step(&mut maps, &self.settings);
                if let Some(inpainter) = &mut inpainter {
                    inpainter.paint(&mut maps, &self.settings);
                }
                time = started.elapsed();
                origins.follow(&maps, hidden);
            }
            origins.look(&maps, hidden, display_cells(&grid));
            let (map, origins, settings) = (maps.shown(), &origins.shown, &self.settings);
            visit(&Frame { number, tally, time, map, overlay, settings, scan_out: self.scan_out, origins });
        }
        Ok(origins.used)
    }
}

/// Maps, and how their next frame is made.
struct Stepped<M> {
    maps: M,
    step: fn(&mut M, &Settings) -> Tally,
}

type Visit<'v> = &'v mut dyn FnMut(&Frame<'_>);

impl Frame<'_> {
    /// Returns what the display shows.
    #[must_use]
    pub fn picture(&self) -> Picture {
        let grid = self.map.grid();
        let (width, height) = (grid.display_width() as usize, grid.display_height() as usize);
        let words = self.scan_out.words(self.map, self.overlay, self.settings);
        let colour = self.map.record().colour_format();
        let pixels = words.into_iter().map(|word| colour.to_rgb888(word)).collect();
        Picture { width, height, pixels }
    }

    /// For each pixel of the display, whether a galpixel of the update reached it, or something is pinned there.
    #[must_use]
    pub fn reached(&self) -> Vec<bool> {
        let width = self.map.grid().display_width();
        let pinned = |at: u32| self.overlay.is_some_and(|overlay| overlay.pinned(at % width, at / width).is_some());
        (0..)
            .zip(display_cells(self.map.grid()))
            .map(|(at, cell)| self.origins[cell as usize] != NO_ORIGIN || pinned(at))
            .collect()
    }

    /// For each pixel of the display, the number of the sample that it shows: its cell, plus the cells of an update for
    /// each layer above the base; [`NO_ORIGIN`] where it shows none.
    pub fn origins(&self) -> impl Iterator<Item = u32> {
        display_cells(self.map.grid()).map(|cell| self.origins[cell as usize])
    }

    /// Returns the map.
    #[must_use]
    pub fn map(&self) -> &Galpixmap<'_, Dynamic> {
        self.map
    }

    /// Returns every galpixel that is still shown: the number of its sample, as in [`Self::origins`], and its place (x,
    /// y) in cells of the map.
    pub fn places(&self) -> impl Iterator<Item = (u32, [f64; 2])> {
        let grid = *self.map.grid();
        (0..grid.height() as i32).flat_map(move |y| {
            (0..grid.width() as i32).filter_map(move |x| {
                let origin = *self.origins.get(grid.cell(x, y)? as usize)?;
                if origin == NO_ORIGIN {
                    return None;
                }
                let offset = self.map.load(x, y)?.offset.map(|offset| offset.to_num::<f64>());
                Some((origin, [f64::from(x) + offset[0], f64::from(y) + offset[1]]))
            })
        })
    }
}

/// Returns the cells of the display, row by row.
fn display_cells(grid: &Grid<'_>) -> impl Iterator<Item = u32> {
    let margin = grid.margin();
    let (width, height) = (grid.display_width(), grid.display_height());
    let cell = move |x: u32, y: u32| grid.cell((x + margin.left) as i32, (y + margin.top) as i32);
    (0..height).flat_map(move |y| (0..width).filter_map(move |x| cell(x, y)))
}
