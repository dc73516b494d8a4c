//! A frame with constant work and one that skips what its picture does not need give the same bits: all planes, tally, winners
//! and edges.

#[path = "../../galpix-core/benches/common/pictures.rs"]
mod pictures;

use galpix_core::fill::Rung;
use galpix_core::frame::{Scratch, Settings, Work, step};
use galpix_core::galpixel::{Budget, Chosen, Class, Profile, Static};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::Wings;
use galpix_core::layout::{Flat565, Full, Layout, Shaded, Still, Tagged, Velocity565, VelocityGray4};
use galpix_core::rounding::Rounding;
use galpix_core::tally::Tally;
use galpix_tests::layouts::{Deep, Flat565WithoutDepth, TinyPlane};
use galpix_tests::lent::{Shape, Trace, traces, with_maps, words};
use galpix_tests::profiles::{Odd, Panel, Paper, Scene, Slide, Uneven};
use galpix_tests::random;
use galpix_tests::stage::{self, settings_in_turn};
use pictures::Picture;

const FRAMES: u32 = 8;

const fn shape(width: u32, height: u32, left: u32, right: u32, top: u32, bottom: u32) -> Shape {
    Shape { width, height, wings: Wings { left, right, top, bottom } }
}

/// One cell, one row, one column, a chunk of the fast pass and its neighbours, wings on all sides and on some.
const SHAPES: [Shape; 9] = [
    Shape::plain(1, 1),
    Shape::plain(1, 9),
    Shape::plain(150, 1),
    Shape::plain(2, 2),
    Shape::plain(64, 5),
    Shape::plain(65, 4),
    Shape::plain(33, 7),
    shape(11, 6, 2, 3, 1, 4),
    shape(1, 1, 0, 70, 0, 1),
];

/// Which of its memories a frame is lent.
#[derive(Clone, Copy, Debug)]
enum Lent {
    Both,
    Winners,
    Edges,
    Neither,
}

/// Some frames, with as much scratch memory as there is.
fn frames<L: Layout, B: Budget<L>>(
    shape: Shape,
    budget: B,
    content: &[u32],
    settings: &Settings,
    lent: Lent,
) -> Vec<Trace> {
    let (winners, edges) = match lent {
        Lent::Both => (true, true),
        Lent::Winners => (true, false),
        Lent::Edges => (false, true),
        Lent::Neither => (false, false),
    };
    let cells = shape.cells() as usize;
    let mut winners = vec![7; if winners { cells } else { 0 }];
    let mut edges = vec![7; if edges { cells.div_ceil(32) } else { 0 }];
    with_maps::<L, B, _>(shape, budget, Some(content), |mut front, mut back| {
        // A frame counter that wraps.
        [u32::MAX, 0, 1]
            .map(|frame| {
                let mut scratch = Scratch { winners: &mut winners, edges: &mut edges };
                let tally = step(&front, &mut back, &mut scratch, settings, frame);
                std::mem::swap(&mut front, &mut back);
                Trace { tally, words: words(&front), winners: winners.clone(), edges: edges.clone() }
            })
            .into()
    })
}

/// Random words; or the same with few empty cells, one class per patch, and motion and depth in their low bits only, so that
/// there are surfaces, cracks and collisions.
fn rubbish<L: Layout>(budget: Chosen<L>, shape: Shape, seed: u64) -> Vec<u32> {
    let record = *budget.record();
    let cells = shape.cells() as usize;
    let mut content = random::words(seed, cells * record.words());
    if seed.is_multiple_of(3) {
        return content;
    }
    let mut keep = |field: galpix_core::record::Field, bits: u32| {
        // Fields that straddle are left as they are.
        if field.present() && field.spill == 0 && u32::from(field.bits) > bits {
            let mask = ((1u32 << (u32::from(field.bits) - bits)) - 1) << (u32::from(field.shift) + bits);
            for word in &mut content[usize::from(field.word) * cells..][..cells] {
                *word &= !mask;
            }
        }
    };
    for (component, scale) in record.scales.iter().enumerate() {
        keep(record.velocity(component), scale.velocity_frac + 1);
        keep(record.acceleration(component), 2);
    }
    keep(record.depth(), u32::from(record.depth().bits) / 2);
    let class = record.class();
    let mut generator = random::generator(seed);
    for cell in 0..cells {
        let word = &mut content[usize::from(class.word) * cells + cell];
        let kind = match random::below(&mut generator, 24) {
            0..=3 => Class::Empty,
            4 => Class::Debris,
            5 => Class::JustUnobscured,
            _ => Class::Galpixel,
        };
        *word = *word & !(3 << class.shift) | (kind as u32) << class.shift;
    }
    content
}

/// What frames did, in sum: a test that never met a bullet hole says nothing about bullet holes.
#[derive(Default)]
struct Seen(Tally);

impl Seen {
    fn add(&mut self, trace: &Trace) {
        let (sum, tally) = (&mut self.0, trace.tally);
        for (sum, count) in [
            (&mut sum.moved, tally.moved),
            (&mut sum.lost, tally.lost),
            (&mut sum.collided, tally.collided),
            (&mut sum.saturated, tally.saturated),
            (&mut sum.bullets, tally.bullets),
            (&mut sum.debris, tally.debris),
            (&mut sum.galdebris, tally.galdebris),
            (&mut sum.empty, tally.empty),
        ] {
            *sum += count;
        }
    }
}

fn assert_same(skipping: &[Trace], constant: &[Trace], what: &str) {
    assert_eq!(skipping.len(), constant.len());
    for (n, (a, b)) in (1..).zip(skipping.iter().zip(constant)) {
        a.assert_same(b, &format!("{what} frame {n}"));
    }
}

/// Both modes on rubbish, for budgets fixed at compile time and chosen at run time.
fn same_on_rubbish<L: Layout, P: Profile>() -> Seen {
    let (fixed, chosen) = (Static::<P>::new(), Chosen::<L>::new(P::BITS).unwrap());
    let depth_bits = chosen.record().depth().bits;
    let mut seen = Seen::default();
    let mut turn = 0;
    for shape in SHAPES {
        for rung in Rung::ALL {
            for reach in 1..=3 {
                turn += 1;
                let content = rubbish(chosen, shape, turn);
                let rounding = Rounding::ALL[turn as usize % Rounding::ALL.len()];
                let lent = [Lent::Both, Lent::Both, Lent::Both, Lent::Winners, Lent::Edges, Lent::Neither];
                let lent = lent[turn as usize / 2 % lent.len()];
                let edge_threshold = [0, 1 << (depth_bits / 2), u32::MAX][turn as usize / 5 % 3];
                let skipping =
                    Settings { rounding, rung, reach, edge_threshold, ..Settings::for_depth(depth_bits.into()) };
                let constant = Settings { work: Work::Constant, ..skipping };
                let what = format!("{shape:?} {lent:?} {constant:?}, turn {turn}");
                let one = frames::<L, _>(shape, fixed, &content, &skipping, lent);
                assert_same(&one, &frames::<L, _>(shape, fixed, &content, &constant, lent), &what);
                assert_same(&one, &frames::<L, _>(shape, chosen, &content, &constant, lent), &what);
                one.iter().for_each(|trace| seen.add(trace));
            }
        }
    }
    seen
}

macro_rules! rubbish_in {
    ($($test:ident = $layout:ty, $profile:ty;)*) => {$(
        #[test]
        fn $test() {
            let Seen(seen) = same_on_rubbish::<$layout, $profile>();
            assert!(seen.moved > 0 && seen.empty > 0, "{seen:?}");
            let lanes = <$layout as Layout>::LANES;
            if lanes.velocity {
                assert!(seen.lost > 0 && seen.collided > 0, "{seen:?}");
                assert!(seen.bullets > 0 && seen.debris > 0 && seen.galdebris > 0, "{seen:?}");
            }
            assert_eq!(seen.saturated > 0, lanes.acceleration, "{seen:?}");
        }
    )*};
}

rubbish_in! {
    rubbish_in_the_papers_galpixels = Full, Paper;
    rubbish_in_tagged_galpixels = Tagged, Odd;
    rubbish_in_shaded_galpixels = Shaded, Uneven;
    rubbish_in_flat_galpixels = Flat565, Scene;
    rubbish_in_flat_galpixels_without_depth = Flat565WithoutDepth, Scene;
    rubbish_in_sliding_galpixels = Velocity565, Slide;
    rubbish_in_the_smallest_galpixels = VelocityGray4, Panel;
    rubbish_in_the_deepest_galpixels = Deep, Slide;
    rubbish_in_a_plane_of_gray = TinyPlane, Uneven;
    rubbish_in_a_picture_that_does_not_move = Still, Paper;
}

/// Both modes on all built-in scenes.
fn same_on_scenes<L: Layout, B: Budget<L>>(budget: B) {
    for (turn, stage) in stage::all().enumerate() {
        let content = stage.content::<L, _>(budget, |_| ());
        for skipping in settings_in_turn(turn, budget.record().depth().bits) {
            let constant = Settings { work: Work::Constant, ..skipping };
            let one = traces::<L, _>(stage.shape, budget, &content, &skipping, FRAMES);
            let other = traces::<L, _>(stage.shape, budget, &content, &constant, FRAMES);
            assert_same(&one, &other, &format!("{} {constant:?}", stage.scene.name()));
        }
    }
}

#[test]
fn scenes_of_the_papers_galpixels() {
    same_on_scenes::<Full, _>(Static::<Paper>::new());
}

#[test]
fn scenes_of_shaded_galpixels() {
    same_on_scenes::<Shaded, _>(Static::<Scene>::new());
}

#[test]
fn scenes_of_sliding_galpixels() {
    same_on_scenes::<Velocity565, _>(Static::<Slide>::new());
}

#[test]
fn scenes_with_lanes_left_out_at_run_time() {
    same_on_scenes::<Shaded, _>(Chosen::with_lanes(Scene::BITS, Flat565::LANES).unwrap());
}

/// The pictures that constant work is measured on.
fn same_on_pictures<L: Layout, P: Profile>() {
    for shape in [Shape::plain(96, 64), shape(60, 20, 9, 0, 3, 2)] {
        for picture in Picture::ALL {
            let content =
                with_maps::<L, _, _>(shape, Static::<P>::new(), None, |mut front: Galpixmap<'_, L, Static<P>>, _| {
                    picture.paint(&mut front);
                    words(&front)
                });
            for skipping in settings_in_turn(1, Chosen::<L>::new(P::BITS).unwrap().record().depth().bits) {
                let constant = Settings { work: Work::Constant, ..skipping };
                let one = traces::<L, _>(shape, Static::<P>::new(), &content, &skipping, FRAMES);
                let other = traces::<L, _>(shape, Static::<P>::new(), &content, &constant, FRAMES);
                assert_same(&one, &other, &format!("{} {constant:?}", picture.name()));
            }
        }
    }
}

#[test]
fn pictures_that_ask_for_much_or_little() {
    same_on_pictures::<Full, Paper>();
    same_on_pictures::<Shaded, Uneven>();
    same_on_pictures::<Velocity565, Slide>();
}
