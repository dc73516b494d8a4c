//! Memory for maps: owned here, borrowed by the engine while a closure runs.

use galpix_core::layers::Layers;
use galpix_core::rolling::Rolling;
use galpix_core::stages;
use galpix_core::{Controller, Format, Galpixmap, Grid, Margin, Scratch, Settings, Tally};

/// Columns and rows of a display, and what its maps have beyond it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Columns of the display.
    pub width: u32,
    /// Rows of the display.
    pub height: u32,
    /// Columns and rows beyond it.
    pub margin: Margin,
}

impl Shape {
    /// Creates a map without margin.
    #[must_use]
    pub const fn plain(width: u32, height: u32) -> Self {
        Self::new(width, height, [0; 4])
    }

    /// A map with a margin: columns on the left and on the right, rows above and below.
    #[must_use]
    pub const fn new(width: u32, height: u32, [left, right, top, bottom]: [u32; 4]) -> Self {
        Self { width, height, margin: Margin { left, right, top, bottom } }
    }

    /// Returns the cells, margin included.
    #[must_use]
    pub const fn cells(self) -> u32 {
        Grid::cells_for(self.width, self.height, self.margin)
    }

    /// Returns the columns, margin included.
    #[must_use]
    pub const fn columns(self) -> u32 {
        self.width + self.margin.left + self.margin.right
    }

    /// Returns the rows, margin included.
    #[must_use]
    pub const fn rows(self) -> u32 {
        self.height + self.margin.top + self.margin.bottom
    }
}

/// What memory holds before a map is laid over it: bits that no map has left there.
const STALE: u32 = 0xa5a5_a5a5;

/// Runs a closure with two maps over one grid: the first holds `content` (any words), or is empty; the second holds
/// stale words.
///
/// Panics if the maps cannot be set up.
pub fn with_maps<F: Format, R>(
    shape: Shape,
    format: F,
    content: Option<&[u32]>,
    work: impl for<'p> FnOnce(Galpixmap<'p, F>, Galpixmap<'p, F>) -> R,
) -> R {
    let mut starts = vec![STALE; Grid::rows(shape.height, shape.margin)];
    let grid = Grid::new(shape.width, shape.height, shape.margin, &mut starts).unwrap();
    let words = Galpixmap::words(&grid, format);
    let mut front = content.map_or_else(|| vec![STALE; words], <[u32]>::to_vec);
    let mut back = vec![STALE; words];
    let front = match content {
        Some(_) => Galpixmap::over(grid, format, &mut front),
        None => Galpixmap::new(grid, format, &mut front),
    };
    work(front.unwrap(), Galpixmap::over(grid, format, &mut back).unwrap())
}

/// Which scratch buffers a controller gets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Buffers {
    /// A winner map and an edge map.
    Both,
    /// A winner map.
    Winners,
    /// An edge map.
    Edges,
    /// None.
    Neither,
}

/// Runs a closure with a controller with some scratch memory. `content` as in [`with_maps`].
///
/// Panics if the maps cannot be set up.
pub fn with_scratch<F: Format, R>(
    shape: Shape,
    format: F,
    content: Option<&[u32]>,
    buffers: Buffers,
    work: impl for<'p> FnOnce(&mut Controller<'p, F>) -> R,
) -> R {
    let (winners, edges) = match buffers {
        Buffers::Both => (true, true),
        Buffers::Winners => (true, false),
        Buffers::Edges => (false, true),
        Buffers::Neither => (false, false),
    };
    let mut winners = vec![STALE; if winners { shape.cells() as usize } else { 0 }];
    let mut edges = vec![STALE; if edges { shape.cells().div_ceil(32) as usize } else { 0 }];
    with_maps(shape, format, content, |front, back| {
        assert!(edges.is_empty() || edges.len() == stages::words(front.grid()));
        let scratch = Scratch { winners: &mut winners, edges: &mut edges };
        work(&mut Controller::new(front, back, scratch).unwrap())
    })
}

/// Runs a closure with a controller with all the scratch memory that any fill mode needs. `content` as in
/// [`with_maps`].
///
/// Panics if the maps cannot be set up.
pub fn with_controller<F: Format, R>(
    shape: Shape,
    format: F,
    content: Option<&[u32]>,
    work: impl for<'p> FnOnce(&mut Controller<'p, F>) -> R,
) -> R {
    with_scratch(shape, format, content, Buffers::Both, work)
}

/// Runs a closure with a map that holds `content` and is propagated in place, with a window of `rows` rows.
///
/// Panics if it cannot be set up.
pub fn with_rolling<F: Format, R>(
    shape: Shape,
    format: F,
    content: &[u32],
    rows: u32,
    work: impl for<'p> FnOnce(&mut Rolling<'p, F>) -> R,
) -> R {
    let (mut starts, mut turns) = (vec![STALE; shape.rows() as usize], vec![STALE; shape.rows() as usize]);
    let grid = Grid::new(shape.width, shape.height, shape.margin, &mut starts).unwrap();
    let window = Grid::window(&grid, rows, &mut turns).unwrap();
    assert_eq!(window.cells(), rows.min(shape.rows()) * shape.columns());
    let (mut memory, mut few) = (content.to_vec(), vec![STALE; Galpixmap::words(&window, format)]);
    let (mut winners, mut edges) = (vec![STALE; window.cells() as usize], vec![STALE; stages::words(&grid)]);
    let rolling = Rolling::new(
        Galpixmap::over(grid, format, &mut memory).unwrap(),
        Galpixmap::over(window, format, &mut few).unwrap(),
        Scratch { winners: &mut winners, edges: &mut edges },
    );
    work(&mut rolling.unwrap())
}

/// The two entry points of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// What the picture does not need is skipped.
    Step,
    /// Instructions that do not depend on the picture.
    ConstantTime,
}

impl Mode {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Step, Self::ConstantTime];

    /// Makes the next frame of a controller.
    pub fn step<F: Format>(self, controller: &mut Controller<'_, F>, settings: &Settings) -> Tally {
        match self {
            Self::Step => controller.step(settings),
            Self::ConstantTime => controller.step_constant_time(settings),
        }
    }

    /// Makes the next frame of some layers.
    pub fn step_layers<F: Format>(self, layers: &mut Layers<'_, '_, F>, settings: &Settings) -> Tally {
        match self {
            Self::Step => layers.step(settings),
            Self::ConstantTime => layers.step_constant_time(settings),
        }
    }
}

/// Returns all planes of a map, one after the other.
#[must_use]
pub fn words<F: Format>(map: &Galpixmap<'_, F>) -> Vec<u32> {
    (0..).map_while(|word| map.plane(word)).flatten().copied().collect()
}

/// Returns the words of one cell.
#[must_use]
pub fn cell_words<F: Format>(map: &Galpixmap<'_, F>, cell: u32) -> Vec<u32> {
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
    /// Returns what the last step of a controller left behind.
    #[must_use]
    pub fn of<F: Format>(controller: &Controller<'_, F>, tally: Tally) -> Self {
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

/// How some frames are made.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// What each frame is made with.
    pub settings: Settings,
    /// The entry point.
    pub mode: Mode,
    /// The scratch memory.
    pub buffers: Buffers,
    /// The frame counter of the map to begin with.
    pub first: u32,
    /// How many frames.
    pub frames: u32,
}

impl Run {
    /// [`Mode::Step`] with all scratch memory, from frame 0 on.
    #[must_use]
    pub const fn new(settings: Settings, frames: u32) -> Self {
        Self { settings, mode: Mode::Step, buffers: Buffers::Both, first: 0, frames }
    }

    /// Returns the same by another entry point.
    #[must_use]
    pub const fn by(self, mode: Mode) -> Self {
        Self { mode, ..self }
    }

    /// Returns what each frame leaves behind, from a map that holds `content`.
    ///
    /// Panics if the maps cannot be set up.
    #[must_use]
    pub fn traces<F: Format>(&self, shape: Shape, format: F, content: &[u32]) -> Vec<Trace> {
        with_scratch(shape, format, Some(content), self.buffers, |controller| {
            controller.set_frame(self.first);
            let trace = |_| {
                let tally = self.mode.step(controller, &self.settings);
                Trace::of(controller, tally)
            };
            (0..self.frames).map(trace).collect()
        })
    }
}

/// Panics with `what` and the first frame and thing that differs.
pub fn assert_same(one: &[Trace], other: &[Trace], what: &str) {
    assert_eq!(one.len(), other.len(), "{what}");
    for (n, (one, other)) in (1..).zip(one.iter().zip(other)) {
        one.assert_same(other, &format!("{what}, frame {n}"));
    }
}
