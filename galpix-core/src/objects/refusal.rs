//! Reasons for which renderings are refused, and their counts.

use core::fmt;

/// Reason for which a rendering was refused. Each message states the remedy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Refusal {
    /// The tag does not fit the layout's tag field.
    Tag {
        /// The tag.
        tag: u32,
        /// Bits of the field.
        bits: u32,
    },
    /// There is no such layer, or it is a stationary-source layer, which is delivered as a whole.
    Layer {
        /// The layer.
        layer: u32,
    },
    /// Part of the rectangle is outside of the map.
    Place {
        /// Its top left corner.
        place: [u32; 2],
        /// Its columns and rows.
        size: [u32; 2],
    },
    /// The rectangle has more cells than one rendering may have.
    Cells {
        /// Cells of the rectangle.
        cells: u32,
        /// The limit.
        most: u32,
    },
    /// The number of words is not that of the rectangle's cells.
    Words {
        /// Words for the rectangle's cells.
        need: usize,
        /// Words given.
        have: usize,
    },
    /// The rendering is later than allowed, when it is submitted or when its turn comes.
    Age {
        /// Frames since the stamp.
        age: u32,
        /// The limit.
        most: u32,
    },
    /// The stamp is a future frame.
    Ahead {
        /// Frames until the stamp.
        frames: u32,
    },
    /// The queue holds as many renderings as it can.
    Queue {
        /// The limit.
        most: usize,
    },
    /// The memory for the galpixels of waiting renderings has too little space left.
    Memory {
        /// Cells of the rectangle.
        cells: u32,
        /// Cells that still fit in.
        left: u32,
    },
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Tag { tag, bits } => write!(
                f,
                "tag {tag} does not fit the layout's {bits} bits: give the object a smaller tag, or choose a layout with more"
            ),
            Self::Layer { layer } => write!(
                f,
                "nothing can be grafted into layer {layer}: name a layer that there is and that is not stationary, 0 is the base"
            ),
            Self::Place { place: [x, y], size: [width, height] } => write!(
                f,
                "the rectangle of {width}x{height} cells at ({x}, {y}) reaches beyond the map: cut it at the map's border"
            ),
            Self::Cells { cells, most } => write!(
                f,
                "a rendering of {cells} cells is more than the {most} that one may have: send a tighter rectangle, or raise the limit"
            ),
            Self::Words { need, have } => {
                write!(f, "the rectangle's cells are {need} words and {have} were given: send one record for each cell")
            }
            Self::Age { age, most } => {
                write!(f, "the rendering is {age} frames old and may be {most}: deliver it sooner, or raise the limit")
            }
            Self::Ahead { frames } => {
                write!(f, "the rendering is for {frames} frames from now: stamp it with a frame that was shown already")
            }
            Self::Queue { most } => {
                write!(f, "{most} renderings wait already and no more can: apply some, or send fewer a frame")
            }
            Self::Memory { cells, left } => write!(
                f,
                "{cells} cells do not fit into the {left} left in the queue's memory: apply some renderings, or provide more memory"
            ),
        }
    }
}

impl core::error::Error for Refusal {}

/// Number of refused renderings for each reason. The counts saturate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Refusals {
    /// [`Refusal::Tag`].
    pub tag: u32,
    /// [`Refusal::Layer`].
    pub layer: u32,
    /// [`Refusal::Place`].
    pub place: u32,
    /// [`Refusal::Cells`].
    pub cells: u32,
    /// [`Refusal::Words`].
    pub words: u32,
    /// [`Refusal::Age`].
    pub age: u32,
    /// [`Refusal::Ahead`].
    pub ahead: u32,
    /// [`Refusal::Queue`].
    pub queue: u32,
    /// [`Refusal::Memory`].
    pub memory: u32,
}

impl Refusals {
    /// Returns the sum of all counts; saturates.
    #[must_use]
    pub fn total(&self) -> u32 {
        let Self { tag, layer, place, cells, words, age, ahead, queue, memory } = *self;
        [tag, layer, place, cells, words, age, ahead, queue, memory].into_iter().fold(0, u32::saturating_add)
    }

    pub(super) fn count(&mut self, refusal: Refusal) {
        let counter = match refusal {
            Refusal::Tag { .. } => &mut self.tag,
            Refusal::Layer { .. } => &mut self.layer,
            Refusal::Place { .. } => &mut self.place,
            Refusal::Cells { .. } => &mut self.cells,
            Refusal::Words { .. } => &mut self.words,
            Refusal::Age { .. } => &mut self.age,
            Refusal::Ahead { .. } => &mut self.ahead,
            Refusal::Queue { .. } => &mut self.queue,
            Refusal::Memory { .. } => &mut self.memory,
        };
        *counter = counter.saturating_add(1);
    }
}
