//! The sizes of a pyramid's levels.
//!
//! Level 0 is the picture. Each level has half the columns and rows of the one below, rounded up, down to a single
//! cell: so any size has a pyramid. The levels from 1 on follow each other in one piece of memory.

use crate::error::SetupError;

/// The most levels above a picture: sides are at most 2^15.
pub const MOST: usize = 15;

/// One level: its size, and where it begins in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Level {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Its first cell, counted from the first one of level 1; 0 for level 0, which lies elsewhere.
    pub start: u32,
}

/// The levels of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Levels {
    levels: [Level; MOST + 1],
    top: u32,
    cells: u32,
}

impl Levels {
    /// Returns the levels of a picture of `width` x `height` cells, each 1 to 32768.
    #[must_use]
    pub const fn new(width: u32, height: u32) -> Self {
        let mut levels = [Level { width: 0, height: 0, start: 0 }; MOST + 1];
        levels[0] = Level { width, height, start: 0 };
        let (mut level, mut start, mut size) = (0, 0, (width, height));
        while level < MOST && (size.0 > 1 || size.1 > 1) {
            size = (size.0.div_ceil(2), size.1.div_ceil(2));
            level += 1;
            levels[level] = Level { width: size.0, height: size.1, start };
            start += size.0 * size.1;
        }
        Self { levels, top: level as u32, cells: start }
    }

    /// Returns the levels of a picture of any size.
    ///
    /// *Errors:* a side of 0 or over 32768.
    pub const fn checked(width: u32, height: u32) -> Result<Self, SetupError> {
        if width == 0 || height == 0 || width > 1 << MOST || height > 1 << MOST {
            return Err(SetupError::Size { width, height });
        }
        Ok(Self::new(width, height))
    }

    /// Returns the number of the topmost level.
    #[must_use]
    pub const fn top(&self) -> u32 {
        self.top
    }

    /// Returns how many cells the levels from 1 on have.
    #[must_use]
    pub const fn cells(&self) -> usize {
        self.cells as usize
    }

    /// Returns a level; of those above the topmost one, one without cells.
    #[inline(always)]
    #[must_use]
    pub fn level(&self, level: u32) -> Level {
        self.levels.get(level as usize).copied().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_is_half_the_one_below_and_the_last_a_single_cell() {
        for (width, height) in [(1, 1), (1, 2), (7, 1), (64, 64), (65, 33), (320, 240), (32768, 32768), (3, 32768)] {
            let levels = Levels::new(width, height);
            let mut start = 0;
            for number in 1..=levels.top() {
                let (below, level) = (levels.level(number - 1), levels.level(number));
                assert_eq!((level.width, level.height), (below.width.div_ceil(2), below.height.div_ceil(2)));
                assert_eq!(level.start, start);
                start += level.width * level.height;
            }
            let top = levels.level(levels.top());
            assert_eq!((top.width, top.height), (1, 1));
            assert_eq!(levels.cells(), start as usize);
            assert!((levels.top() + 1..20).all(|beyond| levels.level(beyond) == Level::default()));
        }
        assert_eq!(Levels::new(1, 1).cells(), 0);
        assert_eq!(Levels::new(128, 64).cells(), 2048 + 512 + 128 + 32 + 8 + 2 + 1);
    }
}
