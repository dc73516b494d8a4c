//! Where the 64 KiB go: every large piece by name, summed up by the compiler.

use galpix_controller::inpainted;
use galpix_core::rolling;
use galpix_link::panel::Panel;
use static_cell::ConstStaticCell;

use crate::Display;
use crate::panel::Band;
use crate::uart;

const WIDTH: usize = Display::WIDTH as usize;
const HEIGHT: usize = Display::HEIGHT as usize;

/// Rows of the window.
pub const WINDOW_ROWS: usize = rolling::rows(&Display::RECORD, 1) as usize;

const WINDOW_CELLS: usize = WINDOW_ROWS * WIDTH;
const WINDOW_WORDS: usize = WINDOW_CELLS * Display::RECORD.words();
const PUSH_PULL_WORDS: usize = inpainted::words::<Display>();
const _: () = assert!(!Display::TELLS_SURFACES, "lend the window a winner map and the map an edge map");

static MAP: ConstStaticCell<[u32; Display::MAP_WORDS]> = ConstStaticCell::new([0; Display::MAP_WORDS]);
static WINDOW: ConstStaticCell<[u32; WINDOW_WORDS]> = ConstStaticCell::new([0; WINDOW_WORDS]);
static STARTS: ConstStaticCell<[u32; HEIGHT]> = ConstStaticCell::new([0; HEIGHT]);
static TURNS: ConstStaticCell<[u32; HEIGHT]> = ConstStaticCell::new([0; HEIGHT]);
static PUSH_PULL: ConstStaticCell<[u32; PUSH_PULL_WORDS]> = ConstStaticCell::new([0; PUSH_PULL_WORDS]);
static BAND: ConstStaticCell<Band> = ConstStaticCell::new(Band::new());

/// What each piece takes, in bytes.
pub const SHARES: [(&str, usize); 5] = [
    ("for the map", Display::MAP_WORDS * 4),
    ("for the window of rows", WINDOW_WORDS * 4),
    ("for the two tables of row starts", HEIGHT * 8),
    ("for push-pull", PUSH_PULL_WORDS * 4),
    ("for a band of the picture and the line", size_of::<Band>() + uart::QUEUE),
];

/// All of them.
pub const SUM: usize = {
    let (mut sum, mut i) = (0, 0);
    while i < SHARES.len() {
        sum += SHARES[i].1;
        i += 1;
    }
    sum
};

/// What is kept for the stack and small statics. The painted stack tells what is really used.
/// With push-pull, which calls itself for each level of its pyramid, there is as little as that, and it is enough.
const STACK: usize = if PUSH_PULL_WORDS == 0 { 8 * 1024 } else { 4 * 1024 };

const _: () = assert!(SUM + STACK <= 64 * 1024, "the maps and the stack do not fit into 64 KiB");

/// The memory, taken once.
pub struct Lent {
    pub map: &'static mut [u32],
    pub window: &'static mut [u32],
    pub starts: &'static mut [u32],
    pub turns: &'static mut [u32],
    pub push_pull: &'static mut [u32],
    pub band: &'static mut Band,
}

impl Lent {
    /// Takes it. The second time there is none left, and the program ends.
    pub fn take() -> Self {
        Self {
            map: MAP.take(),
            window: WINDOW.take(),
            starts: STARTS.take(),
            turns: TURNS.take(),
            push_pull: PUSH_PULL.take(),
            band: BAND.take(),
        }
    }
}
