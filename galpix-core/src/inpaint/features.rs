//! The features of a level: its two bands in three channels, pulled once, tile by tile.
//!
//! A response counts only if all 25 cells under the kernel are known (section 3.2 of the paper: the mask is dilated by the kernel's
//! radius, at each level by that level's cells) and of one surface: the step from foreground to background, where holes open, is
//! no texture of either. Of one surface are cells whose depths lie within the threshold of each other.
//!
//! Responses themselves are not stored: a hole has none, and everything above sees their means only.

use super::below::Below;
use super::block::{ACROSS, HALF, LEVELS, Part, halved, pull_up};
use super::demand::{Base, Demand};
use super::mean::tie;
use super::metamer::Scene;
use super::needs::Needs;
use super::push_pull::{Rule, pulled};
use super::pyramid::{Known, Pyramid, State};
use super::statistics::{BANDS, Moments};
use super::steerable::{APRON, Bands, TILE, bands, row_of};
use super::tile::{ALL, Row, Surroundings};
use super::tone::Tone;
use super::validity::FULL;

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
            quads: Quads { means: [[0; QUADS]; BANDS], squares: [[0; QUADS]; BANDS] },
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
    means: [[i16; QUADS]; BANDS],
    squares: [[u32; QUADS]; BANDS],
}

const QUADS: usize = HALF * HALF;

/// What is added before a sum of four is divided, by the tie of the first one of a tile.
const UP: [[i16; QUADS]; 2] = {
    let mut up = [[0; QUADS]; 2];
    let mut at = 0;
    while at < QUADS {
        let odd = ((at % HALF) ^ (at / HALF)) & 1;
        up[0][at] = 1 + odd as i16;
        up[1][at] = 2 - odd as i16;
        at += 1;
    }
    up
};

impl Quads {
    /// Means of four that weigh the same; `tie` is that of the first one.
    #[inline(always)]
    fn pull(&mut self, of_channels: &[Bands; 3], tie: u32) {
        let up = &UP[(tie & 1) as usize];
        for ((means, squares), band) in self.means.iter_mut().zip(&mut self.squares).zip(of_channels.as_flattened()) {
            let (even, odd) = band.split_at(HALF);
            pull_band(even.as_flattened(), odd.as_flattened(), up, means, squares);
        }
    }

    #[inline(always)]
    fn moments(&self, x: usize, y: usize) -> Moments {
        let mut moments = Moments::default();
        for band in 0..BANDS {
            moments.means[band] = self.means[band][y * HALF + x];
            moments.squares[band] = self.squares[band][y * HALF + x];
        }
        moments
    }
}

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
                            *response = band[row_of(row + dy)][column + dx];
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

/// Means of the responses of a band and of their squares, from the even and the odd rows of a tile.
#[inline(never)]
fn pull_band(even: &[i16], odd: &[i16], up: &[i16; QUADS], means: &mut [i16; QUADS], squares: &mut [u32; QUADS]) {
    // Down the columns first, where neighbours lie side by side; rows so long that they become vector code.
    let (mut sums, mut sums_of_squares) = ([0; 2 * QUADS], [0; 2 * QUADS]);
    for (((sum, square), &a), &b) in sums.iter_mut().zip(&mut sums_of_squares).zip(even).zip(odd) {
        *sum = a + b;
        *square = i32::from(a) * i32::from(a) + i32::from(b) * i32::from(b);
    }
    for at in 0..QUADS {
        means[at] = (sums[2 * at] + sums[2 * at + 1] + up[at]) >> 2;
        squares[at] = (sums_of_squares[2 * at] + sums_of_squares[2 * at + 1] + i32::from(up[at])) as u32 >> 2;
    }
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
            let (upper, lower) = (y * HALF + x, (y + 1) * HALF + x);
            let sum = means[upper] + means[upper + 1] + means[lower] + means[lower + 1];
            to.value.means[band] = (sum + up as i16) >> 2;
            let sum = squares[upper] + squares[upper + 1] + squares[lower] + squares[lower + 1];
            to.value.squares[band] = (sum + up) >> 2;
        }
        to.validity = FULL;
        to.depth = depth(x, y).max(depth(x + 1, y)).max(depth(x, y + 1).max(depth(x + 1, y + 1)));
    }
    pull_up(pyramid, rule, (left, top), &second);
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
