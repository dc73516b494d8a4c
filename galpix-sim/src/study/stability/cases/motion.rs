//! Motion that is fast, stiff, or beyond second order.

use std::f64::consts::TAU;

use super::super::exact::Px;
use super::super::path::{Motion, Path};
use super::super::setting::Setting;

fn analytic(at: impl Fn(f64) -> [f64; 3] + Send + Sync + 'static) -> Motion {
    Motion::Analytic(Box::new(at))
}

/// `middle + amplitude * cos(omega t + phase)`.
pub fn harmonic(middle: f64, amplitude: f64, omega: f64, phase: f64) -> Motion {
    analytic(move |t| {
        let (sin, cos) = (omega * t + phase).sin_cos();
        [middle + amplitude * cos, -amplitude * omega * sin, -amplitude * omega * omega * cos]
    })
}

/// v = 4D/tau_recog and a = -8D/tau_recog²: D cells out in half of tau_recog, and back in the other half.
pub fn turn_round(setting: &Setting) -> Vec<Path> {
    let (extent, recog) = (f64::from(setting.demand.extent), f64::from(setting.demand.recog));
    let (v, a) = (4.0 * extent / recog, 8.0 * extent / (recog * recog));
    let turn = |name: &str, component: usize, from: f64, sign: f64| {
        let motion = Motion::SecondOrder([Px::near(from), Px::near(sign * v), Px::near(-sign * a)]);
        Path::new(name, component, motion, setting.demand.recog)
    };
    vec![
        turn("rightwards first", 0, 0.0, 1.0),
        turn("leftwards first", 0, extent, -1.0),
        turn("downwards first", 1, 0.0, 1.0),
        turn("upwards first", 1, extent, -1.0),
    ]
}

/// Circles of an eighth and of half the display.
pub fn rotation(setting: &Setting) -> Vec<Path> {
    let (extent, recog) = (f64::from(setting.demand.extent), f64::from(setting.demand.recog));
    let circles = [(1.0, 1.0 / 8.0), (1.5, 1.0 / 8.0), (2.0, 1.0 / 8.0), (1.0, 0.5)];
    let components = [(0, 0.0, "x"), (1, -TAU / 4.0, "y")];
    let path = |((turn, radius), (component, phase, axis)): ((f64, f64), (usize, f64, &str))| {
        let omega = TAU / (turn * recog);
        let name = format!("{axis}, radius D/{:.0}, a turn in {turn} tau_recog", 1.0 / radius);
        Path::new(name, component, harmonic(extent / 2.0, radius * extent, omega, phase), setting.demand.prop)
    };
    circles.into_iter().flat_map(|circle| components.map(|axis| path((circle, axis)))).collect()
}

/// Springs as wide as their fields allow, at most an eighth of the display, with an update every tau_prop frames.
pub fn oscillators(setting: &Setting) -> Vec<Path> {
    let (extent, recog, prop) =
        (f64::from(setting.demand.extent), f64::from(setting.demand.recog), f64::from(setting.demand.prop));
    let most = 8.0 * extent / (recog * recog);
    let periods = [4.0 * prop, 2.0 * prop, prop, 8.0, 4.0, 3.0];
    let path = |period: f64| {
        let omega = TAU / period;
        let amplitude = (extent / 8.0).min(0.9 * most / (omega * omega));
        let name = format!("{amplitude:.1} px, a period in {period} frames");
        let motion = harmonic(extent / 2.0, amplitude, omega, 0.3);
        Path::new(name, 0, motion, 4 * setting.demand.prop).every(setting.demand.prop)
    };
    periods.map(path).into()
}

/// `from / (1 - t/contact)`: what comes nearer at a constant speed.
fn inverse(from: f64, contact: f64) -> impl Fn(f64) -> [f64; 3] + Send + Sync + 'static {
    move |t| {
        let left = 1.0 - t / contact;
        [from / left, from / (contact * left * left), 2.0 * from / (contact * contact * left.powi(3))]
    }
}

/// Contact 4, 1 and 1/16 tau_prop after the last frame.
pub fn near_plane(setting: &Setting) -> Vec<Path> {
    let (extent, prop) = (f64::from(setting.demand.extent), f64::from(setting.demand.prop));
    let depth = setting.bits.depth_int;
    let approach = |later: f64| {
        let contact = prop * (1.0 + later);
        let from = extent / 32.0;
        let plane = Path::new(
            format!("x, contact in {contact} frames"),
            0,
            analytic(inverse(from, contact)),
            setting.demand.prop,
        );
        // Depth is linear in inverse distance: 1 - near/z of its range.
        let range = f64::from(1u32 << depth);
        let near = inverse(range / 32.0, contact);
        let farther = move |t: f64| {
            let [r, v, a] = near(t);
            [range - r, -v, -a]
        };
        let name = format!("depth, contact in {contact} frames");
        [plane, Path::new(name, 2, analytic(farther), setting.demand.prop)]
    };
    [4.0, 1.0, 1.0 / 16.0].into_iter().flat_map(approach).collect()
}

/// A ball that loses nothing, a quarter of the display high, and one that meets a wall at a constant speed.
pub fn bounce(setting: &Setting) -> Vec<Path> {
    let (extent, prop) = (f64::from(setting.demand.extent), f64::from(setting.demand.prop));
    // Neither a divisor nor a multiple of tau_prop: bounces fall early, late and not at all between updates.
    let flight = 1.37 * prop;
    let (height, frames) = (extent / 4.0, 6 * setting.demand.prop);
    let ball = move |t: f64| {
        let (s, v, g) = (t.rem_euclid(flight), 4.0 * height / flight, 8.0 * height / (flight * flight));
        [v * s - g * s * s / 2.0, v - g * s, -g]
    };
    let wall = move |t: f64| {
        let (s, v) = (t.rem_euclid(2.0 * flight), height / flight);
        if s < flight { [v * s, v, 0.0] } else { [v * (2.0 * flight - s), -v, 0.0] }
    };
    vec![
        Path::new("a ball under gravity", 1, analytic(ball), frames).every(setting.demand.prop),
        Path::new("between two walls", 0, analytic(wall), frames).every(setting.demand.prop),
    ]
}
