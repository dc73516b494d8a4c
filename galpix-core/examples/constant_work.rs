//! Counts the instructions of a frame for pictures that ask for as little or as much as there is: in the mode of constant
//! work they must not depend on the picture.
//!
//! ```sh
//! cargo run --release -p galpix-core --example constant_work             # 96x64
//! cargo run --release -p galpix-core --example constant_work -- 320x240
//! ```
//!
//! Needs valgrind. The program runs itself under its callgrind, which counts what lies within [`counted_frame`]: one frame
//! with the richest rung, after another of the same picture that is not counted. Of several layers the base shows the picture
//! and the others those that come after it in the table. Prints a table; ends with 1 if the most
//! instructions are more than 1 % above the fewest in the mode of constant work, with 2 if it cannot count.

#[path = "../benches/common/pictures.rs"]
mod pictures;

use std::hint::black_box;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};

use galpix_core::budget::{Bits, Demand};
use galpix_core::edge;
use galpix_core::frame::{Controller, Scratch, Settings, Work, step};
use galpix_core::galpixel::{Budget, Chosen, Profile, Static};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::{Grid, Wings};
use galpix_core::layers::{Layer, Layers, seat_words};
use galpix_core::layout::{Full, Layout, Shaded, Velocity565};
use galpix_core::tally::Tally;
use pictures::Picture;

/// The most by which a picture may take more instructions than another, in parts of the fewest.
const MOST_SPREAD: f64 = 0.01;

/// Up to 1024 pixels a side, recognition in 8 frames, an update every 16.
const DEMAND: Demand = Demand { extent: 1024, recog: 8, prop: 16 };

struct Panel;

impl Profile for Panel {
    const BITS: Bits = Bits::must(Bits::derive(DEMAND));
}

struct PanelVelocity;

impl Profile for PanelVelocity {
    const BITS: Bits = Bits::must(Bits::derive_without_acceleration(DEMAND));
}

/// What is counted, in this order, and each in the order of [`Work::ALL`] and of [`Picture::ALL`].
const LAYOUTS: [&str; 8] = [
    "Full",
    "Velocity565",
    "Shaded",
    "Full, chosen at run time",
    "Full, a controller's frame after the first",
    "Full, a base alone, likewise",
    "Full, two layers",
    "Velocity565, two layers and an anchored one",
];

/// Runs a frame whose instructions callgrind counts. Must keep its name, and no generic parameters, for [`COUNTED`].
#[inline(never)]
fn counted_frame(frame: &mut dyn FnMut() -> Tally) -> Tally {
    frame()
}

/// [`counted_frame`] as callgrind calls it.
const COUNTED: &str = "constant_work::counted_frame";

/// One counted frame of each picture in each mode.
fn frames<L: Layout, B: Budget<L>>(width: u32, height: u32, budget: B) {
    let mut starts = vec![0; Grid::rows(height, Wings::NONE)];
    let grid = Grid::new(width, height, Wings::NONE, &mut starts).expect("a size that can be laid out");
    let words = Galpixmap::<L, B>::words(&grid, budget);
    let (mut front, mut back) = (vec![0; words], vec![0; words]);
    let (mut winners, mut edges) = (vec![0; grid.cells() as usize], vec![0; edge::words(&grid)]);
    let mut scratch = Scratch { winners: &mut winners, edges: &mut edges };
    let mut front = Galpixmap::<L, B>::new(grid, budget, &mut front).expect("memory enough");
    let mut back = Galpixmap::<L, B>::new(grid, budget, &mut back).expect("memory enough");
    for work in Work::ALL {
        let settings = Settings { work, ..Settings::for_depth(front.record().depth().bits.into()) };
        for picture in Picture::ALL {
            picture.paint(&mut front);
            let mut frame = || step(&front, &mut back, &mut scratch, black_box(&settings), 1);
            black_box(frame());
            black_box(counted_frame(black_box(&mut frame)));
        }
    }
}

/// Memory of a layer, or of a base: maps, winner map, edge map, seats and displacements.
struct Memory {
    maps: [Vec<u32>; 3],
    winners: Vec<u32>,
    edges: Vec<u32>,
    seats: Vec<u32>,
    displacements: Vec<u32>,
}

impl Memory {
    fn new(grid: &Grid<'_>, words: usize) -> Self {
        let cells = grid.cells() as usize;
        Self {
            maps: [0; 3].map(|word| vec![word; words]),
            winners: vec![0; cells],
            edges: vec![0; edge::words(grid)],
            seats: vec![0; seat_words(grid)],
            displacements: vec![0; cells],
        }
    }
}

/// One counted frame of each picture in each mode, of a base that shows it and of `HIDDEN` layers that show the pictures after
/// it; the last of two layers or more is anchored. Without any other layer `bare` does without [`Layers`].
fn layered<L: Layout, B: Budget<L>, const HIDDEN: usize>(width: u32, height: u32, budget: B, bare: bool) {
    let mut starts = vec![0; Grid::rows(height, Wings::NONE)];
    let grid = Grid::new(width, height, Wings::NONE, &mut starts).expect("a size that can be laid out");
    let words = Galpixmap::<L, B>::words(&grid, budget);
    for work in Work::ALL {
        for (index, picture) in Picture::ALL.into_iter().enumerate() {
            let lay = |memory| Galpixmap::<L, B>::new(grid, budget, memory).expect("memory enough");
            let mut memory = Memory::new(&grid, words);
            let Memory { maps: [front, back, _], winners, edges, .. } = &mut memory;
            let mut front = lay(front);
            let settings = Settings { work, ..Settings::for_depth(front.record().depth().bits.into()) };
            picture.paint(&mut front);
            let base = Controller::new(front, lay(back), Scratch { winners, edges }).expect("memory enough");
            let mut memories: [Memory; HIDDEN] = std::array::from_fn(|_| Memory::new(&grid, words));
            let mut next = Picture::ALL.into_iter().cycle().skip(index + 1);
            let mut number = 0;
            let hidden = memories.each_mut().map(|memory| {
                let Memory { maps: [front, back, third], winners, edges, seats, displacements } = memory;
                let (mut front, back) = (lay(front), lay(back));
                next.next().unwrap_or(picture).paint(&mut front);
                number += 1;
                let layer = if number == 2 {
                    Layer::anchored(front, displacements, back, lay(third), winners, seats)
                } else {
                    Layer::new(front, back, Scratch { winners, edges }, seats)
                };
                layer.expect("memory enough")
            });
            if bare {
                let mut base = base;
                let mut frame = || base.step(black_box(&settings));
                black_box(frame());
                black_box(counted_frame(black_box(&mut frame)));
            } else {
                let mut layers = Layers::new(base, hidden).expect("one grid");
                let mut frame = || black_box(layers.step(black_box(&settings))).base;
                black_box(frame());
                black_box(counted_frame(black_box(&mut frame)));
            }
        }
    }
}

fn all_frames((width, height): (u32, u32)) {
    frames::<Full, _>(width, height, Static::<Panel>::new());
    frames::<Velocity565, _>(width, height, Static::<PanelVelocity>::new());
    frames::<Shaded, _>(width, height, Static::<Panel>::new());
    frames::<Full, _>(width, height, Chosen::new(black_box(Panel::BITS)).expect("the budget of the static maps"));
    layered::<Full, _, 0>(width, height, Static::<Panel>::new(), true);
    layered::<Full, _, 0>(width, height, Static::<Panel>::new(), false);
    layered::<Full, _, 1>(width, height, Static::<Panel>::new(), false);
    layered::<Velocity565, _, 2>(width, height, Static::<PanelVelocity>::new(), false);
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
    let frames = LAYOUTS.len() * Work::ALL.len() * Picture::ALL.len();
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

/// The table; whether each layout keeps within [`MOST_SPREAD`].
fn table(counts: &[u64], cells: u32) -> bool {
    let mut keeps = true;
    for (layout, counts) in LAYOUTS.iter().zip(counts.chunks(Work::ALL.len() * Picture::ALL.len())) {
        println!(
            "\n{layout}: instructions a cell\n{:<16} {:>10} {:>10}",
            "picture",
            Work::ALL[0].name(),
            Work::ALL[1].name()
        );
        let modes: Vec<_> = counts.chunks(Picture::ALL.len()).collect();
        for (index, picture) in Picture::ALL.iter().enumerate() {
            let [skipping, constant] = [0, 1].map(|mode| modes[mode][index] as f64 / f64::from(cells));
            println!("{:<16} {skipping:>10.2} {constant:>10.2}", picture.name());
        }
        let spread = |counts: &[u64]| {
            let (least, most) = counts.iter().fold((u64::MAX, 0), |(least, most), &n| (least.min(n), most.max(n)));
            (most - least) as f64 / least as f64
        };
        let [skipping, constant] = [0, 1].map(|mode| spread(modes[mode]));
        println!("{:<16} {:>9.1}% {:>9.4}%", "spread", 100.0 * skipping, 100.0 * constant);
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
    let folder = std::env::temp_dir().join(format!("galpix-constant-work-{}", std::process::id()));
    let counts = std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()));
    let counts = counts.and_then(|()| count(text, &folder));
    let _ = std::fs::remove_dir_all(&folder);
    match counts {
        Ok(counts) => {
            println!("a frame of {text} with the rung extend, counted by callgrind");
            if table(&counts, size.0 * size.1) {
                return ExitCode::SUCCESS;
            }
            eprintln!("the instructions of constant work depend on the picture by more than {} %", 100.0 * MOST_SPREAD);
            ExitCode::FAILURE
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}
