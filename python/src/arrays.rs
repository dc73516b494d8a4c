//! Arrays of numpy as slices.
//!
//! The package has already checked shapes, dtypes and that rows follow each other, so that nothing is copied here; what
//! is wrong all the same is a `ValueError`.

use numpy::{Element, PyReadonlyArray1, PyReadonlyArrayDyn};
use pyo3::prelude::*;

use crate::names::value_error;

/// Numbers of either width.
#[derive(FromPyObject)]
pub enum Floats<'py> {
    /// float32.
    Single(PyReadonlyArray1<'py, f32>),
    /// float64.
    Double(PyReadonlyArray1<'py, f64>),
}

/// Numbers of either width as a slice, which is independent of the interpreter.
#[derive(Clone, Copy)]
pub enum Numbers<'a> {
    /// float32.
    Single(&'a [f32]),
    /// float64.
    Double(&'a [f64]),
}

impl Floats<'_> {
    /// Returns the numbers.
    ///
    /// *Errors:* `ValueError` if they are not next to each other, or not `count` of them.
    pub fn numbers(&self, count: usize) -> PyResult<Numbers<'_>> {
        let numbers = match self {
            Self::Single(array) => Numbers::Single(array.as_slice()?),
            Self::Double(array) => Numbers::Double(array.as_slice()?),
        };
        let have = match numbers {
            Numbers::Single(slice) => slice.len(),
            Numbers::Double(slice) => slice.len(),
        };
        if have == count { Ok(numbers) } else { Err(value_error(format!("{have} numbers where {count} are needed"))) }
    }
}

impl Numbers<'_> {
    /// Returns a number.
    #[inline(always)]
    pub fn at(&self, index: usize) -> f64 {
        match self {
            Self::Single(slice) => f64::from(slice[index]),
            Self::Double(slice) => slice[index],
        }
    }
}

/// Returns the numbers of an array that may be absent.
pub fn optional<'a>(array: Option<&'a Floats<'_>>, count: usize) -> PyResult<Option<Numbers<'a>>> {
    array.map(|array| array.numbers(count)).transpose()
}

/// Returns the elements of an array, exactly `count` of them.
///
/// *Errors:* `ValueError` if they are not next to each other, or not so many.
pub fn slice<'a, T: Element>(array: &'a PyReadonlyArrayDyn<'_, T>, count: usize) -> PyResult<&'a [T]> {
    let slice = array.as_slice()?;
    match slice.len() == count {
        true => Ok(slice),
        false => Err(value_error(format!("{} elements where {count} are needed", slice.len()))),
    }
}

/// Returns a bit for each byte that is 0: cell `c` is bit `c mod 32` of word `c / 32`. Bits beyond the last byte are 0.
pub fn zeros(bytes: &[u8]) -> Vec<u32> {
    let (whole, rest) = bytes.as_chunks::<32>();
    let eight = |bytes: [u8; 8]| {
        const TOPS: u64 = 0x8080_8080_8080_8080;
        let word = u64::from_le_bytes(bytes);
        // The top bit of each byte that is 0; times the constant, they come together in the highest byte.
        let zero = !(((word & !TOPS) + !TOPS) | word) & TOPS;
        ((zero >> 7).wrapping_mul(0x0102_0408_1020_4080) >> 56) as u32
    };
    let word = |bytes: &[u8; 32]| {
        let (eights, _) = bytes.as_chunks::<8>();
        eights.iter().enumerate().fold(0, |word, (place, &bytes)| word | eight(bytes) << (8 * place))
    };
    let mut words: Vec<u32> = whole.iter().map(word).collect();
    if !rest.is_empty() {
        words.push(rest.iter().enumerate().fold(0, |word, (bit, &byte)| word | u32::from(byte == 0) << bit));
    }
    words
}
