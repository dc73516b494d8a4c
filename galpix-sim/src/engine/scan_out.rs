//! How cells become the pixels of a picture.

use galpix_core::overlay::Overlay;
use galpix_core::scan_out::{Nearest, Over, Sampling};
use galpix_core::sub_cell::SubCell;
use galpix_core::{Dynamic, Galpixmap, Settings};

/// What a pixel shows of the galpixels around it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ScanOut {
    /// The colour of its own cell.
    #[default]
    Nearest,
    /// What galpixels show at its centre, by their offsets.
    SubCell,
}

impl ScanOut {
    /// Returns the name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Nearest => "nearest",
            Self::SubCell => "sub-cell",
        }
    }

    /// Returns the colour words of the display, row by row. Neighbours are of one surface by the edge threshold of the
    /// frames.
    pub(super) fn words(
        self,
        map: &Galpixmap<'_, Dynamic>,
        overlay: Option<&Overlay<'_>>,
        settings: &Settings,
    ) -> Vec<u32> {
        match self {
            Self::Nearest => words(Nearest, map, overlay),
            Self::SubCell => words(SubCell { edge_threshold: settings.edge_threshold }, map, overlay),
        }
    }
}

fn words(sampling: impl Sampling, map: &Galpixmap<'_, Dynamic>, overlay: Option<&Overlay<'_>>) -> Vec<u32> {
    let (width, height) = (map.grid().display_width(), map.grid().display_height());
    let row = |y| sampling.span(map, y, 0, width);
    match overlay {
        Some(overlay) => (0..height).flat_map(|y| overlay.over(row(y), y, 0)).collect(),
        None => (0..height).flat_map(row).collect(),
    }
}
