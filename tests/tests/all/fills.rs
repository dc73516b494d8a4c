//! The comparison of fills: figures within their ranges, and foreground that stays out of what it uncovered.

use galpix_sim::engine::fill::{Fill, Gamma};
use galpix_sim::source::Source;
use galpix_sim::source::capture::ImportOptions;
use galpix_sim::study::fills::case::{self, CLASSIC};
use galpix_sim::study::fills::report::{FillReport, SourceReport};
use galpix_sim::study::fills::{Plan, study};
use galpix_sim::study::run::Request;

fn compared(name: &str, frames: u32, fills: &[&str], gamma: Option<Gamma>, fovea: Option<u32>) -> SourceReport {
    let mut cases = case::all(gamma, fovea);
    cases.retain(|case| fills.is_empty() || fills.contains(&case.name));
    let plan = Plan {
        request: Request { frames: Some(frames), prop: Some(frames.max(2).next_power_of_two()), ..Request::default() },
        cases,
        left_out: Vec::new(),
        fovea,
    };
    let source = Source::open(name, &ImportOptions::default()).unwrap();
    study(&source, &plan, None, || {}).unwrap().expect("something is disoccluded")
}

fn of<'r>(report: &'r SourceReport, name: &str) -> &'r FillReport {
    report.fills.iter().find(|fill| fill.name == name).expect("a fill")
}

#[test]
fn every_fill_has_figures_within_their_ranges() {
    let report = compared("crossing", 4, &[], None, None);
    assert_eq!(report.fills.len(), case::all(None, None).len());
    assert!(report.cells.len() == 4 && report.cells.iter().all(|cells| cells.disoccluded > 30), "{:?}", report.cells);
    for cells in &report.cells {
        assert_eq!(cells.missing, cells.disoccluded + cells.at_border);
    }
    for fill in &report.fills {
        for figures in fill.frames.iter().map(|frame| frame.figures).chain([fill.summary]) {
            assert!((0.0..60.0).contains(&figures.psnr_db.unwrap()), "{}: {figures:?}", fill.name);
            assert!((-1.0..=1.0).contains(&figures.ssim.unwrap()), "{}: {figures:?}", fill.name);
            assert!((0.0..=1.0).contains(&figures.flip.unwrap()), "{}: {figures:?}", fill.name);
            assert!((0.0..128.0 * 128.0).contains(&figures.variance.unwrap()), "{}: {figures:?}", fill.name);
            assert!(figures.ssimulacra2.unwrap() < 100.0, "{}: {figures:?}", fill.name);
        }
        assert_eq!(fill.frames[0].figures.flicker, None, "there is no frame before the first");
        assert!(fill.frames[3].figures.flicker.unwrap().abs() < 255.0);
        assert!(fill.time.unwrap().x_copy > 0.1, "{}: {:?}", fill.name, fill.time);
    }
    // Black is the worst that can be put into a street, and what was there before is worse than what lies next to it.
    let psnr = |name: &str| of(&report, name).summary.psnr_db.unwrap();
    assert!(psnr("none") < psnr("hold") && psnr("hold") < psnr("extend"));
}

#[test]
fn foreground_that_stays_out_is_seen_in_the_figures() {
    for (name, frames, least_db) in [("crossing", 12, 0.5), ("ball", 6, 0.2), ("fovea", 3, 0.5)] {
        let report = compared(name, frames, &[CLASSIC, "push-pull"], None, None);
        let psnr = |name: &str| of(&report, name).summary.psnr_db.unwrap();
        let gained = psnr("push-pull") - psnr(CLASSIC);
        println!("{name}: {:.2} dB, classic {:.2} dB", psnr("push-pull"), psnr(CLASSIC));
        assert!(gained > least_db, "{name}: {gained} dB");
    }
}

#[test]
fn a_fovea_is_neither_inpainted_nor_judged() {
    let whole = compared("fovea", 2, &["extend", "push-pull"], None, None);
    let around = compared("fovea", 2, &["extend", "push-pull"], None, Some(70));
    assert!(around.disoccluded() > 0 && around.disoccluded() < whole.disoccluded());
    // With a fovea as large as the display, push-pull is the fill mode that it stands on.
    let source = Source::open("fovea", &ImportOptions::default()).unwrap();
    let shown = |fill: Fill| {
        let mut pictures = Vec::new();
        let request = Request { fill, frames: Some(2), prop: Some(2), perceptual: false, ..Request::default() };
        galpix_sim::study::run::run(&source, &request, |frame| pictures.push(frame.picture.clone())).unwrap();
        pictures
    };
    let push_pull = |fovea| case::all(None, fovea).into_iter().find(|case| case.name == "push-pull").unwrap().fill;
    assert_eq!(shown(push_pull(Some(1000))), shown(Fill::default()));
    assert_ne!(shown(push_pull(Some(70))), shown(Fill::default()));
    assert_ne!(shown(push_pull(Some(70))), shown(push_pull(None)));
}

#[test]
fn nothing_is_compared_where_nothing_is_disoccluded() {
    let source = Source::open("still", &ImportOptions::default()).unwrap();
    let request = Request { frames: Some(2), prop: Some(2), ..Request::default() };
    let plan = Plan { request, cases: case::all(None, None), left_out: Vec::new(), fovea: None };
    assert!(study(&source, &plan, None, || panic!("no fill is run")).unwrap().is_none());
}
