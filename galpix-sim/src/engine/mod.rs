//! The engine over memory of the host: one update in, with hidden layers or without, frames out, with what is needed
//! to judge them.

mod base;
pub mod fill;
mod frame;
mod layer;
mod load;
mod origins;
mod scan_out;
mod sources;

use std::time::Duration;

use cpu_time::ThreadTime;
use galpix_core::layers::{Layer, Layers};
use galpix_core::overlay::Overlay;
use galpix_core::source::{MOST_SAMPLES, Sources};
use galpix_core::{
    BudgetError, Colour, Controller, Dynamic, FillMode, Grid, Maps, Margin, Settings, SetupError, Tally,
};

pub use frame::Frame;
pub use layer::HiddenLayer;
pub use load::{LoadTally, galpixel, load};
pub(crate) use load::{grid, margin};
pub use origins::NO_ORIGIN;
pub use scan_out::ScanOut;
pub(crate) use sources::Canvas;

use crate::update::Update;
use base::Base;
use fill::{Fill, Inpaint, Inpainter, Kind};
use frame::{Shown, display_cells};
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

/// The engine over owned memory.
pub struct Engine {
    format: Dynamic,
    settings: Settings,
    inpaint: Option<Inpaint>,
    constant_time: bool,
    scheme: Scheme,
    scan_out: ScanOut,
    outlined: bool,
}

/// How galpixels move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Scheme {
    /// Each frame moves them into the next map: the paper's galpixmap.
    #[default]
    Map,
    /// They stay where the update put them, and each frame finds out where they are seen: stationary sources.
    Source,
}

impl Scheme {
    /// Returns the name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Map => "map",
            Self::Source => "source",
        }
    }

    /// Returns the other one.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Map => Self::Source,
            Self::Source => Self::Map,
        }
    }

    /// Returns what is put into holes, unless told otherwise.
    #[must_use]
    pub fn fill(self) -> Fill {
        match self {
            Self::Map => Fill::default(),
            Self::Source => Kind::PushPull.into(),
        }
    }

    /// Returns whether holes can be filled like this.
    #[must_use]
    pub const fn takes(self, fill: Fill) -> bool {
        use FillMode::{Extend, Hold, None};
        match (self, fill) {
            (Self::Map, _) | (Self::Source, Fill::Mode(None | Hold | Extend) | Fill::Inpaint(_)) => true,
            (Self::Source, Fill::Mode(_)) => false,
        }
    }

    /// Returns how its cells become pixels, unless told otherwise.
    #[must_use]
    pub const fn scan_out(self) -> ScanOut {
        match self {
            Self::Map => ScanOut::Nearest,
            Self::Source => ScanOut::SubCell,
        }
    }
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
        Self {
            format,
            settings,
            inpaint: None,
            constant_time: false,
            scheme: Scheme::Map,
            scan_out: ScanOut::Nearest,
            outlined: false,
        }
    }

    /// Returns the same with inpainting after each frame; its fill mode should be
    /// [`crate::engine::fill::Fill::mode`]'s.
    #[must_use]
    pub const fn inpainting(self, inpaint: Option<Inpaint>) -> Self {
        Self { inpaint, ..self }
    }

    /// Returns the same with galpixels that move, and pictures that are made, in another way.
    #[must_use]
    pub const fn showing(self, scheme: Scheme, scan_out: ScanOut) -> Self {
        Self { scheme, scan_out, ..self }
    }

    /// Returns the same, with [`Frame::outline`] of each frame.
    #[must_use]
    pub const fn outlined(self) -> Self {
        Self { outlined: true, ..self }
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
        if self.scheme == Scheme::Source {
            return self.run_sources(delivered, frames, &mut visit);
        }
        let mut memory = Base::new(update, self.format)?;
        let mut starts = memory.starts.clone();
        let grid = grid(update, &mut starts)?;
        let mut sources =
            sources::Memory::new(&grid, self.format, usize::from(self.outlined && grid.cells() <= MOST_SAMPLES));
        let (mut source, visibility) = sources.lay(grid, self.format)?;
        let outline = match source.is_empty() {
            true => None,
            false => Some(self.outline_of(update, (&mut source, visibility))?),
        };
        if hidden.is_empty() {
            let mut controller = memory.controller(update, self.format)?;
            let loaded = load(update, controller.front_mut());
            let step = if self.constant_time { Controller::step_constant_time } else { Controller::step };
            let stepped = Stepped { maps: controller, step, outline };
            let used = self.frames(stepped, delivered, frames, &mut visit)?;
            return Ok(Ran { loaded, hidden: Vec::new(), used });
        }
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
        let used = self.frames(Stepped { maps: layers, step: Maps::step, outline }, delivered, frames, &mut visit)?;
        Ok(Ran { loaded, hidden: loaded_hidden, used })
    }

    /// Shows the update and `frames` frames; returns which samples were ever shown.
    fn frames<'p>(
        &self,
        Stepped { mut maps, step, mut outline }: Stepped<'_, '_, impl Maps<'p, Format = Dynamic>>,
        Delivered { update, hidden }: Delivered<'_>,
        frames: u32,
        visit: Visit<'_>,
    ) -> Result<Vec<bool>, EngineError> {
        let grid = *maps.shown().grid();
        let colour = *maps.shown().record().colour_format();
        let mut pins = Pins::new(update, &grid, colour);
        let overlay = pins.overlay()?;
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
            let shown = Shown::Map { map: maps.shown(), scan_out: self.scan_out, settings: &self.settings };
            let outline = outline.as_mut().map(|outline| self.outline(outline, number));
            visit(&Frame { number, tally, time, shown, overlay, origins: &origins.shown, outline });
        }
        Ok(origins.used)
    }
}

/// What an update pins over the picture, and the memory for it.
struct Pins<'u> {
    update: &'u Update,
    colour: Colour,
    size: [u32; 2],
    rows: Vec<u32>,
    pinned: Vec<u32>,
}

impl<'u> Pins<'u> {
    fn new(update: &'u Update, grid: &Grid<'_>, colour: Colour) -> Self {
        let size = [grid.display_width(), grid.display_height()];
        Self { update, colour, size, rows: vec![0; Grid::rows(size[1], Margin::NONE)], pinned: Vec::new() }
    }

    /// Returns the overlay; none if nothing is pinned.
    fn overlay(&mut self) -> Result<Option<Overlay<'_>>, SetupError> {
        let Some(given) = &self.update.overlay else { return Ok(None) };
        let display = Grid::new(self.size[0], self.size[1], Margin::NONE, &mut self.rows)?;
        self.pinned = vec![0; Overlay::words(&display)];
        let mut overlay = Overlay::new(display, self.colour, &mut self.pinned)?;
        given.pin(&mut overlay);
        Ok(Some(overlay))
    }
}

/// Maps, and how their next frame is made.
struct Stepped<'p, 'l, M> {
    maps: M,
    step: fn(&mut M, &Settings) -> Tally,
    /// The update's samples alone, see [`Frame::outline`].
    outline: Option<Sources<'p, 'l, Dynamic>>,
}

type Visit<'v> = &'v mut dyn FnMut(&Frame<'_>);
