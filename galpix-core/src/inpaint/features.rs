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
use super::push_pull::{Rule, pulled};
use super::pyramid::{Known, Pyramid, State};
use super::statistics::{BANDS, Moments};
use super::steerable::{APRON, Bands, TILE, bands};
use super::tile::{Row, Surroundings};
use super::tone::Tone;
use super::validity::FULL;

/// Columns and rows of a pulled tile.
const HALF: usize = TILE / 2;

/// Level 0 of the tones: the picture.
#[derive(Debug)]
pub struct Below<'p, P>(pub &'p P);

impl<P: Scene> Base<Tone> for Below<'_, P> {
    /// Pulls 8 x 1 cells.
    fn pull(&mut self, pyramid: &mut Pyramid<'_, Tone>, rule: &Rule, x: u32, y: u32) {
        let [width, height] = self.0.size();
        let (left, top) = (x / HALF as u32 * HALF as u32, y << 1);
        let (mut upper, mut lower) = (Row::default(), Row::default());
        self.0.row(2 * left, top, &mut upper);
        if top + 1 < height {
            self.0.row(2 * left, top + 1, &mut lower);
        }
        let mut means = [[0; HALF]; 3];
        for ((means, upper), lower) in means.iter_mut().zip(&upper.channels).zip(&lower.channels) {
            for (i, mean) in means.iter_mut().enumerate() {
                let sum = upper[2 * i] + upper[2 * i + 1] + lower[2 * i] + lower[2 * i + 1];
                *mean = (sum + 1 + tie(i as u32, y, 1) as i16) >> 2;
            }
        }
        for (i, x) in (left..(left + HALF as u32).min(width.div_ceil(2))).enumerate() {
            let column = 2 * i;
            let depths =
                [upper.depths[column], upper.depths[column + 1], lower.depths[column], lower.depths[column + 1]];
            let [a, b, c, d] = depths;
            let depth = a.max(b).max(c.max(d)) as u32;
            let known = upper.known[column] & upper.known[column + 1] & lower.known[column] & lower.known[column + 1];
            let inside = 2 * x + 1 < width && top + 1 < height;
            let even = inside && known != 0 && depth - a.min(b).min(c.min(d)) as u32 <= rule.threshold;
            let known = if even {
                let channels = [means[0][i], means[1][i], means[2][i]];
                Known { validity: FULL, depth, value: Tone { channels, source: self.0.source(2 * x, top) } }
            } else {
                let child = |x: u32, y: u32| {
                    if x < width && y < height { self.0.known(x, y) } else { Known::default() }
                };
                let (left, top) = (2 * x, top);
                let children = [child(left, top), child(left + 1, top), child(left, top + 1), child(left + 1, top + 1)];
                pulled(&children, rule, tie(x, y, 1))
            };
            pyramid.set(pyramid.index(1, x, y), State::Pulled, known);
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
                for x in 0..HALF {
                    let [a, b, c, d] = [upper[2 * x], upper[2 * x + 1], lower[2 * x], lower[2 * x + 1]].map(i32::from);
                    let up = 1 + ((x as u32 ^ y as u32 ^ tie) & 1);
                    means[x] = ((a + b + c + d + up as i32) >> 2) as i16;
                    squares[x] = ((a * a + b * b + c * c + d * d) as u32 + up) >> 2;
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

impl<P: Scene> Base<Moments> for Responses<'_, '_, '_, P> {
    /// Pulls the tile of 8 x 8 cells that this one lies in.
    #[inline(never)]
    fn pull(&mut self, pyramid: &mut Pyramid<'_, Moments>, rule: &Rule, x: u32, y: u32) {
        let half = HALF as u32;
        let (left, top) = (x / half * half, y / half * half);
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
        for (j, y) in (top..(top + half).min(size.height.div_ceil(2))).enumerate() {
            for (i, x) in (left..(left + half).min(size.width.div_ceil(2))).enumerate() {
                let (column, row) = (2 * i, 2 * j);
                let depth = |dx: usize, dy: usize| surroundings.depths[row + dy + APRON][column + dx + APRON] as u32;
                let inside =
                    |dx: usize, dy: usize| 2 * x + (dx as u32) < size.width && 2 * y + (dy as u32) < size.height;
                let whole = |dx: usize, dy: usize| {
                    inside(dx, dy) && whole.as_ref().is_none_or(|whole| whole[row + dy][column + dx])
                };
                let known = if whole(0, 0) && whole(1, 0) && whole(0, 1) && whole(1, 1) {
                    // They lie under each other's kernel: they are of one surface.
                    let depth = depth(0, 0).max(depth(1, 0)).max(depth(0, 1).max(depth(1, 1)));
                    Known { validity: FULL, depth, value: quads.moments(i, j) }
                } else {
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
                };
                pyramid.set(pyramid.index(1, x, y), State::Pulled, known);
            }
        }
    }
}
