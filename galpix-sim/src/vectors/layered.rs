//! Cases of layers: what they say, and the core run over their inputs.

use galpix_core::budget::Bits;
use galpix_core::edge;
use galpix_core::frame::{Controller, Scratch};
use galpix_core::galpixel::{Budget as _, Chosen};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::Grid;
use galpix_core::layers::{self, displacement_word, seat_words};
use galpix_core::layout::Layout;
use schemars::JsonSchema;
use serde::Serialize;

use super::case::{Content, Counts, Making, Setting};
use super::maps::{Picture, Random, words};
use super::run::{Lent, Plan, RunError, planes, setting};

/// Layers, and some frames of them.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Layers {
    /// Widths, lanes, places, size.
    #[serde(flatten)]
    pub setting: Setting,
    /// How all layers are made.
    #[serde(flatten)]
    pub making: Making,
    /// What each layer is and holds at first, the base first.
    pub layers: Vec<LayerAtFirst>,
    /// What is shown at first.
    pub first: Shown,
    /// The frames after it.
    pub frames: Vec<LayersAfter>,
    /// What each layer holds after the last frame.
    pub after: Vec<Own>,
}

/// One layer at first.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct LayerAtFirst {
    /// Whether it is anchored.
    pub anchored: bool,
    /// Whether it has a winner map.
    pub winners: bool,
    /// Whether it has an edge map.
    pub edges: bool,
    /// Its galpixels and displacements.
    #[serde(flatten)]
    pub own: Own,
}

/// What a layer holds.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Own {
    /// Its own galpixels; of an anchored layer what is stored.
    pub map: Vec<u32>,
    /// Of an anchored layer the word of the displacement of each cell; else empty.
    pub displacements: Vec<u32>,
}

/// What is shown.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Shown {
    /// The map.
    pub map: Vec<u32>,
    /// Which layer each cell shows.
    pub layers: Vec<u32>,
}

/// One frame.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct LayersAfter {
    /// What each layer counted, the base first.
    pub counts: Vec<Counts>,
    /// How many cells show each layer but the base.
    pub shown: Vec<u32>,
    /// What is shown.
    #[serde(flatten)]
    pub showing: Shown,
}

impl Layers {
    /// The arrays of a case by their names.
    pub fn arrays(&self) -> Vec<(String, Vec<u32>)> {
        let mut arrays = Vec::new();
        let mut push = |name: String, words: &[u32]| {
            if !words.is_empty() {
                arrays.push((name, words.to_vec()));
            }
        };
        for (k, layer) in self.layers.iter().enumerate() {
            push(format!("map_{k}"), &layer.own.map);
            push(format!("displacements_{k}"), &layer.own.displacements);
        }
        for (n, shown) in std::iter::once(&self.first).chain(self.frames.iter().map(|frame| &frame.showing)).enumerate()
        {
            push(format!("shown_{n}"), &shown.map);
            push(format!("layers_{n}"), &shown.layers);
        }
        for (k, own) in self.after.iter().enumerate() {
            push(format!("own_{k}"), &own.map);
            push(format!("displacements_after_{k}"), &own.displacements);
        }
        arrays
    }
}

/// A layer beside the base, as it is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Hidden {
    /// What its map shows.
    pub picture: Picture,
    /// Whether it is anchored.
    pub anchored: bool,
    /// Whether it has a winner map.
    pub winners: bool,
    /// Whether it has an edge map.
    pub edges: bool,
}

/// Memory of a layer.
struct Memory {
    maps: [Vec<u32>; 3],
    winners: Vec<u32>,
    edges: Vec<u32>,
    seats: Vec<u32>,
    displacements: Vec<u32>,
}

impl Memory {
    fn new(map: Vec<u32>, displacements: &[u32], grid: &Grid<'_>, kind: Hidden) -> Self {
        let length = map.len();
        Self {
            maps: [map, vec![0; length], vec![0; length]],
            winners: vec![0; if kind.winners { grid.cells() as usize } else { 0 }],
            edges: vec![0; if kind.edges { edge::words(grid) } else { 0 }],
            seats: vec![0; seat_words(grid)],
            displacements: displacements.to_vec(),
        }
    }
}

/// Displacements of a few cells, and some at the ends of their range.
fn displacements(cells: u32, random: &mut Random) -> Vec<u32> {
    let mut one = || match random.below(16) {
        0 => [-32768, 32767, 32766][random.below(3) as usize],
        _ => random.below(7) as i32 - 3,
    };
    (0..cells).map(|_| displacement_word([one(), one()])).collect()
}

/// Frames of a base that shows the plan's picture and of `HIDDEN` further layers.
pub fn layered<L: Layout, const HIDDEN: usize>(
    bits: Bits,
    plan: &Plan,
    hidden: &[Hidden],
    random: &mut Random,
) -> Result<Content, RunError> {
    let budget = Chosen::<L>::new(bits)?;
    let record = *budget.record();
    let mut lent = Lent::new(plan.grid);
    let grid = lent.grid()?;
    let base = Hidden { picture: plan.picture, anchored: false, winners: true, edges: true };
    let kinds: Vec<Hidden> = std::iter::once(base).chain(hidden.iter().copied()).collect();
    let at_first: Vec<LayerAtFirst> = kinds
        .iter()
        .map(|kind| {
            let map = words(kind.picture, &record, &plan.grid, random);
            let displacements = if kind.anchored { displacements(grid.cells(), random) } else { Vec::new() };
            let own = Own { map, displacements };
            LayerAtFirst { anchored: kind.anchored, winners: kind.winners, edges: kind.edges, own }
        })
        .collect();
    let mut memories: Vec<Memory> = at_first
        .iter()
        .zip(&kinds)
        .map(|(layer, &kind)| Memory::new(layer.own.map.clone(), &layer.own.displacements, &grid, kind))
        .collect();
    let mut parts = Vec::new();
    for (memory, kind) in memories.iter_mut().zip(&kinds) {
        let Memory { maps: [front, back, third], winners, edges, seats, displacements } = memory;
        let lay = |memory| Galpixmap::<L, _>::over(grid, budget, memory);
        let (front, back, scratch) = (lay(front)?, lay(back)?, Scratch { winners, edges });
        parts.push((kind.anchored, front, back, lay(third)?, scratch, seats, displacements));
    }
    let mut parts = parts.into_iter();
    let mut layers = Vec::new();
    let Some((_, front, back, _, scratch, ..)) = parts.next() else { unreachable!("there is a base") };
    let base = Controller::new(front, back, scratch)?;
    for (anchored, front, back, third, scratch, seats, displacements) in parts {
        layers.push(match anchored {
            true => layers::Layer::anchored(front, displacements, back, third, scratch.winners, seats)?,
            false => layers::Layer::new(front, back, scratch, seats)?,
        });
    }
    let Ok(layers) = <[_; HIDDEN]>::try_from(layers) else { unreachable!("as many as were asked for") };
    let mut layers = layers::Layers::new(base, layers)?;
    layers.set_frame(plan.frame);
    let shown = |layers: &layers::Layers<'_, L, Chosen<L>, HIDDEN>| Shown {
        map: planes(layers.front()),
        layers: (0..layers.front().grid().cells()).map(|cell| layers.layer_at(cell) as u32).collect(),
    };
    let first = shown(&layers);
    let frames = (0..plan.frames)
        .map(|_| {
            let tally = layers.step(&plan.settings);
            let counts = std::iter::once(&tally.base).chain(&tally.hidden).map(|&tally| tally.into()).collect();
            LayersAfter { counts, shown: tally.shown.to_vec(), showing: shown(&layers) }
        })
        .collect();
    let after = (0..=HIDDEN)
        .map(|layer| Own {
            map: layers.layer_mut(layer).map(|map| planes(map)).unwrap_or_default(),
            displacements: layers.displacements_mut(layer).map(|words| words.to_vec()).unwrap_or_default(),
        })
        .collect();
    Ok(Content::Layers(Layers {
        setting: setting::<L>(bits, &record, plan.grid),
        making: plan.making(),
        layers: at_first,
        first,
        frames,
        after,
    }))
}
