//! The noise is white, its bands have the deviations that are stated, and it has a place.

extern crate std;
use std::vec::Vec;

use super::*;
use crate::inpaint::metamer::steerable::response;

const SIDE: i32 = 256;

fn bands(x: i32, y: i32, level: u32, channel: usize) -> [i16; 2] {
    response(&core::array::from_fn(|j| {
        core::array::from_fn(|i| white(x + i as i32 - 2, y + j as i32 - 2, level, 5)[channel])
    }))
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let products: Vec<f64> = a.iter().zip(b).map(|(a, b)| a * b).collect();
    let squares = |values: &[f64]| mean(&values.iter().map(|value| value * value).collect::<Vec<_>>());
    mean(&products) / (squares(a) * squares(b)).sqrt()
}

#[test]
fn white_noise_is_white() {
    for channel in 0..3 {
        let at = |dx: i32, dy: i32, level: u32, channel: usize| -> Vec<f64> {
            let cell = |i: i32| f64::from(white(i % SIDE + dx, i / SIDE + dy, level, 5)[channel]);
            (0..SIDE * SIDE).map(cell).collect()
        };
        let own = at(0, 0, 0, channel);
        assert!(mean(&own).abs() < 10.0);
        for (dx, dy) in [(1, 0), (0, 1), (1, 1), (-1, 1), (2, 0), (0, 2), (5, 3)] {
            assert!(correlation(&own, &at(dx, dy, 0, channel)).abs() < 0.02, "{channel} {dx} {dy}");
        }
        assert!(correlation(&own, &at(0, 0, 1, channel)).abs() < 0.02);
        assert!(correlation(&own, &at(0, 0, 0, (channel + 1) % 3)).abs() < 0.02);
    }
    let mut counts = [0; 256];
    for i in 0..SIDE * SIDE {
        counts[((white(i % SIDE, i / SIDE, 2, 9)[1] + LARGEST) / 8) as usize] += 1;
    }
    assert!(counts.iter().all(|count| (150..=370).contains(count)), "{counts:?}");
}

#[test]
fn bands_have_the_stated_mean_and_deviation_and_differ() {
    for channel in 0..3 {
        let responses: Vec<[i16; 2]> = (0..SIDE * SIDE).map(|i| bands(i % SIDE, i / SIDE, 3, channel)).collect();
        let scaled = |scale: Scale, band: usize| -> Vec<f64> {
            responses.iter().map(|bands| f64::from(scale.scaled(bands[band])) / 1024.0).collect()
        };
        for (scale, deviation) in [(Scale::Deviation, 1.0), (Scale::Interval, 0.2384)] {
            for band in 0..2 {
                let values = scaled(scale, band);
                let measured = mean(&values.iter().map(|value| value * value).collect::<Vec<_>>()).sqrt();
                assert!(mean(&values).abs() < 0.01 * deviation);
                assert!((measured / deviation - 1.0).abs() < 0.01, "{scale:?} {measured}");
                let most = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
                assert!(scale == Scale::Deviation || most <= 1.0);
            }
        }
        // Both kernels hold on to the middle: 186^2 / (518 134) they have in common, as they have in white pictures.
        let common = correlation(&scaled(Scale::Deviation, 0), &scaled(Scale::Deviation, 1));
        assert!((common - 0.498).abs() < 0.02, "{common}");
    }
    assert_eq!(Scale::Interval.scaled(LARGEST_RESPONSE), 1024);
    assert_eq!(Scale::Interval.scaled(-LARGEST_RESPONSE), -1024);
}

#[test]
fn a_tile_is_the_noise_of_its_places_wherever_it_begins() {
    let mut tiles = [[[0; COLUMNS]; ROWS]; 3];
    for (x, y) in [(0, 0), (-3, 700), (i32::MAX - 5, i32::MIN)] {
        white_tile(x, y, 2, 8, &mut tiles);
        for place in 0..ROWS * COLUMNS {
            let (i, j) = (place % COLUMNS, place / COLUMNS);
            let expected = white(x.wrapping_add(i as i32), y.wrapping_add(j as i32), 2, 8);
            assert_eq!(tiles.map(|cells| cells[j][i]), expected);
        }
    }
}
