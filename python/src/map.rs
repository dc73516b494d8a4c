//! A galpixmap with memory of its own, and the frames that are made of it.

use galpix_core::disocclusion::{self, Reach};
use galpix_core::inpaint::{Inpainting, Motion, PushPull};
use galpix_core::scan_out::{Nearest, Sampling};
use galpix_core::sub_cell::SubCell;
use galpix_core::{
    Controller, Dynamic, Format, Galpixel, Galpixmap, Grid, Margin, Scratch, Settings, SetupError, Tally, stages,
};
use galpix_sim::engine::ScanOut;
use galpix_sim::engine::fill::Inpainter;
use numpy::{PyArray1, PyArray3, PyArrayMethods, PyReadonlyArrayDyn, PyReadwriteArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Floats, optional, slice};
use crate::bits::{BudgetWidths, LayoutFields, format};
use crate::names::{self, value_error};
use crate::update::UpdateArrays;

/// The counts of a frame, in the order of `galpix.Tally`.
pub type Counts = (u32, u32, u32, u32, u32, u32, u32, u32, u32, u32);

/// Returns counts as Python takes them.
pub const fn counts(tally: &Tally) -> Counts {
    let &Tally { moved, lost, collided, saturated, edges, holes, bullets, debris, galdebris, empty } = tally;
    (moved, lost, collided, saturated, edges, holes, bullets, debris, galdebris, empty)
}

/// How frames are made: attributes of an object of the package.
#[derive(FromPyObject)]
pub struct Making {
    rounding: String,
    fill: String,
    gamma: Option<String>,
    reach: u32,
    edge_threshold: Option<u32>,
    scan_out: String,
    constant_time: bool,
}

/// The size of a map: attributes of an object of the package.
#[derive(FromPyObject)]
pub struct Size {
    /// Rows and columns of the display.
    shape: (u32, u32),
    /// Columns left and right, rows above and below.
    margin: (u32, u32, u32, u32),
}

/// How a frame is inpainted: attributes of an object of the package.
#[derive(FromPyObject)]
pub struct Painting<'py> {
    gamma: String,
    threshold: u32,
    background: bool,
    motion: bool,
    /// Words of 32 cells each; none for all cells.
    mask: Option<PyReadonlyArrayDyn<'py, u32>>,
}

/// What a disocclusion map counts: attributes of an object of the package.
#[derive(FromPyObject)]
pub struct Uncovered {
    frames: u32,
    separation: Option<u32>,
    continues: bool,
    tears: bool,
    through: bool,
}

/// A word for each cell, and (edges, saturated, covered).
type Extents<'py> = (Bound<'py, PyArray1<u32>>, (u32, u32, u32));

/// Two maps, what a frame needs besides, and how frames are made.
#[pyclass(module = "galpix._galpix")]
pub struct Map {
    format: Dynamic,
    size: [u32; 2],
    margin: Margin,
    memory: Memory,
    frame: u32,
    settings: Settings,
    inpainter: Option<Inpainter>,
    scan_out: ScanOut,
    constant_time: bool,
}

#[derive(Default)]
struct Memory {
    starts: Vec<u32>,
    front: Vec<u32>,
    back: Vec<u32>,
    winners: Vec<u32>,
    edges: Vec<u32>,
}

type Frames<'m> = Controller<'m, Dynamic>;

impl Map {
    /// Lays a controller over the memory, lets it work, and keeps what it did.
    fn with<R>(&mut self, work: impl FnOnce(&mut Frames<'_>, &mut Option<Inpainter>) -> R) -> Result<R, SetupError> {
        let Memory { starts, front, back, winners, edges } = &mut self.memory;
        let grid = Grid::new(self.size[0], self.size[1], self.margin, starts)?;
        let mut controller = Controller::new(
            Galpixmap::over(grid, self.format, front)?,
            Galpixmap::over(grid, self.format, back)?,
            Scratch { winners, edges },
        )?;
        controller.set_frame(self.frame);
        let result = work(&mut controller, &mut self.inpainter);
        let made = controller.frame().wrapping_sub(self.frame);
        self.frame = controller.frame();
        // The controller swaps its maps with every frame.
        if made % 2 == 1 {
            std::mem::swap(front, back);
        }
        Ok(result)
    }

    /// Makes frames; `seen` gets each of them.
    fn steps(
        &mut self,
        frames: usize,
        mut seen: impl FnMut(usize, &Galpixmap<'_, Dynamic>),
    ) -> Result<Vec<Counts>, SetupError> {
        let (settings, constant_time) = (self.settings, self.constant_time);
        self.with(|controller, inpainter| {
            let frame = |number: usize| {
                let tally = match constant_time {
                    true => controller.step_constant_time(&settings),
                    false => controller.step(&settings),
                };
                if let Some(inpainter) = inpainter {
                    inpainter.paint(controller, &settings);
                }
                seen(number, controller.front());
                counts(&tally)
            };
            (0..frames).map(frame).collect()
        })
    }

    const fn display(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// Rows and columns, margin included.
    const fn cells(&self) -> [usize; 2] {
        let Margin { left, right, top, bottom } = self.margin;
        [(self.size[1] + top + bottom) as usize, (self.size[0] + left + right) as usize]
    }
}

/// Writes what the display shows of a map, 3 bytes a pixel.
fn show(map: &Galpixmap<'_, Dynamic>, scan_out: ScanOut, edge_threshold: u32, to: &mut [u8]) {
    match scan_out {
        ScanOut::Nearest => rows(Nearest, map, to),
        ScanOut::SubCell => rows(SubCell { edge_threshold }, map, to),
    }
}

fn rows(sampling: impl Sampling, map: &Galpixmap<'_, Dynamic>, to: &mut [u8]) {
    let (width, colour) = (map.grid().display_width(), *map.record().colour_format());
    for (y, row) in (0..).zip(to.chunks_exact_mut(3 * width as usize)) {
        for (pixel, word) in row.as_chunks_mut().0.iter_mut().zip(sampling.span(map, y, 0, width)) {
            *pixel = colour.to_rgb888(word);
        }
    }
}

#[pymethods]
impl Map {
    #[new]
    fn new(budget: BudgetWidths, layout: LayoutFields, size: Size, making: Making) -> PyResult<Self> {
        let format = format(&budget, &layout)?;
        let (rows, columns) = size.shape;
        let (left, right, top, bottom) = size.margin;
        let margin = Margin { left, right, top, bottom };
        let fill = names::fill(&making.fill, making.gamma.as_deref())?;
        let usual = Settings::for_depth(u32::from(format.record().depth().bits));
        let settings = Settings {
            rounding: names::rounding(&making.rounding)?,
            fill_mode: fill.mode(),
            edge_threshold: making.edge_threshold.unwrap_or(usual.edge_threshold),
            reach: making.reach,
        };
        let mut memory = Memory::default();
        memory.starts.resize(Grid::rows(rows, margin).min(1 << 16), 0);
        let grid = Grid::new(columns, rows, margin, &mut memory.starts).map_err(value_error)?;
        let words = Galpixmap::<Dynamic>::words(&grid, format);
        memory.winners = vec![0; grid.cells() as usize];
        memory.edges = vec![0; stages::words(&grid)];
        let inpainter = fill.inpaint().map(|inpaint| Inpainter::new(&grid, inpaint));
        (memory.front, memory.back) = (vec![0; words], vec![0; words]);
        Galpixmap::new(grid, format, &mut memory.front).map_err(value_error)?;
        let scan_out = names::scan_out(&making.scan_out)?;
        let constant_time = making.constant_time;
        Ok(Self {
            format,
            size: [columns, rows],
            margin,
            memory,
            frame: 0,
            settings,
            inpainter,
            scan_out,
            constant_time,
        })
    }

    /// Replaces all galpixels and sets the frame counter to 0; returns how many fields were clamped, and how many cells
    /// are empty.
    #[pyo3(signature = (update, offset=None))]
    fn load(&mut self, py: Python<'_>, update: UpdateArrays<'_>, offset: Option<Floats<'_>>) -> PyResult<(u32, u32)> {
        let [height, width] = self.cells();
        if update.shape != (height, width) {
            return Err(value_error(format!("arrays of {:?} for a map of ({height}, {width}) cells", update.shape)));
        }
        let cells = update.cells()?;
        let offset = optional(offset.as_ref(), 2 * cells.len())?;
        self.frame = 0;
        let loaded = py.detach(|| {
            self.with(|controller, _| {
                let (mut saturated, mut empty) = (0, 0);
                for cell in 0..cells.len() {
                    let sample = cells.sample(cell);
                    let galpixel = galpix_sim::engine::galpixel(&sample);
                    empty += u32::from(galpixel.class == galpix_core::Class::Empty);
                    let offset = offset.map_or([0.0; 2], |offset| [offset.at(2 * cell), offset.at(2 * cell + 1)]);
                    let offset = offset.map(fixed::types::I32F32::saturating_from_num);
                    let galpixel = Galpixel { tag: cells.tag(cell), offset, ..galpixel };
                    let (x, y) = ((cell % width) as i32, (cell / width) as i32);
                    saturated += controller.front_mut().store(x, y, &galpixel).unwrap_or(0);
                }
                (saturated, empty)
            })
        });
        loaded.map_err(value_error)
    }

    /// Makes a frame; returns its counts.
    fn step(&mut self, py: Python<'_>) -> PyResult<Counts> {
        let made = py.detach(|| self.steps(1, |_, _| ()));
        Ok(made.map_err(value_error)?[0])
    }

    /// Makes frames that are not shown; returns their counts.
    fn skip(&mut self, py: Python<'_>, frames: usize) -> PyResult<Vec<Counts>> {
        let made = py.detach(|| self.steps(frames, |_, _| ()));
        made.map_err(value_error)
    }

    /// Makes as many frames as fit into `out`, and writes what the display shows of each; returns their counts.
    fn run(&mut self, py: Python<'_>, mut out: PyReadwriteArrayDyn<'_, u8>) -> PyResult<Vec<Counts>> {
        let bytes = out.as_slice_mut()?;
        let (size, scan_out, threshold) = (3 * self.display(), self.scan_out, self.settings.edge_threshold);
        let made = py.detach(|| {
            let frames = bytes.len() / size;
            self.steps(frames, |number, map| show(map, scan_out, threshold, &mut bytes[number * size..][..size]))
        });
        made.map_err(value_error)
    }

    /// Writes what the display shows into `out`.
    fn show(&mut self, py: Python<'_>, mut out: PyReadwriteArrayDyn<'_, u8>) -> PyResult<()> {
        let bytes = out.as_slice_mut()?;
        if bytes.len() != 3 * self.display() {
            return Err(value_error("`out` is not of the display's size"));
        }
        let (scan_out, threshold) = (self.scan_out, self.settings.edge_threshold);
        let shown = py.detach(|| self.with(|controller, _| show(controller.front(), scan_out, threshold, bytes)));
        shown.map_err(value_error)
    }

    /// Inpaints what the last step uncovered; returns the number of cells.
    fn inpaint(&mut self, py: Python<'_>, painting: Painting<'_>) -> PyResult<u32> {
        let gamma = names::gamma(&painting.gamma)?;
        let mask = painting.mask.as_ref().map(|mask| mask.as_slice()).transpose()?.unwrap_or_default();
        let Painting { threshold, background: quads, .. } = painting;
        let motion = if painting.motion { Motion::Inpainted } else { Motion::Kept };
        let [height, width] = self.cells().map(|side| side as u32);
        let settings = self.settings;
        let painted = py.detach(|| {
            let mut words = vec![0; PushPull::words(width, height, motion)];
            let mut push_pull = PushPull::new(width, height, motion, &mut words)?;
            let inpainting = Inpainting { gamma, threshold, quads, mask };
            self.with(|controller, _| controller.inpaint(&settings, &inpainting, &mut push_pull))
        });
        painted.map_err(value_error)
    }

    /// Returns the disocclusion map: a word for each cell, and (edges, saturated, covered).
    fn disocclusion<'py>(&mut self, py: Python<'py>, uncovered: Uncovered) -> PyResult<Extents<'py>> {
        let Uncovered { frames, separation, continues, tears, through } = uncovered;
        let border = if continues { disocclusion::Border::Continues } else { disocclusion::Border::Still };
        let usual = Reach::new(frames, u32::from(self.format.record().depth().bits));
        let separation = separation.unwrap_or(usual.separation);
        let reach = Reach { separation, border, tears, through, ..usual };
        let [height, width] = self.cells();
        let mut extents = vec![0; height * width];
        let tally =
            py.detach(|| self.with(|controller, _| disocclusion::map(controller.front(), &mut extents, &reach)));
        let disocclusion::Tally { edges, saturated, covered } = tally.map_err(value_error)?;
        Ok((PyArray1::from_vec(py, extents), (edges, saturated, covered)))
    }

    /// Returns the words of the map that is shown, plane by plane.
    fn words<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<u32>>> {
        let [height, width] = self.cells();
        let planes = self.format.record().words();
        PyArray1::from_slice(py, &self.memory.front).reshape([planes, height, width])
    }

    /// Replaces the words of the map that is shown.
    fn set_words(&mut self, words: PyReadonlyArrayDyn<'_, u32>) -> PyResult<()> {
        let count = self.memory.front.len();
        self.memory.front.copy_from_slice(slice(&words, count)?);
        Ok(())
    }

    /// Returns the bits of the edge map that the last step made, 32 cells a word.
    fn edges<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_slice(py, &self.memory.edges)
    }

    /// Returns all galpixels as arrays, by their names.
    fn galpixels<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let [height, width] = self.cells();
        let read = py.detach(|| {
            self.with(|controller, _| {
                let place = |cell: usize| ((cell % width) as i32, (cell / width) as i32);
                let galpixel = |cell: usize| {
                    let (x, y) = place(cell);
                    controller.front().load(x, y).unwrap_or_default()
                };
                (0..height * width).map(galpixel).collect::<Vec<Galpixel>>()
            })
        });
        let all = read.map_err(value_error)?;
        let dict = PyDict::new(py);
        let class: Vec<u8> = all.iter().map(|galpixel| galpixel.class as u8).collect();
        dict.set_item("class", PyArray1::from_vec(py, class).reshape([height, width])?)?;
        let colour: Vec<u8> = all.iter().flat_map(|galpixel| galpixel.colour).collect();
        dict.set_item("colour", PyArray1::from_vec(py, colour).reshape([height, width, 3])?)?;
        let tag: Vec<u32> = all.iter().map(|galpixel| galpixel.tag).collect();
        dict.set_item("tag", PyArray1::from_vec(py, tag).reshape([height, width])?)?;
        let flat = |value: &dyn Fn(&Galpixel) -> Vec<fixed::types::I32F32>| {
            let numbers: Vec<f64> = all.iter().flat_map(value).map(|number| number.to_num()).collect();
            PyArray1::from_vec(py, numbers)
        };
        dict.set_item("depth", flat(&|galpixel| vec![galpixel.depth]).reshape([height, width])?)?;
        dict.set_item("offset", flat(&|galpixel| galpixel.offset.to_vec()).reshape([height, width, 2])?)?;
        dict.set_item("velocity", flat(&|galpixel| galpixel.velocity.to_vec()).reshape([height, width, 3])?)?;
        dict.set_item("acceleration", flat(&|galpixel| galpixel.acceleration.to_vec()).reshape([height, width, 3])?)?;
        let rate = flat(&|galpixel| vec![galpixel.luminosity_rate]).reshape([height, width])?;
        dict.set_item("luminosity_rate", rate)?;
        Ok(dict)
    }

    /// The frames since the update.
    #[getter]
    const fn frame(&self) -> u32 {
        self.frame
    }

    #[setter]
    const fn set_frame(&mut self, frame: u32) {
        self.frame = frame;
    }

    /// The edge threshold in use, in units of the depth's last bit.
    #[getter]
    const fn edge_threshold(&self) -> u32 {
        self.settings.edge_threshold
    }

    /// Bytes of a galpixel.
    #[getter]
    fn bytes_per_galpixel(&self) -> usize {
        self.format.record().bytes()
    }
}
