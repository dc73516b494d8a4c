//! What the layers of stationary sources hold: surfaces that have grown, turned and torn, and that move.

use galpix_core::layers::displacement_word;
use galpix_core::record::MAX_WORDS;
use galpix_core::{Class, Record};

use crate::case::GridSize;
use crate::field::{Words, set};
use crate::maps::{Picture, Random, size, words};

/// Parts of a cell in which places count here.
const PARTS: i32 = 32;

/// The base-2 logarithm of the parts of a cell in which speeds count here.
const SPEED: u32 = 8;

/// What a placed surface is like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ground {
    /// One depth.
    Level,
    /// One depth, and cells without a sample.
    Holes,
    /// Depths that differ by half the default threshold and all of it, or by a bit more.
    Rough,
    /// The greatest depth.
    Farthest,
}

/// Differences of depth, in 2^-16 of the range, of which the default threshold is 2^-6.
const ROUGH: [u32; 5] = [0, 0x200, 0x400, 0x402, 0x202];

/// What a layer shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scene {
    /// Fields as in the other kinds, a few of the displacements large.
    Drawn(Picture),
    /// One surface, placed by a matrix about the middle of the map, row by row, in 32nds of a cell; places are off by
    /// up to so many 32nds.
    Placed { name: &'static str, matrix: [i32; 4], noise: u32, ground: Ground },
    /// One surface whose speeds follow from a matrix about the middle of the map, in 256ths of a cell.
    Driven { name: &'static str, matrix: [i32; 4] },
    /// A near block slides over the background, whose colours are mixed with its own along it.
    Slide,
    /// Bars of one cell slide over the background: upright or lying ones.
    Fence { upright: bool },
    /// Depths that grow faster than the threshold on both sides of a crease; what is nearer is faster.
    Slant,
    /// Rows apart, each of which lies along a diagonal: falling or rising to the right.
    Diagonal { falls: bool },
    /// Displacements at the ends of their range, and speeds in all directions.
    Limits,
    /// Patches of each class, one depth.
    Patches,
    /// A far background that nothing moves.
    Background,
    /// The same just behind the other scenes.
    CloseBackground,
    /// A near block that grows over the background.
    Swell,
    /// A step of depth and one of speed where depths are equal.
    Steps,
    /// One depth; speeds that differ by about a quarter of a cell a frame.
    Hurried,
    /// Cells of a near surface leave a background, just behind it, with whose colours theirs are mixed.
    Speckle,
    /// Near cells, each alone, leave a background with whose colour theirs are mixed where the two meet: nearly
    /// everywhere, or here and there.
    Rims { few: bool },
}

/// What a scene has in a cell.
struct Sample {
    class: Class,
    /// In 2^-16 of the range.
    depth: u32,
    /// Relative to the cell, in 32nds of a cell.
    place: [i32; 2],
    /// In 256ths of a cell a frame.
    speed: [i32; 2],
    colour: [u8; 3],
}

impl Scene {
    /// Returns its part of a case's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Drawn(picture) => picture.name(),
            Self::Placed { name, .. } | Self::Driven { name, .. } => name,
            Self::Slide => "slide",
            Self::Fence { upright: true } => "fence",
            Self::Fence { upright: false } => "rungs",
            Self::Slant => "slant",
            Self::Diagonal { falls: true } => "falling",
            Self::Diagonal { falls: false } => "rising",
            Self::Limits => "limits",
            Self::Patches => "patches",
            Self::Background => "background",
            Self::CloseBackground => "close-background",
            Self::Swell => "swell",
            Self::Steps => "steps",
            Self::Hurried => "hurried",
            Self::Speckle => "speckle",
            Self::Rims { few: false } => "rims",
            Self::Rims { few: true } => "few-rims",
        }
    }

    /// Returns the words of a map, plane by plane, and the words of its displacements.
    pub fn layer(self, record: &Record, grid: &GridSize, random: &mut Random) -> [Vec<u32>; 2] {
        let (columns, rows) = size(grid);
        let cells = (columns * rows) as usize;
        if let Self::Drawn(picture) = self {
            let map = words(picture, record, grid, random);
            let mut one = || match random.below(24) {
                0 => [-32768, 32767, 32766][random.below(3) as usize],
                _ => random.below(5) as i32 - 2,
            };
            return [map, (0..cells).map(|_| displacement_word([one(), one()])).collect()];
        }
        let mut map = vec![0; record.words() * cells];
        let mut displacements = vec![0; cells];
        for (cell, displacement) in displacements.iter_mut().enumerate() {
            let at = [cell as i32 % columns as i32, cell as i32 / columns as i32];
            let sample = self.sample(at, [columns as i32, rows as i32], random);
            let words = stored(&sample, displacement, record, random);
            for (word, value) in words.iter().take(record.words()).enumerate() {
                map[word * cells + cell] = *value;
            }
        }
        [map, displacements]
    }

    fn sample(self, [x, y]: [i32; 2], size: [i32; 2], random: &mut Random) -> Sample {
        let from = [x - size[0] / 2, y - size[1] / 2];
        let times = |[a, b, c, d]: [i32; 4]| [a * from[0] + b * from[1], c * from[0] + d * from[1]];
        let mut noise = |most: u32| random.below(2 * most + 1) as i32 - most as i32;
        let colour = [(x * 23 + noise(9)) as u8, (y * 41 + noise(9)) as u8, (x * 7 + y * 13) as u8];
        let plain = Sample { class: Class::Galpixel, depth: 0x6000, place: [0; 2], speed: [0; 2], colour };
        match self {
            Self::Drawn(_) => plain,
            Self::Placed { matrix, noise: most, ground, .. } => {
                let placed = times(matrix);
                let place = [0, 1].map(|i| placed[i] - PARTS * from[i] + noise(most));
                let hole = ground == Ground::Holes && noise(6) == 0;
                let depth = match ground {
                    Ground::Level | Ground::Holes => plain.depth,
                    Ground::Rough => plain.depth + ROUGH[noise(4).unsigned_abs() as usize],
                    Ground::Farthest => 0xffff,
                };
                Sample { class: if hole { Class::Empty } else { Class::Galpixel }, depth, place, ..plain }
            }
            Self::Driven { matrix, .. } => Sample { speed: times(matrix), depth: 0x3000, ..plain },
            Self::Slide => {
                // Two halves, the lower one wider, so that there are corners to all sides.
                let near = |x: i32, y: i32| {
                    let (from, to) = if y < size[1] / 2 { (4, 6) } else { (2, 5) };
                    let columns = size[0] * from / 8..size[0] * to / 8;
                    columns.contains(&x) && (size[1] / 5..size[1] * 4 / 5).contains(&y)
                };
                let behind = [180 + 2 * noise(2), 60 + x, 20];
                if near(x, y) {
                    let colour = [30, 200 - noise(3), 210 - y].map(|level| level as u8);
                    return Sample { depth: 0x2000, speed: [170, 110], colour, ..plain };
                }
                let beside = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)].iter().any(|&(x, y)| near(x, y));
                // Eighths of the block's colour.
                let part = if beside { noise(4) + 4 } else { 0 };
                let mixed = |from: i32, to: i32| ((from * (8 - part) + to * part) / 8) as u8;
                let colour = [mixed(behind[0], 30), mixed(behind[1], 200), mixed(behind[2], 210)];
                Sample { depth: 0xb000, speed: [-20, 0], colour, ..plain }
            }
            Self::Fence { upright } => {
                let along = if upright { x } else { y };
                match along % 3 {
                    1 => Sample { depth: 0x2000, speed: if upright { [90, 10] } else { [10, -90] }, ..plain },
                    _ => Sample { depth: 0xa000, ..plain },
                }
            }
            Self::Slant => {
                let depth = (0x2000 + 0x700 * from[0].abs()).min(0xf000) as u32;
                Sample { depth, speed: [300 - depth as i32 / 200, 0], ..plain }
            }
            Self::Diagonal { falls } => {
                let class = if y % 3 == 0 { Class::Galpixel } else { Class::Empty };
                let down = if falls { 2 } else { -2 };
                Sample { class, place: [PARTS * from[0], PARTS * down * from[0]], ..plain }
            }
            Self::Limits => {
                let end = |noise: i32| PARTS * [-32768, -32767, 0, 1, 32766, 32767][(noise + 3) as usize % 6];
                let speed = [noise(900), noise(900)];
                Sample { place: [end(noise(3)), end(noise(3))], speed, ..plain }
            }
            Self::Patches => {
                let class = [Class::Galpixel, Class::Galpixel, Class::JustUnobscured, Class::Debris, Class::Empty]
                    [((x / 3 + 2 * (y / 2)) % 5) as usize];
                Sample { class, place: [noise(8), noise(8)], speed: [noise(8), noise(8)], ..plain }
            }
            Self::Background => Sample { depth: 0xe000, place: [noise(15), noise(15)], ..plain },
            Self::CloseBackground => {
                let depth = plain.depth + 0x200 + ROUGH[noise(4).unsigned_abs() as usize];
                Sample { depth, place: [noise(15), noise(15)], ..plain }
            }
            Self::Swell => {
                let near = from[0].abs() <= 4 + noise(1) && from[1].abs() <= 3 + noise(1);
                match near {
                    true => Sample { depth: 0x3000, speed: [28 * from[0] + 30, 22 * from[1]], ..plain },
                    false => Sample { depth: 0x9000, ..plain },
                }
            }
            Self::Hurried => {
                let mut one = || [0, 50, 64, 65, 80][noise(4).unsigned_abs() as usize];
                Sample { speed: [one(), one()], ..plain }
            }
            Self::Speckle => {
                let behind_depth = plain.depth + 1;
                if noise(3) > 1 {
                    let depth = behind_depth - [0x401, 0x402, 0x403, 0x800, 0x1000][noise(4).unsigned_abs() as usize];
                    return Sample { depth, speed: [200, 60], colour: [16, 240, 128], ..plain };
                }
                // Eighths of the near colour, and a bit more or less.
                let part = noise(4).abs() * 2;
                let behind = [[208, 48, 64], [204, 44, 64]][usize::from(noise(1) > 0)];
                let mixed = |from: i32, to: i32| (from * (8 - part) + to * part) / 8;
                let colour = [mixed(behind[0], 16), mixed(behind[1], 240), mixed(behind[2], 128) + noise(1)];
                let colour = colour.map(|level| level as u8);
                Sample { depth: behind_depth, speed: [-200, 0], colour, ..plain }
            }
            Self::Rims { few } => {
                let behind_depth = plain.depth + 1;
                let (near_colour, behind) = ([16, 240, 128], [208, 48, 64]);
                let is_near = |x: i32, y: i32| (x * 5 + y * 3).rem_euclid(19) == 0;
                if is_near(x, y) {
                    let depth = behind_depth - [0x401, 0x402, 0x403, 0x800, 0x1000][noise(4).unsigned_abs() as usize];
                    let speed = if noise(2) == 0 { [-200, 0] } else { [200, 60] };
                    let colour = if noise(1) == 1 { behind } else { near_colour };
                    return Sample { depth, speed, colour, ..plain };
                }
                let is_rim = is_near(x - 1, y) || is_near(x + 1, y) || is_near(x, y - 1) || is_near(x, y + 1);
                let is_mixed = is_rim && (!few || noise(4) == 4);
                let part = if is_mixed { noise(3).abs() * 2 } else { 0 };
                let mixed = [0, 1, 2].map(|channel| {
                    let [from, to] = [behind, near_colour].map(|colour: [u8; 3]| i32::from(colour[channel]));
                    ((from * (8 - part) + to * part) / 8) as u8
                });
                // Here by whole cells, there not.
                let speed = [if x / 8 % 2 == 0 { -256 } else { -200 }, 0];
                Sample { depth: behind_depth, speed, colour: mixed, ..plain }
            }
            Self::Steps => {
                let depth = [0x4000, 0x4000, 0x9000][(x / 4 % 3) as usize];
                let speed = [[0, 0], [140, -140]][(y / 3 % 2) as usize];
                Sample { depth, speed, ..plain }
            }
        }
    }
}

/// Returns the words of a sample and writes its displacement: what of its place is less than a cell is its offset.
fn stored(sample: &Sample, displacement: &mut u32, record: &Record, random: &mut Random) -> Words {
    let &Sample { class, depth, place, speed, colour } = sample;
    let mut words = [0; MAX_WORDS];
    let mut cells = [0; 2];
    for component in 0..2 {
        let field = [record.offset_x(), record.offset_y()][component];
        let frac = u32::from(field.bits);
        let place = i64::from(place[component]) << frac >> PARTS.trailing_zeros();
        cells[component] = ((place + (1 << frac >> 1)) >> frac) as i32;
        set(&mut words, field, (place - (i64::from(cells[component]) << frac)) as i32);

        let velocity = record.velocity(component);
        let top = (1i64 << velocity.bits >> 1) - 1;
        let raw = i64::from(speed[component]) << record.scales[component].velocity_frac >> SPEED;
        set(&mut words, velocity, raw.clamp(-top - 1, top.max(0)) as i32);
        let acceleration = record.acceleration(component);
        set(&mut words, acceleration, random.signed(u32::from(acceleration.bits).min(2)));
    }
    *displacement = displacement_word(cells);
    let depth_field = record.depth();
    set(&mut words, record.class(), class as i32);
    set(&mut words, depth_field, (u64::from(depth) << depth_field.bits >> 16) as i32);
    set(&mut words, record.velocity(2), random.signed(u32::from(record.velocity(2).bits).min(6)));
    set(&mut words, record.colour(), record.colour_format().from_rgb888(colour) as i32);
    set(&mut words, record.luminosity_rate(), random.signed(u32::from(record.luminosity_rate().bits).min(5)));
    set(&mut words, record.luminosity(), random.next() as i32);
    set(&mut words, record.tag(), random.next() as i32);
    words
}
