//! The same scheme in 32-bit floats: what one would build without a bit budget. It is meant to be a fair opponent.
//!
//! A pixel is a packed struct of exactly the fields that it needs (24 bytes with velocity in x and y, 40 with
//! everything but the luminosity); position and velocity take the same step as in the engine, the nearer wins and the
//! smaller source wins a tie, and holes are left black (`none`) or keep what was shown (`hold`). The fill modes that
//! tell surfaces apart are not built.

use std::mem::size_of;

use galpix_core::FillMode;

use super::design::Kept;
use crate::picture::Picture;
use crate::study::timing::Contender;
use crate::update::{Known, Sample, Update};

/// In an origin map: no galpixel of the update.
pub const NO_ORIGIN: u32 = u32::MAX;

/// A pixel with `V` velocities, `A` accelerations and `L` numbers of luminosity (its level's fraction and its rate).
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Pixel<const V: usize, const A: usize, const L: usize> {
    /// From the cell's centre, -1/2 to 1/2.
    offset: [f32; 2],
    depth: f32,
    velocity: [f32; V],
    acceleration: [f32; A],
    light: [f32; L],
    /// The top byte is 0 where there is no pixel, only the colour that is shown.
    argb: u32,
}

/// What a cell shows, and its offset if a pixel is there.
pub type Cell = ([u8; 3], Option<[f32; 2]>);

/// Memory for one map and its follower, for any fields.
pub trait Floats {
    /// Returns the bytes of a pixel.
    fn bytes_per_pixel(&self) -> usize;
    /// Writes an update into the map that is shown.
    fn load(&mut self, update: &Update);
    /// Makes the next frame and shows it; `winners`, if not empty, gets the source of each cell.
    fn step(&mut self, fill_mode: FillMode, winners: &mut [u32]);
    /// Returns every cell of the map.
    fn cells(&self) -> Vec<Cell>;
}

struct Maps<const V: usize, const A: usize, const L: usize> {
    front: Vec<Pixel<V, A, L>>,
    back: Vec<Pixel<V, A, L>>,
    width: usize,
}

/// Returns the maps of a size for some fields; `None` without fields that move.
#[must_use]
pub fn maps(kept: Kept, width: usize, height: usize) -> Option<Box<dyn Floats>> {
    fn new<const V: usize, const A: usize, const L: usize>(width: usize, height: usize) -> Option<Box<dyn Floats>> {
        let blank = vec![Pixel::<V, A, L>::shown(0); width * height];
        Some(Box::new(Maps { front: blank.clone(), back: blank, width }))
    }
    match kept {
        Kept::Still => None,
        Kept::Velocity => new::<2, 0, 0>(width, height),
        Kept::VelocityDepth => new::<3, 0, 0>(width, height),
        Kept::Acceleration => new::<2, 2, 0>(width, height),
        Kept::Full => new::<3, 3, 0>(width, height),
        Kept::Luminosity => new::<3, 3, 2>(width, height),
    }
}

impl<const V: usize, const A: usize, const L: usize> Pixel<V, A, L> {
    /// Creates a hole that shows a colour.
    fn shown(rgb: u32) -> Self {
        Self {
            offset: [0.0; 2],
            depth: 1.0,
            velocity: [0.0; V],
            acceleration: [0.0; A],
            light: [0.0; L],
            argb: rgb & 0x00ff_ffff,
        }
    }

    fn of(sample: &Sample) -> Self {
        let [red, green, blue] = sample.colour;
        let rgb = u32::from_be_bytes([0, red, green, blue]);
        if sample.known == Known::ColourOnly {
            return Self::shown(rgb);
        }
        let mut light = [0.0; L];
        if let Some(rate) = light.get_mut(1) {
            *rate = sample.luminosity_rate as f32;
        }
        Self {
            depth: sample.depth as f32,
            velocity: std::array::from_fn(|axis| sample.velocity[axis] as f32),
            acceleration: std::array::from_fn(|axis| sample.acceleration[axis] as f32),
            light,
            argb: rgb | 0xff00_0000,
            ..Self::shown(rgb)
        }
    }

    #[inline(always)]
    fn present(&self) -> bool {
        self.argb >> 24 != 0
    }

    /// Equations (6) and (7), and the cells moved.
    #[inline(always)]
    fn step(&mut self) -> [i32; 2] {
        let mut cells = [0; 2];
        for (axis, velocity) in self.velocity.iter_mut().enumerate() {
            let a = self.acceleration.get(axis).copied().unwrap_or(0.0);
            let way = *velocity + 0.5 * a;
            if let Some(cells) = cells.get_mut(axis) {
                let position = self.offset[axis] + way;
                let whole = (position + 0.5).floor();
                self.offset[axis] = position - whole;
                *cells = whole as i32;
            } else {
                self.depth = (self.depth + way).clamp(0.0, 1.0);
            }
            *velocity += a;
        }
        if L == 2 {
            let level = self.light[0] + self.light[1];
            let whole = level.floor();
            self.light[0] = level - whole;
            if whole != 0.0 {
                let [alpha, rgb @ ..] = self.argb.to_be_bytes();
                let [r, g, b] = rgb.map(|channel| (i32::from(channel) + whole as i32).clamp(0, 255) as u8);
                self.argb = u32::from_be_bytes([alpha, r, g, b]);
            }
        }
        cells
    }
}

impl<const V: usize, const A: usize, const L: usize> Floats for Maps<V, A, L> {
    fn bytes_per_pixel(&self) -> usize {
        size_of::<Pixel<V, A, L>>()
    }

    fn load(&mut self, update: &Update) {
        for (pixel, sample) in self.front.iter_mut().zip(&update.samples) {
            *pixel = Pixel::of(sample);
        }
    }

    fn step(&mut self, fill_mode: FillMode, winners: &mut [u32]) {
        let (width, height) = (self.width, self.front.len() / self.width.max(1));
        // A hole shows black, or goes on showing what was shown there.
        if fill_mode == FillMode::None {
            self.back.fill(Pixel::shown(0));
        } else {
            for (to, from) in self.back.iter_mut().zip(&self.front) {
                *to = Pixel::shown(from.argb);
            }
        }
        winners.fill(NO_ORIGIN);
        for (y, row) in self.front.chunks_exact(width.max(1)).enumerate() {
            for (x, pixel) in row.iter().enumerate() {
                if !pixel.present() {
                    continue;
                }
                let mut pixel = *pixel;
                let [dx, dy] = pixel.step();
                let (to_x, to_y) = ((x as i32).wrapping_add(dx) as usize, (y as i32).wrapping_add(dy) as usize);
                if to_x >= width || to_y >= height {
                    continue;
                }
                let cell = to_y * width + to_x;
                let incumbent = &mut self.back[cell];
                if !incumbent.present() || pixel.depth < incumbent.depth {
                    *incumbent = pixel;
                    if let Some(winner) = winners.get_mut(cell) {
                        *winner = (y * width + x) as u32;
                    }
                }
            }
        }
        std::mem::swap(&mut self.front, &mut self.back);
    }

    fn cells(&self) -> Vec<Cell> {
        let cell = |pixel: &Pixel<V, A, L>| {
            let [_, rgb @ ..] = pixel.argb.to_be_bytes();
            (rgb, pixel.present().then_some(pixel.offset))
        };
        self.front.iter().map(cell).collect()
    }
}

/// One frame of the floats as a display would show it.
pub struct FloatFrame {
    /// Frames since the update.
    pub number: u32,
    /// What is shown.
    pub picture: Picture,
    /// For each pixel of the display, whether a pixel of the update is there.
    pub reached: Vec<bool>,
    /// Every pixel of the update that is still there: its sample, and its place in cells of the map.
    pub places: Vec<(u32, [f64; 2])>,
}

/// Extrapolates an update in floats up to the last of the frames that `wanted` names; `visit` sees these.
pub fn run(update: &Update, kept: Kept, fill_mode: FillMode, wanted: &[u32], mut visit: impl FnMut(FloatFrame)) {
    let Some(mut maps) = maps(kept, update.width, update.height) else { return };
    maps.load(update);
    let known = |(cell, sample): (u32, &Sample)| if sample.known == Known::Motion { cell } else { NO_ORIGIN };
    let mut origins: Vec<u32> = (0..).zip(&update.samples).map(known).collect();
    let mut winners = vec![NO_ORIGIN; origins.len()];
    for number in 1..=wanted.iter().copied().max().unwrap_or(0) {
        maps.step(fill_mode, &mut winners);
        origins = winners.iter().map(|&winner| origins.get(winner as usize).copied().unwrap_or(NO_ORIGIN)).collect();
        if wanted.contains(&number) {
            visit(frame(update, number, &maps.cells(), &origins));
        }
    }
}

fn frame(update: &Update, number: u32, cells: &[Cell], origins: &[u32]) -> FloatFrame {
    let (width, height) = (update.display_width(), update.display_height());
    let rows = || (0..height).map(|y| (y + update.margin.top) * update.width + update.margin.left);
    let pixels = rows().flat_map(|row| cells[row..row + width].iter().map(|cell| cell.0)).collect();
    let reached = rows().flat_map(|row| origins[row..row + width].iter().map(|&origin| origin != NO_ORIGIN)).collect();
    let place = |index: usize| {
        let origin = origins[index];
        let [x, y] = cells[index].1.filter(|_| origin != NO_ORIGIN)?.map(f64::from);
        Some((origin, [(index % update.width) as f64 + x, (index / update.width) as f64 + y]))
    };
    let places = (0..cells.len()).filter_map(place).collect();
    FloatFrame { number, picture: Picture { width, height, pixels }, reached, places }
}

/// The floats as a contender.
pub struct InFloats {
    /// The maps.
    pub maps: Box<dyn Floats>,
    /// What is put into holes.
    pub fill_mode: FillMode,
    /// Pixels of a map.
    pub cells: usize,
}

impl Contender for InFloats {
    fn bytes(&self) -> usize {
        self.maps.bytes_per_pixel() * self.cells
    }

    fn restart(&mut self, update: &Update) {
        self.maps.load(update);
    }

    fn step(&mut self) {
        self.maps.step(self.fill_mode, &mut []);
    }
}
