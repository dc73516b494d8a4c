//! What the terminal shows: the fronts, floats and sample-and-hold for comparison, and what galpixels buy.

use super::columns::{Row, columns};
use super::report::{Point, Scheme, SourceReport};
use crate::output::column::Table;
use crate::output::number;

/// Returns the report of a source as text.
#[must_use]
pub fn text(report: &SourceReport) -> String {
    let demand = report.demand;
    let row = |point| Row::new(report, point, String::new());
    let of = |ids: &[usize]| report.points.iter().filter(|point| ids.contains(&point.id)).collect::<Vec<_>>();
    let bytes = report.fronts.bytes.iter().flat_map(|&id| of(&[id])).collect();
    let floats = report.points.iter().filter(|point| point.scheme == Scheme::F32).collect();
    let parts: [(&str, Vec<Row<'_>>); 4] = [
        ("front of time and worst position error:", by_time(of(&report.fronts.position))),
        ("front of time and FLIP:", by_time(of(&report.fronts.picture))),
        ("front of bytes and worst position error:", bytes),
        ("the same scheme in 32-bit floats:", by_time(floats)),
    ]
    .map(|(title, points): (_, Vec<&Point>)| (title, points.into_iter().map(row).collect()));
    let columns = columns();
    let all: Vec<Row<'_>> = report.points.iter().map(row).collect();
    let table = Table::new(&columns, &all);
    let mut lines = vec![format!(
        "{}: {}x{}, {} frames, D = {}, tau_recog = {}, tau_prop = {}; {} points",
        report.source,
        report.width,
        report.height,
        report.frames,
        demand.extent,
        demand.recog,
        demand.prop,
        report.points.len()
    )];
    lines.push(table.heading());
    for (place, (title, rows)) in parts.iter().enumerate() {
        // Without true pictures there is no front of FLIP.
        if place != 1 || !rows.is_empty() {
            lines.push((*title).to_owned());
            lines.extend(rows.iter().map(|row| table.line(row)));
        }
    }
    if report.hold.flip.is_some() {
        let [psnr, flip] = [number(report.hold.psnr_db, 2), number(report.hold.flip, 4)];
        lines.push(format!("sample-and-hold: PSNR {psnr} dB, FLIP {flip}"));
    }
    lines.extend(rates(report));
    lines.join("\n")
}

fn by_time(mut points: Vec<&Point>) -> Vec<&Point> {
    let time = |point: &Point| point.compile_time.map_or(f64::INFINITY, |time| time.frame_us);
    points.sort_by(|a, b| time(a).total_cmp(&time(b)));
    points
}

/// Returns one sentence for each rate above every frame.
fn rates(report: &SourceReport) -> Vec<String> {
    let rates = report.rates.iter().filter(|rate| rate.every > 1).map(|rate| {
        let needed = match rate.hold_needs_every {
            1 => "sample-and-hold needs every frame to be as good".to_owned(),
            every if every == rate.every => "sample-and-hold is as good at the same rate".to_owned(),
            every if every > rate.every => format!("sample-and-hold is as good at 1 in {every}"),
            every => format!("sample-and-hold needs 1 in {every} to be as good"),
        };
        format!(
            "1 update in {:>2} frames: FLIP {:.4}, sample-and-hold {:.4}; {needed}",
            rate.every, rate.flip, rate.flip_hold
        )
    });
    let ages = report.ages.iter().filter(|_| report.rates.is_empty()).map(|age| {
        format!("{:>2} frames after the update: FLIP {:.4}, sample-and-hold {:.4}", age.frame, age.flip, age.flip_hold)
    });
    rates.chain(ages).collect()
}
