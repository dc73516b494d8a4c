//! What the terminal shows: the fronts, floats and sample-and-hold for comparison, and what galpixels buy.

use super::columns::{Row, columns};
use super::report::{Point, Scheme, SourceReport};
use crate::metric::measures::Measures;
use crate::output::column::Table;
use crate::output::number;

/// Returns the report of a source as text.
#[must_use]
pub fn text(report: &SourceReport) -> String {
    let demand = report.demand;
    let row = |point| Row::new(report, point, String::new());
    let of = |ids: &[usize]| report.points.iter().filter(|point| ids.contains(&point.id)).collect::<Vec<_>>();
    let bytes = report.fronts.bytes.iter().flat_map(|&id| of(&[id])).collect();
    let of_scheme = |scheme| by_time(report.points.iter().filter(|point| point.scheme == scheme).collect());
    let parts: [(&str, Vec<Row<'_>>); 5] = [
        ("front of time and certified position error:", by_time(of(&report.fronts.position))),
        ("front of time and FLIP:", by_time(of(&report.fronts.picture))),
        ("front of bytes and certified position error:", bytes),
        ("as stationary sources:", of_scheme(Scheme::Source)),
        ("the same scheme in 32-bit floats:", of_scheme(Scheme::F32)),
    ]
    .map(|(title, points): (_, Vec<&Point>)| (title, points.into_iter().map(row).collect()));
    let columns = columns();
    let all: Vec<Row<'_>> = report.points.iter().map(row).collect();
    let table = Table::new(&columns, &all);
    let mut lines = vec![format!(
        "{}: {}x{}, positions of {} and pictures of {} of {} frames, D = {}, tau_recog = {}, tau_prop = {}; {} points",
        report.source,
        report.width,
        report.height,
        report.looked_at.len(),
        report.pictures.len(),
        report.frames,
        demand.extent,
        demand.recog,
        demand.prop,
        report.points.len()
    )];
    lines.push(table.heading());
    // Without true pictures there is no front of FLIP, without a time none of time.
    for (title, rows) in parts.iter().filter(|(_, rows)| !rows.is_empty()) {
        lines.push((*title).to_owned());
        lines.extend(rows.iter().map(|row| table.line(row)));
    }
    if report.hold.flip.is_some() {
        let Measures { psnr_db, psnr_inside_db, change_error, .. } = report.hold.measures;
        let [psnr, inside, change] = [psnr_db, psnr_inside_db, change_error].map(|measure| number(measure, 2));
        let flip = number(report.hold.flip, 4);
        lines.push(format!("sample-and-hold: PSNR {psnr} dB, inside {inside} dB, change {change}, FLIP {flip}"));
    }
    lines.extend(doubts(report));
    lines.extend(rates(report));
    lines.join("\n")
}

fn by_time(mut points: Vec<&Point>) -> Vec<&Point> {
    let time = |point: &Point| point.compile_time.or(point.run_time).map_or(f64::INFINITY, |time| time.frame_us);
    points.sort_by(|a, b| time(a).total_cmp(&time(b)));
    points
}

/// Returns what is not certain about the times, a sentence each.
pub fn doubts(report: &SourceReport) -> Vec<String> {
    let pairs = |pairs: &[[usize; 2]]| {
        let pairs: Vec<String> = pairs.iter().map(|[first, second]| format!("{first} and {second}")).collect();
        pairs.join(", ")
    };
    let fronts = [
        ("certified position error", &report.fronts.position_not_told_apart),
        ("FLIP", &report.fronts.picture_not_told_apart),
    ];
    let overlapping = fronts.into_iter().filter(|(_, overlapping)| !overlapping.is_empty()).map(|(of, overlapping)| {
        format!("Not told apart by their times on the front of time and {of}: {}.", pairs(overlapping))
    });
    report.noise.and_then(|noise| noise.warning()).into_iter().chain(overlapping).collect()
}

/// Returns one sentence for each rate above every frame.
fn rates(report: &SourceReport) -> Vec<String> {
    let rates = report.rates.iter().filter(|rate| rate.every > 1).map(|rate| {
        let needed = match rate.hold_equals_every {
            Some(every) => format!("sample-and-hold is as good with 1 in {every:.1}, by interpolation"),
            None => format!("sample-and-hold is not worse with 1 in {}", rate.hold_needs_every),
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
