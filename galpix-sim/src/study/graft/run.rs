//! One strategy of delivering updates, run over a scene: in maps that move. [`super::stationary`] does it over sources.

use galpix_core::layers::{Layer, Layers, composite_words};
use galpix_core::objects::{Limits, Object, ObjectsTally, Places, Queue};
use galpix_core::{
    Bits, Class, Colour, Controller, Dynamic, FillMode, Galpixel, Galpixmap, Grid, Layout, Scratch, Settings,
    SetupError, scan_out, stages,
};

use super::report::{GraftedReport, RefusedReport, StrategyReport};
use super::world::{Rendering, World};
use crate::engine::{EngineError, Scheme, galpixel, margin};
use crate::metric;
use crate::picture::Picture;
use crate::source::scene::{self, jet::Jet, surface::Point};

type Maps<'p> = (Galpixmap<'p, Dynamic>, Galpixmap<'p, Dynamic>, Scratch<'p>, &'p mut [u32]);

/// How updates are delivered.
#[derive(Clone, Copy, Debug)]
pub(super) enum Deliver {
    /// What is seen, into one map: the paper's global update.
    View { every: u32 },
    /// Every object in its layer, all at once.
    Layers { every: u32 },
    /// Objects by their tags.
    Objects { objects_every: u32, background_every: u32, late: u32, limits: Limits, updates: usize },
}

/// A strategy and its name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strategy {
    pub name: &'static str,
    pub scheme: Scheme,
    pub deliver: Deliver,
}

impl Deliver {
    /// Returns the longest time without news of something.
    pub fn longest(self) -> u32 {
        match self {
            Self::View { every } | Self::Layers { every } => every,
            Self::Objects { background_every, objects_every, late, .. } => background_every.max(objects_every) + late,
        }
    }

    /// Returns the frame at which the rendering of an object is exact that enters at `frame`; `None` if none does.
    /// Renderings are spread over the period, and the first ones do not enter before the frame at which they are exact.
    pub fn rendered(self, object: usize, objects: usize, frame: u32) -> Option<u32> {
        match self {
            Self::View { every } | Self::Layers { every } => frame.is_multiple_of(every).then_some(frame),
            Self::Objects { objects_every, background_every, late, .. } => {
                let every = if object == 0 { background_every } else { objects_every };
                let phase = every * object as u32 / objects as u32;
                let stamp = frame.checked_sub(late).filter(|&stamp| stamp > 0)?;
                (stamp + phase).is_multiple_of(every).then_some(stamp)
            }
        }
    }

    /// Returns the frames between renderings of an object and of the background, and how late they enter.
    pub const fn periods(self) -> [u32; 3] {
        match self {
            Self::View { every } | Self::Layers { every } => [every, every, 0],
            Self::Objects { objects_every, background_every, late, .. } => [objects_every, background_every, late],
        }
    }
}

/// What galpixels carry as their colours.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Carry {
    Colours,
    /// Numbers of the points that they are, so that each can be compared with its true place. Nothing is filled then.
    Points,
}

/// A run of a strategy, and sums over its frames.
pub(super) struct Run<'w> {
    pub world: &'w World,
    pub deliver: Deliver,
    pub carry: Carry,
    report: StrategyReport,
    cells: u64,
    galpixels: u64,
    /// Sum of distances and their number: objects, background.
    apart: [(f64, u64); 2],
    decibels: Vec<f64>,
    picture: Option<Picture>,
    points: Vec<(usize, Point)>,
}

/// Runs a strategy twice, once for the pictures and once for the places.
pub(super) fn run(
    world: &World,
    strategy: &Strategy,
    frames: u32,
    bits: Bits,
) -> Result<(StrategyReport, Picture), EngineError> {
    let format = Dynamic::new(bits, Layout::SHADED)?;
    let ran = |carry: Carry| {
        let mut run = Run::new(world, strategy.deliver, carry);
        match strategy.scheme {
            Scheme::Map => run.layered(frames, format)?,
            Scheme::Source => run.stationary(frames, format)?,
        }
        Ok::<_, EngineError>(run)
    };
    let (pictures, places) = (ran(Carry::Colours)?, ran(Carry::Points)?);
    let mean = |(sum, count): (f64, u64)| if count == 0 { 0.0 } else { sum / count as f64 };
    let count = f64::from(frames.max(1));
    let [objects_every, background_every, late] = strategy.deliver.periods();
    let report = StrategyReport {
        strategy: strategy.name,
        objects_every,
        background_every,
        late,
        cells_per_frame: pictures.cells as f64 / count,
        galpixels_per_frame: pictures.galpixels as f64 / count,
        psnr_db: metric::pooled_db(&pictures.decibels),
        flip: pictures.report.flip / count,
        objects_px: mean(places.apart[0]),
        background_px: mean(places.apart[1]),
        missing: places.report.missing / count,
        ..pictures.report
    };
    let whole = Picture::filled(world.scene.width(), world.scene.height(), [0; 3]);
    Ok((report, pictures.picture.unwrap_or(whole)))
}

struct LayerMemory {
    front: Vec<u32>,
    back: Vec<u32>,
    winners: Vec<u32>,
    edges: Vec<u32>,
    composited: Vec<u32>,
}

impl LayerMemory {
    fn new(grid: &Grid<'_>, words: usize) -> Self {
        Self {
            front: vec![0; words],
            back: vec![0; words],
            winners: vec![0; grid.cells() as usize],
            edges: vec![0; stages::words(grid)],
            composited: vec![0; composite_words(grid)],
        }
    }

    /// Returns two empty maps over this memory, and what else a layer needs.
    fn maps<'p>(&'p mut self, grid: Grid<'p>, format: Dynamic) -> Result<Maps<'p>, SetupError> {
        let Self { front, back, winners, edges, composited } = self;
        let scratch = Scratch { winners, edges };
        Ok((Galpixmap::new(grid, format, front)?, Galpixmap::new(grid, format, back)?, scratch, composited))
    }
}

impl<'w> Run<'w> {
    fn new(world: &'w World, deliver: Deliver, carry: Carry) -> Self {
        Self {
            world,
            deliver,
            carry,
            report: StrategyReport { worst_psnr_db: f64::INFINITY, ..StrategyReport::default() },
            cells: 0,
            galpixels: 0,
            apart: [(0.0, 0); 2],
            decibels: Vec::new(),
            picture: None,
            points: Vec::new(),
        }
    }

    /// Lays out the maps and the queue, and makes the frames.
    fn layered(&mut self, frames: u32, format: Dynamic) -> Result<(), EngineError> {
        let scene = self.world.scene;
        let margin = margin(scene.margin());
        let mut starts = vec![0; Grid::rows(scene.height() as u32, margin)];
        let grid = Grid::new(scene.width() as u32, scene.height() as u32, margin, &mut starts)?;
        let words = Galpixmap::words(&grid, format);
        let hidden = match self.deliver {
            Deliver::View { .. } => 0,
            _ => self.world.cells().len() - 1,
        };
        let mut base = LayerMemory::new(&grid, words);
        let mut memory: Vec<LayerMemory> = (0..hidden).map(|_| LayerMemory::new(&grid, words)).collect();
        let (front, back, scratch, _) = base.maps(grid, format)?;
        let base = Controller::new(front, back, scratch)?;
        let mut hidden = Vec::with_capacity(memory.len());
        for memory in &mut memory {
            let (front, back, scratch, composited) = memory.maps(grid, format)?;
            hidden.push(Layer::new(front, back, scratch, composited)?);
        }
        let mut maps = Layers::new(base, &mut hidden)?;
        let depth_bits = u32::from(maps.front().record().depth().bits);
        let fill_mode = if self.carry == Carry::Colours { FillMode::Extend } else { FillMode::None };
        let settings = Settings { fill_mode, ..Settings::for_depth(depth_bits) };
        let Deliver::Objects { limits, updates, .. } = self.deliver else {
            self.frames(frames, &mut maps, &settings, None);
            return Ok(());
        };
        let (mut one, mut several) = (Places::<1>::new(), Places::<8>::new());
        let places = if updates == 1 { one.as_mut_view() } else { several.as_mut_view() };
        let mut memory = vec![0; Queue::words(format, limits.cells)];
        let mut queue = Queue::new(format, limits, places, &mut memory)?;
        self.frames(frames, &mut maps, &settings, Some(&mut queue));
        Ok(())
    }

    /// Makes and compares the frames.
    fn frames(
        &mut self,
        frames: u32,
        maps: &mut Layers<'_, '_, Dynamic>,
        settings: &Settings,
        mut queue: Option<&mut Queue<'_, Dynamic>>,
    ) {
        let world = self.world;
        for frame in 0..=frames {
            if frame > 0 {
                maps.step(settings);
            }
            let objects = world.cells().len();
            match (self.deliver, queue.as_deref_mut()) {
                (Deliver::View { .. }, _) => {
                    if let Some(stamp) = self.deliver.rendered(0, 1, frame) {
                        self.store(maps, 0, &world.view(stamp), frame > 0);
                    }
                }
                (Deliver::Objects { .. }, Some(queue)) if frame > 0 => {
                    for object in 0..objects {
                        if let Some(stamp) = self.deliver.rendered(object, objects, frame) {
                            self.submit(maps, queue, object, stamp);
                        }
                    }
                    self.grafted(queue.apply(maps, settings.rounding, u32::MAX));
                    let refusals = queue.refusals();
                    self.report.refused = RefusedReport {
                        total: refusals.total(),
                        cells: refusals.cells,
                        queue: refusals.queue,
                        memory: refusals.memory,
                        age: refusals.age,
                    };
                }
                (Deliver::Layers { .. }, _) if self.deliver.rendered(0, objects, frame).is_none() => {}
                _ => {
                    for object in 0..objects {
                        self.store(maps, object, &world.rendering(object, frame), frame > 0);
                    }
                }
            }
            maps.composite();
            if frame > 0 {
                match self.carry {
                    Carry::Colours => {
                        let rows =
                            (0..maps.front().grid().display_height()).flat_map(|y| scan_out::row(maps.front(), y));
                        self.compare_picture(rows, maps.front().record().colour_format(), frame);
                    }
                    Carry::Points => self.compare_places(maps.front(), frame),
                }
            }
        }
    }

    /// Returns a galpixel for a cell of a rendering.
    pub(super) fn galpixel(&mut self, cell: &Option<(crate::update::Sample, Point)>) -> Galpixel {
        let Some((sample, point)) = cell else { return Galpixel { class: Class::Empty, ..Galpixel::default() } };
        let mut galpixel = galpixel(sample);
        if self.carry == Carry::Points {
            let [_, high, middle, low] = (self.points.len() as u32).to_be_bytes();
            galpixel.colour = [high, middle, low];
            galpixel.luminosity_rate = Default::default();
            self.points.push((usize::from(sample.tag) - 1, *point));
        }
        galpixel
    }

    pub(super) fn sent(&mut self, rendering: &Rendering) {
        self.report.renderings += 1;
        self.cells += rendering.cells.len() as u64;
        self.galpixels += rendering.cells.iter().flatten().count() as u64;
    }

    /// Replaces a whole layer by a rendering.
    fn store(&mut self, maps: &mut Layers<'_, '_, Dynamic>, layer: usize, rendering: &Rendering, counted: bool) {
        let Some(map) = maps.layer_mut(layer) else { return };
        map.clear();
        for (at, cell) in (0..).zip(&rendering.cells) {
            let (x, y) = (rendering.place[0] + at % rendering.size[0], rendering.place[1] + at / rendering.size[0]);
            map.store(x as i32, y as i32, &self.galpixel(cell));
        }
        if counted {
            self.sent(rendering);
        }
    }

    /// Hands the queue the rendering of an object that is exact at frame `stamp`.
    fn submit(&mut self, maps: &Layers<'_, '_, Dynamic>, queue: &mut Queue<'_, Dynamic>, object: usize, stamp: u32) {
        let rendering = self.world.rendering(object, stamp);
        let count = maps.front().record().words();
        let mut words = Vec::with_capacity(rendering.cells.len() * count);
        for cell in &rendering.cells {
            let galpixel = self.galpixel(cell);
            words.extend_from_slice(&maps.front().stored(&galpixel).0[..count]);
        }
        let Rendering { place, size, .. } = rendering;
        let object = Object { tag: object as u32 + 1, layer: object as u32, stamp, place, size };
        // What is refused is in the queue's own count.
        let _ = queue.submit(maps, &object, &words);
        self.sent(&rendering);
    }

    fn grafted(&mut self, tally: ObjectsTally) {
        let GraftedReport { renderings, removed, put, behind, lost, replaced } = &mut self.report.grafted;
        for (sum, more) in [
            (renderings, tally.renderings),
            (removed, tally.removed),
            (put, tally.put),
            (behind, tally.behind),
            (lost, tally.lost),
            (replaced, tally.replaced),
        ] {
            *sum += more;
        }
    }

    /// Compares a picture, of the colour words of the display, with the truth.
    pub(super) fn compare_picture(&mut self, words: impl Iterator<Item = u32>, colour: &Colour, frame: u32) {
        let world = self.world;
        let (width, height) = (world.scene.width(), world.scene.height());
        let pixels = words.map(|word| colour.to_rgb888(word)).collect();
        let mut picture = Picture { width, height, pixels };
        if let Some(overlay) = world.scene.overlay() {
            picture = overlay.over(picture);
        }
        let truth = scene::render(world.scene, f64::from(frame));
        let psnr = metric::psnr_db(&picture, &truth, None).unwrap_or(0.0);
        self.decibels.push(psnr);
        self.report.worst_psnr_db = self.report.worst_psnr_db.min(psnr);
        self.report.flip += metric::flip(&picture, &truth, None).unwrap_or(0.0);
        self.picture = Some(picture);
    }

    fn compare_places(&mut self, map: &Galpixmap<'_, Dynamic>, frame: u32) {
        let margin = map.grid().margin();
        for y in 0..map.grid().display_height() {
            for x in 0..map.grid().display_width() {
                let there = map.load((x + margin.left) as i32, (y + margin.top) as i32);
                let shown = there.filter(|shown| shown.class == Class::Galpixel);
                self.compare_place(shown.map(|shown| (shown, [f64::from(x), f64::from(y)])), frame);
            }
        }
    }

    /// Compares the place of what a pixel shows with its true place. Given is the galpixel, and the column and row of
    /// the display to which its offset is added.
    pub(super) fn compare_place(&mut self, shown: Option<(Galpixel, [f64; 2])>, frame: u32) {
        let Some((shown, cell)) = shown else {
            self.report.missing += 1.0;
            return;
        };
        let [high, middle, low] = shown.colour;
        let serial = u32::from_be_bytes([0, high, middle, low]) as usize;
        let Some(&(object, point)) = self.points.get(serial) else { return };
        let truth = self.world.scene.surfaces()[object].place(point, Jet::constant(f64::from(frame)));
        let apart = [0, 1].map(|axis| cell[axis] + shown.offset[axis].to_num::<f64>() - truth[axis].value);
        let (sum, count) = &mut self.apart[usize::from(object == 0)];
        *sum += apart[0].hypot(apart[1]);
        *count += 1;
    }
}
