//! Two ways of saying the same give the same bits: a budget fixed at compile time and one chosen at run time; a lane that is
//! absent and one that is fed with zeros.

use fixed::types::I32F32;
use galpix_core::frame::Settings;
use galpix_core::galpixel::{Budget, Chosen, Class, Galpixel, Profile, Static};
use galpix_core::layout::{Flat565, Full, Layout, Shaded, Still, Tagged, Velocity565, VelocityGray4, VelocityGray8};
use galpix_core::tally::Tally;
use galpix_tests::layouts::{
    Flat565WithoutDepth, ShadedWithoutAcceleration, ShadedWithoutDepthMotion, ShadedWithoutLuminosity,
    ShadedWithoutTag, Velocity565WithoutVelocity,
};
use galpix_tests::lent::{self, Shape, Trace, with_controller};
use galpix_tests::profiles::{Odd, Panel, Paper, Scene, Slide, Uneven};
use galpix_tests::stage::{self, Stage, settings_in_turn as settings};

const FRAMES: u32 = 8;

/// The words of a stage in a layout.
fn content<L: Layout, B: Budget<L>>(stage: &Stage, budget: B, change: impl Fn(&mut Galpixel)) -> Vec<u32> {
    stage.content::<L, B>(budget, change)
}

fn traces<L: Layout, B: Budget<L>>(shape: Shape, budget: B, content: &[u32], settings: &Settings) -> Vec<Trace> {
    lent::traces::<L, B>(shape, budget, content, settings, FRAMES)
}

/// All planes, tallies, winners and edges, on all scenes, rungs and roundings.
fn compile_time_is_run_time<L: Layout, P: Profile>() {
    let fixed = Static::<P>::new();
    let chosen = Chosen::<L>::new(P::BITS).unwrap();
    let depth_bits = chosen.record().depth().bits;
    for (turn, stage) in stage::all().enumerate() {
        let loaded = content::<L, _>(&stage, fixed, |_| ());
        assert!(loaded == content::<L, _>(&stage, chosen, |_| ()), "{}: stored differently", stage.scene.name());
        for settings in settings(turn, depth_bits) {
            let at_compile_time = traces::<L, _>(stage.shape, fixed, &loaded, &settings);
            let at_run_time = traces(stage.shape, chosen, &loaded, &settings);
            for (n, (a, b)) in (1..).zip(at_compile_time.iter().zip(&at_run_time)) {
                a.assert_same(b, &format!("{} {settings:?} frame {n}", stage.scene.name()));
            }
        }
    }
}

macro_rules! identities {
    ($($test:ident = $layout:ty, $profile:ty;)*) => {$(
        #[test]
        fn $test() {
            compile_time_is_run_time::<$layout, $profile>();
        }
    )*};
}

identities! {
    the_papers_galpixel_and_budget = Full, Paper;
    tagged_galpixels_and_a_budget_of_no_power_of_two = Tagged, Odd;
    shaded_galpixels_and_components_that_differ = Shaded, Uneven;
    flat_galpixels = Flat565, Scene;
    sliding_galpixels = Velocity565, Slide;
    gray_galpixels = VelocityGray8, Panel;
    the_smallest_galpixels = VelocityGray4, Slide;
    a_picture_that_does_not_move = Still, Paper;
}

/// What a frame shows, cell by cell, in units.
fn loaded<L: Layout>(
    stage: &Stage,
    bits: galpix_core::budget::Bits,
    change: impl Fn(&mut Galpixel),
    settings: &Settings,
    mut see: impl FnMut(Tally, Vec<Galpixel>),
) {
    let budget = Chosen::<L>::new(bits).unwrap();
    let content = content(stage, budget, change);
    with_controller(stage.shape, budget, Some(&content), |controller| {
        for _ in 0..FRAMES {
            let tally = controller.step(settings);
            let front = controller.front();
            let columns = 0..stage.shape.columns() as i32;
            let cells = (0..stage.shape.rows() as i32).flat_map(|y| columns.clone().map(move |x| (x, y)));
            see(tally, cells.map(|(x, y)| front.load(x, y).unwrap()).collect());
        }
    });
}

/// `Less` lacks a lane; `More` is fed with zeros in it. `forget` takes out what no map without the lane can tell.
fn absent_is_zero<More: Layout, Less: Layout>(
    profile: impl Profile,
    zero: fn(&mut Galpixel),
    forget: fn(&mut Galpixel),
) {
    fn bits<P: Profile>(_: P) -> galpix_core::budget::Bits {
        P::BITS
    }
    let bits = bits(profile);
    let depth_bits = Chosen::<Less>::new(bits).unwrap().record().depth().bits;
    for (turn, stage) in stage::all().enumerate() {
        for settings in settings(turn, depth_bits) {
            let mut more = Vec::new();
            loaded::<More>(&stage, bits, zero, &settings, |tally, cells| more.push((tally, cells)));
            let mut more = more.into_iter();
            loaded::<Less>(
                &stage,
                bits,
                |_| (),
                &settings,
                |tally, cells| {
                    let (more_tally, more_cells) = more.next().unwrap();
                    let at = format!("{} {settings:?}", stage.scene.name());
                    assert_eq!(tally, more_tally, "{at}");
                    for (cell, (mut less, mut more)) in cells.into_iter().zip(more_cells).enumerate() {
                        forget(&mut less);
                        forget(&mut more);
                        assert_eq!(less, more, "{at}: cell {cell}");
                    }
                },
            );
        }
    }
}

#[test]
fn an_absent_acceleration_is_none() {
    absent_is_zero::<Shaded, ShadedWithoutAcceleration>(Paper, |g| g.acceleration = [I32F32::ZERO; 3], |_| ());
}

#[test]
fn an_absent_depth_motion_is_none() {
    absent_is_zero::<Shaded, ShadedWithoutDepthMotion>(
        Paper,
        |g| (g.velocity[2], g.acceleration[2]) = (I32F32::ZERO, I32F32::ZERO),
        |_| (),
    );
}

#[test]
fn an_absent_tag_is_0() {
    absent_is_zero::<Shaded, ShadedWithoutTag>(Paper, |g| g.tag = 0, |_| ());
}

#[test]
fn an_absent_luminosity_rate_is_none() {
    absent_is_zero::<Shaded, ShadedWithoutLuminosity>(Paper, |g| g.luminosity_rate = I32F32::ZERO, |_| ());
}

/// Debris without motion is stored as far away as can be, which only a map with a depth can tell.
#[test]
fn an_absent_depth_is_0_everywhere() {
    absent_is_zero::<Flat565, Flat565WithoutDepth>(
        Scene,
        |g| g.depth = I32F32::ZERO,
        |g| {
            if g.class != Class::Galpixel {
                g.depth = I32F32::ZERO;
            }
        },
    );
}

#[test]
fn an_absent_velocity_is_none() {
    absent_is_zero::<Velocity565, Velocity565WithoutVelocity>(Slide, |g| g.velocity = [I32F32::ZERO; 3], |_| ());
}

/// All planes, tallies, winners and edges of a layout that lacks lanes, and of one that leaves them out at run time.
fn left_out_is_absent<More: Layout, Less: Layout<Colour = More::Colour>>(profile: impl Profile) {
    fn bits<P: Profile>(_: P) -> galpix_core::budget::Bits {
        P::BITS
    }
    let bits = bits(profile);
    let absent = Chosen::<Less>::new(bits).unwrap();
    let left_out = Chosen::<More>::with_lanes(bits, Less::LANES).unwrap();
    for (turn, stage) in stage::all().enumerate() {
        let stored = content(&stage, absent, |_| ());
        assert!(stored == content(&stage, left_out, |_| ()), "{}: stored differently", stage.scene.name());
        for settings in settings(turn, absent.record().depth().bits) {
            let one = traces(stage.shape, absent, &stored, &settings);
            let other = traces(stage.shape, left_out, &stored, &settings);
            for (n, (a, b)) in (1..).zip(one.iter().zip(&other)) {
                a.assert_same(b, &format!("{} {settings:?} frame {n}", stage.scene.name()));
            }
        }
    }
}

#[test]
fn a_lane_left_out_at_run_time_is_absent() {
    left_out_is_absent::<Shaded, Full>(Paper);
    left_out_is_absent::<Shaded, Still>(Paper);
    left_out_is_absent::<Shaded, ShadedWithoutAcceleration>(Odd);
    left_out_is_absent::<Shaded, ShadedWithoutDepthMotion>(Paper);
    left_out_is_absent::<Flat565, Velocity565>(Scene);
    left_out_is_absent::<Flat565, Velocity565WithoutVelocity>(Scene);
}

#[test]
fn a_lane_that_the_layout_lacks_is_refused() {
    for lanes in [Shaded::LANES, Full::LANES] {
        assert!(Chosen::<Flat565>::with_lanes(Paper::BITS, lanes).is_err());
    }
}
