//! Push-pull in floats as one would write it first: what others are compared with.

/// Red, green, blue, and how much is known, 0 or 1.
pub type Pixel = [f32; 4];

/// A level: columns, rows, pixels.
struct Level {
    width: usize,
    height: usize,
    pixels: Vec<Pixel>,
}

/// The levels above a picture, kept from call to call.
pub struct Textbook {
    levels: Vec<Level>,
}

impl Textbook {
    /// Makes levels for pictures of `width` x `height`.
    pub fn new(width: usize, height: usize) -> Self {
        let mut levels = vec![Level { width, height, pixels: vec![[0.0; 4]; width * height] }];
        while let Some(Level { width, height, .. }) = levels.last()
            && (*width > 1 || *height > 1)
        {
            let (width, height) = (width.div_ceil(2), height.div_ceil(2));
            levels.push(Level { width, height, pixels: vec![[0.0; 4]; width * height] });
        }
        Self { levels }
    }

    /// Fills what is not known: all levels up by the mean of what is known, all levels down by linear interpolation.
    pub fn fill(&mut self, picture: &[Pixel]) -> &[Pixel] {
        self.levels[0].pixels.copy_from_slice(picture);
        for number in 1..self.levels.len() {
            let (below, above) = self.levels.split_at_mut(number);
            pull(&below[number - 1], &mut above[0]);
        }
        for number in (0..self.levels.len() - 1).rev() {
            let (below, above) = self.levels.split_at_mut(number + 1);
            push(&above[0], &mut below[number]);
        }
        &self.levels[0].pixels
    }
}

fn pull(fine: &Level, coarse: &mut Level) {
    for y in 0..coarse.height {
        for x in 0..coarse.width {
            let mut sum = [0.0; 4];
            for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let (x, y) = (2 * x + dx, 2 * y + dy);
                if x < fine.width && y < fine.height {
                    let pixel = fine.pixels[y * fine.width + x];
                    for (sum, channel) in sum.iter_mut().zip([pixel[0], pixel[1], pixel[2], 1.0]) {
                        *sum += channel * pixel[3];
                    }
                }
            }
            let by = if sum[3] > 0.0 { 1.0 / sum[3] } else { 0.0 };
            coarse.pixels[y * coarse.width + x] = [sum[0] * by, sum[1] * by, sum[2] * by, sum[3].min(1.0)];
        }
    }
}

fn push(coarse: &Level, fine: &mut Level) {
    for y in 0..fine.height {
        for x in 0..fine.width {
            let pixel = fine.pixels[y * fine.width + x];
            if pixel[3] >= 1.0 {
                continue;
            }
            let neighbour =
                |at: usize, size: usize| if at % 2 == 1 { (at / 2 + 1).min(size - 1) } else { (at / 2).max(1) - 1 };
            let (near_x, near_y) = (x / 2, y / 2);
            let (far_x, far_y) = (neighbour(x, coarse.width), neighbour(y, coarse.height));
            let mut from_above = [0.0; 3];
            for (x, y, weight) in
                [(near_x, near_y, 9.0), (far_x, near_y, 3.0), (near_x, far_y, 3.0), (far_x, far_y, 1.0)]
            {
                let coarse = coarse.pixels[y * coarse.width + x];
                for (sum, channel) in from_above.iter_mut().zip(coarse) {
                    *sum += channel * weight / 16.0;
                }
            }
            let known = pixel[3];
            let mix = |channel: usize| pixel[channel] * known + from_above[channel] * (1.0 - known);
            fine.pixels[y * fine.width + x] = [mix(0), mix(1), mix(2), 1.0];
        }
    }
}
