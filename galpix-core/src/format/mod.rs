//! Formats: how galpixels are stored. A budget gives the widths of the fields, a layout selects the fields, and a
//! record packs them into words.

pub mod budget;
pub mod colour;
pub mod layout;
pub mod record;
pub mod rounding;

use core::marker::PhantomData;

use crate::error::BudgetError;
use crate::fast::Passes;
use budget::Bits;
use layout::Layout;
use record::Record;

/// A format chosen at compile time: which fields there are, and how wide they are. See [`Static`].
pub trait Profile {
    /// The fields.
    const LAYOUT: Layout;
    /// The widths.
    const BITS: Bits;
}

/// The stored form of a map's galpixels: fixed at compile time ([`Static`]) or chosen at run time ([`Dynamic`]). Both
/// give the same results, bit by bit.
pub trait Format: Copy + Passes {
    /// Whether the stored form is known at compile time. Selects between forms of the code; results do not depend on
    /// it.
    const FIXED: bool;

    /// Returns the stored form.
    fn record(&self) -> &Record;
}

/// A format fixed at compile time. It occupies no memory, and the code shifts by constants.
///
/// ```
/// use galpix_core::{Bits, Demand, Layout, Profile, Static};
/// struct Paper;
/// impl Profile for Paper {
///     const LAYOUT: Layout = Layout::FULL;
///     const BITS: Bits = Bits::must(Bits::derive(Demand { extent: 1024, recog: 8, prop: 16 }));
/// }
/// const WORDS: usize = 64 * 64 * Static::<Paper>::RECORD.words();
/// static MAP: [u32; WORDS] = [0; WORDS];
/// assert_eq!(MAP.len(), 64 * 64 * 5);
/// ```
#[derive(Debug)]
pub struct Static<P>(PhantomData<P>);

impl<P> Static<P> {
    /// Returns the only value of the type.
    #[must_use]
    pub const fn new() -> Self {
        Self(PhantomData)
    }
}

impl<P: Profile> Static<P> {
    /// The stored form. A profile that cannot be stored is a compile error.
    pub const RECORD: Record = Record::must(Record::plan(P::BITS, P::LAYOUT));
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

impl<P: Profile> Format for Static<P> {
    const FIXED: bool = true;

    #[inline(always)]
    fn record(&self) -> &Record {
        const { &Self::RECORD }
    }
}

/// A format chosen at run time. The passes over its maps are compiled once, in this crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dynamic {
    record: Record,
}

impl Dynamic {
    /// Makes the format of a layout under a budget.
    ///
    /// *Errors:* those of [`Record::plan`].
    pub const fn new(bits: Bits, layout: Layout) -> Result<Self, BudgetError> {
        match Record::plan(bits, layout) {
            Ok(record) => Ok(Self { record }),
            Err(error) => Err(error),
        }
    }
}

impl Format for Dynamic {
    const FIXED: bool = false;

    #[inline(always)]
    fn record(&self) -> &Record {
        &self.record
    }
}
