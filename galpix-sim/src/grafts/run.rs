//! One way of delivering updates, run over a scene.

use galpix_core::budget::Bits;
use galpix_core::edge;
use galpix_core::fill::Rung;
use galpix_core::frame::{Controller, Scratch, Settings};
use galpix_core::galpixel::{Chosen, Class, Galpixel};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::Grid;
use galpix_core::layers::{Layer, Layers, seat_words};
use galpix_core::layout::Shaded;
use galpix_core::objects::{Limits, Object, ObjectsTally, Queue};
use galpix_core::scan_out;

use super::report::{GraftedReport, RefusedReport, WayReport};
use super::world::{Rendering, World};
use crate::engine::{EngineError, core_wings, galpixel};
use crate::metric;
use crate::picture::Picture;
use crate::scene::{self, jet::Jet, surface::Point};

type Maps<'p, const HIDDEN: usize> = Layers<'p, Shaded, Chosen<Shaded>, HIDDEN>;

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

/// A way and its name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    pub name: &'static str,
    pub deliver: Deliver,
}

impl Deliver {
    /// The longest time without news of something.
    pub fn longest(self) -> u32 {
        match self {
            Self::View { every } | Self::Layers { every } => every,
            Self::Objects { background_every, objects_every, late, .. } => background_every.max(objects_every) + late,
        }
    }
}

/// What galpixels carry as their colours.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Carry {
    Colours,
    /// Numbers of the points that they are, so that each can be compared with its true place. Nothing is filled then.
    Points,
}

/// Sums over the frames of a run.
#[derive(Default)]
struct Sums {
    report: WayReport,
    cells: u64,
    galpixels: u64,
    /// Sum of distances and their number: objects, background.
    apart: [(f64, u64); 2],
    decibels: Vec<f64>,
    picture: Option<Picture>,
    points: Vec<(usize, Point)>,
}

/// Runs a way twice, once for the pictures and once for the places.
pub(super) fn run(world: &World, way: &Way, frames: u32, bits: Bits) -> Result<(WayReport, Picture), EngineError> {
    let hidden = match way.deliver {
        Deliver::View { .. } => 0,
        _ => world.cells().len() - 1,
    };
    let dispatched = |carry, sums: &mut Sums| match hidden {
        0 => layered::<0>(world, way, frames, bits, carry, sums),
        1 => layered::<1>(world, way, frames, bits, carry, sums),
        2 => layered::<2>(world, way, frames, bits, carry, sums),
        3 => layered::<3>(world, way, frames, bits, carry, sums),
        4 => layered::<4>(world, way, frames, bits, carry, sums),
        5 => layered::<5>(world, way, frames, bits, carry, sums),
        6 => layered::<6>(world, way, frames, bits, carry, sums),
        _ => layered::<7>(world, way, frames, bits, carry, sums),
    };
    let (mut pictures, mut places) = (Sums::default(), Sums::default());
    dispatched(Carry::Colours, &mut pictures)?;
    dispatched(Carry::Points, &mut places)?;
    let mean = |(sum, count): (f64, u64)| if count == 0 { 0.0 } else { sum / count as f64 };
    let count = f64::from(frames.max(1));
    let report = WayReport {
        way: way.name,
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

fn layered<const HIDDEN: usize>(
    world: &World,
    way: &Way,
    frames: u32,
    bits: Bits,
    carry: Carry,
    sums: &mut Sums,
) -> Result<(), EngineError> {
    let (scene, budget) = (world.scene, Chosen::<Shaded>::new(bits)?);
    let wings = core_wings(scene.wings());
    let mut starts = vec![0; Grid::rows(scene.height() as u32, wings)];
    let grid = Grid::new(scene.width() as u32, scene.height() as u32, wings, &mut starts)?;
    let words = Galpixmap::<Shaded, _>::words(&grid, budget);
    let mut memory: Vec<LayerMemory> = (0..=HIDDEN).map(|_| LayerMemory::new(&grid, words)).collect();
    let mut hidden = Vec::new();
    let mut base = None;
    for memory in &mut memory {
        let LayerMemory { front, back, winners, edges, seats } = memory;
        let (front, back) = (Galpixmap::new(grid, budget, front)?, Galpixmap::new(grid, budget, back)?);
        let scratch = Scratch { winners, edges };
        if base.is_none() {
            base = Some(Controller::new(front, back, scratch)?);
        } else {
            hidden.push(Layer::new(front, back, scratch, seats)?);
        }
    }
    let (Some(base), Ok(hidden)) = (base, <[Layer<'_, _, _>; HIDDEN]>::try_from(hidden)) else { return Ok(()) };
    let mut maps = Layers::new(base, hidden)?;
    let depth_bits = u32::from(maps.front().record().depth().bits);
    let rung = if carry == Carry::Colours { Rung::Extend } else { Rung::None };
    let settings = Settings { rung, ..Settings::for_depth(depth_bits) };
    match way.deliver {
        Deliver::Objects { limits, updates: 1, .. } => {
            let mut memory = vec![0; Queue::<Shaded, _, 1>::words(budget, limits.cells)];
            let mut queue = Queue::<Shaded, _, 1>::new(budget, limits, &mut memory)?;
            frames_of(world, way, frames, carry, sums, &mut maps, &settings, Some(&mut queue));
        }
        Deliver::Objects { limits, .. } => {
            let mut memory = vec![0; Queue::<Shaded, _, 8>::words(budget, limits.cells)];
            let mut queue = Queue::<Shaded, _, 8>::new(budget, limits, &mut memory)?;
            frames_of(world, way, frames, carry, sums, &mut maps, &settings, Some(&mut queue));
        }
        _ => frames_of::<HIDDEN, 1>(world, way, frames, carry, sums, &mut maps, &settings, None),
    }
    Ok(())
}

struct LayerMemory {
    front: Vec<u32>,
    back: Vec<u32>,
    winners: Vec<u32>,
    edges: Vec<u32>,
    seats: Vec<u32>,
}

impl LayerMemory {
    fn new(grid: &Grid<'_>, words: usize) -> Self {
        Self {
            front: vec![0; words],
            back: vec![0; words],
            winners: vec![0; grid.cells() as usize],
            edges: vec![0; edge::words(grid)],
            seats: vec![0; seat_words(grid)],
        }
    }
}

#[expect(clippy::too_many_arguments, reason = "what a run is made of, named once")]
fn frames_of<const HIDDEN: usize, const UPDATES: usize>(
    world: &World,
    way: &Way,
    frames: u32,
    carry: Carry,
    sums: &mut Sums,
    maps: &mut Maps<'_, HIDDEN>,
    settings: &Settings,
    mut queue: Option<&mut Queue<'_, Shaded, Chosen<Shaded>, UPDATES>>,
) {
    sums.report.worst_psnr_db = f64::INFINITY;
    for frame in 0..=frames {
        if frame > 0 {
            maps.step(settings);
        }
        match (way.deliver, queue.as_deref_mut()) {
            (Deliver::View { every }, _) => {
                (sums.report.objects_every, sums.report.background_every) = (every, every);
                if frame % every == 0 {
                    let rendering = world.view(frame);
                    sums.store(maps, 0, &rendering, carry, frame > 0);
                }
            }
            (Deliver::Objects { objects_every, background_every, late, .. }, Some(queue)) if frame > 0 => {
                sums.report.late = late;
                (sums.report.objects_every, sums.report.background_every) = (objects_every, background_every);
                let objects = world.cells().len();
                for object in 0..objects {
                    // Spread over the period, and the first renderings not before the frame that they are exact at.
                    let every = if object == 0 { background_every } else { objects_every };
                    let phase = every * object as u32 / objects as u32;
                    if frame >= late && (frame - late + phase).is_multiple_of(every) && frame != late {
                        sums.submit(world, maps, queue, object, frame, late, carry);
                    }
                }
                sums.grafted(queue.apply(maps, settings.rounding, u32::MAX));
                let refusals = queue.refusals();
                sums.report.refused = RefusedReport {
                    total: refusals.total(),
                    cells: refusals.cells,
                    queue: refusals.queue,
                    memory: refusals.memory,
                    age: refusals.age,
                };
            }
            (Deliver::Layers { every }, _) if frame % every != 0 => {
                (sums.report.objects_every, sums.report.background_every) = (every, every);
            }
            _ => {
                for object in 0..world.cells().len() {
                    let rendering = world.rendering(object, frame);
                    sums.store(maps, object, &rendering, carry, frame > 0);
                }
            }
        }
        maps.resolve(settings.work);
        if frame > 0 {
            match carry {
                Carry::Colours => sums.compare_picture(world, maps.front(), frame),
                Carry::Points => sums.compare_places(world, maps.front(), frame),
            }
        }
    }
}

impl Sums {
    /// A galpixel for a cell of a rendering.
    fn galpixel(&mut self, cell: &Option<(crate::update::Sample, Point)>, carry: Carry) -> Galpixel {
        let Some((sample, point)) = cell else { return Galpixel { class: Class::Empty, ..Galpixel::default() } };
        let mut galpixel = galpixel(sample);
        if carry == Carry::Points {
            let [_, high, middle, low] = (self.points.len() as u32).to_be_bytes();
            galpixel.colour = [high, middle, low];
            galpixel.luminosity_rate = Default::default();
            self.points.push((usize::from(sample.tag) - 1, *point));
        }
        galpixel
    }

    fn sent(&mut self, rendering: &Rendering) {
        self.report.renderings += 1;
        self.cells += rendering.cells.len() as u64;
        self.galpixels += rendering.cells.iter().flatten().count() as u64;
    }

    /// Replaces a whole layer by a rendering.
    fn store<const HIDDEN: usize>(
        &mut self,
        maps: &mut Maps<'_, HIDDEN>,
        layer: usize,
        rendering: &Rendering,
        carry: Carry,
        counted: bool,
    ) {
        let Some(map) = maps.layer_mut(layer) else { return };
        map.clear();
        for (at, cell) in (0..).zip(&rendering.cells) {
            let (x, y) = (rendering.place[0] + at % rendering.size[0], rendering.place[1] + at / rendering.size[0]);
            map.store(x as i32, y as i32, &self.galpixel(cell, carry));
        }
        if counted {
            self.sent(rendering);
        }
    }

    #[expect(clippy::too_many_arguments, reason = "what a rendering is made of, named once")]
    fn submit<const HIDDEN: usize, const UPDATES: usize>(
        &mut self,
        world: &World,
        maps: &Maps<'_, HIDDEN>,
        queue: &mut Queue<'_, Shaded, Chosen<Shaded>, UPDATES>,
        object: usize,
        frame: u32,
        late: u32,
        carry: Carry,
    ) {
        let rendering = world.rendering(object, frame - late);
        let count = maps.front().record().words();
        let mut words = Vec::with_capacity(rendering.cells.len() * count);
        for cell in &rendering.cells {
            let galpixel = self.galpixel(cell, carry);
            words.extend_from_slice(&maps.front().stored(&galpixel).0[..count]);
        }
        let Rendering { place, size, .. } = rendering;
        let stamp = maps.frame().wrapping_sub(late);
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

    fn compare_picture(&mut self, world: &World, map: &Galpixmap<'_, Shaded, Chosen<Shaded>>, frame: u32) {
        use galpix_core::colour::{Colour, Rgb888};
        let (width, height) = (world.scene.width(), world.scene.height());
        let pixels = (0..height as u32).flat_map(|y| scan_out::row(map, y)).map(Rgb888::to_rgb888).collect();
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

    fn compare_places(&mut self, world: &World, map: &Galpixmap<'_, Shaded, Chosen<Shaded>>, frame: u32) {
        let (wings, t) = (map.grid().wings(), Jet::constant(f64::from(frame)));
        for y in 0..map.grid().display_height() {
            for x in 0..map.grid().display_width() {
                let there = map.load((x + wings.left) as i32, (y + wings.top) as i32);
                let Some(shown) = there.filter(|shown| shown.class == Class::Galpixel) else {
                    self.report.missing += 1.0;
                    continue;
                };
                let [high, middle, low] = shown.colour;
                let serial = u32::from_be_bytes([0, high, middle, low]) as usize;
                let Some(&(object, point)) = self.points.get(serial) else { continue };
                let truth = world.scene.surfaces()[object].place(point, t);
                let offset = shown.offset.map(|offset| offset.to_num::<f64>());
                let apart = [f64::from(x) + offset[0] - truth[0].value, f64::from(y) + offset[1] - truth[1].value];
                let (sum, count) = &mut self.apart[usize::from(object == 0)];
                *sum += apart[0].hypot(apart[1]);
                *count += 1;
            }
        }
    }
}
