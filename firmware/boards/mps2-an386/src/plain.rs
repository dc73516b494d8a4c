//! What one writes first, to stand beside the engine: a struct of six numbers a pixel, moved one by one. No
//! acceleration, no motion in depth, no winner map; positions are exact, or as exact as floats are.

/// In integers: position and velocity with 16 fraction bits.
#[derive(Clone, Copy, Default)]
pub struct Fixed {
    /// Place within the cell, x and y.
    pub offset: [i32; 2],
    /// Cells a frame.
    pub velocity: [i32; 2],
    /// Smaller is nearer.
    pub depth: i32,
    /// A top byte of 0: nothing.
    pub argb: u32,
}

/// In floats.
#[derive(Clone, Copy, Default)]
pub struct Float {
    /// Place within the cell, x and y.
    pub offset: [f32; 2],
    /// Cells a frame.
    pub velocity: [f32; 2],
    /// Smaller is nearer.
    pub depth: f32,
    /// A top byte of 0: nothing.
    pub argb: u32,
}

/// Clears the new picture and moves each pixel of the old one there; the nearer wins.
#[inline(never)]
pub fn propagate_fixed(old: &[Fixed], new: &mut [Fixed], width: usize, height: usize) {
    new.fill(Fixed::default());
    for y in 0..height {
        for x in 0..width {
            let mut pixel = old[y * width + x];
            if pixel.argb >> 24 == 0 {
                continue;
            }
            pixel.offset[0] += pixel.velocity[0];
            pixel.offset[1] += pixel.velocity[1];
            let cells = pixel.offset.map(|offset| (offset + 0x8000) >> 16);
            let (to_x, to_y) = (x as i32 + cells[0], y as i32 + cells[1]);
            if to_x < 0 || to_y < 0 || to_x >= width as i32 || to_y >= height as i32 {
                continue;
            }
            pixel.offset[0] -= cells[0] << 16;
            pixel.offset[1] -= cells[1] << 16;
            let target = &mut new[to_y as usize * width + to_x as usize];
            if target.argb >> 24 == 0 || pixel.depth < target.depth {
                *target = pixel;
            }
        }
    }
}

/// The same.
#[inline(never)]
pub fn propagate_float(old: &[Float], new: &mut [Float], width: usize, height: usize) {
    new.fill(Float::default());
    for y in 0..height {
        for x in 0..width {
            let mut pixel = old[y * width + x];
            if pixel.argb >> 24 == 0 {
                continue;
            }
            pixel.offset[0] += pixel.velocity[0];
            pixel.offset[1] += pixel.velocity[1];
            let cells = pixel.offset.map(nearest);
            let (to_x, to_y) = (x as i32 + cells[0], y as i32 + cells[1]);
            if to_x < 0 || to_y < 0 || to_x >= width as i32 || to_y >= height as i32 {
                continue;
            }
            pixel.offset[0] -= cells[0] as f32;
            pixel.offset[1] -= cells[1] as f32;
            let target = &mut new[to_y as usize * width + to_x as usize];
            if target.argb >> 24 == 0 || pixel.depth < target.depth {
                *target = pixel;
            }
        }
    }
}

/// The nearest whole number.
fn nearest(number: f32) -> i32 {
    (if number < 0.0 { number - 0.5 } else { number + 0.5 }) as i32
}
