//! Layers against what they are made of: maps that move apart, and the smallest by (class, depth, layer) in each cell.

pub mod engine;
mod holes;
pub mod model;
mod random;
mod reference;

use fixed::types::I32F32;
use galpix_core::layers::{Layer, Layers, Stationary, composite_words};
use galpix_core::{
    Bits, Class, Controller, Demand, Dynamic, Galpixel, Galpixmap, Grid, Layout, Margin, Scratch, Settings, stages,
};
use galpix_tests::memory::Mode;
use galpix_tests::profiles::{PAPER, dynamic};

type Map<'p> = Galpixmap<'p, Dynamic>;

fn format() -> Dynamic {
    dynamic(Layout::FULL, Bits::derive(Demand { extent: 64, recog: 8, prop: 8 }).expect("a budget"))
}

fn galpixel(colour: u8, depth: f64, velocity: [f64; 2]) -> Galpixel {
    Galpixel {
        class: Class::Galpixel,
        colour: [colour; 3],
        depth: I32F32::from_num(depth),
        velocity: [I32F32::from_num(velocity[0]), I32F32::from_num(velocity[1]), I32F32::ZERO],
        ..Galpixel::default()
    }
}

fn colours(map: &Map<'_>) -> Vec<u8> {
    let grid = *map.grid();
    (0..grid.height() as i32)
        .flat_map(|y| (0..grid.width() as i32).map(move |x| (x, y)))
        .map(|(x, y)| map.rgb888(x, y).expect("a cell")[0])
        .collect()
}

#[test]
fn a_wall_behind_a_ball_comes_back_from_its_own_layer() {
    const WIDTH: u32 = 40;
    let mut rows = [0; 3];
    let grid = Grid::new(WIDTH, 3, Margin::NONE, &mut rows).expect("a grid");
    for (mode, stationary) in
        [(Mode::Step, false), (Mode::ConstantTime, false), (Mode::Step, true), (Mode::ConstantTime, true)]
    {
        let words = Map::words(&grid, format());
        let mut memory: Vec<Vec<u32>> = (0..5).map(|_| vec![0; words]).collect();
        let [m0, m1, m2, m3, m4] = memory.as_mut_slice() else { unreachable!() };
        let map = |memory| Map::new(grid, format(), memory).expect("a map");
        let (mut winners, mut edges) = (vec![0; grid.cells() as usize], vec![0; stages::words(&grid)]);
        let (mut composited, mut displacements) = (vec![0; composite_words(&grid)], vec![0; grid.cells() as usize]);
        let scratch = Scratch { winners: &mut winners, edges: &mut edges };
        let base = Controller::new(map(m0), map(m1), scratch).expect("a base");
        let layer = if stationary {
            Layer::stationary(
                Stationary { stored: map(m2), displacements: &mut displacements },
                map(m3),
                map(m4),
                &mut [],
                &mut composited,
            )
        } else {
            Layer::new(map(m2), map(m3), Scratch::default(), &mut composited)
        };
        let mut hidden = [layer.expect("a layer")];
        let mut layers = Layers::new(base, &mut hidden).expect("layers");
        for y in 0..3 {
            for x in 0..WIDTH as i32 {
                layers.layer_mut(0).expect("the base").store(x, y, &galpixel(100 + x as u8, 0.75, [0.0; 2]));
                if (4..10).contains(&x) {
                    layers.layer_mut(1).expect("the ball").store(x, y, &galpixel(1 + x as u8, 0.25, [1.5, 0.0]));
                }
            }
        }
        layers.composite();
        let settings = Settings::for_depth(16);
        for frame in 0..20 {
            let left = 4 + (3 * frame + 1) / 2;
            let expected: Vec<u8> = (0..WIDTH as i32)
                .map(|x| if (left..left + 6).contains(&x) { (5 + x - left) as u8 } else { 100 + x as u8 })
                .collect();
            let shown = colours(layers.front());
            assert_eq!(&shown[..WIDTH as usize], &expected[..], "frame {frame}, {mode:?}, stationary: {stationary}");
            for cell in 0..WIDTH {
                let ball = (left..left + 6).contains(&(cell as i32));
                assert_eq!(layers.layer_at(cell), usize::from(ball), "frame {frame}, cell {cell}");
            }
            let tally = mode.step_layers(&mut layers, &settings);
            assert_eq!((tally.holes, tally.lost, tally.collided), (0, 0, 0));
        }
    }
}

/// The table of `docs/notes/layers.md`, from what the engine asks for.
#[test]
fn memory_is_as_documented() {
    let format = dynamic(Layout::FULL, PAPER);
    let mut rows =
        ["1 layer", "2 layers", "3 layers", "a stationary-source layer more"].map(|name| format!("| {name} |"));
    for (width, height) in [(128, 64), (320, 240), (1024, 1024)] {
        let mut starts = vec![0; Grid::rows(height, Margin::NONE)];
        let grid = Grid::new(width, height, Margin::NONE, &mut starts).expect("a grid");
        let (map, cells) = (Map::words(&grid, format), grid.cells() as usize);
        let base = 2 * map + cells + stages::words(&grid);
        let layer = 2 * map + composite_words(&grid);
        let stationary = 3 * map + cells + composite_words(&grid);
        for (row, words) in rows.iter_mut().zip([base, base + layer, base + 2 * layer, stationary]) {
            let digits = (4 * words).to_string();
            let groups: Vec<_> = digits.as_bytes().rchunks(3).rev().map(String::from_utf8_lossy).collect();
            *row += &format!(" {} |", groups.join(" "));
        }
    }
    let document = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/notes/layers.md"))
        .expect("it can be read");
    for row in rows {
        println!("{row}");
        assert!(document.lines().any(|line| line == row), "docs/notes/layers.md lacks the row {row}");
    }
}
