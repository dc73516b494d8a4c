//! Error against run time: the certificate over all fields and steps of the format, and floats compared with the
//! engine.

use std::path::Path;

use galpix_core::{Demand, Dynamic, FillMode, Format, Rounding, Settings};
use galpix_sim::certificate::Certificate;
use galpix_sim::engine::{Engine, Scheme};
use galpix_sim::source::Source;
use galpix_sim::source::capture::ImportOptions;
use galpix_sim::source::scene;
use galpix_sim::study::error::design::{Configuration, Kept, Step};
use galpix_sim::study::error::ranges::Ranges;
use galpix_sim::study::error::reference::Reference;
use galpix_sim::study::error::{float, measure};
use galpix_tests::captures::{manifests, shared};

/// What floating point may add to an error of a pixel.
const FLOAT: f64 = 1e-6;

fn demand(reference: &Reference<'_>) -> Demand {
    let side = reference.update.display_width().max(reference.update.display_height()) as u32;
    let prop = reference.frames.max(2).next_power_of_two();
    Demand { extent: side.next_power_of_two(), recog: 8, prop }
}

/// What was checked.
#[derive(Default)]
struct Checked {
    frames: u32,
    /// Galpixels that a range stopped: outside of the certificate.
    saturated: u32,
    /// The largest part of a bound that was reached.
    reached: f64,
}

/// Holds a source against the certificate, in fields and steps of the budget that other tests do not run.
fn hold_to_the_certificate(source: &Source, frames: u32, checked: &mut Checked) {
    let reference = Reference::new(source, frames);
    let demand = demand(&reference);
    let ranges = Ranges::of(&reference.update, frames);
    let coarse = Step { position: -2, motion: -2, fitted: true };
    for (kept, step, rounding) in [
        (Kept::Velocity, Step::DERIVED, Rounding::LowDiscrepancy),
        (Kept::VelocityDepth, coarse, Rounding::Truncate),
        (Kept::Acceleration, Step { position: 1, ..coarse }, Rounding::Nearest),
        (Kept::Full, Step { motion: -1, ..Step::DERIVED }, Rounding::Searched),
    ] {
        let layout = kept.layout();
        let bits = step.bits(demand, layout, &ranges).unwrap();
        let format = Dynamic::new(bits, layout).unwrap();
        let record = format.record();
        let settings =
            Settings { rounding, fill_mode: FillMode::Hold, ..Settings::for_depth(u32::from(record.depth().bits)) };
        let (fill, scheme) = (FillMode::Hold.into(), Scheme::Map);
        let configuration = Configuration { kept, step, rounding, fill, scheme };
        let certificate = Certificate::of(&record.scales[0], layout.acceleration, rounding, demand.prop);
        let measured = measure::engine(&reference, &configuration, bits, settings).unwrap();
        assert_eq!(measured.frames.len(), reference.looked.len());
        for frame in measured.frames {
            let at = format!("{} {kept:?} {} {rounding:?} frame {}", source.name(), step.name(), frame.frame);
            let Some(bound) = certificate.after(frame.frame) else { continue };
            let Some(error) = frame.kept_worst_px else { continue };
            assert!(error <= bound + FLOAT, "{at}: {error} px, certified are {bound} px");
            let left_out = reference.left_out_px(layout, frame.frame);
            if frame.saturated_galpixels == 0 {
                let all = frame.worst_px.unwrap();
                assert!(all <= bound + left_out + FLOAT, "{at}: {all} px, at most {bound} + {left_out} px");
            }
            checked.frames += 1;
            checked.saturated += frame.saturated_galpixels;
            checked.reached = checked.reached.max(error / bound);
        }
    }
}

#[test]
fn every_scene_keeps_the_certificate_in_all_fields() {
    let mut checked = Checked::default();
    for scene in scene::all() {
        hold_to_the_certificate(&Source::Scene(*scene), scene.frames(), &mut checked);
    }
    println!("{} frames, {} saturated, {:.2} of a bound", checked.frames, checked.saturated, checked.reached);
    assert!(checked.frames >= 200 && checked.reached > 0.5, "{} frames, {}", checked.frames, checked.reached);
}

#[test]
fn every_capture_keeps_the_certificate_in_all_fields() {
    let mut found = manifests(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../captures"));
    match shared() {
        Some(data) => found.extend(manifests(&data)),
        None => eprintln!("../shared/data is absent: only the project's own captures are checked"),
    }
    let mut checked = Checked::default();
    for manifest in &found {
        let source = Source::open(&manifest.to_string_lossy(), &ImportOptions::default()).unwrap();
        hold_to_the_certificate(&source, source.frames().min(16), &mut checked);
    }
    println!("{} captures, {} frames, {} saturated", found.len(), checked.frames, checked.saturated);
    assert!(checked.frames > 0 && checked.reached > 0.3, "{} frames, {}", checked.frames, checked.reached);
}

#[test]
fn floats_show_what_the_engine_shows_where_nothing_moves() {
    let still = scene::find("still").unwrap();
    let update = scene::update(still, 0.0);
    let hold = update.picture();
    for kept in [Kept::Velocity, Kept::VelocityDepth, Kept::Acceleration, Kept::Full, Kept::Luminosity] {
        let mut frames = 0;
        float::run(&update, kept, FillMode::Hold, &[1, 4], |frame| {
            assert_eq!(frame.picture, hold, "{kept:?} frame {}", frame.number);
            assert!(frame.reached.iter().all(|&reached| reached));
            frames += 1;
        });
        assert_eq!(frames, 2);
    }
}

#[test]
fn floats_and_engine_agree_to_the_certificate_where_things_move() {
    for name in ["drift", "crossing", "pillars"] {
        let source = Source::open(name, &ImportOptions::default()).unwrap();
        let reference = Reference::new(&source, 8);
        let (update, kept, rounding) = (&reference.update, Kept::Full, Rounding::LowDiscrepancy);
        let bits = Step::DERIVED.bits(demand(&reference), kept.layout(), &Ranges::default()).unwrap();
        let format = Dynamic::new(bits, kept.layout()).unwrap();
        let record = format.record();
        let bound = Certificate::of(&record.scales[0], true, rounding, demand(&reference).prop).total_px;
        let settings = Settings { fill_mode: FillMode::Hold, ..Settings::for_depth(u32::from(record.depth().bits)) };
        let mut engine = vec![None; update.samples.len()];
        Engine::new(format, settings)
            .run(update, 8, |frame| {
                if frame.number == 8 {
                    for (origin, place) in frame.places() {
                        engine[origin as usize] = Some(place);
                    }
                }
            })
            .unwrap();
        let (mut both, mut one) = (0, 0);
        float::run(update, kept, FillMode::Hold, &[8], |frame| {
            for (origin, [x, y]) in frame.places {
                match engine[origin as usize].take() {
                    Some([to_x, to_y]) => {
                        let apart = f64::max((x - to_x).abs(), (y - to_y).abs());
                        assert!(apart <= bound + 1e-4, "{name}: {origin} is {apart} px apart, certified are {bound}");
                        both += 1;
                    }
                    None => one += 1,
                }
            }
        });
        one += engine.iter().flatten().count();
        // Who is hidden may differ where rounding decides between two cells.
        assert!(both > 15_000 && one * 10 < both, "{name}: {both} in both, {one} in one only");
    }
}

#[test]
fn floats_leave_black_holes_or_what_was_shown() {
    let pillars = scene::find("pillars").unwrap();
    let update = scene::update(pillars, 0.0);
    for (fill_mode, filled) in [(FillMode::None, false), (FillMode::Hold, true)] {
        float::run(&update, Kept::Full, fill_mode, &[1], |frame| {
            let before = update.picture();
            let mut holes = 0;
            for (index, _) in frame.reached.iter().enumerate().filter(|(_, reached)| !**reached) {
                let expected = if filled { before.pixels[index] } else { [0; 3] };
                assert_eq!(frame.picture.pixels[index], expected, "{fill_mode:?}");
                holes += 1;
            }
            assert!(holes > 20, "{holes} holes");
        });
    }
}
