//! What was hidden: samples are counted right, culling keeps what is needed, and no picture gets worse for it.

use galpix_core::{Bits, Dynamic, Layout, Settings};
use galpix_sim::engine::{Engine, EngineError, HiddenLayer, MAX_HIDDEN, NO_ORIGIN};
use galpix_sim::picture::Picture;
use galpix_sim::source::Source;
use galpix_sim::source::capture::ImportOptions;
use galpix_sim::source::hidden::{Arrangement, Kind, SEPARATION, Strategy};
use galpix_sim::source::scene;
use galpix_sim::study::layers::report::SourceReport;
use galpix_sim::study::layers::{Plan, Study, strategies, study};
use galpix_sim::study::run::{self as experiment, ExperimentError, Request, RunReport};
use galpix_sim::update::{Known, Sample, Update};

const SECOND: Strategy = Strategy { kind: Kind::Second { separation: SEPARATION }, ..Strategy::ONE };
const SHIPPED: Strategy = Strategy { culled: true, ..SECOND };

fn open(name: &str) -> Source {
    Source::open(name, &ImportOptions::default()).expect("a built-in scene")
}

/// Scenes in which something is hidden behind something that leaves it, and frames between two updates.
const DISOCCLUDED: [(&str, u32); 6] =
    [("pillars", 8), ("crossing", 8), ("disc", 8), ("sphere", 8), ("near-plane", 8), ("ball", 8)];

/// Returns the tau_prop of updates so many frames apart.
fn prop(frames: u32) -> Option<u32> {
    Some(frames.max(2).next_power_of_two())
}

fn run(name: &str, frames: u32, strategy: Strategy) -> (RunReport, Vec<Picture>) {
    let mut pictures = Vec::new();
    let request = Request { frames: Some(frames), prop: prop(frames), strategy, ..Request::default() };
    let report = experiment::run(&open(name), &request, |frame| pictures.push(frame.picture.clone())).unwrap();
    (report, pictures)
}

fn compared(name: &str, frames: u32) -> SourceReport {
    let request = Request { frames: Some(frames), prop: prop(frames), ..Request::default() };
    match study(&open(name), &Plan { request, strategies: strategies(SEPARATION) }, || {}).unwrap() {
        Study::Compared(report) => *report,
        _ => panic!("{name}: nothing is disoccluded"),
    }
}

#[test]
fn each_way_counts_what_it_offers_keeps_and_uses() {
    let report = compared("crossing", 6);
    assert_eq!(report.strategies.len(), strategies(SEPARATION).len());
    assert_eq!(report.strategies[0].hidden, None);
    for pair in report.strategies[1..].chunks(2) {
        let [whole, culled] = pair else { panic!("each strategy comes whole and culled") };
        let (all, kept) = (whole.hidden.as_ref().unwrap(), culled.hidden.as_ref().unwrap());
        assert!(all.offered == all.kept && all.used <= all.kept && all.used > 100, "{all:?}");
        assert!(kept.offered == all.offered && kept.kept < all.kept && kept.used <= kept.kept, "{kept:?}");
        assert!(culled.name.starts_with(&whole.name) && culled.update_us.unwrap() > 0.0 && whole.update_us.is_none());
        for strategy in [whole, culled] {
            assert!(strategy.missing < report.strategies[0].missing, "{}: {} missing", strategy.name, strategy.missing);
            assert!(strategy.disoccluded <= strategy.missing && strategy.frames.len() == 6);
            assert!(strategy.x_one.unwrap() > 0.0);
        }
    }
    // Every surface whole is the most that can be known.
    let missing = |name: &str| report.strategy(name).unwrap().missing;
    assert!(missing("unlimited") <= missing("second, separated"));
    // What is passed in front of is lost where it is not by itself.
    let disoccluded = |name: &str| report.strategy(name).unwrap().disoccluded;
    assert!(disoccluded("second, separated") < disoccluded("second, separated, behind"));
}

/// The ball takes nothing away of the park: each cell of it comes back, with its own colour.
#[test]
fn a_park_is_whole_again_behind_the_ball() {
    let (one, _) = run("ball", 12, Strategy::ONE);
    let (layered, pictures) = run("ball", 12, SHIPPED);
    let missing = |report: &RunReport| report.frames.iter().map(|frame| frame.truth.unwrap().missing).sum::<u64>();
    assert!(missing(&one) > 10_000, "{}", missing(&one));
    assert_eq!(missing(&layered), 0);
    let ball = scene::find("ball").unwrap();
    let truth = scene::render(ball, 12.0);
    let tag = |cell: usize| ball.sample((cell % truth.width) as f64, (cell / truth.width) as f64, 12.0).tag;
    let park: Vec<usize> = (0..truth.pixels.len()).filter(|&cell| tag(cell) == 1).collect();
    let wrong = park.iter().filter(|&&cell| pictures[12].pixels[cell] != truth.pixels[cell]).count();
    // The rim of the ball is where its centre snaps to.
    assert!(wrong < 60, "{wrong} of {} cells", park.len());
}

/// On scenes of many surfaces, with an update every eight frames. (Of a single thing that flies as far as the ball all
/// is uncovered.)
#[test]
fn culling_keeps_less_than_half_and_loses_next_to_nothing() {
    for (name, frames) in DISOCCLUDED.into_iter().filter(|(name, _)| *name != "ball") {
        let missing = |report: &RunReport| report.frames.iter().map(|frame| frame.truth.unwrap().missing).sum::<u64>();
        let (uncut, _) = run(name, frames, SECOND);
        let (culled, _) = run(name, frames, SHIPPED);
        let hidden = culled.hidden.as_ref().unwrap();
        println!(
            "{name}: {} of {} kept, {} -> {} missing",
            hidden.kept,
            hidden.offered,
            missing(&uncut),
            missing(&culled)
        );
        assert!(2 * hidden.kept < hidden.offered, "{name}: {hidden:?}");
        assert!(100 * missing(&culled) <= 101 * missing(&uncut), "{name}: {}, {}", missing(&culled), missing(&uncut));
    }
}

#[test]
fn no_scene_gets_worse_with_what_is_shipped() {
    for (name, frames) in DISOCCLUDED {
        let (one, _) = run(name, frames, Strategy::ONE);
        let (layered, _) = run(name, frames, SHIPPED);
        let mean = |report: &RunReport, of: fn(&experiment::TruthReport) -> f64| {
            report.frames.iter().map(|frame| of(&frame.truth.unwrap())).sum::<f64>() / f64::from(frames)
        };
        let psnr = |report| mean(report, |truth| truth.psnr_db.unwrap());
        let flip = |report| mean(report, |truth| truth.flip.unwrap());
        println!("{name}: {:.3} -> {:.3} dB, {:.5} -> {:.5}", psnr(&one), psnr(&layered), flip(&one), flip(&layered));
        // Where the motion is not of second order a rim leaves that truly does not, and what is behind is shown: no
        // more than this.
        let (worse_db, worse) = if ["disc", "near-plane"].contains(&name) { (0.2, 0.002) } else { (0.0, 0.0) };
        assert!(psnr(&layered) >= psnr(&one) - worse_db, "{name}: {} dB, {} dB", psnr(&layered), psnr(&one));
        assert!(flip(&layered) <= flip(&one) + worse, "{name}: {}, {}", flip(&layered), flip(&one));
    }
}

/// A layer in which nothing is changes no bit, and neither does one that is never seen.
#[test]
fn an_empty_layer_changes_nothing() {
    let update = scene::update(scene::find("crossing").unwrap(), 0.0);
    let empty = with(&update, |_| Sample { known: Known::ColourOnly, ..Sample::default() });
    let bits = Bits::derive(Request::default().demand(&update, 6)).unwrap();
    let engine = Engine::new(Dynamic::new(bits, Layout::FULL).unwrap(), Settings::for_depth(16));
    let shown = |hidden: &[HiddenLayer<'_>]| {
        let (mut pictures, mut origins) = (Vec::new(), Vec::new());
        let ran = engine.run_layers(&update, hidden, 6, |frame| {
            pictures.push(frame.picture());
            origins.push(frame.origins().collect::<Vec<_>>());
        });
        let cells = update.samples.len();
        assert!(ran.unwrap().used[cells..].iter().all(|used| !used));
        (pictures, origins)
    };
    let one = shown(&[]);
    assert!(one.1[6].contains(&NO_ORIGIN));
    for layers in [1, 2, 3, MAX_HIDDEN] {
        assert!(shown(&vec![HiddenLayer::Moving(&empty); layers]) == one, "{layers} empty layers");
    }
}

#[test]
fn what_cannot_be_layered_is_refused() {
    let update = scene::update(scene::find("drift").unwrap(), 0.0);
    let other = scene::update(scene::find("fovea").unwrap(), 0.0);
    let bits = Bits::derive(Request::default().demand(&update, 6)).unwrap();
    let engine = Engine::new(Dynamic::new(bits, Layout::FULL).unwrap(), Settings::for_depth(16));
    let refused =
        |hidden: &[HiddenLayer<'_>]| engine.run_layers(&update, hidden, 1, |_| panic!("nothing is shown")).unwrap_err();
    let size = refused(&[HiddenLayer::Moving(&update), HiddenLayer::Moving(&other)]);
    assert!(matches!(size, EngineError::LayerSize { width: 256, height: 192, of: [192, 144] }), "{size}");
    let count = refused(&vec![HiddenLayer::Moving(&update); MAX_HIDDEN + 1]);
    assert!(matches!(count, EngineError::TooManyLayers(9)), "{count}");
}

#[test]
fn a_capture_without_hidden_samples_says_so() {
    let marbles = concat!(env!("CARGO_MANIFEST_DIR"), "/../captures/marbles");
    let source = Source::open(marbles, &ImportOptions::default()).unwrap();
    let request = Request { frames: Some(1), prop: prop(1), strategy: SHIPPED, ..Request::default() };
    let error = experiment::run(&source, &request, |_| panic!("nothing is shown")).unwrap_err();
    assert!(matches!(error, ExperimentError::NothingHidden { .. }), "{error}");
    let sentence = error.to_string();
    assert!(sentence.contains("marbles") && sentence.contains("[update.hidden]"), "{sentence}");
    assert!(matches!(study(&source, &Plan::default(), || {}).unwrap(), Study::NothingHidden));
}

/// Two layers of a still scene are nothing but that scene.
#[test]
fn where_nothing_moves_nothing_hidden_is_shown_or_kept() {
    for arrangement in [Arrangement::Nearer, Arrangement::Farther] {
        for culled in [false, true] {
            let (report, pictures) = run("still", 3, Strategy { arrangement, culled, ..SECOND });
            let hidden = report.hidden.unwrap();
            assert_eq!((hidden.used, hidden.kept == 0), (0, culled), "{hidden:?}");
            assert!(hidden.offered > 100);
            assert_eq!(pictures, run("still", 3, Strategy::ONE).1);
            assert!(report.frames.iter().all(|frame| frame.from_hidden == Some(0)));
        }
    }
}

fn with(update: &Update, sample: impl Fn(&Sample) -> Sample) -> Update {
    Update { samples: update.samples.iter().map(sample).collect(), ..update.clone() }
}
