//! The displays that both ends know: their sizes, and how their galpixels are stored.

use galpix_core::inpaint::{Gamma, Inpainting, Motion, PushPull};
use galpix_core::record::{Component, Field, Scale};
use galpix_core::{Bits, BudgetError, Colour, Demand, Layout, Profile, Record, Settings, Static};

use crate::CRC;
use crate::size::MAX_WORD_BYTES;

/// The version of the frames. It enters every fingerprint, so that ends of different versions refuse each other's
/// galpixels.
pub const VERSION: u8 = 1;

/// A display, as a type. `Static<Self>` is the format of its maps.
pub trait Panel: Profile + Sized {
    /// What it is called.
    const NAME: &'static str;
    /// Columns.
    const WIDTH: u16;
    /// Rows.
    const HEIGHT: u16;

    /// How its galpixels are stored.
    const RECORD: Record = Static::<Self>::RECORD;
    /// Cells of its map, which has no margin.
    const CELLS: usize = Self::WIDTH as usize * Self::HEIGHT as usize;
    /// With what its frames are made. With few depths the surface next to another may be apart by a single step.
    const SETTINGS: Settings = Settings::for_depth(Self::RECORD.depth().bits as u32);
    /// Whether its frames tell surfaces apart, with a winner map and an edge map. Without them no hole is a bullet
    /// hole: all continue what is beside them.
    const TELLS_SURFACES: bool;
    /// What push-pull makes of the motion of what it fills in after a frame.
    const MOTION: Motion;
    /// How.
    const INPAINTING: Inpainting<'static> = Inpainting::for_depth(Self::RECORD.depth().bits as u32, Gamma::Zero);
    /// Words of memory that it needs.
    const PUSH_PULL_WORDS: usize = PushPull::words(Self::WIDTH as u32, Self::HEIGHT as u32, Self::MOTION);
    /// Words of memory for one map.
    const MAP_WORDS: usize = Self::CELLS * Self::RECORD.words();
    /// The display as a value.
    const DESCRIPTION: Description = Description::of::<Self>();
}

/// What the two ends of a line must agree on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Description {
    /// What it is called.
    pub name: &'static str,
    /// Columns.
    pub width: u16,
    /// Rows.
    pub height: u16,
    /// Words of a stored galpixel.
    pub words: u8,
    /// The CRC-32 of size and stored form, see [`fingerprint`].
    pub fingerprint: u32,
}

/// Every display, the smallest first.
pub const ALL: [Description; 3] = [Oled::DESCRIPTION, Tft::DESCRIPTION, Lcd::DESCRIPTION];

/// The display with this fingerprint.
#[must_use]
pub fn with_fingerprint(fingerprint: u32) -> Option<Description> {
    ALL.into_iter().find(|panel| panel.fingerprint == fingerprint)
}

impl Description {
    /// Of a display.
    #[must_use]
    pub const fn of<P: Panel>() -> Self {
        // The hash of a picture takes 16 bits of each colour.
        const { assert!(P::LAYOUT.colour.bits() <= 16) };
        Self {
            name: P::NAME,
            width: P::WIDTH,
            height: P::HEIGHT,
            words: P::RECORD.words() as u8,
            fingerprint: fingerprint::<P>(),
        }
    }

    /// Bytes of a stored galpixel.
    #[must_use]
    pub const fn bytes_per_galpixel(&self) -> usize {
        self.words as usize * 4
    }

    /// The most galpixels of one frame.
    #[must_use]
    pub const fn galpixels_per_frame(&self) -> usize {
        match MAX_WORD_BYTES.checked_div(self.bytes_per_galpixel()) {
            Some(galpixels) => galpixels,
            None => 0,
        }
    }
}

/// Bytes under a fingerprint, put behind each other in constants.
struct Hashed {
    bytes: [u8; 160],
    length: usize,
}

impl Hashed {
    const fn push(&mut self, number: u32) {
        self.bytes[self.length] = number as u8;
        self.length += 1;
    }

    const fn field(&mut self, Field { bits, word, shift, spill }: Field) {
        self.push(bits as u32);
        self.push(word as u32);
        self.push(shift as u32);
        self.push(spill as u32);
    }

    const fn scale(&mut self, scale: Scale) {
        self.push(scale.acceleration_up);
        self.push(scale.down);
        self.push(scale.up);
        self.push(scale.position_frac);
        self.push(scale.velocity_frac);
        self.push(scale.acceleration_frac);
        self.push(scale.velocity_bits);
    }

    /// Puts the lowest bit and the bits of the channel that `brightest` fills, and no other one.
    const fn channel(&mut self, colour: Colour, brightest: [u8; 3]) {
        let mask = colour.from_rgb888(brightest);
        self.push(mask.trailing_zeros());
        self.push(mask.count_ones());
    }
}

/// The CRC-32 of everything that gives a stored galpixel its meaning, each number as one byte: [`VERSION`]; width and
/// height (two bytes each, the low one first); words; bits, word, shift and spill of each field in canonical order; the
/// seven numbers of the scales of x, y and depth in their order; fraction bits of the luminosity; for each channel of
/// the colour its lowest bit and its bits.
///
/// For constants: it is computed while compiling.
#[must_use]
pub const fn fingerprint<P: Panel>() -> u32 {
    let record = P::RECORD;
    let mut hashed = Hashed { bytes: [0; 160], length: 0 };
    hashed.push(VERSION as u32);
    hashed.push(P::WIDTH as u32);
    hashed.push(P::WIDTH as u32 >> 8);
    hashed.push(P::HEIGHT as u32);
    hashed.push(P::HEIGHT as u32 >> 8);
    hashed.push(record.words() as u32);
    hashed.field(record.class());
    hashed.field(record.depth());
    hashed.field(record.offset_x());
    hashed.field(record.offset_y());
    let mut component = 0;
    while component < 3 {
        hashed.field(record.velocity(component));
        hashed.field(record.acceleration(component));
        component += 1;
    }
    hashed.field(record.colour());
    hashed.field(record.tag());
    hashed.field(record.luminosity_rate());
    hashed.field(record.luminosity());
    let mut component = 0;
    while component < 3 {
        hashed.scale(record.scales[component]);
        component += 1;
    }
    hashed.push(record.luminosity_frac);
    if P::LAYOUT.colour.is_gray() {
        hashed.channel(P::LAYOUT.colour, [255; 3]);
    } else {
        hashed.channel(P::LAYOUT.colour, [255, 0, 0]);
        hashed.channel(P::LAYOUT.colour, [0, 255, 0]);
        hashed.channel(P::LAYOUT.colour, [0, 0, 255]);
    }
    CRC.checksum(hashed.bytes.split_at(hashed.length).0)
}

/// A component, or a compile error.
const fn must(component: Result<Component, BudgetError>) -> Component {
    match component {
        Ok(component) => component,
        Err(_) => panic!("panel: this component cannot exist"),
    }
}

/// A small graphic display of 128 x 64 gray pixels.
#[derive(Clone, Copy, Debug)]
pub enum Oled {}

impl Profile for Oled {
    /// x and y with velocity only, 4-bit gray, 4-bit z that does not move, and one bit that tells an update from the
    /// one before.
    const LAYOUT: Layout = Layout { tag_bits: 1, ..Layout::VELOCITY_GRAY4 };
    /// Recognition in 32 frames, an update every 16: at most 4 cells a frame along a row and 2 along a column. That
    /// fills one word to its last bit.
    const BITS: Bits = {
        let x = Demand { extent: 128, recog: 32, prop: 16 };
        let y = Demand { extent: 64, ..x };
        Bits::must(Bits::derive_without_acceleration(x))
            .with_xy(must(Component::derive_without_acceleration(x)), must(Component::derive_without_acceleration(y)))
    };
}

impl Panel for Oled {
    const NAME: &'static str = "oled";
    const WIDTH: u16 = 128;
    const HEIGHT: u16 = 64;
    /// No: that would take 4.5 KiB, and a quarter of the work of a frame.
    const TELLS_SURFACES: bool = false;
    /// The colour only: the motion stays the one that the ladder gave. In one map no map before is left for quads.
    const MOTION: Motion = Motion::Kept;
    const INPAINTING: Inpainting<'static> =
        Inpainting { quads: false, ..Inpainting::for_depth(Self::RECORD.depth().bits as u32, Gamma::Zero) };
}

/// A colour display of 320 x 240 pixels, each galpixel on 2 x 2 of them.
#[derive(Clone, Copy, Debug)]
pub enum Tft {}

impl Profile for Tft {
    /// x and y with velocity only, RGB565, 16-bit z that does not move, and two bits that tell an update from those
    /// before.
    const LAYOUT: Layout = Layout { tag_bits: 2, ..Layout::VELOCITY565 };
    /// Recognition in 8 frames, an update every 16: 64 bits, two words to their last bit.
    const BITS: Bits = Bits::must(Bits::derive_without_acceleration(Demand { extent: 160, recog: 8, prop: 16 }));
}

impl Panel for Tft {
    const NAME: &'static str = "tft";
    const WIDTH: u16 = 160;
    const HEIGHT: u16 = 120;
    /// No: that would be half of the work of a frame.
    const TELLS_SURFACES: bool = false;
    /// The colour only, as on the OLED: one map.
    const MOTION: Motion = Motion::Kept;
    const INPAINTING: Inpainting<'static> =
        Inpainting { quads: false, ..Inpainting::for_depth(Self::RECORD.depth().bits as u32, Gamma::Zero) };
}

/// A colour display of 320 x 240 pixels.
#[derive(Clone, Copy, Debug)]
pub enum Lcd {}

impl Profile for Lcd {
    /// x and y with velocity and acceleration, RGB565, 14-bit z that does not move, and two bits that tell an update
    /// from those before.
    const LAYOUT: Layout = Layout { depth_bits: 14, tag_bits: 2, ..Layout::FLAT565 };
    /// Recognition in 16 frames, an update every 16: 96 bits, three words to their last bit. Recognition in 8 would
    /// take six bits more, and a fourth word for them.
    const BITS: Bits = Bits::must(Bits::derive(Demand { extent: 320, recog: 16, prop: 16 }));
}

impl Panel for Lcd {
    const NAME: &'static str = "lcd";
    const WIDTH: u16 = 320;
    const HEIGHT: u16 = 240;
    const TELLS_SURFACES: bool = true;
    const MOTION: Motion = Motion::Inpainted;
}

const _: () = assert!(Oled::RECORD.bits() == 32 && Oled::RECORD.bytes() == 4);
const _: () = assert!(Tft::RECORD.bits() == 64 && Tft::RECORD.bytes() == 8);
const _: () = assert!(Lcd::RECORD.bits() == 96 && Lcd::RECORD.bytes() == 12);
