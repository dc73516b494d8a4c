//! What the maps of the vectors hold: words drawn field by field, so that each bit follows from the record alone.

use galpix_core::record::{Field, MAX_WORDS};
use galpix_core::stages::threshold_for_depth;
use galpix_core::{Class, Record};

use crate::case::{GridSize, fields};
use crate::field::{Words, set};

/// Steele, Lea and Flood's splitmix64: three lines, and the same on every machine for ever.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// Creates a sequence that `seed` and `name` determine.
    pub fn new(seed: u64, name: &str) -> Self {
        // FNV-1a over the name, so that a case keeps its map when others come and go.
        let hash = name.bytes().fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        Self(hash.wrapping_add(seed))
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number in `0 .. end`.
    pub fn below(&mut self, end: u32) -> u32 {
        (((self.next() >> 32) * u64::from(end)) >> 32) as u32
    }

    /// Returns a signed number of `bits` bits.
    pub fn signed(&mut self, bits: u32) -> i32 {
        if bits == 0 { 0 } else { self.next() as i32 >> (32 - bits) }
    }
}

/// What a map shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Picture {
    /// Any class, any content, most of it slow enough to meet others.
    Random,
    /// Every field at an end of its range, at 0 or at -1.
    Extreme,
    /// Everything wants the middle cell; few depths, so that ties are decided by origin.
    Collide,
    /// A plane that is magnified: cracks inside a surface.
    Zoom,
    /// The four quarters drift apart, so that gaps between rows cross gaps between columns.
    Quarters,
    /// Blocks drift apart over bumps in depth: where gaps cross, any of the four corners may lie on an edge.
    Blocks,
    /// Near blocks slide over a far background with gaps: what is uncovered has neighbours on both, one or no side.
    Uncover,
    /// Rows slide down: whole rows are uncovered.
    Curtain,
    /// Neighbours move in opposite directions.
    Checkerboard,
    /// Everything leaves.
    Leave,
    /// Nothing is there.
    Empty,
    /// Nothing moves.
    Still,
    /// Two halves, a far and a near one, fly apart along the longer side, each row (or column) by a cell more.
    Tear,
    /// A block slides over a wide ground of two depths, so that long runs next to what it uncovers are known.
    Slide,
    /// One surface whose cells creep apart by units of the last bits, so that in some frames they do not part and in
    /// more they do.
    Creep,
    /// Surfaces whose depths differ by just as much as one surface may, or by one more, with debris and holes; offsets
    /// anywhere, every other one small.
    Surfaces,
    /// The same with offsets at the limits of sub-cell scan-out: a 256th of a cell, three eighths, a half.
    Limits,
    /// The quarters of a surface drift apart, and every field differs from cell to cell.
    Varied,
    /// What a camera sends to test a display: bars, and a box that moves over them.
    Pattern,
}

impl Picture {
    /// All of them but the last seven, which are for inpainting, disocclusion, scan-out, the means of bullets, a panel.
    pub const ALL: [Self; 12] = [
        Self::Random,
        Self::Extreme,
        Self::Collide,
        Self::Zoom,
        Self::Quarters,
        Self::Blocks,
        Self::Uncover,
        Self::Curtain,
        Self::Checkerboard,
        Self::Leave,
        Self::Empty,
        Self::Still,
    ];

    /// Returns its part of a case's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::Extreme => "extreme",
            Self::Collide => "collide",
            Self::Zoom => "zoom",
            Self::Quarters => "quarters",
            Self::Blocks => "blocks",
            Self::Uncover => "uncover",
            Self::Curtain => "curtain",
            Self::Checkerboard => "checkerboard",
            Self::Leave => "leave",
            Self::Empty => "empty",
            Self::Still => "still",
            Self::Tear => "tear",
            Self::Slide => "slide",
            Self::Creep => "creep",
            Self::Surfaces => "surfaces",
            Self::Limits => "limits",
            Self::Varied => "varied",
            Self::Pattern => "pattern",
        }
    }
}

/// Returns the columns and rows of a map, margin included.
pub fn size(grid: &GridSize) -> (u32, u32) {
    (grid.left + grid.width + grid.right, grid.top + grid.height + grid.bottom)
}

/// Returns the words of a map, plane by plane.
pub fn words(picture: Picture, record: &Record, grid: &GridSize, random: &mut Random) -> Vec<u32> {
    let (columns, rows) = size(grid);
    let cells = (columns * rows) as usize;
    let mut map = vec![0; record.words() * cells];
    for cell in 0..cells {
        let (x, y) = (cell as u32 % columns, cell as u32 / columns);
        let words = match picture {
            Picture::Random => each_field(record, |name, field| random_field(name, field, record, random)),
            Picture::Extreme => each_field(record, |name, field| extreme_field(name, field, random)),
            Picture::Creep => each_field(record, |name, field| creeping_field(name, field, random)),
            Picture::Surfaces => each_field(record, |name, field| surface_field(name, field, random)),
            Picture::Pattern => each_field(record, |name, field| pattern_field(name, field, record, [x, y])),
            Picture::Limits => each_field(record, |name, field| limit_field(name, field, random)),
            Picture::Varied => {
                let halves = [2 * i32::from(2 * x >= columns), 2 * i32::from(2 * y >= rows)];
                each_field(record, |name, field| varied_field(name, field, record, halves, random))
            }
            _ => drawn(picture, record, [x, y], [columns, rows], random),
        };
        for (word, value) in words.iter().take(record.words()).enumerate() {
            map[word * cells + cell] = *value;
        }
    }
    map
}

/// Returns the words of a galpixel each of whose fields has the value that is given for it.
pub fn each_field(record: &Record, mut value: impl FnMut(&str, Field) -> i32) -> Words {
    let mut words = [0; MAX_WORDS];
    for (name, field) in fields(record) {
        set(&mut words, field, value(name, field));
    }
    words
}

/// Returns the fraction bits of a component of the plane.
fn velocity_frac(record: &Record, name: &str) -> u32 {
    record.scales[usize::from(name.ends_with('y'))].velocity_frac
}

pub fn random_field(name: &str, field: Field, record: &Record, random: &mut Random) -> i32 {
    let bits = u32::from(field.bits);
    match name {
        "class" => [0, 0, 0, 0, 0, 1, 2, 3][random.below(8) as usize],
        // Three in four slow, so that galpixels stay and meet; the rest anywhere in the field.
        "velocity_x" | "velocity_y" if random.below(4) > 0 => {
            random.signed((velocity_frac(record, name) + 2).min(bits))
        }
        "acceleration_x" | "acceleration_y" if random.below(4) > 0 => random.signed(bits.min(4)),
        // Few different depths: ties, and surfaces that go on.
        "depth" if random.below(2) > 0 => (random.below(3) << bits.saturating_sub(2)) as i32,
        _ => random.signed(bits),
    }
}

fn creeping_field(name: &str, field: Field, random: &mut Random) -> i32 {
    let bits = u32::from(field.bits);
    match name {
        "class" => 0,
        "depth" => random.below(2) as i32,
        "acceleration_x" | "acceleration_y" => random.signed(bits.min(1)),
        _ if name.starts_with("velocity") => random.signed(bits.min(5)),
        _ => random.signed(bits),
    }
}

fn surface_field(name: &str, field: Field, random: &mut Random) -> i32 {
    let bits = u32::from(field.bits);
    match name {
        "class" => [0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3][random.below(11) as usize],
        "depth" => {
            let threshold = threshold_for_depth(bits) as i32;
            [0, 0, threshold, threshold, threshold + 1, 2 * threshold][random.below(6) as usize]
        }
        "offset_x" | "offset_y" => random.signed(bits) >> random.below(2),
        _ => random.signed(bits),
    }
}

fn limit_field(name: &str, field: Field, random: &mut Random) -> i32 {
    match name {
        "offset_x" | "offset_y" => {
            let parts = [0, 1, -1, 96, -96, 97, -97, 127, -128][random.below(9) as usize];
            parts << u32::from(field.bits).saturating_sub(8)
        }
        _ => surface_field(name, field, random),
    }
}

/// `halves` is the velocity in half cells a frame, on which the field has some noise.
fn varied_field(name: &str, field: Field, record: &Record, halves: [i32; 2], random: &mut Random) -> i32 {
    let bits = u32::from(field.bits);
    match name {
        "class" => 0,
        // Far less than the threshold of an edge, wherever the field has the bits for it.
        "depth" => (1 << bits >> 2) + (random.below(1 << bits >> 9) as i32),
        "velocity_x" | "velocity_y" if bits > 0 => {
            let component = usize::from(name.ends_with('y'));
            let top = (1i32 << bits >> 1) - 1;
            let noise = random.signed(bits.min(3));
            (((halves[component] << record.scales[component].velocity_frac) >> 1) + noise).clamp(-top - 1, top)
        }
        "acceleration_x" | "acceleration_y" => random.signed(bits.min(4)),
        "velocity_depth" | "acceleration_depth" => random.signed(bits.min(6)),
        _ => random.signed(bits),
    }
}

/// Bars of eight columns behind, their colour by three bits of the column; a box of 16 x 12 cells in front, which moves
/// by one and a half cells to the right and half a cell down. As `firmware/rtl/src/galpix_pattern.sv` has it.
fn pattern_field(name: &str, field: Field, record: &Record, [x, y]: [u32; 2]) -> i32 {
    let bits = u32::from(field.bits);
    let in_box = (8..24).contains(&x) && (8..20).contains(&y);
    let all = |bits: u32| (1i64 << bits) as i32 - 1;
    match name {
        "depth" if in_box => 1 << bits >> 2,
        "depth" => all(bits),
        "velocity_x" if in_box => 3 << record.scales[0].velocity_frac >> 1,
        "velocity_y" if in_box => 1 << record.scales[1].velocity_frac >> 1,
        "colour" => {
            let channels = record.layout().colour;
            let bars = channels.channels().zip(3..).fold(0, |colour, (channel, bit)| {
                colour | if x >> bit & 1 == 1 { all(channel.bits) << channel.shift } else { 0 }
            });
            match (in_box, (x ^ y) & 4 == 0) {
                (true, true) => all(bits),
                (true, false) => bars ^ all(bits),
                (false, _) => bars,
            }
        }
        _ => 0,
    }
}

pub fn extreme_field(name: &str, field: Field, random: &mut Random) -> i32 {
    let bits = u32::from(field.bits);
    if bits == 0 {
        return 0;
    }
    if name == "class" {
        return random.below(4) as i32;
    }
    let top = (1i64 << (bits - 1)) - 1;
    [-top - 1, top, 0, -1, -top][random.below(5) as usize] as i32
}

/// A picture with a shape: class, depth, colour and velocity by place.
fn drawn(picture: Picture, record: &Record, at: [u32; 2], size: [u32; 2], random: &mut Random) -> Words {
    let [x, y] = at.map(|n| n as i32);
    let [columns, rows] = size.map(|n| n as i32);
    let (from_x, from_y) = (x - columns / 2, y - rows / 2);
    let range = |eighths: u32| ((1u64 << record.depth().bits) * u64::from(eighths) / 8) as i32;
    let colour = |spread: u32| (random_colour(x, y, spread)) as i32;
    // In halves of a cell a frame.
    let (class, depth, halves) = match picture {
        Picture::Collide => (Class::Galpixel, range(1 + (at[0] + at[1]) % 3), [-2 * from_x, -2 * from_y]),
        Picture::Zoom => (Class::Galpixel, range(2), [from_x, from_y]),
        Picture::Quarters => (Class::Galpixel, range(2), [2 * i32::from(from_x >= 0), 2 * i32::from(from_y >= 0)]),
        Picture::Blocks => {
            let depth = if random.below(7) == 0 { range(7) } else { range(2) };
            (Class::Galpixel, depth, [2 * (x / 4 - columns / 8), 2 * (y / 4 - rows / 8)])
        }
        Picture::Uncover => {
            let near = (x / 3 + y / 4) % 3 == 0;
            let gap = (x * 7 + y * 5) % 11 == 0;
            match (near, gap) {
                (true, _) => (Class::Galpixel, range(1), [4 - 8 * (y / 4 % 2), 2 * (y % 2)]),
                (false, true) => ([Class::Empty, Class::Debris][(y % 2) as usize], range(7), [0, 0]),
                (false, false) => (Class::Galpixel, range(5 + at[0] % 2), [0, 0]),
            }
        }
        Picture::Curtain => (Class::Galpixel, range(2), [0, 3 * i32::from(y % 3 > 0)]),
        Picture::Checkerboard => {
            let sign = if (x + y) % 2 == 0 { 2 } else { -2 };
            (Class::Galpixel, range(1 + at[0] % 4), [sign, -sign])
        }
        Picture::Leave => (Class::Galpixel, range(3), [4 * columns * if x % 2 == 0 { 1 } else { -1 }, 0]),
        Picture::Tear => {
            // In the first row the halves end 64 cells apart, which is the most that is still a surface.
            let (along, across) = if columns >= rows { (from_x, y) } else { (from_y, x) };
            let speed = if along < 0 { -2 * (31 + across) } else { 62 };
            let depth = range(if along < 0 { 1 } else { 3 + (across % 2) as u32 });
            (Class::Galpixel, depth, if columns >= rows { [speed, 0] } else { [0, speed] })
        }
        Picture::Slide => match x {
            32..40 => (Class::Galpixel, range(1), [8, 0]),
            // A part of the ground is nearer just before what is uncovered, in every other pair of rows.
            31 if y / 2 % 2 == 1 => (Class::Galpixel, range(3), [0, 0]),
            _ => (Class::Galpixel, range(6), [0, 0]),
        },
        Picture::Empty => (Class::Empty, 0, [0, 0]),
        _ => (Class::Galpixel, range(1 + (at[0] ^ at[1]) % 6), [0, 0]),
    };
    let top = |bits: u8| (1i64 << (bits.max(1) - 1)) - 1;
    let velocity = |component: usize| {
        let raw = i64::from(halves[component]) << record.scales[component].velocity_frac >> 1;
        let top = top(record.velocity(component).bits);
        raw.clamp(-top - 1, top) as i32
    };
    let mut words = [0; MAX_WORDS];
    set(&mut words, record.class(), class as i32);
    set(&mut words, record.depth(), depth);
    set(&mut words, record.colour(), colour(random.below(4)));
    set(&mut words, record.velocity(0), velocity(0));
    set(&mut words, record.velocity(1), velocity(1));
    set(&mut words, record.tag(), x + y);
    words
}

/// Returns a colour that identifies places.
fn random_colour(x: i32, y: i32, spread: u32) -> u32 {
    (x as u32 * 37 + spread) << 16 ^ (y as u32 * 59 + spread) << 8 ^ (x as u32 * 11 + y as u32 * 3 + spread)
}
