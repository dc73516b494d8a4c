//! One galpixel as a person reads and writes it, with units; its stored form is in [`crate::record`].

use fixed::types::I32F32;

use crate::budget::Bits;
use crate::colour::Colour;
use crate::error::BudgetError;
use crate::layout::{Lanes, Layout};
use crate::record::{Field, Record, Words};

use core::marker::PhantomData;

/// What a cell holds. The numbers are the stored ones; a smaller one wins a collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Class {
    /// A fully-fledged galpixel.
    Galpixel = 0,
    /// Debris of a cell that was uncovered in this very frame. From the next frame on it is debris.
    JustUnobscured = 1,
    /// Something left behind; loses against any galpixel.
    Debris = 2,
    /// Nothing; its colour is what the display still shows there.
    Empty = 3,
}

impl Class {
    /// The class with this stored number; only the low two bits count.
    #[inline(always)]
    #[must_use]
    pub const fn from_bits(bits: u32) -> Self {
        match bits & 3 {
            0 => Self::Galpixel,
            1 => Self::JustUnobscured,
            2 => Self::Debris,
            _ => Self::Empty,
        }
    }
}

/// A named product choice of widths, like a display controller's model.
pub trait Profile {
    /// The widths.
    const BITS: Bits;
}

/// Where a map gets its stored form from: a profile fixed at compile time, or bits chosen at run time.
pub trait Budget<L: Layout>: Copy {
    /// Whether the stored form is known at compile time. Decides how the code is arranged, and no bit of a result.
    const FIXED: bool = false;

    /// The stored form.
    fn record(&self) -> &Record;
}

/// A budget fixed at compile time: no memory, shifts by constants.
#[derive(Debug)]
pub struct Static<P>(PhantomData<P>);

impl<P> Static<P> {
    /// The only value.
    #[must_use]
    pub const fn new() -> Self {
        Self(PhantomData)
    }
}

impl<P> Default for Static<P> {
    fn default() -> Self {
        Self::new()
    }
}

impl<P> Clone for Static<P> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<P> Copy for Static<P> {}

impl<L: Layout, P: Profile> Budget<L> for Static<P> {
    const FIXED: bool = true;

    #[inline(always)]
    fn record(&self) -> &Record {
        const { &<Self as Fixed<L>>::RECORD }
    }
}

/// What is known of a layout under a budget fixed at compile time, to size memory with.
///
/// ```
/// use galpix_core::{budget::{Bits, Demand}, galpixel::{Fixed, Profile, Static}, layout::Full};
/// struct Paper;
/// impl Profile for Paper {
///     const BITS: Bits = Bits::must(Bits::derive(Demand { extent: 1024, recog: 8, prop: 16 }));
/// }
/// const WORDS: usize = 64 * 64 * <Static<Paper> as Fixed<Full>>::BYTES_PER_GALPIXEL / 4;
/// static MAP: [u32; WORDS] = [0; WORDS];
/// assert_eq!(MAP.len(), 64 * 64 * 5);
/// ```
pub trait Fixed<L: Layout>: Budget<L> {
    /// The stored form.
    const RECORD: Record;
    /// Bytes of memory for one galpixel.
    const BYTES_PER_GALPIXEL: usize = Self::RECORD.bytes();
}

impl<L: Layout, P: Profile> Fixed<L> for Static<P> {
    const RECORD: Record = Record::must(Record::plan(P::BITS, L::LANES, L::Colour::BITS));
}

/// A budget chosen at run time, checked against the layout.
#[derive(Debug)]
pub struct Chosen<L> {
    record: Record,
    layout: PhantomData<L>,
}

impl<L: Layout> Chosen<L> {
    /// The stored form of the layout under these bits.
    ///
    /// *Errors:* see [`Record::plan`].
    pub const fn new(bits: Bits) -> Result<Self, BudgetError> {
        match Record::plan(bits, L::LANES, L::Colour::BITS) {
            Ok(record) => Ok(Self { record, layout: PhantomData }),
            Err(error) => Err(error),
        }
    }

    /// The stored form of a part of the layout's lanes: the others are left out of memory, read 0 and ignore what is
    /// written, as if the type lacked them. Every step is the same, bit by bit, as that of a layout with these lanes alone.
    ///
    /// *Errors:* lanes that the layout lacks, a component that [`crate::budget::Component::checked`] refuses, and those of
    /// [`Record::plan`].
    pub const fn with_lanes(bits: Bits, lanes: Lanes) -> Result<Self, BudgetError> {
        if !L::LANES.include(lanes) {
            return Err(BudgetError::NoSuchLane);
        }
        // The code of the lanes that are left out still runs, over zeros: its shifts must be sound.
        match (bits.x.checked(), bits.y.checked(), bits.z.checked()) {
            (Ok(_), Ok(_), Ok(_)) => match Record::plan(bits, lanes, L::Colour::BITS) {
                Ok(record) => Ok(Self { record, layout: PhantomData }),
                Err(error) => Err(error),
            },
            (Err(error), _, _) | (_, Err(error), _) | (_, _, Err(error)) => Err(error),
        }
    }
}

impl<L> Clone for Chosen<L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L> Copy for Chosen<L> {}

impl<L: Layout> Budget<L> for Chosen<L> {
    #[inline(always)]
    fn record(&self) -> &Record {
        &self.record
    }
}

/// One galpixel with units.
///
/// *Units:* offsets in cells from the cell's centre, `-1/2 .. 1/2`; depth as a part of the whole depth range, `0 .. 1`,
/// smaller is nearer; velocity and acceleration in cells a frame and cells a frame² (depth: parts of the range);
/// luminosity rate in 8-bit code values a frame. What a layout lacks is ignored when stored and 0 when read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Galpixel {
    /// What the cell holds.
    pub class: Class,
    /// 8-bit red, green and blue.
    pub colour: [u8; 3],
    /// Place within the cell.
    pub offset: [I32F32; 2],
    /// Depth.
    pub depth: I32F32,
    /// Velocity in x, y and depth.
    pub velocity: [I32F32; 3],
    /// Acceleration in x, y and depth.
    pub acceleration: [I32F32; 3],
    /// Rate of the luminosity.
    pub luminosity_rate: I32F32,
    /// The object's tag; its low bits are kept.
    pub tag: u32,
}

impl Default for Galpixel {
    fn default() -> Self {
        Self {
            class: Class::Galpixel,
            colour: [0; 3],
            offset: [I32F32::ZERO; 2],
            depth: I32F32::ZERO,
            velocity: [I32F32::ZERO; 3],
            acceleration: [I32F32::ZERO; 3],
            luminosity_rate: I32F32::ZERO,
            tag: 0,
        }
    }
}

/// `value` with `frac` fraction bits, to nearest, halves upwards, clamped to `low ..= high`; and whether it was clamped.
const fn quantised(value: I32F32, frac: i32, low: i64, high: i64) -> (i32, bool) {
    let shift = 32 - frac;
    let bits = value.to_bits();
    let raw = if shift <= 0 {
        // A field as fine as I32F32 or finer: motion in depth, whose unit is the whole range. What would overflow is far
        // beyond the field and clamped either way.
        if bits < low {
            low - 1
        } else if bits > high {
            high + 1
        } else {
            bits << -shift
        }
    } else if shift > 62 {
        0
    } else {
        // The half is added after the last bit but one has gone, so that the sum cannot overflow.
        ((bits >> (shift - 1)) + 1) >> 1
    };
    if raw < low {
        (low as i32, true)
    } else if raw > high {
        (high as i32, true)
    } else {
        (raw as i32, false)
    }
}

/// `raw` with `frac` fraction bits as a number.
const fn widened(raw: i32, frac: i32) -> I32F32 {
    let shift = 32 - frac;
    if shift >= 0 { I32F32::from_bits((raw as i64) << shift) } else { I32F32::from_bits(raw as i64 >> -shift) }
}

const fn signed_range(field: Field) -> (i64, i64) {
    if field.bits == 0 { (0, 0) } else { (-(1 << (field.bits - 1)), (1 << (field.bits - 1)) - 1) }
}

const fn unsigned_top(field: Field) -> i64 {
    (1i64 << field.bits) - 1
}

impl Galpixel {
    /// Fraction bits of the stored velocity and acceleration of `component` in this type's units.
    const fn fracs(record: &Record, component: usize) -> (i32, i32) {
        let scale = &record.scales[component];
        // In depth a unit is the whole range, 2^depth_int bins.
        let unit = if component == 2 { record.depth().bits as i32 - scale.position_frac as i32 } else { 0 };
        (scale.velocity_frac as i32 + unit, scale.acceleration_frac as i32 + unit)
    }

    const fn luminosity_frac<C: Colour>(record: &Record) -> i32 {
        record.luminosity_frac as i32 - (8 - C::LUMINOSITY_BITS as i32)
    }

    /// The stored words, and how many fields of velocity and acceleration had to be clamped to their range.
    ///
    /// *Rounding:* to nearest, halves upwards. Offsets and depth are clamped to the cell and to the range uncounted.
    #[must_use]
    pub(crate) fn stored<C: Colour>(&self, record: &Record) -> (Words, u32) {
        let mut words: Words = Default::default();
        let mut saturated = 0;
        record.class().set(&mut words, self.class as u32);
        record.colour().set(&mut words, C::from_rgb888(self.colour));
        record.tag().set(&mut words, self.tag);
        if record.depth().present() {
            let (raw, _) = quantised(self.depth, record.depth().bits as i32, 0, unsigned_top(record.depth()));
            record.depth().set(&mut words, raw as u32);
        }
        for (component, field) in [record.offset_x(), record.offset_y()].into_iter().enumerate() {
            if field.present() {
                let (low, high) = signed_range(field);
                let (raw, _) = quantised(self.offset[component], field.bits as i32, low, high);
                field.set(&mut words, raw as u32);
            }
        }
        for component in 0..3 {
            let (velocity_frac, acceleration_frac) = Self::fracs(record, component);
            for (field, value, frac) in [
                (record.velocity(component), self.velocity[component], velocity_frac),
                (record.acceleration(component), self.acceleration[component], acceleration_frac),
            ] {
                if field.present() {
                    let (low, high) = signed_range(field);
                    let (raw, clamped) = quantised(value, frac, low, high);
                    field.set(&mut words, raw as u32);
                    saturated += clamped as u32;
                }
            }
        }
        if record.luminosity_rate().present() {
            let (low, high) = signed_range(record.luminosity_rate());
            let (raw, clamped) = quantised(self.luminosity_rate, Self::luminosity_frac::<C>(record), low, high);
            record.luminosity_rate().set(&mut words, raw as u32);
            saturated += clamped as u32;
        }
        (words, saturated)
    }

    /// The galpixel that these words hold.
    #[must_use]
    pub(crate) fn read<C: Colour>(record: &Record, words: &Words) -> Self {
        let colour = record.colour().unsigned(words);
        let depth = record.depth().unsigned(words);
        let class = record.class().unsigned(words);
        let tag = record.tag().unsigned(words);
        let rate = record.luminosity_rate().signed(words);
        let offset =
            [record.offset_x(), record.offset_y()].map(|field| widened(field.signed(words), field.bits as i32));
        let velocity = [0, 1, 2]
            .map(|component| widened(record.velocity(component).signed(words), Self::fracs(record, component).0));
        let acceleration = [0, 1, 2]
            .map(|component| widened(record.acceleration(component).signed(words), Self::fracs(record, component).1));
        Self {
            class: Class::from_bits(class),
            colour: C::to_rgb888(colour),
            offset,
            depth: widened(depth as i32, record.depth().bits as i32),
            velocity,
            acceleration,
            luminosity_rate: widened(rate, Self::luminosity_frac::<C>(record)),
            tag,
        }
    }
}
