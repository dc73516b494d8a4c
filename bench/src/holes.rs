//! A picture with the holes that a step of the scene leaves.

use galpix_core::stages::{fill, mark, sweep};
use galpix_core::{Class, Static, Tally};

use crate::scene::{Motion, samples};
use crate::{Full, Laid, Maps};

/// Which holes count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holes {
    /// All that nothing reached.
    All,
    /// Those that are left when bullet holes are filled.
    Slivers,
}

impl Holes {
    /// As in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Slivers => "slivers",
        }
    }
}

/// Colours, a bit for each that is known, depths, and what makes foreground.
pub struct Picture {
    /// Colour words.
    pub colours: Vec<u32>,
    /// A bit for each cell.
    pub known: Vec<u32>,
    /// Depths of the cells.
    pub depths: Vec<u32>,
    /// How far apart depths of two surfaces are.
    pub threshold: u32,
}

impl Picture {
    /// Returns the part of the cells that are holes.
    pub fn share(&self) -> f64 {
        let known: u32 = self.known.iter().map(|word| word.count_ones()).sum();
        1.0 - f64::from(known) / self.colours.len() as f64
    }
}

/// Returns the scene after a step.
pub fn picture(width: u32, height: u32, holes: Holes) -> Picture {
    let mut maps = Maps::new(width, height, Static::<Full>::new(), &samples(width, height, Motion::Scene));
    let settings = *maps.settings();
    let Laid { front, mut back, mut scratch } = maps.lay();
    let depth_bits = u32::from(front.record().depth().bits);
    let threshold = settings.edge_threshold;
    mark(&front, threshold, scratch.edges);
    sweep(&front, &mut back, scratch.winners, settings.rounding, 1);
    if holes == Holes::Slivers {
        fill(&front, &mut back, &mut scratch, &settings, &mut Tally::default());
    }
    let mut picture =
        Picture { colours: Vec::new(), known: vec![0; scratch.edges.len()], depths: Vec::new(), threshold };
    for cell in 0..front.grid().cells() {
        let (x, y) = ((cell % width) as i32, (cell / width) as i32);
        let depth = back.load(x, y).map_or(0, |galpixel| (galpixel.depth.to_bits() >> (32 - depth_bits)) as u32);
        picture.colours.push(back.colour(cell));
        if matches!(back.class(cell), Class::Galpixel | Class::Debris) {
            picture.known[(cell / 32) as usize] |= 1 << (cell % 32);
        }
        // A hole of which nothing is known is as far away as can be.
        let known = back.class(cell) != Class::Empty;
        picture.depths.push(if known { depth } else { (1 << depth_bits) - 1 });
    }
    picture
}

/// Returns a textured background with strips of holes that make up so many thousandths of it: upright, one to eight
/// cells wide and up to 96 high, with foreground on their left.
pub fn strips(width: u32, height: u32, share: u32) -> Picture {
    let mut holed = picture(width, height, Holes::Slivers);
    let (near, far) = (holed.threshold, 40 * holed.threshold);
    holed.known.fill(u32::MAX);
    holed.depths.fill(far);
    let wanted = (u64::from(width) * u64::from(height) * u64::from(share) / 1000) as u32;
    let (mut holes, mut bits) = (0, 1u64);
    let mut next = |end: u32| {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((bits >> 33) % u64::from(end)) as u32
    };
    while holes < wanted {
        let (left, top, wide, high) = (next(width), next(height), 1 + next(8), 8 + next(89));
        for y in top..(top + high).min(height) {
            for x in left..(left + wide + 8).min(width) {
                let cell = y * width + x;
                let (word, bit) = ((cell / 32) as usize, 1 << (cell % 32));
                if x >= left + 8 {
                    holes += u32::from(holed.known[word] & bit != 0);
                    holed.known[word] &= !bit;
                    holed.depths[cell as usize] = far;
                } else {
                    holed.depths[cell as usize] = near;
                }
            }
        }
    }
    holed
}
