//! The same strategies over stationary sources: every object is a layer as large as its rendering.
//!
//! A rendering replaces the layer of its object as a whole. One that is late first steps the frames that it missed.

use galpix_core::source::{Gather, Source, Sources, Visibility, link_words};
use galpix_core::{Class, Dynamic, FillMode, Format, Galpixmap, Grid, Margin, Settings, SetupError};

use super::run::{Carry, Deliver, Run};
use super::world::Rendering;
use crate::engine::{Canvas, EngineError, margin};

/// A layer's memory between frames.
struct LayerMemory {
    /// Columns and rows without the margin, and the margin.
    shape: (u32, u32, Margin),
    starts: Vec<u32>,
    map: Vec<u32>,
    displacements: Vec<u32>,
    links: Vec<u32>,
}

impl LayerMemory {
    /// Makes an empty layer.
    fn new(shape: (u32, u32, Margin), format: Dynamic) -> Result<Self, SetupError> {
        let (width, height, margin) = shape;
        let mut starts = vec![0; Grid::rows(height, margin)];
        let grid = Grid::new(width, height, margin, &mut starts)?;
        let mut map = vec![0; Galpixmap::words(&grid, format)];
        Galpixmap::new(grid, format, &mut map)?;
        let (cells, words) = (grid.cells() as usize, link_words(&grid));
        Ok(Self { shape, starts, map, displacements: vec![0; cells], links: vec![0; words] })
    }

    /// Lays the layer over its memory, as it was.
    fn lay(&mut self, format: Dynamic) -> Result<Source<'_, Dynamic>, SetupError> {
        let (width, height, margin) = self.shape;
        let grid = Grid::new(width, height, margin, &mut self.starts)?;
        Source::new(Galpixmap::over(grid, format, &mut self.map)?, &mut self.displacements, &mut self.links)
    }
}

impl Run<'_> {
    /// Makes and compares the frames.
    pub(super) fn stationary(&mut self, frames: u32, format: Dynamic) -> Result<(), EngineError> {
        let world = self.world;
        let margin = margin(world.scene.margin());
        let display = (world.scene.width() as u32, world.scene.height() as u32, margin);
        let fill_mode = if self.carry == Carry::Colours { FillMode::Extend } else { FillMode::None };
        let settings = Settings { fill_mode, ..Settings::for_depth(format.record().depth().bits.into()) };
        let objects = if matches!(self.deliver, Deliver::View { .. }) { 1 } else { world.cells().len() };
        let mut layers = Vec::new();
        for object in 0..objects {
            let shape = if object == 0 { display } else { (1, 1, Margin::NONE) };
            layers.push(LayerMemory::new(shape, format)?);
        }
        let mut starts = vec![0; Grid::rows(display.1, margin)];
        let grid = Grid::new(display.0, display.1, margin, &mut starts)?;
        let cells = grid.cells() as usize;
        let (mut keys, mut words) = (vec![0; cells], vec![0; cells]);
        let mut line = vec![0; Visibility::line_half_words(&grid)];
        let mut canvas = Canvas::new(&grid, None);
        let sub_cell = self.carry == Carry::Colours;
        let gather = Gather { fill_mode, sub_cell, edge_threshold: settings.edge_threshold };
        for frame in 0..=frames {
            let mut delivered = Vec::new();
            for (object, layer) in layers.iter_mut().enumerate() {
                let stamp = if frame == 0 { Some(0) } else { self.deliver.rendered(object, objects, frame) };
                if let Some(stamp) = stamp {
                    let rendering = if objects == 1 { world.view(stamp) } else { world.rendering(object, stamp) };
                    let shape =
                        if object == 0 { display } else { (rendering.size[0], rendering.size[1], Margin::NONE) };
                    *layer = LayerMemory::new(shape, format)?;
                    let mut source = layer.lay(format)?;
                    self.write(&mut source, &rendering, object == 0, settings.edge_threshold);
                    for missed in stamp..frame {
                        source.step(settings.rounding, missed);
                    }
                    delivered.push(object);
                    if frame > 0 {
                        self.sent(&rendering);
                    }
                }
            }
            let mut sources = Vec::new();
            for (object, layer) in layers.iter_mut().enumerate() {
                let mut source = layer.lay(format)?;
                if frame > 0 && !delivered.contains(&object) {
                    source.step(settings.rounding, frame - 1);
                }
                sources.push(source);
            }
            let mut sources = Sources::new(&mut sources, Visibility::new(&grid, &mut keys, &mut words, &mut line)?)?;
            sources.show(&settings);
            if frame == 0 {
                continue;
            }
            let shown = |x: u32, y: u32| grid.row((y + margin.top) as i32).map(|start| start + x + margin.left);
            let pixels = (0..display.1).flat_map(|y| (0..display.0).map(move |x| (x, y)));
            match self.carry {
                Carry::Colours => {
                    let colours = canvas.paint(&sources, gather);
                    let words = pixels.filter_map(|(x, y)| colours.get(shown(x, y)? as usize).copied());
                    self.compare_picture(words, format.record().colour_format(), frame);
                }
                Carry::Points => {
                    for (x, y) in pixels {
                        let place = shown(x, y).and_then(|cell| place(&sources, cell));
                        self.compare_place(place, frame);
                    }
                }
            }
        }
        Ok(())
    }

    /// Writes a rendering as a new layer. The base is as large as the map; all others are as large as the rendering.
    fn write(&mut self, source: &mut Source<'_, Dynamic>, rendering: &Rendering, is_base: bool, edge_threshold: u32) {
        let Rendering { place, size, .. } = rendering;
        let place = place.map(|number| number as i32);
        let (inside, begins) = if is_base { (place, [0, 0]) } else { ([0, 0], place) };
        for (at, cell) in (0..).zip(&rendering.cells) {
            let (x, y) = ((at % size[0]) as i32, (at / size[0]) as i32);
            let galpixel = self.galpixel(cell);
            source.map_mut().store(inside[0] + x, inside[1] + y, &galpixel);
        }
        source.begin_at(begins, edge_threshold);
    }
}

/// Returns the sample that a cell shows, and the column and row of the display to which its offset is added.
fn place(sources: &Sources<'_, '_, Dynamic>, cell: u32) -> Option<(galpix_core::Galpixel, [f64; 2])> {
    let (layer, stored) = sources.shown(cell)?;
    let source = sources.layers().get(layer)?;
    let (width, margin) = (source.map().grid().width(), sources.base()?.grid().margin());
    let (x, y) = ((stored % width) as i32, (stored / width) as i32);
    let galpixel = source.map().load(x, y).filter(|galpixel| galpixel.class == Class::Galpixel)?;
    let [dx, dy] = source.displacement(stored);
    Some((galpixel, [f64::from(x + dx - margin.left as i32), f64::from(y + dy - margin.top as i32)]))
}
