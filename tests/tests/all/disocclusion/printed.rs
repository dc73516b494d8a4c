//! Algorithms 1 and 2 of the supplement as they are printed, line by line.
//!
//! Their y grows upwards; nothing but the names depends on that. What lies beyond the border is taken as the cell at
//! it.

/// Extents to the left, right, top, bottom.
pub type Extents = [i32; 4];
const L: usize = 0;
const R: usize = 1;
const T: usize = 2;
const B: usize = 3;

/// A first layer: depth (larger is farther) and cells moved within the interval.
pub struct Layer {
    pub width: i32,
    pub height: i32,
    pub cells: Vec<(i32, [i32; 2])>,
}

/// Which cell gets the extents of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// The current one, as printed.
    Current,
    /// The nearer one.
    Nearer,
}

impl Layer {
    fn index(&self, x: i32, y: i32) -> usize {
        (x.clamp(0, self.width - 1) + y.clamp(0, self.height - 1) * self.width) as usize
    }

    fn at(&self, x: i32, y: i32) -> (i32, [i32; 2]) {
        self.cells[self.index(x, y)]
    }

    /// Algorithm 1.
    pub fn initialised(&self, owner: Owner) -> Vec<Extents> {
        let mut map = vec![[0; 4]; self.cells.len()];
        for y in 0..self.height {
            for x in 0..self.width {
                let (current, v) = self.at(x, y);
                let (right, of_right) = self.at(x + 1, y);
                let (top, of_top) = self.at(x, y + 1);
                let dx = [of_right[0] - v[0], of_right[1] - v[1]];
                let dy = [of_top[0] - v[0], of_top[1] - v[1]];
                let mut by_x = [0; 4];
                if dx[0] > 0 {
                    if current > right {
                        by_x[R] = dx[0];
                        if dx[1] > 0 { by_x[T] = dx[1] } else { by_x[B] = -dx[1] }
                    } else {
                        by_x[L] = dx[0];
                        if dx[1] < 0 { by_x[T] = -dx[1] } else { by_x[B] = dx[1] }
                    }
                }
                let mut by_y = [0; 4];
                if dy[1] > 0 {
                    if current > top {
                        by_y[T] = dy[1];
                        if dy[0] > 0 { by_y[R] = dy[0] } else { by_y[L] = -dy[0] }
                    } else {
                        by_y[B] = dy[1];
                        if dy[0] < 0 { by_y[R] = -dy[0] } else { by_y[L] = dy[0] }
                    }
                }
                let nearer = owner == Owner::Nearer;
                let of_x = if nearer && current > right { self.index(x + 1, y) } else { self.index(x, y) };
                let of_y = if nearer && current > top { self.index(x, y + 1) } else { self.index(x, y) };
                for (cell, by) in [(of_x, by_x), (of_y, by_y)] {
                    map[cell] = [0, 1, 2, 3].map(|e| map[cell][e].max(by[e]));
                }
            }
        }
        map
    }
}

/// Algorithm 2.
pub fn spread(width: i32, height: i32, map: &[Extents]) -> Vec<Extents> {
    let levels = i32::BITS - (width.max(height) - 1).leading_zeros();
    let mut source = map.to_vec();
    for m in (0..levels).map(|level| 1 << level) {
        let at = |x: i32, y: i32| {
            let inside = (0..width).contains(&x) && (0..height).contains(&y);
            if inside { source[(x + y * width) as usize] } else { [0; 4] }
        };
        let mut target = Vec::new();
        for y in 0..height {
            for x in 0..width {
                let mut spread = at(x, y);
                for (e, [dx, dy]) in [(R, [-m, 0]), (L, [m, 0]), (T, [0, -m]), (B, [0, m])] {
                    spread[e] = spread[e].max(at(x + dx, y + dy)[e] - m);
                }
                for (e, [dx, dy]) in [([R, T], [-m, -m]), ([L, T], [m, -m]), ([R, B], [-m, m]), ([L, B], [m, m])] {
                    let from = at(x + dx, y + dy);
                    if e.iter().all(|&e| from[e] - m > 0) {
                        for e in e {
                            spread[e] = spread[e].max(from[e] - m);
                        }
                    }
                }
                target.push(spread);
            }
        }
        source = target;
    }
    source
}
