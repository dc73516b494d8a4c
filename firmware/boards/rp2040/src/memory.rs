//! Where the 264 KiB go: every large piece by name, summed up by the compiler.

use galpix_core::rolling;
use galpix_link::panel::Panel;
use static_cell::ConstStaticCell;

use crate::Display;
use crate::panel::{self, Band, Line};
use crate::uart;

const HEIGHT: usize = Display::HEIGHT as usize;

/// Rows of the window.
pub const WINDOW_ROWS: usize = rolling::rows(&Display::RECORD, 1) as usize;

const WINDOW_WORDS: usize = WINDOW_ROWS * Display::WIDTH as usize * Display::RECORD.words();
const _: () = assert!(!Display::TELLS_SURFACES, "lend the window a winner map and the map an edge map");
const _: () = assert!(Display::WIDTH as usize == panel::WIDTH && Display::HEIGHT as u32 == panel::HEIGHT);

static MAP: ConstStaticCell<[u32; Display::MAP_WORDS]> = ConstStaticCell::new([0; Display::MAP_WORDS]);
static WINDOW: ConstStaticCell<[u32; WINDOW_WORDS]> = ConstStaticCell::new([0; WINDOW_WORDS]);
static STARTS: ConstStaticCell<[u32; HEIGHT]> = ConstStaticCell::new([0; HEIGHT]);
static TURNS: ConstStaticCell<[u32; HEIGHT]> = ConstStaticCell::new([0; HEIGHT]);
static BAND: ConstStaticCell<Band> = ConstStaticCell::new(Band::new());
static LINES: [ConstStaticCell<Line>; 2] = [const { ConstStaticCell::new([0; size_of::<Line>()]) }; 2];

/// What each piece takes, in bytes.
pub const SHARES: [(&str, usize); 5] = [
    ("for the map", Display::MAP_WORDS * 4),
    ("for the window of rows", WINDOW_WORDS * 4),
    ("for the two tables of row starts", HEIGHT * 8),
    ("for a band of the picture and two lines", size_of::<Band>() + 2 * size_of::<Line>()),
    ("for the line to the host", uart::QUEUE),
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
const STACK: usize = 8 * 1024;

const _: () = assert!(SUM + STACK <= 264 * 1024, "the map and the stack do not fit into 264 KiB");

/// The memory, taken once.
pub struct Lent {
    pub map: &'static mut [u32],
    pub window: &'static mut [u32],
    pub starts: &'static mut [u32],
    pub turns: &'static mut [u32],
    pub band: &'static mut Band,
    pub lines: [&'static mut Line; 2],
}

impl Lent {
    /// Takes it. The second time there is none left, and the program ends.
    pub fn take() -> Self {
        let [line, free] = &LINES;
        Self {
            map: MAP.take(),
            window: WINDOW.take(),
            starts: STARTS.take(),
            turns: TURNS.take(),
            band: BAND.take(),
            lines: [line.take(), free.take()],
        }
    }
}
