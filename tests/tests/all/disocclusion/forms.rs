//! The forms of the map against each other, bit by bit, and all of them against one that looks at each pair frame by
//! frame.

use galpix_core::disocclusion::{Border, Extents, Reach, Tally, cover, map, mark, spread};
use galpix_core::{Dynamic, Format, Galpixmap, Grid, Layout, Margin, Record, stages};
use galpix_tests::layouts::{FLAT565_WITHOUT_DEPTH, TINY_DEEP};
use galpix_tests::memory::{Shape, with_maps};
use galpix_tests::profiles::{ODD, PAPER, SLIDE, UNEVEN, dynamic};
use galpix_tests::{packed, random};
use rand::RngExt;

use super::doubling::{EXTENTS, spread_by_doubling};

const STALE: u32 = 0x3c5a_7e11;

/// Returns both spreadings of the same marks.
fn spread_both(width: u32, height: u32, marks: &[u32]) -> Vec<u32> {
    let mut starts = vec![0; height as usize];
    let grid = Grid::new(width, height, Margin::NONE, &mut starts).unwrap();
    let (mut raster, mut doubling) = (marks.to_vec(), marks.to_vec());
    let mut spare = vec![STALE; 2 * marks.len()];
    let covered = spread(&mut raster, &grid);
    assert_eq!(spread_by_doubling(&mut doubling, &mut spare, &grid), covered);
    assert_eq!(raster, doubling, "{width}x{height} of {marks:x?}");
    assert_eq!(covered, raster.iter().map(|&word| u32::from(word != 0)).sum::<u32>());
    raster
}

#[test]
fn raster_and_doubling_agree_on_all_short_rows_and_columns() {
    let words: Vec<u32> = (0..12)
        .map(|n| Extents { left: n % 2 * 2, right: n / 2 % 3, above: n / 6 + 1, below: 2 - n / 6 }.word())
        .chain([0, Extents { left: 4, right: 3, above: 1, below: 9 }.word()])
        .collect();
    let turned = |word: u32| word.rotate_left(16);
    let count = words.len();
    for number in 0..count.pow(4) {
        let row = [0, 1, 2, 3].map(|cell| words[number / count.pow(cell) % count]);
        let spread_row = spread_both(4, 1, &row);
        let spread_column = spread_both(1, 4, &row.map(turned));
        // The other two extents are carried along in any direction.
        assert_eq!(spread_row, spread_column.into_iter().map(turned).collect::<Vec<_>>());
    }
}

/// One cell in a long row, whose extents end within some run of cells that are passed at once, at its end, or never.
#[test]
fn raster_and_doubling_agree_on_long_extents() {
    for extent in [15, 16, 17, 18, 31, 32, 33, 34, 126, 127] {
        for x in (0..150).step_by(7) {
            let mut marks = vec![0; 150];
            marks[x] = Extents { left: extent, right: extent, above: 3, below: 1 }.word();
            let row = spread_both(150, 1, &marks);
            let reached = |other: usize| extent == 127 || x.abs_diff(other) < usize::from(extent);
            assert!((0..150).all(|other| (row[other] != 0) == reached(other)), "{extent} at {x}: {row:x?}");
        }
    }
}

#[test]
fn raster_and_doubling_agree_on_random_marks() {
    let mut generator = random::generator(44);
    for _ in 0..600 {
        let (width, height) = (generator.random_range(1..70), generator.random_range(1..40));
        let (dense, long) = (generator.random_range(1..60), [2, 5, 20, 128][generator.random_range(0..4)]);
        let marks: Vec<u32> = (0..width * height)
            .map(|_| {
                let mut extent = || generator.random_range(0..long) as u8;
                let extents = Extents { left: extent(), right: extent(), above: extent(), below: extent() };
                let word = if generator.random_range(0..60) < dense { extents.word() } else { 0 };
                // Blocked in some directions.
                if generator.random_range(0..8) == 0 {
                    word | (generator.random_range(0..16) * 0x0810_2040) & !EXTENTS
                } else {
                    word
                }
            })
            .collect();
        spread_both(width, height, &marks);
    }
}

/// Motion of one component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
struct Motion {
    offset: i64,
    v: i64,
    a: i64,
}

/// What is in a cell, and nothing for empty ones and beyond the border.
type Body = Option<(i64, [Motion; 2])>;

struct Reference<'r> {
    record: &'r Record,
    reach: Reach,
}

impl Reference<'_> {
    /// Returns the largest sum of the differences of steps, and of these and what rounding adds.
    fn ahead(&self, component: usize, one: Motion, other: Motion) -> [i128; 2] {
        let scale = &self.record.scales[component];
        let top = (1i64 << scale.velocity_bits.max(1)) / 2 - 1;
        let dropped = 1i128 << scale.down;
        let slack = if self.record.acceleration(component).present() { dropped - 1 } else { (dropped - 2).max(0) };
        let (mut one, mut other) = (one, other);
        let (mut sums, mut most) = ([0; 2], [i128::MIN; 2]);
        for _ in 0..self.reach.frames.min(255) {
            let difference = i128::from(2 * one.v + one.a - 2 * other.v - other.a);
            sums = [sums[0] + difference, sums[1] + difference + slack];
            most = [most[0].max(sums[0]), most[1].max(sums[1])];
            for of in [&mut one, &mut other] {
                of.v = (of.v + of.a).clamp(-top - 1, top);
            }
        }
        most
    }

    fn cells(&self, component: usize, one: Motion, other: Motion) -> i128 {
        if self.reach.frames == 0 || one == other {
            return 0;
        }
        let scale = &self.record.scales[component];
        let [_, most] = self.ahead(component, one, other);
        let ahead = i128::from(one.offset - other.offset) + ((most >> scale.down) << scale.up);
        // Rounded up.
        (-(-ahead >> scale.position_frac)).max(0)
    }

    /// Returns what two neighbours uncover: by the first and by the second. And in which direction, backwards or
    /// onwards, one of them is blocked.
    fn pair(&self, along: usize, first: Body, second: Body) -> (Option<[[i128; 4]; 2]>, [bool; 2]) {
        let across = 1 - along;
        let motion = |body: Body| body.map_or([Motion::default(); 2], |(_, motion)| motion);
        let (one, other) = (motion(first), motion(second));
        let gap = self.cells(along, other[along], one[along]);
        let key = |body: Body| body.map_or(i64::from(i32::MAX), |(key, _)| key);
        let farther = key(second) - key(first);
        let one_surface = farther.abs() < i64::from(self.reach.separation.min(1 << 30));
        let parts = |component: usize, one: Motion, other: Motion| {
            let [exactly, _] = self.ahead(component, one, other);
            self.reach.frames > 0 && exactly >= 2i128 << self.record.scales[component].velocity_frac
        };
        let apart = [0, 1].into_iter().any(|component| {
            let [one, other] = [one[component], other[component]];
            self.cells(component, one, other) >= 2 || self.cells(component, other, one) >= 2
        });
        let closes = !self.reach.through && !one_surface && apart;
        let blocked = [closes && farther < 0, closes && farther > 0];
        if gap == 0 || one_surface && !parts(along, other[along], one[along]) {
            return (None, blocked);
        }
        let onwards = self.cells(across, other[across], one[across]) + 1;
        let backwards = self.cells(across, one[across], other[across]) + 1;
        // Backwards and onwards along, backwards and onwards across.
        let leaves = [farther >= 0 || one_surface, farther <= 0 || one_surface];
        let extents = [[gap, 1, onwards, backwards], [1, gap, backwards, onwards]];
        let extents = [0, 1].map(|of| {
            let [a, b, c, d] = if leaves[of] { extents[of] } else { [0; 4] };
            if along == 0 { [a, b, c, d] } else { [c, d, a, b] }
        });
        (Some(extents), blocked)
    }
}

/// Returns the marks, pair by pair and frame by frame.
fn reference(front: &Galpixmap<'_, Dynamic>, reach: &Reach) -> (Vec<u32>, Tally) {
    let (grid, record) = (*front.grid(), front.record());
    let of = Reference { record, reach: *reach };
    let (width, height) = (grid.width() as i32, grid.height() as i32);
    let body = |x: i32, y: i32| -> Body {
        let cell = grid.cell(x, y)?;
        let words: Vec<u32> = (0..record.words()).map(|word| front.plane(word).unwrap()[cell as usize]).collect();
        let class = packed::unsigned(record.class(), &words);
        let motion = |component: usize| Motion {
            offset: packed::signed([record.offset_x(), record.offset_y()][component], &words),
            v: packed::signed(record.velocity(component), &words),
            a: packed::signed(record.acceleration(component), &words) << record.scales[component].acceleration_up,
        };
        let key = class << record.depth().bits | packed::unsigned(record.depth(), &words);
        (class != 3).then(|| (key, [motion(0), motion(1)]))
    };
    let mut extents = vec![[0u8; 4]; grid.cells() as usize];
    let mut tally = Tally::default();
    for y in -1..height {
        for x in -1..width {
            if let Some(cell) = grid.cell(x, y)
                && body(x, y).is_none()
            {
                extents[cell as usize] = extents[cell as usize].map(|extent| extent & 0x80 | (extent & 0x7f).max(1));
            }
            for (along, (dx, dy)) in [(1, 0), (0, 1)].into_iter().enumerate() {
                let cells = [grid.cell(x, y), grid.cell(x + dx, y + dy)];
                if cells == [None, None] || cells.contains(&None) && reach.border == Border::Continues {
                    continue;
                }
                let (by, blocked) = of.pair(along, body(x, y), body(x + dx, y + dy));
                for (blocked, (cell, direction)) in
                    blocked.into_iter().zip(cells.into_iter().zip([2 * along, 2 * along + 1]))
                {
                    if blocked && let Some(cell) = cell {
                        extents[cell as usize][direction] |= 0x80;
                    }
                }
                let Some(by) = by else { continue };
                tally.edges += 1;
                tally.saturated += u32::from(by.as_flattened().iter().any(|&extent| extent >= 127));
                for (cell, by) in cells.into_iter().zip(by) {
                    let Some(cell) = cell else { continue };
                    for (to, extent) in extents[cell as usize].iter_mut().zip(by) {
                        *to = *to & 0x80 | (*to & 0x7f).max(extent.min(127) as u8);
                    }
                }
            }
        }
    }
    (extents.into_iter().map(u32::from_le_bytes).collect(), tally)
}

/// Returns words of which a part is random, and whose motion is mostly slow.
fn content(record: &Record, shape: Shape, seed: u64) -> Vec<u32> {
    let cells = shape.cells() as usize;
    let noise = random::words(seed, cells * record.words());
    let mut content = noise.clone();
    let mut generator = random::generator(!seed);
    let kind = seed % 5;
    for cell in 0..cells {
        let mut words: Vec<u32> = (0..record.words()).map(|word| noise[word * cells + cell]).collect();
        if kind > 0 {
            let class = if generator.random_range(0..12) == 0 { generator.random_range(0..4) } else { 0 };
            let near = generator.random_range(0..5) == 0;
            let mut depth = (1i64 << record.depth().bits) * if near { 1 } else { 5 } / 8 + generator.random_range(0..3);
            // First and last depths of all classes: as numbers, some of empty cells are next to some of others.
            let class = if kind == 4 { generator.random_range(0..4) } else { class };
            if kind == 4 {
                depth = generator.random_range(-2..2);
            }
            packed::set(record.class(), &mut words, class);
            packed::set(record.depth(), &mut words, depth);
            for component in 0..2 {
                let slow = |generator: &mut rand::rngs::SmallRng, bits: u8| {
                    let shift = if kind == 1 { 1 } else { 4 + i64::from(near) };
                    let most = (1i64 << bits) >> shift;
                    if most == 0 { 0 } else { generator.random_range(-most..=most) >> generator.random_range(0..4) }
                };
                let (velocity, acceleration) = (record.velocity(component), record.acceleration(component));
                let base = if near { (1i64 << velocity.bits) >> 4 } else { 0 };
                packed::set(velocity, &mut words, base + slow(&mut generator, velocity.bits));
                packed::set(acceleration, &mut words, slow(&mut generator, acceleration.bits) >> 4);
                if kind == 3 {
                    packed::set([record.offset_x(), record.offset_y()][component], &mut words, 0);
                }
            }
        }
        for (word, value) in words.into_iter().enumerate() {
            content[word * cells + cell] = value;
        }
    }
    content
}

fn check(format: Dynamic, seed: u64) {
    let mut generator = random::generator(seed);
    for number in 0..30 {
        let shape = Shape {
            width: generator.random_range(1..150),
            height: generator.random_range(1..12),
            margin: Margin::all(generator.random_range(0..2)),
        };
        let cells = shape.cells() as usize;
        let separation = [0, 1, 2, 3, 1 << format.record().depth().bits >> 6, u32::MAX][generator.random_range(0..6)];
        let frames = [0, 1, 2, 3, 16, 60, 255, 300][generator.random_range(0..8)];
        let border = if generator.random() { Border::Still } else { Border::Continues };
        let reach = Reach { frames, separation, border, tears: true, through: generator.random() };
        let content = content(format.record(), shape, number);
        with_maps(shape, format, Some(&content), |front, _| {
            let grid = *front.grid();
            let (mut marks, mut extents) = (vec![STALE; cells], vec![STALE; cells]);
            let (mut line, mut mask) = (vec![STALE; shape.columns() as usize], vec![STALE; stages::words(&grid)]);
            let tally = mark(&front, &mut marks, &reach);
            let (expected, counts) = reference(&front, &reach);
            assert_eq!(marks, expected, "{shape:?} {reach:?} {number}");
            assert_eq!(tally, counts);
            let covered = spread(&mut marks, &grid);
            let tally = Tally { covered, ..tally };
            assert_eq!(map(&front, &mut extents, &reach), tally);
            assert_eq!(extents, marks);
            assert_eq!(cover(&front, &mut line, &mut mask, &reach), tally);
            for (cell, &word) in extents.iter().enumerate() {
                assert_eq!(mask[cell / 32] >> (cell % 32) & 1 != 0, word != 0);
                // What is covered is covered with all four extents.
                assert!(word == 0 || word.to_le_bytes().iter().all(|&extent| extent > 0));
            }
            assert!(mask.iter().map(|word| word.count_ones()).sum::<u32>() == covered);
        });
    }
}

#[test]
fn marks_are_those_of_each_pair() {
    for (seed, (layout, bits)) in (1..).zip([
        (Layout::FULL, PAPER),
        (Layout::FULL, ODD),
        (Layout::TAGGED, UNEVEN),
        (Layout::FLAT565, PAPER),
        (FLAT565_WITHOUT_DEPTH, UNEVEN),
        (Layout::VELOCITY565, SLIDE),
        (Layout::VELOCITY_GRAY4, SLIDE),
        (Layout::STILL, PAPER),
        (TINY_DEEP, UNEVEN),
    ]) {
        check(dynamic(layout, bits), seed);
        check(dynamic(layout, bits), !seed);
    }
}

/// Memory that is too short: cells without memory get no mark, and nothing else is touched.
#[test]
fn what_is_not_lent_is_left_out() {
    let format = dynamic(Layout::VELOCITY565, SLIDE);
    let shape = Shape::plain(40, 9);
    let content = content(format.record(), shape, 2);
    let reach = Reach::new(16, 16);
    with_maps(shape, format, Some(&content), |front, _| {
        let (mut whole, mut part) = (vec![0; 360], vec![STALE; 360]);
        map(&front, &mut whole, &reach);
        mark(&front, &mut whole, &reach);
        mark(&front, &mut part[..40 * 5 + 7], &reach);
        assert_eq!(part[..200], whole[..200]);
        assert!(part[200..].iter().all(|&word| word == STALE));
        assert_eq!(cover(&front, &mut [0; 39], &mut [0; 12], &reach), Tally::default());
    });
}
