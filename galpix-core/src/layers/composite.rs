//! Resolution between the base and a hidden layer: which of the two a cell shows.
//!
//! A cell is *composited* for a layer where the layer's galpixel is nearer: there the galpixels of base and layer
//! change places. The exchange is its own inverse.

use core::ops::Range;

use crate::fast::VECTORS;
use crate::format::Format;
use crate::frame::reference::{below, opaque};
use crate::map::Galpixmap;

/// Cells per word of a composite mask, which are compared at once.
const RUN: usize = 32;

/// Returns whether bit `cell` of a composite mask is set; `false` beyond its end.
#[inline(always)]
pub(super) fn is_set(composited: &[u32], cell: u32) -> bool {
    composited.get((cell >> 5) as usize).is_some_and(|word| word >> (cell & 31) & 1 != 0)
}

/// Returns all ones if bit `cell` of a composite mask is set, else 0, in constant time.
#[inline(always)]
pub(super) fn mask(composited: &[u32], cell: u32) -> u32 {
    let word = composited.get((cell >> 5) as usize).copied().unwrap_or(0);
    opaque((word >> (cell & 31) & 1).wrapping_neg())
}

/// Exchanges the galpixels of `base` and `layer` in every cell where the layer's is nearer, and sets the bits of these
/// cells in `composited`; all other bits become 0.
///
/// The depth alone decides, not the class: a filled cell belongs to its surface, and what it covers stays in its layer.
/// Of equal depths the base's galpixel stays, which may be that of a layer that was composited before.
pub(super) fn composite<F: Format, const CONSTANT_TIME: bool>(
    base: &mut Galpixmap<'_, F>,
    layer: &mut Galpixmap<'_, F>,
    composited: &mut [u32],
) {
    let cells = base.grid().cells() as usize;
    let empty = 1 << base.record().depth().bits;
    for (index, composited) in composited.iter_mut().enumerate() {
        let run = index * RUN..cells.min(index * RUN + RUN);
        *composited = 0;
        if !CONSTANT_TIME && layer.all_empty(run.clone()) {
            continue;
        }
        let mut nearer = [0; RUN];
        let mut any = 0;
        let surfaces = base.surfaces(run.clone()).zip(layer.surfaces(run.clone()));
        for (nearer, (incumbent, challenger)) in nearer.iter_mut().zip(surfaces) {
            // An empty cell is never shown, whatever its other fields hold.
            *nearer = below(challenger, incumbent.min(empty));
            any |= *nearer;
        }
        if CONSTANT_TIME || any != 0 {
            for (lane, &nearer) in nearer.iter().enumerate() {
                *composited |= (nearer & 1) << lane;
            }
            exchange::<F, CONSTANT_TIME>(base, layer, run, *composited);
        }
    }
}

/// Undoes [`composite`]; `composited` stays as it is.
pub(super) fn restore<F: Format, const CONSTANT_TIME: bool>(
    base: &mut Galpixmap<'_, F>,
    layer: &mut Galpixmap<'_, F>,
    composited: &[u32],
) {
    let cells = base.grid().cells() as usize;
    for (index, &composited) in composited.iter().enumerate() {
        if CONSTANT_TIME || composited != 0 {
            exchange::<F, CONSTANT_TIME>(base, layer, index * RUN..cells.min(index * RUN + RUN), composited);
        }
    }
}

/// Exchanges all words of those cells of a run whose bit is set in `composited`.
#[inline(always)]
fn exchange<F: Format, const CONSTANT_TIME: bool>(
    base: &mut Galpixmap<'_, F>,
    layer: &mut Galpixmap<'_, F>,
    run: Range<usize>,
    composited: u32,
) {
    let words = base.record().words();
    let planes = base.planes_mut().iter_mut().zip(layer.planes_mut()).take(words);
    if !CONSTANT_TIME && !VECTORS {
        for (base, layer) in planes {
            let (Some(base), Some(layer)) = (base.get_mut(run.clone()), layer.get_mut(run.clone())) else { continue };
            exchange_set(base, layer, composited);
        }
        return;
    }
    let mut masks = [0; RUN];
    for (lane, mask) in masks.iter_mut().enumerate() {
        *mask = (composited >> lane & 1).wrapping_neg();
    }
    for (base, layer) in planes {
        let (Some(base), Some(layer)) = (base.get_mut(run.clone()), layer.get_mut(run.clone())) else { continue };
        exchange_masked(base, layer, &masks);
    }
}

/// Exchanges the words of a run in one plane where the masks are all ones; reads and writes all of them.
#[inline(never)]
fn exchange_masked(base: &mut [u32], layer: &mut [u32], masks: &[u32; RUN]) {
    for ((base, layer), mask) in base.iter_mut().zip(layer).zip(masks) {
        let difference = (*base ^ *layer) & mask;
        *base ^= difference;
        *layer ^= difference;
    }
}

/// Exchanges the words of a run in one plane where bits are set; does not touch the others.
#[inline(never)]
fn exchange_set(base: &mut [u32], layer: &mut [u32], mut composited: u32) {
    for (base, layer) in base.iter_mut().zip(layer) {
        if composited & 1 != 0 {
            core::mem::swap(base, layer);
        }
        composited >>= 1;
    }
}
