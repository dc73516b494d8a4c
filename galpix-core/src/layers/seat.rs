//! Who is shown: the resolution between layers, and its undoing. An exchange of words, which is its own inverse.

use core::ops::Range;

use crate::fast::VECTORS;
use crate::format::Format;
use crate::frame::reference::{below, opaque};
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// Cells that are looked at once: a word of seats.
const RUN: usize = 32;

/// All ones for a cell that is seated, else 0.
#[inline(always)]
pub(super) fn bit(seats: &[u32], cell: u32) -> u32 {
    let word = seats.get((cell >> 5) as usize).copied().unwrap_or(0);
    opaque((word >> (cell & 31) & 1).wrapping_neg())
}

/// Exchanges the galpixels of `base` and `layer` in every cell where the layer's is nearer by class and depth; `seats` says
/// afterwards where. Of equal keys the base's stays, and with it that of a layer that was seated before.
pub(super) fn take<F: Format, const CONSTANT_TIME: bool>(
    base: &mut Galpixmap<'_, F>,
    layer: &mut Galpixmap<'_, F>,
    seats: &mut [u32],
) {
    let cells = base.grid().cells() as usize;
    let empty = (Class::Empty as u32) << base.record().depth().bits;
    for (index, seats) in seats.iter_mut().enumerate() {
        let run = index * RUN..cells.min(index * RUN + RUN);
        *seats = 0;
        if !CONSTANT_TIME && layer.all_empty(run.clone()) {
            continue;
        }
        let mut nearer = [0; RUN];
        let mut any = 0;
        let keys = base.keys(run.clone()).zip(layer.keys(run.clone()));
        for (nearer, (incumbent, challenger)) in nearer.iter_mut().zip(keys) {
            // An empty cell is not shown, whatever is left in its other fields.
            *nearer = below(challenger, incumbent.min(empty));
            any |= *nearer;
        }
        if CONSTANT_TIME || any != 0 {
            for (lane, &nearer) in nearer.iter().enumerate() {
                *seats |= (nearer & 1) << lane;
            }
            exchange::<F, CONSTANT_TIME>(base, layer, run, *seats);
        }
    }
}

/// Undoes [`take`].
pub(super) fn leave<F: Format, const CONSTANT_TIME: bool>(
    base: &mut Galpixmap<'_, F>,
    layer: &mut Galpixmap<'_, F>,
    seats: &[u32],
) {
    let cells = base.grid().cells() as usize;
    for (index, &seats) in seats.iter().enumerate() {
        if CONSTANT_TIME || seats != 0 {
            exchange::<F, CONSTANT_TIME>(base, layer, index * RUN..cells.min(index * RUN + RUN), seats);
        }
    }
}

/// Exchanges the words of those cells of a run whose bit is set.
#[inline(always)]
fn exchange<F: Format, const CONSTANT_TIME: bool>(
    base: &mut Galpixmap<'_, F>,
    layer: &mut Galpixmap<'_, F>,
    run: Range<usize>,
    seats: u32,
) {
    let words = base.record().words();
    let planes = base.planes_mut().iter_mut().zip(layer.planes_mut()).take(words);
    if !CONSTANT_TIME && !VECTORS {
        for (base, layer) in planes {
            let (Some(base), Some(layer)) = (base.get_mut(run.clone()), layer.get_mut(run.clone())) else { continue };
            exchange_few(base, layer, seats);
        }
        return;
    }
    let mut masks = [0; RUN];
    for (lane, mask) in masks.iter_mut().enumerate() {
        *mask = (seats >> lane & 1).wrapping_neg();
    }
    for (base, layer) in planes {
        let (Some(base), Some(layer)) = (base.get_mut(run.clone()), layer.get_mut(run.clone())) else { continue };
        exchange_plane(base, layer, &masks);
    }
}

/// In one plane, where the masks have ones.
#[inline(never)]
fn exchange_plane(base: &mut [u32], layer: &mut [u32], masks: &[u32; RUN]) {
    for ((base, layer), mask) in base.iter_mut().zip(layer).zip(masks) {
        let apart = (*base ^ *layer) & mask;
        *base ^= apart;
        *layer ^= apart;
    }
}

/// In one plane, where bits are set; others are not touched.
#[inline(never)]
fn exchange_few(base: &mut [u32], layer: &mut [u32], mut seats: u32) {
    for (base, layer) in base.iter_mut().zip(layer) {
        if seats & 1 != 0 {
            core::mem::swap(base, layer);
        }
        seats >>= 1;
    }
}
