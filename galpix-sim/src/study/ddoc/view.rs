//! Pinhole cameras that look along z, and the triangles that they see.

/// A place of the world: x to the right, y down, z away from the reference eye, which is at the origin.
pub type Place = [f64; 3];

/// Red, green and blue, 0 to 255.
pub type Colour = [f32; 3];

/// A corner of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Where it is.
    pub place: Place,
    /// What colour it has.
    pub colour: Colour,
}

impl Corner {
    /// Returns the point at `share` of the way to `other`.
    #[must_use]
    pub fn towards(&self, other: &Self, share: f64) -> Self {
        let place = [0, 1, 2].map(|i| self.place[i] + (other.place[i] - self.place[i]) * share);
        let colour = [0, 1, 2].map(|i| self.colour[i] + (other.colour[i] - self.colour[i]) * share as f32);
        Self { place, colour }
    }
}

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where it is.
    pub eye: Place,
    /// Focal length, pixels.
    pub focal: f64,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl View {
    /// Creates a camera whose field of view is `degrees` wide.
    #[must_use]
    pub fn new(eye: Place, width: usize, height: usize, degrees: f64) -> Self {
        Self { eye, focal: 0.5 * width as f64 / (0.5 * degrees).to_radians().tan(), width, height }
    }

    /// Creates the reference view: at the origin, 90 by 90 degrees.
    #[must_use]
    pub fn reference(size: usize) -> Self {
        Self::new([0.0; 3], size, size, 90.0)
    }

    /// Returns where the optical axis meets the picture; pixels have their middles at whole numbers.
    #[must_use]
    pub fn centre(&self) -> [f64; 2] {
        [0.5 * (self.width as f64 - 1.0), 0.5 * (self.height as f64 - 1.0)]
    }

    /// Returns the pixel and distance of a place in front of the eye.
    #[must_use]
    pub fn project(&self, place: Place) -> [f64; 3] {
        let [x, y, z] = [0, 1, 2].map(|i| place[i] - self.eye[i]);
        let [centre_u, centre_v] = self.centre();
        [x / z * self.focal + centre_u, y / z * self.focal + centre_v, z]
    }

    /// The place that is seen at a pixel at distance `z`.
    #[must_use]
    pub fn unproject(&self, [u, v]: [f64; 2], z: f64) -> Place {
        let [centre_u, centre_v] = self.centre();
        let [x, y] = [u - centre_u, v - centre_v].map(|from_axis| from_axis / self.focal * z);
        [self.eye[0] + x, self.eye[1] + y, self.eye[2] + z]
    }

    /// The parts of a triangle that are at least `nearest` away along the axis, as up to two triangles.
    pub fn in_front(&self, corners: &[Corner; 3], nearest: f64, mut draw: impl FnMut(&[Corner; 3])) {
        let away = |corner: &Corner| corner.place[2] - self.eye[2] - nearest;
        let behind = corners.iter().filter(|corner| away(corner) < 0.0).count();
        if behind == 0 {
            return draw(corners);
        }
        if behind == 3 {
            return;
        }
        let mut kept = Vec::with_capacity(4);
        for (i, from) in corners.iter().enumerate() {
            let to = &corners[(i + 1) % 3];
            let (a, b) = (away(from), away(to));
            if a >= 0.0 {
                kept.push(*from);
            }
            if (a < 0.0) != (b < 0.0) {
                kept.push(from.towards(to, a / (a - b)));
            }
        }
        for pair in kept[1..].windows(2) {
            draw(&[kept[0], pair[0], pair[1]]);
        }
    }
}
