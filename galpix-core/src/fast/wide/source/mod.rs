//! The passes over stationary sources, many cells at a time. They are quicker than their references on processors
//! without vector registers too: on a Cortex-M4 they take a half to a quarter of the instructions.

pub(crate) mod cracks;
pub(crate) mod finish;
pub(crate) mod gather;
pub(crate) mod links;
pub(crate) mod scatter;
pub(crate) mod step;

/// Cells that are looked at at a time.
const RUN: usize = 32;

/// Returns the keys of the cells of a row from column `x` on; past its end `beyond`.
#[inline(always)]
fn run_at(row: &[u16], x: usize, beyond: u16) -> [u16; RUN] {
    let from = row.get(x..).unwrap_or_default();
    if let Some(run) = from.first_chunk() {
        return *run;
    }
    let mut run = [beyond; RUN];
    for (to, &key) in run.iter_mut().zip(from) {
        *to = key;
    }
    run
}

/// Returns the keys of the cells before those of [`run_at`]; before the first one `beyond`.
#[inline(always)]
fn run_before(row: &[u16], x: usize, beyond: u16) -> [u16; RUN] {
    if let Some(x) = x.checked_sub(1) {
        return run_at(row, x, beyond);
    }
    let mut run = [beyond; RUN];
    for (to, &key) in run.iter_mut().skip(1).zip(row) {
        *to = key;
    }
    run
}
