//! Errors of setup, and what rows of a wrong size do.

use super::*;
use crate::error::SetupError;
use crate::frame::Settings;
use crate::frame::fill::FillMode;
use crate::source::{Gather, MOST_SAMPLES};
use std::string::ToString;

fn said<T>(result: Result<T, SetupError>) -> std::string::String {
    result.err().unwrap().to_string()
}

#[test]
fn each_error_of_setup_says_what_to_do() {
    // All buffers live as long as the test, so that layers of one list need not.
    let grid = |height: u32| Grid::new(9, height, Margin::NONE, vec![0; height as usize].leak()).unwrap();
    let (grid, other) = (grid(4), grid(5));
    let format = Static::<Small>::new();
    let source = |grid, displacements: usize, links: usize| {
        let memory = vec![0; Galpixmap::words(&grid, format)].leak();
        let map = Galpixmap::new(grid, format, memory).unwrap();
        Source::new(map, vec![0; displacements].leak(), vec![0; links].leak())
    };
    let visibility = |grid: Grid<'static>, less: [usize; 3]| {
        let cells = grid.cells() as usize;
        let keys = vec![0; cells - less[0]].leak();
        Visibility::new(&grid, keys, vec![0; cells - less[1]].leak(), vec![0; 8 * 9 - less[2]].leak())
    };
    let short = |plane, need, have| {
        std::format!("the {plane} needs {need} words and {have} were provided: provide a longer slice")
    };
    assert_eq!(said(source(grid, 35, 6)), short("plane of displacements", 36, 35));
    assert_eq!(said(source(grid, 36, 5)), short("plane of links", 6, 5));
    assert_eq!(said(source(grid, 35, 5)), short("plane of displacements", 36, 35));
    assert_eq!(said(visibility(grid, [1, 0, 0])), short("plane of keys", 36, 35));
    assert_eq!(said(visibility(grid, [0, 1, 0])), short("plane of entries", 36, 35));
    assert_eq!(said(visibility(grid, [0, 0, 1])), short("line of entries", 72, 71));
    assert!(source(grid, 36, 6).is_ok() && source(grid, 99, 99).is_ok());

    let shown = |grid| visibility(grid, [0; 3]).unwrap();
    let none: &mut [Source<'_, Static<Small>>] = &mut [];
    assert_eq!(
        said(Sources::new(none, shown(grid))),
        "a map of 0x0 cells cannot be made: both sides must be 1 to 32768, margin included, and the cells at most 2^28"
    );
    let differ = "the two maps have different grids: make both over the same one";
    let mut layers = [source(grid, 36, 6).unwrap(), source(other, 45, 7).unwrap()];
    assert_eq!(said(Sources::new(&mut layers[..1], shown(other))), differ);
    assert_eq!(said(Sources::new(&mut layers[1..], shown(grid))), differ);
    assert!(Sources::new(&mut layers, shown(grid)).is_ok());

    // What a base must be and a layer may be does not change when one is replaced.
    let wide = "a layer of 10 columns is wider than the map of the display, which has 9: store only columns that can be \
                seen";
    let wider = || source(Grid::new(10, 1, Margin::NONE, vec![0].leak()).unwrap(), 10, 3).unwrap();
    let small = || source(Grid::new(4, 2, Margin::NONE, vec![0; 2].leak()).unwrap(), 8, 2).unwrap();
    let mut sources = Sources::new(&mut layers, shown(grid)).unwrap();
    let (mut wider_one, mut small_one) = (wider(), small());
    assert_eq!(said(sources.replace(0, &mut wider_one)), differ);
    assert_eq!(said(sources.replace(0, &mut small_one)), differ);
    assert_eq!(said(sources.replace(1, &mut wider_one)), wide);
    assert!(sources.replace(2, &mut wider_one).is_ok() && *wider_one.map().grid() == *wider().map().grid());
    assert!(sources.replace(1, &mut small_one).is_ok());
    assert_eq!((small_one.map().grid(), sources.layers()[1].map().grid().cells()), (&other, 8));
    let mut layers = [source(grid, 36, 6).unwrap(), wider()];
    assert_eq!(said(Sources::new(&mut layers, shown(grid))), wide);
}

/// Two layers of a map of half the cells that can be numbered are just as many as can be.
#[test]
fn there_are_not_more_samples_than_numbers() {
    let format = Dynamic::new(BITS, Layout { colour: Colour::must(Colour::gray(1)), ..Layout::STILL }).unwrap();
    for (height, layers, is_enough) in [(1024, 2, true), (1024, 3, false), (1025, 2, false)] {
        let mut starts = vec![0; height as usize];
        let grid = Grid::new(2048, height, Margin::NONE, &mut starts).unwrap();
        let cells = grid.cells() as usize;
        let mut memory: Vec<_> =
            (0..layers).map(|_| [vec![0; cells], vec![0; cells], vec![0; cells / 8 + 1]]).collect();
        let mut layers: Vec<_> = memory
            .iter_mut()
            .map(|[map, displacements, links]| {
                Source::new(Galpixmap::over(grid, format, map).unwrap(), displacements, links).unwrap()
            })
            .collect();
        let (mut keys, mut words, mut line) = (vec![0; cells], vec![0; cells], vec![0; 8 * 2048]);
        let samples = u64::from(grid.cells()) * layers.len() as u64;
        let visibility = Visibility::new(&grid, &mut keys, &mut words, &mut line).unwrap();
        match Sources::new(&mut layers, visibility) {
            Ok(mut sources) => {
                assert!(is_enough && samples == u64::from(MOST_SAMPLES));
                // The last number is one like others.
                for cell in 0..grid.cells() - 1 {
                    sources.layers[1].map.put(cell, &[u32::MAX; 8]);
                    sources.layers[0].map.put(cell, &[u32::MAX; 8]);
                }
                sources.layers[0].map.put(grid.cells() - 1, &[u32::MAX; 8]);
                sources.layers.iter_mut().for_each(|layer| layer.begin(0));
                let tally = sources.show(&Settings::for_depth(16));
                assert_eq!((tally.moved, tally.holes), (1, grid.cells() - 1));
                assert_eq!(sources.shown(grid.cells() - 1), Some((1, grid.cells() - 1)));
                assert_eq!(sources.shown(grid.cells() - 2), None);
            }
            Err(error) => {
                assert!(!is_enough);
                assert_eq!(
                    error.to_string(),
                    std::format!(
                        "{samples} samples of all layers are more than the 4194304 that can be numbered: use a smaller \
                         map, or fewer layers"
                    )
                );
            }
        }
    }
}

/// Rows that do not exist and buffers of a wrong size: nothing panics, and a buffer that is too short is not changed.
#[test]
fn rows_beyond_the_map_and_buffers_of_any_size_do_no_harm() {
    let (mut random, format) = (Random(6), format(4, Layout::FULL));
    for shape in SHAPES {
        let mut layers = [random_layer(&mut random, shape, format, Look::Grown)];
        with_sources(shape, format, &mut layers, &mut Random(7), |sources| {
            sources.layers[0].begin(16);
            sources.step(&Settings::for_depth(16));
            let grid = *sources.base().unwrap().grid();
            let (width, height) = (grid.width() as usize, grid.height());
            for y in [0, height - 1, height, height + 1, 1 << 15, 1 << 31, u32::MAX] {
                for length in [0, 1, width - 1, width, width + 1, width + 70] {
                    let full = length >= width && y < height;
                    for (sub_cell, fill_mode) in
                        FillMode::ALL.into_iter().flat_map(|mode| [(false, mode), (true, mode)])
                    {
                        let mut colours = vec![!0; length];
                        let holes = sources.gather(y, Gather { fill_mode, sub_cell, edge_threshold: 16 }, &mut colours);
                        assert!(full || holes == 0 && colours == vec![!0; length]);
                        assert!(colours.iter().skip(width).all(|&colour| colour == !0));
                    }
                    let (mut known, mut depths) = (vec![0; length / 32], vec![!0; length]);
                    sources.known(y, &mut known, &mut depths);
                    // Farther than any of these maps is wide.
                    const FAR: u32 = 0x7777_7777;
                    let mut moved = vec![FAR; length];
                    sources.moved(y, &mut moved);
                    assert!(!full || !moved[..width].contains(&FAR), "{y} {length}");
                    assert!(moved.iter().skip(if full { width } else { 0 }).all(|&word| word == FAR), "{y} {length}");
                    // Rows of which one may have another length.
                    let row = vec![3; width];
                    for (lengths, written) in
                        [([width; 3], full), ([0, width, length], full), ([0, length, width], full)]
                    {
                        let gathered = lengths.map(|length| &row[..length.min(width)]);
                        let mut colours = vec![!0; length];
                        sources.finish(y, 16, gathered, &mut colours);
                        assert!(written || colours == vec![!0; length], "{y} {length}");
                        assert!(colours.iter().skip(width).all(|&colour| colour == !0));
                        let mut colours = vec![!0; width];
                        sources.finish(y, 16, gathered, &mut colours);
                        let written = y < height && gathered[1].len() == width;
                        assert!(written != colours.contains(&!0), "{y} {length}");
                    }
                }
            }
        });
    }
}

/// What the line holds before the first frame is of no account.
#[test]
fn a_line_may_hold_anything() {
    let format = format(4, Layout::FULL);
    for shape in [(70, 2, Margin::NONE), (5, 3, Margin::NONE)] {
        let mut layers = [drawn(shape, format, |_, _| nothing())];
        with_sources(shape, format, &mut layers, &mut Random(8), |sources| {
            sources.layers[0].begin(16);
            for first in 0..4 {
                // Pairs whose difference, and that of a cell more, is the smallest number.
                let extremes = [0, i16::MIN as u16, (i16::MIN as u16).wrapping_sub(32), 0];
                let (_, _, line) = sources.visibility.planes();
                line.iter_mut().zip(extremes.into_iter().cycle().skip(first)).for_each(|(to, word)| *to = word);
                assert_eq!(sources.show(&Settings::for_depth(16)).moved, 0);
            }
        });
    }
}
