//! A galpixel with units, for reading and writing single cells. The stored form is in [`crate::format::record`].

use fixed::types::I32F32;

use crate::format::record::{Field, Record, Words};

/// What a cell holds. The discriminants are stored; a galpixel of a smaller class wins a collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Class {
    /// A fully-fledged galpixel.
    Galpixel = 0,
    /// What a fill left in a cell that was unobscured in this frame. It becomes debris in the next frame.
    JustUnobscured = 1,
    /// What a fill made: a bullet, or what was just unobscured in an earlier frame. It loses against any galpixel.
    Debris = 2,
    /// Nothing; the cell's colour is what the display keeps showing there.
    Empty = 3,
}

impl Class {
    /// Returns the class with this discriminant; only the low two bits are used.
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

/// A galpixel with units.
///
/// *Units:* offsets in cells from the cell's centre, `-1/2 .. 1/2`; depth as a fraction of the whole depth range, `0 ..
/// 1`, smaller is nearer; velocity in cells per frame and acceleration in cells per frame² (in depth: fractions of the
/// range instead of cells); luminosity rate in 8-bit code values per frame. Fields that a layout lacks are ignored when
/// a galpixel is stored and 0 when it is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Galpixel {
    /// What the cell holds.
    pub class: Class,
    /// 8-bit red, green and blue.
    pub colour: [u8; 3],
    /// Offset in x and y from the centre of the cell.
    pub offset: [I32F32; 2],
    /// Depth.
    pub depth: I32F32,
    /// Velocity in x, y and depth.
    pub velocity: [I32F32; 3],
    /// Acceleration in x, y and depth.
    pub acceleration: [I32F32; 3],
    /// Rate of the luminosity.
    pub luminosity_rate: I32F32,
    /// The object's tag; only its low bits are stored.
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

/// Returns `value` with `frac` fraction bits, rounded to nearest, halves upwards, and clamped to `low ..= high`; and
/// whether it was clamped.
const fn quantised(value: I32F32, frac: i32, low: i64, high: i64) -> (i32, bool) {
    let shift = 32 - frac;
    let bits = value.to_bits();
    let raw = if shift <= 0 {
        // The field has at least the 32 fraction bits of I32F32: a motion in depth, whose unit is the whole range.
        // Values that would overflow in the shift are outside of the field's range, so that they are clamped first.
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
        // All dropped bits but one are dropped before the half is added, so that the sum cannot overflow.
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

/// Returns the number that `raw` with `frac` fraction bits stands for.
const fn widened(raw: i32, frac: i32) -> I32F32 {
    let shift = 32 - frac;
    if shift >= 0 { I32F32::from_bits((raw as i64) << shift) } else { I32F32::from_bits(raw as i64 >> -shift) }
}

/// Returns the smallest and the largest two's complement number of a field.
const fn signed_range(field: Field) -> (i64, i64) {
    if field.bits == 0 { (0, 0) } else { (-(1 << (field.bits - 1)), (1 << (field.bits - 1)) - 1) }
}

/// Returns the largest unsigned number of a field.
const fn unsigned_top(field: Field) -> i64 {
    (1i64 << field.bits) - 1
}

impl Galpixel {
    /// Returns the fraction bits of the stored velocity and acceleration of `component` in the units of this type.
    const fn fracs(record: &Record, component: usize) -> (i32, i32) {
        let scale = &record.scales[component];
        // In depth the unit is the whole range, 2^depth_int bins.
        let unit = if component == 2 { record.depth().bits as i32 - scale.position_frac as i32 } else { 0 };
        (scale.velocity_frac as i32 + unit, scale.acceleration_frac as i32 + unit)
    }

    /// Returns the fraction bits of the stored luminosity rate in the units of this type.
    const fn luminosity_frac(record: &Record) -> i32 {
        record.luminosity_frac as i32 - (8 - record.colour_format().luminosity_bits() as i32)
    }

    /// Returns the stored words, and how many of the fields velocity, acceleration and luminosity rate were clamped to
    /// their range. Offsets and depth are clamped too, but not counted.
    ///
    /// *Rounding:* to nearest, halves upwards; colours by dropping low bits.
    #[must_use]
    pub(crate) fn stored(&self, record: &Record) -> (Words, u32) {
        let mut words: Words = Default::default();
        let mut saturated = 0;
        record.class().set(&mut words, self.class as u32);
        record.colour().set(&mut words, record.colour_format().from_rgb888(self.colour));
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
            let (raw, clamped) = quantised(self.luminosity_rate, Self::luminosity_frac(record), low, high);
            record.luminosity_rate().set(&mut words, raw as u32);
            saturated += clamped as u32;
        }
        (words, saturated)
    }

    /// Returns the galpixel that these words hold.
    #[must_use]
    pub(crate) fn read(record: &Record, words: &Words) -> Self {
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
            colour: record.colour_format().to_rgb888(colour),
            offset,
            depth: widened(depth as i32, record.depth().bits as i32),
            velocity,
            acceleration,
            luminosity_rate: widened(rate, Self::luminosity_frac(record)),
            tag,
        }
    }
}
