//! The bands share out the highpass, and a picture comes back from its pyramid.

extern crate std;
use std::vec;
use std::vec::Vec;

use super::*;

/// 512 times a kernel's coefficients, measured: its responses to a single cell, so large that no rounding counts.
fn coefficients(band: usize) -> [[i32; 5]; 5] {
    let mut kernel = [[0; 5]; 5];
    for (y, row) in kernel.iter_mut().enumerate() {
        for (x, coefficient) in row.iter_mut().enumerate() {
            let unit = |at: usize| core::array::from_fn::<i16, 5, _>(|i| i16::from(i == at));
            let (down, along) = (unit(y), unit(x));
            let passes =
                if band == 0 { [smoothed(down), sharpened(along)] } else { [sharpened(down), smoothed(along)] };
            *coefficient = i32::from(passes[0]) * i32::from(passes[1]);
        }
    }
    kernel
}

#[test]
fn bands_partition_the_highpass() {
    let b = [1, 4, 6, 4, 1];
    let (across, down) = (coefficients(0), coefficients(1));
    for y in 0..5 {
        for x in 0..5 {
            let delta = if (x, y) == (2, 2) { 512 } else { 0 };
            assert_eq!(across[y][x] + down[y][x], delta - 2 * b[x] * b[y]);
            assert_eq!(across[y][x], down[x][y]);
        }
    }
    for kernel in [across, down] {
        assert_eq!(kernel.as_flattened().iter().sum::<i32>(), 0);
    }
    assert_eq!(across[2], [-22, -88, 220, -88, -22]);
}

#[test]
fn nothing_leaves_sixteen_bits() {
    // Debug assertions watch the sums. The worst signs for one kernel, and for the other.
    for signs in 0..1 << 5 {
        for others in 0..1 << 5 {
            let sign = |bits: i32, at: usize| if bits >> at & 1 == 0 { 1 } else { -1 };
            let window = core::array::from_fn(|y| core::array::from_fn(|x| LARGEST * sign(signs, x) * sign(others, y)));
            for band in response(&window) {
                assert!(band.abs() <= LARGEST_RESPONSE);
            }
        }
    }
    assert_eq!(response(&[[LARGEST; 5]; 5]), [0, 0]);
}

#[test]
fn a_tile_has_the_responses_of_its_cells() {
    let mut state = 1u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 16) as i16 % (LARGEST + 1)
    };
    let cells: Cells = core::array::from_fn(|_| core::array::from_fn(|_| next()));
    let mut tile = [[[0; TILE]; TILE]; 2];
    bands(&cells, &mut tile);
    for y in 0..TILE {
        for x in 0..TILE {
            let window = core::array::from_fn(|j| core::array::from_fn(|i| cells[y + j][x + i]));
            assert_eq!(response(&window), [tile[0][row_of(y)][x], tile[1][row_of(y)][x]]);
        }
    }
}

struct Plane {
    width: i32,
    height: i32,
    cells: Vec<i16>,
}

impl Plane {
    fn new(width: i32, height: i32, cell: impl Fn(i32, i32) -> i16) -> Self {
        let cells = (0..width * height).map(|i| cell(i % width, i / width)).collect();
        Self { width, height, cells }
    }

    /// Beyond the border, the outermost cell.
    fn at(&self, x: i32, y: i32) -> i16 {
        self.cells[(y.clamp(0, self.height - 1) * self.width + x.clamp(0, self.width - 1)) as usize]
    }

    fn halved(&self) -> Self {
        Self::new((self.width + 1) / 2, (self.height + 1) / 2, |x, y| {
            let sum: i16 = [(0, 0), (1, 0), (0, 1), (1, 1)].iter().map(|(i, j)| self.at(2 * x + i, 2 * y + j)).sum();
            (sum + 2) >> 2
        })
    }

    fn doubled(&self, x: i32, y: i32) -> i16 {
        let (side, across) = (2 * (x & 1) - 1, 2 * (y & 1) - 1);
        let at = |i: i32, j: i32| i32::from(self.at((x >> 1) + i, (y >> 1) + j));
        ((9 * at(0, 0) + 3 * (at(side, 0) + at(0, across)) + at(side, across) + 8) >> 4) as i16
    }

    fn window(&self, x: i32, y: i32) -> [[i16; 5]; 5] {
        core::array::from_fn(|j| core::array::from_fn(|i| self.at(x + i as i32 - 2, y + j as i32 - 2)))
    }
}

/// The picture that comes back from the lowpass of `levels` levels and the bands of those below.
fn reconstructed(picture: &Plane, levels: u32) -> Plane {
    if levels == 0 {
        return Plane::new(picture.width, picture.height, |x, y| picture.at(x, y));
    }
    let coarse = reconstructed(&picture.halved(), levels - 1);
    Plane::new(picture.width, picture.height, |x, y| {
        let [across, down] = response(&picture.window(x, y));
        coarse.doubled(x, y) + rounded(across + down, FRACTION_BITS - 2)
    })
}

fn psnr(a: &Plane, b: &Plane) -> f64 {
    let squares: i64 = a.cells.iter().zip(&b.cells).map(|(&a, &b)| i64::from(a - b).pow(2)).sum();
    20.0 * (1020.0 / (squares as f64 / a.cells.len() as f64).sqrt()).log10()
}

#[test]
fn a_picture_comes_back_from_its_pyramid() {
    let noise = |x: i32, y: i32| (crate::inpaint::metamer::noise::white(x, y, 0, 7)[0] / 4) as f64 / 255.0;
    let waves = |x: i32, y: i32| 300.0 * (f64::from(x) / 3.1 + (f64::from(y) / 9.0).sin()).sin();
    let pictures: Vec<(&str, f64, Plane)> = vec![
        // Waves of 20 cells with a fine grain; fine weave; a step; smooth hills.
        ("weave", 26.0, Plane::new(97, 64, |x, y| (waves(x, y) + 20.0 * noise(x, y)) as i16)),
        ("step", 30.0, Plane::new(96, 65, |x, y| if x + y / 3 > 50 { 400 } else { -300 })),
        ("hills", 40.0, Plane::new(64, 64, |x, y| (f64::from(x * y) / 8.0) as i16)),
        ("grain", 20.0, Plane::new(64, 64, |x, y| (120.0 * noise(x, y)) as i16)),
    ];
    for (name, least, picture) in &pictures {
        for levels in 3..=5 {
            let psnr = psnr(picture, &reconstructed(picture, levels));
            std::println!("{name}, {levels} levels: {psnr:.1} dB");
            assert!(psnr > *least, "{name}, {levels} levels: {psnr:.1} dB");
        }
    }
}
