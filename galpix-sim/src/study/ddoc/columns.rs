//! The columns of the figures, a line per world. Missing samples are means over the views.

use super::report::SourceReport;
use crate::output::column::{Column, Value};

/// Characters of a name on the terminal.
const NAME: usize = 11;

fn mean(report: &SourceReport, sum: u64) -> Value {
    (sum as f64 / report.views.max(1) as f64).into()
}

fn percent(share: Option<f64>) -> Value {
    share.map(|share| 100.0 * share).into()
}

/// Returns a name that is cut where it is too long.
fn cut(name: &str) -> Value {
    if name.chars().count() <= NAME {
        return name.into();
    }
    name.chars().take(NAME - 1).chain(['…']).collect::<String>().into()
}

/// Returns the columns, wide enough for figures printed later.
pub fn columns() -> [Column<SourceReport>; 15] {
    let column = Column::<SourceReport>::new;
    [
        column(|world| cut(&world.source)).terminal("world", 0).words().width(NAME),
        column(|world| world.source.as_str().into()).page("world", 0).words(),
        column(|world| world.triangles.into()).both("triangles", 0).grouped().width(9),
        column(|world| world.radius.into()).page("D px", 0),
        column(|world| world.asymmetry.to_string().into()).page("a_f", 0),
        column(|world| mean(world, world.missing_plain)).both("plain", 0).width(6),
        column(|world| mean(world, world.missing_ddoc)).both("DDOC", 0).width(6),
        column(|world| percent(world.ratio)).terminal("ratio", 1).page("ratio %", 1).unit(" %").width(7),
        column(|world| mean(world, world.strict_plain)).terminal("strict:", 0).page("strict plain", 0).width(6),
        column(|world| mean(world, world.strict_ddoc)).both("DDOC", 0).width(6),
        column(|world| percent(world.strict_ratio)).terminal("ratio", 1).page("ratio %", 1).unit(" %").width(7),
        column(|world| world.samples.into()).both("samples", 0).grouped().width(8),
        column(|world| world.splats.into()).terminal("splats", 0).width(6),
        column(|world| world.shrunk.into()).terminal("shrunk", 0).width(6),
        column(|world| world.seconds.total.into()).both("seconds", 2).width(7),
    ]
}

/// What the columns are.
pub const LEGEND: &str = "\
Missing samples of the truth, a view's mean over the 26 of a cube: plain, in frames made from the depth image; DDOC, from the
DDOC image; each within a pixel, then (strict) at the very pixel, where outlines count, too. seconds: z-buffer, map and image.";
