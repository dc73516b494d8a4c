//! Displacements that come in steps, as renderers' motion vectors do, and what can be told from them.
//!
//! A displacement is off by half a step at most, so a difference of two by a whole one. Half a step of the velocity,
//! times the frames, is what a position is off because of it.

/// Fewer different numbers are no evidence of a step: a few rigid motions may lie on any lattice.
const LEAST_LEVELS: usize = 8;

/// So many numbers for each level at least: else the numbers are but few.
const TO_A_LEVEL: usize = 4;

/// Numbers nearer to each other than this part of the largest one are the same but for rounding.
const SAME: f64 = 2e-4;

/// By how much of a step a gap may miss a whole number of steps.
const OFF: f64 = 0.1;

/// The part of the gaps that must fit.
const MOST: f64 = 0.95;

/// Numbers looked at, at most.
const LOOKED_AT: usize = 1 << 18;

/// The part of neighbouring cells that have the same number, along rows and along columns: what grows evenly, from cell
/// to cell, lies on a lattice without coming in steps.
const ALIKE: f64 = 0.25;

/// Numbers of a picture's cells, NaN where they are unknown.
pub(super) struct Field {
    pub numbers: Vec<f64>,
    pub width: usize,
    /// Columns and rows from a number of the file to the next one.
    pub apart: [usize; 2],
}

/// The steps of x and y; 0 where there is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Steps(pub [f64; 2]);

impl Steps {
    /// Finds the steps of two fields.
    pub fn found(fields: [Field; 2]) -> Self {
        Self(fields.map(|field| field.step().unwrap_or(0.0)))
    }

    /// Returns the larger one.
    pub fn largest(self) -> f64 {
        self.0[0].max(self.0[1])
    }
}

impl Field {
    /// Returns the step in which the numbers come; nothing if they do not.
    fn step(self) -> Option<f64> {
        let [columns, rows] = self.apart;
        let is_known = |number: &f64| number.abs() < 1e9;
        let alike = |along: usize| {
            let pairs =
                self.numbers.iter().zip(self.numbers.iter().skip(along)).filter(|(a, b)| is_known(a) && is_known(b));
            let (mut all, mut same) = (0_usize, 0_usize);
            for (a, b) in pairs {
                all += 1;
                same += usize::from(a == b);
            }
            same as f64 >= ALIKE * all as f64
        };
        if !alike(columns) || !alike(rows * self.width) {
            return None;
        }
        lattice(self.numbers)
    }
}

/// Returns the distance of equally spaced levels on which numbers lie; nothing if they do not.
fn lattice(mut numbers: Vec<f64>) -> Option<f64> {
    let every = numbers.len().div_ceil(LOOKED_AT).max(1);
    numbers = numbers.into_iter().step_by(every).filter(|number| number.abs() < 1e9).collect();
    numbers.sort_by(f64::total_cmp);
    let count = numbers.len();
    let largest = numbers.first()?.abs().max(numbers.last()?.abs());
    let mut levels: Vec<f64> = Vec::new();
    let mut last = f64::NEG_INFINITY;
    for number in numbers {
        if number - last > SAME * largest {
            levels.push(number);
        }
        last = number;
    }
    if levels.len() < LEAST_LEVELS || levels.len() * TO_A_LEVEL > count {
        return None;
    }
    let gaps: Vec<f64> = levels.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut sorted = gaps.clone();
    sorted.sort_by(f64::total_cmp);
    let first = sorted[sorted.len() / 10];
    // Over all levels the rounding of one gap does not count.
    let whole: f64 = gaps.iter().map(|gap| (gap / first).round().max(1.0)).sum();
    let step = gaps.iter().sum::<f64>() / whole;
    let fits = gaps.iter().filter(|&&gap| (gap / step - (gap / step).round()).abs() <= OFF).count();
    (fits as f64 >= MOST * gaps.len() as f64).then_some(step)
}
