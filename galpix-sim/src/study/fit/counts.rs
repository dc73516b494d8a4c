//! The counted instructions and the measured code, as the firmware's checks keep them.

use std::collections::HashMap;
use std::sync::LazyLock;

use super::boards::Core;

/// Hundredths of an instruction a galpixel, by target, layout, picture, stage and fill mode.
static COUNTS: LazyLock<HashMap<[&str; 5], u64>> = LazyLock::new(|| {
    let rows = include_str!("../../../../firmware/cost.csv").lines().filter(|line| !line.starts_with('#'));
    rows.filter_map(|line| match line.split(',').collect::<Vec<_>>()[..] {
        [target, layout, picture, mode, stage, fill, count] if mode != "constant" => {
            Some(([target, layout, picture, stage, fill], count.parse().ok()?))
        }
        _ => None,
    })
    .collect()
});

/// Bytes of code, by target, layout and program.
static TEXT: LazyLock<HashMap<[&str; 3], u64>> = LazyLock::new(|| {
    let rows = include_str!("../../../../firmware/text.csv").lines();
    rows.filter_map(|line| match line.split(',').collect::<Vec<_>>()[..] {
        [target, layout, program, bytes] => Some(([target, layout, program], bytes.parse().ok()?)),
        _ => None,
    })
    .collect()
});

/// Returns the targets whose counts bound those of a processor, the fewest instructions first.
const fn targets(core: Core) -> [&'static str; 2] {
    const M0: &str = "thumbv6m-none-eabi";
    const M3: &str = "thumbv7m-none-eabi";
    const M4: &str = "thumbv7em-none-eabi";
    match core {
        Core::M0 => [M0, M0],
        Core::M3 => [M3, M3],
        Core::M4 => [M4, M4],
        Core::Other => [M4, M0],
    }
}

/// Returns instructions a galpixel of a stage, from and to; 0 where the stage was not counted.
pub fn count(core: Core, layout: &str, picture: &str, stage: &str, fill: &str) -> [f64; 2] {
    targets(core).map(|target| COUNTS.get(&[target, layout, picture, stage, fill]).map_or(0.0, |&c| c as f64 / 100.0))
}

/// Returns bytes of code of a program (`rolling`, `two-maps`, `push-pull`): of an M4 for an M3, which differs by less
/// than one per cent, and of RISC-V for what is no Arm.
pub fn text(core: Core, layout: &str, program: &str) -> u64 {
    let target = match core {
        Core::M0 => "thumbv6m-none-eabi",
        Core::M3 | Core::M4 => "thumbv7em-none-eabi",
        Core::Other => "riscv32imac-unknown-none-elf",
    };
    TEXT.get(&[target, layout, program]).copied().unwrap_or(0)
}
