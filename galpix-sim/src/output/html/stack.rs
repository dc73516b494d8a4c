//! Stacked bars over frames as inline SVG, with lines over them.

use super::axis::{Axis, Scale};
use super::canvas::{FINE, Ticked, colour, element, pen};
use super::style::Ink;
use plotters::prelude::*;

const WIDTH: u32 = 560;
const HEIGHT: u32 = 320;

/// One layer: what each bar has of it.
#[derive(Clone, Debug)]
pub struct Layer {
    /// Its entry in the legend.
    pub name: String,
    /// Its colour.
    pub ink: Ink,
    /// A figure for each bar, 0 or more.
    pub figures: Vec<f64>,
}

/// Bars over frames.
#[derive(Clone, Debug)]
pub struct Stack {
    /// A description for readers who cannot see it.
    pub description: String,
    /// Title of the axis upwards.
    pub y: String,
    /// The frame of each bar.
    pub frames: Vec<u32>,
    /// From the bottom up.
    pub layers: Vec<Layer>,
    /// Lines over the bars.
    pub lines: Vec<Layer>,
}

/// Returns the plot as an `<svg>` element; `None` if there is nothing to draw.
pub fn svg(stack: &Stack) -> Option<String> {
    let heights =
        (0..stack.frames.len()).map(|bar| stack.layers.iter().filter_map(|layer| layer.figures.get(bar)).sum::<f64>());
    let lines = stack.lines.iter().flat_map(|line| line.figures.iter().copied());
    let y = Axis::new(Scale::Linear, heights.chain(lines))?;
    let mut drawing = String::new();
    draw(stack, &y, &mut drawing).ok()?;
    element(&drawing, WIDTH, HEIGHT, &stack.description)
}

type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw(stack: &Stack, y: &Axis, drawing: &mut String) -> Drawn {
    let root = SVGBackend::with_string(drawing, (WIDTH * FINE, HEIGHT * FINE)).into_drawing_area();
    let bars = stack.frames.len();
    // Every bar has its frame beneath it, or every second one, …
    let every = bars.div_ceil(12).max(1);
    let ticks: Vec<f64> = (0..bars).filter(|bar| (bar + 1) % every == 0 || bars == 1).map(|bar| bar as f64).collect();
    let mut chart = ChartBuilder::on(&root)
        .margin_top(10 * FINE)
        .margin_right(16 * FINE)
        .x_label_area_size(50 * FINE)
        .y_label_area_size(72 * FINE)
        .build_cartesian_2d(Ticked::new(-0.6..bars as f64 - 0.4, ticks), Ticked::from(y))?;
    let font = |size: u32| ("sans-serif", size * FINE).into_font().color(&colour(Ink::Label));
    let frame = |bar: &f64| stack.frames.get(bar.round() as usize).map_or_else(String::new, u32::to_string);
    chart
        .configure_mesh()
        .disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(pen(Ink::Grid, 1))
        .axis_style(pen(Ink::Axis, 1))
        .set_all_tick_mark_size(4 * FINE)
        .x_label_formatter(&frame)
        .y_label_formatter(&|place| y.label(*place))
        .label_style(font(15))
        .axis_desc_style(font(15))
        .x_desc("frames since the update")
        .y_desc(stack.y.as_str())
        .draw()?;
    let mut bottoms = vec![0.0; bars];
    for layer in &stack.layers {
        for (bar, (bottom, &figure)) in bottoms.iter_mut().zip(&layer.figures).enumerate() {
            let place = bar as f64;
            let top = *bottom + figure;
            if figure > 0.0 {
                let corners = [(place - 0.4, *bottom), (place + 0.4, top)];
                chart.draw_series(std::iter::once(Rectangle::new(corners, colour(layer.ink).filled())))?;
            }
            *bottom = top;
        }
    }
    for line in &stack.lines {
        let points = (0..).map(f64::from).zip(line.figures.iter().copied());
        chart.draw_series(LineSeries::new(points, pen(line.ink, 2)))?;
    }
    root.present()?;
    drop(chart);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_has_a_rectangle_for_each_figure_above_nothing() {
        let layer = |ink, figures: &[f64]| Layer { name: String::new(), ink, figures: figures.to_vec() };
        let stack = Stack {
            description: String::new(),
            y: "px".to_owned(),
            frames: vec![1, 2, 4],
            layers: vec![layer(Ink::Known, &[0.1, 0.0, 0.3]), layer(Ink::Holes, &[0.2, 0.2, 0.2])],
            lines: vec![layer(Ink::Label, &[0.3, 0.2, 0.4])],
        };
        let svg = svg(&stack).expect("a plot");
        assert_eq!((svg.matches("fill=\"#0F8577\"").count(), svg.matches("fill=\"#7A45C4\"").count()), (2, 3));
        assert!(svg.contains("\nframes since the update\n") && svg.contains("\n4\n"));
        let empty = Stack { frames: Vec::new(), layers: Vec::new(), lines: Vec::new(), ..stack };
        assert_eq!(super::svg(&empty), None);
    }
}
