//! Surfaces as they are seen: connected cells of one object whose depths go on from cell to cell.

use super::SEPARATION;
use crate::update::{Known, Update};

/// Returns the cells that cover something, of all surfaces that leave some of what they cover. Such a surface goes into
/// a layer of its own as a whole, so that no crack opens within it.
pub(super) fn that_leave(update: &Update, covering: &[bool], leaves: &[bool]) -> Vec<usize> {
    let mut seen = vec![false; covering.len()];
    let mut all = Vec::new();
    for start in 0..covering.len() {
        if !covering[start] || seen[start] {
            continue;
        }
        seen[start] = true;
        let mut surface = vec![start];
        let mut next = 0;
        while let Some(&cell) = surface.get(next) {
            next += 1;
            for near in neighbours(cell, update.width, covering.len()) {
                if covering[near] && !seen[near] && one_surface(update, cell, near) {
                    seen[near] = true;
                    surface.push(near);
                }
            }
        }
        if surface.iter().any(|&cell| leaves[cell]) {
            all.append(&mut surface);
        }
    }
    all
}

/// Returns whether two neighbours belong together.
fn one_surface(update: &Update, a: usize, b: usize) -> bool {
    let (a, b) = (&update.samples[a], &update.samples[b]);
    let known = a.known == Known::Motion && b.known == Known::Motion;
    known && a.tag == b.tag && (a.depth - b.depth).abs() < SEPARATION
}

fn neighbours(cell: usize, width: usize, cells: usize) -> impl Iterator<Item = usize> {
    let x = cell % width;
    let sides = [
        (x > 0).then(|| cell - 1),
        (x + 1 < width).then_some(cell + 1),
        cell.checked_sub(width),
        (cell + width < cells).then_some(cell + width),
    ];
    sides.into_iter().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::update::{DepthKind, Margin, Sample};

    #[test]
    fn a_surface_that_leaves_nothing_stays() {
        // Two rows of `a`, one cell of which leaves something; `b` at another depth and `c` of another tag next to it.
        let art = ["aab.", "aac."];
        let sample = |c: char| match c {
            'a' => Sample { depth: 0.2, tag: 1, ..Sample::default() },
            'b' => Sample { depth: 0.3, tag: 1, ..Sample::default() },
            _ => Sample { depth: 0.2, tag: 2, ..Sample::default() },
        };
        let samples = art.iter().flat_map(|row| row.chars().map(sample)).collect();
        let update =
            Update { width: 4, height: 2, margin: Margin::default(), samples, depth_kind: DepthKind::Z, overlay: None };
        let covering = [true, true, true, false, true, true, true, false];
        let leaving = |cell: usize| {
            let leaves: Vec<bool> = (0..8).map(|other| other == cell).collect();
            let mut cells = that_leave(&update, &covering, &leaves);
            cells.sort_unstable();
            cells
        };
        assert_eq!(leaving(4), [0, 1, 4, 5]);
        assert_eq!(leaving(2), [2]);
        assert_eq!(leaving(6), [6]);
        assert!(leaving(3).is_empty());
    }
}
