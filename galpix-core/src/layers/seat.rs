//! Who is shown: the resolution between layers, and its undoing. An exchange of words, which is its own inverse.

use core::ops::Range;

use crate::constant::{below, opaque};
use crate::frame::Work;
use crate::galpixel::{Budget, Class};
use crate::galpixmap::Galpixmap;
use crate::layout::Layout;

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
            exchange(base, layer, run, &nearer);
        }
    }
}

/// Undoes [`take`], but for what was made up in the base to fill a hole: where a layer has covered it, it is dropped. It would be stale when
/// the cell opens again, and is then filled anew.
pub(super) fn leave<L: Layout, B: Budget<L>>(
    base: &mut Galpixmap<'_, L, B>,
    layer: &mut Galpixmap<'_, L, B>,
    seats: &[u32],
    work: Work,
) {
    let cells = base.grid().cells() as usize;
    for (index, &seats) in seats.iter().enumerate() {
        if work == Work::Constant || seats != 0 {
            let mut seated = [0; RUN];
            for (lane, seated) in seated.iter_mut().enumerate() {
                *seated = (seats >> lane & 1).wrapping_neg();
            }
            let run = index * RUN..cells.min(index * RUN + RUN);
            exchange(base, layer, run.clone(), &seated);
            drop_debris(base, run, &seated);
        }
    }
}

/// Empties the cells of a run that hold no galpixel, where the mask has ones.
#[inline(always)]
fn drop_debris<L: Layout, B: Budget<L>>(base: &mut Galpixmap<'_, L, B>, run: Range<usize>, masks: &[u32; RUN]) {
    let class = base.record().class();
    let (word, _) = class.words();
    // Galpixel is the class without a bit, empty the one with all its bits.
    let all = (Class::Empty as u32) << class.shift;
    let Some(words) = base.planes_mut().get_mut(word).and_then(|plane| plane.get_mut(run)) else { return };
    for (word, mask) in words.iter_mut().zip(masks) {
        let debris = below(0, *word & all) & mask;
        *word |= debris & all;
    }
}

/// Exchanges the words of a run of cells where the mask has ones.
#[inline(always)]
fn exchange<L: Layout, B: Budget<L>>(
    base: &mut Galpixmap<'_, L, B>,
    layer: &mut Galpixmap<'_, L, B>,
    run: Range<usize>,
    masks: &[u32; RUN],
) {
    let words = base.record().words();
    for (base, layer) in base.planes_mut().iter_mut().zip(layer.planes_mut()).take(words) {
        let (Some(base), Some(layer)) = (base.get_mut(run.clone()), layer.get_mut(run.clone())) else { continue };
        for ((base, layer), mask) in base.iter_mut().zip(layer).zip(masks) {
            let apart = (*base ^ *layer) & mask;
            *base ^= apart;
            *layer ^= apart;
        }
    }
}
