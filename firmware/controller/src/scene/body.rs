//! Bodies, and how they move.

use fixed::types::I20F12;

/// A length or a speed with a fraction.
pub type Number = I20F12;

/// What a scene is built of: the first body that covers a place is seen there.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    /// What it is called.
    pub name: &'static str,
    /// From the nearest to the farthest. The last one covers everything.
    pub bodies: &'static [Body],
}

/// A flat body that moves.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// Its shape.
    pub outline: Outline,
    /// What is painted on it.
    pub texture: Texture,
    /// How far away it is, in 16ths of the depth range.
    pub depth: u8,
    /// How it moves, along x and along y.
    pub paths: [Path; 2],
}

/// The shape of a body, about its own centre.
#[derive(Clone, Copy, Debug)]
pub enum Outline {
    /// Everywhere.
    All,
    /// A disc of this radius.
    Disc(i32),
    /// A rectangle of half this width and half this height.
    Rectangle(i32, i32),
}

/// Two colours in a pattern of squares or bars.
#[derive(Clone, Copy, Debug)]
pub struct Texture {
    /// The pattern.
    pub pattern: Pattern,
    /// Each bar and square is 2 to this power wide, in units.
    pub size_log2: u32,
    /// 8-bit red, green and blue.
    pub colours: [[u8; 3]; 2],
}

/// How two colours take turns.
#[derive(Clone, Copy, Debug)]
pub enum Pattern {
    /// Squares, as on a board.
    Squares,
    /// Upright bars.
    Bars,
    /// Lines of both kinds, thin, on a ground of the first colour.
    Grid,
}

/// Where something is along one axis. It starts anew every `period` frames, there and back by turns if it is
/// `mirrored`.
#[derive(Clone, Copy, Debug)]
pub struct Path {
    /// Where it starts.
    pub start: Number,
    /// How fast it starts.
    pub velocity: Number,
    /// How fast that changes.
    pub acceleration: Number,
    /// Frames until it starts anew; 0 for something that never moves.
    pub period: u32,
    /// Whether each second time it goes the way backwards.
    pub mirrored: bool,
}

/// A body at a time, in cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placed {
    /// Its centre, from the display's centre.
    pub place: [Number; 2],
    /// Cells a frame.
    pub velocity: [Number; 2],
    /// Cells a frame².
    pub acceleration: [Number; 2],
}

impl Path {
    /// Something that stays where it is.
    #[must_use]
    pub const fn still(start: Number) -> Self {
        Self { start, velocity: Number::ZERO, acceleration: Number::ZERO, period: 0, mirrored: false }
    }

    /// Place, velocity and acceleration at frame `t`, in units.
    #[must_use]
    pub fn at(&self, t: u32) -> [Number; 3] {
        if self.period == 0 {
            return [self.start, self.velocity, self.acceleration];
        }
        let (turn, phase) = (t / self.period, t % self.period);
        let back = self.mirrored && turn % 2 == 1;
        let time = Number::from_num(if back { self.period - phase } else { phase });
        let place = self.start + self.velocity * time + self.acceleration * time * time / 2;
        let velocity = self.velocity + self.acceleration * time;
        [place, if back { -velocity } else { velocity }, self.acceleration]
    }
}

impl Body {
    /// Where the body is at frame `t`, on a display with `zoom` cells to the unit.
    #[must_use]
    pub fn at(&self, t: u32, zoom: i32) -> Placed {
        let [x, y] = self.paths.map(|path| path.at(t).map(|number| number * Number::from_num(zoom)));
        Placed { place: [x[0], y[0]], velocity: [x[1], y[1]], acceleration: [x[2], y[2]] }
    }

    /// Which of its two colours is seen at (`x`, `y`), in cells from its centre, if it covers that place.
    #[must_use]
    pub fn seen(&self, [x, y]: [Number; 2], zoom: i32) -> Option<usize> {
        let covered = match self.outline {
            Outline::All => true,
            Outline::Disc(radius) => {
                let (x, y, radius) = (x.to_num::<i32>(), y.to_num::<i32>(), radius * zoom);
                x.abs() <= radius && y.abs() <= radius && x * x + y * y <= radius * radius
            }
            Outline::Rectangle(x_most, y_most) => x.abs() <= x_most * zoom && y.abs() <= y_most * zoom,
        };
        covered.then(|| self.texture.colour_at([x, y], zoom))
    }
}

impl Texture {
    fn colour_at(&self, place: [Number; 2], zoom: i32) -> usize {
        let size = zoom << self.size_log2;
        let line = place.map(|number| number.to_num::<i32>());
        let bar = line.map(|line| line.div_euclid(size));
        let second = match self.pattern {
            Pattern::Squares => (bar[0] ^ bar[1]) & 1,
            Pattern::Bars => bar[0] & 1,
            Pattern::Grid => line.iter().any(|line| line.rem_euclid(size) < zoom).into(),
        };
        second as usize
    }
}
