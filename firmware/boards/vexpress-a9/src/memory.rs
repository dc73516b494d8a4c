//! The memory of the controller, by name.

use galpix_controller::inpainted;
use galpix_core::Scratch;
use galpix_link::panel::Panel;
use static_cell::ConstStaticCell;

use crate::Display;
use crate::panel::Picture;

const HEIGHT: usize = Display::HEIGHT as usize;
const EDGE_WORDS: usize = Display::CELLS.div_ceil(32);
const PUSH_PULL_WORDS: usize = inpainted::words::<Display>();

static MAPS: [ConstStaticCell<[u32; Display::MAP_WORDS]>; 2] =
    [const { ConstStaticCell::new([0; Display::MAP_WORDS]) }; 2];
static WINNERS: ConstStaticCell<[u32; Display::CELLS]> = ConstStaticCell::new([0; Display::CELLS]);
static EDGES: ConstStaticCell<[u32; EDGE_WORDS]> = ConstStaticCell::new([0; EDGE_WORDS]);
static STARTS: ConstStaticCell<[u32; HEIGHT]> = ConstStaticCell::new([0; HEIGHT]);
static PUSH_PULL: ConstStaticCell<[u32; PUSH_PULL_WORDS]> = ConstStaticCell::new([0; PUSH_PULL_WORDS]);
static PICTURES: [ConstStaticCell<Picture>; 2] = [const { ConstStaticCell::new(Picture::new()) }; 2];

/// What each piece takes, in bytes.
pub const SHARES: [(&str, usize); 6] = [
    ("for two maps", 2 * Display::MAP_WORDS * 4),
    ("for the winners", Display::CELLS * 4),
    ("for the edge map", EDGE_WORDS * 4),
    ("for the table of row starts", HEIGHT * 4),
    ("for push-pull", PUSH_PULL_WORDS * 4),
    ("for two pictures", 2 * size_of::<Picture>()),
];

/// The memory, taken once.
pub struct Lent {
    pub maps: [&'static mut [u32]; 2],
    pub scratch: Scratch<'static>,
    pub starts: &'static mut [u32],
    pub push_pull: &'static mut [u32],
    pub pictures: [&'static mut Picture; 2],
}

impl Lent {
    /// Takes it. The second time there is none left, and the program ends.
    pub fn take() -> Self {
        let [front, back] = &MAPS;
        let [shown, hidden] = &PICTURES;
        Self {
            maps: [front.take(), back.take()],
            scratch: Scratch { winners: WINNERS.take(), edges: EDGES.take() },
            starts: STARTS.take(),
            push_pull: PUSH_PULL.take(),
            pictures: [shown.take(), hidden.take()],
        }
    }
}
