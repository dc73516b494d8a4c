//! Galpixels as a panel's maps store them.

use galpix_core::{Galpixel, Galpixmap, Grid, Margin, SetupError, Static};
use galpix_link::panel::{Description, Lcd, Oled, Panel, Tft};

/// A whole map of stored galpixels, row by row; all words of a galpixel follow each other, each with its lowest byte
/// first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Packed {
    /// The words.
    pub bytes: Vec<u8>,
    /// Fields that had to be clamped to their range.
    pub saturated: u32,
}

impl Packed {
    /// Returns the rows of the panel that it was made for.
    pub fn rows(&self, panel: &Description) -> impl Iterator<Item = &[u8]> {
        self.bytes.chunks((usize::from(panel.width) * panel.bytes_per_galpixel()).max(1))
    }
}

/// Stores galpixels, row by row, for a panel; those that are missing are empty.
///
/// *Errors:* a map that cannot be laid out.
pub fn pack(panel: &Description, galpixels: &[Galpixel]) -> Result<Packed, SetupError> {
    if panel.fingerprint == Oled::DESCRIPTION.fingerprint {
        pack_as::<Oled>(galpixels)
    } else if panel.fingerprint == Tft::DESCRIPTION.fingerprint {
        pack_as::<Tft>(galpixels)
    } else {
        pack_as::<Lcd>(galpixels)
    }
}

fn pack_as<P: Panel>(galpixels: &[Galpixel]) -> Result<Packed, SetupError> {
    let height = u32::from(P::HEIGHT);
    let mut starts = vec![0; Grid::rows(height, Margin::NONE)];
    let grid = Grid::new(u32::from(P::WIDTH), height, Margin::NONE, &mut starts)?;
    let mut memory = vec![0; P::MAP_WORDS];
    let mut map = Galpixmap::new(grid, Static::<P>::new(), &mut memory)?;
    let cells = (0..i32::from(P::HEIGHT)).flat_map(|y| (0..i32::from(P::WIDTH)).map(move |x| (x, y)));
    let saturated = cells.zip(galpixels).map(|((x, y), galpixel)| map.store(x, y, galpixel).unwrap_or(0)).sum();
    // Planes of words become words of galpixels.
    let cells = 0..P::CELLS;
    let words = cells.flat_map(|cell| {
        let planes = 0..P::RECORD.words();
        planes.map(move |word| word * P::CELLS + cell)
    });
    let bytes = words.flat_map(|at| memory.get(at).copied().unwrap_or(0).to_le_bytes()).collect();
    Ok(Packed { bytes, saturated })
}
