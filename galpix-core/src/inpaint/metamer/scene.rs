//! What metamers are made in.

use super::steerable::COLUMNS;
use super::surroundings::Row;
use super::tone::Tone;
use crate::inpaint::kernel::Known;
use crate::inpaint::push_pull::Holed;

/// A picture with holes, and with motion.
pub trait Scene: Holed<Value = Tone> {
    /// Calls `hole` with the place of each hole that is to be filled, row by row.
    fn each_hole(&mut self, hole: impl FnMut(u32, u32));

    /// Copies the cells of a row from `left` on, as many as there are; those of `cells` beyond the border are
    /// unspecified.
    #[inline]
    fn row(&self, left: u32, y: u32, cells: &mut Row) {
        let [width, _] = self.size();
        for x in left..width.min(left + COLUMNS as u32) {
            cells.set((x - left) as usize, &self.known(x, y));
        }
    }

    /// Returns the depth of a cell.
    #[inline]
    fn depth(&self, x: u32, y: u32) -> u32 {
        self.known(x, y).depth
    }

    /// Returns the source of a cell's tone.
    #[inline]
    fn source(&self, x: u32, y: u32) -> u32 {
        let Known { value, .. } = self.known(x, y);
        value.source
    }

    /// Returns how far what a cell holds has moved in the last `age` frames, in cells to the right and down, to the
    /// nearest.
    fn displacement(&self, source: u32, age: u32) -> [i32; 2];

    /// Fills a hole. What [`Holed::known`] returns for it does not change, but for its tone.
    fn put(&mut self, x: u32, y: u32, tone: Tone);
}
