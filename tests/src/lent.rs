//! Memory for maps: owned here, lent to the engine for the time of a closure.

use galpix_core::edge;
use galpix_core::frame::{Controller, Scratch, Settings};
use galpix_core::galpixel::Budget;
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::{Grid, Wings};
use galpix_core::layout::Layout;
use galpix_core::tally::Tally;

/// Columns and rows of a display, and what its maps have beyond it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Columns of the display.
    pub width: u32,
    /// Rows of the display.
    pub height: u32,
    /// Columns and rows beyond it.
    pub wings: Wings,
}

impl Shape {
    /// A map without wings.
    #[must_use]
    pub const fn plain(width: u32, height: u32) -> Self {
        Self { width, height, wings: Wings::NONE }
    }

    /// Cells, wings included.
    #[must_use]
    pub const fn cells(self) -> u32 {
        Grid::cells_for(self.width, self.height, self.wings)
    }

    /// Columns, wings included.
    #[must_use]
    pub const fn columns(self) -> u32 {
        self.width + self.wings.left + self.wings.right
    }

    /// Rows, wings included.
    #[must_use]
    pub const fn rows(self) -> u32 {
        self.height + self.wings.top + self.wings.bottom
    }
}

/// What memory holds before a map is laid over it: bits that no map has left there.
const STALE: u32 = 0xa5a5_a5a5;

/// Lends two maps over one grid: the first holds `content` (any words), or is empty; the second holds stale words.
///
/// Panics if the maps cannot be set up.
pub fn with_maps<L: Layout, B: Budget<L>, R>(
    shape: Shape,
    budget: B,
    content: Option<&[u32]>,
    work: impl for<'p> FnOnce(Galpixmap<'p, L, B>, Galpixmap<'p, L, B>) -> R,
) -> R {
    let mut starts = vec![STALE; Grid::rows(shape.height, shape.wings)];
    let grid = Grid::new(shape.width, shape.height, shape.wings, &mut starts).unwrap();
    let words = Galpixmap::<L, B>::words(&grid, budget);
    let mut front = content.map_or_else(|| vec![STALE; words], <[u32]>::to_vec);
    let mut back = vec![STALE; words];
    let front = match content {
        Some(_) => Galpixmap::over(grid, budget, &mut front),
        None => Galpixmap::new(grid, budget, &mut front),
    };
    work(front.unwrap(), Galpixmap::over(grid, budget, &mut back).unwrap())
}

/// Lends a controller with all the scratch memory that any rung needs. `content` as in [`with_maps`].
///
/// Panics if the maps cannot be set up.
pub fn with_controller<L: Layout, B: Budget<L>, R>(
    shape: Shape,
    budget: B,
    content: Option<&[u32]>,
    work: impl for<'p> FnOnce(&mut Controller<'p, L, B>) -> R,
) -> R {
    let mut winners = vec![STALE; shape.cells() as usize];
    let mut edges = vec![STALE; shape.cells().div_ceil(32) as usize];
    with_maps(shape, budget, content, |front, back| {
        assert_eq!(edges.len(), edge::words(front.grid()));
        let scratch = Scratch { winners: &mut winners, edges: &mut edges };
        work(&mut Controller::new(front, back, scratch).unwrap())
    })
}

/// All planes of a map, one after the other.
#[must_use]
pub fn words<L: Layout, B: Budget<L>>(map: &Galpixmap<'_, L, B>) -> Vec<u32> {
    (0..).map_while(|word| map.plane(word)).flatten().copied().collect()
}

/// The words of one cell.
#[must_use]
pub fn cell_words<L: Layout, B: Budget<L>>(map: &Galpixmap<'_, L, B>, cell: u32) -> Vec<u32> {
    (0..).map_while(|word| map.plane(word)).map(|plane| plane[cell as usize]).collect()
}

/// Everything that a frame leaves behind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trace {
    /// What it counted.
    pub tally: Tally,
    /// All planes of the new map.
    pub words: Vec<u32>,
    /// Who won each cell.
    pub winners: Vec<u32>,
    /// The edge map of the map before.
    pub edges: Vec<u32>,
}

impl Trace {
    /// What the last step of a controller left behind.
    #[must_use]
    pub fn of<L: Layout, B: Budget<L>>(controller: &Controller<'_, L, B>, tally: Tally) -> Self {
        Self {
            tally,
            words: words(controller.front()),
            winners: controller.winners().to_vec(),
            edges: controller.edges().to_vec(),
        }
    }

    /// Panics with `what` and the first thing that differs.
    pub fn assert_same(&self, other: &Self, what: &str) {
        assert_eq!(self.tally, other.tally, "{what}: tallies differ");
        for (name, a, b) in [
            ("words", &self.words, &other.words),
            ("winners", &self.winners, &other.winners),
            ("edges", &self.edges, &other.edges),
        ] {
            assert_eq!(a.len(), b.len(), "{what}: {name}");
            if let Some(index) = a.iter().zip(b).position(|(a, b)| a != b) {
                panic!("{what}: {name} differ from index {index} on: {:#010x} and {:#010x}", a[index], b[index]);
            }
        }
    }
}

/// What each of `frames` frames leaves behind, from a map that holds `content`.
///
/// Panics if the maps cannot be set up.
#[must_use]
pub fn traces<L: Layout, B: Budget<L>>(
    shape: Shape,
    budget: B,
    content: &[u32],
    settings: &Settings,
    frames: u32,
) -> Vec<Trace> {
    with_controller::<L, B, _>(shape, budget, Some(content), |controller| {
        (0..frames)
            .map(|_| {
                let tally = controller.step(settings);
                Trace::of(controller, tally)
            })
            .collect()
    })
}
