//! Small budgets exhaustively, and the crack rule as it is written.

use super::*;
use crate::fast;
use crate::frame::Settings;
use crate::frame::step::parts;
use crate::source::constant_time::residual;
use crate::source::cracks::Closed;
use crate::source::links::Links;
use crate::source::reference;
use crate::source::visibility::{EMPTY, Entry, FARTHEST, Kind, MOST_SAMPLES};

/// A number of 2^`frac` parts of a cell in `count` parts, halves upwards.
fn rounded(offset: i64, frac: u32, count: i64) -> i64 {
    (2 * count * offset + (1 << frac)).div_euclid(2 << frac)
}

#[test]
fn every_offset_has_its_residual_and_its_place() {
    for frac in 0..=16 {
        let half = 1 << frac >> 1;
        for offset in -half..half.max(1) {
            let sixteenths = rounded(offset.into(), frac, 16);
            assert!((-8..=8).contains(&sixteenths));
            let own = [-sixteenths as i32, 0];
            assert_eq!(residual([offset, 0], [frac, 0]), own, "{offset} of 2^{frac}");
            assert_eq!(residual([0, offset], [0, frac]), [own[1], own[0]]);
            assert_eq!(i64::from(parts::<5>(offset, frac)), rounded(offset.into(), frac, 32));
        }
    }
}

/// Galpixels with every pair of offsets are shown in their own cells, with the residuals of the offsets.
#[test]
fn a_cell_shows_the_residual_of_every_offset() {
    for frac in 0..=6 {
        let format = format(frac, Layout::VELOCITY_GRAY4);
        let (side, record) = (1 << frac, *format.record());
        let shape = (side, side, Margin::NONE);
        let mut layers = [drawn(shape, format, |_, _| Galpixel::default())];
        with_sources(shape, format, &mut layers, &mut Random(1), |sources| {
            for cell in 0..side * side {
                let mut words = sources.layers[0].map.words_at(cell).unwrap();
                record.offset_x().set(&mut words, cell % side);
                record.offset_y().set(&mut words, cell / side);
                sources.layers[0].map.put(cell, &words);
            }
            sources.layers[0].begin(1);
            assert_eq!(sources.show(&Settings::for_depth(4)).holes, 0);
            for cell in 0..side * side {
                let signed = |offset: u32| i64::from(offset) - if 2 * offset >= side.max(2) { side as i64 } else { 0 };
                let residual = [cell % side, cell / side].map(|offset| -rounded(signed(offset), frac, 16) as i32);
                let entry = sources.visibility.at(cell);
                assert_eq!((entry.sample(), entry.residual()), (cell, residual), "{cell} of 2^{frac}");
            }
        });
    }
}

#[test]
fn entries_hold_every_residual_and_clamp_what_is_more() {
    for sample in [0, 1, 0x155_555, MOST_SAMPLES - 1] {
        for (u, v) in (-40..40).flat_map(|u| (-40..40).map(move |v| (u, v))) {
            let clamped = [u.clamp(-16, 15), v.clamp(-16, 15)];
            let entry = Entry::new(77, Kind::Quad, sample, [u, v]);
            assert_eq!((entry.depth(), entry.sample(), entry.residual()), (77, sample, clamped));
            let other = Entry::new(FARTHEST, Kind::Point, sample, [3, -3]).seen_from([u, v]);
            assert_eq!((other.depth(), other.sample(), other.residual()), (FARTHEST as i32, sample, clamped));
            assert!(other.is_point() && !entry.is_point());
        }
    }
}

/// What the crack rule reads: entries and links of a grid, and the threshold.
struct Cracks<'c> {
    sides: [i32; 2],
    entries: &'c [Entry],
    layers: Vec<Links<'c>>,
    threshold: i32,
}

impl Cracks<'_> {
    fn at(&self, x: i32, y: i32) -> Option<Entry> {
        let [width, height] = self.sides;
        let is_inside = (0..width).contains(&x) && (0..height).contains(&y);
        is_inside.then(|| self.entries[(y * width + x) as usize])
    }

    /// Whether the samples of two entries are of one surface.
    fn joined(&self, f: Entry, g: Entry) -> bool {
        let [width, height] = self.sides;
        let place = |entry: Entry| {
            let (sample, cells) = (entry.sample() as i32, width * height);
            (sample / cells, sample % cells % width, sample % cells / width)
        };
        let ((layer, mut x, mut y), (other, to_x, to_y)) = (place(f), place(g));
        if layer != other || (x - to_x).abs() > 2 || (y - to_y).abs() > 2 {
            return false;
        }
        let links = self.layers[layer as usize];
        while [x, y] != [to_x, to_y] {
            let next = x + (to_x - x).signum();
            if x != next && !links.right((y * width + x.min(next)) as u32) {
                return false;
            }
            x = next;
            let next = y + (to_y - y).signum();
            if y != next && !links.below((y.min(next) * width + x) as u32) {
                return false;
            }
            y = next;
        }
        true
    }

    /// The distance and the entry by which two opposite neighbours close a cell.
    fn closing(&self, [x, y]: [i32; 2], [dx, dy]: [i32; 2]) -> Option<(i32, Entry)> {
        let own = self.at(x, y)?;
        let (f, g) = (self.at(x - dx, y - dy)?, self.at(x + dx, y + dy)?);
        let is_nearer = |entry: Entry| !own.is_some() || entry.depth() < own.depth() - self.threshold;
        if !f.is_some() || !g.is_some() || !is_nearer(f) || !is_nearer(g) {
            return None;
        }
        if !self.joined(f, g) {
            return None;
        }
        let [[fu, fv], [gu, gv]] = [f.residual(), g.residual()];
        let (from_f, from_g) = ([fu + 16 * dx, fv + 16 * dy], [gu - 16 * dx, gv - 16 * dy]);
        let [of_f, of_g] = [from_f, from_g].map(|[u, v]| u.abs() + v.abs());
        Some(if of_f <= of_g { (of_f, f.seen_from(from_f)) } else { (of_g, g.seen_from(from_g)) })
    }

    fn best(&self, x: i32, y: i32) -> Option<Entry> {
        let [across, down, first, second] =
            [[1, 0], [0, 1], [1, 1], [1, -1]].map(|towards| self.closing([x, y], towards));
        let straight = match (across, down) {
            (Some(across), Some(down)) => Some(if down.0 < across.0 { down } else { across }),
            _ => across.or(down),
        };
        straight.or(first).or(second).map(|(_, entry)| entry)
    }

    /// All entries after cracks are closed, and the counts.
    fn close(&self) -> (Vec<Entry>, Closed) {
        let (mut after, mut closed) = (self.entries.to_vec(), Closed::default());
        let width = self.sides[0];
        for (cell, to) in (0..).zip(&mut after) {
            let best = self.best(cell % width, cell / width);
            closed.points += u32::from(to.is_point());
            closed.holes += u32::from(!to.is_some() && best.is_some());
            closed.empty += u32::from(!to.is_some() && best.is_none());
            *to = best.unwrap_or(*to);
        }
        (after, closed)
    }
}

/// Compares the crack rule, as it is written above, with both forms.
fn compare(sources: &mut Sources<'_, '_, Dynamic>, entries: &[Entry], threshold: i32) -> u32 {
    let grid = *sources.base().unwrap().grid();
    let sides = [grid.width() as i32, grid.height() as i32];
    let layers = sources.layers.iter().map(Source::links).collect();
    let expected = Cracks { sides, entries, layers, threshold }.close();
    for close in [reference::close, fast::close_cracks] {
        let visibility = &mut sources.visibility;
        visibility.clear();
        for (cell, &entry) in (0..).zip(entries) {
            visibility.challenge(cell, entry);
        }
        let closed = close(sources.layers, visibility, threshold);
        let after: Vec<_> = (0..visibility.grid().cells()).map(|cell| visibility.at(cell)).collect();
        assert_eq!((after, closed), expected, "{entries:?}, threshold {threshold}");
    }
    expected.1.holes
}

/// Sets the links of all cells of a layer from bits: two for each cell, the right one first. None lead out of the grid.
fn set_links(source: &mut Source<'_, Dynamic>, bits: u32) {
    let grid = *source.map.grid();
    source.links.fill(0);
    for cell in 0..grid.cells() {
        let right = cell % grid.width() + 1 < grid.width() && bits >> (2 * cell) & 1 != 0;
        let below = cell / grid.width() + 1 < grid.height() && bits >> (2 * cell + 1) & 1 != 0;
        let links = (u32::from(right) * 0b0011) | (u32::from(below) * 0b1100);
        source.links[cell as usize / 8] |= links << (cell % 8 * 4);
    }
}

/// An entry whose key is one of 13.
fn entry(key: u32, sample: u32, residual: [i32; 2]) -> Entry {
    let kind = if key.is_multiple_of(2) { Kind::Quad } else { Kind::Point };
    match key / 2 {
        6 => Entry::NONE,
        5 => Entry::new(FARTHEST, kind, sample, residual),
        depth => Entry::new(depth, kind, sample, residual),
    }
}

/// Three cells in a row and in a column: all keys of near depths, of the farthest one and of an empty cell.
#[test]
fn all_keys_of_three_cells_are_closed_by_the_rule() {
    let format = format(4, Layout::VELOCITY_GRAY4);
    let mut holes = 0;
    for shape in [(3, 1, Margin::NONE), (1, 3, Margin::NONE)] {
        let mut layers = [drawn(shape, format, |_, _| nothing())];
        with_sources(shape, format, &mut layers, &mut Random(1), |sources| {
            for links in [u32::MAX, 0b0011, 0] {
                set_links(&mut sources.layers[0], links);
                for residuals in [[[0, 0], [0, 0]], [[-5, 2], [3, -1]], [[8, 8], [-8, -8]], [[-16, -16], [15, 15]]] {
                    for number in 0..13 * 13 * 13 {
                        let keys = [number % 13, number / 13 % 13, number / 169];
                        let entries = [
                            entry(keys[0], 0, residuals[0]),
                            entry(keys[1], 1, [7, -7]),
                            entry(keys[2], 2, residuals[1]),
                        ];
                        for threshold in [0, 1, 2, 1 << 15] {
                            holes += compare(sources, &entries, threshold);
                        }
                    }
                }
            }
        });
    }
    assert!(holes > 1000);
}

/// Few cells with any samples of two layers and any links, so that all directions and paths occur.
#[test]
fn random_entries_and_links_are_closed_by_the_rule() {
    let format = format(4, Layout::VELOCITY_GRAY4);
    let (mut random, mut holes) = (Random(2), 0);
    for shape in [(3, 3, Margin::NONE), (4, 4, Margin::NONE), (2, 6, Margin::NONE), (1, 7, Margin::NONE)] {
        let mut layers = [(); 2].map(|()| drawn(shape, format, |_, _| nothing()));
        with_sources(shape, format, &mut layers, &mut Random(1), |sources| {
            for _ in 0..20_000 {
                for layer in sources.layers.iter_mut() {
                    let bits = random.next() | random.next() | random.next();
                    set_links(layer, if random.below(4) > 0 { bits } else { u32::MAX });
                }
                let cells = shape.0 * shape.1;
                let entries: Vec<_> = (0..cells)
                    .map(|cell| {
                        // Mostly the samples of the cells, or of those around.
                        let near = (cell + random.below(5) * random.below(2)) % cells;
                        let far = cells * u32::from(random.below(8) == 0);
                        let residual = [random.below(32) as i32 - 16, random.below(32) as i32 - 16];
                        entry(random.below(7) + 6 * random.below(2), near + far, residual)
                    })
                    .collect();
                holes += compare(sources, &entries, random.below(4) as i32);
            }
        });
    }
    assert!(holes > 1000);
}

#[test]
fn every_key_is_smaller_than_that_of_an_empty_cell() {
    for depth in [0, 1, FARTHEST - 1, FARTHEST, FARTHEST + 1, u32::MAX] {
        for kind in [Kind::Quad, Kind::Point] {
            let entry = Entry::new(depth, kind, MOST_SAMPLES - 1, [15, 15]);
            assert!(entry.is_some() && entry.depth() < i32::from(EMPTY >> 1));
        }
    }
}
