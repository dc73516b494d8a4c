//! The features of a level: its two bands in three channels, pulled once, tile by tile.
//!
//! A response counts only if all 25 cells under the kernel are known (section 3.2 of the paper: the mask is dilated by the kernel's
//! radius, at each level by that level's cells) and of one surface: the step from foreground to background, where holes open, is
//! no texture of either. Of one surface are cells whose depths lie within the threshold of each other.
//!
//! Responses themselves are not stored: a hole has none, and everything above sees their means only.

use super::demand::{Base, Demand, Even, pulled_alike};
use super::mean::tie;
use super::metamer::Scene;
use super::needs::Needs;
use super::push_pull::{Rule, pulled};
use super::pyramid::{Known, State};
use super::statistics::{BANDS, Moments};
use super::steerable::{APRON, Bands, TILE, bands};
use super::store::Store;
use super::tile::{Row, Surroundings};
use super::tone::Tone;
use super::validity::FULL;

/// Columns and rows of a pulled tile.
const HALF: usize = TILE / 2;

/// Level 0 of the tones: the picture.
#[derive(Debug)]
pub struct Below<'p, P>(pub &'p P);

impl<P: Scene> Below<'_, P> {
    /// Eight cells of level 1, from `left` on.
    #[inline(always)]
    fn line(&self, left: u32, y: u32, rule: &Rule, cells: &mut [Known<Tone>]) {
        let [width, height] = self.0.size();
        let top = y << 1;
        if top >= height {
            return;
        }
        let (mut upper, mut lower) = (Row::default(), Row::default());
        self.0.row(2 * left, top, &mut upper);
        if top + 1 < height {
            self.0.row(2 * left, top + 1, &mut lower);
        }
        for ((i, x), to) in (left..width.div_ceil(2)).enumerate().zip(cells) {
            let (left, right) = (2 * i, 2 * i + 1);
            let [a, b, c, d] = [upper.depths[left], upper.depths[right], lower.depths[left], lower.depths[right]];
            let depth = a.max(b).max(c.max(d)) as u32;
            let known = upper.known[left] & upper.known[right] & lower.known[left] & lower.known[right];
            let inside = 2 * x + 1 < width && top + 1 < height;
            *to = if inside && known != 0 && depth - a.min(b).min(c.min(d)) as u32 <= rule.threshold {
                let mut tone = Tone { channels: [0; 3], source: self.0.source(2 * x, top) };
                for ((to, upper), lower) in tone.channels.iter_mut().zip(&upper.channels).zip(&lower.channels) {
                    let sum = upper[left] + upper[right] + lower[left] + lower[right];
                    *to = (sum + 1 + tie(x, y, 1) as i16) >> 2;
                }
                Known { validity: FULL, depth, value: tone }
            } else {
                let child =
                    |x: u32, y: u32| if x < width && y < height { self.0.known(x, y) } else { Known::default() };
                let (x0, x1) = (2 * x, 2 * x + 1);
                pulled(&[child(x0, top), child(x1, top), child(x0, top + 1), child(x1, top + 1)], rule, tie(x, y, 1))
            };
        }
    }
}

impl<P: Scene> Base<Tone> for Below<'_, P> {
    const LEVELS: u32 = 4;

    /// Pulls 8 x 8 cells of level 1, up to one of level 4.
    #[inline(never)]
    fn pull(&mut self, pyramid: &mut Store<'_, Tone>, rule: &Rule, x: u32, y: u32) {
        let (left, top) = (x >> 3 << 3, y >> 3 << 3);
        let mut first: Part<Tone, 64> = [Known::default(); 64];
        for (line, y) in first.chunks_exact_mut(8).zip(top..) {
            self.line(left, y, rule, line);
        }
        keep(pyramid, 1, (left, top), 8, &first);
        pull_up(pyramid, rule, (left, top), &first);
    }
}

/// Level 0 of the moments: the responses of a level of the tones.
#[derive(Debug)]
pub struct Responses<'t, 'f, 's, P> {
    /// The tones.
    pub tones: &'t mut Demand<'f, 's, Tone, Below<'t, P>>,
    /// The level.
    pub level: u32,
    /// What of the level above is asked for: of what is not, no moments are kept.
    pub needs: &'t Needs<'t>,
}

impl<P: Scene> Responses<'_, '_, '_, P> {
    /// The cells of a row of the level.
    #[inline(always)]
    fn row(&mut self, left: u32, y: u32, cells: &mut Row) {
        if self.level == 0 {
            return self.tones.base.0.row(left, y, cells);
        }
        let width = self.tones.pyramid.levels().level(self.level).width;
        for x in left..width.min(left + (TILE + 2 * APRON) as u32) {
            self.tones.want_pulled(self.level, x, y);
            cells.set((x - left) as usize, &self.tones.pyramid.known(self.tones.pyramid.index(self.level, x, y)));
        }
    }
}

/// The moments of four cells each of a tile.
struct Quads {
    means: [[[i16; HALF]; HALF]; BANDS],
    squares: [[[u32; HALF]; HALF]; BANDS],
}

impl Quads {
    /// Means of four that weigh the same; `tie` is that of the first one.
    #[inline(always)]
    fn new(of_channels: &[Bands; 3], tie: u32) -> Self {
        let mut quads = Self { means: [[[0; HALF]; HALF]; BANDS], squares: [[[0; HALF]; HALF]; BANDS] };
        let of_bands = of_channels.as_flattened();
        for ((means, squares), band) in quads.means.iter_mut().zip(&mut quads.squares).zip(of_bands) {
            for (y, (means, squares)) in means.iter_mut().zip(squares).enumerate() {
                let (upper, lower) = (&band[2 * y], &band[2 * y + 1]);
                // Down the columns first, where neighbours lie side by side.
                let (mut sums, mut sums_of_squares) = ([0; TILE], [0; TILE]);
                for x in 0..TILE {
                    sums[x] = upper[x] + lower[x];
                    let (a, b) = (i32::from(upper[x]), i32::from(lower[x]));
                    sums_of_squares[x] = a * a + b * b;
                }
                for x in 0..HALF {
                    let up = 1 + ((x as u32 ^ y as u32 ^ tie) & 1);
                    means[x] = (sums[2 * x] + sums[2 * x + 1] + up as i16) >> 2;
                    squares[x] = ((sums_of_squares[2 * x] + sums_of_squares[2 * x + 1]) as u32 + up) >> 2;
                }
            }
        }
        quads
    }

    #[inline(always)]
    fn moments(&self, x: usize, y: usize) -> Moments {
        let mut moments = Moments::default();
        for band in 0..BANDS {
            moments.means[band] = self.means[band][y][x];
            moments.squares[band] = self.squares[band][y][x];
        }
        moments
    }
}

/// Cells of a level of a pulled tile, or of its quarters.
type Part<V, const CELLS: usize> = [Known<V>; CELLS];

impl<P: Scene> Responses<'_, '_, '_, P> {
    /// The cells of level 1 of the tile that begins at `left`, `top` of that level.
    #[inline(always)]
    fn first(&mut self, left: u32, top: u32, rule: &Rule) -> Part<Moments, 64> {
        let size = self.tones.pyramid.levels().level(self.level);
        let surroundings = Surroundings::new(2 * left, 2 * top, [size.width, size.height], |left, y, cells| {
            self.row(left, y, cells);
        });
        let whole = surroundings.whole(rule.threshold);
        let mut of_channels: [Bands; 3] = [[[[0; TILE]; TILE]; 2]; 3];
        for (cells, of_channel) in surroundings.channels.iter().zip(&mut of_channels) {
            bands(cells, of_channel);
        }
        let quads = Quads::new(&of_channels, tie(left, top, 1));
        let mut cells = [Known::default(); 64];
        for (at, cell) in cells.iter_mut().enumerate() {
            let (i, j) = (at % HALF, at / HALF);
            let (x, y, column, row) = (left + i as u32, top + j as u32, 2 * i, 2 * j);
            let depth = |dx: usize, dy: usize| surroundings.depths[row + dy + APRON][column + dx + APRON] as u32;
            let inside = |dx: usize, dy: usize| 2 * x + (dx as u32) < size.width && 2 * y + (dy as u32) < size.height;
            let whole = |dx: usize, dy: usize| {
                whole.as_ref().is_none_or(|whole| whole[row + dy][column + dx]) && inside(dx, dy)
            };
            *cell = if whole(0, 0) & whole(1, 0) & whole(0, 1) & whole(1, 1) {
                // They lie under each other's kernel: they are of one surface.
                let depth = depth(0, 0).max(depth(1, 0)).max(depth(0, 1).max(depth(1, 1)));
                Known { validity: FULL, depth, value: quads.moments(i, j) }
            } else if inside(0, 0) {
                let child = |dx: usize, dy: usize| {
                    if !inside(dx, dy) {
                        return Known::default();
                    }
                    let mut responses = [0; BANDS];
                    for (response, band) in responses.iter_mut().zip(of_channels.as_flattened()) {
                        *response = band[row + dy][column + dx];
                    }
                    let validity = if whole(dx, dy) { FULL } else { 0 };
                    Known { validity, depth: depth(dx, dy), value: Moments::of(responses) }
                };
                pulled(&[child(0, 0), child(1, 0), child(0, 1), child(1, 1)], rule, tie(x, y, 1))
            } else {
                Known::default()
            };
        }
        cells
    }
}

/// Keeps the cells of a level of a tile of `side` x `side` that begins at `left`, `top`.
#[inline(always)]
fn keep<V: Even>(store: &mut Store<'_, V>, level: u32, (left, top): (u32, u32), side: usize, cells: &[Known<V>]) {
    for (row, y) in cells.chunks_exact(side).zip(top..) {
        let first = store.index(level, left, y);
        let width = store.levels().level(level).width;
        if first != usize::MAX {
            for ((cell, index), _) in row.iter().zip(first..).zip(left..width) {
                store.set(index, State::Pulled, cell);
            }
        }
    }
}

/// The level above a tile's, which has `2 side` x `2 side` cells.
#[inline(always)]
fn halved<V: Even, const CELLS: usize>(
    cells: &[Known<V>],
    side: usize,
    (left, top): (u32, u32),
    level: u32,
    rule: &Rule,
) -> Part<V, CELLS> {
    let mut halved = [Known::default(); CELLS];
    for (at, to) in halved.iter_mut().enumerate() {
        let (i, j) = (at % side, at / side);
        let child = |dx: usize, dy: usize| cells.get((2 * j + dy) * 2 * side + 2 * i + dx).copied().unwrap_or_default();
        let children = [child(0, 0), child(1, 0), child(0, 1), child(1, 1)];
        *to = pulled_alike(&children, rule, tie(left + i as u32, top + j as u32, level));
    }
    halved
}

impl<P: Scene> Base<Moments> for Responses<'_, '_, '_, P> {
    const LEVELS: u32 = 4;

    /// Pulls the tile that a cell lies in: 8 x 8 cells of level 1, up to one of level 4.
    #[inline(never)]
    fn pull(&mut self, pyramid: &mut Store<'_, Moments>, rule: &Rule, x: u32, y: u32) {
        let (left, top) = (x >> 3 << 3, y >> 3 << 3);
        let first = self.first(left, top, rule);
        let asked = self.needs.bits(self.level + 1, left, top);
        for (at, cell) in first.iter().enumerate() {
            if asked >> at & 1 != 0 {
                let (x, y) = (left + at as u32 % 8, top + at as u32 / 8);
                pyramid.set(pyramid.index(1, x, y), State::Pulled, cell);
            }
        }
        pull_up(pyramid, rule, (left, top), &first);
    }
}

/// Pulls levels 2 to 4 of the tile whose cells of level 1, from `left`, `top` on, these are.
#[inline(always)]
fn pull_up<V: Even>(store: &mut Store<'_, V>, rule: &Rule, (left, top): (u32, u32), first: &Part<V, 64>) {
    let place = |level: u32| (left >> (level - 1), top >> (level - 1));
    let second: Part<V, 16> = halved(first, 4, place(2), 2, rule);
    keep(store, 2, place(2), 4, &second);
    let third: Part<V, 4> = halved(&second, 2, place(3), 3, rule);
    keep(store, 3, place(3), 2, &third);
    let fourth: Part<V, 1> = halved(&third, 1, place(4), 4, rule);
    keep(store, 4, place(4), 1, &fourth);
}
