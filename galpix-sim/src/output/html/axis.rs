//! Axes of the plots with free axes: linear or logarithmic, with ticks at 1, 2 and 5 times powers of ten.

/// How figures are laid along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// From 0.
    Linear,
    /// By decades; what is below the floor is drawn at it.
    Log {
        /// The smallest figure.
        floor: f64,
    },
    /// By doublings, with ticks at powers of two; figures of 1 or more.
    Doubling,
}

/// An axis for some figures.
#[derive(Clone, Debug)]
pub struct Axis {
    scale: Scale,
    /// Its ends, as places.
    pub ends: std::ops::Range<f64>,
    /// Places of its ticks.
    pub ticks: Vec<f64>,
}

impl Axis {
    /// Creates an axis that shows all of `figures` that are finite; `None` if there are none.
    pub fn new(scale: Scale, figures: impl Iterator<Item = f64>) -> Option<Self> {
        let places: Vec<f64> = figures.filter(|figure| figure.is_finite()).map(|figure| place(scale, figure)).collect();
        let low = places.iter().copied().reduce(f64::min)?;
        let high = places.iter().copied().reduce(f64::max)?;
        let (low, high) = match scale {
            Scale::Linear => (low.min(0.0), if high > low.min(0.0) { high * 1.06 } else { low.min(0.0) + 1.0 }),
            // A decade at least, so that there are ticks.
            Scale::Log { .. } => {
                let pad = (0.06 * (high - low)).max(0.5 * (1.0 - (high - low))).max(0.02);
                (low - pad, high + pad)
            }
            Scale::Doubling => (low - 0.2, high.max(low + 1.0) + 0.2),
        };
        let ticks = match scale {
            Scale::Linear => {
                let step = step((high - low) / 5.0);
                (0..).map(|n| f64::from(n) * step).take_while(|&tick| tick <= high).collect()
            }
            Scale::Log { .. } => log_ticks(low, high),
            Scale::Doubling => (low.ceil() as i32..=high.floor() as i32).map(f64::from).collect(),
        };
        Some(Self { scale, ends: low..high, ticks })
    }

    /// Returns where a figure is.
    pub fn place(&self, figure: f64) -> f64 {
        place(self.scale, figure).clamp(self.ends.start, self.ends.end)
    }

    /// Returns the label of a tick.
    pub fn label(&self, place: f64) -> String {
        match self.scale {
            Scale::Linear => plain(place),
            Scale::Log { floor } if place <= floor.log10() + 1e-9 => format!("\u{2264}{}", plain(floor)),
            Scale::Log { .. } => plain(10f64.powf(place)),
            Scale::Doubling => plain(place.exp2()),
        }
    }
}

fn place(scale: Scale, figure: f64) -> f64 {
    match scale {
        Scale::Linear => figure,
        Scale::Log { floor } => figure.max(floor).log10(),
        Scale::Doubling => figure.max(1.0).log2(),
    }
}

/// 1, 2 or 5 times a power of ten, at least `span`.
fn step(span: f64) -> f64 {
    let power = 10f64.powf(span.max(1e-12).log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|step| step * power).into_iter().find(|&step| step >= span).unwrap_or(power)
}

/// 1, 2 and 5 times powers of ten where there are few, else powers of ten alone.
fn log_ticks(low: f64, high: f64) -> Vec<f64> {
    let multiples: &[f64] = if high - low > 2.5 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let decades = low.floor() as i32..=high.ceil() as i32;
    decades
        .flat_map(|decade| multiples.iter().map(move |multiple| f64::from(decade) + multiple.log10()))
        .filter(|tick| (low..=high).contains(tick))
        .collect()
}

/// Returns a figure with the digits that it needs.
fn plain(figure: f64) -> String {
    let digits = if figure == 0.0 { 0.0 } else { (2.0 - figure.abs().log10().floor()).clamp(0.0, 6.0) };
    let text = format!("{figure:.*}", digits as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let axis = Axis::new(Scale::Log { floor: 1e-3 }, [0.0, 0.02, 96.0].into_iter()).unwrap();
        let labels: Vec<String> = axis.ticks.iter().map(|&tick| axis.label(tick)).collect();
        assert_eq!(labels, ["\u{2264}0.001", "0.01", "0.1", "1", "10", "100"]);
        let axis = Axis::new(Scale::Log { floor: 1.0 }, [120.0, 900.0].into_iter()).unwrap();
        let labels: Vec<String> = axis.ticks.iter().map(|&tick| axis.label(tick)).collect();
        assert_eq!(labels, ["200", "500", "1000"]);
        let axis = Axis::new(Scale::Doubling, [1.0, 32.0].into_iter()).unwrap();
        assert_eq!(axis.ticks.iter().map(|&tick| axis.label(tick)).collect::<String>(), "12481632");
        let axis = Axis::new(Scale::Linear, [0.02, 0.23].into_iter()).unwrap();
        assert_eq!(
            axis.ticks.iter().map(|&tick| axis.label(tick)).collect::<Vec<_>>(),
            ["0", "0.05", "0.1", "0.15", "0.2"]
        );
    }

    #[test]
    fn axes_are_never_empty() {
        for scale in [Scale::Linear, Scale::Log { floor: 1e-3 }, Scale::Doubling] {
            for figure in [0.0, 1.0, 1e-9, 1e9, -2.0] {
                let axis = Axis::new(scale, std::iter::once(figure)).unwrap();
                assert!(axis.ends.start < axis.ends.end, "{scale:?} {figure}");
                assert!(axis.ends.contains(&axis.place(figure)), "{scale:?} {figure}");
            }
            assert!(Axis::new(scale, [f64::NAN].into_iter()).is_none());
        }
    }
}
