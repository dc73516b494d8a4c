//! `galpix fit`.

use clap::{Args, ValueEnum};

use super::choices::AccelerationChoice;
use super::{CliError, call, print, print_json};
use crate::study::fit::{Fitting, boards, fit, page};
use crate::suggest;

/// Arguments of `galpix fit`.
#[derive(Debug, Args)]
#[command(after_help = "\
Columns: maps, 2 or 1 with a window of rows; RAM KiB, with the stack; flash KiB, code of the frame and a program around \
it; M instr/frame, million instructions of a frame as counted in firmware/cost.csv; frames/s, from and to, by the cycles \
an instruction that are assumed for the board.")]
pub struct Fit {
    /// A chip or a board, or `all`: rp2040, rp2350, stm32f103, stm32f407, stm32f429, stm32h743, nrf52840, esp32c3,
    /// esp32s3, samd51, lm3s6965, vexpress-a9, artix, ecp5
    #[arg(required_unless_present = "page")]
    board: Option<String>,
    /// A built-in scene or a capture, whose size the map has [default: what fits of the panel]
    source: Option<String>,
    /// The picture whose instructions are taken
    #[arg(long, value_enum, value_name = "PICTURE", default_value_t)]
    picture: PictureChoice,
    /// Print the page docs/fit.md
    #[arg(long, conflicts_with_all = ["board", "source", "json"])]
    page: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// A picture of the cost bench.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum PictureChoice {
    /// Nothing moves
    Still,
    /// All moves alike
    Pan,
    /// All moves apart
    Zoom,
    /// Objects move, each by itself
    #[default]
    Layers,
    /// Each galpixel moves by itself
    Chaos,
}

impl PictureChoice {
    const fn name(self) -> &'static str {
        match self {
            Self::Still => "still",
            Self::Pan => "pan",
            Self::Zoom => "zoom",
            Self::Layers => "layers",
            Self::Chaos => "chaos",
        }
    }
}

impl Fit {
    /// Says what fits.
    pub fn run(&self) -> Result<(), CliError> {
        let Some(name) = &self.board else { return print(page::markdown().trim_end()) };
        let chosen: Vec<&boards::Board> = match boards::find(name) {
            Some(board) => vec![board],
            None if name == "all" => boards::ALL.iter().collect(),
            None => {
                let names: Vec<&str> = boards::ALL.iter().map(|board| board.name).collect();
                let meant = suggest::hint(name, names.iter().copied());
                return Err(CliError::unusable(format!("`{name}` is no board: {}{meant}", names.join(", "))));
            }
        };
        let size = match &self.source {
            Some(source) => {
                let update = call::open(source, AccelerationChoice::default())?.update();
                Some([update.display_width() as u32, update.display_height() as u32])
            }
            None => None,
        };
        let picture = self.picture.name();
        let fits = chosen.into_iter().map(|board| fit(board, size, picture)).collect();
        let report = Fitting { picture: picture.to_owned(), boards: fits };
        if self.json {
            return print_json("fit", &report);
        }
        let texts: Vec<String> = report.boards.iter().map(page::text).collect();
        print(&texts.join("\n\n"))
    }
}
