//! Counts the instructions of a frame for pictures that ask for as little or as much as there is: in constant time they
//! must not depend on the picture.
//!
//! ```sh
//! cargo run --profile bench -p galpix-bench --bin constant_time             # 96x64
//! cargo run --profile bench -p galpix-bench --bin constant_time -- 320x240
//! ```
//!
//! Needs valgrind. The program runs itself under its callgrind, which counts what lies within [`counted_frame`]: one
//! frame with the richest fill mode, after another of the same picture that is not counted. Of several layers the base
//! shows the picture and the others those that come after it in the table. Prints a table; ends with 1 if the most
//! instructions are more than 1 % above the fewest in constant time, with 2 if it cannot count.

use std::hint::black_box;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};

use galpix_bench::pictures::Picture;
use galpix_bench::{Full, Shaded, Velocity565, at_run_time, grid};
use galpix_core::layers::{Layer, Layers, Stationary, composite_words};
use galpix_core::source::{Budget, Source, Sources, Visibility, link_words};
use galpix_core::stages;
use galpix_core::{Controller, Format, Galpixmap, Grid, Scratch, Settings, Static, Tally};

/// The most by which a picture may take more instructions than another, in parts of the fewest.
const MOST_SPREAD: f64 = 0.01;

/// The modes: whether a frame is made in constant time, and its name in tables.
const MODES: [(bool, &str); 2] = [(false, "data-dependent"), (true, "constant-time")];

/// What is counted, in this order, and each in the order of [`MODES`] and of [`Picture::ALL`].
const LAYOUTS: [&str; 10] = [
    "Full",
    "Velocity565",
    "Shaded",
    "Full, chosen at run time",
    "Full, a controller's frame after the first",
    "Full, a base alone, likewise",
    "Full, two layers",
    "Velocity565, two layers and a stationary-source one",
    "Full, stationary sources",
    "Velocity565, stationary sources",
];

/// What is done of rare things in a row of stationary sources: a sixteenth of all quads, and of all cells.
const fn budget(width: u32) -> Budget {
    Budget { quads: width >> 4, cracks: width >> 4 }
}

/// Runs a frame whose instructions callgrind counts. Must keep its name, and no generic parameters, for [`COUNTED`].
#[inline(never)]
fn counted_frame(frame: &mut dyn FnMut() -> Tally) -> Tally {
    frame()
}

/// [`counted_frame`] as callgrind calls it.
const COUNTED: &str = "constant_time::counted_frame";

/// Memory of a layer, or of a base: maps, winner map, edge map, composited and displacements.
struct Memory {
    maps: [Vec<u32>; 3],
    winners: Vec<u32>,
    edges: Vec<u32>,
    composited: Vec<u32>,
    displacements: Vec<u32>,
}

impl Memory {
    fn new(grid: &Grid<'_>, words: usize) -> Self {
        let cells = grid.cells() as usize;
        Self {
            maps: [0; 3].map(|word| vec![word; words]),
            winners: vec![0; cells],
            edges: vec![0; stages::words(grid)],
            composited: vec![0; composite_words(grid)],
            displacements: vec![0; cells],
        }
    }

    /// Returns a controller that shows a picture.
    fn base<'p, F: Format>(&'p mut self, grid: Grid<'p>, format: F, picture: Picture) -> Controller<'p, F> {
        let Self { maps: [front, back, _], winners, edges, .. } = self;
        let lay = |memory| Galpixmap::new(grid, format, memory).expect("memory enough");
        let mut front = lay(front);
        picture.paint(&mut front);
        Controller::new(front, lay(back), Scratch { winners, edges }).expect("memory enough")
    }

    /// Returns a layer that shows a picture.
    fn layer<'p, F: Format>(
        &'p mut self,
        grid: Grid<'p>,
        format: F,
        picture: Picture,
        stationary: bool,
    ) -> Layer<'p, F> {
        let Self { maps: [front, back, third], winners, edges, composited, displacements } = self;
        let lay = |memory| Galpixmap::new(grid, format, memory).expect("memory enough");
        let mut front = lay(front);
        picture.paint(&mut front);
        let layer = if stationary {
            Layer::stationary(Stationary { stored: front, displacements }, lay(back), lay(third), winners, composited)
        } else {
            Layer::new(front, lay(back), Scratch { winners, edges }, composited)
        };
        layer.expect("memory enough")
    }
}

/// Counts one frame of each picture in each mode, all of frame counter 1 and from the same map.
fn frames<F: Format>(width: u32, height: u32, format: F) {
    let grid = grid(width, height);
    let mut memory = Memory::new(&grid, Galpixmap::words(&grid, format));
    for (constant_time, _) in MODES {
        for picture in Picture::ALL {
            let Memory { maps: [front, back, _], winners, edges, .. } = &mut memory;
            picture.paint(&mut Galpixmap::new(grid, format, front).expect("memory enough"));
            for counted in [false, true] {
                let over = |memory| Galpixmap::over(grid, format, memory).expect("memory enough");
                let mut controller = Controller::new(over(&mut *front), over(&mut *back), Scratch { winners, edges })
                    .expect("maps of one grid");
                controller.set_frame(1);
                let settings = settings(controller.front());
                let mut frame = || stepped(&mut controller, &settings, constant_time);
                black_box(if counted { counted_frame(black_box(&mut frame)) } else { frame() });
            }
        }
    }
}

/// Makes the next frame in a mode.
fn stepped<F: Format>(controller: &mut Controller<'_, F>, settings: &Settings, constant_time: bool) -> Tally {
    if constant_time { controller.step_constant_time(settings) } else { controller.step(settings) }
}

fn settings<F: Format>(map: &Galpixmap<'_, F>) -> Settings {
    black_box(Settings::for_depth(map.record().depth().bits.into()))
}

/// Counts the second frame of each picture in each mode, of a controller.
fn alone<F: Format>(width: u32, height: u32, format: F) {
    let grid = grid(width, height);
    for (constant_time, _) in MODES {
        for picture in Picture::ALL {
            let mut memory = Memory::new(&grid, Galpixmap::words(&grid, format));
            let mut base = memory.base(grid, format, picture);
            let settings = settings(base.front());
            let mut frame = || stepped(&mut base, &settings, constant_time);
            black_box(frame());
            black_box(counted_frame(black_box(&mut frame)));
        }
    }
}

/// Counts the second frame of each picture in each mode, of stationary sources.
fn stationary<F: Format>(width: u32, height: u32, format: F) {
    let grid = grid(width, height);
    let cells = grid.cells() as usize;
    for (constant_time, _) in MODES {
        for picture in Picture::ALL {
            let (mut map, mut displacements) = (vec![0; Galpixmap::words(&grid, format)], vec![0; cells]);
            let (mut links, mut keys, mut words) = (vec![0; link_words(&grid)], vec![0; cells], vec![0; cells]);
            let mut line = vec![0; Visibility::line_half_words(&grid)];
            let mut map = Galpixmap::new(grid, format, &mut map).expect("memory enough");
            picture.paint(&mut map);
            let settings = settings(&map);
            let mut source = Source::new(map, &mut displacements, &mut links).expect("memory enough");
            source.begin(settings.edge_threshold);
            let visibility = Visibility::new(&grid, &mut keys, &mut words, &mut line).expect("memory enough");
            let mut layers = [source];
            let mut sources = Sources::new(&mut layers, visibility).expect("a layer");
            let budget = black_box(budget(width));
            let mut frame = || match constant_time {
                true => sources.step_constant_time(&settings, &budget).0,
                false => sources.step(&settings),
            };
            black_box(frame());
            black_box(counted_frame(black_box(&mut frame)));
        }
    }
}

/// Counts the second frame of each picture in each mode, of a base that shows it and of `hidden` layers that show the
/// pictures after it; the second of them is stationary.
fn layered<F: Format>(width: u32, height: u32, format: F, hidden: usize) {
    let grid = grid(width, height);
    let words = Galpixmap::words(&grid, format);
    for (constant_time, _) in MODES {
        for (index, picture) in Picture::ALL.into_iter().enumerate() {
            let mut memory = Memory::new(&grid, words);
            let mut memories: Vec<_> = (0..hidden).map(|_| Memory::new(&grid, words)).collect();
            let next = Picture::ALL.into_iter().cycle().skip(index + 1);
            let layers = memories.iter_mut().zip(next).enumerate();
            let mut layers: Vec<_> =
                layers.map(|(number, (memory, picture))| memory.layer(grid, format, picture, number == 1)).collect();
            let mut layers = Layers::new(memory.base(grid, format, picture), &mut layers).expect("one grid");
            let settings = settings(layers.front());
            let mut frame = || {
                if constant_time { layers.step_constant_time(&settings) } else { layers.step(&settings) }
            };
            black_box(frame());
            black_box(counted_frame(black_box(&mut frame)));
        }
    }
}

fn all_frames((width, height): (u32, u32)) {
    frames(width, height, Static::<Full>::new());
    frames(width, height, Static::<Velocity565>::new());
    frames(width, height, Static::<Shaded>::new());
    frames(width, height, at_run_time::<Full>());
    alone(width, height, Static::<Full>::new());
    layered(width, height, Static::<Full>::new(), 0);
    layered(width, height, Static::<Full>::new(), 1);
    layered(width, height, Static::<Velocity565>::new(), 2);
    stationary(width, height, Static::<Full>::new());
    stationary(width, height, Static::<Velocity565>::new());
}

/// Runs this program under callgrind: the instructions of each counted frame, in their order.
fn count(size: &str, folder: &Path) -> Result<Vec<u64>, String> {
    let program = std::env::current_exe().map_err(|error| format!("this program is not to be found: {error}"))?;
    let status = Command::new("valgrind")
        .arg("--tool=callgrind")
        .arg(format!("--toggle-collect={COUNTED}"))
        .arg(format!("--dump-after={COUNTED}"))
        .arg(format!("--callgrind-out-file={}", folder.join("out").display()))
        .arg(program)
        .args(["counted", size])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .map_err(|error| format!("valgrind cannot be started ({error}): install it, for example with apt-get"))?;
    if !status.success() {
        return Err(format!("under valgrind this program ended with {status}"));
    }
    let frames = LAYOUTS.len() * MODES.len() * Picture::ALL.len();
    (1..=frames)
        .map(|number| {
            let path = folder.join(format!("out.{number}"));
            let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
            let totals = text.lines().find_map(|line| line.strip_prefix("totals: "));
            totals
                .and_then(|count| count.trim().parse().ok())
                .filter(|&count| count > 0)
                .ok_or_else(|| format!("{}: callgrind counted nothing", path.display()))
        })
        .collect()
}

fn size(text: &str) -> Result<(u32, u32), String> {
    text.split_once('x')
        .and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)))
        .filter(|(width, height)| (1..=1024).contains(width) && (1..=1024).contains(height))
        .ok_or_else(|| format!("\"{text}\" is no size: give sides of 1 to 1024 cells, as in 96x64"))
}

/// Returns the table; whether each layout keeps within [`MOST_SPREAD`].
fn table(counts: &[u64], cells: u32) -> bool {
    let mut keeps = true;
    for (layout, counts) in LAYOUTS.iter().zip(counts.chunks(MODES.len() * Picture::ALL.len())) {
        println!("\n{layout}: instructions per cell\n{:<16} {:>14} {:>14}", "picture", MODES[0].1, MODES[1].1);
        let modes: Vec<_> = counts.chunks(Picture::ALL.len()).collect();
        for (index, picture) in Picture::ALL.iter().enumerate() {
            let [data_dependent, constant] = [0, 1].map(|mode| modes[mode][index] as f64 / f64::from(cells));
            println!("{:<16} {data_dependent:>14.2} {constant:>14.2}", picture.name());
        }
        let spread = |counts: &[u64]| {
            let (least, most) = counts.iter().fold((u64::MAX, 0), |(least, most), &n| (least.min(n), most.max(n)));
            (most - least) as f64 / least as f64
        };
        let [data_dependent, constant] = [0, 1].map(|mode| spread(modes[mode]));
        println!("{:<16} {:>13.1}% {:>13.4}%", "spread", 100.0 * data_dependent, 100.0 * constant);
        keeps &= constant <= MOST_SPREAD;
    }
    keeps
}

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
    let (counted, text) = match arguments[..] {
        [] => (false, "96x64"),
        [text] => (false, text),
        ["counted", text] => (true, text),
        _ => (false, ""),
    };
    let size = match size(text) {
        Ok(size) => size,
        Err(message) => {
            eprintln!("{message}");
            return ExitCode::from(2);
        }
    };
    if counted {
        all_frames(size);
        return ExitCode::SUCCESS;
    }
    let folder = std::env::temp_dir().join(format!("galpix-constant-time-{}", std::process::id()));
    let counts = std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()));
    let counts = counts.and_then(|()| count(text, &folder));
    let _ = std::fs::remove_dir_all(&folder);
    match counts {
        Ok(counts) => {
            println!("a frame of {text} with the fill mode extend, counted by callgrind");
            if table(&counts, size.0 * size.1) {
                return ExitCode::SUCCESS;
            }
            eprintln!("constant-time instructions depend on the picture by more than {} %", 100.0 * MOST_SPREAD);
            ExitCode::FAILURE
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}
