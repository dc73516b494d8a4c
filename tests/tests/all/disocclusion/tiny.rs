//! Maps of 4 x 4 cells that hold two surfaces: a bit for each cell, set where the near one is.

use galpix_core::disocclusion::{self, Border, Reach, Tally};
use galpix_core::record::Component;
use galpix_core::stages::{clamp_velocity, snap, step_position, step_velocity};
use galpix_core::{Bits, Demand, Dynamic, Format, Galpixmap, Grid, Margin, Record, Rounding};
use galpix_tests::packed;

pub const SIDE: i32 = 4;
pub const CELLS: usize = 16;
const ALL: u16 = u16::MAX;

/// The cells of `mask` moved by some cells; what leaves the map is lost.
pub fn moved(mask: u16, by: [i32; 2]) -> u16 {
    let [dx, dy] = by;
    if dx.abs() >= SIDE || dy.abs() >= SIDE {
        return 0;
    }
    // Columns that stay in the map, in each of the four rows.
    let stay: u16 = (0..SIDE).filter(|x| (0..SIDE).contains(&(x + dx))).map(|x| 0x1111 << x).sum();
    let by = dx + SIDE * dy;
    if by >= 0 { (mask & stay) << by } else { (mask & stay) >> -by }
}

/// How a surface moves, in x and y, in stored numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct State {
    pub offset: [i32; 2],
    pub velocity: [i32; 2],
    pub acceleration: [i32; 2],
}

/// Returns a budget with this component in x and y.
pub fn bits(component: Component) -> Bits {
    let component = component.checked().unwrap();
    Bits::must(Bits::derive(Demand { extent: 4, recog: 1, prop: 4 })).with_xy(component, component)
}

/// A near and a far surface in a map.
pub struct Scene {
    pub format: Dynamic,
    pub near: State,
    pub far: State,
}

impl Scene {
    pub fn record(&self) -> &Record {
        self.format.record()
    }

    fn word(&self, state: State, depth: i64) -> u32 {
        let record = self.record();
        assert_eq!(record.words(), 1);
        let mut words = [0];
        packed::set(record.depth(), &mut words, depth);
        for (component, offset) in [record.offset_x(), record.offset_y()].into_iter().enumerate() {
            packed::set(offset, &mut words, state.offset[component].into());
            packed::set(record.velocity(component), &mut words, state.velocity[component].into());
            packed::set(record.acceleration(component), &mut words, state.acceleration[component].into());
        }
        words[0]
    }

    /// Returns the words of a near and of a far galpixel.
    pub fn words(&self) -> [u32; 2] {
        [self.word(self.near, 0), self.word(self.far, 2)]
    }

    /// Returns the cells that each surface has moved after each frame.
    pub fn paths(&self, rounding: Rounding, phase: u32, frames: u32) -> Vec<[[i32; 2]; 2]> {
        let [near, far] = [self.near, self.far].map(|state| {
            [0, 1].map(|component| {
                let scale = &self.record().scales[component];
                let (mut position, mut v, a) =
                    (state.offset[component], state.velocity[component], state.acceleration[component]);
                let mut path = Vec::new();
                for n in 0..frames {
                    position = step_position(scale, rounding.threshold(phase + n, scale.down), position, v, a);
                    v = clamp_velocity(scale, step_velocity(scale, v, a));
                    path.push(snap(scale, position));
                }
                path
            })
        });
        (0..frames as usize).map(|n| [[near[0][n], near[1][n]], [far[0][n], far[1][n]]]).collect()
    }
}

/// Memory for a map, and for its extents.
pub struct Memory {
    pub map: [u32; CELLS],
    pub extents: [u32; CELLS],
}

impl Memory {
    pub fn new() -> Self {
        Self { map: [0; CELLS], extents: [0x5a5a_5a5a; CELLS] }
    }

    /// The cells that the disocclusion map covers.
    #[expect(clippy::too_many_arguments, reason = "one case of the enumeration, in its own terms")]
    pub fn covered(
        &mut self,
        grid: Grid<'_>,
        format: Dynamic,
        words: [u32; 2],
        mask: u16,
        reach: &Reach,
    ) -> (u16, Tally) {
        for (cell, word) in self.map.iter_mut().enumerate() {
            *word = words[usize::from(mask >> cell & 1 == 0)];
        }
        let map = Galpixmap::over(grid, format, &mut self.map).unwrap();
        let tally = disocclusion::map(&map, &mut self.extents, reach);
        let covered = self.extents.iter().enumerate().map(|(cell, &word)| u16::from(word != 0) << cell).sum();
        (covered, tally)
    }
}

/// Runs `work` with the grid.
pub fn with_grid<R>(work: impl FnOnce(Grid<'_>) -> R) -> R {
    let mut starts = [0; SIDE as usize];
    work(Grid::new(SIDE as u32, SIDE as u32, Margin::NONE, &mut starts).unwrap())
}

/// What is uncovered after one frame: samples hidden behind the near surface that move like the far one, and that are
/// in the map, where no galpixel is.
///
/// `near` and `far`: cells moved. What moves over the border is left out where the map does not know it: unless what is
/// beyond is still and so is the far surface.
pub fn uncovered(mask: u16, [near, far]: [[i32; 2]; 2], border: Border) -> u16 {
    let relative = [near[0] - far[0], near[1] - far[1]];
    let shown = mask & moved(ALL, far.map(|cells| -cells));
    let within = shown & moved(!mask, relative);
    let from_beyond = shown & !moved(ALL, relative);
    within | if border == Border::Still && far == [0, 0] { from_beyond } else { 0 }
}
