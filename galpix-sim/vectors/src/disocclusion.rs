//! Cases of the disocclusion map: which there are, their content, and the core run over their inputs.

use galpix_core::disocclusion::{Border, Reach, Tally, cover, mark, spread};
use galpix_core::{Bits, Colour, Demand, Galpixmap, Layout, Record, stages};
use schemars::JsonSchema;
use serde::Serialize;

use crate::case::{Case, Content, GridSize, Setting};
use crate::choice::{component, grid};
use crate::maps::{Picture, Random, size, words};
use crate::run::{GridMemory, Model, RunError};

/// A map, and which of its cells hide what may be uncovered.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Disocclusion {
    /// Widths, fields, places, size.
    #[serde(flatten)]
    pub setting: Setting,
    /// Frames until the next update.
    pub frames: u32,
    /// From which difference on two neighbours are of two surfaces, in units of the depth's last bit.
    pub separation: u32,
    /// What is beyond the border: still or continues.
    pub border: String,
    /// Whether tears count.
    pub tears: bool,
    /// Whether surfaces are let through.
    pub through: bool,
    /// The map.
    pub front: Vec<u32>,
    /// Extents and bits *blocked* of each cell, before they are spread.
    pub marked: Vec<u32>,
    /// Extents of each cell.
    pub spread: Vec<u32>,
    /// A bit for each cell: whether it is covered.
    pub mask: Vec<u32>,
    /// What was counted.
    pub counts: Uncovered,
}

/// Counts of a map.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Uncovered {
    edges: u32,
    #[serde(rename = "endless")]
    saturated: u32,
    covered: u32,
}

impl From<Tally> for Uncovered {
    fn from(tally: Tally) -> Self {
        let Tally { edges, saturated, covered } = tally;
        Self { edges, saturated, covered }
    }
}

/// What a map shows.
#[derive(Clone, Copy, Debug)]
pub enum Shown {
    /// As in the other kinds.
    One(Picture),
    /// Patches, each of which moves as a whole: what a random map shows, each cell of it as so many columns and rows.
    Patches(u32, u32),
}

impl Shown {
    const fn name(self) -> &'static str {
        match self {
            Self::One(picture) => picture.name(),
            Self::Patches(..) => "patches",
        }
    }

    fn words(self, record: &Record, map_size: &GridSize, random: &mut Random) -> Vec<u32> {
        let (wide, high) = match self {
            Self::One(picture) => return words(picture, record, map_size, random),
            Self::Patches(wide, high) => (wide, high),
        };
        let (columns, rows) = size(map_size);
        let (across, down) = (columns.div_ceil(wide), rows.div_ceil(high));
        let patches = words(Picture::Random, record, &grid(across, down, [0; 4]), random);
        let of = |word: u32, cell: u32| {
            let (x, y) = (cell % columns, cell / columns);
            patches[(word * across * down + y / high * across + x / wide) as usize]
        };
        (0..record.words() as u32).flat_map(|word| (0..columns * rows).map(move |cell| of(word, cell))).collect()
    }
}

/// Runs of cells longer than any that an engine may take at once, lines along either side, margin, and a single cell.
const SHAPES: [GridSize; 9] = [
    grid(40, 13, [0; 4]),
    grid(12, 9, [0; 4]),
    grid(33, 6, [1, 0, 0, 1]),
    grid(7, 5, [2, 1, 3, 0]),
    grid(1, 40, [0; 4]),
    grid(70, 1, [0; 4]),
    grid(5, 22, [0, 4, 1, 0]),
    grid(1, 1, [0; 4]),
    grid(16, 12, [0; 4]),
];

/// The numbers of pictures and of shapes have no common divisor.
const PICTURES: [Shown; 11] = [
    Shown::Patches(5, 4),
    Shown::One(Picture::Random),
    Shown::One(Picture::Uncover),
    Shown::Patches(7, 3),
    Shown::One(Picture::Blocks),
    Shown::One(Picture::Extreme),
    Shown::Patches(3, 6),
    Shown::One(Picture::Slide),
    Shown::One(Picture::Checkerboard),
    Shown::One(Picture::Tear),
    Shown::One(Picture::Creep),
];

/// A depth as wide as it may be.
const DEEPEST: Layout = Layout { depth_bits: 28, ..Layout::VELOCITY_GRAY8 };

/// No depth, with acceleration: surfaces are distinguished by motion and class alone.
const LEVEL: Layout = Layout { colour: Colour::RGB888, velocity: true, acceleration: true, ..Layout::STILL };

/// Without acceleration, and more bits dropped than the one that a derived budget drops.
fn glide() -> Result<Bits, RunError> {
    let bits = Bits::derive_without_acceleration(Demand { extent: 64, recog: 8, prop: 8 })?;
    Ok(bits.with_xy(component(2, [5, 4], [0, 0]).checked()?, component(4, [4, 5], [0, 0]).checked()?))
}

/// Returns all cases, over the layouts of the others and three more.
pub fn cases(seed: u64, models: &[Model]) -> Result<Vec<Case>, RunError> {
    let derived = Bits::derive(Demand { extent: 64, recog: 8, prop: 8 })?;
    let slide = Bits::derive_without_acceleration(Demand { extent: 128, recog: 4, prop: 16 })?;
    let more = [
        Model::new("deepest", DEEPEST, slide)?,
        Model::new("level", LEVEL, derived)?,
        Model::new("glide", Layout::VELOCITY565, glide()?)?,
    ];
    let mut cases = Vec::new();
    for (place, model) in models.iter().chain(&more).enumerate() {
        for (index, shown) in PICTURES.into_iter().enumerate() {
            // For a still picture one case is enough.
            if model.name == "still" && index > 2 {
                continue;
            }
            let map_size = match shown {
                Shown::One(Picture::Slide) => grid(70, 8, [0; 4]),
                Shown::One(Picture::Tear) => [grid(70, 4, [0; 4]), grid(4, 70, [0; 4])][place % 2],
                _ => SHAPES[(index + place) % SHAPES.len()],
            };
            cases.push(case(seed, model, shown, map_size)?);
        }
    }
    Ok(cases)
}

fn case(seed: u64, model: &Model, shown: Shown, map_size: GridSize) -> Result<Case, RunError> {
    let GridSize { width, height, .. } = map_size;
    let patch = if let Shown::Patches(wide, high) = shown { format!("-{wide}x{high}") } else { String::new() };
    let name = format!("disocclusion-{}-{}{patch}-{width}x{height}", model.name, shown.name());
    // The same for every seed, so that each seed has every rule.
    let mut drawn = Random::new(0, &name);
    let mut one_of = |choices: [u32; 6]| choices[drawn.below(6) as usize];
    let default = Reach::new(0, model.depth_bits()).separation;
    // The distance between depths of the random map.
    let quarter = 1 << model.depth_bits().saturating_sub(2);
    let frames = match shown {
        Shown::One(Picture::Random | Picture::Extreme) => one_of([0, 1, 1, 2, 3, 16]),
        Shown::One(Picture::Creep) => one_of([1, 2, 3, 8, 16, 16]),
        _ => one_of([1, 3, 3, 16, 255, 1000]),
    };
    let reach = Reach {
        frames,
        separation: match shown {
            Shown::One(Picture::Creep) => 2,
            _ => one_of([default, default, 0, 1, quarter, u32::MAX]),
        },
        border: [Border::Still, Border::Continues][one_of([0, 0, 0, 0, 1, 1]) as usize],
        tears: one_of([0, 0, 1, 1, 1, 1]) == 1 || matches!(shown, Shown::One(Picture::Creep)),
        through: one_of([0, 0, 0, 0, 1, 1]) == 1,
    };
    let content = model.uncovered(map_size, shown, &reach, &mut Random::new(seed, &name))?;
    let about = format!("what a map that shows {} may uncover", shown.name());
    Ok(Case { name, about, content })
}

impl Model {
    /// Makes the disocclusion map of a front map; the mask by the form that keeps a line alone.
    fn uncovered(
        &self,
        map_size: GridSize,
        shown: Shown,
        reach: &Reach,
        random: &mut Random,
    ) -> Result<Content, RunError> {
        let mut starts = GridMemory::new(map_size);
        let grid = starts.grid()?;
        let front = shown.words(self.record(), &map_size, random);
        let mut memory = front.clone();
        let map = Galpixmap::over(grid, self.format, &mut memory)?;
        let mut marked = vec![0; grid.cells() as usize];
        let tally = mark(&map, &mut marked, reach);
        let mut extents = marked.clone();
        let covered = spread(&mut extents, &grid);
        let (mut line, mut mask) = (vec![0; grid.width() as usize], vec![0; stages::words(&grid)]);
        cover(&map, &mut line, &mut mask, reach);
        let &Reach { frames, separation, border, tears, through } = reach;
        let border = match border {
            Border::Still => "still",
            Border::Continues => "continues",
        };
        Ok(Content::Disocclusion(Disocclusion {
            setting: self.setting(map_size),
            frames,
            separation,
            border: border.to_owned(),
            tears,
            through,
            front,
            marked,
            spread: extents,
            mask,
            counts: Tally { covered, ..tally }.into(),
        }))
    }
}
