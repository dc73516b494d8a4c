//! The engine over memory of the host: one update in, frames out, with what is needed to judge them.

use std::time::Duration;

use cpu_time::ThreadTime;
use fixed::types::I32F32;
use galpix_core::budget::Bits;
use galpix_core::error::{BudgetError, SetupError};
use galpix_core::fill::FILLED;
use galpix_core::frame::{Controller, Scratch, Settings};
use galpix_core::galpixel::{Budget, Chosen, Class, Galpixel};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::{Grid, Wings as CoreWings};
use galpix_core::layout::{Lanes, Layout};
use galpix_core::overlay::{self, Overlay};
use galpix_core::tally::Tally;
use galpix_core::{edge, scan_out};

use crate::fill::{Inpaint, Inpainter};
use crate::picture::Picture;
use crate::update::{Known, Sample, Update, Wings};

/// In an origin map: this cell does not hold a galpixel of the update.
pub const NO_ORIGIN: u32 = u32::MAX;

/// Why a run could not be set up.
#[derive(Debug, thiserror::Error)]
pub enum EngineError {
    /// The budget does not fit the layout.
    #[error("{0}")]
    Budget(#[from] BudgetError),
    /// The map cannot be laid out.
    #[error("{0}")]
    Setup(#[from] SetupError),
}

/// What entered with the update.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct LoadTally {
    /// Cells with a galpixel.
    pub galpixels: u32,
    /// Cells that start empty because depth or motion is unknown.
    pub empty: u32,
    /// Fields that had to be clamped to their range.
    pub saturated: u32,
}

/// One frame as the display shows it, and what is known about it.
pub struct Frame<'f, L: Layout> {
    /// Frames since the update.
    pub number: u32,
    /// What the engine counted; all zero for the update itself.
    pub tally: Tally,
    /// The processor time of the engine's own work: what else runs on the machine does not count.
    pub time: Duration,
    map: &'f Galpixmap<'f, L, Chosen<L>>,
    overlay: Option<&'f Overlay<'f, L::Colour>>,
    origins: &'f [u32],
}

/// The engine over owned memory.
pub struct Engine<L> {
    budget: Chosen<L>,
    settings: Settings,
    inpaint: Option<Inpaint>,
}

impl<L: Layout> Engine<L> {
    /// An engine for a budget.
    ///
    /// *Errors:* a budget that does not fit the layout.
    pub fn new(bits: Bits, settings: Settings) -> Result<Self, EngineError> {
        Ok(Self { budget: Chosen::new(bits)?, settings, inpaint: None })
    }

    /// An engine for a budget that keeps only a part of the layout's lanes, see [`Chosen::with_lanes`].
    ///
    /// *Errors:* lanes that the layout lacks, a budget that does not fit them.
    pub fn with_lanes(bits: Bits, lanes: Lanes, settings: Settings) -> Result<Self, EngineError> {
        Ok(Self { budget: Chosen::with_lanes(bits, lanes)?, settings, inpaint: None })
    }

    /// The same with inpainting after each frame; its rung should be [`crate::fill::Fill::rung`]'s.
    #[must_use]
    pub fn inpainting(self, inpaint: Option<Inpaint>) -> Self {
        Self { inpaint, ..self }
    }

    /// Extrapolates an update by `frames` frames; `visit` sees the update itself (frame 0) and every frame.
    ///
    /// *Errors:* an update that cannot be laid out.
    pub fn run(
        &self,
        update: &Update,
        frames: u32,
        mut visit: impl FnMut(&Frame<'_, L>),
    ) -> Result<LoadTally, EngineError> {
        let wings = core_wings(update.wings);
        let (width, height) = (update.display_width() as u32, update.display_height() as u32);
        let mut starts = vec![0; Grid::rows(height, wings)];
        let grid = Grid::new(width, height, wings, &mut starts)?;
        let words = Galpixmap::<L, _>::words(&grid, self.budget);
        let (mut front, mut back) = (vec![0; words], vec![0; words]);
        let mut winners = vec![0; grid.cells() as usize];
        let mut edges = vec![0; edge::words(&grid)];
        let mut controller = Controller::new(
            Galpixmap::<L, _>::new(grid, self.budget, &mut front)?,
            Galpixmap::new(grid, self.budget, &mut back)?,
            Scratch { winners: &mut winners, edges: &mut edges },
        )?;
        let mut rows = vec![0; Grid::rows(height, CoreWings::NONE)];
        let display = Grid::new(width, height, CoreWings::NONE, &mut rows)?;
        let mut pinned = vec![0; if update.overlay.is_some() { Overlay::<L::Colour>::words(&display) } else { 0 }];
        let overlay = match &update.overlay {
            Some(given) => {
                let mut overlay = Overlay::new(display, &mut pinned)?;
                given.pin(&mut overlay);
                Some(overlay)
            }
            None => None,
        };
        let overlay = overlay.as_ref();
        let mut inpainter = self.inpaint.map(|inpaint| Inpainter::new(&grid, inpaint));
        let loaded = load(update, controller.front_mut());
        let mut origins: Vec<u32> = (0u32..)
            .zip(&update.samples)
            .map(|(cell, sample)| if sample.known == Known::Motion { cell } else { NO_ORIGIN })
            .collect();
        let no_time = Duration::ZERO;
        let (map, tally) = (controller.front(), Tally::default());
        visit(&Frame { number: 0, tally, time: no_time, map, overlay, origins: &origins });
        for number in 1..=frames {
            let started = ThreadTime::now();
            let tally = controller.step(&self.settings);
            if let Some(inpainter) = &mut inpainter {
                inpainter.paint(&mut controller, &self.settings);
            }
            let time = started.elapsed();
            origins = follow(&controller, &origins);
            visit(&Frame { number, tally, time, map: controller.front(), overlay, origins: &origins });
        }
        Ok(loaded)
    }
}

/// The wings of an update, as the core has them.
pub(crate) fn core_wings(wings: Wings) -> CoreWings {
    let cells = |cells: usize| u32::try_from(cells).unwrap_or(u32::MAX);
    CoreWings { left: cells(wings.left), right: cells(wings.right), top: cells(wings.top), bottom: cells(wings.bottom) }
}

/// Writes the samples of an update into a map, quantised to its budget.
pub fn load<L: Layout, B: Budget<L>>(update: &Update, map: &mut Galpixmap<'_, L, B>) -> LoadTally {
    let mut tally = LoadTally::default();
    for (y, row) in (0i32..).zip(update.samples.chunks(update.width.max(1))) {
        for (x, sample) in (0i32..).zip(row) {
            match sample.known {
                Known::Motion => tally.galpixels += 1,
                Known::ColourOnly => tally.empty += 1,
            }
            tally.saturated += map.store(x, y, &galpixel(sample)).unwrap_or(0);
        }
    }
    tally
}

/// A sample as a galpixel in fixed point: 32 fraction bits, so that the rounding that counts is the budget's.
#[must_use]
pub fn galpixel(sample: &Sample) -> Galpixel {
    if sample.known == Known::ColourOnly {
        return Galpixel { class: Class::Empty, colour: sample.colour, ..Galpixel::default() };
    }
    Galpixel {
        class: Class::Galpixel,
        colour: sample.colour,
        offset: [I32F32::ZERO; 2],
        depth: I32F32::saturating_from_num(sample.depth),
        velocity: sample.velocity.map(I32F32::saturating_from_num),
        acceleration: sample.acceleration.map(I32F32::saturating_from_num),
        luminosity_rate: I32F32::saturating_from_num(sample.luminosity_rate),
        tag: u32::from(sample.tag),
    }
}

/// For each cell of the shown map, the sample of the update that it holds.
fn follow<L: Layout>(controller: &Controller<'_, L, Chosen<L>>, before: &[u32]) -> Vec<u32> {
    (0u32..)
        .zip(controller.winners())
        .map(|(cell, &winner)| {
            if winner >= FILLED || controller.front().class(cell) != Class::Galpixel {
                return NO_ORIGIN;
            }
            before.get(winner as usize).copied().unwrap_or(NO_ORIGIN)
        })
        .collect()
}

impl<L: Layout> Frame<'_, L> {
    /// What the display shows.
    #[must_use]
    pub fn picture(&self) -> Picture {
        use galpix_core::colour::Colour;
        let grid = self.map.grid();
        let (width, height) = (grid.display_width() as usize, grid.display_height() as usize);
        let rows = 0..height as u32;
        let words: Vec<u32> = match self.overlay {
            Some(overlay) => rows.flat_map(|y| overlay::row(self.map, overlay, y)).collect(),
            None => rows.flat_map(|y| scan_out::row(self.map, y)).collect(),
        };
        let pixels = words.into_iter().map(L::Colour::to_rgb888).collect();
        Picture { width, height, pixels }
    }

    /// For each pixel of the display, whether a galpixel of the update reached it, or something is pinned there.
    #[must_use]
    pub fn reached(&self) -> Vec<bool> {
        let width = self.map.grid().display_width();
        let pinned = |at: u32| self.overlay.is_some_and(|overlay| overlay.pinned(at % width, at / width).is_some());
        (0..)
            .zip(self.display_cells())
            .map(|(at, cell)| self.origins[cell as usize] != NO_ORIGIN || pinned(at))
            .collect()
    }

    fn display_cells(&self) -> impl Iterator<Item = u32> {
        let grid = self.map.grid();
        let wings = grid.wings();
        let (width, height) = (grid.display_width(), grid.display_height());
        (0..height).flat_map(move |y| {
            (0..width).filter_map(move |x| grid.cell((x + wings.left) as i32, (y + wings.top) as i32))
        })
    }

    /// The map.
    #[must_use]
    pub fn map(&self) -> &Galpixmap<'_, L, Chosen<L>> {
        self.map
    }

    /// Every galpixel of the update that is still on the map: its sample, and its place (x, y) in cells of the map.
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
