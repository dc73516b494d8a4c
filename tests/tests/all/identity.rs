//! Two forms of the same give the same bits: a format fixed at compile time and one chosen at run time; a field
//! that is absent and one that is fed with zeros.

use fixed::types::I32F32;
use galpix_core::disocclusion::{self, Reach};
use galpix_core::inpaint::{Gamma, Motion, PushPull};
use galpix_core::objects::{Object, ObjectsTally, replace};
use galpix_core::{
    Bits, Class, Dynamic, FillMode, Format, Galpixel, Inpainting, Layout, Profile, Rounding, Settings, Static, Tally,
    stages,
};
use galpix_tests::layouts::{
    FLAT565_WITHOUT_DEPTH, SHADED_WITHOUT_ACCELERATION, SHADED_WITHOUT_DEPTH_MOTION, SHADED_WITHOUT_LUMINOSITY,
    SHADED_WITHOUT_TAG, VELOCITY565_WITHOUT_VELOCITY,
};
use galpix_tests::memory::{
    Mode, Run, Shape, Trace, assert_same, cell_words, with_controller, with_maps, with_rolling, words,
};
use galpix_tests::profiles::{PAPER, SCENE, SLIDE, STRADDLING, UNEVEN, dynamic};
use galpix_tests::random;
use galpix_tests::stage::{self, Stage, settings_in_turn};

use crate::layers::engine::with_layers;
use crate::layers::model::Kind;

const FRAMES: u32 = 8;

macro_rules! profiles {
    ($($name:ident: $layout:expr, $bits:expr;)*) => {$(
        struct $name;

        impl Profile for $name {
            const LAYOUT: Layout = $layout;
            const BITS: Bits = $bits;
        }
    )*};
}

profiles! {
    Paper: Layout::FULL, PAPER;
    Shaded: Layout::SHADED, UNEVEN;
    Sliding: Layout::VELOCITY565, SLIDE;
    Straddling: Layout::FULL, STRADDLING;
    Still: Layout::STILL, PAPER;
}

/// Compares all planes, tallies, winners and edges, on all scenes, fill modes and roundings; then what all passes make
/// of random words.
fn compile_time_is_run_time<P: Profile>() {
    let (fixed, chosen) = (Static::<P>::new(), dynamic(P::LAYOUT, P::BITS));
    assert_eq!(fixed.record(), chosen.record());
    let depth_bits = chosen.record().depth().bits;
    for (turn, stage) in stage::all().enumerate() {
        let content = stage.content(fixed, |_| ());
        assert!(content == stage.content(chosen, |_| ()), "{}: stored differently", stage.scene.name());
        for settings in settings_in_turn(turn, depth_bits) {
            let run = Run::new(settings, FRAMES);
            let (one, other) = (run.traces(stage.shape, fixed, &content), run.traces(stage.shape, chosen, &content));
            assert_same(&one, &other, &format!("{} {settings:?}", stage.scene.name()));
        }
    }
    let shapes = [Shape::plain(1, 1), Shape::plain(70, 1), Shape::new(61, 20, [3, 1, 2, 5])];
    for (seed, shape) in (0..).zip(shapes) {
        let content = random::words(seed, shape.cells() as usize * chosen.record().words());
        // Neighbours that often agree.
        let calm: Vec<u32> = content.iter().map(|word| word & 0x0410_0041).collect();
        for (content, settings) in [content, calm]
            .iter()
            .flat_map(|content| settings_in_turn(seed as usize, depth_bits).map(move |settings| (content, settings)))
        {
            let what = format!("random words, {shape:?} {settings:?}");
            Made::of(fixed, shape, content, &settings).assert_same(&Made::of(chosen, shape, content, &settings), &what);
        }
    }
}

/// What a frame of base and layer gave: its counts, and both maps' words.
type Layered = (Tally, Vec<u32>, Vec<u32>);

/// What all passes make of a map.
struct Made {
    /// Frames by each entry point.
    frames: [Vec<Trace>; 2],
    /// In one map.
    rolled: Vec<(Tally, Vec<u32>)>,
    /// As base and layer, by each entry point.
    layered: [Vec<Layered>; 2],
    /// With holes inpainted.
    inpainted: Vec<(u32, Vec<u32>)>,
    /// The disocclusion map, and as a mask.
    disoccluded: [(disocclusion::Tally, Vec<u32>); 2],
    /// With an object replaced by what the map holds already, some frames late.
    replaced: (ObjectsTally, Vec<u32>),
}

impl Made {
    fn of<F: Format>(format: F, shape: Shape, content: &[u32], settings: &Settings) -> Self {
        Self {
            frames: Mode::ALL.map(|mode| Run::new(*settings, FRAMES).by(mode).traces(shape, format, content)),
            rolled: with_rolling(shape, format, content, shape.rows(), |rolling| {
                (0..FRAMES).map(|_| (rolling.step(settings), words(rolling.map()))).collect()
            }),
            layered: Mode::ALL.map(|mode| layered(format, shape, content, settings, mode)),
            inpainted: inpainted(format, shape, content, settings),
            disoccluded: disoccluded(format, shape, content),
            replaced: replaced(format, shape, content),
        }
    }

    fn assert_same(&self, other: &Self, what: &str) {
        for (one, other) in self.frames.iter().zip(&other.frames) {
            assert_same(one, other, what);
        }
        assert!(self.rolled == other.rolled, "{what}: in one map");
        assert!(self.layered == other.layered, "{what}: as layers");
        assert!(self.inpainted == other.inpainted, "{what}: inpainted");
        assert!(self.disoccluded == other.disoccluded, "{what}: disocclusion map");
        assert!(self.replaced == other.replaced, "{what}: an object replaced");
    }
}

fn layered<F: Format>(format: F, shape: Shape, content: &[u32], settings: &Settings, mode: Mode) -> Vec<Layered> {
    let kind = Kind { winners: true, edges: true, stationary: false };
    let cells = shape.cells() as usize;
    let cell = |cell: usize| content.iter().skip(cell).step_by(cells).copied().collect::<Vec<_>>();
    // In the hidden layer everything lies elsewhere.
    let (base, layer) = ((0..cells).map(cell), (0..cells).rev().map(cell));
    let hidden = Kind { edges: false, stationary: cells % 2 == 1, ..kind };
    with_layers(shape, format, &[(kind, base.collect()), (hidden, layer.collect())], |layers| {
        let frame = |_| {
            let tally = mode.step_layers(layers, settings);
            (tally, words(layers.front()), layers.winners(1).to_vec())
        };
        (0..FRAMES).map(frame).collect()
    })
}

fn inpainted<F: Format>(format: F, shape: Shape, content: &[u32], settings: &Settings) -> Vec<(u32, Vec<u32>)> {
    let (columns, rows) = (shape.columns(), shape.rows());
    let mut memory = vec![0; PushPull::words(columns, rows, Motion::Inpainted)];
    let mut push_pull = PushPull::new(columns, rows, Motion::Inpainted, &mut memory).unwrap();
    let inpainting = Inpainting::for_depth(format.record().depth().bits.into(), Gamma::Half);
    with_controller(shape, format, Some(content), |controller| {
        let frame = |_| {
            controller.step(settings);
            (controller.inpaint(settings, &inpainting, &mut push_pull), words(controller.front()))
        };
        (0..FRAMES).map(frame).collect()
    })
}

fn disoccluded<F: Format>(format: F, shape: Shape, content: &[u32]) -> [(disocclusion::Tally, Vec<u32>); 2] {
    with_maps(shape, format, Some(content), |front, _| {
        let (mut extents, mut line) = (vec![0; shape.cells() as usize], vec![0; shape.columns() as usize]);
        let mut mask = vec![0; stages::words(front.grid())];
        let reach = Reach::new(16, 16);
        let tallies = [
            disocclusion::map(&front, &mut extents, &reach),
            disocclusion::cover(&front, &mut line, &mut mask, &reach),
        ];
        [(tallies[0], extents), (tallies[1], mask)]
    })
}

fn replaced<F: Format>(format: F, shape: Shape, content: &[u32]) -> (ObjectsTally, Vec<u32>) {
    with_maps(shape, format, Some(content), |mut map, _| {
        let object = Object { tag: 0, layer: 0, stamp: 0, place: [0, 0], size: [shape.columns(), shape.rows()] };
        let given: Vec<u32> = (0..shape.cells()).flat_map(|cell| cell_words(&map, cell)).collect();
        let tally = replace(&mut map, &object, given, Rounding::LowDiscrepancy, 3);
        (tally, words(&map))
    })
}

#[test]
fn the_papers_galpixel_and_budget() {
    compile_time_is_run_time::<Paper>();
}

#[test]
fn shaded_galpixels_and_components_that_differ() {
    compile_time_is_run_time::<Shaded>();
}

#[test]
fn sliding_galpixels() {
    compile_time_is_run_time::<Sliding>();
}

#[test]
fn a_field_that_straddles_two_words() {
    let record = Static::<Straddling>::RECORD;
    assert!((0..3).any(|component| record.velocity(component).spill + record.acceleration(component).spill > 0));
    compile_time_is_run_time::<Straddling>();
}

#[test]
fn a_picture_that_does_not_move() {
    compile_time_is_run_time::<Still>();
}

/// What a frame shows, cell by cell, in units.
fn loaded(
    stage: &Stage,
    format: Dynamic,
    change: impl Fn(&mut Galpixel),
    settings: &Settings,
    mut see: impl FnMut(Tally, Vec<Galpixel>),
) {
    let content = stage.content(format, change);
    with_controller(stage.shape, format, Some(&content), |controller| {
        for _ in 0..FRAMES {
            let tally = controller.step(settings);
            let front = controller.front();
            let columns = 0..stage.shape.columns() as i32;
            let cells = (0..stage.shape.rows() as i32).flat_map(|y| columns.clone().map(move |x| (x, y)));
            see(tally, cells.map(|(x, y)| front.load(x, y).unwrap()).collect());
        }
    });
}

/// A layout with a field that is fed with zeros, and one that lacks it.
struct Absent {
    bits: Bits,
    more: Layout,
    less: Layout,
    /// Makes the field zero.
    zero: fn(&mut Galpixel),
    /// Removes what a map without the field cannot hold.
    forget: fn(&mut Galpixel),
    /// The fill modes that need the field.
    needed_by: &'static [FillMode],
}

impl Absent {
    fn is_zero(&self) {
        let [more, less] = [self.more, self.less].map(|layout| dynamic(layout, self.bits));
        for (turn, stage) in stage::all().enumerate() {
            for settings in settings_in_turn(turn, less.record().depth().bits) {
                if self.needed_by.contains(&settings.fill_mode) {
                    continue;
                }
                let mut frames = Vec::new();
                loaded(&stage, more, self.zero, &settings, |tally, cells| frames.push((tally, cells)));
                let mut frames = frames.into_iter();
                loaded(
                    &stage,
                    less,
                    |_| (),
                    &settings,
                    |tally, cells| {
                        let (more_tally, more_cells) = frames.next().unwrap();
                        let at = format!("{} {settings:?}", stage.scene.name());
                        assert_eq!(tally, more_tally, "{at}");
                        for (cell, (mut less, mut more)) in cells.into_iter().zip(more_cells).enumerate() {
                            (self.forget)(&mut less);
                            (self.forget)(&mut more);
                            assert_eq!(less, more, "{at}: cell {cell}");
                        }
                    },
                );
            }
        }
    }
}

#[test]
fn an_absent_acceleration_is_none() {
    let absent = Absent {
        bits: PAPER,
        more: Layout::SHADED,
        less: SHADED_WITHOUT_ACCELERATION,
        zero: |g| g.acceleration = [I32F32::ZERO; 3],
        forget: |_| (),
        needed_by: &[],
    };
    absent.is_zero();
}

#[test]
fn an_absent_depth_motion_is_none() {
    let absent = Absent {
        bits: PAPER,
        more: Layout::SHADED,
        less: SHADED_WITHOUT_DEPTH_MOTION,
        zero: |g| (g.velocity[2], g.acceleration[2]) = (I32F32::ZERO, I32F32::ZERO),
        forget: |_| (),
        needed_by: &[],
    };
    absent.is_zero();
}

#[test]
fn an_absent_tag_is_0() {
    let absent = Absent {
        bits: PAPER,
        more: Layout::SHADED,
        less: SHADED_WITHOUT_TAG,
        zero: |g| g.tag = 0,
        forget: |_| (),
        needed_by: &[],
    };
    absent.is_zero();
}

#[test]
fn an_absent_luminosity_rate_is_none() {
    let absent = Absent {
        bits: PAPER,
        more: Layout::SHADED,
        less: SHADED_WITHOUT_LUMINOSITY,
        zero: |g| g.luminosity_rate = I32F32::ZERO,
        forget: |_| (),
        needed_by: &[],
    };
    absent.is_zero();
}

/// Debris without motion is stored as far away as can be, which only a map with a depth can hold. There it is on an
/// edge, so that bullet holes beside it differ.
#[test]
fn an_absent_depth_is_0_everywhere() {
    let absent = Absent {
        bits: SCENE,
        more: Layout::FLAT565,
        less: FLAT565_WITHOUT_DEPTH,
        zero: |g| g.depth = I32F32::ZERO,
        forget: |g| {
            if g.class != Class::Galpixel {
                g.depth = I32F32::ZERO;
            }
        },
        needed_by: &[FillMode::Bullet],
    };
    absent.is_zero();
}

#[test]
fn an_absent_velocity_is_none() {
    let absent = Absent {
        bits: SLIDE,
        more: Layout::VELOCITY565,
        less: VELOCITY565_WITHOUT_VELOCITY,
        zero: |g| g.velocity = [I32F32::ZERO; 3],
        forget: |_| (),
        needed_by: &[],
    };
    absent.is_zero();
}
