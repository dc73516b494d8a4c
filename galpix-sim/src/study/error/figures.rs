//! What the plots of a source show.

use maud::{Markup, PreEscaped, html};

use super::legend::{block_key, ink, key, radius, shape};
use super::report::{Point, Scheme, SourceReport};
use crate::output::html::axis::Scale;
use crate::output::html::line_key;
use crate::output::html::scatter::{self, Course, Mark, Scatter, Shape};
use crate::output::html::stack::{self, Layer, Stack};
use crate::output::html::style::Ink;
use crate::output::html::text::Text;

/// Position errors below this are drawn at it, in pixels.
const FLOOR_PX: f64 = 0.001;

/// Returns all plots of a source, each a `<figure>`.
pub fn all(source: &SourceReport) -> Markup {
    html! {
        (position(source, true))
        (picture(source))
        (bytes(source))
        (rates(source))
        (causes(source))
        (squares(source))
        (position(source, false))
    }
}

/// Returns the letter of the `place`-th point of a front.
pub fn letter(place: usize) -> String {
    let letter = char::from(b'A' + (place % 26) as u8);
    if place < 26 { letter.to_string() } else { format!("{letter}{}", place / 26) }
}

type Figures<'f> = &'f dyn Fn(&Point) -> Option<(f64, f64)>;

/// Marks for the points, small ones last, and the front through those that are on it.
fn marks(source: &SourceReport, at: Figures<'_>, front: &[usize], bounds: bool) -> (Vec<Mark>, Course) {
    let mut points: Vec<&Point> = source.points.iter().collect();
    points.sort_by_key(|point| std::cmp::Reverse(point.bytes));
    let mark = |point: &&Point| {
        let place = front.iter().position(|&id| id == point.id);
        Some(Mark {
            at: at(point)?,
            bound: point.summary.worst_px.filter(|_| bounds),
            radius: radius(point.bytes),
            ink: ink(point),
            shape: shape(point),
            label: place.map(letter).unwrap_or_default(),
        })
    };
    let corners = front.iter().filter_map(|id| source.points.iter().find(|point| point.id == *id)).filter_map(at);
    // A stair: up to the next point's time nothing better is to be had.
    let mut stair: Vec<(f64, f64)> = Vec::new();
    for corner in corners {
        if let Some(&(_, error)) = stair.last() {
            stair.push((corner.0, error));
        }
        stair.push(corner);
    }
    (points.iter().filter_map(mark).collect(), Course { ink: Ink::Guide, dashed: false, points: stair })
}

fn position(source: &SourceReport, compiled: bool) -> Markup {
    let at = |point: &Point| {
        let time = if compiled || point.scheme == Scheme::F32 { point.compile_time } else { point.run_time };
        Some((time?.frame_us, point.at_most_px().or(point.summary.worst_px)?))
    };
    let front: &[usize] = if compiled { &source.fronts.position } else { &[] };
    let (marks, stair) = marks(source, &at, front, true);
    let form = if compiled { "budget fixed at compile time" } else { "budget chosen at run time" };
    let plot = Scatter {
        description: format!("{}: certified position error against the time of a frame, {form}", source.source),
        x: (format!("time of a frame, \u{00B5}s ({form})"), Scale::Log { floor: 0.01 }),
        y: ("certified position error, px".to_owned(), Scale::Log { floor: FLOOR_PX }),
        courses: vec![stair],
        marks,
    };
    let (title, remark) = if compiled {
        (
            "Position error against time",
            "What a galpixel can at most be away from its second-order path; of floats, the worst measured. Points above each other take the same time: \
             bits within the same words are free.",
        )
    } else {
        (
            "Position error against time, run-time form",
            "The same points in the form that the simulator runs, which takes any budget and pays for it. The floats are the same.",
        )
    };
    figure(title, &key(source, true), scatter::svg(&plot), remark)
}

fn picture(source: &SourceReport) -> Markup {
    let at = |point: &Point| Some((point.compile_time?.frame_us, point.summary.flip?));
    let (marks, stair) = marks(source, &at, &source.fronts.picture, false);
    let mut courses = vec![stair];
    courses.extend(source.hold.flip.and_then(|flip| scatter::level(flip, Ink::Hold, &marks)));
    let plot = Scatter {
        description: format!("{}: FLIP against the time of a frame", source.source),
        x: ("time of a frame, \u{00B5}s (budget fixed at compile time)".to_owned(), Scale::Log { floor: 0.01 }),
        y: ("FLIP, mean of the frames compared".to_owned(), Scale::Linear),
        courses,
        marks,
    };
    let hold = line_key("sample-and-hold, which takes no time", Ink::Hold, true);
    let legend = html! { (key(source, false)) (hold) };
    figure("Picture error against time", &legend, scatter::svg(&plot), "Lower is better; 0 is the true picture.")
}

fn bytes(source: &SourceReport) -> Markup {
    let at = |point: &Point| Some((point.bytes as f64, point.at_most_px().or(point.summary.worst_px)?));
    let (marks, stair) = marks(source, &at, &source.fronts.bytes, true);
    let plot = Scatter {
        description: format!("{}: certified position error against bytes a galpixel", source.source),
        x: ("bytes a galpixel".to_owned(), Scale::Linear),
        y: ("certified position error, px".to_owned(), Scale::Log { floor: FLOOR_PX }),
        courses: vec![stair],
        marks,
    };
    let remark = "Whole words are stored: a map takes this much memory for each cell, and a product holds two.";
    figure("Position error against memory", &key(source, true), scatter::svg(&plot), remark)
}

fn rates(source: &SourceReport) -> Markup {
    let (title, x, remark, moved, held): (_, _, _, Vec<_>, Vec<_>) = if source.rates.is_empty() {
        (
            "Error by age",
            "frames since the update",
            "One update and its true pictures; the renderer cannot be run at other rates here.",
            source.ages.iter().map(|age| (f64::from(age.frame), age.flip)).collect(),
            source.ages.iter().map(|age| (f64::from(age.frame), age.flip_hold)).collect(),
        )
    } else {
        (
            "What galpixels buy",
            "frames from one update to the next",
            "The scene rendered anew every N frames, all frames of the display compared. At the same height, the way to the \
             right is what is saved of the renderer.",
            source.rates.iter().map(|rate| (f64::from(rate.every), rate.flip)).collect(),
            source.rates.iter().map(|rate| (f64::from(rate.every), rate.flip_hold)).collect(),
        )
    };
    let dots = |points: &[(f64, f64)], ink: Ink| {
        points
            .iter()
            .map(|&at| Mark { at, bound: None, radius: 4.0, ink, shape: Shape::Disc, label: String::new() })
            .collect::<Vec<_>>()
    };
    let plot = Scatter {
        description: format!("{}: FLIP of galpix and of sample-and-hold against {x}", source.source),
        x: (x.to_owned(), Scale::Doubling),
        y: ("FLIP, mean of the frames".to_owned(), Scale::Linear),
        marks: [dots(&held, Ink::Hold), dots(&moved, Ink::Galpix)].concat(),
        courses: vec![
            Course { ink: Ink::Hold, dashed: false, points: held },
            Course { ink: Ink::Galpix, dashed: false, points: moved },
        ],
    };
    let [moved, held] =
        [("galpix", Ink::Galpix), ("sample-and-hold", Ink::Hold)].map(|(name, ink)| line_key(name, ink, false));
    let legend = html! { (moved) (held) };
    figure(title, &legend, scatter::svg(&plot), remark)
}

fn causes(source: &SourceReport) -> Markup {
    let layer = |name: &str, ink: Ink, column: &dyn Fn(&super::causes::FrameCauses) -> f64| Layer {
        name: name.to_owned(),
        ink,
        figures: source.causes.iter().map(column).collect(),
    };
    let mut layers = vec![
        layer("snap to a cell", Ink::Guide, &|frame| frame.snap_px),
        layer("quantisation", Ink::Known, &|frame| frame.quantisation_px),
        layer("rounding drift", Ink::Galpix, &|frame| frame.drift_px),
        layer("saturation", Ink::Bound, &|frame| frame.saturation_px),
        layer("fields left out", Ink::Hold, &|frame| frame.left_out_px),
        layer("Taylor: beyond second order", Ink::Holes, &|frame| frame.taylor_px.unwrap_or(0.0)),
    ];
    layers.retain(|layer| layer.figures.iter().any(|&figure| figure > 0.0));
    let all = layer("all together", Ink::Label, &|frame| frame.all_px);
    let legend = stack_key(&layers, &all, Ink::Label);
    let known = source.causes.iter().any(|frame| frame.taylor_px.is_some());
    let remark = if known {
        "Means over the galpixels of the update, the worse of x and y: from the true place to the cell that shows it. Causes \
         may cancel, so the line is at most as high as the bars."
    } else {
        "Means over the galpixels of the update, the worse of x and y: from the second-order path to the cell that shows it. \
         The true motion is not known here, and with it what second order leaves out. Causes may cancel."
    };
    let stack = Stack {
        description: format!("{}: mean position error by cause over frames since the update", source.source),
        y: "mean position error, px".to_owned(),
        frames: source.causes.iter().map(|frame| frame.frame).collect(),
        layers,
        lines: vec![all],
    };
    let name = source.points.first().map(Point::name).unwrap_or_default();
    figure("Position error by cause", &legend, stack::svg(&stack), &format!("{name}. {remark}"))
}

fn squares(source: &SourceReport) -> Markup {
    let frames: Vec<_> = source.causes.iter().filter(|frame| frame.mse_reached.is_some()).collect();
    let layer = |name: &str, ink: Ink, column: &dyn Fn(&super::causes::FrameCauses) -> Option<f64>| Layer {
        name: name.to_owned(),
        ink,
        figures: frames.iter().map(|frame| column(frame).unwrap_or(0.0)).collect(),
    };
    let layers = vec![
        layer("cells that a galpixel reached", Ink::Galpix, &|frame| frame.mse_reached),
        layer("holes, as the fill mode fills them", Ink::Holes, &|frame| frame.mse_missing),
    ];
    let hold = layer("sample-and-hold", Ink::Hold, &|frame| frame.mse_hold);
    let legend = stack_key(&layers, &hold, Ink::Hold);
    let stack = Stack {
        description: format!("{}: squared error of the picture in reached cells and in holes", source.source),
        y: "mean squared error, code values\u{00B2}".to_owned(),
        frames: frames.iter().map(|frame| frame.frame).collect(),
        layers,
        lines: vec![hold],
    };
    let remark = "The squared error of the picture is the sum of both parts: where the galpixels are, and where none came, which \
                  no arithmetic can mend.";
    figure("Picture error by cause", &legend, stack::svg(&stack), remark)
}

/// Returns the legend of layers, and of a line over them.
fn stack_key(layers: &[Layer], line: &Layer, ink: Ink) -> Markup {
    html! {
        @for layer in layers { (block_key(&layer.name, layer.ink)) }
        (line_key(&line.name, ink, false))
    }
}

fn figure(title: &str, legend: &Markup, drawing: Option<String>, remark: &str) -> Markup {
    html! {
        figure {
            h3 { (Text(title)) }
            @match drawing {
                Some(drawing) => { p.legend { (legend) } (PreEscaped(drawing)) },
                None => p.nothing { "There is no true picture to compare with." },
            }
            figcaption { (Text(remark)) }
        }
    }
}
