//! Level 0 of the moments: the responses of a level of the tones, two bands in three channels, pulled once, tile by
//! tile.
//!
//! A response counts only if all 25 cells under the kernel are known (section 3.2 of the paper: the mask is dilated by
//! the kernel's radius, at each level by that level's cells) and of one surface: the step from foreground to
//! background, where holes open, is no texture of either. Of one surface are cells whose depths lie within the
//! threshold of each other.
//!
//! Responses themselves are not stored: a hole has none, and everything above sees their means only.

use super::active::ActiveTiles;
use super::block::{ACROSS, HALF, LEVELS, Part, halved, pull_up};
use super::scene::Scene;
use super::statistics::{BANDS, Moments};
use super::steerable::{APRON, Bands, TILE, bands, row_of};
use super::surroundings::{ALL, Row, RowBits, Surroundings};
use super::tone::Tone;
use super::tones::Tones;
use crate::inpaint::kernel::{Known, pulled};
use crate::inpaint::lazy::{Base, Lazy};
use crate::inpaint::levels::Level;
use crate::inpaint::mean::tie;
use crate::inpaint::pyramid::{Pyramid, State};
use crate::inpaint::settings::Inpainting;
use crate::inpaint::validity::FULL;

/// A level of the tones under the pyramid of its moments.
#[derive(Debug)]
pub struct Responses<'t, 'f, 's, S> {
    /// The tones.
    pub tones: &'t mut Lazy<'f, 's, Tone, Tones<'t, S>>,
    /// The level.
    pub level: u32,
    /// What of the level above is requested: of what is not, no moments are kept.
    pub active: &'t ActiveTiles<'t>,
    /// Where tiles are worked out.
    pub workspace: &'t mut Workspace,
}

impl<S: Scene> Responses<'_, '_, '_, S> {
    fn size(&self) -> Level {
        self.tones.pyramid.levels().level(self.level)
    }

    /// Pulls what of the level lies in and around the tile that begins at `left`, `top`.
    #[inline(always)]
    fn pull_tones(&mut self, left: u32, top: u32) {
        // What is computed together is requested once.
        let (across, down) = match self.level {
            0 => return,
            level if level <= LEVELS => (ACROSS >> (level - 1), HALF as u32 >> (level - 1)),
            _ => (1, 1),
        };
        let size = self.size();
        let first = |from: u32, step: u32| from.saturating_sub(APRON as u32) / step * step;
        let end = |from: u32, end: u32| (from + (TILE + APRON) as u32).min(end);
        for y in (first(top, down)..end(top, size.height)).step_by(down as usize) {
            for x in (first(left, across)..end(left, size.width)).step_by(across as usize) {
                self.tones.ensure_pulled(self.level, x, y);
            }
        }
    }
}

/// Copies the cells of a row of a level, which are pulled.
#[inline(always)]
fn copy_row<S: Scene>(tones: &Lazy<'_, '_, Tone, Tones<'_, S>>, level: u32, left: u32, y: u32, cells: &mut Row) {
    if level == 0 {
        return tones.base.scene.row(left, y, cells);
    }
    let width = tones.pyramid.levels().level(level).width;
    let first = tones.pyramid.index(level, left, y);
    let count = (width - left).min((TILE + 2 * APRON) as u32) as usize;
    for (column, known) in tones.pyramid.run(first, count).enumerate() {
        cells.set(column, &known);
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
    /// Makes room for a tile.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            surroundings: Surroundings::new(),
            of_channels: [[[[0; TILE]; TILE]; 2]; 3],
            quads: Quads { means: [[0; QUADS]; BANDS], squares: [[0; QUADS]; BANDS] },
        }
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
    /// Takes means of four that weigh the same; `tie` is that of the first one.
    #[inline(always)]
    fn pull(&mut self, of_channels: &[Bands; 3], tie: u32) {
        let up = &UP[(tie & 1) as usize];
        for ((means, squares), band) in self.means.iter_mut().zip(&mut self.squares).zip(of_channels.as_flattened()) {
            let (even, odd) = band.split_at(HALF);
            pull_band(even.as_flattened(), odd.as_flattened(), up, means, squares);
        }
    }

    /// Returns the moments of a cell of level 1.
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

/// Returns the farthest of four cells of a tile; beyond the level its border is repeated.
#[inline(always)]
fn depth_of(surroundings: &Surroundings, x: usize, y: usize) -> u32 {
    let (column, row) = (2 * x + APRON, 2 * y + APRON);
    let [upper, lower] = [&surroundings.depths[row], &surroundings.depths[row + 1]];
    upper[column].max(upper[column + 1]).max(lower[column].max(lower[column + 1])) as u32
}

/// Takes means of the responses of a band and of their squares, from the even and the odd rows of a tile.
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

/// A tile of 8 x 8 cells of level 1.
#[derive(Clone, Copy)]
struct Tile {
    /// Its first column and row.
    left: u32,
    top: u32,
    /// The level below.
    size: Level,
    /// A bit for each of its cells that is requested.
    requested: u64,
}

impl<S: Scene> Responses<'_, '_, '_, S> {
    /// Pulls the tile that begins at `left`, `top` of level 1.
    #[inline(always)]
    fn pull_tile(&mut self, pyramid: &mut Pyramid<'_, Moments>, left: u32, top: u32) {
        let size = self.size();
        self.pull_tones(2 * left, 2 * top);
        let (tones, level) = (&*self.tones, self.level);
        let inpainting = tones.base.inpainting;
        let Workspace { surroundings, of_channels, quads } = &mut *self.workspace;
        surroundings.load(2 * left, 2 * top, [size.width, size.height], |left, y, cells| {
            copy_row(tones, level, left, y, cells);
        });
        for (cells, of_channel) in surroundings.channels.iter().zip(of_channels.iter_mut()) {
            bands(cells, of_channel);
        }
        quads.pull(of_channels, tie(left, top, 1));
        let mut whole = surroundings.whole(inpainting.threshold);
        // What lies beyond the level has no response.
        let columns = u32::MAX.checked_shr(u32::BITS - (size.width - 2 * left).min(u32::BITS)).unwrap_or_default();
        for (y, whole) in (2 * top..).zip(&mut whole) {
            *whole &= if y < size.height { columns } else { 0 };
        }
        let tile = Tile { left, top, size, requested: self.active.bits(level + 1, left, top) };
        if whole == [ALL; TILE] {
            self.workspace.pull_even(pyramid, inpainting, tile);
        } else {
            self.workspace.pull_uneven(pyramid, inpainting, tile, &whole);
        }
    }
}

impl Workspace {
    /// Returns what is known of a response of a tile.
    #[inline(always)]
    fn response(&self, column: usize, row: usize, counts: bool) -> Known<Moments> {
        let mut responses = [0; BANDS];
        for (response, band) in responses.iter_mut().zip(self.of_channels.as_flattened()) {
            *response = band[row_of(row)][column];
        }
        let depth = self.surroundings.depths[row + APRON][column + APRON] as u32;
        Known { validity: u32::from(counts) * FULL, depth, value: Moments::of(responses) }
    }

    /// Pulls a tile of which some responses do not count.
    #[inline(always)]
    fn pull_uneven(
        &self,
        pyramid: &mut Pyramid<'_, Moments>,
        inpainting: &Inpainting<'_>,
        Tile { left, top, size, requested }: Tile,
        whole: &[RowBits; TILE],
    ) {
        let mut cells = [Known::default(); 64];
        for (j, (line, whole)) in cells.chunks_exact_mut(HALF).zip(whole.chunks_exact(2)).enumerate() {
            let [upper, lower] = [whole[0], whole[1]];
            for (i, cell) in line.iter_mut().enumerate() {
                let (x, y, column, row) = (left + i as u32, top + j as u32, 2 * i, 2 * j);
                let four = upper >> column & 3 | (lower >> column & 3) << 2;
                let depth = depth_of(&self.surroundings, i, j);
                *cell = if four == 15 {
                    // They lie under each other's kernel: they are of one surface.
                    Known { validity: FULL, depth, value: self.quads.moments(i, j) }
                } else if four == 0 {
                    Known { validity: 0, depth, value: Moments::default() }
                } else {
                    let child = |at: usize| {
                        let (dx, dy) = (at & 1, at >> 1);
                        if 2 * x + dx as u32 >= size.width || 2 * y + dy as u32 >= size.height {
                            return Known::default();
                        }
                        self.response(column + dx, row + dy, four >> at & 1 != 0)
                    };
                    pulled(&[child(0), child(1), child(2), child(3)], inpainting, tie(x, y, 1))
                };
                if requested >> (HALF * j + i) & 1 != 0 {
                    pyramid.set(pyramid.index(1, x, y), State::Pulled, *cell);
                }
            }
        }
        let second: Part<Moments, 16> = halved(&cells, 4, (left >> 1, top >> 1), 2, inpainting);
        pull_up(pyramid, inpainting, (left, top), &second);
    }

    /// Pulls a tile that is known throughout, of one surface, and within the level: of level 1 only what is requested
    /// is put together.
    #[inline(always)]
    fn pull_even(
        &self,
        pyramid: &mut Pyramid<'_, Moments>,
        inpainting: &Inpainting<'_>,
        Tile { left, top, mut requested, .. }: Tile,
    ) {
        let depth = |x: usize, y: usize| depth_of(&self.surroundings, x, y);
        while requested != 0 {
            let at = requested.trailing_zeros() as usize;
            requested &= requested - 1;
            let (i, j) = (at % HALF, at / HALF);
            let known = Known { validity: FULL, depth: depth(i, j), value: self.quads.moments(i, j) };
            pyramid.set(pyramid.index(1, left + i as u32, top + j as u32), State::Pulled, known);
        }
        let mut second: Part<Moments, 16> = [Known::default(); 16];
        for (at, to) in second.iter_mut().enumerate() {
            let (i, j) = (at % 4, at / 4);
            let up = 1 + tie((left >> 1) + i as u32, (top >> 1) + j as u32, 2);
            let (x, y) = (2 * i, 2 * j);
            for band in 0..BANDS {
                let (means, squares) = (&self.quads.means[band], &self.quads.squares[band]);
                let (upper, lower) = (y * HALF + x, (y + 1) * HALF + x);
                let sum = means[upper] + means[upper + 1] + means[lower] + means[lower + 1];
                to.value.means[band] = (sum + up as i16) >> 2;
                let sum = squares[upper] + squares[upper + 1] + squares[lower] + squares[lower + 1];
                to.value.squares[band] = (sum + up) >> 2;
            }
            to.validity = FULL;
            to.depth = depth(x, y).max(depth(x + 1, y)).max(depth(x, y + 1).max(depth(x + 1, y + 1)));
        }
        pull_up(pyramid, inpainting, (left, top), &second);
    }
}

impl<S: Scene> Base<Moments> for Responses<'_, '_, '_, S> {
    const LEVELS: u32 = LEVELS;

    #[inline(always)]
    fn inpainting(&self) -> &Inpainting<'_> {
        self.tones.base.inpainting
    }

    /// Pulls the tile that a cell lies in: 8 x 8 cells of level 1, up to one of level 4.
    #[inline(never)]
    fn pull(&mut self, pyramid: &mut Pyramid<'_, Moments>, level: u32, x: u32, y: u32) {
        let (x, y) = (x << (level - 1), y << (level - 1));
        self.pull_tile(pyramid, x >> 3 << 3, y >> 3 << 3);
    }
}
