//! What must hold for every built-in scene, and what single scenes claim of themselves.

use super::{Scene, all, find, render, update};
use crate::update::{Known, Sample};

/// Every third column and row of the map, margin included; odd steps, so that no pattern of the textures is in tune
/// with them.
fn places(scene: &dyn Scene) -> impl Iterator<Item = (f64, f64)> {
    let margin = scene.margin();
    let (left, right) = (-(margin.left as i32), (scene.width() + margin.right) as i32);
    let (top, bottom) = (-(margin.top as i32), (scene.height() + margin.bottom) as i32);
    let row = move |y| (left..right).step_by(3).map(move |x| (f64::from(x), f64::from(y)));
    (top..bottom).step_by(3).flat_map(row)
}

fn on_display(scene: &dyn Scene, [x, y, _]: [f64; 3]) -> bool {
    (0.0..=scene.width() as f64 - 1.0).contains(&x) && (0.0..=scene.height() as f64 - 1.0).contains(&y)
}

/// Equation (2) with what an update knows.
fn taylor(x: f64, y: f64, sample: &Sample, t: f64) -> [f64; 3] {
    let start = [x, y, sample.depth];
    [0, 1, 2].map(|i| start[i] + sample.velocity[i] * t + sample.acceleration[i] * t * t / 2.0)
}

#[test]
fn names_are_found_and_fit_for_a_script() {
    for scene in all() {
        let name = scene.name();
        assert!(name.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'-'), "{name}");
        assert_eq!(find(name).map(|found| found.about()), Some(scene.about()));
        assert!(!scene.about().contains('\n'));
    }
    assert_eq!(all().len(), 12);
    assert!(find("Still").is_none());
}

#[test]
fn velocity_and_acceleration_are_the_derivatives_of_the_track() {
    const H: f64 = 1e-2;
    for scene in all() {
        for t in [0.0, 0.4, 0.9].map(|share| share * f64::from(scene.frames())) {
            for (x, y) in places(*scene) {
                let sample = scene.sample(x, y, t);
                let [before, here, after] = [t - H, t, t + H].map(|then| scene.track(x, y, t, then));
                for (i, start) in [x, y, sample.depth].into_iter().enumerate() {
                    let velocity = (after[i] - before[i]) / (2.0 * H);
                    let acceleration = (after[i] - 2.0 * here[i] + before[i]) / (H * H);
                    let at = format!("{} at ({x}, {y}, t = {t}), component {i}", scene.name());
                    assert!((here[i] - start).abs() < 1e-9, "{at}: {} is not {start}", here[i]);
                    assert!((velocity - sample.velocity[i]).abs() < 2e-4, "{at}: {velocity} {sample:?}");
                    assert!((acceleration - sample.acceleration[i]).abs() < 2e-4, "{at}: {acceleration} {sample:?}");
                }
            }
        }
    }
}

/// A point that is still the foremost one keeps its colour (but for the light), and one that is not has something in
/// front.
#[test]
fn a_tracked_point_is_seen_again_unless_it_is_covered() {
    for scene in all() {
        let frames = f64::from(scene.frames());
        for t in [1.37, 0.5 * frames, frames] {
            let (mut visible, mut covered, mut all) = (0, 0, 0);
            for (x, y) in places(*scene) {
                all += 1;
                let place = scene.track(x, y, 0.0, t);
                if !on_display(*scene, place) {
                    continue;
                }
                let (first, then) = (scene.sample(x, y, 0.0), scene.sample(place[0], place[1], t));
                let at = format!("{} at ({x}, {y}), seen again at {place:?}, t = {t}", scene.name());
                assert!(then.depth <= place[2] + 1e-9, "{at}: only {} is seen", then.depth);
                if then.depth < place[2] - 1e-9 {
                    covered += 1;
                    continue;
                }
                visible += 1;
                assert_eq!(first.tag, then.tag, "{at}");
                for channel in 0..3 {
                    let expected = f64::from(first.colour[channel]) + first.luminosity_rate * t;
                    // Both colours are rounded.
                    assert!(
                        (f64::from(then.colour[channel]) - expected).abs() <= 1.0 + 1e-6,
                        "{at}: {first:?} {then:?}"
                    );
                }
            }
            assert!(visible * 5 > all, "{}: only {visible} of {all} are seen again at {t}", scene.name());
            let separate = ["pillars", "crossing", "sphere", "near-plane", "ball"];
            if t < frames && t > 2.0 && separate.contains(&scene.name()) {
                assert!(covered > 10, "{}: {covered} covered at {t}", scene.name());
            }
        }
    }
}

#[test]
fn second_order_is_exact_where_it_is_claimed_and_visibly_wrong_where_not() {
    for scene in all() {
        let mut worst = 0.0_f64;
        for (x, y) in places(*scene) {
            let sample = scene.sample(x, y, 0.0);
            for t in (1..=scene.frames()).map(f64::from) {
                let (truth, known) = (scene.track(x, y, 0.0, t), taylor(x, y, &sample, t));
                if on_display(*scene, truth) {
                    worst = worst.max((truth[0] - known[0]).abs()).max((truth[1] - known[1]).abs());
                }
            }
        }
        println!("{}: second order is wrong by up to {worst:.3e} pixels", scene.name());
        if scene.second_order() {
            assert!(worst < 1e-9, "{}: {worst}", scene.name());
        } else {
            assert!(worst > 1.0, "{}: {worst}", scene.name());
        }
    }
}

#[test]
fn updates_are_complete_and_in_range() {
    for scene in all() {
        let (update, margin) = (update(*scene, 0.0), scene.margin());
        assert_eq!(update.margin, margin);
        assert_eq!(update.width, scene.width() + margin.left + margin.right);
        assert_eq!(update.height, scene.height() + margin.top + margin.bottom);
        assert_eq!(update.samples.len(), update.width * update.height);
        assert_eq!(update.picture(), render(*scene, 0.0), "{}", scene.name());
        let corner = scene.sample(-(margin.left as f64), -(margin.top as f64), 0.0);
        assert_eq!(update.samples.first(), Some(&corner), "{}", scene.name());
        for sample in &update.samples {
            assert!((0.0..=1.0).contains(&sample.depth), "{}: {sample:?}", scene.name());
            assert!(sample.velocity.iter().chain(&sample.acceleration).all(|value| value.is_finite()));
            assert!(sample.luminosity_rate.is_finite());
            assert_eq!(sample.known, Known::Motion);
            assert!((1..=scene.surfaces().len()).contains(&usize::from(sample.tag)), "{}: {sample:?}", scene.name());
        }
        for tag in 1..=scene.surfaces().len() {
            let seen = update.samples.iter().filter(|sample| usize::from(sample.tag) == tag).count();
            assert!(seen > 20, "{}: object {tag} fills {seen} cells", scene.name());
        }
    }
}

/// A surface of one colour would hide errors of its motion.
#[test]
fn every_object_is_textured() {
    for scene in all() {
        let update = update(*scene, 0.0);
        for tag in 1..=scene.surfaces().len() {
            let seen = update.samples.iter().filter(|sample| usize::from(sample.tag) == tag);
            let light: Vec<f64> = seen.map(|sample| sample.colour.map(f64::from).iter().sum::<f64>() / 3.0).collect();
            let mean = light.iter().sum::<f64>() / light.len() as f64;
            let spread = (light.iter().map(|l| (l - mean) * (l - mean)).sum::<f64>() / light.len() as f64).sqrt();
            assert!(spread > 8.0, "{}: object {tag} has a spread of only {spread:.1} code values", scene.name());
        }
    }
}

#[test]
fn pictures_change_with_time_except_the_still_one() {
    for scene in all() {
        let (first, later) = (render(*scene, 0.0), render(*scene, f64::from(scene.frames()) / 2.0));
        let changed = first.pixels.iter().zip(&later.pixels).filter(|(a, b)| a != b).count();
        let share = changed as f64 / first.pixels.len() as f64;
        assert_eq!(share == 0.0, scene.name() == "still", "{}: {share}", scene.name());
        assert!(share == 0.0 || share > 0.04, "{}: {share}", scene.name());
    }
}

#[test]
fn whatever_the_pan_shows_has_waited_in_the_margin() {
    let pan = find("pan").expect("a built-in scene");
    let margin = pan.margin();
    let (width, height) = (pan.width() as f64 - 1.0, pan.height() as f64 - 1.0);
    for t in 0..=pan.frames() {
        for (x, y) in [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)] {
            let [x, y, _] = pan.track(x, y, f64::from(t), 0.0);
            assert!(x >= -(margin.left as f64) && x <= width + margin.right as f64, "frame {t}: {x}");
            assert!(y >= -(margin.top as f64) && y <= height + margin.bottom as f64, "frame {t}: {y}");
        }
    }
}

/// v = -a T / 2 brings it back; the display is nearly crossed at half time.
#[test]
fn the_ball_returns() {
    let ball = find("ball").expect("a built-in scene");
    let flight = f64::from(ball.frames());
    let thrown = ball.sample(24.0, 112.0, 0.0);
    assert_eq!(thrown.tag, 2);
    let [there, back] = [0.5, 1.0].map(|share| ball.track(24.0, 112.0, 0.0, share * flight));
    assert!(there[0] - 24.0 > 0.7 * ball.width() as f64, "{there:?}");
    assert!((back[0] - 24.0).abs() < 1e-9 && (back[1] - 112.0).abs() < 1e-9, "{back:?}");
    for i in 0..3 {
        assert!((thrown.velocity[i] + thrown.acceleration[i] * flight / 2.0).abs() < 1e-12);
    }
}

/// A channel at its end would stop following the light, and the rate would not be the truth any more.
#[test]
fn the_ramp_never_reaches_the_end_of_a_channel() {
    let ramp = find("ramp").expect("a built-in scene");
    let (first, last) = (update(ramp, 0.0), update(ramp, f64::from(ramp.frames())));
    for sample in first.samples.iter().chain(&last.samples) {
        assert!(sample.colour.iter().all(|channel| (1..=254).contains(channel)), "{sample:?}");
    }
    for tag in 1..=ramp.surfaces().len() {
        let rates = first.samples.iter().filter(|sample| usize::from(sample.tag) == tag).map(|s| s.luminosity_rate);
        let (count, sum) = rates.fold((0, 0.0), |(count, sum), rate| (count + 1, sum + rate.abs()));
        assert!(sum / f64::from(count) > 0.3, "object {tag} changes by {sum} over {count} cells");
    }
    for scene in all().iter().filter(|scene| scene.name() != "ramp") {
        assert!(places(*scene).all(|(x, y)| scene.sample(x, y, 0.0).luminosity_rate == 0.0), "{}", scene.name());
    }
}
