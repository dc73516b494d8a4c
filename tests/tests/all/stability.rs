//! The stiff and extreme suite, whatever the budget: nothing is unstable, and the strip that it runs on is the engine.

use fixed::types::I32F32;
use galpix_core::{Class, Demand, Dynamic, FillMode, Layout, Rounding, Settings};
use galpix_sim::study::stability::causes::follow;
use galpix_sim::study::stability::mover::Strip;
use galpix_sim::study::stability::verdict::Verdict;
use galpix_sim::study::stability::{self, ALL, Px, Request, Setting};
use galpix_tests::memory::{Shape, with_controller};

const PAPER: Demand = Demand { extent: 1024, recog: 8, prop: 16 };

#[test]
fn no_case_is_unstable_under_any_budget_and_rounding() {
    let odd = Demand { extent: 200, recog: 7, prop: 11 };
    let small = Demand { extent: 64, recog: 8, prop: 2 };
    for demand in [PAPER, odd, small, Demand { extent: 512, recog: 8, prop: 32 }] {
        let report = stability::run(&Request { demand, ..Request::default() }, |_| ()).unwrap();
        assert_eq!(report.cases.len(), ALL.len());
        for case in &report.cases {
            assert_eq!(case.roundings.len(), Rounding::ALL.len());
            for rounding in &case.roundings {
                assert!(
                    rounding.findings.is_empty(),
                    "{demand:?} {} {}: {:?}",
                    case.name,
                    rounding.rounding,
                    rounding.findings
                );
                assert_ne!(rounding.verdict, Verdict::Unstable);
            }
        }
        assert!(report.stable);
    }
}

/// With an update every tau_prop frames the error does not grow: the last updates are no worse than the bound of the
/// first.
#[test]
fn nothing_grows_from_update_to_update() {
    let setting = Setting::new(PAPER).unwrap();
    let case = ALL.iter().find(|case| case.name == "re-anchored").unwrap();
    for rounding in Rounding::ALL {
        for path in (case.paths)(&setting) {
            let mut strip = Strip::new(&setting, path.component, rounding).unwrap();
            let followed = follow(&path, &setting, rounding, &mut strip);
            let law = stability::Law::of(&setting, path.component, rounding, PAPER.prop);
            let off = |frames: std::ops::Range<u32>| {
                let rows = followed.rows.iter().filter(|row| frames.contains(&row.frame));
                rows.map(|row| (row.causes.quantisation + row.causes.drift).abs()).max().unwrap_or_default().to_f64()
            };
            assert_eq!(path.frames, 512);
            for update in 0..32 {
                let worst = off(16 * update..16 * update + 17);
                assert!(
                    worst <= law.bound_px(16, true),
                    "{rounding:?} {}: {worst} px after update {update}",
                    path.name
                );
            }
        }
    }
}

/// Puts the galpixel of a path on one wide map and leaves it there: each frame is what the strip gave.
#[test]
fn a_galpixel_that_is_put_back_each_frame_goes_where_one_goes_that_is_left_alone() {
    let setting = Setting::new(PAPER).unwrap();
    let format = Dynamic::new(setting.bits, Layout::FULL).unwrap();
    let mut frames = 0;
    for rounding in Rounding::ALL {
        let settings = Settings { rounding, fill_mode: FillMode::None, ..Settings::for_depth(16) };
        for case in ["turn-round", "rotation", "near-plane", "counter-wrap", "edge-of-overflow"] {
            let case = ALL.iter().find(|other| other.name == case).unwrap();
            for path in (case.paths)(&setting).iter().filter(|path| path.component == 0) {
                let mut strip = Strip::new(&setting, 0, rounding).unwrap();
                let followed = follow(path, &setting, rounding, &mut strip);
                let shown: Vec<i64> = followed.rows.iter().map(|row| row.shown.nearest(0)).collect();
                let (left, right) = (*shown.iter().min().unwrap(), *shown.iter().max().unwrap());
                let shape = Shape::plain((right - left + 1) as u32, 1);
                let given = path.given(&setting, 0);
                with_controller(shape, format, None, |controller| {
                    controller.set_frame(path.counter);
                    controller.front_mut().store((given.cell - left) as i32, 0, &given.galpixel).unwrap();
                    for row in &followed.rows[1..] {
                        let tally = controller.step(&settings);
                        assert_eq!((tally.moved, tally.lost), (1, 0), "{}, frame {}", path.name, row.frame);
                        let x = (row.shown.nearest(0) - left) as i32;
                        let galpixel = controller.front().load(x, 0).unwrap();
                        assert_eq!(galpixel.class, Class::Galpixel, "{}, frame {}", path.name, row.frame);
                        let offset: I32F32 = galpixel.offset[0];
                        assert_eq!(Px::given(offset, 0), row.causes.snapping, "{}, frame {}", path.name, row.frame);
                        frames += 1;
                    }
                });
            }
        }
    }
    assert!(frames > 1000, "only {frames} frames");
}
