//! A plain picture as a scene for metamers.

use super::scene::Scene;
use super::steerable::COLUMNS;
use super::surroundings::Row;
use super::tone::Tone;
use crate::inpaint::picture::{Holes, pyramid_depth};
use crate::inpaint::push_pull::Holed;
use crate::layers::displacement;

impl Scene for Holes<'_, Tone> {
    fn each_hole(&mut self, mut hole: impl FnMut(u32, u32)) {
        Holes::each_hole(self, |_, x, y| hole(x, y));
    }

    #[inline]
    fn row(&self, left: u32, y: u32, cells: &mut Row) {
        let [width, _] = self.size();
        let first = self.cell(left, y);
        let range = first as usize..(first + (width - left).min(COLUMNS as u32)) as usize;
        let copy = |plane: &[u32]| {
            let mut copy = [0; COLUMNS];
            for (to, &word) in copy.iter_mut().zip(plane.get(range.clone()).unwrap_or_default()) {
                *to = word;
            }
            copy
        };
        let (colours, depths) = (copy(self.picture.colours), copy(self.picture.depths));
        let known = self.known_from(first);
        for x in 0..COLUMNS {
            cells.depths[x] = pyramid_depth(depths[x]) as i32;
            cells.known[x] = -((known >> x & 1) as i32);
            let [luma, blue, red] = self.table.channels(colours[x]);
            cells.channels[0][x] = luma;
            cells.channels[1][x] = blue;
            cells.channels[2][x] = red;
        }
    }

    #[inline]
    fn source(&self, x: u32, y: u32) -> u32 {
        self.cell(x, y)
    }

    /// Returns what the picture says of the source: how far it moves in a frame is not known here.
    fn displacement(&self, source: u32, _: u32) -> [i32; 2] {
        displacement(self.moved.get(source as usize).copied().unwrap_or_default())
    }

    fn put(&mut self, x: u32, y: u32, tone: Tone) {
        self.set(x, y, tone);
    }
}
