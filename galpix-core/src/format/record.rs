//! The stored form of a galpixel: which bits of which 32-bit word hold which field.
//!
//! Every field has exactly the width that its budget gives. The fields are packed into as few words as their bits
//! allow: first-fit by decreasing width, ties in canonical order. If first-fit needs one more word, all fields are
//! placed end to end in canonical order instead, and a field may then straddle two words. Within a word the fields are
//! in canonical order from the most significant bit down, so that class and depth in the same word compare as one
//! number.

mod pack;

use pack::pack;

use crate::error::BudgetError;
use crate::format::budget::{Bits, Component, WIDEST_FIELD};
use crate::format::colour::Colour;
use crate::format::layout::Layout;

/// The largest number of words of a galpixel. A power of two.
pub const MAX_WORDS: usize = 8;

/// Fields of a galpixel, in canonical order.
const CLASS: usize = 0;
const DEPTH: usize = 1;
const OFFSET: [usize; 2] = [2, 3];
const VELOCITY: [usize; 3] = [4, 6, 8];
const ACCELERATION: [usize; 3] = [5, 7, 9];
const COLOUR: usize = 10;
const TAG: usize = 11;
const LUMINOSITY_RATE: usize = 12;
const LUMINOSITY: usize = 13;
const FIELDS: usize = 14;

/// The location of a field in a galpixel's words. An absent field has width 0, reads as 0 and ignores writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Field {
    /// Bits of the field.
    pub bits: u8,
    /// The word that holds the upper part of the field, which is the whole field unless it straddles two words.
    pub word: u8,
    /// Position of the lowest bit of the upper part in its word.
    pub shift: u8,
    /// Bits of the field that continue at the top of the next word; 0 unless the field straddles two words.
    pub spill: u8,
}

/// The words of a galpixel. Words that the record does not use are 0.
pub(crate) type Words = [u32; MAX_WORDS];

/// Returns a mask of the low `bits` bits.
const fn low_mask(bits: u32) -> u32 {
    if bits >= 32 { u32::MAX } else { (1 << bits) - 1 }
}

impl Field {
    /// Returns whether the record has this field.
    #[inline(always)]
    #[must_use]
    pub const fn present(self) -> bool {
        self.bits != 0
    }

    /// Returns the bits of the upper part.
    #[inline(always)]
    const fn upper_bits(self) -> u32 {
        (self.bits - self.spill) as u32
    }

    /// Returns the word of the upper part, and the word of the spilled bits; the same word if no bits spill.
    #[inline(always)]
    pub(crate) fn words(self) -> (usize, usize) {
        // The masks keep the indices below `MAX_WORDS`, so that indexing needs no bounds check.
        let word = self.word as usize & (MAX_WORDS - 1);
        (word, (word + (self.spill > 0) as usize) & (MAX_WORDS - 1))
    }

    /// Returns how to extract this field from its words.
    #[inline(always)]
    pub(crate) fn extract(self) -> Extract {
        let upper_bits = if self.bits == 0 { 32 } else { self.upper_bits() };
        Extract {
            left: 32 - upper_bits - self.shift as u32,
            right: 32 - upper_bits,
            spill: self.spill as u32,
            present: if self.bits == 0 { 0 } else { u32::MAX },
        }
    }

    /// Returns the set of words that hold the field, as a bit for each word.
    #[inline(always)]
    pub(crate) fn word_set(self) -> u32 {
        let (upper, lower) = self.words();
        if self.bits == 0 { 0 } else { 1 << upper | 1 << lower }
    }

    /// Returns the mask of the upper part in its word, the position of its lowest bit, and the number of spilled bits.
    #[inline(always)]
    pub(crate) const fn upper_mask(self) -> (u32, u32, u32) {
        (low_mask(self.upper_bits()) << self.shift, self.shift as u32, self.spill as u32)
    }

    /// Returns the position of the field's lowest bit, if the field is at the top of its word and does not spill.
    #[inline(always)]
    pub(crate) const fn at_top(self) -> Option<u32> {
        if self.spill == 0 && self.shift as u32 + self.bits as u32 == 32 { Some(self.shift as u32) } else { None }
    }

    /// Returns the field as an unsigned number.
    #[inline(always)]
    pub(crate) fn unsigned(self, words: &Words) -> u32 {
        let (upper, lower) = self.words();
        self.extract().unsigned(words[upper], words[lower])
    }

    /// Returns the field as a two's complement number.
    #[inline(always)]
    pub(crate) fn signed(self, words: &Words) -> i32 {
        let (upper, lower) = self.words();
        self.extract().signed(words[upper], words[lower])
    }

    /// Replaces the field by the low bits of `value`.
    #[inline(always)]
    pub(crate) fn set(self, words: &mut Words, value: u32) {
        if self.bits == 0 {
            return;
        }
        let (upper, lower) = self.words();
        let mask = low_mask(self.upper_bits()) << self.shift;
        words[upper] = words[upper] & !mask | (value >> self.spill) << self.shift & mask;
        if self.spill != 0 {
            let shift = 32 - self.spill as u32;
            words[lower] = words[lower] & low_mask(shift) | value << shift;
        }
    }
}

/// Shifts and masks that extract a field from the word of its upper part and the word of its spilled bits. Free of
/// branches, so that loops over lanes become vector code.
#[derive(Clone, Copy)]
pub(crate) struct Extract {
    left: u32,
    right: u32,
    spill: u32,
    /// All ones, or 0 for an absent field.
    present: u32,
}

impl Extract {
    /// Returns the field as an unsigned number.
    #[inline(always)]
    pub(crate) fn unsigned(self, upper: u32, lower: u32) -> u32 {
        let spilled = if self.spill == 0 { 0 } else { lower >> (32 - self.spill) };
        (((upper << self.left) >> self.right) << self.spill | spilled) & self.present
    }

    /// Returns the field as a two's complement number.
    #[inline(always)]
    pub(crate) fn signed(self, upper: u32, lower: u32) -> i32 {
        let spilled = if self.spill == 0 { 0 } else { lower >> (32 - self.spill) };
        ((((upper << self.left) as i32) >> self.right) << self.spill | spilled as i32) & self.present as i32
    }
}

/// How what tells surfaces apart is extracted from stored words: the depth, and above it a bit that is set if the cell
/// is empty.
#[derive(Clone, Copy)]
pub(crate) struct Surface {
    /// All bits of a word but the lower one of the class.
    others: u32,
    /// The lower bit of the class.
    lower: Extract,
    depth: Extract,
    depth_bits: u8,
    /// The lower bit of the class, and the depth just below it.
    joined: Option<Extract>,
}

impl Surface {
    /// Returns the surface of a cell, from the words with its class, its depth and the spilled bits of its depth.
    #[inline(always)]
    pub(crate) fn of(self, class: u32, depth: u32, spill: u32) -> u32 {
        // Only the class of an empty cell has both bits set: the lower one is kept if the upper one is set.
        match self.joined {
            Some(joined) => {
                let word = class & (class >> 1 | self.others);
                joined.unsigned(word, word)
            }
            None => self.empty(class) | self.depth.unsigned(depth, spill),
        }
    }

    /// Returns the bit above the depth alone.
    #[inline(always)]
    pub(crate) fn empty(self, class: u32) -> u32 {
        let both = class & class >> 1;
        self.lower.unsigned(both, both) << self.depth_bits
    }
}

/// The shifts that convert velocity and acceleration of a component to the unit of its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Scale {
    /// Fraction bits of the velocity minus those of the acceleration.
    pub acceleration_up: u32,
    /// Bits that are dropped from `2v + a`, after the rounding threshold was added, to reach the position's unit.
    pub down: u32,
    /// Bits that are appended instead if the position is finer than the step. `down` or `up` is 0.
    pub up: u32,
    /// Fraction bits of the position.
    pub position_frac: u32,
    /// Fraction bits of the velocity.
    pub velocity_frac: u32,
    /// Fraction bits of the acceleration.
    pub acceleration_frac: u32,
    /// Bits of the velocity.
    pub velocity_bits: u32,
}

impl Scale {
    /// Makes the scale of a component whose position has `position_frac` fraction bits. In depth these are the bits of
    /// the depth field below a bin, not `component.position_frac`.
    #[must_use]
    pub const fn new(component: Component, position_frac: u32) -> Self {
        let step_frac = component.velocity_frac + 1;
        Self {
            acceleration_up: component.velocity_frac.saturating_sub(component.acceleration_frac),
            down: step_frac.saturating_sub(position_frac),
            up: position_frac.saturating_sub(step_frac),
            position_frac,
            velocity_frac: component.velocity_frac,
            acceleration_frac: component.acceleration_frac,
            velocity_bits: component.velocity_bits(),
        }
    }
}

/// The stored form of a galpixel: the fields of a layout with the widths of a budget, packed into words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Record {
    fields: [Field; FIELDS],
    words: u8,
    bits: u16,
    layout: Layout,
    /// The scales of x, y and depth.
    pub scales: [Scale; 3],
    /// Fraction bits of the luminosity.
    pub luminosity_frac: u32,
}

macro_rules! field_getters {
    ($($(#[$doc:meta])* $name:ident = $index:expr;)*) => {$(
        $(#[$doc])*
        #[inline(always)]
        #[must_use]
        pub const fn $name(&self) -> Field {
            self.fields[$index]
        }
    )*};
}

impl Record {
    /// Packs the fields of a layout with the widths of a budget.
    ///
    /// *Errors:* an acceleration or a depth motion without the fields that it needs, a component that
    /// [`Component::checked`] refuses, a depth field that cannot hold its bins, a field wider than a word, more than
    /// [`MAX_WORDS`] words.
    pub const fn plan(bits: Bits, layout: Layout) -> Result<Self, BudgetError> {
        if (layout.acceleration && !layout.velocity)
            || (layout.depth_motion && (layout.depth_bits == 0 || !layout.velocity))
        {
            return Err(BudgetError::FieldWithoutItsBase);
        }
        if let Err(error) = check_components(bits, layout) {
            return Err(error);
        }
        let depth_bits = layout.depth_bits + if layout.depth_motion { bits.z.position_frac } else { 0 };
        if layout.depth_motion && depth_bits < bits.depth_int {
            return Err(BudgetError::DepthTooCoarse { bits: depth_bits, needed: bits.depth_int });
        }
        if depth_bits > 28 {
            return Err(BudgetError::FieldTooWide { bits: depth_bits, most: 28 });
        }
        let z_frac = depth_bits.saturating_sub(bits.depth_int);
        let scales = [
            Scale::new(bits.x, bits.x.position_frac),
            Scale::new(bits.y, bits.y.position_frac),
            Scale::new(bits.z, z_frac),
        ];
        if layout.depth_motion {
            let widest = bits.z.velocity_bits() + scales[2].up;
            let widest = if bits.z.acceleration_bits() + scales[2].acceleration_up + scales[2].up > widest {
                bits.z.acceleration_bits() + scales[2].acceleration_up + scales[2].up
            } else {
                widest
            };
            if widest > WIDEST_FIELD {
                return Err(BudgetError::FieldTooWide { bits: widest, most: WIDEST_FIELD });
            }
            if let Err(error) = bits.z.dropped_bits_checked(z_frac) {
                return Err(error);
            }
        }
        if layout.acceleration
            && !(bits.x.has_acceleration()
                && bits.y.has_acceleration()
                && (!layout.depth_motion || bits.z.has_acceleration()))
        {
            return Err(BudgetError::AccelerationVanishes { integer_bits: 0 });
        }

        let mut widths = [0u32; FIELDS];
        widths[CLASS] = 2;
        widths[DEPTH] = depth_bits;
        widths[COLOUR] = layout.colour.bits();
        widths[TAG] = layout.tag_bits;
        if layout.velocity {
            let components = [bits.x, bits.y, bits.z];
            let mut i = 0;
            while i < if layout.depth_motion { 3 } else { 2 } {
                widths[VELOCITY[i]] = components[i].velocity_bits();
                if layout.acceleration {
                    widths[ACCELERATION[i]] = components[i].acceleration_bits();
                }
                if i < 2 {
                    widths[OFFSET[i]] = components[i].position_frac;
                }
                i += 1;
            }
        }
        if layout.luminosity {
            widths[LUMINOSITY_RATE] = bits.luminosity_int + bits.luminosity_frac;
            widths[LUMINOSITY] = bits.luminosity_frac;
        }
        match pack(widths) {
            Ok((fields, words, total)) => {
                Ok(Self { fields, words, bits: total, layout, scales, luminosity_frac: bits.luminosity_frac })
            }
            Err(error) => Err(error),
        }
    }

    /// Returns the record, for constants; an error becomes a compile error that states the reason.
    ///
    /// *Panics* on an error if called at run time.
    #[must_use]
    pub const fn must(record: Result<Self, BudgetError>) -> Self {
        match record {
            Ok(record) => record,
            Err(BudgetError::DepthTooCoarse { .. }) => {
                panic!("layout: the depth field cannot hold its bins: use more depth bits")
            }
            Err(BudgetError::RecordTooLong { .. }) => {
                panic!("layout: a galpixel of more than 256 bits: leave fields out")
            }
            Err(BudgetError::FieldWithoutItsBase) => {
                panic!("layout: acceleration needs velocity, depth motion needs depth")
            }
            Err(_) => panic!("layout: this budget does not fit these fields"),
        }
    }

    /// Returns the words of a stored galpixel.
    #[inline(always)]
    #[must_use]
    pub const fn words(&self) -> usize {
        self.words as usize
    }

    /// Returns the bytes of a stored galpixel.
    #[must_use]
    pub const fn bytes(&self) -> usize {
        self.words as usize * 4
    }

    /// Returns the bits of a stored galpixel that are in use.
    #[must_use]
    pub const fn bits(&self) -> u32 {
        self.bits as u32
    }

    /// Returns the layout, which says which fields there are.
    #[inline(always)]
    #[must_use]
    pub const fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Returns the colour format.
    #[inline(always)]
    #[must_use]
    pub const fn colour_format(&self) -> &Colour {
        &self.layout.colour
    }

    field_getters! {
        /// Returns the field of the class, see [`crate::Class`].
        class = CLASS;
        /// Returns the field of the depth with its fraction, unsigned. Smaller is nearer.
        depth = DEPTH;
        /// Returns the field of the offset along the row from the cell's centre.
        offset_x = OFFSET[0];
        /// Returns the field of the offset along the column from the cell's centre.
        offset_y = OFFSET[1];
        /// Returns the field of the colour word.
        colour = COLOUR;
        /// Returns the field of the object's tag.
        tag = TAG;
        /// Returns the field of the luminosity rate, in steps of luminosity per frame.
        luminosity_rate = LUMINOSITY_RATE;
        /// Returns the field of the fraction of the luminosity.
        luminosity = LUMINOSITY;
    }

    /// Returns the field of the offset in x (0) or y (1) from the cell's centre.
    #[inline(always)]
    pub(crate) const fn offset(&self, component: usize) -> Field {
        self.fields[OFFSET[component]]
    }

    /// Returns class and depth as a single field, if they are adjacent in one word.
    #[inline(always)]
    pub(crate) const fn key_field(&self) -> Option<Field> {
        let (class, depth) = (self.class(), self.depth());
        if class.word == depth.word && class.shift == depth.shift + depth.bits && depth.spill == 0 && depth.bits != 0 {
            Some(Field { bits: class.bits + depth.bits, ..depth })
        } else {
            None
        }
    }

    /// Returns the lower bit of the class.
    #[inline(always)]
    pub(crate) const fn lower_class(&self) -> Field {
        Field { bits: 1, ..self.class() }
    }

    /// Returns how to extract what tells surfaces apart. `fixed` says whether the record is known at compile time: then
    /// fields that are adjacent are extracted at once.
    #[inline(always)]
    pub(crate) fn surface(&self, fixed: bool) -> Surface {
        let (class, depth) = (self.class(), self.depth());
        let joined = self.key_field().filter(|_| fixed);
        Surface {
            others: !(1 << class.shift),
            lower: self.lower_class().extract(),
            depth: depth.extract(),
            depth_bits: depth.bits,
            joined: joined.map(|key| Field { bits: key.bits - 1, ..key }.extract()),
        }
    }

    /// Returns the field of the velocity in x (0), y (1) or depth (2).
    #[inline(always)]
    #[must_use]
    pub const fn velocity(&self, component: usize) -> Field {
        self.fields[VELOCITY[component]]
    }

    /// Returns the field of the acceleration in x (0), y (1) or depth (2).
    #[inline(always)]
    #[must_use]
    pub const fn acceleration(&self, component: usize) -> Field {
        self.fields[ACCELERATION[component]]
    }
}

/// Checks the widths of the fields that a layout has, because the fields of [`Bits`] are public.
const fn check_components(bits: Bits, layout: Layout) -> Result<(), BudgetError> {
    let components = [bits.x, bits.y, bits.z];
    let used = match (layout.velocity, layout.depth_motion) {
        (_, true) => 3,
        (true, false) => 2,
        (false, false) => 0,
    };
    let mut i = 0;
    while i < used {
        if let Err(error) = components[i].checked() {
            return Err(error);
        }
        i += 1;
    }
    let luminosity = bits.luminosity_int.saturating_add(bits.luminosity_frac);
    if layout.luminosity && luminosity > WIDEST_FIELD {
        return Err(BudgetError::FieldTooWide { bits: luminosity, most: WIDEST_FIELD });
    }
    Ok(())
}

#[cfg(test)]
mod tests;
