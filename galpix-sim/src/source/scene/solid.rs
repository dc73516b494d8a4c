//! Surfaces in space, seen in perspective by a moving eye: planes, globes and columns.
//!
//! World coordinates: x to the right, y down, z away from the viewer; the eye looks along z and never turns. A move of
//! the eye along x and y leaves every image second order in time; one along z does not.

use super::jet::{Jet, Path};
use super::surface::{Hit, Paint, Point, Shape, Surface};
use super::texture::Rgb;

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Returns `start + distance * direction`.
fn along(start: Vector, distance: f64, direction: Vector) -> Vector {
    [0, 1, 2].map(|i| start[i] + distance * direction[i])
}

/// Returns where a ray meets a body: the real roots of `a s² - 2 b s + c = 0` for positive `a`, the nearer one first.
fn roots(a: f64, b: f64, c: f64) -> Option<[f64; 2]> {
    let discriminant = b * b - a * c;
    (discriminant >= 0.0).then(|| [(b - discriminant.sqrt()) / a, (b + discriminant.sqrt()) / a])
}

/// A pinhole camera.
pub struct Lens {
    /// Focal length, pixels.
    pub focal: f64,
    /// Where the optical axis meets the display, pixels.
    pub centre: [f64; 2],
    /// Distance of normalised depth 0; nothing nearer is seen.
    pub near: f64,
    /// The eye's way through the world.
    pub eye: [Path; 3],
}

impl Lens {
    fn eye(&self, t: f64) -> Vector {
        [self.eye[0].value(t), self.eye[1].value(t), self.eye[2].value(t)]
    }

    /// Returns the direction of view through a display position, scaled to z = 1: distances along it are depths.
    fn ray(&self, x: f64, y: f64) -> Vector {
        [(x - self.centre[0]) / self.focal, (y - self.centre[1]) / self.focal, 1.0]
    }

    /// Returns the normalised depth at distance `z`; none in front of the near plane, none where the distance is
    /// infinite or undefined.
    fn depth(&self, z: f64) -> Option<f64> {
        (z >= self.near && z.is_finite()).then(|| 1.0 - self.near / z)
    }

    /// Display position and normalised depth of a point of the world.
    fn project(&self, world: [Jet; 3], t: Jet) -> [Jet; 3] {
        let [x, y, z] = [0, 1, 2].map(|i| world[i] - self.eye[i].at(t));
        [x / z * self.focal + self.centre[0], y / z * self.focal + self.centre[1], Jet::constant(-self.near) / z + 1.0]
    }
}

/// A part of a plane. Points: `[u, v, 0]`, in world units along the two axes.
pub struct Plane {
    /// What it is seen through.
    pub lens: &'static Lens,
    /// The world's place of u = v = 0.
    pub origin: Vector,
    /// Unit vector of u.
    pub u: Vector,
    /// Unit vector of v, at right angles to u.
    pub v: Vector,
    /// Which (u, v) belong to it.
    pub shape: Shape,
    /// Colour of (u, v).
    pub paint: Paint,
}

impl Surface for Plane {
    fn hit(&self, x: f64, y: f64, t: f64) -> Option<Hit> {
        let [u, v] = [self.u, self.v];
        let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let (eye, ray) = (self.lens.eye(t), self.lens.ray(x, y));
        // A ray along the plane divides by zero; `depth` refuses what comes of it.
        let z = dot(normal, minus(self.origin, eye)) / dot(normal, ray);
        let depth = self.lens.depth(z)?;
        let place = minus(along(eye, z, ray), self.origin);
        let (u, v) = (dot(place, u), dot(place, v));
        (self.shape)(u, v).then_some(Hit { point: [u, v, 0.0], depth })
    }

    fn place(&self, [u, v, _]: Point, t: Jet) -> [Jet; 3] {
        self.lens.project(along(along(self.origin, u, self.u), v, self.v).map(Jet::constant), t)
    }

    fn colour(&self, [u, v, _]: Point) -> Rgb {
        (self.paint)(u, v)
    }
}

/// A sphere that moves without turning. Points: the outward unit normal.
pub struct Globe {
    /// What it is seen through.
    pub lens: &'static Lens,
    /// The way of its centre through the world.
    pub centre: [Path; 3],
    /// World units.
    pub radius: f64,
    /// Colour by outward unit normal.
    pub paint: fn(Vector) -> Rgb,
}

impl Globe {
    fn meet(&self, [x, y]: [f64; 2], t: f64, back: bool) -> Option<Hit> {
        let centre = [self.centre[0].value(t), self.centre[1].value(t), self.centre[2].value(t)];
        let (eye, ray) = (self.lens.eye(t), self.lens.ray(x, y));
        let to_centre = minus(centre, eye);
        let reach = dot(to_centre, to_centre) - self.radius * self.radius;
        let z = roots(dot(ray, ray), dot(ray, to_centre), reach)?[usize::from(back)];
        let depth = self.lens.depth(z)?;
        let point = minus(along(eye, z, ray), centre).map(|offset| offset / self.radius);
        Some(Hit { point, depth })
    }
}

impl Surface for Globe {
    fn hit(&self, x: f64, y: f64, t: f64) -> Option<Hit> {
        self.meet([x, y], t, false)
    }

    fn behind(&self, x: f64, y: f64, t: f64) -> Option<Hit> {
        self.meet([x, y], t, true)
    }

    fn place(&self, normal: Point, t: Jet) -> [Jet; 3] {
        self.lens.project([0, 1, 2].map(|i| self.centre[i].at(t) + self.radius * normal[i]), t)
    }

    fn colour(&self, normal: Point) -> Rgb {
        (self.paint)(normal)
    }
}

/// An upright round column. Points: `[nx, y, nz]`, the horizontal unit normal and the world's height.
pub struct Column {
    /// What it is seen through.
    pub lens: &'static Lens,
    /// x and z of its axis, world units.
    pub axis: [f64; 2],
    /// World units.
    pub radius: f64,
    /// Smallest (upper) and largest (lower) y, world units.
    pub reach: [f64; 2],
    /// Colour by point.
    pub paint: fn(Vector) -> Rgb,
}

impl Column {
    fn meet(&self, [x, y]: [f64; 2], t: f64, back: bool) -> Option<Hit> {
        let (eye, ray) = (self.lens.eye(t), self.lens.ray(x, y));
        let (dx, dz) = (self.axis[0] - eye[0], self.axis[1] - eye[2]);
        let outside = dx * dx + dz * dz - self.radius * self.radius;
        let z = roots(ray[0] * ray[0] + 1.0, ray[0] * dx + dz, outside)?[usize::from(back)];
        let depth = self.lens.depth(z)?;
        let place = along(eye, z, ray);
        let [nx, nz] = [(place[0] - self.axis[0]) / self.radius, (place[2] - self.axis[1]) / self.radius];
        (self.reach[0] <= place[1] && place[1] <= self.reach[1]).then_some(Hit { point: [nx, place[1], nz], depth })
    }
}

impl Surface for Column {
    fn hit(&self, x: f64, y: f64, t: f64) -> Option<Hit> {
        self.meet([x, y], t, false)
    }

    fn behind(&self, x: f64, y: f64, t: f64) -> Option<Hit> {
        self.meet([x, y], t, true)
    }

    fn place(&self, [nx, y, nz]: Point, t: Jet) -> [Jet; 3] {
        let world = [self.axis[0] + self.radius * nx, y, self.axis[1] + self.radius * nz];
        self.lens.project(world.map(Jet::constant), t)
    }

    fn colour(&self, point: Point) -> Rgb {
        (self.paint)(point)
    }
}
