//! The certificate holds on every scene that second order describes exactly, and it is nearly reached.

use fixed::types::I32F32;
use galpix_core::{Bits, Class, Demand, FillMode, Format, Galpixel, Layout, Record, Rounding, Settings};
use galpix_sim::certificate::Certificate;
use galpix_sim::engine::Engine;
use galpix_tests::memory::{Shape, with_controller};
use galpix_tests::profiles::dynamic;
use galpix_tests::stage::{self, Stage, number};

/// What floating point may add to an error of a pixel.
const FLOAT: f64 = 1e-6;

fn budget(stage: &Stage) -> (Bits, u32) {
    let side = stage.shape.width.max(stage.shape.height);
    let prop = stage.scene.frames().max(2).next_power_of_two();
    (Bits::derive(Demand { extent: side.next_power_of_two(), recog: 8, prop }).unwrap(), prop)
}

fn certificate(record: &Record, rounding: Rounding, prop: u32) -> Certificate {
    Certificate::of(&record.scales[0], true, rounding, prop)
}

#[test]
fn no_galpixel_of_a_second_order_scene_is_farther_off_than_the_certificate() {
    let mut scenes = 0;
    for stage in stage::all().filter(|stage| stage.scene.second_order()) {
        scenes += 1;
        let (scene, update) = (stage.scene, &stage.update);
        let (bits, prop) = budget(&stage);
        let margin = [update.margin.left as f64, update.margin.top as f64];
        let format = dynamic(Layout::FULL, bits);
        for rounding in Rounding::ALL {
            let certificate = certificate(format.record(), rounding, prop);
            let settings = Settings { rounding, ..Settings::for_depth(format.record().depth().bits.into()) };
            let engine = Engine::new(format, settings);
            let mut followed = 0;
            let loaded = engine
                .run(update, scene.frames(), |frame| {
                    let at = format!("{} {rounding:?} frame {}", scene.name(), frame.number);
                    assert_eq!(frame.tally.saturated, 0, "{at}: the budget is made for this scene");
                    if frame.number == 0 {
                        return;
                    }
                    let bound = certificate.after(frame.number).unwrap();
                    for (origin, [x, y]) in frame.places() {
                        let origin = origin as usize;
                        let [from_x, from_y] = [origin % update.width, origin / update.width];
                        let (from_x, from_y) = (from_x as f64 - margin[0], from_y as f64 - margin[1]);
                        let [true_x, true_y, _] = scene.track(from_x, from_y, 0.0, frame.number.into());
                        let error = (x - margin[0] - true_x).abs().max((y - margin[1] - true_y).abs());
                        assert!(error <= bound + FLOAT, "{at}: ({from_x}, {from_y}) is {error} px off, over {bound}");
                        followed += 1;
                    }
                })
                .unwrap();
            assert_eq!(loaded.saturated, 0, "{}", scene.name());
            assert!(followed > 100_000, "{}: only {followed} galpixels were followed", scene.name());
        }
    }
    assert!(scenes >= 5, "only {scenes} scenes are of second order");
}

/// Returns the largest error of each frame, the first after `phase` of the frame counter, over all low bits of velocity
/// and acceleration, with position, velocity and acceleration each a hair less than half a last bit from what can be
/// stored.
///
/// One state a row, so that none meets another.
fn worst_errors(bits: Bits, rounding: Rounding, prop: u32, phase: u32) -> Vec<f64> {
    let x = bits.x;
    let unit = |frac: u32| 0.5f64.powi(frac as i32);
    // 2v + a drops `velocity_frac + 1 - position_frac` bits: as many states of v and of a there are at most.
    let residues = 2 << (x.velocity_frac - x.position_frac);
    let almost_half = 0.5 - 1.0 / 256.0;
    let states: Vec<[f64; 3]> = [-almost_half, almost_half]
        .into_iter()
        .flat_map(|off| {
            (0..residues).flat_map(move |v| {
                (-residues / 2..residues / 2).map(move |a| {
                    let [v, a] = [v, a].map(f64::from);
                    [
                        off * unit(x.position_frac),
                        (v + off) * unit(x.velocity_frac),
                        (a + off) * unit(x.acceleration_frac),
                    ]
                })
            })
        })
        .collect();
    let after = |[r, v, a]: [f64; 3], n: f64| r + v * n + a * n * n / 2.0;
    let farthest = states.iter().flat_map(|&state| (0..=prop).map(move |n| after(state, n.into()).abs()));
    let middle = farthest.fold(0.0, f64::max).ceil() as u32 + 2;
    let shape = Shape::plain(2 * middle + 1, states.len() as u32);
    let format = dynamic(Layout::FULL, bits);
    let settings = Settings { rounding, fill_mode: FillMode::None, ..Settings::for_depth(16) };
    with_controller(shape, format, None, |controller| {
        for _ in 0..phase {
            controller.step(&settings);
        }
        for (y, &[r, v, a]) in (0..).zip(&states) {
            let galpixel = Galpixel {
                offset: [number(r), I32F32::ZERO],
                velocity: [number(v), I32F32::ZERO, I32F32::ZERO],
                acceleration: [number(a), I32F32::ZERO, I32F32::ZERO],
                ..Galpixel::default()
            };
            assert_eq!(controller.front_mut().store(middle as i32, y, &galpixel), Some(0));
        }
        let frames = (1..=prop).map(|n| {
            assert_eq!(controller.step(&settings).moved, states.len() as u32, "none is lost");
            let rows = (0..).zip(&states).map(|(y, &state)| {
                let found = (0..shape.width as i32).find_map(|x| {
                    let galpixel = controller.front().load(x, y)?;
                    (galpixel.class == Class::Galpixel).then(|| f64::from(x) + galpixel.offset[0].to_num::<f64>())
                });
                let x = found.expect("one a row") - f64::from(middle);
                (x - after(state, n.into())).abs()
            });
            rows.fold(0.0, f64::max)
        });
        frames.collect()
    })
}

/// In every frame the certificate holds, and in some frame, from some phase of the counter on, it is all but reached.
#[test]
fn the_certificate_is_reached_to_within_a_tenth() {
    for prop in [8, 16] {
        let bits = Bits::derive(Demand { extent: 64, recog: 8, prop }).unwrap();
        let record = Record::plan(bits, Layout::FULL).unwrap();
        for rounding in Rounding::ALL {
            let certificate = certificate(&record, rounding, prop);
            let phases = if rounding == Rounding::LowDiscrepancy { 1 << record.scales[0].down } else { 1 };
            let (mut tightest, mut worst) = (0.0f64, 0.0f64);
            for phase in 0..phases {
                for (n, error) in (1..).zip(worst_errors(bits, rounding, prop, phase)) {
                    let bound = certificate.after(n).unwrap();
                    assert!(error <= bound, "{rounding:?}, frame {n} of {prop}: {error} is over {bound}");
                    tightest = tightest.max(error / bound);
                    worst = worst.max(error / certificate.total_px);
                }
            }
            assert!(tightest >= 0.9, "{rounding:?}, {prop} frames: {tightest} of the bound of a frame is reached");
            assert!(worst >= 0.9, "{rounding:?}, {prop} frames: {worst} of the whole bound is reached");
        }
    }
}
