//! One fault each, to be found.

use core::hint::black_box;
use core::num::NonZeroU32;

use crate::Inputs;

/// Calls them all.
pub fn call_all(inputs: &mut Inputs<'_>) {
    let Inputs { size: [width, height], rows, .. } = black_box(inputs);
    black_box(planted_multiply(*width, *height));
    black_box(planted_divide(*width, NonZeroU32::new(*height).unwrap_or(NonZeroU32::MIN)));
    black_box(planted_float(*width as i32, *height as i32));
    black_box(planted_behind_a_pointer(*width, *height));
    black_box(planted_inpaint_divide(*width, NonZeroU32::new(*height).unwrap_or(NonZeroU32::MIN)));
    #[cfg(feature = "bad")]
    bad_index(rows, *width as usize);
    black_box(&rows);
}

/// A product, an instruction or a helper.
#[inline(never)]
fn planted_multiply(width: u32, height: u32) -> u32 {
    width.wrapping_mul(height)
}

/// A quotient, an instruction or a helper; no panic.
#[inline(never)]
fn planted_divide(width: u32, height: NonZeroU32) -> u32 {
    width / height
}

/// A quotient beside a product, of which only the product is allowed in push-pull.
#[inline(never)]
fn planted_inpaint_divide(width: u32, height: NonZeroU32) -> u32 {
    width.wrapping_mul(width) / height
}

/// A float, an instruction or a helper.
#[inline(never)]
fn planted_float(width: i32, height: i32) -> f32 {
    width as f32 + height as f32
}

/// A product that is called only through a table in memory.
#[inline(never)]
fn planted_behind_a_pointer(width: u32, height: u32) -> u32 {
    static TABLE: [fn(u32, u32) -> u32; 2] = [planted_multiply, sum];
    TABLE.get(black_box(width) as usize).map_or(0, |chosen| chosen(width, height))
}

fn sum(width: u32, height: u32) -> u32 {
    width.wrapping_add(height)
}

/// An index that may be out of range.
#[cfg(feature = "bad")]
#[inline(never)]
fn bad_index(rows: &mut [u32], row: usize) {
    rows[row] = 0;
}
