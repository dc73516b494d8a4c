//! The engine's layers over buffers of the test, compared with their model.

use galpix_core::layers::{Layer, Layers, Stationary, composite_words, displacement_word};
use galpix_core::{Controller, Format, Galpixmap, Grid, Scratch, stages};
use galpix_tests::memory::Shape;

use super::holes::Cell;
use super::model::{Kind, planes};

/// What memory holds before anything is laid over it.
const STALE: u32 = 0xa5a5_a5a5;

#[derive(Default)]
struct Memory {
    maps: [Vec<u32>; 3],
    winners: Vec<u32>,
    edges: Vec<u32>,
    composited: Vec<u32>,
    displacements: Vec<u32>,
}

/// Runs a closure with layers whose maps hold `contents`, the base first.
pub fn with_layers<F: Format, R>(
    shape: Shape,
    format: F,
    contents: &[(Kind, Vec<Cell>)],
    work: impl for<'p, 'l> FnOnce(&mut Layers<'p, 'l, F>) -> R,
) -> R {
    let mut starts = vec![STALE; Grid::rows(shape.height, shape.margin)];
    let grid = Grid::new(shape.width, shape.height, shape.margin, &mut starts).unwrap();
    let words = Galpixmap::words(&grid, format);
    let cells = grid.cells() as usize;
    let mut memories: Vec<Memory> = contents
        .iter()
        .map(|(kind, content)| Memory {
            maps: [planes(content), vec![STALE; words], vec![STALE; words]],
            winners: vec![STALE; if kind.winners { cells } else { 0 }],
            edges: vec![STALE; if kind.edges { stages::words(&grid) } else { 0 }],
            composited: vec![STALE; composite_words(&grid)],
            displacements: vec![displacement_word([0, 0]); cells],
        })
        .collect();
    let mut parts = memories.iter_mut().zip(contents).map(|(memory, (kind, _))| {
        let Memory { maps, winners, edges, composited, displacements } = memory;
        let maps = maps.each_mut().map(|memory| Galpixmap::over(grid, format, memory).unwrap());
        (kind, maps, Scratch { winners, edges }, composited, displacements)
    });
    let (_, [front, back, _], scratch, ..) = parts.next().expect("a base");
    let base = Controller::new(front, back, scratch).unwrap();
    let mut hidden: Vec<_> = parts
        .map(|(kind, [front, back, third], scratch, composited, displacements)| {
            let layer = if kind.stationary {
                Layer::stationary(Stationary { stored: front, displacements }, back, third, scratch.winners, composited)
            } else {
                Layer::new(front, back, scratch, composited)
            };
            layer.unwrap()
        })
        .collect();
    work(&mut Layers::new(base, &mut hidden).unwrap())
}
