//! A plot with two free axes as inline SVG: marks of several shapes and sizes, bounds above them, and lines.

use super::axis::{Axis, Scale};
use super::canvas::{FINE, Ticked, colour, element, pen};
use super::style::Ink;
use plotters::prelude::*;

const WIDTH: u32 = 560;
const HEIGHT: u32 = 380;
/// Half the width of a bound's tick, in units of the drawing.
const BAR: i32 = 4 * FINE as i32;

/// What a mark looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A disc.
    Disc,
    /// A square.
    Square,
    /// A triangle.
    Triangle,
    /// A square on its corner.
    Diamond,
    /// A cross.
    Cross,
}

/// One mark.
#[derive(Clone, Debug)]
pub struct Mark {
    /// Its figures.
    pub at: (f64, f64),
    /// What its second figure can at most be.
    pub bound: Option<f64>,
    /// Half its width, in units of the page.
    pub radius: f64,
    /// Its colour.
    pub ink: Ink,
    /// Its shape.
    pub shape: Shape,
    /// Its label.
    pub label: String,
}

/// A line through figures.
#[derive(Clone, Debug)]
pub struct Course {
    /// Its colour.
    pub ink: Ink,
    /// Whether it is broken.
    pub dashed: bool,
    /// Its corners.
    pub points: Vec<(f64, f64)>,
}

/// A plot with two free axes.
#[derive(Clone, Debug)]
pub struct Scatter {
    /// A description for readers who cannot see it.
    pub description: String,
    /// Title and scale of the axis to the right.
    pub x: (String, Scale),
    /// Title and scale of the axis upwards.
    pub y: (String, Scale),
    /// Drawn first.
    pub courses: Vec<Course>,
    /// Drawn over them, in this order.
    pub marks: Vec<Mark>,
}

/// Returns a level line at `height`, from one end of `marks` to the other.
pub fn level(height: f64, ink: Ink, marks: &[Mark]) -> Option<Course> {
    let low = marks.iter().map(|mark| mark.at.0).reduce(f64::min)?;
    let high = marks.iter().map(|mark| mark.at.0).reduce(f64::max)?;
    Some(Course { ink, dashed: true, points: vec![(low, height), (high, height)] })
}

/// Returns the plot as an `<svg>` element; `None` if there is nothing to draw.
pub fn svg(plot: &Scatter) -> Option<String> {
    let points = || plot.courses.iter().flat_map(|course| course.points.iter().copied());
    let marks = || plot.marks.iter().map(|mark| mark.at);
    let x = Axis::new(plot.x.1, points().chain(marks()).map(|at| at.0))?;
    let bounds = plot.marks.iter().filter_map(|mark| mark.bound);
    let y = Axis::new(plot.y.1, points().chain(marks()).map(|at| at.1).chain(bounds))?;
    let mut drawing = String::new();
    draw(plot, &x, &y, &mut drawing).ok()?;
    element(&drawing, WIDTH, HEIGHT, &plot.description)
}

type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw(plot: &Scatter, x: &Axis, y: &Axis, drawing: &mut String) -> Drawn {
    let root = SVGBackend::with_string(drawing, (WIDTH * FINE, HEIGHT * FINE)).into_drawing_area();
    let mut chart = ChartBuilder::on(&root)
        .margin_top(10 * FINE)
        .margin_right(16 * FINE)
        .x_label_area_size(50 * FINE)
        .y_label_area_size(72 * FINE)
        .build_cartesian_2d(Ticked::from(x), Ticked::from(y))?;
    let font = |size: u32| ("sans-serif", size * FINE).into_font().color(&colour(Ink::Label));
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(pen(Ink::Grid, 1))
        .axis_style(pen(Ink::Axis, 1))
        .set_all_tick_mark_size(4 * FINE)
        .x_label_formatter(&|place| x.label(*place))
        .y_label_formatter(&|place| y.label(*place))
        .label_style(font(15))
        .axis_desc_style(font(15))
        .x_desc(plot.x.0.as_str())
        .y_desc(plot.y.0.as_str())
        .draw()?;
    let place = |(right, up): (f64, f64)| (x.place(right), y.place(up));
    for course in &plot.courses {
        let points: Vec<_> = course.points.iter().copied().map(place).collect();
        if course.dashed {
            chart.draw_series(DashedLineSeries::new(points, 6 * FINE, 5 * FINE, pen(course.ink, 2)))?;
        } else {
            chart.draw_series(LineSeries::new(points, pen(course.ink, 2)))?;
        }
    }
    for mark in &plot.marks {
        let Some(bound) = mark.bound else { continue };
        let (at, top) = (place(mark.at), place((mark.at.0, bound)));
        chart.draw_series(std::iter::once(PathElement::new(vec![at, top], faint(Ink::Bound))))?;
        let tick = EmptyElement::at(top) + PathElement::new(vec![(-BAR, 0), (BAR, 0)], pen(Ink::Bound, 1));
        chart.draw_series(std::iter::once(tick))?;
    }
    for mark in &plot.marks {
        let radius = (mark.radius * f64::from(FINE)).round() as i32;
        let outline = corners(mark.shape, radius);
        let fill = colour(mark.ink).mix(0.82).filled();
        let at = EmptyElement::at(place(mark.at));
        match mark.shape {
            Shape::Disc => chart.draw_series(std::iter::once(at + Circle::new((0, 0), radius, fill)))?,
            Shape::Cross => {
                let [a, b] = [[outline[0], outline[2]], [outline[1], outline[3]]];
                let strokes = at + PathElement::new(a, pen(mark.ink, 2)) + PathElement::new(b, pen(mark.ink, 2));
                chart.draw_series(std::iter::once(strokes))?
            }
            _ => chart.draw_series(std::iter::once(at + Polygon::new(outline, fill)))?,
        };
    }
    for mark in plot.marks.iter().filter(|mark| !mark.label.is_empty()) {
        let away = (mark.radius * f64::from(FINE)).round() as i32 + FINE as i32;
        let style = ("sans-serif", 14 * FINE).into_font().style(FontStyle::Bold).color(&colour(Ink::Label));
        let label = EmptyElement::at(place(mark.at))
            + plotters::element::Text::new(mark.label.clone(), (away, -away - 10 * FINE as i32), style);
        chart.draw_series(std::iter::once(label))?;
    }
    root.present()?;
    drop(chart);
    Ok(())
}

/// Returns the corners of a shape around a mark.
fn corners(shape: Shape, radius: i32) -> Vec<(i32, i32)> {
    let r = radius;
    match shape {
        Shape::Disc => Vec::new(),
        Shape::Square | Shape::Cross => vec![(-r, -r), (r, -r), (r, r), (-r, r)],
        Shape::Triangle => vec![(0, -r - r / 4), (r + r / 4, r), (-r - r / 4, r)],
        Shape::Diamond => vec![(0, -r - r / 3), (r + r / 3, 0), (0, r + r / 3), (-r - r / 3, 0)],
    }
}

/// Returns a mark for a legend.
pub fn key(shape: Shape, ink: Ink, radius: f64) -> String {
    let middle = 9.0;
    let style = format!("style=\"fill:var(--{0});stroke:var(--{0})\"", ink.name());
    let outline = corners(shape, (radius * 16.0) as i32);
    let at = |(x, y): (i32, i32)| format!("{:.1},{:.1}", middle + f64::from(x) / 16.0, middle + f64::from(y) / 16.0);
    let points: Vec<String> = outline.into_iter().map(at).collect();
    let drawn = match (shape, points.as_slice()) {
        (Shape::Disc, _) => format!("<circle cx=\"{middle}\" cy=\"{middle}\" r=\"{radius}\" {style}/>"),
        (Shape::Cross, [a, b, c, d]) => format!("<path d=\"M{a}L{c}M{b}L{d}\" {style} stroke-width=\"2\"/>"),
        (_, points) => format!("<polygon points=\"{}\" {style}/>", points.join(" ")),
    };
    format!("<svg class=\"mark\" viewBox=\"0 0 18 18\" aria-hidden=\"true\">{drawn}</svg>")
}

fn faint(ink: Ink) -> ShapeStyle {
    colour(ink).mix(0.35).stroke_width(FINE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_mark_is_drawn_with_its_bound_and_its_label() {
        let mark = |x: f64, shape, label: &str| Mark {
            at: (x, 0.1),
            bound: Some(0.5),
            radius: 5.0,
            ink: Ink::Galpix,
            shape,
            label: label.to_owned(),
        };
        let plot = Scatter {
            description: "a <plot>".to_owned(),
            x: ("time, us".to_owned(), Scale::Log { floor: 1.0 }),
            y: ("error, px".to_owned(), Scale::Log { floor: 1e-3 }),
            courses: Vec::new(),
            marks: vec![mark(10.0, Shape::Disc, "A"), mark(20.0, Shape::Square, ""), mark(30.0, Shape::Cross, "")],
        };
        let svg = svg(&plot).expect("a plot");
        assert!(svg.contains("aria-label=\"a &lt;plot&gt;\"") && svg.trim_end().ends_with("</svg>"));
        assert_eq!((svg.matches("<circle").count(), svg.matches("<polygon").count()), (1, 1));
        assert_eq!(svg.matches("\nA\n").count(), 1);
        assert!(svg.contains("\ntime, us\n") && svg.contains("\nerror, px\n"));
        // A whisker and a tick for each bound.
        assert_eq!(svg.matches("stroke=\"#C22F45\"").count(), 6);
        assert_eq!(super::svg(&Scatter { marks: Vec::new(), ..plot }), None);
    }
}
