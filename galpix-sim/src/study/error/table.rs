//! What the terminal says: the fronts, floats and sample-and-hold beside them, and what galpixels buy.

use super::report::{Point, Scheme, SourceReport};

/// The report of a source as text.
#[must_use]
pub fn text(report: &SourceReport) -> String {
    let demand = report.demand;
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
    lines.push(heading());
    let of = |ids: &[usize]| report.points.iter().filter(|point| ids.contains(&point.id)).collect::<Vec<_>>();
    lines.push("front of time and worst position error:".to_owned());
    lines.extend(by_time(of(&report.fronts.position)).into_iter().map(line));
    if !report.fronts.picture.is_empty() {
        lines.push("front of time and FLIP:".to_owned());
        lines.extend(by_time(of(&report.fronts.picture)).into_iter().map(line));
    }
    lines.push("front of bytes and worst position error:".to_owned());
    lines.extend(report.fronts.bytes.iter().flat_map(|&id| of(&[id])).map(line));
    lines.push("the same scheme in 32-bit floats:".to_owned());
    lines.extend(
        by_time(report.points.iter().filter(|point| point.scheme == Scheme::F32).collect()).into_iter().map(line),
    );
    if report.hold.flip.is_some() {
        lines.push(format!(
            "sample-and-hold: PSNR {} dB, FLIP {}",
            number(report.hold.psnr_db, 2),
            number(report.hold.flip, 4)
        ));
    }
    lines.extend(rates(report));
    lines.join("\n")
}

fn by_time(mut points: Vec<&Point>) -> Vec<&Point> {
    points.sort_by(|a, b| time(a).total_cmp(&time(b)));
    points
}

/// One sentence for each rate above every frame.
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

fn heading() -> String {
    format!(
        "{:>4} {:<14} {:<15} {:<15} {:<9} {:>5} {:>9} {:>7} {:>9} {:>9} {:>9} {:>9} {:>7} {:>7} {:>7} {:>8}",
        "no",
        "lanes",
        "budget",
        "rounding",
        "rung",
        "bytes",
        "us/frame",
        "x copy",
        "run-time",
        "worst px",
        "bound px",
        "truth px",
        "PSNR",
        "SSIM",
        "FLIP",
        "missing%"
    )
}

fn time(point: &Point) -> f64 {
    point.compile_time.map_or(f64::INFINITY, |time| time.frame_us)
}

fn line(point: &Point) -> String {
    let summary = &point.summary;
    let (budget, rounding) = match point.scheme {
        Scheme::Galpix => (point.budget.as_str(), point.rounding.unwrap_or_default()),
        Scheme::F32 => ("f32", "-"),
    };
    format!(
        "{:>4} {:<14} {:<15} {:<15} {:<9} {:>5} {:>9} {:>7} {:>9} {:>9} {:>9} {:>9} {:>7} {:>7} {:>7} {:>8}",
        point.id,
        point.lanes,
        budget,
        rounding,
        point.rung,
        point.bytes,
        number(point.compile_time.map(|time| time.frame_us), 1),
        number(point.compile_time.map(|time| time.x_copy), 2),
        number(point.run_time.map(|time| time.frame_us), 1),
        number(summary.worst_px, 4),
        number(summary.bound_px, 4),
        number(summary.truth_worst_px, 4),
        number(summary.psnr_db, 2),
        number(summary.ssim, 4),
        number(summary.flip, 4),
        number(summary.missing_percent, 2),
    )
}

/// A figure or a dash.
fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
}
