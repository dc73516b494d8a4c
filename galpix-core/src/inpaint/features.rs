//! The features of a level: its two bands in three channels, pulled once, tile by tile.
//!
//! A response counts only if all 25 cells under the kernel are known (section 3.2 of the paper: the mask is dilated by the kernel's
//! radius, at each level by that level's cells) and of one surface: the step from foreground to background, where holes open, is
//! no texture of either. Of one surface are cells whose depths lie within the threshold of each other.
//!
//! Responses themselves are not stored: a hole has none, and everything above sees their means only.

use super::demand::{Base, Demand};
use super::mean::tie;
use super::metamer::Scene;
use super::needs::Needs;
use super::push_pull::{Rule, Value, pulled};
use super::pyramid::{Known, Pyramid, State};
use super::statistics::{BANDS, Moments};
use super::steerable::{APRON, Bands, TILE, bands};
use super::tile::{ALL, Row, Surroundings};
use super::tone::Tone;
use super::validity::FULL;

/// Columns and rows of a pulled tile.
const HALF: usize = TILE / 2;

/// Levels of a tile above the cells that it is pulled from.
const LEVELS: u32 = 4;

/// Columns of level 1 of the tiles of tones that are pulled together.
const ACROSS: u32 = 8 * HALF as u32;

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
    const LEVELS: u32 = LEVELS;

    /// Pulls some tiles of 8 x 8 cells of level 1 that lie in a row, up to one of level 4 for each. Rows of the picture are long in
    /// memory: that is why they are read far along before the next one is.
    #[inline(never)]
    fn pull(&mut self, pyramid: &mut Pyramid<'_, Tone>, rule: &Rule, x: u32, y: u32) {
        let (start, top) = (x / ACROSS * ACROSS, y >> 3 << 3);
        let end = (start + ACROSS).min(pyramid.levels().level(1).width);
        let tiles = || (start..end).step_by(HALF);
        for y in top..top + HALF as u32 {
            for left in tiles() {
                let mut cells: Part<Tone, 8> = [Known::default(); 8];
                self.line(left, y, rule, &mut cells);
                keep(pyramid, 1, (left, y), 8, &cells);
            }
        }
        for left in tiles() {
            let mut first: Part<Tone, 64> = [Known::default(); 64];
            for (line, y) in first.chunks_exact_mut(8).zip(top..) {
                for (cell, x) in line.iter_mut().zip(left..) {
                    *cell = pyramid.known(pyramid.index(1, x, y));
                }
            }
            let second: Part<Tone, 16> = halved(&first, 4, (left >> 1, top >> 1), 2, rule);
            pull_up(pyramid, rule, (left, top), &second);
        }
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
    /// Where tiles are worked out.
    pub workspace: &'t mut Workspace,
}

impl<P: Scene> Responses<'_, '_, '_, P> {
    /// Pulls what of the level lies in and around the tile that begins at `left`, `top`.
    #[inline(always)]
    fn pull_tones(&mut self, left: u32, top: u32) {
        // What comes together need be asked for once.
        let (across, down) = match self.level {
            0 => return,
            level if level <= LEVELS => (ACROSS >> (level - 1), HALF as u32 >> (level - 1)),
            _ => (1, 1),
        };
        let size = self.tones.pyramid.levels().level(self.level);
        let first = |from: u32, step: u32| from.saturating_sub(APRON as u32) / step * step;
        let end = |from: u32, end: u32| (from + (TILE + APRON) as u32).min(end);
        for y in (first(top, down)..end(top, size.height)).step_by(down as usize) {
            for x in (first(left, across)..end(left, size.width)).step_by(across as usize) {
                self.tones.want_pulled(self.level, x, y);
            }
        }
    }
}

/// The cells of a row of a level, which are pulled.
#[inline(always)]
fn row<P: Scene>(tones: &Demand<'_, '_, Tone, Below<'_, P>>, level: u32, left: u32, y: u32, cells: &mut Row) {
    if level == 0 {
        return tones.base.0.row(left, y, cells);
    }
    let width = tones.pyramid.levels().level(level).width;
    let first = tones.pyramid.index(level, left, y);
    let count = (width - left).min((TILE + 2 * APRON) as u32) as usize;
    for (column, (validity, depth, tone)) in tones.pyramid.run(first, count).enumerate() {
        cells.set(column, validity, depth, tone);
    }
}

/// What a tile is worked out in, so that it need not be cleared for each.
#[derive(Debug)]
pub struct Workspace {
    surroundings: Surroundings,
    of_channels: [Bands; 3],
    quads: Quads,
}

impl Workspace {
    /// Nothing.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            surroundings: Surroundings::new(),
            of_channels: [[[[0; TILE]; TILE]; 2]; 3],
            quads: Quads { means: [[[0; HALF]; HALF]; BANDS], squares: [[[0; HALF]; HALF]; BANDS] },
        }
    }
}

impl Default for Workspace {
    fn default() -> Self {
        Self::new()
    }
}

/// The moments of four cells each of a tile.
#[derive(Debug)]
struct Quads {
    means: [[[i16; HALF]; HALF]; BANDS],
    squares: [[[u32; HALF]; HALF]; BANDS],
}

impl Quads {
    /// Means of four that weigh the same; `tie` is that of the first one.
    #[inline(always)]
    fn pull(&mut self, of_channels: &[Bands; 3], tie: u32) {
        let of_bands = of_channels.as_flattened();
        for ((means, squares), band) in self.means.iter_mut().zip(&mut self.squares).zip(of_bands) {
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
    /// Pulls the tile that begins at `left`, `top` of level 1.
    #[inline(always)]
    fn tile(&mut self, pyramid: &mut Pyramid<'_, Moments>, left: u32, top: u32, rule: &Rule) {
        let size = self.tones.pyramid.levels().level(self.level);
        self.pull_tones(2 * left, 2 * top);
        let (tones, level) = (&*self.tones, self.level);
        let Workspace { surroundings, of_channels, quads } = &mut *self.workspace;
        surroundings.load(2 * left, 2 * top, [size.width, size.height], |left, y, cells| {
            row(tones, level, left, y, cells);
        });
        for (cells, of_channel) in surroundings.channels.iter().zip(of_channels.iter_mut()) {
            bands(cells, of_channel);
        }
        quads.pull(of_channels, tie(left, top, 1));
        let mut whole = surroundings.whole(rule.threshold);
        // What lies beyond the picture has no response.
        let columns = u32::MAX.checked_shr(u32::BITS - (size.width - 2 * left).min(u32::BITS)).unwrap_or_default();
        for (y, whole) in (2 * top..).zip(&mut whole) {
            *whole &= if y < size.height { columns } else { 0 };
        }
        let asked = self.needs.bits(self.level + 1, left, top);
        if whole == [ALL; TILE] {
            return even_tile(pyramid, (left, top), quads, surroundings, asked, rule);
        }
        let mut cells = [Known::default(); 64];
        for (j, (line, whole)) in cells.chunks_exact_mut(HALF).zip(whole.chunks_exact(2)).enumerate() {
            let [upper, lower] = [whole[0], whole[1]];
            for (i, cell) in line.iter_mut().enumerate() {
                let (x, y, column, row) = (left + i as u32, top + j as u32, 2 * i, 2 * j);
                let four = upper >> column & 3 | (lower >> column & 3) << 2;
                let depth = depth_of(surroundings, i, j);
                *cell = if four == 15 {
                    // They lie under each other's kernel: they are of one surface.
                    Known { validity: FULL, depth, value: quads.moments(i, j) }
                } else if four == 0 {
                    Known { validity: 0, depth, value: Moments::default() }
                } else {
                    let child = |at: usize| {
                        let (dx, dy) = (at & 1, at >> 1);
                        if 2 * x + dx as u32 >= size.width || 2 * y + dy as u32 >= size.height {
                            return Known::default();
                        }
                        let mut responses = [0; BANDS];
                        for (response, band) in responses.iter_mut().zip(of_channels.as_flattened()) {
                            *response = band[row + dy][column + dx];
                        }
                        let depth = surroundings.depths[row + dy + APRON][column + dx + APRON] as u32;
                        Known { validity: (four >> at & 1) * FULL, depth, value: Moments::of(responses) }
                    };
                    pulled(&[child(0), child(1), child(2), child(3)], rule, tie(x, y, 1))
                };
                if asked >> (HALF * j + i) & 1 != 0 {
                    pyramid.set(pyramid.index(1, x, y), State::Pulled, *cell);
                }
            }
        }
        let second: Part<Moments, 16> = halved(&cells, 4, (left >> 1, top >> 1), 2, rule);
        pull_up(pyramid, rule, (left, top), &second);
    }
}

/// The farthest of four cells of a tile; beyond the picture its border is repeated.
#[inline(always)]
fn depth_of(surroundings: &Surroundings, x: usize, y: usize) -> u32 {
    let (column, row) = (2 * x + APRON, 2 * y + APRON);
    let [upper, lower] = [&surroundings.depths[row], &surroundings.depths[row + 1]];
    upper[column].max(upper[column + 1]).max(lower[column].max(lower[column + 1])) as u32
}

/// Pulls a tile that is known throughout, of one surface, and within the picture: of level 1 only what is asked for is put together.
#[inline(always)]
fn even_tile(
    pyramid: &mut Pyramid<'_, Moments>,
    (left, top): (u32, u32),
    quads: &Quads,
    surroundings: &Surroundings,
    mut asked: u64,
    rule: &Rule,
) {
    let depth = |x: usize, y: usize| depth_of(surroundings, x, y);
    while asked != 0 {
        let at = asked.trailing_zeros() as usize;
        asked &= asked - 1;
        let (i, j) = (at % HALF, at / HALF);
        let known = Known { validity: FULL, depth: depth(i, j), value: quads.moments(i, j) };
        pyramid.set(pyramid.index(1, left + i as u32, top + j as u32), State::Pulled, known);
    }
    let mut second: Part<Moments, 16> = [Known::default(); 16];
    for (at, to) in second.iter_mut().enumerate() {
        let (i, j) = (at % 4, at / 4);
        let up = 1 + tie((left >> 1) + i as u32, (top >> 1) + j as u32, 2);
        let (x, y) = (2 * i, 2 * j);
        for band in 0..BANDS {
            let (means, squares) = (&quads.means[band], &quads.squares[band]);
            let sum = means[y][x] + means[y][x + 1] + means[y + 1][x] + means[y + 1][x + 1];
            to.value.means[band] = (sum + up as i16) >> 2;
            let sum = squares[y][x] + squares[y][x + 1] + squares[y + 1][x] + squares[y + 1][x + 1];
            to.value.squares[band] = (sum + up) >> 2;
        }
        to.validity = FULL;
        to.depth = depth(x, y).max(depth(x + 1, y)).max(depth(x, y + 1).max(depth(x + 1, y + 1)));
    }
    pull_up(pyramid, rule, (left, top), &second);
}

/// Keeps the cells of a level of a tile of `side` x `side` that begins at `left`, `top`.
#[inline(always)]
fn keep<V: Value>(store: &mut Pyramid<'_, V>, level: u32, (left, top): (u32, u32), side: usize, cells: &[Known<V>]) {
    for (row, y) in cells.chunks_exact(side).zip(top..) {
        let first = store.index(level, left, y);
        let width = store.levels().level(level).width;
        if first != usize::MAX {
            for ((cell, index), _) in row.iter().zip(first..).zip(left..width) {
                store.set(index, State::Pulled, *cell);
            }
        }
    }
}

/// The level above a tile's, which has `2 side` x `2 side` cells.
#[inline(always)]
fn halved<V: Value, const CELLS: usize>(
    cells: &[Known<V>],
    side: usize,
    (left, top): (u32, u32),
    level: u32,
    rule: &Rule,
) -> Part<V, CELLS> {
    let mut halved = [Known::default(); CELLS];
    for (at, to) in halved.iter_mut().enumerate() {
        let (i, j) = (at % side, at / side);
        let first = 2 * (2 * j * side + i);
        let (Some([a, b]), Some([c, d])) =
            (cells.get(first..first + 2), cells.get(first + 2 * side..first + 2 * side + 2))
        else {
            continue;
        };
        let tie = tie(left + i as u32, top + j as u32, level);
        let farthest = a.depth.max(b.depth).max(c.depth.max(d.depth));
        let nearest = a.depth.min(b.depth).min(c.depth.min(d.depth));
        if a.validity & b.validity & c.validity & d.validity == FULL && farthest - nearest <= rule.threshold {
            to.validity = FULL;
            to.depth = farthest;
            to.value = V::plain_mean(&[a.value, b.value, c.value, d.value], tie);
        } else {
            *to = pulled(&[*a, *b, *c, *d], rule, tie);
        }
    }
    halved
}

impl<P: Scene> Base<Moments> for Responses<'_, '_, '_, P> {
    const LEVELS: u32 = LEVELS;

    /// Pulls the tile that a cell lies in: 8 x 8 cells of level 1, up to one of level 4.
    #[inline(never)]
    fn pull(&mut self, pyramid: &mut Pyramid<'_, Moments>, rule: &Rule, x: u32, y: u32) {
        let (left, top) = (x >> 3 << 3, y >> 3 << 3);
        self.tile(pyramid, left, top, rule);
    }
}

/// Pulls levels 3 and 4 of the tile whose cells of level 2 these are, and keeps all; `left`, `top` is its first cell of level 1.
#[inline(always)]
fn pull_up<V: Value>(store: &mut Pyramid<'_, V>, rule: &Rule, (left, top): (u32, u32), second: &Part<V, 16>) {
    let place = |level: u32| (left >> (level - 1), top >> (level - 1));
    keep(store, 2, place(2), 4, second);
    let third: Part<V, 4> = halved(second, 2, place(3), 3, rule);
    keep(store, 3, place(3), 2, &third);
    let fourth: Part<V, 1> = halved(&third, 1, place(4), 4, rule);
    keep(store, 4, place(4), 1, &fourth);
}
