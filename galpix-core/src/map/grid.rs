//! The size of a map, its margin, and the first cell of each row.
//!
//! Propagation needs the first cell of arbitrary rows. A table in a caller-provided buffer holds them, so that one load
//! says whether a row exists and where it begins, without a multiplication. The table is filled by additions.

use crate::error::SetupError;

/// The overscan margin: columns and rows of a map beyond the display.
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

    /// Returns a margin with the same number of cells on all four sides.
    #[must_use]
    pub const fn all(cells: u32) -> Self {
        Self { left: cells, right: cells, top: cells, bottom: cells }
    }
}

/// The grid of cells of a map. Maps that work together have equal grids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid<'r> {
    width: u32,
    height: u32,
    cells: u32,
    margin: Margin,
    starts: &'r [u32],
}

impl<'r> Grid<'r> {
    /// Returns the rows of a map for a display of `height` rows: the words of the buffer for [`Grid::new`].
    #[must_use]
    pub const fn rows(height: u32, margin: Margin) -> usize {
        height.saturating_add(margin.top).saturating_add(margin.bottom) as usize
    }

    /// Returns the cells of a map for a display of `width` x `height` cells, margin included; 0 if such a map cannot
    /// exist.
    #[must_use]
    pub const fn cells_for(width: u32, height: u32, margin: Margin) -> u32 {
        let columns = width.saturating_add(margin.left).saturating_add(margin.right);
        let rows = height.saturating_add(margin.top).saturating_add(margin.bottom);
        if width == 0 || height == 0 || columns > 1 << 15 || rows > 1 << 15 || columns as u64 * rows as u64 > 1 << 28 {
            return 0;
        }
        columns * rows
    }

    /// Makes the grid for a display of `width` x `height` cells, and writes the table of row starts into `starts`.
    ///
    /// *Errors:* a side of 0, a side of more than 2^15 or more than 2^28 cells (margin included), or a buffer shorter
    /// than [`Self::rows`].
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

    /// Makes a grid whose rows `y` and `y + rows` occupy the same cells, for maps of which only `rows` successive rows
    /// are needed at a time. Writes the table of row starts, one for each row of the grid `of`, into `starts`.
    ///
    /// *Errors:* no rows, or a buffer shorter than the height of `of`.
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

    /// Returns the columns, margin included.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.width
    }

    /// Returns the rows, margin included.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.height
    }

    /// Returns the cells, margin included.
    #[must_use]
    pub const fn cells(&self) -> u32 {
        self.cells
    }

    /// Returns the margin.
    #[must_use]
    pub const fn margin(&self) -> Margin {
        self.margin
    }

    /// Returns the columns of the display.
    #[must_use]
    pub const fn display_width(&self) -> u32 {
        self.width - self.margin.left - self.margin.right
    }

    /// Returns the rows of the display.
    #[must_use]
    pub const fn display_height(&self) -> u32 {
        self.height - self.margin.top - self.margin.bottom
    }

    /// Returns the first cell of row `y`, if there is such a row. Row 0 is the topmost row of the margin.
    #[inline(always)]
    #[must_use]
    pub fn row(&self, y: i32) -> Option<u32> {
        self.starts.get(y as u32 as usize).copied()
    }

    /// Returns the cell in column `x` of row `y`, if there is one. Both count from the top left corner of the margin.
    #[inline(always)]
    #[must_use]
    pub fn cell(&self, x: i32, y: i32) -> Option<u32> {
        if (x as u32) < self.width { Some(self.row(y)? + x as u32) } else { None }
    }

    /// Returns the row of a cell, and the first cell of that row. Of a cell beyond the last one those of the last row.
    ///
    /// *Cost:* a search in the table, in as many steps as the number of rows has bits; nothing divides.
    #[inline]
    pub(crate) fn row_of(&self, cell: u32) -> (u32, u32) {
        let row = self.starts.partition_point(|&start| start <= cell).saturating_sub(1);
        (row as u32, self.starts.get(row).copied().unwrap_or_default())
    }

    /// Returns the first cells of all rows, from the top.
    pub(crate) fn starts(&self) -> &'r [u32] {
        self.starts
    }
}
