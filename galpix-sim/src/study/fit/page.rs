//! The page of documentation: every board with a row for each of some layouts.

use std::fmt::Write as _;

use super::{Fit, boards, fit};

/// The rows of the page: layout and fill.
const ROWS: [(&str, &str); 3] = [("velocity-gray4", "hold"), ("velocity565", "hold"), ("velocity565", "extend")];

const HEAD: &str = "# What fits which board

Printed by `galpix fit --page`, from instructions that were counted ([cost.md](cost.md)) and code that was measured
(`firmware/text.csv`); a test compares this page with what is printed. **Nothing here was measured on hardware.** Cycles
an instruction are an assumption, printed for each board; frames a second are a range by it. The picture is *layers*.
Processors other than Cortex-M were not counted: their instructions are a range from those of an M4 to those of an M0.

A frame is made, then sent: while the bus is busy, the rows are read that it sends next. RAM has the maps, what the fill
needs, two line buffers (or two pictures that are scanned out), and 8 KiB of stack; flash has the code of the frame and
28 KiB for the rest of a program. Two maps where they fit, else one and a window of rows. Where the panel's size does
not fit with Velocity565, a galpixel is shown as 2 x 2 pixels. Budgets are for recognition in 8 frames and an update
every 16; slower motion takes fewer bits, and a window of fewer rows.

Updates, an overlay, and scenes that the device evaluates itself come on top: the emulated Pico's program has all three,
and its longest frame takes 54 ms at 125 MHz (`firmware/test.sh pace`), where 32 to 40 are stated here for the frame and
its way to the panel.
";

/// Returns the page.
#[must_use]
pub fn markdown() -> String {
    let mut page = HEAD.to_owned();
    let _ = write!(
        page,
        "\n| board | MHz, cycles an instruction | panel | map | layout, fill | maps | RAM KiB | flash KiB | million \
         instructions a frame | frames a second | bus ms |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- \
         | --- |\n"
    );
    for board in &boards::ALL {
        let fit = fit(board, None, "layers");
        for (layout, fill) in ROWS {
            if let Some(row) = fit.rows.iter().find(|row| (row.layout, row.fill) == (layout, fill)) {
                let _ = writeln!(
                    page,
                    "| {} | {}, {:.1} to {:.1} | {} {} x {} | {} x {} | {layout}, {fill} | {} | {} | {} | {} | {} | {:.1} |",
                    fit.board,
                    fit.clock_mhz,
                    fit.cycles_per_instruction[0],
                    fit.cycles_per_instruction[1],
                    fit.panel,
                    fit.panel_width,
                    fit.panel_height,
                    fit.map_width,
                    fit.map_height,
                    row.maps,
                    row.ram_bytes.div_ceil(1024),
                    row.flash_bytes.div_ceil(1024),
                    millions(row.instructions),
                    frames(row),
                    fit.bus_ms
                );
            }
        }
    }
    let _ = writeln!(
        page,
        "\n60 frames a second, with velocity565 and extend:\n\n| board | chip | 60 frames a second |\n| --- | --- | --- |"
    );
    for board in &boards::ALL {
        let fit = fit(board, None, "layers");
        if let Some(row) = fit.rows.iter().find(|row| (row.layout, row.fill) == ("velocity565", "extend")) {
            let _ = writeln!(page, "| {} | {} | {} |", fit.board, fit.chip, row.sixty);
        }
    }
    page
}

/// Returns the table of one board as text.
#[must_use]
pub fn text(fit: &Fit) -> String {
    let mut text = format!(
        "{}: {}, {} MHz, {:.1} to {:.1} cycles an instruction (assumed); {} KiB of RAM, {} KiB of flash\n{} {} x {}, {:.1} ms \
         for a picture on its bus; map of {} x {} galpixels\n",
        fit.board,
        fit.chip,
        fit.clock_mhz,
        fit.cycles_per_instruction[0],
        fit.cycles_per_instruction[1],
        fit.ram_bytes / 1024,
        fit.flash_bytes / 1024,
        fit.panel,
        fit.panel_width,
        fit.panel_height,
        fit.bus_ms,
        fit.map_width,
        fit.map_height
    );
    if fit.instructions_by_analogy {
        text += "instructions were not counted on this processor: a range from a Cortex-M4's to a Cortex-M0's\n";
    }
    let _ = writeln!(
        text,
        "\n{:<15} {:<10} {:>4} {:>8} {:>9} {:>14} {:>12}",
        "layout", "fill", "maps", "RAM KiB", "flash KiB", "M instr/frame", "frames/s"
    );
    for row in &fit.rows {
        let _ = writeln!(
            text,
            "{:<15} {:<10} {:>4} {:>8} {:>9} {:>14} {:>12}",
            row.layout,
            row.fill,
            row.maps,
            row.ram_bytes.div_ceil(1024),
            row.flash_bytes.div_ceil(1024),
            millions(row.instructions),
            frames(row)
        );
    }
    if let Some(row) = fit.rows.iter().find(|row| (row.layout, row.fill) == ("velocity565", "extend")) {
        let _ = write!(text, "\nvelocity565, extend: {}", row.sixty);
    }
    text
}

fn millions([low, high]: [u64; 2]) -> String {
    let [low, high] = [low, high].map(|count| format!("{:.2}", count as f64 / 1e6));
    if low == high { low } else { format!("{low} to {high}") }
}

fn frames(row: &super::Row) -> String {
    let [low, high] = row.frames_per_second;
    if row.fits { format!("{low:.0} to {high:.0}") } else { "too large".to_owned() }
}
