//! One plot as inline SVG: lines over frames.

use super::canvas::{FINE, colour, element, pen};
use super::style::Ink;
use super::text::figure;
use plotters::prelude::*;

const WIDTH: u32 = 380;
const HEIGHT: u32 = 236;
/// Above this many points a line carries no dots.
const MOST_DOTS: usize = 40;

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// Unbroken, with a dot at each measured point.
    Solid,
    /// Broken, without dots.
    Dashed,
}

/// One line: figures over frames. Points that are `None` or not finite are left out, the line goes on to the next.
#[derive(Clone, Debug)]
pub struct Line {
    /// What the legend says.
    pub name: String,
    /// Its colour.
    pub ink: Ink,
    /// How it is drawn.
    pub stroke: Stroke,
    /// Frame and figure.
    pub points: Vec<(u32, Option<f64>)>,
}

impl Line {
    fn measured(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        self.points.iter().filter_map(|&(frame, value)| Some((frame, value.filter(|value| value.is_finite())?)))
    }

    /// Whether there is anything to draw.
    pub fn is_empty(&self) -> bool {
        self.measured().next().is_none()
    }
}

/// A plot over frames.
#[derive(Clone, Debug)]
pub struct Plot {
    /// What a reader who cannot see it is told.
    pub description: String,
    /// The lines, drawn in this order.
    pub lines: Vec<Line>,
    /// Whether the vertical axis starts at 0.
    pub from_zero: bool,
    /// Figures from here on do not stretch the axis and are drawn at its upper end.
    pub cap: f64,
}

/// The plot as an `<svg>` element; `None` if no line has a point.
pub fn svg(plot: &Plot) -> Option<String> {
    let frames = frame_range(plot)?;
    let values = value_range(plot)?;
    let mut drawing = String::new();
    draw(plot, frames, values, &mut drawing).ok()?;
    element(&drawing, WIDTH, HEIGHT, &plot.description)
}

/// First and last frame, never the same.
fn frame_range(plot: &Plot) -> Option<std::ops::Range<u32>> {
    let frames = || plot.lines.iter().flat_map(Line::measured).map(|(frame, _)| frame);
    let (first, last) = (frames().min()?, frames().max()?);
    Some(if first == last { first.saturating_sub(1)..last.saturating_add(1) } else { first..last })
}

/// The vertical extent, never empty.
fn value_range(plot: &Plot) -> Option<std::ops::Range<f64>> {
    let values = || plot.lines.iter().flat_map(Line::measured).map(|(_, value)| value);
    values().next()?;
    let below_cap = || values().filter(|&value| value < plot.cap);
    let lowest = below_cap().reduce(f64::min).unwrap_or(plot.cap);
    let highest = below_cap().reduce(f64::max).unwrap_or(plot.cap);
    let lowest = if plot.from_zero { lowest.min(0.0) } else { lowest };
    let span = (highest - lowest).max(highest.abs() * 1e-9);
    let pad = if span > 0.0 { span * 0.08 } else { 1.0 };
    let range = if plot.from_zero && lowest == 0.0 { 0.0..highest + pad } else { lowest - pad..highest + pad };
    (range.start.is_finite() && range.end.is_finite()).then_some(range)
}

type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw(plot: &Plot, frames: std::ops::Range<u32>, values: std::ops::Range<f64>, drawing: &mut String) -> Drawn {
    let root = SVGBackend::with_string(drawing, (WIDTH * FINE, HEIGHT * FINE)).into_drawing_area();
    let mut chart = ChartBuilder::on(&root)
        .margin_top(10 * FINE)
        .margin_right(14 * FINE)
        .x_label_area_size(22 * FINE)
        .y_label_area_size(46 * FINE)
        .build_cartesian_2d(frames, values.clone())?;
    let decimals = decimals(values.end - values.start);
    chart
        .configure_mesh()
        .disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(pen(Ink::Grid, 1))
        .axis_style(pen(Ink::Axis, 1))
        .set_all_tick_mark_size(4 * FINE)
        .x_labels(7)
        .y_labels(6)
        .y_label_formatter(&|value| figure(Some(*value), decimals))
        .label_style(("sans-serif", 14 * FINE).into_font().color(&colour(Ink::Label)))
        .draw()?;
    let inside = |(frame, value): (u32, f64)| (frame, value.min(values.end));
    for line in &plot.lines {
        let points: Vec<_> = line.measured().map(inside).collect();
        match line.stroke {
            Stroke::Solid => {
                chart.draw_series(LineSeries::new(points.iter().copied(), pen(line.ink, 2)))?;
                if points.len() <= MOST_DOTS {
                    let dot = |&point| Circle::new(point, 5 * FINE / 2, colour(line.ink).filled());
                    chart.draw_series(points.iter().map(dot))?;
                }
            }
            Stroke::Dashed => {
                let dashed = DashedLineSeries::new(points, 6 * FINE, 4 * FINE, pen(line.ink, 2));
                chart.draw_series(dashed)?;
            }
        }
    }
    root.present()?;
    drop(chart);
    Ok(())
}

/// Digits after the point that tell the labels of an axis of this length apart: its five or six steps are 1, 2 or 5 times
/// a power of ten.
fn decimals(span: f64) -> usize {
    (-(span / 6.0).log10().floor()).clamp(0.0, 6.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(points: Vec<(u32, Option<f64>)>) -> Plot {
        let line = Line { name: "line".into(), ink: Ink::Galpix, stroke: Stroke::Solid, points };
        Plot { description: "a <plot>".into(), lines: vec![line], from_zero: true, cap: f64::INFINITY }
    }

    #[test]
    fn a_line_with_a_gap_goes_on_and_has_a_dot_at_each_point() {
        let svg = svg(&plot(vec![(1, Some(1.0)), (2, None), (3, Some(f64::NAN)), (4, Some(3.0))])).expect("a plot");
        assert_eq!(svg.matches("<circle").count(), 2);
        assert!(svg.starts_with("<svg class=\"plot\" viewBox=\"0 0 1520 944\""));
        assert!(svg.contains("aria-label=\"a &lt;plot&gt;\""));
        assert!(svg.trim_end().ends_with("</svg>"));
        let line = svg.split("<polyline").find(|tag| tag.contains("#1F5FD0")).expect("the line");
        assert_eq!(
            line.split("points=\"").nth(1).and_then(|p| p.split('"').next()).map(|p| p.split(' ').count()),
            Some(3)
        );
    }

    #[test]
    fn nothing_to_draw_is_none() {
        assert_eq!(svg(&plot(vec![])), None);
        assert_eq!(svg(&plot(vec![(1, None), (2, Some(f64::INFINITY))])), None);
    }

    #[test]
    fn ranges_are_never_empty() {
        for value in [0.0, -3.0, 5.0, 1e-12, 1e300] {
            let plot = plot(vec![(u32::MAX, Some(value))]);
            let range = value_range(&plot).expect("a range");
            assert!(range.start < range.end, "{range:?} for {value}");
            let frames = frame_range(&plot).expect("a range");
            assert!(frames.start < frames.end);
            assert!(svg(&plot).is_some());
        }
    }

    #[test]
    fn a_cap_does_not_stretch_the_axis() {
        let mut plot = plot(vec![(0, Some(100.0)), (1, Some(30.0)), (2, Some(20.0))]);
        (plot.cap, plot.from_zero) = (100.0, false);
        let range = value_range(&plot).expect("a range");
        assert!(range.start > 18.0 && range.end < 32.0, "{range:?}");
        plot.lines[0].points.truncate(1);
        assert!(value_range(&plot).is_some_and(|range| range.contains(&100.0)));
    }

    #[test]
    fn labels_have_digits_enough() {
        assert_eq!([decimals(50.0), decimals(9.0), decimals(1.0), decimals(0.3), decimals(20_000.0)], [0, 0, 1, 2, 0]);
    }
}
