//! Where cells are: the size of a map, its margin, and the first cell of each row.
//!
//! A scatter needs the start of an arbitrary row. The starts are a table, lent by the caller and filled by additions: one
//! load answers at once whether a row exists and where it begins, and no pass multiplies.

use crate::error::SetupError;

/// Columns and rows of a map beyond the display, "in the margin".
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Margin {
    /// Columns left of the display.
    pub left: u32,
    /// Columns right of the display.
    pub right: u32,
    /// Rows above the display.
    pub top: u32,
    /// Rows below the display.
    pub bottom: u32,
}

impl Margin {
    /// No margin: the map is the display.
    pub const NONE: Self = Self { left: 0, right: 0, top: 0, bottom: 0 };

    /// The same margin on all four sides.
    #[must_use]
    pub const fn all(cells: u32) -> Self {
        Self { left: cells, right: cells, top: cells, bottom: cells }
    }
}

/// The grid of cells that two maps share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid<'r> {
    width: u32,
    height: u32,
    cells: u32,
    margin: Margin,
    starts: &'r [u32],
}

impl<'r> Grid<'r> {
    /// Rows of a map for a display of `height` rows: the words that [`Grid::new`] must be lent.
    #[must_use]
    pub const fn rows(height: u32, margin: Margin) -> usize {
        height.saturating_add(margin.top).saturating_add(margin.bottom) as usize
    }

    /// Cells of a map for a display of `width` x `height`, margin included; 0 if such a map cannot exist.
    #[must_use]
    pub const fn cells_for(width: u32, height: u32, margin: Margin) -> u32 {
        let columns = width.saturating_add(margin.left).saturating_add(margin.right);
        let rows = height.saturating_add(margin.top).saturating_add(margin.bottom);
        if width == 0 || height == 0 || columns > 1 << 15 || rows > 1 << 15 || columns as u64 * rows as u64 > 1 << 28 {
            return 0;
        }
        columns * rows
    }

    /// A grid for a display of `width` x `height` cells; the table of row starts is written into `starts`.
    ///
    /// *Errors:* a side of 0, a side over 2^15 or more than 2^28 cells (margin included), or a table that is too short.
    pub fn new(width: u32, height: u32, margin: Margin, starts: &'r mut [u32]) -> Result<Self, SetupError> {
        let cells = Self::cells_for(width, height, margin);
        if cells == 0 {
            return Err(SetupError::Size { width, height });
        }
        let (width, rows) = (width + margin.left + margin.right, Self::rows(height, margin));
        let have = starts.len();
        let Some(starts) = starts.get_mut(..rows) else {
            return Err(SetupError::TooShort { plane: "table of row starts", need: rows, have });
        };
        let mut start = 0;
        for row in starts.iter_mut() {
            *row = start;
            start += width;
        }
        Ok(Self { width, height: rows as u32, cells, margin, starts })
    }

    /// The same rows over fewer cells: row `y` lies where row `y + rows` does, for maps of which only some rows are needed at
    /// a time. The table of row starts is written into `starts`.
    ///
    /// *Errors:* no rows, or a table that is too short.
    pub fn window(of: &Grid<'_>, rows: u32, starts: &'r mut [u32]) -> Result<Self, SetupError> {
        if rows == 0 {
            return Err(SetupError::Size { width: of.width, height: rows });
        }
        let (need, have) = (of.height as usize, starts.len());
        let Some(starts) = starts.get_mut(..need) else {
            return Err(SetupError::TooShort { plane: "table of row starts", need, have });
        };
        let cells = match of.starts.get(rows as usize) {
            Some(&start) => start,
            None => of.cells,
        };
        let mut start = 0;
        for row in starts.iter_mut() {
            *row = start;
            start += of.width;
            if start == cells {
                start = 0;
            }
        }
        Ok(Self { cells, starts, ..*of })
    }

    /// Columns, margin included.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.width
    }

    /// Rows, margin included.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.height
    }

    /// Cells, margin included.
    #[must_use]
    pub const fn cells(&self) -> u32 {
        self.cells
    }

    /// What lies outside of the display.
    #[must_use]
    pub const fn margin(&self) -> Margin {
        self.margin
    }

    /// Columns of the display.
    #[must_use]
    pub const fn display_width(&self) -> u32 {
        self.width - self.margin.left - self.margin.right
    }

    /// Rows of the display.
    #[must_use]
    pub const fn display_height(&self) -> u32 {
        self.height - self.margin.top - self.margin.bottom
    }

    /// The first cell of row `y`, if there is such a row. `y` counts from the topmost row of the margin.
    #[inline(always)]
    #[must_use]
    pub fn row(&self, y: i32) -> Option<u32> {
        self.starts.get(y as u32 as usize).copied()
    }

    /// The cell in column `x` of row `y`, if there is one. Both count from the corner of the margin.
    #[inline(always)]
    #[must_use]
    pub fn cell(&self, x: i32, y: i32) -> Option<u32> {
        if (x as u32) < self.width { Some(self.row(y)? + x as u32) } else { None }
    }

    /// The starts of all rows, from the top.
    pub(crate) fn starts(&self) -> &'r [u32] {
        self.starts
    }
}
