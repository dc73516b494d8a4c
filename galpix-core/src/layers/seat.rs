//! Who is shown: the resolution between layers, and its undoing. An exchange of words, which is its own inverse.

use core::ops::Range;

use crate::constant::{below, opaque};
use crate::frame::Work;
use crate::galpixel::{Budget, Class};
use crate::galpixmap::Galpixmap;
use crate::layout::Layout;
use crate::sweep::VECTORS;

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
pub(super) fn take<L: Layout, B: Budget<L>>(
    base: &mut Galpixmap<'_, L, B>,
    layer: &mut Galpixmap<'_, L, B>,
    seats: &mut [u32],
    work: Work,
) {
    let cells = base.grid().cells() as usize;
    let empty = (Class::Empty as u32) << base.record().depth().bits;
    for (index, seats) in seats.iter_mut().enumerate() {
        let run = index * RUN..cells.min(index * RUN + RUN);
        *seats = 0;
        if work == Work::Skipping && layer.all_empty(run.clone()) {
            continue;
        }
        let mut nearer = [0; RUN];
        let keys = base.keys(run.clone()).zip(layer.keys(run.clone()));
        let mut any = 0;
        for (nearer, (incumbent, challenger)) in nearer.iter_mut().zip(keys) {
            // An empty cell gets no seat, whatever is left in its other fields.
            *nearer = below(challenger, incumbent.min(empty));
            any |= *nearer;
        }
        if work == Work::Constant || any != 0 {
            for (lane, &nearer) in nearer.iter().enumerate() {
                *seats |= (nearer & 1) << lane;
            }
            exchange(base, layer, run, *seats, work);
        }
    }
}

/// Undoes [`take`].
pub(super) fn leave<L: Layout, B: Budget<L>>(
    base: &mut Galpixmap<'_, L, B>,
    layer: &mut Galpixmap<'_, L, B>,
    seats: &[u32],
    work: Work,
) {
    let cells = base.grid().cells() as usize;
    for (index, &seats) in seats.iter().enumerate() {
        if work == Work::Constant || seats != 0 {
            exchange(base, layer, index * RUN..cells.min(index * RUN + RUN), seats, work);
        }
    }
}

/// Exchanges the words of those cells of a run whose bit is set.
#[inline(always)]
fn exchange<L: Layout, B: Budget<L>>(
    base: &mut Galpixmap<'_, L, B>,
    layer: &mut Galpixmap<'_, L, B>,
    run: Range<usize>,
    seats: u32,
    work: Work,
) {
    let words = base.record().words();
    let planes = base.planes_mut().iter_mut().zip(layer.planes_mut()).take(words);
    if work == Work::Skipping && !VECTORS {
        for (base, layer) in planes {
            let (Some(base), Some(layer)) = (base.get_mut(run.clone()), layer.get_mut(run.clone())) else { continue };
            let mut rest = seats;
            for (base, layer) in base.iter_mut().zip(layer) {
                if rest & 1 != 0 {
                    core::mem::swap(base, layer);
                }
                rest >>= 1;
            }
        }
        return;
    }
    let mut masks = [0; RUN];
    for (lane, mask) in masks.iter_mut().enumerate() {
        let seated = (seats >> lane & 1).wrapping_neg();
        // A compiler that knows what it is may multiply by the bit; one with vector registers is to know it.
        *mask = if VECTORS { seated } else { opaque(seated) };
    }
    for (base, layer) in planes {
        let (Some(base), Some(layer)) = (base.get_mut(run.clone()), layer.get_mut(run.clone())) else { continue };
        for ((base, layer), mask) in base.iter_mut().zip(layer).zip(&masks) {
            let apart = (*base ^ *layer) & mask;
            *base ^= apart;
            *layer ^= apart;
        }
    }
}
