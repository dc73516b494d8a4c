//! The features of a level: its two bands in three channels, pulled once, tile by tile.
//!
//! A response counts only if all 25 cells under the kernel are known (section 3.2 of the paper: the mask is dilated by the kernel's
//! radius, at each level by that level's cells) and of one surface: the step from foreground to background, where holes open, is
//! no texture of either. Of one surface are cells whose depths lie within the threshold of each other.
//!
//! Responses themselves are not stored: a hole has none, and everything above sees their means only.

use super::demand::{Base, Demand};
use super::mean::tie;
use super::push_pull::{Picture, Rule, pulled};
use super::pyramid::{Known, Pyramid, State};
use super::statistics::Moments;
use super::steerable::{APRON, Bands, COLUMNS, Cells, ROWS, TILE, bands};
use super::tone::Tone;
use super::validity::FULL;

/// Level 0 of the tones: the picture.
#[derive(Debug)]
pub struct Below<'p, P>(pub &'p P);

impl<P: Picture<Value = Tone>> Base<Tone> for Below<'_, P> {
    #[inline(always)]
    fn pull(&mut self, pyramid: &mut Pyramid<'_, Tone>, rule: &Rule, x: u32, y: u32) {
        let [width, height] = self.0.size();
        let (left, top) = (x << 1, y << 1);
        let children = [(left, top), (left + 1, top), (left, top + 1), (left + 1, top + 1)]
            .map(|(x, y)| if x < width && y < height { self.0.known(x, y) } else { Known::default() });
        let index = pyramid.index(1, x, y);
        pyramid.set(index, State::Pulled, pulled(&children, rule, tie(x, y, 1)));
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

/// What a tile's responses are made from.
struct Surroundings {
    channels: [Cells; 3],
    /// Whether a cell is known.
    known: [[bool; COLUMNS]; ROWS],
    depths: [[u32; COLUMNS]; ROWS],
}

impl<P: Picture<Value = Tone>> Responses<'_, '_, '_, P> {
    /// A cell of the level, in its size.
    #[inline(always)]
    fn cell(&mut self, x: u32, y: u32) -> Known<Tone> {
        if self.level == 0 {
            return self.tones.base.0.known(x, y);
        }
        self.tones.want_pulled(self.level, x, y);
        self.tones.pyramid.known(self.tones.pyramid.index(self.level, x, y))
    }

    /// The cells of a tile that begins at `left`, `top`, and those around it; the picture's border is repeated.
    fn surroundings(&mut self, left: u32, top: u32) -> Surroundings {
        let size = self.tones.pyramid.levels().level(self.level);
        let mut surroundings = Surroundings {
            channels: [[[0; COLUMNS]; ROWS]; 3],
            known: [[false; COLUMNS]; ROWS],
            depths: [[0; COLUMNS]; ROWS],
        };
        for row in 0..ROWS {
            let y = (top + row as u32).saturating_sub(APRON as u32).min(size.height - 1);
            for column in 0..TILE + 2 * APRON {
                let x = (left + column as u32).saturating_sub(APRON as u32).min(size.width - 1);
                let Known { validity, depth, value } = self.cell(x, y);
                for (channel, level) in surroundings.channels.iter_mut().zip(value.channels) {
                    channel[row][column] = level;
                }
                surroundings.known[row][column] = validity == FULL;
                surroundings.depths[row][column] = depth;
            }
        }
        surroundings
    }
}

/// Whether all cells under the kernel are known and of one surface, for each cell of a tile.
fn whole(of: &Surroundings, rule: &Rule) -> [[bool; TILE]; TILE] {
    // Down the columns, then along the rows.
    let mut known = [[true; COLUMNS]; TILE];
    let mut ranges = [[(u32::MAX, 0); COLUMNS]; TILE];
    for y in 0..TILE {
        for row in y..y + 1 + 2 * APRON {
            for x in 0..COLUMNS {
                known[y][x] &= of.known[row][x];
                let (low, high) = ranges[y][x];
                ranges[y][x] = (low.min(of.depths[row][x]), high.max(of.depths[row][x]));
            }
        }
    }
    let mut whole = [[true; TILE]; TILE];
    for y in 0..TILE {
        for x in 0..TILE {
            let (mut low, mut high) = (u32::MAX, 0);
            for column in x..x + 1 + 2 * APRON {
                whole[y][x] &= known[y][column];
                low = low.min(ranges[y][column].0);
                high = high.max(ranges[y][column].1);
            }
            whole[y][x] &= high - low <= rule.threshold;
        }
    }
    whole
}

impl<P: Picture<Value = Tone>> Base<Moments> for Responses<'_, '_, '_, P> {
    /// Pulls the tile of 8 x 8 cells that this one lies in.
    fn pull(&mut self, pyramid: &mut Pyramid<'_, Moments>, rule: &Rule, x: u32, y: u32) {
        const HALF: u32 = TILE as u32 / 2;
        let (left, top) = (x / HALF * HALF, y / HALF * HALF);
        let surroundings = self.surroundings(2 * left, 2 * top);
        let whole = whole(&surroundings, rule);
        let mut of_channels: [Bands; 3] = [[[[0; TILE]; TILE]; 2]; 3];
        for (cells, of_channel) in surroundings.channels.iter().zip(&mut of_channels) {
            bands(cells, of_channel);
        }
        let size = self.tones.pyramid.levels().level(self.level);
        for (j, y) in (top..(top + HALF).min(size.height.div_ceil(2))).enumerate() {
            for (i, x) in (left..(left + HALF).min(size.width.div_ceil(2))).enumerate() {
                let child = |dx: usize, dy: usize| {
                    let (column, row) = (2 * i + dx, 2 * j + dy);
                    if 2 * x + dx as u32 >= size.width || 2 * y + dy as u32 >= size.height {
                        return Known::default();
                    }
                    let depth = surroundings.depths[row + APRON][column + APRON];
                    if !whole[row][column] {
                        return Known { validity: 0, depth, value: Moments::default() };
                    }
                    let mut responses = [0; 6];
                    for (pair, of_channel) in responses.chunks_exact_mut(2).zip(&of_channels) {
                        pair[0] = of_channel[0][row][column];
                        pair[1] = of_channel[1][row][column];
                    }
                    Known { validity: FULL, depth, value: Moments::of(responses) }
                };
                let children = [child(0, 0), child(1, 0), child(0, 1), child(1, 1)];
                let known = pulled(&children, rule, tie(x, y, 1));
                pyramid.set(pyramid.index(1, x, y), State::Pulled, known);
            }
        }
    }
}
