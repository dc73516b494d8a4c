//! The engine's kernels on all states of a tiny budget, on the processor that runs them.
//!
//! Offset, velocity and acceleration of x and y take 16 bits here: all 65536 states make one step each, under every
//! threshold that the roundings have, in a whole sweep. Each is compared with the same step in plain numbers, by
//! divisions, and all words that come out are hashed: the hash is the same on every processor.

#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

use fixed::types::I32F32;
use galpix_core::record::Component;
use galpix_core::stages::sweep;
use galpix_core::{
    Bits, BudgetError, Colour, Demand, Galpixel, Galpixmap, Grid, Layout, Margin, Profile, Rounding, SetupError, Static,
};

/// The hash of all words.
pub const HASH: u32 = 0x2782_2e88;

/// States that are tried.
pub const STATES: u32 = CASES.len() as u32 * (1 << 16);

/// Roundings and frame counters: all thresholds of one dropped bit.
const CASES: [(Rounding, u32); 4] =
    [(Rounding::Truncate, 0), (Rounding::Nearest, 0), (Rounding::LowDiscrepancy, 0), (Rounding::LowDiscrepancy, 1)];

/// Cells between two galpixels: none reaches another one's.
const APART: i32 = 8;
/// Galpixels to a row and to a column of a map.
const ROW: i32 = 16;
const COLUMN: i32 = 16;

const WIDTH: u32 = (APART * ROW) as u32;
const HEIGHT: u32 = (APART * COLUMN) as u32;
/// Words of memory for each of two maps.
pub const WORDS: usize = (WIDTH * HEIGHT) as usize;
/// Words of memory for the table of row starts.
pub const ROWS: usize = HEIGHT as usize;

const POSITION_FRAC: u32 = 2;
const VELOCITY_FRAC: u32 = 2;
const ACCELERATION_FRAC: u32 = 1;

/// Motion in x and y with acceleration, eight bits a component; no depth.
struct Tiny;

impl Profile for Tiny {
    const LAYOUT: Layout = Layout { colour: Colour::GRAY4, velocity: true, acceleration: true, ..Layout::STILL };
    const BITS: Bits = {
        let component = Component {
            position_frac: POSITION_FRAC,
            velocity_int: 2,
            velocity_frac: VELOCITY_FRAC,
            acceleration_int: 1,
            acceleration_frac: ACCELERATION_FRAC,
        };
        let bits: Result<Bits, BudgetError> = Bits::derive(Demand { extent: 16, recog: 2, prop: 4 });
        Bits::must(bits).with_xy(component, component)
    };
}

/// What went wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrong {
    /// The maps could not be laid over the memory.
    Setup(SetupError),
    /// This state, under this case, did not become what it should.
    State(u32, u32),
    /// Some galpixel was lost or met another one.
    Tally,
}

/// One component before or after a step, in units of its last bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct State {
    offset: i32,
    velocity: i32,
    acceleration: i32,
}

impl State {
    /// From 8 bits.
    const fn of(bits: u32) -> Self {
        const fn signed(bits: u32, width: u32) -> i32 {
            let value = (bits & ((1 << width) - 1)) as i32;
            if value >= 1 << (width - 1) { value - (1 << width) } else { value }
        }
        Self { offset: signed(bits, 2), velocity: signed(bits >> 2, 4), acceleration: signed(bits >> 6, 2) }
    }

    /// Equations (6) and (7) in plain numbers: the cells moved, and the state after.
    fn stepped(self, threshold: i32) -> (i32, Self) {
        // Half steps of the velocity's unit; a half step is also half of the position's unit.
        let acceleration = self.acceleration * 2;
        let half_steps = 2 * self.velocity + acceleration;
        let position = self.offset + (half_steps + threshold).div_euclid(2);
        let cells = (position + 2).div_euclid(4);
        let velocity = (self.velocity + acceleration).clamp(-8, 7);
        (cells, Self { offset: position - 4 * cells, velocity, ..self })
    }
}

/// A galpixel with these two components.
fn galpixel([x, y]: [State; 2], colour: u8) -> Galpixel {
    let number = |raw: i32, frac: u32| I32F32::from_bits(i64::from(raw) << (32 - frac));
    Galpixel {
        colour: [colour; 3],
        offset: [number(x.offset, POSITION_FRAC), number(y.offset, POSITION_FRAC)],
        velocity: [number(x.velocity, VELOCITY_FRAC), number(y.velocity, VELOCITY_FRAC), I32F32::ZERO],
        acceleration: [
            number(x.acceleration, ACCELERATION_FRAC),
            number(y.acceleration, ACCELERATION_FRAC),
            I32F32::ZERO,
        ],
        ..Galpixel::default()
    }
}

/// Where the galpixel of a state stands in its map.
const fn place(state: u32) -> (i32, i32) {
    let index = state as i32 % (ROW * COLUMN);
    (index % ROW * APART + APART / 2, index / ROW * APART + APART / 2)
}

/// Tries all states; the hash of all words.
///
/// *Errors:* the first that is wrong.
pub fn check(front: &mut [u32], back: &mut [u32], starts: &mut [u32]) -> Result<u32, Wrong> {
    let grid = Grid::new(WIDTH, HEIGHT, Margin::NONE, starts).map_err(Wrong::Setup)?;
    let format = Static::<Tiny>::new();
    let mut front = Galpixmap::new(grid, format, front).map_err(Wrong::Setup)?;
    let mut back = Galpixmap::new(grid, format, back).map_err(Wrong::Setup)?;
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    let mut hash = crc.digest();
    for (case, (rounding, frame)) in (0..).zip(CASES) {
        let threshold = rounding.threshold(frame, 1);
        for map in 0..(1 << 16) / (ROW * COLUMN) as u32 {
            let states = map * (ROW * COLUMN) as u32..(map + 1) * (ROW * COLUMN) as u32;
            let both = |state: u32| [State::of(state), State::of(state >> 8)];
            front.clear();
            for state in states.clone() {
                let (x, y) = place(state);
                front.store(x, y, &galpixel(both(state), state as u8));
            }
            let tally = sweep(&front, &mut back, &mut [], rounding, frame);
            if tally.moved != (ROW * COLUMN) as u32 || tally.lost + tally.collided > 0 {
                return Err(Wrong::Tally);
            }
            for state in states {
                let [(dx, x_after), (dy, y_after)] = both(state).map(|component| component.stepped(threshold));
                let (x, y) = place(state);
                // Of the colour the upper four bits are stored, and read twice over.
                let colour = (state as u8 & 0xf0) | (state as u8 >> 4);
                let expected = galpixel([x_after, y_after], colour);
                let found = back.load(x + dx, y + dy);
                if found != Some(expected) {
                    return Err(Wrong::State(state, case));
                }
                let cell = grid.cell(x + dx, y + dy).unwrap_or_default();
                let word = back.plane(0).and_then(|words| words.get(cell as usize)).copied().unwrap_or_default();
                hash.update(&word.to_le_bytes());
            }
        }
    }
    Ok(hash.finalize())
}
