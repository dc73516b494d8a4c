//! What one writes first: a struct of floats a pixel, moved one by one.

use crate::scene::Sample;

/// 40 bytes. A top byte of 0 in the colour means that there is no pixel.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Pixel {
    position: [f32; 3],
    velocity: [f32; 3],
    acceleration: [f32; 3],
    argb: u32,
}

impl From<&Sample> for Pixel {
    fn from(sample: &Sample) -> Self {
        let [red, green, blue] = sample.colour;
        Self {
            position: [sample.offset[0], sample.offset[1], sample.depth],
            velocity: sample.velocity,
            acceleration: sample.acceleration,
            argb: u32::from_be_bytes([255, red, green, blue]),
        }
    }
}

/// Clears the new picture and moves each pixel of the old one there; the nearer wins.
pub fn propagate(old: &[Pixel], new: &mut [Pixel], width: usize, height: usize) {
    new.fill(Pixel::default());
    for y in 0..height {
        for x in 0..width {
            let mut pixel = old[y * width + x];
            if pixel.argb >> 24 == 0 {
                continue;
            }
            for axis in 0..3 {
                pixel.position[axis] += pixel.velocity[axis] + 0.5 * pixel.acceleration[axis];
                pixel.velocity[axis] += pixel.acceleration[axis];
            }
            let (cells_x, cells_y) = ((pixel.position[0] + 0.5).floor(), (pixel.position[1] + 0.5).floor());
            let (to_x, to_y) = (x as i32 + cells_x as i32, y as i32 + cells_y as i32);
            if to_x < 0 || to_y < 0 || to_x >= width as i32 || to_y >= height as i32 {
                continue;
            }
            pixel.position[0] -= cells_x;
            pixel.position[1] -= cells_y;
            let target = &mut new[to_y as usize * width + to_x as usize];
            if target.argb >> 24 == 0 || pixel.position[2] < target.position[2] {
                *target = pixel;
            }
        }
    }
}
