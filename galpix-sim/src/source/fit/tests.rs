use galpix_core::stages::{self, FILLED};
use galpix_core::{Class, Controller, FillMode, Galpixmap, Grid, Margin, Rounding, Scratch, Settings, Static};
use galpix_link::panel::{Lcd, Oled, Panel};

use super::*;
use crate::certificate::Certificate;
use crate::update::{self, DepthKind, Known};

/// Calls `look` with every galpixel that is left after `frames` frames of a panel: the cell that it entered at, and its
/// place.
fn after<P: Panel>(galpixels: &[Galpixel], frames: u32, mut look: impl FnMut([usize; 2], [f64; 2])) {
    let (width, height) = (u32::from(P::WIDTH), u32::from(P::HEIGHT));
    let mut starts = vec![0; Grid::rows(height, Margin::NONE)];
    let grid = Grid::new(width, height, Margin::NONE, &mut starts).unwrap();
    let (mut front, mut back) = (vec![0; P::MAP_WORDS], vec![0; P::MAP_WORDS]);
    let mut front = Galpixmap::new(grid, Static::<P>::new(), &mut front).unwrap();
    let back = Galpixmap::new(grid, Static::<P>::new(), &mut back).unwrap();
    for (index, galpixel) in galpixels.iter().enumerate() {
        let (x, y) = (index % P::WIDTH as usize, index / P::WIDTH as usize);
        assert_eq!(front.store(x as i32, y as i32, galpixel), Some(0), "a field of ({x}, {y}) was clamped");
    }
    let (mut winners, mut edges) = (vec![0; P::CELLS], vec![0; stages::words(&grid)]);
    let scratch = Scratch { winners: &mut winners, edges: &mut edges };
    let mut controller = Controller::new(front, back, scratch).unwrap();
    let settings = Settings::for_depth(u32::from(P::RECORD.depth().bits));
    assert_eq!(settings.fill_mode, FillMode::Extend, "a fill mode that keeps a winner map");
    let mut origins: Vec<Option<usize>> = (0..P::CELLS).map(Some).collect();
    for _ in 0..frames {
        controller.step(&settings);
        let origin = |&winner: &u32| if winner < FILLED { origins[winner as usize] } else { None };
        origins = controller.winners().iter().map(origin).collect();
    }
    for (cell, origin) in origins.iter().enumerate() {
        let (x, y) = (cell % P::WIDTH as usize, cell / P::WIDTH as usize);
        let galpixel = controller.front().load(x as i32, y as i32).unwrap();
        if let Some(origin) = origin
            && galpixel.class == Class::Galpixel
        {
            let [dx, dy] = galpixel.offset.map(|offset| offset.to_num::<f64>());
            look([origin % P::WIDTH as usize, origin / P::WIDTH as usize], [x as f64 + dx, y as f64 + dy]);
        }
    }
}

#[test]
fn the_source_covers_the_panel_around_its_centre() {
    // Wider than the panel: columns are cropped, 1.5 pixels per cell in both directions.
    let wide = Fit::new([192, 96], [64, 64]).unwrap();
    assert_eq!(wide.scale(), 1.5);
    assert_eq!(wide.centre(0, 0), [95.5 - 31.5 * 1.5, 47.5 - 31.5 * 1.5]);
    assert_eq!(wide.centre(63, 63), [95.5 + 31.5 * 1.5, 47.5 + 31.5 * 1.5]);
    assert_eq!(wide.nearest(0, 0), [48, 0]);
    assert_eq!(wide.nearest(63, 63), [143, 95]);
    let same = Fit::new([7, 5], [7, 5]).unwrap();
    assert_eq!((same.centre(3, 4), same.nearest(3, 4)), ([3.0, 4.0], [3, 4]));
    // Two pixels per cell: the centre lies between two of them.
    let half = Fit::new([256, 128], [128, 64]).unwrap();
    assert_eq!((half.centre(5, 6), half.nearest(5, 6)), ([10.5, 12.5], [10, 12]));
    assert_eq!(Fit::new([0, 5], [7, 5]), None);
    assert_eq!(Fit::new([7, 5], [7, 0]), None);
}

#[test]
fn every_cell_has_a_pixel_of_its_own_within_half_a_pixel() {
    for source in [[128, 64], [129, 65], [192, 144], [320, 240], [333, 217], [640, 480], [1000, 77]] {
        let panel = [128, 64];
        let fit = Fit::new(source, panel).unwrap();
        let cells = (0..panel[1]).flat_map(|y| (0..panel[0]).map(move |x| (x, y)));
        let taken: std::collections::BTreeSet<_> = cells
            .map(|(x, y)| {
                let pixel = fit.nearest(x, y);
                for axis in 0..2 {
                    let centre = fit.centre(x, y)[axis];
                    assert!((pixel[axis] as f64 - centre).abs() <= 0.5 + 1e-9, "{source:?} ({x}, {y})");
                    assert!((-0.5..source[axis] as f64 - 0.5).contains(&centre), "{source:?} ({x}, {y})");
                }
                pixel
            })
            .collect();
        assert_eq!(taken.len(), panel[0] * panel[1], "{source:?}");
    }
}

/// Samples that tell their place by their colour, and move by `velocity`.
fn marked(width: usize, height: usize, margin: update::Margin, velocity: [f64; 3]) -> Update {
    let cell = |index: usize| Sample {
        colour: [(index % width) as u8, (index / width) as u8, 0],
        velocity,
        acceleration: velocity.map(|velocity| velocity / 4.0),
        depth: 0.5,
        ..Sample::default()
    };
    let samples = (0..width * height).map(cell).collect();
    Update { width, height, margin, samples, depth_kind: DepthKind::Z, overlay: None }
}

#[test]
fn the_margin_is_left_out_and_unknown_motion_leaves_the_colour() {
    let mut marked = marked(20, 12, update::Margin { left: 3, right: 1, top: 2, bottom: 2 }, [2.0, -1.0, 0.25]);
    marked.samples[(2 + 2) * 20 + 3].known = Known::ColourOnly;
    // The display has 16 x 8 pixels, two a cell.
    let galpixels = update(&marked, 8, 4);
    assert_eq!(galpixels.len(), 32);
    assert_eq!(galpixels[0].colour, [3, 2, 0]);
    assert_eq!(galpixels[31].colour, [17, 8, 0]);
    assert_eq!(galpixels[31].velocity.map(|velocity| velocity.to_num::<f64>()), [1.0, -0.5, 0.25]);
    assert_eq!(galpixels[31].acceleration.map(|velocity| velocity.to_num::<f64>()), [0.25, -0.125, 0.0625]);
    let unknown = Galpixel { class: Class::Empty, colour: [3, 4, 0], ..Galpixel::default() };
    assert_eq!(galpixels[8], unknown);
    assert_eq!(update(&marked, 8, 0), []);
}

#[test]
fn a_coarse_source_becomes_squares_of_cells() {
    let galpixels = update(&marked(4, 4, update::Margin::default(), [1.0, 0.0, 0.0]), 8, 8);
    for (index, galpixel) in galpixels.iter().enumerate() {
        assert_eq!(galpixel.colour, [(index % 8 / 2) as u8, (index / 8 / 2) as u8, 0]);
        assert_eq!(galpixel.velocity[0], 2);
    }
}

#[test]
fn a_scene_of_the_panels_size_is_its_own_update() {
    let drift = crate::source::scene::find("drift").unwrap();
    let (width, height) = (drift.width(), drift.height());
    assert_eq!(scene(drift, 3.0, width, height), update(&crate::source::scene::update(drift, 3.0), width, height));
}

/// Returns the largest error of the places of a scene's galpixels after 16 frames of a panel, in cells, what is
/// certified, and the galpixels left.
fn worst<P: Panel>(name: &str) -> (f64, f64, usize) {
    const FRAMES: u32 = 16;
    let source = crate::source::scene::find(name).unwrap();
    let (width, height) = (P::WIDTH as usize, P::HEIGHT as usize);
    let fit = Fit::new([source.width(), source.height()], [width, height]).unwrap();
    let origin = fit.centre(0, 0);
    let (mut worst, mut left) = (0.0f64, 0);
    after::<P>(&scene(source, 0.0, width, height), FRAMES, |[x, y], place| {
        let [i, j] = fit.centre(x, y);
        let track = source.track(i, j, 0.0, f64::from(FRAMES));
        for axis in 0..2 {
            worst = worst.max((place[axis] - (track[axis] - origin[axis]) / fit.scale()).abs());
        }
        left += 1;
    });
    let acceleration = P::RECORD.acceleration(0).present();
    let certified = [0, 1]
        .map(|axis| Certificate::of(&P::RECORD.scales[axis], acceleration, Rounding::LowDiscrepancy, FRAMES).total_px);
    (worst, certified[0].max(certified[1]), left)
}

#[test]
fn galpixels_are_where_the_panels_bits_are_certified_to_keep_them() {
    let check = |name: &str, panel: &str, (worst, certified, left): (f64, f64, usize), cells: usize| {
        println!("{name}, {panel}: {worst:.4} cells after 16 frames, certified {certified:.4}; {left} of {cells} left");
        assert!(worst <= certified, "{name}, {panel}: {worst} cells, certified {certified}");
        assert!(left > cells / 2, "{name}, {panel}: {left} of {cells}");
    };
    // Scenes without acceleration for the panel without it.
    for name in ["still", "drift"] {
        check(name, "oled", worst::<Oled>(name), Oled::CELLS);
    }
    for name in ["still", "drift", "pan", "crossing"] {
        check(name, "lcd", worst::<Lcd>(name), Lcd::CELLS);
    }
}
