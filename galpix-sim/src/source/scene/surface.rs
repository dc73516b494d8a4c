//! What scenes are built of. A [`Surface`] knows two things, each the inverse of the other: which of its points is seen
//! through a place of the display ([`Surface::hit`]), and where such a point is at any time ([`Surface::place`]).

use super::jet::{Jet, Path};
use super::texture::Rgb;

/// A point of a surface in the surface's own coordinates, which do not change as the surface moves.
pub type Point = [f64; 3];

/// What is met when looking at a surface.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// The point of the surface that is seen.
    pub point: Point,
    /// Its normalised depth.
    pub depth: f64,
}

/// One rigid, opaque, coloured object of a scene.
pub trait Surface: Sync {
    /// Returns the point seen at display position (`x`, `y`) (pixels) at `t` (frames), if the surface is there.
    fn hit(&self, x: f64, y: f64, t: f64) -> Option<Hit>;

    /// Returns the point of the back that would be seen at the same place if the front were not there; only solid
    /// bodies have a back.
    fn behind(&self, _x: f64, _y: f64, _t: f64) -> Option<Hit> {
        None
    }

    /// Returns where `point` is at `t`: x and y in pixels, normalised depth; with derivatives if `t` has them.
    fn place(&self, point: Point, t: Jet) -> [Jet; 3];

    /// Returns the colour of `point` at the update, t = 0.
    fn colour(&self, point: Point) -> Rgb;

    /// Change of the luminosity of `point`: code values per frame, added to each of the three channels.
    fn luminosity_rate(&self, _point: Point) -> f64 {
        0.0
    }
}

/// Colour as a function of the place on a surface.
pub type Paint = fn(f64, f64) -> Rgb;
/// Which places on an unbounded plane belong to the surface.
pub type Shape = fn(f64, f64) -> bool;

/// Returns the shape of a surface that has no border.
#[must_use]
pub fn everywhere(_u: f64, _v: f64) -> bool {
    true
}

/// A flat cut-out that faces the viewer, as on a stage: it is shifted and turned, one unit of it is always one pixel.
/// Its place is second order in time exactly as long as it does not turn.
pub struct Card {
    /// Display position of the card's origin, pixels.
    pub origin: [Path; 2],
    /// Normalised depth.
    pub depth: Path,
    /// Turn about the origin, radians, from x towards y.
    pub angle: Path,
    /// Cut of the card, in pixels from the origin.
    pub shape: Shape,
    /// Colour, in pixels from the origin.
    pub paint: Paint,
    /// Change of luminosity (code values per frame), in pixels from the origin.
    pub rate: fn(f64, f64) -> f64,
}

impl Card {
    /// A card that is shifted along `origin` at a constant `depth`; it neither turns nor changes its luminosity.
    #[must_use]
    pub const fn new(origin: [Path; 2], depth: f64, shape: Shape, paint: Paint) -> Self {
        Self { origin, depth: Path::still(depth), angle: Path::still(0.0), shape, paint, rate: |_, _| 0.0 }
    }

    /// Creates a card that never moves, its origin at the top left corner of the display.
    #[must_use]
    pub const fn still(depth: f64, shape: Shape, paint: Paint) -> Self {
        Self::new([Path::still(0.0), Path::still(0.0)], depth, shape, paint)
    }
}

impl Surface for Card {
    fn hit(&self, x: f64, y: f64, t: f64) -> Option<Hit> {
        let (sin, cos) = self.angle.value(t).sin_cos();
        let (dx, dy) = (x - self.origin[0].value(t), y - self.origin[1].value(t));
        let (u, v) = (cos * dx + sin * dy, cos * dy - sin * dx);
        (self.shape)(u, v).then(|| Hit { point: [u, v, 0.0], depth: self.depth.value(t) })
    }

    fn place(&self, [u, v, _]: Point, t: Jet) -> [Jet; 3] {
        let (sin, cos) = self.angle.at(t).sin_cos();
        [self.origin[0].at(t) + cos * u - sin * v, self.origin[1].at(t) + sin * u + cos * v, self.depth.at(t)]
    }

    fn colour(&self, [u, v, _]: Point) -> Rgb {
        (self.paint)(u, v)
    }

    fn luminosity_rate(&self, [u, v, _]: Point) -> f64 {
        (self.rate)(u, v)
    }
}
