//! Long times: without an update, with updates without end, and past the end of the frame counter.

use std::f64::consts::TAU;

use fixed::types::I32F32;

use super::super::exact::Px;
use super::super::path::{Motion, Path};
use super::super::setting::Setting;
use super::motion::harmonic;

/// Frames that are followed at least.
const LONG: u32 = 512;

/// Parts of the last bits of a position, a velocity and an acceleration.
fn parts(setting: &Setting, [r, v, a]: [f64; 3]) -> Motion {
    let widths = setting.bits.x;
    // To the last bit of what an update hands over, so that nothing is left for the Taylor share.
    let number = I32F32::saturating_from_num::<f64>;
    let part = |value: f64, frac: u32| Px::given(number(value * 0.5f64.powi(frac as i32)), 0);
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
        (
            "v of 1/2 last bit of r",
            [
                0.0,
                f64::from(1u32 << setting.bits.x.velocity_frac.saturating_sub(setting.bits.x.position_frac)) / 2.0,
                0.0,
            ],
        ),
        ("a of 1 last bit", [0.0, 0.0, 1.0]),
        ("a of 0.49 last bits", [0.0, 0.0, 0.49]),
    ]
    .map(path)
    .into()
}

/// Accelerations of a quarter, an eighth and three quarters of the period of the thresholds: after each period the low
/// bits meet the same thresholds again.
pub fn in_step(setting: &Setting) -> Vec<Path> {
    let frames = LONG.max(2 * setting.demand.prop);
    let scale = &setting.record.scales[0];
    let period = f64::from(1u32 << scale.down.min(20));
    let path = |(v, a): (f64, f64)| {
        let [v, a] = [v * period, a * period].map(|part| part.max(1.0).round());
        Path::new(format!("v of {v} and a of {a} last bits"), 0, parts(setting, [0.0, v, a]), frames)
    };
    [(1.0 / 8.0, 1.0 / 4.0), (3.0 / 8.0, 1.0 / 4.0), (0.0, 1.0 / 8.0), (1.0 / 8.0, 3.0 / 4.0)].map(path).into()
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
        path("a slow swing", harmonic(extent / 2.0, extent / 4.0, TAU / (40.0 * f64::from(prop)), 0.1)),
    ]
}

/// The counter's last frame is in the middle of the path.
pub fn counter_wrap(setting: &Setting) -> Vec<Path> {
    let prop = setting.demand.prop;
    let states = [[0.0, 5.0, 3.0], [0.25, -11.0, 7.0], [-0.5, 123.0, -13.0], [0.0, -1.0, 1.0]];
    let path = |(state, before): ([f64; 3], u32)| {
        Path::new(
            format!("v of {} and a of {} last bits, wraps after {before}", state[1], state[2]),
            0,
            parts(setting, state),
            prop,
        )
        .from_counter(u32::MAX - before + 1)
    };
    states.into_iter().flat_map(|state| [1, prop / 2, prop - 1].map(|before| path((state, before)))).collect()
}
