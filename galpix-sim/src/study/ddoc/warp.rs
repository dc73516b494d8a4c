//! A reference image from another view (section 5): its samples as a mesh, cut where the depth is discontinuous.

use super::reference::Reference;
use super::view::View;
use crate::source::ddoc::raster::{Pin, Raster};

/// What decides which neighbouring samples are one surface.
#[derive(Clone, Copy, Debug)]
pub struct Joint {
    /// The inverse distance may change by this much from a pixel of the plain image to the next.
    pub step: f32,
    /// Neighbours may have been this far apart in the plain image, pixels: what is squeezed by twice the asymmetry, and
    /// a little more.
    pub reach: f32,
}

/// Returns the frame of `view` made from the samples of `reference`: red, green, blue.
#[must_use]
pub fn warp(reference: &Reference, view: &View, joint: &Joint) -> Raster<3> {
    let Reference { raster, near, .. } = reference;
    let (width, height) = (raster.width, raster.height);
    let mut frame = Raster::new(view.width, view.height);
    let undistorted = |index: usize| {
        let [_, _, _, x, y] = raster.carried[index];
        [(index % width) as f32 - x, (index / width) as f32 - y]
    };
    let pins: Vec<Option<Pin<3>>> = (0..width * height)
        .map(|index| {
            let nearness = f64::from(raster.nearness[index]);
            if nearness <= 0.0 {
                return None;
            }
            let place = reference.view.unproject(undistorted(index).map(f64::from), near / nearness);
            let [u, v, z] = view.project(place);
            let [red, green, blue, ..] = raster.carried[index];
            // What is behind the eye, or almost there, is not seen.
            (z > 0.05 * near).then(|| Pin { at: [u, v], nearness: near / z, carried: [red, green, blue] })
        })
        .collect();
    let joined = |a: usize, b: usize| {
        let (from, to) = (undistorted(a), undistorted(b));
        let apart = (from[0] - to[0]).abs().max((from[1] - to[1]).abs());
        let step = (raster.nearness[a] - raster.nearness[b]).abs();
        apart <= joint.reach && step <= joint.step * apart.max(1.0)
    };
    // Where the mesh is cut, a sample goes on to the border of its pixel: half a pixel of the plain image.
    let neighbours = |x: usize, y: usize, index: usize| {
        [
            (x > 0).then(|| index - 1),
            (x + 1 < width).then_some(index + 1),
            (y > 0).then(|| index - width),
            (y + 1 < height).then_some(index + width),
        ]
    };
    for (index, of) in pins.iter().enumerate() {
        let Some(of) = of else { continue };
        if neighbours(index % width, index / width, index).into_iter().flatten().all(|other| joined(index, other)) {
            continue;
        }
        let z = near / f64::from(raster.nearness[index]);
        let [u, v] = undistorted(index).map(f64::from);
        let corner = |[x, y]: [f64; 2]| {
            let [u, v, z] = view.project(reference.view.unproject([u + x, v + y], z));
            Pin { at: [u, v], nearness: near / z, carried: of.carried }
        };
        let [a, b, c, d] = [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]].map(corner);
        frame.draw([&a, &b, &c]);
        frame.draw([&b, &d, &c]);
    }
    let mut triangle = |of: [usize; 3]| {
        if let [Some(a), Some(b), Some(c)] = of.map(|index| &pins[index])
            && joined(of[0], of[1])
            && joined(of[1], of[2])
            && joined(of[2], of[0])
        {
            frame.draw([a, b, c]);
        }
    };
    for y in 0..height - 1 {
        for x in 0..width - 1 {
            let a = y * width + x;
            let (b, c, d) = (a + 1, a + width, a + width + 1);
            // Both diagonals are tried, so that a quad of which one corner lies elsewhere keeps the other three.
            if joined(a, d) {
                triangle([a, b, d]);
                triangle([a, d, c]);
            } else {
                triangle([a, b, c]);
                triangle([b, d, c]);
            }
        }
    }
    frame
}
