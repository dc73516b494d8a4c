//! Stretched quads: the depth of the background in what was uncovered (section 3.1 of the paper).
//!
//! Four neighbours of the map before are the corners of a quad. Where it is torn, because its corners move differently,
//! it connects foreground and background, and what opens between them has the farthest of its depths. The paper draws
//! such quads with the others into a depth buffer that is *re-partitioned*, equation (1), so that one depth test does
//! all: what is known is never overwritten, and of two stretched quads the farther one is seen. Here the known
//! galpixels are in the map already, with their depths, so that only the stretched quads have to be drawn, and only
//! holes look.
//!
//! A quad is looked at if one of its corners is on the edge of a surface: inside of one nothing is uncovered, or it is
//! a bullet hole. Its area is the convex hull of its corners, whose cells are found by the sides of lines they lie on.

use crate::format::Format;
use crate::format::record::{Record, Words};
use crate::format::rounding::Rounding;
use crate::frame::step::{advance, cells_moved, thresholds};
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// The widest and highest quad that is drawn, in cells. Larger ones, between corners that part at such a speed, say
/// nothing of what lies between them; without a limit a hostile map would take for ever.
const LARGEST: i32 = 64;

/// Returns a depth of `bits` bits in the re-partitioned range of `bits + 1` bits, equation (1): known surfaces in the
/// nearer half, stretched quads in the farther one and turned round, so that the smaller number is what is seen.
#[inline(always)]
const fn partitioned(depth: u32, stretched: bool, bits: u32) -> u32 {
    if stretched { (2 << bits) - 1 - depth } else { depth }
}

/// Returns the depth that [`partitioned`] was given, and whether it was a stretched quad's.
#[inline(always)]
const fn unpartitioned(key: u32, bits: u32) -> (u32, bool) {
    if key >> bits == 0 { (key, false) } else { ((2 << bits) - 1 - key, true) }
}

/// A corner of a quad: the cell that it was, and the place where it is after the step.
#[derive(Clone, Copy)]
struct Corner {
    cell: u32,
    x: i32,
    y: i32,
}

/// Two maps, one before the other.
struct Step<'s, 'p, 'q, F> {
    before: &'s Galpixmap<'p, F>,
    map: &'s mut Galpixmap<'q, F>,
    thresholds: [i32; 3],
    /// Ones in all fields from which a step in the plane follows.
    motion: Words,
}

/// Gives the holes of `map` that stretched quads of the map `before` cover the depth of the background there, unless
/// the depth that the fill mode gave them is farther; returns how often it made one deeper.
///
/// `edges` is the edge map of the map before, `rounding` and `frame` are those of the step from one to the other.
pub(crate) fn lay_background<F: Format>(
    before: &Galpixmap<'_, F>,
    map: &mut Galpixmap<'_, F>,
    edges: &[u32],
    rounding: Rounding,
    frame: u32,
) -> u32 {
    let layout = before.record().layout();
    if !layout.velocity || layout.depth_bits == 0 || before.grid() != map.grid() {
        return 0;
    }
    let thresholds = thresholds(before.record(), rounding, frame);
    let (width, starts) = (before.grid().width(), before.grid().starts());
    let mut step = Step { before, map, thresholds, motion: motion(before.record()) };
    let mut changed = 0;
    for (y, (&row, &next)) in (0..).zip(starts.iter().zip(starts.iter().skip(1))) {
        let mut x = 0;
        while x + 1 < width {
            let run = (width - 1 - x).min(QUADS);
            let on_edge = on_edge(edges, row + x) | on_edge(edges, next + x);
            // A bit for each quad: two columns of it.
            let quads = (on_edge | on_edge >> 1) & ((1 << run) - 1);
            if quads != 0 {
                changed += step.draw_run(quads, x, y, [row, next]);
            }
            x += run;
        }
    }
    changed
}

/// Neighbouring quads whose columns fit into a word of the edge map.
const QUADS: u32 = u32::BITS - 1;

/// Returns which of the 32 cells from `cell` on are on the edge of a surface, the first one in the lowest bit. What is
/// not in the map is.
#[inline(always)]
fn on_edge(edges: &[u32], cell: u32) -> u32 {
    let word = |word: usize| edges.get(word).copied().unwrap_or(u32::MAX);
    let (at, shift) = ((cell / u32::BITS) as usize, cell % u32::BITS);
    word(at) >> shift | word(at + 1) << 1 << (u32::BITS - 1 - shift)
}

/// Returns [`Step::motion`].
fn motion(record: &Record) -> Words {
    let mut motion = Words::default();
    let fields = [record.velocity(0), record.velocity(1), record.acceleration(0), record.acceleration(1)];
    for field in fields.into_iter().chain([record.offset_x(), record.offset_y()]) {
        field.set(&mut motion, u32::MAX);
    }
    motion
}

impl<F: Format> Step<'_, '_, '_, F> {
    /// Draws the quads right of column `x + i` for all set bits `i`, between the rows that begin at these two cells.
    #[inline(never)]
    fn draw_run(&mut self, mut quads: u32, x: u32, y: i32, [row, next]: [u32; 2]) -> u32 {
        let mut changed = 0;
        let mut known: Option<(u32, [Option<Corner>; 2])> = None;
        while quads != 0 {
            let left = x + quads.trailing_zeros();
            quads &= quads - 1;
            if self.moves_as_one([row + left, next + left]) {
                continue;
            }
            let column = |x: u32| [self.corner(row + x, x, y), self.corner(next + x, x, y + 1)];
            let lefts = match known {
                Some((x, corners)) if x == left => corners,
                _ => column(left),
            };
            let rights = column(left + 1);
            known = Some((left + 1, rights));
            if let ([Some(a), Some(b)], [Some(c), Some(d)]) = (lefts, rights) {
                changed += self.draw([a, b, c, d]);
            }
        }
        changed
    }

    /// Whether the corners of a quad, two from each of these cells on, make the same step: then it is not torn.
    #[inline(always)]
    fn moves_as_one(&self, cells: [u32; 2]) -> bool {
        let mut differ = 0;
        for (plane, mask) in self.before.planes().iter().zip(self.motion).take(self.before.record().words()) {
            let two = |cell: u32| plane.get(cell as usize..).and_then(<[u32]>::first_chunk::<2>).copied();
            let (Some([a, b]), Some([c, d])) = (two(cells[0]), two(cells[1])) else { return false };
            differ |= ((a ^ b) | (a ^ c) | (a ^ d)) & mask;
        }
        differ == 0
    }

    /// Returns a cell of the map before as a corner; none if it is empty.
    #[inline(always)]
    fn corner(&self, cell: u32, x: u32, y: i32) -> Option<Corner> {
        let words = self.before.words_at(cell)?;
        let record = self.before.record();
        if record.class().unsigned(&words) == Class::Empty as u32 {
            return None;
        }
        let [dx, dy] = cells_moved(record, &self.thresholds, &words);
        Some(Corner { cell, x: x as i32 + dx, y: y + dy })
    }

    /// Draws a quad into the holes under it, if it is stretched.
    #[inline(always)]
    fn draw(&mut self, corners: [Corner; 4]) -> u32 {
        let low = corners.iter().fold((i32::MAX, i32::MAX), |low, corner| (low.0.min(corner.x), low.1.min(corner.y)));
        let high =
            corners.iter().fold((i32::MIN, i32::MIN), |high, corner| (high.0.max(corner.x), high.1.max(corner.y)));
        let (across, down) = (high.0 - low.0, high.1 - low.1);
        // A quad that still touches all cells between its corners covers no hole.
        if across < 2 && down < 2 || across > LARGEST || down > LARGEST {
            return 0;
        }
        let grid = *self.map.grid();
        let (left, right) = (low.0.max(0), high.0.min(grid.width() as i32 - 1));
        let (mut changed, mut key) = (0, None);
        for y in low.1..=high.1 {
            let Some(row) = grid.row(y) else { continue };
            if left > right || !self.map.any_just_unobscured(row + left as u32, (right - left + 1) as u32) {
                continue;
            }
            let key = *key.get_or_insert_with(|| self.key(&corners));
            for x in left..=right {
                changed += self.deepen(row + x as u32, (x, y), key, &corners);
            }
        }
        changed
    }

    /// Returns what is seen of a stretched quad: the farthest depth of its corners after the step.
    #[inline(never)]
    fn key(&self, corners: &[Corner; 4]) -> u32 {
        let record = self.before.record();
        let farthest = corners.iter().fold(0, |farthest, corner| {
            let mut words = self.before.words_at(corner.cell).unwrap_or_default();
            advance::<true>(record, &self.thresholds, &mut words);
            record.depth().unsigned(&words).max(farthest)
        });
        partitioned(farthest, true, record.depth().bits.into())
    }

    /// Gives a hole the depth of a quad that covers it, if that is what is seen; returns 1 if so.
    #[inline(always)]
    fn deepen(&mut self, cell: u32, (x, y): (i32, i32), key: u32, corners: &[Corner; 4]) -> u32 {
        let record = *self.map.record();
        let bits = u32::from(record.depth().bits);
        let own = self.map.key_at(cell).unwrap_or_default();
        // Of a known surface nothing farther is seen: its key is in the nearer half.
        let hole = own >> bits == Class::JustUnobscured as u32;
        let seen = key < partitioned(own & ((1 << bits) - 1), hole, bits);
        if !hole || !seen || !covers(corners, x, y) {
            return 0;
        }
        let Some(mut words) = self.map.words_at(cell) else { return 0 };
        record.depth().set(&mut words, unpartitioned(key, bits).0);
        self.map.put(cell, &words);
        1
    }
}

/// Whether a place lies in the convex hull of four corners, its border included: in one of the four triangles that they
/// form.
fn covers(corners: &[Corner; 4], x: i32, y: i32) -> bool {
    let side = |a: Corner, b: Corner| {
        let cross = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
        cross.signum()
    };
    let within = |a: Corner, b: Corner, c: Corner| {
        let sides = [side(a, b), side(b, c), side(c, a)];
        let between = |from: i32, to: i32, at: i32| at >= from && at <= to;
        // Corners on one line: all places on the line are on no side of it, those within the triangle's box are between
        // them.
        let box_x = between(a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x), x);
        let box_y = between(a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y), y);
        box_x && box_y && (sides.iter().all(|&side| side >= 0) || sides.iter().all(|&side| side <= 0))
    };
    let [a, b, c, d] = *corners;
    within(a, b, c) || within(b, d, c) || within(a, b, d) || within(a, d, c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_partitioned_range_shows_known_before_stretched_and_farther_stretched_before_nearer() {
        const BITS: u32 = 4;
        for (a, a_torn) in (0..16).flat_map(|depth| [(depth, false), (depth, true)]) {
            let key = partitioned(a, a_torn, BITS);
            assert!(key < 2 << BITS);
            assert_eq!(unpartitioned(key, BITS), (a, a_torn));
            for (b, b_torn) in (0..16).flat_map(|depth| [(depth, false), (depth, true)]) {
                let seen = key < partitioned(b, b_torn, BITS);
                let expected = match (a_torn, b_torn) {
                    (false, false) => a < b,
                    (false, true) => true,
                    (true, false) => false,
                    (true, true) => a > b,
                };
                assert_eq!(seen, expected, "{a} {a_torn} before {b} {b_torn}");
            }
        }
    }

    #[test]
    fn a_hull_covers_its_corners_and_what_lies_between_them() {
        let at = |x, y| Corner { cell: 0, x, y };
        let quad = [at(0, 0), at(0, 1), at(5, 0), at(5, 1)];
        for x in -1..=6 {
            for y in -1..=2 {
                assert_eq!(covers(&quad, x, y), (0..=5).contains(&x) && (0..=1).contains(&y), "{x} {y}");
            }
        }
        // On one line.
        let line = [at(0, 0), at(1, 1), at(4, 4), at(2, 2)];
        assert!((0..=4).all(|i| covers(&line, i, i)));
        assert!(!covers(&line, 5, 5) && !covers(&line, 1, 2));
        // A corner within the triangle of the others.
        let dart = [at(0, 0), at(1, 1), at(4, 0), at(0, 4)];
        assert!(covers(&dart, 2, 2) && covers(&dart, 1, 0) && !covers(&dart, 3, 3));
    }
}
