//! Long times: without an update, with updates without end, and past the end of the frame counter.

use std::f64::consts::TAU;

use super::super::exact::Px;
use super::super::path::{Motion, Path};
use super::super::setting::Setting;
use super::motion::harmonic;

/// Frames that are followed at least.
const LONG: u32 = 512;

/// Parts of the last bits of a position, a velocity and an acceleration.
fn parts(setting: &Setting, [r, v, a]: [f64; 3]) -> Motion {
    let widths = setting.bits.x;
    let part = |value: f64, frac: u32| Px::near(value * 0.5f64.powi(frac as i32));
    Motion::SecondOrder([
        part(r, widths.position_frac),
        part(v, widths.velocity_frac),
        part(a, widths.acceleration_frac),
    ])
}

/// No update for 512 frames, or for twice tau_prop if that is longer.
pub fn sub_lsb(setting: &Setting) -> Vec<Path> {
    let frames = LONG.max(2 * setting.demand.prop);
    let path = |(name, state): (&str, [f64; 3])| Path::new(name, 0, parts(setting, state), frames);
    [
        ("at rest", [0.0, 0.0, 0.0]),
        ("v of 1 last bit", [0.0, 1.0, 0.0]),
        ("v of 3 last bits", [0.0, 3.0, 0.0]),
        ("v of 0.49 last bits", [0.49, 0.49, 0.0]),
        ("v of -0.49 last bits", [-0.49, -0.49, 0.0]),
        ("v of 0.51 last bits", [0.0, 0.51, 0.0]),
        ("v of 1/2 last bit of r", [0.0, f64::from(1u32 << setting.bits.x.velocity_frac.saturating_sub(setting.bits.x.position_frac)) / 2.0, 0.0]),
        ("a of 1 last bit", [0.0, 0.0, 1.0]),
        ("a of 0.49 last bits", [0.0, 0.0, 0.49]),
    ]
    .map(path)
    .into()
}

/// An update every tau_prop frames, 32 times; the exact position of each goes into the next.
pub fn re_anchored(setting: &Setting) -> Vec<Path> {
    let (extent, prop) = (f64::from(setting.demand.extent), setting.demand.prop);
    let path = |name: &str, motion: Motion| Path::new(name, 0, motion, 32 * prop).every(prop);
    let slow = |v: f64| Motion::SecondOrder([Px::near(0.3), Px::near(v), Px::default()]);
    vec![
        path("v of a third of a cell", slow(1.0 / 3.0)),
        path("v of -0.49 last bits", parts(setting, [0.0, -0.49, 0.0])),
        path("v of a golden part", slow(0.618_033_988_749)),
        path(
            "a slow swing",
            harmonic(extent / 2.0, extent / 4.0, TAU / (40.0 * f64::from(prop)), 0.1),
        ),
    ]
}

/// The counter's last frame is in the middle of the path.
pub fn counter_wrap(setting: &Setting) -> Vec<Path> {
    let prop = setting.demand.prop;
    let states = [[0.0, 5.0, 3.0], [0.25, -11.0, 7.0], [-0.5, 123.0, -13.0], [0.0, -1.0, 1.0]];
    let path = |(state, before): ([f64; 3], u32)| {
        Path::new(format!("v of {} and a of {} last bits, wraps after {before}", state[1], state[2]), 0, parts(setting, state), prop)
            .from_counter(u32::MAX - before + 1)
    };
    states.into_iter().flat_map(|state| [1, prop / 2, prop - 1].map(|before| path((state, before)))).collect()
}
