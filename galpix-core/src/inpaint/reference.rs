//! The reference of push-pull: all cells of all levels, in plain loops, by the kernel and by nothing else of the fast
//! form.

extern crate std;

use std::vec::Vec;

use super::kernel::{Known, Value, above, below, each, pulled, pushed, sampled};
use super::levels::Levels;
use super::mean::tie;
use super::push_pull::Holed;
use super::settings::Inpainting;
use super::validity::FULL;

/// The cells of a level.
pub struct Plane<V> {
    size: [u32; 2],
    cells: Vec<Known<V>>,
}

impl<V: Value> Plane<V> {
    /// Makes a plane cell by cell.
    pub fn new([width, height]: [u32; 2], mut of: impl FnMut(u32, u32) -> Known<V>) -> Self {
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Self { size: [width, height], cells: places.map(|(x, y)| of(x, y)).collect() }
    }

    /// Makes another plane from each cell.
    pub fn map<W: Value>(&self, mut of: impl FnMut(u32, u32, Known<V>) -> Known<W>) -> Plane<W> {
        Plane::new(self.size, |x, y| of(x, y, self.at((x, y))))
    }

    /// Returns columns and rows.
    pub const fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns what is known of a cell; nothing beyond the border.
    pub fn at(&self, (x, y): (u32, u32)) -> Known<V> {
        let [width, height] = self.size;
        if x < width && y < height { self.cells[(y * width + x) as usize] } else { Known::default() }
    }

    /// Pulls the plane above, which is level `level`.
    fn pulled(&self, level: u32, inpainting: &Inpainting<'_>) -> Self {
        let size = self.size.map(|side| side.div_ceil(2));
        Self::new(size, |x, y| pulled(&each(below(x, y), |place| self.at(place)), inpainting, tie(x, y, level)))
    }

    /// Samples the plane for a cell of depth `depth` of the level below, which is level `level`.
    pub fn sampled(&self, level: u32, (x, y): (u32, u32), depth: u32, inpainting: &Inpainting<'_>) -> Option<V> {
        sampled(&each(above(x, y), |place| self.at(place)), depth, inpainting, tie(x, y, level))
    }
}

/// Pulls all levels above a plane, down to a single cell; the plane is the first of them.
pub fn pulled_up<V: Value>(base: Plane<V>, inpainting: &Inpainting<'_>) -> Vec<Plane<V>> {
    let mut planes = Vec::from([base]);
    while let Some(last) = planes.last().filter(|last| last.size != [1, 1]) {
        let above = last.pulled(planes.len() as u32, inpainting);
        planes.push(above);
    }
    planes
}

/// Pushes all levels from the last but one down to `lowest`.
pub fn push_down<V: Value>(planes: &mut [Plane<V>], lowest: u32, inpainting: &Inpainting<'_>) {
    for level in (lowest..planes.len() as u32 - 1).rev() {
        let above = &planes[level as usize + 1];
        planes[level as usize] = planes[level as usize].map(|x, y, own| {
            let from_above = above.sampled(level, (x, y), own.depth, inpainting);
            if own.validity < FULL { pushed(own, from_above, tie(x, y, level)) } else { own }
        });
    }
}

/// Fills the holes of a picture by push-pull over a pyramid of these levels: how many were filled.
pub fn push_pull<P: Holed>(picture: &mut P, levels: &Levels, inpainting: &Inpainting<'_>) -> u32 {
    if levels.top() == 0 {
        return 0;
    }
    // Of a picture of another size, all cells count that lie below a cell of level 1.
    let ([width, height], above) = (picture.size(), levels.level(1));
    let base = Plane::new([2 * above.width, 2 * above.height], |x, y| {
        if x < width && y < height { picture.known(x, y) } else { Known::default() }
    });
    let mut planes = pulled_up(base, inpainting);
    push_down(&mut planes, 1, inpainting);
    picture.fill_holes(|picture, x, y| planes[1].sampled(0, (x, y), picture.known(x, y).depth, inpainting))
}
