//! Push-pull once more, as one would write it down: whole levels, fractions, no tables, no shortcuts.

extern crate std;

use std::vec;
use std::vec::Vec;

use crate::inpaint::Gamma;

/// A cell: sixteenths that are known, depth, value of one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Cell {
    pub validity: i64,
    pub depth: i64,
    pub value: i64,
}

/// Rows of cells.
pub type Level = Vec<Vec<Cell>>;

/// Returns `sum / weight` to the nearest; a half goes up if `up`.
fn nearest(sum: i64, weight: i64, up: bool) -> i64 {
    let twice = 2 * sum.rem_euclid(weight);
    sum.div_euclid(weight) + i64::from(twice > weight || twice == weight && up)
}

fn up(x: usize, y: usize, level: usize) -> bool {
    (x ^ y ^ level) & 1 == 1
}

fn raised(gamma: Gamma, sum: i64) -> i64 {
    let mean = sum as f64 / 64.0;
    let power = match gamma {
        Gamma::Zero => 1.0,
        Gamma::Half => mean.sqrt(),
        Gamma::One => mean,
    };
    if sum == 0 { 0 } else { ((16.0 * power + 0.5).floor() as i64).max(1) }
}

fn pull(below: &Level, gamma: Gamma, threshold: i64, number: usize) -> Level {
    let (width, height) = (below[0].len().div_ceil(2), below.len().div_ceil(2));
    let one = |x: usize, y: usize| {
        let places = [(2 * x, 2 * y), (2 * x + 1, 2 * y), (2 * x, 2 * y + 1), (2 * x + 1, 2 * y + 1)];
        let children: Vec<Cell> = places.iter().filter_map(|&(x, y)| Some(*below.get(y)?.get(x)?)).collect();
        let depth = children.iter().map(|child| child.depth).max().unwrap_or(0);
        let kept: Vec<&Cell> = children.iter().filter(|child| depth - child.depth <= threshold).collect();
        let sum: i64 = kept.iter().map(|child| child.validity).sum();
        let weighted: i64 = kept.iter().map(|child| child.validity * child.value).sum();
        let value = if sum == 0 { 0 } else { nearest(weighted, sum, up(x, y, number)) };
        Cell { validity: raised(gamma, sum), depth, value }
    };
    (0..height).map(|y| (0..width).map(|x| one(x, y)).collect()).collect()
}

/// Returns what a cell of level `number` gets from the completed level above.
fn sample(above: &Level, [x, y]: [usize; 2], depth: i64, threshold: i64, number: usize) -> Option<i64> {
    let beside = |at: usize| if at % 2 == 1 { (at / 2) as isize + 1 } else { (at / 2) as isize - 1 };
    let (own, other) = ((x / 2) as isize, beside(x));
    let (row, across) = ((y / 2) as isize, beside(y));
    let mut sums = (0, 0);
    for (x, y, weight) in [(own, row, 9), (other, row, 3), (own, across, 3), (other, across, 1)] {
        let cell = usize::try_from(y).ok().and_then(|y| above.get(y)).and_then(|row| row.get(usize::try_from(x).ok()?));
        if let Some(cell) = cell.filter(|cell| cell.validity > 0 && depth - cell.depth <= threshold) {
            sums = (sums.0 + weight, sums.1 + weight * cell.value);
        }
    }
    (sums.0 > 0).then(|| nearest(sums.1, sums.0, up(x, y, number)))
}

/// Returns the value of each cell that is not known, where there is one.
pub fn filled(picture: &Level, gamma: Gamma, threshold: i64) -> Vec<Vec<Option<i64>>> {
    let mut levels = vec![picture.clone()];
    while levels.last().is_some_and(|level| level.len() > 1 || level[0].len() > 1) {
        levels.push(pull(levels.last().unwrap(), gamma, threshold, levels.len()));
    }
    let top = levels.len() - 1;
    for number in (1..top).rev() {
        let (below, above) = levels.split_at_mut(number + 1);
        for (y, row) in below[number].iter_mut().enumerate() {
            for (x, cell) in row.iter_mut().enumerate() {
                let from_above = sample(&above[0], [x, y], cell.depth, threshold, number);
                match from_above {
                    Some(value) if cell.validity < 16 => {
                        let sum = cell.validity * cell.value + (16 - cell.validity) * value;
                        *cell = Cell { validity: 16, value: nearest(sum, 16, up(x, y, number)), ..*cell };
                    }
                    _ => {}
                }
            }
        }
    }
    let of = |x: usize, y: usize, cell: &Cell| {
        if top == 0 { None } else { sample(&levels[1], [x, y], cell.depth, threshold, 0) }
    };
    let row = |(y, row): (usize, &Vec<Cell>)| row.iter().enumerate().map(|(x, cell)| of(x, y, cell)).collect();
    picture.iter().enumerate().map(row).collect()
}
