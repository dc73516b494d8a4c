//! Cases of layers: their content, and the core run over their inputs.

use galpix_core::layers::{self, Layer, Stationary, composite_words, displacement_word};
use galpix_core::{Dynamic, Galpixmap, Grid, Scratch, SetupError, stages};
use schemars::JsonSchema;
use serde::Serialize;

use crate::case::{Content, Counts, Making, Setting};
use crate::maps::{Picture, Random, words};
use crate::run::{GridMemory, Memory, Model, Plan, RunError, planes};

/// Layers, and some frames of them.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Layers {
    /// Widths, fields, places, size.
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
    /// Whether it is a stationary-source layer.
    #[serde(rename = "anchored")]
    pub stationary: bool,
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
    /// Its own galpixels; of a stationary-source layer what is stored.
    pub map: Vec<u32>,
    /// Of a stationary-source layer the word of the displacement of each cell; else empty.
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
    /// Returns the arrays of a case by their names.
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

/// A hidden layer, as it is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Hidden {
    /// What its map shows.
    pub picture: Picture,
    /// Whether it is a stationary-source layer.
    pub stationary: bool,
    /// Whether it has a winner map.
    pub winners: bool,
    /// Whether it has an edge map.
    pub edges: bool,
}

/// Memory of a hidden layer.
struct LayerMemory {
    maps: [Vec<u32>; 3],
    winners: Vec<u32>,
    edges: Vec<u32>,
    composited: Vec<u32>,
    displacements: Vec<u32>,
}

impl LayerMemory {
    fn new(layer: &LayerAtFirst, grid: &Grid<'_>) -> Self {
        let LayerAtFirst { winners, edges, own: Own { map, displacements }, .. } = layer;
        let empty = vec![0; map.len()];
        Self {
            maps: [map.clone(), empty.clone(), empty],
            winners: vec![0; if *winners { grid.cells() as usize } else { 0 }],
            edges: vec![0; if *edges { stages::words(grid) } else { 0 }],
            composited: vec![0; composite_words(grid)],
            displacements: displacements.clone(),
        }
    }

    fn layer<'m>(
        &'m mut self,
        grid: Grid<'m>,
        format: Dynamic,
        stationary: bool,
    ) -> Result<Layer<'m, Dynamic>, SetupError> {
        let Self { maps: [first, second, third], winners, edges, composited, displacements } = self;
        let lay = |memory| Galpixmap::over(grid, format, memory);
        if stationary {
            return Layer::stationary(
                Stationary { stored: lay(first)?, displacements },
                lay(second)?,
                lay(third)?,
                winners,
                composited,
            );
        }
        Layer::new(lay(first)?, lay(second)?, Scratch { winners, edges }, composited)
    }
}

/// Draws displacements of a few cells, and some at the ends of their range.
fn displacements(cells: u32, random: &mut Random) -> Vec<u32> {
    let mut one = || match random.below(16) {
        0 => [-32768, 32767, 32766][random.below(3) as usize],
        _ => random.below(7) as i32 - 3,
    };
    (0..cells).map(|_| displacement_word([one(), one()])).collect()
}

impl Model {
    /// Makes frames of a base that shows the plan's picture and of further layers.
    pub fn layered(&self, plan: &Plan, hidden: &[Hidden], random: &mut Random) -> Result<Content, RunError> {
        let mut starts = GridMemory::new(plan.grid);
        let grid = starts.grid()?;
        let base = Hidden { picture: plan.picture, stationary: false, winners: true, edges: true };
        let at_first: Vec<LayerAtFirst> = std::iter::once(&base)
            .chain(hidden)
            .map(|&Hidden { picture, stationary, winners, edges }| {
                let map = words(picture, self.record(), &plan.grid, random);
                let displacements = if stationary { displacements(grid.cells(), random) } else { Vec::new() };
                LayerAtFirst { stationary, winners, edges, own: Own { map, displacements } }
            })
            .collect();
        let mut base = Memory::new(&at_first[0].own.map, &grid, true);
        let mut memories: Vec<LayerMemory> = at_first[1..].iter().map(|layer| LayerMemory::new(layer, &grid)).collect();
        let mut hidden_layers = Vec::new();
        for (memory, kind) in memories.iter_mut().zip(hidden) {
            hidden_layers.push(memory.layer(grid, self.format, kind.stationary)?);
        }
        let mut layers = layers::Layers::new(base.controller(grid, self.format)?, &mut hidden_layers)?;
        layers.set_frame(plan.frame);
        let showing = |layers: &layers::Layers<'_, '_, Dynamic>| Shown {
            map: planes(layers.front()),
            layers: (0..grid.cells()).map(|cell| layers.layer_at(cell) as u32).collect(),
        };
        let first = showing(&layers);
        let frames = (0..plan.frames)
            .map(|_| {
                let base = if plan.constant_time {
                    layers.step_constant_time(&plan.settings)
                } else {
                    layers.step(&plan.settings)
                };
                let tallies = layers.hidden().iter().map(|layer| *layer.tally());
                LayersAfter {
                    counts: std::iter::once(base).chain(tallies).map(Counts::from).collect(),
                    shown: layers.hidden().iter().map(Layer::shown).collect(),
                    showing: showing(&layers),
                }
            })
            .collect();
        let after = (0..=hidden.len())
            .map(|layer| Own {
                map: layers.layer_mut(layer).map(|map| planes(map)).unwrap_or_default(),
                displacements: layers.displacements_mut(layer).map(|words| words.to_vec()).unwrap_or_default(),
            })
            .collect();
        Ok(Content::Layers(Layers {
            setting: self.setting(plan.grid),
            making: plan.making(),
            layers: at_first,
            first,
            frames,
            after,
        }))
    }
}
