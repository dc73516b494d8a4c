//! Fields at their ends.

use super::super::exact::Px;
use super::super::path::{Motion, Path};
use super::super::setting::{Ranges, Setting};

/// Position, velocity and acceleration in last bits, exactly as they are stored.
fn stored(ranges: &Ranges, [r, v, a]: [i64; 3]) -> Motion {
    let scale = &ranges.scale;
    Motion::SecondOrder([
        Px::of(r, scale.position_frac),
        Px::of(v, scale.velocity_frac),
        Px::of(a, scale.acceleration_frac),
    ])
}

/// Every combination of an end, 0 and the other end.
fn combinations(setting: &Setting, component: usize, positions: [i64; 3]) -> Vec<Path> {
    let ranges = setting.ranges(component);
    let ends = |top: i64| [(-1 - top, "min"), (0, "0"), (top, "max")];
    let positions = [(positions[0], "min"), (positions[1], "0"), (positions[2], "max")];
    let axis = ["x", "y", "depth"][component];
    let mut paths = Vec::new();
    for (r, r_name) in positions {
        for (v, v_name) in ends(ranges.velocity_top) {
            for (a, a_name) in ends(ranges.acceleration_top) {
                let name = format!("{axis}: r {r_name}, v {v_name}, a {a_name}");
                paths.push(Path::new(name, component, stored(&ranges, [r, v, a]), setting.demand.prop));
            }
        }
    }
    paths
}

/// x and y: the position's field is the place within the cell. In y the ends alone, for the same code.
pub fn plane(setting: &Setting) -> Vec<Path> {
    let of = |component: usize| {
        let half = 1i64 << setting.record.scales[component].position_frac >> 1;
        combinations(setting, component, [-half, 0, half - 1])
    };
    let ends = of(1).into_iter().filter(|path| !path.name.contains(['0']));
    of(0).into_iter().chain(ends).collect()
}

/// Depth: the position's field is the whole range.
pub fn depth(setting: &Setting) -> Vec<Path> {
    let far = setting.ranges(2).far.unwrap_or(0);
    combinations(setting, 2, [0, far / 2, far])
}

/// One against the other, in both directions, a step less and a step more.
pub fn opposite(setting: &Setting) -> Vec<Path> {
    let ranges = setting.ranges(0);
    let (v, a) = (ranges.velocity_top, ranges.acceleration_top);
    let path = |sign: i64, dv: i64, da: i64| {
        let name = format!("v {} of max, a {} of min", signed(sign * dv), signed(-sign * da));
        Path::new(name, 0, stored(&ranges, [0, sign * (v + dv), -sign * (a + da)]), setting.demand.prop)
    };
    let steps = [-1, 0, 1];
    [1, -1]
        .into_iter()
        .flat_map(|sign| steps.into_iter().flat_map(move |dv| steps.map(|da| path(sign, dv, da))))
        .collect()
}

fn signed(steps: i64) -> String {
    if steps == 0 { "0".to_owned() } else { format!("{steps:+}") }
}

/// From half of the largest velocity on, over it after half of tau_prop; at once; and with a last bit more than it
/// takes.
pub fn saturating(setting: &Setting) -> Vec<Path> {
    let ranges = setting.ranges(0);
    let prop = i64::from(setting.demand.prop);
    let up = ranges.scale.acceleration_up;
    let middle = ((ranges.velocity_top / prop) >> up).clamp(1, ranges.acceleration_top);
    let frames = 2 * setting.demand.prop;
    let path = |(name, v, a): (&str, i64, i64)| {
        Path::new(name, 0, stored(&ranges, [0, v, a]), frames).every(setting.demand.prop)
    };
    [
        ("upwards, in the middle", ranges.velocity_top / 2, middle),
        ("downwards, in the middle", -ranges.velocity_top / 2, -middle),
        ("upwards by one last bit", ranges.velocity_top, 1),
        ("downwards by one last bit", -1 - ranges.velocity_top, -1),
    ]
    .map(path)
    .into()
}

/// In depth the position itself ends, at the near and at the far plane.
pub fn depth_ends(setting: &Setting) -> Vec<Path> {
    let ranges = setting.ranges(2);
    let (far, bin) = (ranges.far.unwrap_or(0), 1i64 << ranges.scale.position_frac);
    let v = 1i64 << ranges.scale.velocity_frac;
    let turn = (v / 4).clamp(1, ranges.acceleration_top);
    let path =
        |(name, r, v, a): (&str, i64, i64, i64)| Path::new(name, 2, stored(&ranges, [r, v, a]), setting.demand.prop);
    [
        ("resting at the nearest", 0, 0, 0),
        ("resting at the farthest", far, 0, 0),
        ("into the nearest", 2 * bin, -v, 0),
        ("into the farthest", far - 2 * bin, v, 0),
        ("into the nearest and out", 2 * bin, -v, turn),
        ("into the farthest and out", far - 2 * bin, v, -turn),
        ("touching the nearest", 2 * bin, -v, v / 4),
    ]
    .map(path)
    .into()
}
