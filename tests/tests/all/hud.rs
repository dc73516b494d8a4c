//! Instruments over a moving world: exactly right in every frame, with every fill, and invisible to the engine.

use galpix_core::{Bits, Format, Layout, Settings};
use galpix_sim::engine::Engine;
use galpix_sim::engine::fill::Fill;
use galpix_sim::source::Source;
use galpix_sim::source::scene;
use galpix_sim::study::run::{self as experiment, Request};
use galpix_sim::update::Update;
use galpix_tests::memory::words;
use galpix_tests::profiles::dynamic;

/// Every frame's picture, the words of its map, what it counted and what was reached.
fn run(update: &Update, fill: Fill, mut visit: impl FnMut(u32, galpix_sim::picture::Picture, Vec<u32>, Vec<bool>)) {
    let request = Request { fill, ..Request::default() };
    let format = dynamic(Layout::FULL, Bits::derive(request.demand(update, 24)).unwrap());
    let settings = Settings { fill_mode: fill.mode(), ..Settings::for_depth(u32::from(format.record().depth().bits)) };
    let engine = Engine::new(format, settings).inpainting(fill.inpaint());
    engine
        .run(update, 24, |frame| {
            visit(frame.number, frame.picture(), words(frame.map().expect("a map")), frame.reached())
        })
        .expect("it runs");
}

#[test]
fn pinned_pixels_are_the_truths_in_every_frame_with_every_fill() {
    let hud = scene::find("hud").expect("a built-in scene");
    let update = scene::update(hud, 0.0);
    let overlay = update.overlay.clone().expect("it has instruments");
    let lines = overlay.pixels.windows(3).filter(|w| w[0].is_none() && w[1].is_some() && w[2].is_none()).count();
    assert!(overlay.pinned() > 1500 && lines > 100, "{} pinned, {lines} lines of a pixel", overlay.pinned());
    let bare = Update { overlay: None, ..update.clone() };
    for fill in Fill::all() {
        let mut without = Vec::new();
        run(&bare, fill, |_, picture, words, reached| without.push((picture, words, reached)));
        let mut frames = 0;
        run(&update, fill, |number, picture, words, reached| {
            let truth = scene::render(hud, f64::from(number));
            let (bare, bare_words, bare_reached) = &without[number as usize];
            assert!(words == *bare_words, "frame {number}: the engine does not know of the overlay");
            let mut covered = 0;
            for at in 0..overlay.pixels.len() {
                let (shown, below) = (picture.pixels[at], bare.pixels[at]);
                match overlay.pixels[at] {
                    Some(pinned) => {
                        assert!(shown == pinned && shown == truth.pixels[at] && reached[at], "frame {number}, {at}");
                        covered += usize::from(below != pinned);
                    }
                    None => assert!(shown == below && reached[at] == bare_reached[at], "frame {number}, {at}"),
                }
            }
            assert!(covered > 1000, "the world goes on underneath");
            frames += 1;
        });
        assert_eq!(frames, 25, "the update and each frame, with {}", fill.name());
    }
}

/// What a run reports counts the pinned pixels as right, and sample-and-hold has them too.
#[test]
fn a_report_compares_under_the_instruments() {
    let source = Source::open("hud", &Default::default()).unwrap();
    let mut frames = 0;
    let report =
        experiment::run(&source, &Request { frames: Some(3), perceptual: false, ..Request::default() }, |shown| {
            let overlay = source.update().overlay.unwrap();
            for (at, pinned) in overlay.pixels.iter().enumerate() {
                if let Some(pinned) = pinned {
                    let truth = &shown.truth.expect("a scene knows it").picture;
                    assert!([shown.picture, shown.hold, truth].iter().all(|picture| picture.pixels[at] == *pinned));
                }
            }
            frames += 1;
        });
    assert_eq!((report.unwrap().frames.len(), frames), (3, 4));
}
