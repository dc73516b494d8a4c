//! The points as comma-separated values: a line a point, sample-and-hold as a line of its own for each source.

use super::report::{Document, Point, Scheme, SourceReport, Summary};
use super::timing::Time;

/// The columns, in order.
pub const COLUMNS: [&str; 36] = [
    "source",
    "id",
    "scheme",
    "lanes",
    "budget",
    "rounding",
    "rung",
    "position_frac_bits",
    "velocity_int_bits",
    "velocity_frac_bits",
    "acceleration_int_bits",
    "acceleration_frac_bits",
    "bytes",
    "used_bits",
    "compile_time_us",
    "compile_time_ns_per_cell",
    "compile_time_x_copy",
    "stand_in",
    "run_time_us",
    "run_time_ns_per_cell",
    "run_time_x_copy",
    "worst_px",
    "mean_px",
    "certified_px",
    "bound_px",
    "truth_worst_px",
    "truth_mean_px",
    "psnr_db",
    "psnr_known_db",
    "ssim",
    "flip",
    "missing_percent",
    "saturated",
    "front_position",
    "front_picture",
    "front_bytes",
];

/// The document's points.
#[must_use]
pub fn csv(document: &Document) -> String {
    let mut text = COLUMNS.join(",") + "\n";
    for source in &document.sources {
        for point in &source.points {
            text += &line(&cells(source, point));
        }
        let mut hold = vec![source.source.clone(), String::new(), "hold".to_owned()];
        hold.extend(std::iter::repeat_n(String::new(), 18));
        hold.extend(summary(&source.hold));
        hold.extend(std::iter::repeat_n(String::new(), 4));
        text += &line(&hold);
    }
    text
}

fn cells(source: &SourceReport, point: &Point) -> Vec<String> {
    let scheme = match point.scheme {
        Scheme::Galpix => "galpix",
        Scheme::F32 => "f32",
    };
    let text = |text: &str| text.to_owned();
    let mut cells = vec![
        source.source.clone(),
        point.id.to_string(),
        text(scheme),
        text(point.lanes),
        point.budget.clone(),
        text(point.rounding.unwrap_or_default()),
        text(point.rung),
    ];
    match point.bits {
        Some(bits) => cells.extend(bits.map(|bits| bits.to_string())),
        None => cells.extend(std::iter::repeat_n(String::new(), 5)),
    }
    cells.extend([point.bytes.to_string(), point.used_bits.to_string()]);
    cells.extend(time(point.compile_time));
    cells.push(point.stand_in.clone().unwrap_or_default());
    cells.extend(time(point.run_time));
    cells.extend(summary(&point.summary));
    cells.push(point.saturated.to_string());
    let fronts = &source.fronts;
    cells.extend([&fronts.position, &fronts.picture, &fronts.bytes].map(|front| front.contains(&point.id).to_string()));
    cells
}

fn number(value: Option<f64>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}

fn time(time: Option<Time>) -> [String; 3] {
    [time.map(|time| time.frame_us), time.map(|time| time.ns_per_cell), time.map(|time| time.x_copy)].map(number)
}

fn summary(summary: &Summary) -> [String; 11] {
    [
        summary.worst_px,
        summary.mean_px,
        summary.certified_px,
        summary.bound_px,
        summary.truth_worst_px,
        summary.truth_mean_px,
        summary.psnr_db,
        summary.psnr_known_db,
        summary.ssim,
        summary.flip,
        summary.missing_percent,
    ]
    .map(number)
}

/// A line, quoted where a cell needs it.
pub(crate) fn line(cells: &[String]) -> String {
    let quoted = |cell: &String| {
        if cell.contains([',', '"', '\n', '\r']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.clone() }
    };
    cells.iter().map(quoted).collect::<Vec<_>>().join(",") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_that_hold_a_separator_are_quoted() {
        let cells = ["a,b", "say \"x\"", "plain", ""].map(str::to_owned);
        assert_eq!(line(&cells), "\"a,b\",\"say \"\"x\"\"\",plain,\n");
    }
}
