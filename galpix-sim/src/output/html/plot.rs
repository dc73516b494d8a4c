//! One plot as inline SVG: lines over frames.

use super::canvas::{FINE, colour, element, pen};
use super::style::Ink;
use super::text::figure;
use plotters::coord::ranged1d::{AsRangedCoord, DefaultFormatting, KeyPointHint, ValueFormatter};
use plotters::prelude::*;

const WIDTH: u32 = 380;
const HEIGHT: u32 = 236;
/// Above this many points a line carries no dots.
const MOST_DOTS: usize = 40;
/// Powers of ten that a logarithmic axis spans at most.
const MOST_DECADES: i32 = 8;

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
    /// Its entry in the legend.
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

    /// Returns whether there is anything to draw.
    pub fn is_empty(&self) -> bool {
        self.measured().next().is_none()
    }
}

/// A plot over frames.
#[derive(Clone, Debug)]
pub struct Plot {
    /// A description for readers who cannot see it.
    pub description: String,
    /// The lines, drawn in this order.
    pub lines: Vec<Line>,
    /// Whether the vertical axis starts at 0.
    pub from_zero: bool,
    /// Figures from here on do not stretch the axis and are drawn at its upper end.
    pub cap: f64,
}

/// Returns the plot as an `<svg>` element; `None` if no line has a point.
pub fn svg(plot: &Plot) -> Option<String> {
    let frames = frame_range(plot)?;
    let values = value_range(plot)?;
    let decimals = decimals(values.end - values.start);
    let label = move |value: &f64| figure(Some(*value), decimals);
    let end = values.end;
    let drawing = draw(plot, frames, values, &label, |value| value.min(end)).ok()?;
    element(&drawing, WIDTH, HEIGHT, &plot.description)
}

/// Returns the same over a logarithmic vertical axis, for figures of different powers of ten. Figures of 0 and below,
/// and those more than [`MOST_DECADES`] powers of ten below the largest, are drawn at its lower end.
pub fn svg_log(plot: &Plot) -> Option<String> {
    let frames = frame_range(plot)?;
    let (lowest, highest) = decades(plot)?;
    let (start, end) = (f64::from(lowest), f64::from(highest));
    let inside = |value: f64| if value > 0.0 { value.log10().clamp(start, end) } else { start };
    let drawing = draw(plot, frames, Decades { lowest, highest }, &|power| power_of_ten(*power), inside).ok()?;
    element(&drawing, WIDTH, HEIGHT, &plot.description)
}

/// Returns the powers of ten around all figures above 0, never the same.
fn decades(plot: &Plot) -> Option<(i32, i32)> {
    let powers =
        || plot.lines.iter().flat_map(Line::measured).filter(|(_, value)| *value > 0.0).map(|(_, v)| v.log10());
    let (least, most) = (powers().reduce(f64::min)?, powers().reduce(f64::max)?);
    let highest = most.ceil() as i32;
    let lowest = (least.floor() as i32).max(highest - MOST_DECADES).min(highest - 1);
    Some((lowest, highest))
}

/// An axis of powers of ten: its values are their exponents.
struct Decades {
    lowest: i32,
    highest: i32,
}

impl Ranged for Decades {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let part = (value - f64::from(self.lowest)) / f64::from(self.highest - self.lowest);
        limit.0 + (part * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        let step = if self.highest - self.lowest > 5 { 2 } else { 1 };
        (self.lowest..=self.highest).rev().step_by(step).map(f64::from).collect()
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.lowest.into()..self.highest.into()
    }
}

/// Returns a whole power of ten as a label: a plain number where that is short.
fn power_of_ten(power: f64) -> String {
    const DIGITS: [char; 10] = [
        '\u{2070}', '\u{b9}', '\u{b2}', '\u{b3}', '\u{2074}', '\u{2075}', '\u{2076}', '\u{2077}', '\u{2078}',
        '\u{2079}',
    ];
    let power = power.round() as i32;
    match power {
        0..=3 => 10u32.pow(power as u32).to_string(),
        -3..0 => figure(Some(10f64.powi(power)), power.unsigned_abs() as usize),
        _ => {
            let sign = if power < 0 { "\u{207b}" } else { "" };
            let digits = power.unsigned_abs().to_string();
            let raised: String = digits.bytes().map(|digit| DIGITS[usize::from(digit - b'0')]).collect();
            format!("10{sign}{raised}")
        }
    }
}

/// Returns the first and last frame, never the same.
fn frame_range(plot: &Plot) -> Option<std::ops::Range<u32>> {
    let frames = || plot.lines.iter().flat_map(Line::measured).map(|(frame, _)| frame);
    let (first, last) = (frames().min()?, frames().max()?);
    Some(if first == last { first.saturating_sub(1)..last.saturating_add(1) } else { first..last })
}

/// Returns the vertical extent, never empty.
fn value_range(plot: &Plot) -> Option<std::ops::Range<f64>> {
    let values = || plot.lines.iter().flat_map(Line::measured).map(|(_, value)| value);
    values().next()?;
    let below_cap = || values().filter(|&value| value < plot.cap);
    let lowest = below_cap().reduce(f64::min).unwrap_or(plot.cap);
    let highest = below_cap().reduce(f64::max).unwrap_or(plot.cap);
    let lowest = if plot.from_zero { lowest.min(0.0) } else { lowest };
    // Figures that hardly differ do not ask for an axis of many digits.
    let pad = (0.08 * (highest - lowest)).max(0.02 * highest.abs());
    let pad = if pad > 0.0 { pad } else { 1.0 };
    let range = if plot.from_zero && lowest == 0.0 { 0.0..highest + pad } else { lowest - pad..highest + pad };
    (range.start.is_finite() && range.end.is_finite()).then_some(range)
}

fn draw<Y>(
    plot: &Plot,
    frames: std::ops::Range<u32>,
    axis: Y,
    label: &dyn Fn(&f64) -> String,
    inside: impl Fn(f64) -> f64,
) -> Result<String, Box<dyn std::error::Error>>
where
    Y: AsRangedCoord<Value = f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    let mut drawing = String::new();
    let root = SVGBackend::with_string(&mut drawing, (WIDTH * FINE, HEIGHT * FINE)).into_drawing_area();
    let mut chart = ChartBuilder::on(&root)
        .margin_top(10 * FINE)
        .margin_right(14 * FINE)
        .x_label_area_size(22 * FINE)
        .y_label_area_size(46 * FINE)
        .build_cartesian_2d(frames, axis)?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(pen(Ink::Grid, 1))
        .axis_style(pen(Ink::Axis, 1))
        .set_all_tick_mark_size(4 * FINE)
        .x_labels(7)
        .y_labels(6)
        .y_label_formatter(&label)
        .label_style(("sans-serif", 14 * FINE).into_font().color(&colour(Ink::Label)))
        .draw()?;
    for line in &plot.lines {
        let points: Vec<_> = line.measured().map(|(frame, value)| (frame, inside(value))).collect();
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
    drop(root);
    Ok(drawing)
}

/// Returns the digits after the point that distinguish the labels of an axis of this length: its five or six steps are
/// 1, 2 or 5 times a power of ten.
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
    fn equal_figures_have_labels_of_few_digits() {
        let (equal, plot) = (100.0, |value| plot(vec![(1, Some(value)), (2, Some(value))]));
        let range = value_range(&Plot { from_zero: false, ..plot(equal) }).expect("a range");
        assert!(decimals(range.end - range.start) <= 1, "{range:?}");
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
    fn a_logarithmic_axis_spans_whole_decades_and_takes_anything() {
        for (values, expected) in [
            ([0.02, 30.0], Some((-2, 2))),
            ([1e-30, 5.0], Some((-7, 1))),
            ([0.0, 1.0], Some((-1, 0))),
            ([-1.0, 1e5], Some((4, 5))),
            ([0.0, -1.0], None),
        ] {
            let plot = plot(vec![(1, Some(values[0])), (2, Some(values[1])), (3, Some(f64::NAN)), (4, None)]);
            assert_eq!(decades(&plot), expected, "{values:?}");
            let drawing = svg_log(&plot);
            assert_eq!(drawing.is_some(), expected.is_some());
            assert!(drawing.is_none_or(|drawing| drawing.matches("<circle").count() == 2));
        }
        let labels: Vec<String> = [-12, -3, -1, 0, 3, 4, 15].map(f64::from).map(power_of_ten).into();
        assert_eq!(labels, ["10\u{207b}\u{b9}\u{b2}", "0.001", "0.1", "1", "1000", "10\u{2074}", "10\u{b9}\u{2075}"]);
    }

    #[test]
    fn labels_have_digits_enough() {
        assert_eq!([decimals(50.0), decimals(9.0), decimals(1.0), decimals(0.3), decimals(20_000.0)], [0, 0, 1, 2, 0]);
    }
}
