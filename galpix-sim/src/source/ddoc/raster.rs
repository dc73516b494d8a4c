//! Triangles into pixels, with a z-buffer.

/// A corner of a triangle in a picture, and what it carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin<const N: usize> {
    /// Column and row; pixels have their middles at whole numbers.
    pub at: [f64; 2],
    /// Inverse distance: the larger, the nearer. Linear across a triangle.
    pub nearness: f64,
    /// What is interpolated over the triangle, in perspective.
    pub carried: [f32; N],
}

/// A picture with depth, and `N` numbers per pixel.
#[derive(Clone, Debug)]
pub struct Raster<const N: usize> {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Inverse distance, row by row; 0 where nothing is.
    pub nearness: Vec<f32>,
    /// What the pixels carry.
    pub carried: Vec<[f32; N]>,
}

impl<const N: usize> Raster<N> {
    /// Creates an empty picture.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, nearness: vec![0.0; width * height], carried: vec![[0.0; N]; width * height] }
    }

    /// Draws a triangle: the pixels whose middles are in it or on its border, where nothing as near has been drawn
    /// before. A triangle without an area, or with a place that is no number, is nothing.
    pub fn draw(&mut self, [a, b, c]: [&Pin<N>; 3]) {
        let across = |axis: usize| {
            let [a, b, c] = [a.at[axis], b.at[axis], c.at[axis]];
            (a.min(b).min(c), a.max(b).max(c))
        };
        let ((left, right), (top, bottom)) = (across(0), across(1));
        // `as` saturates: what is left of the picture starts at 0.
        let (first_x, first_y) = (left.ceil().max(0.0) as usize, top.ceil().max(0.0) as usize);
        let begins = right >= 0.0 && bottom >= 0.0;
        if !begins {
            return;
        }
        let end = |last: f64| (last.floor() as usize).saturating_add(1);
        let (end_x, end_y) = (self.width.min(end(right)), self.height.min(end(bottom)));
        if first_x >= end_x || first_y >= end_y {
            return;
        }
        let edge = |from: &Pin<N>, to: &Pin<N>, x: f64, y: f64| {
            (to.at[0] - from.at[0]) * (y - from.at[1]) - (to.at[1] - from.at[1]) * (x - from.at[0])
        };
        let area = edge(a, b, c.at[0], c.at[1]);
        let has_area = area.abs() > 1e-12;
        if !has_area {
            return;
        }
        let inverse = 1.0 / area;
        for y in first_y..end_y {
            for x in first_x..end_x {
                let (at_x, at_y) = (x as f64, y as f64);
                let weights = [edge(b, c, at_x, at_y), edge(c, a, at_x, at_y), edge(a, b, at_x, at_y)];
                let weights = weights.map(|weight| weight * inverse);
                // A hair beyond the border, so that no pixel between two triangles is lost by rounding.
                if weights.iter().any(|&weight| weight < -1e-9) {
                    continue;
                }
                let shares = [weights[0] * a.nearness, weights[1] * b.nearness, weights[2] * c.nearness];
                let nearness = shares[0] + shares[1] + shares[2];
                let index = y * self.width + x;
                if nearness as f32 > self.nearness[index] {
                    self.nearness[index] = nearness as f32;
                    let shares = shares.map(|share| (share / nearness) as f32);
                    self.carried[index] = std::array::from_fn(|i| {
                        shares[0] * a.carried[i] + shares[1] * b.carried[i] + shares[2] * c.carried[i]
                    });
                }
            }
        }
    }
}
