//! The levels of a pyramid in lent memory, what is known of a cell apart from its value: values may be long, and most are not
//! looked at.

use super::levels::Levels;
use super::pyramid::{DEPTH_BITS, Known, State};
use super::validity::FULL;
use crate::error::SetupError;

/// How a cell stands: its state, validity and depth, from the highest bit.
#[derive(Clone, Copy, Debug, Default)]
pub struct Standing(u32);

const VALIDITY_BITS: u32 = 5;
const STATE_SHIFT: u32 = DEPTH_BITS + VALIDITY_BITS;
const _: () = assert!(STATE_SHIFT + 2 == 32 && FULL < 1 << VALIDITY_BITS);

impl Standing {
    #[inline(always)]
    const fn new(state: State, validity: u32, depth: u32) -> Self {
        Self((state as u32) << STATE_SHIFT | validity << DEPTH_BITS | depth)
    }

    /// 0 to [`FULL`].
    #[inline(always)]
    #[must_use]
    pub const fn validity(self) -> u32 {
        self.0 >> DEPTH_BITS & ((1 << VALIDITY_BITS) - 1)
    }

    /// Of the cell.
    #[inline(always)]
    #[must_use]
    pub const fn depth(self) -> u32 {
        self.0 & ((1 << DEPTH_BITS) - 1)
    }
}

/// The levels above a picture.
#[derive(Debug)]
pub struct Store<'s, V> {
    levels: Levels,
    standings: &'s mut [Standing],
    values: &'s mut [V],
}

impl<'s, V: Copy + Default> Store<'s, V> {
    /// The levels from 1 on of a picture of `width` x `height` cells, nothing of which has been worked out.
    ///
    /// *Errors:* a side of 0 or over 32768, memory shorter than [`super::levels::cells`].
    pub fn new(
        width: u32,
        height: u32,
        standings: &'s mut [Standing],
        values: &'s mut [V],
    ) -> Result<Self, SetupError> {
        if width == 0 || height == 0 || width > 1 << 15 || height > 1 << 15 {
            return Err(SetupError::Size { width, height });
        }
        let levels = Levels::new(width, height);
        let (need, have) = (levels.cells(), standings.len().min(values.len()));
        let (Some(standings), Some(values)) = (standings.get_mut(..need), values.get_mut(..need)) else {
            return Err(SetupError::TooShort { plane: "pyramid", need, have });
        };
        standings.fill(Standing::default());
        Ok(Self { levels, standings, values })
    }

    /// The sizes of its levels.
    #[inline(always)]
    #[must_use]
    pub const fn levels(&self) -> &Levels {
        &self.levels
    }

    /// The index of a cell of a level from 1 on; beyond the memory for a place that the level does not have.
    #[inline(always)]
    #[must_use]
    pub fn index(&self, level: u32, x: u32, y: u32) -> usize {
        let level = self.levels.level(level);
        if x < level.width && y < level.height { (level.start + y * level.width + x) as usize } else { usize::MAX }
    }

    /// How far a cell has been worked out; a place that there is not is completed.
    #[inline(always)]
    #[must_use]
    pub fn state(&self, index: usize) -> State {
        match self.standings.get(index).map(|standing| standing.0 >> STATE_SHIFT) {
            Some(0) => State::Untouched,
            Some(1) => State::Pulled,
            _ => State::Completed,
        }
    }

    /// How a cell stands; without validity and depth for a place that there is not.
    #[inline(always)]
    #[must_use]
    pub fn standing(&self, index: usize) -> Standing {
        self.standings.get(index).copied().unwrap_or_default()
    }

    /// The value of a cell.
    #[inline(always)]
    #[must_use]
    pub fn value(&self, index: usize) -> Option<&V> {
        self.values.get(index)
    }

    /// What is known of a cell; nothing of a place that there is not.
    #[inline(always)]
    #[must_use]
    pub fn known(&self, index: usize) -> Known<V> {
        let standing = self.standing(index);
        let value = self.value(index).copied().unwrap_or_default();
        Known { validity: standing.validity(), depth: standing.depth(), value }
    }

    #[inline(always)]
    pub(super) fn set(&mut self, index: usize, state: State, known: &Known<V>) {
        if let (Some(standing), Some(value)) = (self.standings.get_mut(index), self.values.get_mut(index)) {
            *standing = Standing::new(state, known.validity, known.depth);
            *value = known.value;
        }
    }
}
