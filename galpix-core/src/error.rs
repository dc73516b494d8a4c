//! The errors of setup functions. After setup nothing fails: irregularities are counted in a tally.

use core::fmt;

/// Why a bit budget or a record cannot exist. Each message says how to correct it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum BudgetError {
    /// The extent, the recognition time or the propagation time is zero.
    Zero,
    /// `tau_prop` is 1: nothing is extrapolated.
    PropagationTooShort,
    /// Equation (8) leaves no integer bit for the velocity.
    VelocityVanishes {
        /// Integer bits that the equation gives.
        integer_bits: i32,
    },
    /// Equation (9) leaves no integer bit for the acceleration.
    AccelerationVanishes {
        /// Integer bits that the equation gives.
        integer_bits: i32,
    },
    /// A field would be wider than the arithmetic allows.
    FieldTooWide {
        /// Bits requested.
        bits: u32,
        /// Largest possible number of bits.
        most: u32,
    },
    /// More bits were shaved off than there are.
    ShavedAway,
    /// The velocity has fewer fraction bits than the acceleration, so that their sum would lose bits.
    VelocityCoarserThanAcceleration {
        /// Fraction bits of the velocity.
        velocity: u32,
        /// Fraction bits of the acceleration.
        acceleration: u32,
    },
    /// The depth field has fewer bits than are needed to number the depth bins of the display.
    DepthTooCoarse {
        /// Bits of the depth field.
        bits: u32,
        /// Base-2 logarithm of the number of bins.
        needed: u32,
    },
    /// A galpixel would need more than [`crate::record::MAX_WORDS`] words.
    RecordTooLong {
        /// Bits of a galpixel.
        bits: u32,
        /// Largest possible number of bits.
        most: u32,
    },
    /// The layout has an acceleration but no velocity, or a depth motion but no depth or no velocity.
    FieldWithoutItsBase,
    /// A colour channel has no bit, or more than 8.
    ChannelBits {
        /// Bits requested.
        bits: u32,
    },
}

impl fmt::Display for BudgetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Zero => {
                f.write_str("extent, recog and prop must all be at least 1: give each of them a positive number")
            }
            Self::PropagationTooShort => {
                f.write_str("prop = 1 extrapolates nothing: give a propagation time of 2 frames or more")
            }
            Self::VelocityVanishes { integer_bits } => write!(
                f,
                "equation (8) gives {integer_bits} integer bits for the velocity: raise the extent or lower recog"
            ),
            Self::AccelerationVanishes { integer_bits } => write!(
                f,
                "equation (9) gives {integer_bits} integer bits for the acceleration: raise the extent, lower recog, \
                 or choose a layout without acceleration"
            ),
            Self::FieldTooWide { bits, most } => write!(
                f,
                "a field of {bits} bits is more than the {most} that one word's arithmetic holds: lower the extent or \
                 prop, raise recog, or shave bits off"
            ),
            Self::ShavedAway => f.write_str("more bits are shaved off than the field has: shave fewer"),
            Self::VelocityCoarserThanAcceleration { velocity, acceleration } => write!(
                f,
                "the velocity has {velocity} fraction bits and the acceleration {acceleration}: shave the acceleration \
                 at least as much as the velocity"
            ),
            Self::DepthTooCoarse { bits, needed } => write!(
                f,
                "a depth field of {bits} bits cannot hold 2^{needed} depth bins: use more depth bits or a smaller \
                 extent in z"
            ),
            Self::RecordTooLong { bits, most } => write!(
                f,
                "a galpixel of {bits} bits is more than the {most} that the engine carries: leave fields out or shave \
                 bits off"
            ),
            Self::FieldWithoutItsBase => f.write_str(
                "acceleration needs velocity, and depth motion needs depth and velocity: add what is missing",
            ),
            Self::ChannelBits { bits } => write!(f, "a colour channel of {bits} bits cannot be stored: give it 1 to 8"),
        }
    }
}

impl core::error::Error for BudgetError {}

/// Why a map or its companions cannot be set up. Each message says how to correct it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SetupError {
    /// A caller-provided buffer is too short.
    TooShort {
        /// What the buffer is for.
        plane: &'static str,
        /// Words needed.
        need: usize,
        /// Words provided.
        have: usize,
    },
    /// The map, margin included, has no cell or more cells than can be addressed.
    Size {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The layers of stationary sources have more samples than there are numbers for.
    TooManySamples {
        /// Samples of all layers, a cell each.
        samples: u64,
        /// Largest possible number.
        most: u32,
    },
    /// A layer of stationary sources has more columns than the map of the display.
    LayerTooWide {
        /// Columns of the layer.
        width: u32,
        /// Columns of the display's map, margin included.
        most: u32,
    },
    /// Two maps that work together have different grids.
    GridsDiffer,
    /// The operation identifies objects by their tags, and the layout has no tag.
    NoTag,
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::TooShort { plane, need, have } => {
                write!(f, "the {plane} needs {need} words and {have} were provided: provide a longer slice")
            }
            Self::Size { width, height } => write!(
                f,
                "a map of {width}x{height} cells cannot be made: both sides must be 1 to 32768, margin included, and \
                 the cells at most 2^28"
            ),
            Self::TooManySamples { samples, most } => write!(
                f,
                "{samples} samples of all layers are more than the {most} that can be numbered: use a smaller map, or \
                 fewer layers"
            ),
            Self::LayerTooWide { width, most } => write!(
                f,
                "a layer of {width} columns is wider than the map of the display, which has {most}: store only columns \
                 that can be seen"
            ),
            Self::GridsDiffer => f.write_str("the two maps have different grids: make both over the same one"),
            Self::NoTag => f.write_str(
                "the layout has no tag, so that objects cannot be told apart: choose one with tag bits, as \
                 `Layout::TAGGED`",
            ),
        }
    }
}

impl core::error::Error for SetupError {}
