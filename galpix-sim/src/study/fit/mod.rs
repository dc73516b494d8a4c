//! Whether a map fits a chip and its panel: memory, code, instructions and frames a second, before anything is bought.
//!
//! Instructions are those that the cost bench counts (`firmware/cost.csv`), code is measured (`firmware/text.csv`),
//! memory is what the engine asks for. Cycles an instruction are an assumption of each board; all figures of time are
//! ranges by it. Nothing here has been measured on hardware.

pub mod boards;
mod counts;
pub mod page;

use galpix_core::inpaint::{Motion, PushPull};
use galpix_core::{Bits, Demand, FillMode, Layout, Record, rolling};
use schemars::JsonSchema;
use serde::Serialize;

use boards::Board;

/// Bytes that are kept for the stack.
const STACK: u64 = 8 * 1024;
/// Bytes of code of everything else: start-up, panel driver, scan-out. That of the Pico's program without the engine.
const PROGRAM: u64 = 28 * 1024;
/// Frames a second that are wished for.
const WISHED: f64 = 60.0;

/// The layouts that were counted: name, name in the tables, layout.
const LAYOUTS: [(&str, &str, Layout); 6] = [
    ("velocity-gray4", "VelocityGray4", Layout::VELOCITY_GRAY4),
    ("velocity-gray8", "VelocityGray8", Layout::VELOCITY_GRAY8),
    ("velocity565", "Velocity565", Layout::VELOCITY565),
    ("flat565", "Flat565", Layout::FLAT565),
    ("full", "Full", Layout::FULL),
    ("shaded", "Shaded", Layout::SHADED),
];

/// Every fill that was counted.
const FILLS: [&str; 7] = ["none", "hold", "debris", "bullet", "galdebris", "extend", "push-pull"];

/// A report on some boards.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Fitting {
    /// The picture whose instructions were counted: still, pan, zoom, layers or chaos.
    pub picture: String,
    /// Those that were asked for.
    pub boards: Vec<Fit>,
}

/// A board with each layout and fill.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Fit {
    /// Its name.
    pub board: &'static str,
    /// Chip and processor.
    pub chip: &'static str,
    /// Of the processor.
    pub clock_mhz: f64,
    /// An assumption, from and to.
    pub cycles_per_instruction: [f64; 2],
    /// In one piece.
    pub ram_bytes: u64,
    /// For the program.
    pub flash_bytes: u64,
    /// What controls the panel.
    pub panel: &'static str,
    /// Columns of pixels.
    pub panel_width: u32,
    /// Rows of pixels.
    pub panel_height: u32,
    /// The map's size: the panel's, or that of the source.
    pub map_width: u32,
    /// Rows of the map.
    pub map_height: u32,
    /// Pixels of the panel for a galpixel, along each side.
    pub pixels_per_galpixel: u32,
    /// For one picture over the bus; 0 where the panel is scanned out of memory.
    pub bus_ms: f64,
    /// Whether instructions were counted on another processor: then they are a range.
    pub instructions_by_analogy: bool,
    /// Each layout with each fill.
    pub rows: Vec<Row>,
}

/// A layout with a fill.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Row {
    /// Its name, as `galpix budget` takes it.
    pub layout: &'static str,
    /// Its name, as `galpix run` takes it.
    pub fill: &'static str,
    /// 2 where two maps fit, 1 for one and a window of rows.
    pub maps: u32,
    /// With stack, line buffers and what the fill needs.
    pub ram_bytes: u64,
    /// Code of a frame and of a usual program around it.
    pub flash_bytes: u64,
    /// Whether both are there.
    pub fits: bool,
    /// Of a frame, from and to.
    pub instructions: [u64; 2],
    /// From and to; 0 where it does not fit.
    pub frames_per_second: [f64; 2],
    /// What 60 frames a second need.
    pub sixty: String,
}

/// Returns the fill mode of a fill, by its name: push-pull works over what extend has left.
fn mode(fill: &str) -> FillMode {
    let name = if fill == "push-pull" { "extend" } else { fill };
    FillMode::ALL.into_iter().find(|mode| mode.name() == name).unwrap_or(FillMode::None)
}

/// Returns the instructions of a frame for each cell, from and to, without the scan-out.
fn frame(board: &Board, layout: &str, picture: &str, fill: &str, rolls: bool) -> [f64; 2] {
    let stage = |stage: &str, fill: &str| counts::count(board.core, layout, picture, stage, fill);
    let after = if fill == "push-pull" { stage("push-pull", "-") } else { [0.0; 2] };
    let mode = mode(fill);
    let (edge, sweep) = if mode.uses_edges() {
        (stage("edge", "-"), stage("sweep", "-"))
    } else {
        ([0.0; 2], stage("sweep-alone", "-"))
    };
    let fill = stage("fill", mode.name());
    let window = if rolls {
        let (rolling, frame) = (stage("rolling", "extend"), stage("frame", "extend"));
        [rolling[0] - frame[0], rolling[1] - frame[1]]
    } else {
        [0.0; 2]
    };
    [0, 1].map(|end| edge[end] + sweep[end] + fill[end] + window[end] + after[end])
}

/// Returns bytes of RAM for a map of `width` by `height` cells.
fn memory(record: &Record, [width, height]: [u32; 2], fill: &str, rolls: bool, picture: u64) -> u64 {
    let cells = u64::from(width) * u64::from(height);
    let words = record.words() as u64;
    let window = u64::from(rolling::rows(record, 1).min(height)) * u64::from(width);
    let (others, winners) = if rolls { (window, window) } else { (cells, cells) };
    let mut sum = (cells + others) * words + 2 * u64::from(height);
    if mode(fill).uses_edges() {
        sum += winners + cells.div_ceil(32);
    }
    if fill == "push-pull" {
        sum += PushPull::words(width, height, Motion::Kept) as u64;
    }
    sum * 4 + picture + STACK
}

/// Fits a board: each layout with each fill. `size` is the map's, else that of the panel, or what fits of it: a
/// galpixel is then shown as 2 x 2 pixels.
#[must_use]
pub fn fit(board: &Board, size: Option<[u32; 2]>, picture: &str) -> Fit {
    let panel = board.panel;
    // The whole panel if the smallest layout fits, else each galpixel as 2 x 2 pixels.
    let whole = [panel.width, panel.height];
    let least = |size| memory(&record(Layout::VELOCITY565, size), size, "none", true, buffers(board));
    let scale = if least(whole) <= u64::from(board.ram) * 1024 { 1 } else { 2 };
    let map = size.unwrap_or(whole.map(|side| side.div_ceil(scale)));
    let mut rows = Vec::new();
    for (name, table, layout) in LAYOUTS {
        for fill in FILLS {
            rows.push(row(board, (name, table, layout), fill, map, picture));
        }
    }
    Fit {
        board: board.name,
        chip: board.chip,
        clock_mhz: board.clock,
        cycles_per_instruction: board.cycles,
        ram_bytes: u64::from(board.ram) * 1024,
        flash_bytes: u64::from(board.flash) * 1024,
        panel: panel.name,
        panel_width: panel.width,
        panel_height: panel.height,
        map_width: map[0],
        map_height: map[1],
        pixels_per_galpixel: if size.is_some() { 1 } else { scale },
        bus_ms: bus_ms(board),
        instructions_by_analogy: board.core == boards::Core::Other,
        rows,
    }
}

/// Returns the time of a picture on the bus.
fn bus_ms(board: &Board) -> f64 {
    let panel = board.panel;
    let bits = f64::from(panel.width * panel.height * panel.bits);
    panel.bus.map_or(0.0, |rate| bits / rate / 1000.0)
}

/// Returns bytes of the pictures that a panel scans, or of two lines.
fn buffers(board: &Board) -> u64 {
    let panel = board.panel;
    let line = u64::from(panel.width * panel.bits / 8);
    if panel.bus.is_some() { 2 * line } else { 2 * line * u64::from(panel.height) }
}

/// Returns how a layout is stored for a map of this size: recognition in 8 frames, an update every 16.
fn record(layout: Layout, [width, height]: [u32; 2]) -> Record {
    let demand = Demand { extent: width.max(height).max(64), recog: 8, prop: 16 };
    let derived = if layout.acceleration { Bits::derive(demand) } else { Bits::derive_without_acceleration(demand) };
    let bits = derived.expect("64 pixels and more have a budget");
    Record::plan(bits, layout).expect("and fields of at most a word")
}

fn row(
    board: &Board,
    (name, table, layout): (&'static str, &str, Layout),
    fill: &'static str,
    map: [u32; 2],
    picture: &str,
) -> Row {
    let bus_ms = bus_ms(board);
    let record = record(layout, map);
    let have = u64::from(board.ram) * 1024;
    let needs = |rolls| memory(&record, map, fill, rolls, buffers(board));
    let rolls = needs(false) > have;
    let program = if rolls { "rolling" } else { "two-maps" };
    let push_pull = if fill == "push-pull" { counts::text(board.core, table, "push-pull") } else { 0 };
    let flash_bytes = PROGRAM + counts::text(board.core, table, program) + push_pull;
    let fits = needs(rolls) <= have && flash_bytes <= u64::from(board.flash) * 1024;
    let cells = f64::from(map[0]) * f64::from(map[1]);
    let pixels = f64::from(board.panel.width * board.panel.height);
    let step = frame(board, table, picture, fill, rolls).map(|count| count * cells);
    let show = counts::count(board.core, table, "any", "scan-out", "-").map(|count| count * pixels);
    let ms = |instructions: f64, end: usize| instructions * board.cycles[end] / board.clock / 1000.0;
    // While the bus is busy the rows are made that it sends next; the next frame is made after that.
    let taken = [0, 1].map(|end| ms(step[end], end) + ms(show[end], end).max(bus_ms));
    let instructions = [0, 1].map(|end| (step[end] + show[end]) as u64);
    let frames_per_second = if fits { [1000.0 / taken[1], 1000.0 / taken[0]] } else { [0.0; 2] };
    Row {
        layout: name,
        fill,
        maps: if rolls { 1 } else { 2 },
        ram_bytes: needs(rolls),
        flash_bytes,
        fits,
        instructions,
        frames_per_second,
        sixty: sixty(board, instructions, bus_ms, fits.then_some(frames_per_second)),
    }
}

/// Returns the sentence on 60 frames a second.
fn sixty(board: &Board, instructions: [u64; 2], bus_ms: f64, frames: Option<[f64; 2]>) -> String {
    let Some([low, high]) = frames else {
        return "it does not fit into the memory".to_owned();
    };
    let need = [0, 1].map(|end| instructions[end] as f64 * board.cycles[end] * WISHED / 1e6);
    let bits = f64::from(board.panel.width * board.panel.height * board.panel.bits) * WISHED / 1e6;
    let bus = if bus_ms > 0.0 { format!(" and {bits:.0} Mbit/s of bus") } else { String::new() };
    let verdict = if low >= WISHED {
        "it has them".to_owned()
    } else {
        format!("it makes {low:.0} to {high:.0} frames a second")
    };
    format!("60 Hz needs {:.0} to {:.0} million cycles a second{bus}; {verdict}", need[0], need[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stages_of_a_frame_add_up_to_the_frame_that_was_counted() {
        let board = boards::find("rp2040").expect("a board");
        for (_, table, _) in LAYOUTS {
            for picture in ["still", "pan", "zoom", "layers"] {
                for (rolls, stage) in [(false, "frame"), (true, "rolling")] {
                    let [sum, _] = frame(board, table, picture, "extend", rolls);
                    let [counted, _] = counts::count(board.core, table, picture, stage, "extend");
                    assert!(
                        counted > 0.0 && (sum - counted).abs() <= 0.05 * counted,
                        "{table} {picture}: {sum} {counted}"
                    );
                }
            }
        }
    }

    #[test]
    fn every_board_has_counts_and_code() {
        for board in &boards::ALL {
            let fit = fit(board, None, "layers");
            assert_eq!(fit.rows.len(), LAYOUTS.len() * FILLS.len(), "{}", board.name);
            assert!(fit.rows.iter().all(|row| row.instructions[0] > 0 && row.flash_bytes > PROGRAM), "{}", board.name);
            assert!(fit.rows.iter().all(|row| row.fits == (row.frames_per_second[0] > 0.0)), "{}", board.name);
        }
    }

    /// As the program of the Pico says itself: `memory.rs` and the linker.
    #[test]
    fn the_memory_of_the_pico_is_that_of_its_program() {
        let fit = fit(boards::find("rp2040").expect("a board"), None, "layers");
        let row = fit.rows.iter().find(|row| (row.layout, row.fill) == ("velocity565", "hold")).expect("a row");
        assert_eq!((fit.map_width, fit.map_height, row.maps), (160, 120, 1));
        let cells = 160 * 120 * 8;
        assert!(row.fits && row.ram_bytes > cells && row.ram_bytes < 264 * 1024, "{row:?}");
    }
}
