//! One frame, and what is known about it.

use std::time::Duration;

use galpix_core::overlay::Overlay;
use galpix_core::scan_out::Over;
use galpix_core::source::Sources;
use galpix_core::{Class, Dynamic, Format, Galpixmap, Grid, Settings, Tally};

use super::{NO_ORIGIN, ScanOut};
use crate::picture::Picture;

/// One frame as the display shows it, and what is known about it.
pub struct Frame<'f> {
    /// Frames since the update.
    pub number: u32,
    /// What the engine counted; all zero for the update itself.
    pub tally: Tally,
    /// The processor time of the engine's own work: what else runs on the machine does not count.
    pub time: Duration,
    pub(super) shown: Shown<'f>,
    pub(super) overlay: Option<&'f Overlay<'f>>,
    pub(super) origins: &'f [u32],
    /// For each cell, whether the update's samples alone reach it as stationary sources; `None` if `origins` says so.
    pub(super) outline: Option<Vec<bool>>,
}

/// The number of a sample, as in [`Frame::origins`], and its place (x, y) in cells of the map.
pub type Place = (u32, [f64; 2]);

/// What is shown.
pub(super) enum Shown<'f> {
    /// A map, and how its cells become pixels.
    Map { map: &'f Galpixmap<'f, Dynamic>, scan_out: ScanOut, settings: &'f Settings },
    /// The colour words of all cells that were made of stationary sources, and where their samples are.
    Sources { grid: Grid<'f>, format: &'f Dynamic, colours: &'f [u32], places: &'f dyn Fn() -> Vec<Place> },
}

impl Frame<'_> {
    const fn grid(&self) -> &Grid<'_> {
        match &self.shown {
            Shown::Map { map, .. } => map.grid(),
            Shown::Sources { grid, .. } => grid,
        }
    }

    /// Returns what the display shows.
    #[must_use]
    pub fn picture(&self) -> Picture {
        let grid = self.grid();
        let (width, height) = (grid.display_width() as usize, grid.display_height() as usize);
        let (words, colour) = match &self.shown {
            Shown::Map { map, scan_out, settings } => {
                (scan_out.words(map, self.overlay, settings), map.record().colour_format())
            }
            Shown::Sources { format, colours, .. } => {
                let words: Vec<u32> = display_cells(grid).map(|cell| colours[cell as usize]).collect();
                let words = match self.overlay {
                    Some(overlay) => {
                        let rows = (0..).zip(words.chunks(width));
                        rows.flat_map(|(y, row)| overlay.over(row.iter().copied(), y, 0)).collect()
                    }
                    None => words,
                };
                (words, format.record().colour_format())
            }
        };
        let pixels = words.into_iter().map(|word| colour.to_rgb888(word)).collect();
        Picture { width, height, pixels }
    }

    /// For each pixel of the display, whether a galpixel of the update reached it, or something is pinned there.
    #[must_use]
    pub fn reached(&self) -> Vec<bool> {
        self.pixels(|cell| self.origins[cell] != NO_ORIGIN)
    }

    /// For each pixel of the display, whether a sample of the update would be seen there if none was lost on the way:
    /// as stationary sources, whatever the scheme.
    #[must_use]
    pub fn outline(&self) -> Vec<bool> {
        match &self.outline {
            Some(outline) => self.pixels(|cell| outline[cell]),
            None => self.reached(),
        }
    }

    /// Returns for each pixel whether something holds for its cell or something is pinned there.
    fn pixels(&self, holds: impl Fn(usize) -> bool) -> Vec<bool> {
        let width = self.grid().display_width();
        let pinned = |at: u32| self.overlay.is_some_and(|overlay| overlay.pinned(at % width, at / width).is_some());
        (0..).zip(display_cells(self.grid())).map(|(at, cell)| holds(cell as usize) || pinned(at)).collect()
    }

    /// For each pixel of the display, the number of the sample that it shows: its cell, plus the cells of an update for
    /// each layer above the base; [`NO_ORIGIN`] where it shows none.
    pub fn origins(&self) -> impl Iterator<Item = u32> {
        display_cells(self.grid()).map(|cell| self.origins[cell as usize])
    }

    /// Returns the map; `None` in the scheme of stationary sources.
    #[must_use]
    pub const fn map(&self) -> Option<&Galpixmap<'_, Dynamic>> {
        match &self.shown {
            Shown::Map { map, .. } => Some(*map),
            Shown::Sources { .. } => None,
        }
    }

    /// Returns every galpixel that is still there, of stationary sources every one on the map.
    #[must_use]
    pub fn places(&self) -> Vec<Place> {
        match &self.shown {
            Shown::Map { map, .. } => cells(*map.grid())
                .zip(self.origins)
                .filter(|&(_, &origin)| origin != NO_ORIGIN)
                .filter_map(|(cell, &origin)| Some((origin, place(map, cell, [0; 2])?)))
                .collect(),
            Shown::Sources { places, .. } => places(),
        }
    }
}

/// Returns the places of all samples that are on the map.
pub(super) fn places_of(sources: &Sources<'_, '_, Dynamic>) -> Vec<Place> {
    let layers = sources.layers().iter().flat_map(|source| {
        cells(*source.map().grid()).zip(0..).map(move |([x, y], cell)| {
            let [dx, dy] = source.displacement(cell);
            let shown =
                source.map().class(cell) == Class::Galpixel && source.map().grid().cell(x + dx, y + dy).is_some();
            if shown { place(source.map(), [x, y], [dx, dy]) } else { None }
        })
    });
    (0..).zip(layers).filter_map(|(origin, place)| Some((origin, place?))).collect()
}

/// Returns column and row of all cells.
fn cells(grid: Grid<'_>) -> impl Iterator<Item = [i32; 2]> {
    let (width, height) = (grid.width() as i32, grid.height() as i32);
    (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
}

/// Returns the place of a galpixel that is so many cells from where it is stored.
fn place(map: &Galpixmap<'_, Dynamic>, [x, y]: [i32; 2], moved: [i32; 2]) -> Option<[f64; 2]> {
    let offset = map.load(x, y)?.offset.map(|offset| offset.to_num::<f64>());
    Some([f64::from(x + moved[0]) + offset[0], f64::from(y + moved[1]) + offset[1]])
}

/// Returns the cells of the display, row by row.
pub(super) fn display_cells(grid: &Grid<'_>) -> impl Iterator<Item = u32> {
    let margin = grid.margin();
    let (width, height) = (grid.display_width(), grid.display_height());
    let cell = move |x: u32, y: u32| grid.cell((x + margin.left) as i32, (y + margin.top) as i32);
    (0..height).flat_map(move |y| (0..width).filter_map(move |x| cell(x, y)))
}
