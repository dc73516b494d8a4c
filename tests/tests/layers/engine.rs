//! The engine's layers with the memory that they are lent, beside the model of them.

use galpix_core::edge;
use galpix_core::frame::{Controller, Scratch};
use galpix_core::galpixel::Budget;
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::Grid;
use galpix_core::layers::{Layer, Layers, displacement_word, seat_words};
use galpix_core::layout::Layout;
use galpix_tests::lent::Shape;

use crate::holes::Cell;
use crate::model::{Kind, planes};

/// What memory holds before anything is laid over it.
const STALE: u32 = 0xa5a5_a5a5;

#[derive(Default)]
struct Memory {
    maps: [Vec<u32>; 3],
    winners: Vec<u32>,
    edges: Vec<u32>,
    seats: Vec<u32>,
    displacements: Vec<u32>,
}

/// Lends layers whose maps hold `contents`, the base first.
pub fn with_layers<L: Layout, B: Budget<L>, const HIDDEN: usize, R>(
    shape: Shape,
    budget: B,
    contents: &[(Kind, Vec<Cell>)],
    work: impl for<'p> FnOnce(&mut Layers<'p, L, B, HIDDEN>) -> R,
) -> R {
    let mut starts = vec![STALE; Grid::rows(shape.height, shape.wings)];
    let grid = Grid::new(shape.width, shape.height, shape.wings, &mut starts).unwrap();
    let words = Galpixmap::<L, B>::words(&grid, budget);
    let cells = grid.cells() as usize;
    let mut memories: Vec<Memory> = contents
        .iter()
        .map(|(kind, content)| Memory {
            maps: [planes(content), vec![STALE; words], vec![STALE; words]],
            winners: vec![STALE; if kind.winners { cells } else { 0 }],
            edges: vec![STALE; if kind.edges { edge::words(&grid) } else { 0 }],
            seats: vec![STALE; seat_words(&grid)],
            displacements: vec![displacement_word([0, 0]); cells],
        })
        .collect();
    let mut parts = memories.iter_mut().zip(contents).map(|(memory, (kind, _))| {
        let Memory { maps, winners, edges, seats, displacements } = memory;
        let maps = maps.each_mut().map(|memory| Galpixmap::<L, B>::over(grid, budget, memory).unwrap());
        (kind, maps, Scratch { winners, edges }, seats, displacements)
    });
    let (_, [front, back, _], scratch, ..) = parts.next().expect("a base");
    let base = Controller::new(front, back, scratch).unwrap();
    let hidden: Vec<_> = parts
        .map(|(kind, [front, back, third], scratch, seats, displacements)| {
            let layer = if kind.anchored {
                Layer::anchored(front, displacements, back, third, scratch.winners, seats)
            } else {
                Layer::new(front, back, scratch, seats)
            };
            layer.unwrap()
        })
        .collect();
    let hidden: [_; HIDDEN] = hidden.try_into().unwrap_or_else(|_| panic!("a content for each layer"));
    work(&mut Layers::new(base, hidden).unwrap())
}
