//! Each surface of a built-in scene on its own, as a mesh: all that the reference eye would see of it if nothing else
//! were there, and what it would see of its back.

use crate::source::scene::surface::{Hit, Surface};

/// One node of a mesh.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Place on the display, pixels.
    pub at: [f64; 2],
    /// The point and its depth.
    pub hit: Hit,
    /// Whether it is on the side that faces away.
    pub back: bool,
}

/// Where nodes are: columns and rows of a lattice over the display.
#[derive(Clone, Copy, Debug)]
pub struct Lattice {
    /// The node at the top left, pixels.
    pub first: [f64; 2],
    /// Pixels between nodes.
    pub step: f64,
    /// Columns and rows.
    pub size: [usize; 2],
}

impl Lattice {
    fn at(&self, column: usize, row: usize) -> [f64; 2] {
        [self.first[0] + column as f64 * self.step, self.first[1] + row as f64 * self.step]
    }
}

/// The mesh of a surface at time `t`: triangles between neighbouring nodes that are all on it, and, where it has a
/// back, the back's, and a rim that closes what is between the two.
pub fn triangles(surface: &dyn Surface, lattice: &Lattice, t: f64, mut draw: impl FnMut([&Node; 3])) {
    let [columns, rows] = lattice.size;
    let nodes = |back: bool| -> Vec<Option<Node>> {
        let node = |index: usize| {
            let at = lattice.at(index % columns, index / columns);
            let hit = if back { surface.behind(at[0], at[1], t) } else { surface.hit(at[0], at[1], t) };
            hit.map(|hit| Node { at, hit, back })
        };
        (0..columns * rows).map(node).collect()
    };
    let front = nodes(false);
    let mut quad = |corners: [&Node; 4]| {
        let [a, b, c, d] = corners;
        draw([a, b, c]);
        draw([b, d, c]);
    };
    let quads = |nodes: &[Option<Node>], column: usize, row: usize| -> Option<[Node; 4]> {
        let at = row * columns + column;
        Some([nodes[at]?, nodes[at + 1]?, nodes[at + columns]?, nodes[at + columns + 1]?])
    };
    for row in 0..rows - 1 {
        for column in 0..columns - 1 {
            if let Some([a, b, c, d]) = quads(&front, column, row) {
                quad([&a, &b, &c, &d]);
            }
        }
    }
    // Most surfaces have no back; one that has shows it wherever it shows its front.
    let has_back =
        front.iter().flatten().next().is_some_and(|node| surface.behind(node.at[0], node.at[1], t).is_some());
    if !has_back {
        return;
    }
    let behind = nodes(true);
    let whole = |column: Option<usize>, row: Option<usize>| {
        let inside = column.zip(row).filter(|&(column, row)| column + 1 < columns && row + 1 < rows);
        inside.is_some_and(|(column, row)| quads(&front, column, row).is_some())
    };
    for row in 0..rows {
        for column in 0..columns {
            if column + 1 < columns
                && row + 1 < rows
                && let Some([a, b, c, d]) = quads(&behind, column, row)
            {
                quad([&a, &b, &c, &d]);
            }
            // An edge of the lattice with the surface on one side only is a part of the rim.
            let at = row * columns + column;
            let above = whole(Some(column), row.checked_sub(1));
            let left = whole(column.checked_sub(1), Some(row));
            let own = whole(Some(column), Some(row));
            for (other, is_rim) in [(at + 1, above != own), (at + columns, left != own)] {
                if is_rim
                    && let (Some(a), Some(b), Some(c), Some(d)) = (front[at], front[other], behind[at], behind[other])
                {
                    quad([&a, &b, &c, &d]);
                }
            }
        }
    }
}
