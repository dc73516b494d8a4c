//! A plan never claims what its certificate does not hold.

use galpix_core::Static;
use galpix_sim::source::Source;
use galpix_sim::source::capture::ImportOptions;
use galpix_sim::source::scene;
use galpix_sim::study::plan::{self, Planning};
use galpix_sim::study::run::Request;
use galpix_tests::captures::{manifests, shared};

fn planned(source: &Source, max_error: f64) -> Planning {
    let request = Request { perceptual: false, ..Request::default() };
    plan::plan(source, &request, [max_error, max_error / 4.0], || {})
        .unwrap_or_else(|error| panic!("{}: {error}", source.name()))
}

/// What holds of any plan.
fn check(planning: &Planning) {
    let name = &planning.source;
    for plan in std::iter::once(&planning.plan).chain(&planning.tighter) {
        let at = format!("{name}, {} px: {plan:?}", plan.max_error_px);
        assert!(plan.motion.certified_px <= plan.max_error_px, "{at}");
        if plan.measured.saturated == 0 {
            assert_ne!(plan.measured.within_certificate, Some(false), "{at}");
        }
        assert!(plan.stored_bytes_per_galpixel <= planning.full.stored_bytes_per_galpixel, "{at}");
        assert_eq!(plan.stored_bytes_per_galpixel, plan.used_bits_per_galpixel.div_ceil(32) as usize * 4, "{at}");
        assert!(plan.measured.frame_us > 0.0 && !plan.reasons.is_empty(), "{at}");
    }
    if let Some(tighter) = &planning.tighter {
        // Depth and fill mode are what the pictures need: only the plane is sure to need no less.
        assert!(tighter.motion.velocity >= planning.plan.motion.velocity, "{name}");
        assert!(tighter.motion.certified_px <= tighter.max_error_px, "{name}");
    }
}

#[test]
fn plans_of_all_scenes_hold_what_they_claim() {
    let mut moved = 0;
    for &scene in scene::all() {
        let planning = planned(&Source::Scene(scene), 0.5);
        check(&planning);
        // What is left are depths that reach the near or the far end.
        let [planned, full] = [&planning.plan.measured, &planning.full.measured].map(|measured| measured.saturated);
        assert!(planned <= full, "{}: {planned} fields are clamped, {full} in the full budget", scene.name());
        moved += u32::from(planning.plan.motion.velocity);
    }
    assert!(moved >= 8, "{moved} scenes move");
}

#[test]
fn a_still_scene_plans_to_nothing_but_colour() {
    let planning = planned(&Source::Scene(scene::find("still").unwrap()), 0.5);
    let plan = &planning.plan;
    assert!(!plan.motion.velocity && !plan.motion.acceleration && !plan.depth_motion && !plan.luminosity);
    assert_eq!((plan.depth_bits, plan.fill_mode, plan.used_bits_per_galpixel), (0, "none", 26));
}

#[test]
fn what_does_not_accelerate_needs_no_acceleration() {
    let planning = planned(&Source::Scene(scene::find("drift").unwrap()), 0.5);
    assert!(planning.extremes.x.acceleration == 0.0 && planning.extremes.y.acceleration == 0.0);
    assert!(planning.plan.motion.velocity && !planning.plan.motion.acceleration, "{:?}", planning.plan);
}

/// Whatever the error, more is never needed for a larger one.
#[test]
fn a_larger_error_never_needs_more() {
    let source = Source::Scene(scene::find("ramp").unwrap());
    let bits = [2.0, 1.0, 0.25, 0.06].map(|error| planned(&source, error).plan.used_bits_per_galpixel);
    assert!(bits.is_sorted(), "{bits:?}");
    assert!(bits[0] < bits[3], "{bits:?}");
}

#[test]
fn an_error_that_no_budget_keeps_is_refused() {
    let source = Source::Scene(scene::find("ball").unwrap());
    let refused = plan::plan(&source, &Request::default(), [1e-9, 1e-10], || {}).unwrap_err().to_string();
    assert!(refused.contains("no budget certifies"), "{refused}");
}

/// What `galpix plan pan --max-error 0.5` printed.
mod printed {
    include!("plan/pan.rs");
}

/// The printed lines are Rust, and make the planned layout.
#[test]
fn the_printed_code_compiles_and_is_the_plan() {
    let plan = planned(&Source::Scene(scene::find("pan").unwrap()), 0.5).plan;
    let kept = include_str!("plan/pan.rs");
    assert_eq!(plan.code.trim(), kept.trim(), "copy what is printed over tests/tests/all/plan/pan.rs");
    assert_eq!(Static::<printed::PlannedPan>::RECORD.bytes(), plan.stored_bytes_per_galpixel);
    let settings = printed::SETTINGS;
    assert_eq!((settings.fill_mode.name(), settings.rounding.name()), (plan.fill_mode, plan.motion.rounding));
}

#[test]
fn plans_of_all_captures_hold_what_they_claim() {
    let Some(folder) = shared() else {
        eprintln!("skipped: ../shared/data is absent");
        return;
    };
    let mut planned_captures = 0;
    for manifest in manifests(&folder) {
        let source = Source::open(&manifest.to_string_lossy(), &ImportOptions::default()).unwrap();
        // A few frames: what is checked is the same, and the pictures are large.
        let request = Request { perceptual: false, frames: Some(source.frames().clamp(2, 6)), ..Request::default() };
        match plan::plan(&source, &request, [1.0, 0.25], || {}) {
            Ok(planning) => check(&planning),
            Err(error) => panic!("{}: {error}", source.name()),
        }
        planned_captures += 1;
    }
    assert!(planned_captures >= 12, "{planned_captures} captures");
}
