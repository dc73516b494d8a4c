//! The sources of a disocclusion map: cells next to which something opens, and how far. Algorithm 1 of the supplement.
//!
//! Most neighbours lie on one surface and move nearly alike. A few comparisons over a run of cells find these pairs at
//! once; the others are flagged and resolved pair by pair.

use core::ops::Range;

use super::extents::{EXTENTS, ONLY_ITSELF, larger};
use super::pair::{Body, Rule, Uncovered};
use super::{Border, Reach, Tally};
use crate::fast::VECTORS;
use crate::format::Format;
use crate::format::record::{Extract, Field, Record};
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// A direction for rows that are not part of a pass: their words hold nothing of a row before.
pub(crate) const NO_PASS: u32 = u32::MAX;

/// Pairs that are compared at once. A power of two.
const RUN: usize = if VECTORS { 64 } else { 8 };

/// The most flagged pairs that are collected before they are resolved.
const PENDING: usize = if VECTORS { 16 } else { 1 };

/// The words of a run of cells that decide whether neighbours are flagged: of each field the word of its upper part and
/// the word of its lower one.
struct RunWords<'l> {
    class: &'l [u32; RUN],
    depth: [&'l [u32; RUN]; 2],
    v: [&'l [u32; RUN]; 2],
    a: [&'l [u32; RUN]; 2],
}

impl<'l> RunWords<'l> {
    /// Returns the words of the cells from `cell` on, `None` if the map ends before the run does.
    #[inline(always)]
    fn at<F: Format, const ALONG: usize>(front: &'l Galpixmap<'_, F>, cell: u32) -> Option<Self> {
        let record = front.record();
        let word = |word: usize| front.planes()[word].get(cell as usize..)?.first_chunk();
        let field = |field: Field| {
            let (upper, lower) = field.words();
            Some([word(upper)?, word(lower)?])
        };
        let [class, _] = field(record.class())?;
        Some(Self {
            class,
            depth: field(record.depth())?,
            v: field(record.velocity(ALONG))?,
            a: field(record.acceleration(ALONG))?,
        })
    }

    /// Returns class and depth of a cell as one number, as [`Galpixmap::keys`], above [`key_shift`] unspecified bits.
    #[inline(always)]
    fn key<F: Format>(&self, record: &Record, lane: usize) -> u32 {
        let ([depth, spill], lane) = (self.depth, lane & (RUN - 1));
        if key_shift::<F>(record).is_some() {
            return depth[lane];
        }
        let class = record.class().extract().unsigned(self.class[lane], self.class[lane]);
        class << record.depth().bits | record.depth().extract().unsigned(depth[lane], spill[lane])
    }
}

/// Returns the lowest bit of the key in its word, if the key is at the top of one.
#[inline(always)]
fn key_shift<F: Format>(record: &Record) -> Option<u32> {
    if F::FIXED { record.key_field().and_then(Field::at_top) } else { None }
}

/// Returns a limit and a mask: two keys are certainly less than `separation` apart if their difference plus the limit
/// has none of the bits of the mask. `None` if all pairs are flagged. `shift` is that of [`key_shift`].
fn key_limit(separation: i32, shift: u32) -> Option<(u32, u32)> {
    // The limit is a power of two that is less than the separation: the bits below the key can add 1 to the difference
    // of two keys, or subtract it. Differences of up to 1/4 of all numbers pass; keys of cells that are not empty
    // differ by less than 3/4, so that no difference wraps into the range that passes.
    match separation {
        0 => None,
        1 => Some((0, u32::MAX)),
        _ => {
            let below = (1..31).filter(|power| (separation - 1) >> power != 0).count() as u32;
            let power = (below + shift).min(30);
            Some((1 << power, 0u32.wrapping_sub(2 << power)))
        }
    }
}

/// The result of comparing a run of pairs.
#[derive(Clone, Copy)]
struct Compared {
    /// Whether any pair is flagged.
    flagged: bool,
    /// Whether any second cell is empty; known only of pairs in a column.
    empties_below: bool,
}

/// Returns a signed field of a cell of a run.
#[inline(always)]
fn signed(field: Extract, [upper, lower]: [&[u32; RUN]; 2], lane: usize) -> i32 {
    let lane = lane & (RUN - 1);
    field.signed(upper[lane], lower[lane])
}

/// The columns of flagged pairs. Most of the words that a pair is resolved from are not in the cache: they are loaded
/// for all pairs at once, so that the wait for the memory occurs once and not for each pair.
struct Pending {
    columns: [u32; PENDING],
    count: usize,
}

impl Pending {
    const NONE: Self = Self { columns: [0; PENDING], count: 0 };

    /// Adds the pair whose first cell is in column `x`; returns whether no further pair fits in.
    #[inline(always)]
    fn push(&mut self, x: u32) -> bool {
        if let Some(column) = self.columns.get_mut(self.count) {
            *column = x;
            self.count += 1;
        }
        self.count >= PENDING
    }

    /// Loads into the cache what [`Body::read`] reads of the first cells, which are in the row from cell `one` on, and
    /// of the second ones, in the row from cell `other` on.
    #[inline(always)]
    fn prefetch<F: Format>(&self, front: &Galpixmap<'_, F>, one: u32, other: u32) {
        if !VECTORS {
            return;
        }
        let record = front.record();
        let field = |component| {
            [record.offset(component), record.velocity(component), record.acceleration(component)].map(Field::word_set)
        };
        let set = [field(0), field(1)].as_flattened().iter().fold(0, |set, field| set | field);
        let mut words = 0;
        for (plane, word) in front.planes().iter().zip(0..) {
            for &x in self.columns.iter().take(if set >> word & 1 != 0 { self.count } else { 0 }) {
                for cell in [one + x, other + x] {
                    words |= plane.get(cell as usize).copied().unwrap_or(0);
                }
            }
        }
        core::hint::black_box(words);
    }
}

/// Marks the rows of a map.
pub(crate) struct Marker<'m, 'p, F> {
    front: &'m Galpixmap<'p, F>,
    rule: Rule,
    border: Border,
    key_limit: Option<(u32, u32)>,
    /// Whether the current row may have empty cells.
    empties: bool,
    /// For velocity and acceleration along each component a limit of their difference, and the bits that are 0 in the
    /// sum of difference and limit if the difference is within it.
    limits: [[(i32, u32); 2]; 2],
    /// The bits of a word that marking writes.
    marked: u32,
    pub tally: Tally,
}

impl<'m, 'p, F: Format> Marker<'m, 'p, F> {
    pub fn new(front: &'m Galpixmap<'p, F>, reach: &Reach) -> Self {
        let rule = Rule::new(front.record(), reach);
        let beyond = |limit| if limit == 0 { u32::MAX } else { 0u32.wrapping_sub((limit as u32) << 1) };
        let limits = rule.bounds.map(|bound| bound.together().map(|limit| (limit, beyond(limit))));
        let key_limit = key_limit(rule.separation, key_shift::<F>(front.record()).unwrap_or(0));
        let (border, tally) = (reach.border, Tally::default());
        Self { front, rule, border, key_limit, empties: true, limits, marked: u32::MAX, tally }
    }

    /// Returns the number of columns.
    pub fn width(&self) -> u32 {
        self.front.grid().width()
    }

    /// Begins row `y`: only its empty cells are uncovered. In a pass in `DIRECTION` the byte of the opposite direction
    /// stays as the row before has left it; with [`NO_PASS`] nothing stays. Returns the first cell of the row, `None`
    /// if there is no such row.
    pub fn begin<const DIRECTION: u32>(&mut self, y: u32, row: &mut [u32]) -> Option<u32> {
        let start = self.front.grid().row(y as i32)?;
        self.clear::<DIRECTION>(row);
        self.empties = self.front.any_empty(start, self.front.grid().width());
        if self.empties {
            self.mark_empty(start, row);
        }
        Some(start)
    }

    /// Begins a row that is the next one to [`Self::rows`], which marks its empty cells.
    pub fn clear<const DIRECTION: u32>(&mut self, row: &mut [u32]) {
        let kept = if DIRECTION == NO_PASS { 0 } else { 0xff << (DIRECTION ^ 8) };
        self.marked = !kept;
        for word in row {
            *word &= kept;
        }
    }

    /// Marks the empty cells of a row that begins at cell `start` as uncovered: nothing hides what is in them.
    fn mark_empty(&self, start: u32, row: &mut [u32]) {
        let cells = start as usize..(start + self.front.grid().width()) as usize;
        for (x, key) in (0..).zip(self.front.keys(cells)) {
            if self.front.class_of(key) == Class::Empty as u32 {
                self.raise(row, x, ONLY_ITSELF);
            }
        }
    }

    /// Marks row `y`, which is `here`, and row `y + 1`, which is `next`, by the pairs of one cell in each. If `IN_ROW`,
    /// marks row `y` also by the pairs within it and by the border. Both rows must have begun; an empty slice
    /// stands for a row that is left out.
    pub fn rows<const IN_ROW: bool>(&mut self, y: u32, here: &mut [u32], next: &mut [u32]) {
        let grid = *self.front.grid();
        let Some(row) = grid.row(y as i32) else { return };
        let below = grid.row(y as i32 + 1);
        let empties = !IN_ROW || self.empties;
        let (mut flags, mut empties_below) = ([0; RUN], false);
        let (mut pairs_in_row, mut pairs_between) = (Pending::NONE, Pending::NONE);
        let mut x = 0;
        while x < grid.width() {
            let cells = (grid.width() - x).min(RUN as u32);
            if let Some(below) = below {
                let compared = self.compare::<1>(row + x, below + x, empties, &mut flags);
                empties_below |= compared.empties_below;
                if compared.flagged {
                    for x in flagged(&flags, x..x + cells) {
                        if pairs_between.push(x) {
                            self.resolve_pairs_between(&mut pairs_between, [row, below], here, next);
                        }
                    }
                }
            }
            if IN_ROW && self.compare::<0>(row + x, row + x + 1, empties, &mut flags).flagged {
                for x in flagged(&flags, x..(x + cells).min(grid.width() - 1)) {
                    if pairs_in_row.push(x) {
                        self.resolve_pairs_in_row(&mut pairs_in_row, row, here);
                    }
                }
            }
            x += cells;
        }
        self.resolve_pairs_in_row(&mut pairs_in_row, row, here);
        if let Some(below) = below {
            self.resolve_pairs_between(&mut pairs_between, [row, below], here, next);
            self.empties = empties_below;
            if empties_below {
                self.mark_empty(below, next);
            }
        }
        if IN_ROW && self.border == Border::Still {
            self.mark_border(y, row, here);
        }
    }

    /// Flags the lanes whose pairs must be resolved: those of two surfaces, and those that may part. The pairs are
    /// those of the run from cell `one` on and the run from cell `other` on. First cells can be empty only if
    /// `empties`. All lanes are flagged where the map ends before the run does.
    #[inline(always)]
    fn compare<const ALONG: usize>(&self, one: u32, other: u32, empties: bool, flags: &mut [u32; RUN]) -> Compared {
        let one = RunWords::at::<F, ALONG>(self.front, one);
        let (Some(one), Some(other), Some((limit, beyond))) =
            (one, RunWords::at::<F, ALONG>(self.front, other), self.key_limit)
        else {
            *flags = [1; RUN];
            return Compared { flagged: true, empties_below: true };
        };
        let record = self.front.record();
        let [(v_limit, v_beyond), (a_limit, a_beyond)] = self.limits[ALONG];
        let (v, a) = (record.velocity(ALONG).extract(), record.acceleration(ALONG).extract());
        let (mut any, mut twos) = (0, 0);
        for (lane, flag) in flags.iter_mut().enumerate() {
            let (key, other_key) = (one.key::<F>(record, lane), other.key::<F>(record, lane));
            let mut outside = other_key.wrapping_sub(key).wrapping_add(limit) & beyond;
            if record.layout().velocity {
                let (one, other) = (signed(v, one.v, lane), signed(v, other.v, lane));
                outside |= other.wrapping_sub(one).wrapping_add(v_limit) as u32 & v_beyond;
            }
            if record.layout().acceleration {
                let (one, other) = (signed(a, one.a, lane), signed(a, other.a, lane));
                outside |= other.wrapping_sub(one).wrapping_add(a_limit) as u32 & a_beyond;
            }
            *flag = outside;
            any |= outside;
            if ALONG == 1 {
                // As in `Galpixmap::any_empty`.
                let class = other.class[lane & (RUN - 1)];
                twos |= class & class << 1;
            }
        }
        let empties_below = twos >> record.class().shift >> 1 & 1 != 0;
        if empties || empties_below {
            // The difference of keys decides nothing where one is that of an empty cell: other classes flag the pair.
            let class = record.class().extract();
            for ((flag, &one), &other) in flags.iter_mut().zip(one.class).zip(other.class) {
                *flag |= class.unsigned(one ^ other, one ^ other);
                any |= *flag;
            }
        }
        Compared { flagged: any != 0, empties_below }
    }

    /// Resolves flagged pairs of neighbours in a row.
    #[inline(never)]
    fn resolve_pairs_in_row(&mut self, pairs: &mut Pending, row: u32, here: &mut [u32]) {
        pairs.prefetch(self.front, row, row + 1);
        for &x in pairs.columns.iter().take(pairs.count) {
            let (one, other) = (Body::read(self.front, row + x), Body::read(self.front, row + x + 1));
            let uncovered = self.uncovered::<0>(&one, &other);
            self.raise(here, x, uncovered.first);
            self.raise(here, x + 1, uncovered.second);
        }
        pairs.count = 0;
    }

    /// Resolves flagged pairs of neighbours in a column.
    #[inline(never)]
    fn resolve_pairs_between(
        &mut self,
        pairs: &mut Pending,
        [row, below]: [u32; 2],
        here: &mut [u32],
        next: &mut [u32],
    ) {
        pairs.prefetch(self.front, row, below);
        for &x in pairs.columns.iter().take(pairs.count) {
            let (one, other) = (Body::read(self.front, row + x), Body::read(self.front, below + x));
            let uncovered = self.uncovered::<1>(&one, &other);
            self.raise(here, x, uncovered.first);
            self.raise(next, x, uncovered.second);
        }
        pairs.count = 0;
    }

    /// Marks the cells of a row that are at the border, which is still and infinitely far away.
    fn mark_border(&mut self, y: u32, row: u32, here: &mut [u32]) {
        let grid = *self.front.grid();
        self.mark_at_border::<0>(row, 0, true, here);
        self.mark_at_border::<0>(row, grid.width() - 1, false, here);
        for (at_end, before) in [(y == 0, true), (y + 1 == grid.height(), false)] {
            for x in 0..if at_end { grid.width() } else { 0 } {
                self.mark_at_border::<1>(row, x, before, here);
            }
        }
    }

    /// Marks a cell by its pair with what lies beyond the border: before it (to the left or above) or after it.
    fn mark_at_border<const ALONG: usize>(&mut self, row: u32, x: u32, before: bool, here: &mut [u32]) {
        let body = Body::read(self.front, row + x);
        let [one, other] = if before { [Body::NOTHING, body] } else { [body, Body::NOTHING] };
        let uncovered = self.uncovered::<ALONG>(&one, &other);
        self.raise(here, x, if before { uncovered.second } else { uncovered.first });
    }

    /// Returns what two neighbours uncover, and counts it.
    fn uncovered<const ALONG: usize>(&mut self, one: &Body, other: &Body) -> Uncovered {
        if one == other {
            return Uncovered::default();
        }
        let uncovered = self.rule.uncovered::<ALONG>(one, other);
        self.tally.edges += u32::from(uncovered.opens);
        self.tally.saturated += u32::from(uncovered.saturated);
        uncovered
    }

    /// Raises the extents of a cell to those of `to`, and blocks it where `to` is blocked.
    fn raise(&self, row: &mut [u32], x: u32, to: u32) {
        if let Some(word) = row.get_mut(x as usize) {
            let to = to & self.marked;
            *word = larger(*word, to) | to & !EXTENTS;
        }
    }
}

/// Returns those of some columns that are flagged. The run begins with the first of the columns.
#[inline(always)]
fn flagged(flags: &[u32; RUN], columns: Range<u32>) -> impl Iterator<Item = u32> {
    let Range { start, end } = columns;
    let eights = flags.as_chunks::<8>().0.iter().zip((0..).map(move |eight| start + 8 * eight));
    let any = |eight: &[u32; 8]| eight.iter().fold(0, |any, flag| any | flag) != 0;
    eights
        .filter(move |(eight, _)| any(eight))
        .flat_map(move |(eight, first)| eight.iter().zip(first..end).filter(|(flag, _)| **flag != 0).map(|(_, x)| x))
}

#[cfg(test)]
mod tests {
    use super::key_limit;

    #[test]
    fn keys_that_pass_are_less_than_the_separation_apart() {
        for shift in [0, 1, 10, 24] {
            let classes = 1i64 << (30 - shift);
            for separation in [1, 2, 3, 4, 5, 100, 1 << 16, 1 << 30] {
                let (limit, beyond) = key_limit(separation, shift).unwrap();
                let separation = i64::from(separation);
                let mut passed = 0;
                for key in [0, 1, classes - 1, classes, 2 * classes, 3 * classes - 1] {
                    for apart in
                        [0, 1, separation / 2, separation - 1, separation, separation + 1, classes, 3 * classes - 1]
                    {
                        // All keys but those of empty cells.
                        for other in
                            [key - apart, key + apart].into_iter().filter(|other| (0..3 * classes).contains(other))
                        {
                            for (low, other_low) in [(0, 0), (0, u32::MAX), (u32::MAX, 0)] {
                                let word = |key: i64, low: u32| (key as u32) << shift | low & ((1 << shift) - 1);
                                let difference = word(other, other_low).wrapping_sub(word(key, low));
                                let passes = difference.wrapping_add(limit) & beyond == 0;
                                assert!(!passes || apart < separation, "{key} {other} {separation} {shift}");
                                assert!(passes || apart > 0 || low != other_low);
                                passed += u32::from(passes && apart > 0);
                            }
                        }
                    }
                }
                assert!(passed > 0 || separation == 1 || separation > classes, "{separation} {shift}");
            }
        }
        assert_eq!(key_limit(0, 0), None);
    }
}
