//! What a galpixel costs on a microcontroller: instructions a stage, counted in an emulator, printed as CSV.
//!
//! ```sh
//! cargo build --release -p galpix-cost --target thumbv7em-none-eabi
//! qemu-system-arm -M mps2-an386 -icount shift=6 -display none -monitor none -serial none \
//!     -semihosting-config enable=on,target=native -kernel target/thumbv7em-none-eabi/release/galpix-cost
//! ```
//!
//! The same machine runs what is compiled for Cortex-M0 (`thumbv6m`), M3 (`thumbv7m`) and M4 (`thumbv7em`). These are
//! instructions, not cycles: no wait states, no pipeline.

#![no_std]
#![no_main]

mod bench;
mod clock;
mod inpainting;
mod layouts;
mod machine;
mod pictures;
mod plain;
mod report;
mod sources;
mod stages;

use core::hint::black_box;

use cortex_m_rt::{ExceptionFrame, entry, exception};
use galpix_core::inpaint::{Motion, PushPull};
use galpix_core::{Grid, Margin, Scratch};
use semihosting::{eprintln, println, process};

use bench::Bench;
use clock::Clock;
use layouts::MOST_WORDS;
use machine::{Machine, Psram};
use pictures::Picture;
use plain::{Fixed, Float, propagate_fixed, propagate_float};
use report::{Row, print, print_head};

const WIDTH: u32 = 320;
const HEIGHT: u32 = 240;
/// Rows for constant time.
const BAND: u32 = 48;
const CELLS: usize = (WIDTH * HEIGHT) as usize;
/// Words for push-pull of either kind.
const PUSH_PULL_WORDS: usize = PushPull::words(WIDTH, HEIGHT, Motion::Inpainted);

#[entry]
fn main() -> ! {
    static mut FRONT: [u32; CELLS * MOST_WORDS] = [0; CELLS * MOST_WORDS];
    static mut BACK: [u32; CELLS * MOST_WORDS] = [0; CELLS * MOST_WORDS];
    static mut WINNERS: [u32; CELLS] = [0; CELLS];
    static mut EDGES: [u32; CELLS.div_ceil(32)] = [0; CELLS.div_ceil(32)];
    static mut ROWS: [u32; HEIGHT as usize] = [0; HEIGHT as usize];

    let Machine { timer, mut psram } = Machine::take().expect("nobody else has the board");
    let clock = Clock::calibrated(timer).unwrap_or_else(|ticks| {
        eprintln!("nothing is reported: 200000 instructions took {ticks} ticks; run QEMU with -icount shift=6");
        process::exit(2)
    });
    print_head();
    let grid = Grid::new(WIDTH, HEIGHT, Margin::NONE, ROWS).expect("a size that can be laid out");
    let sources = sources::Memory::new(&mut psram, &grid).expect("memory enough");
    let mut lend = |words: usize| psram.lend(words, 0).expect("memory enough");
    let mut bench = Bench {
        clock,
        grid,
        sources,
        band: Grid::new(WIDTH, BAND, Margin::NONE, lend(BAND as usize)).expect("a size that can be laid out"),
        painted: lend(CELLS * MOST_WORDS),
        swept: [lend(CELLS * MOST_WORDS), lend(CELLS)],
        window_rows: lend(HEIGHT as usize),
        maps: [FRONT, BACK],
        scratch: Scratch { winners: WINNERS, edges: EDGES },
        push_pull: lend(PUSH_PULL_WORDS),
    };
    layouts::measure_all(&mut bench);
    measure_plain(clock, &mut psram);
    println!(
        "# {}: {} bytes of stack at most, this report's own included",
        env!("GALPIX_TARGET"),
        machine::stack_used()
    );
    process::exit(0)
}

/// The kernels beside the engine, one frame of each picture.
fn measure_plain(clock: Clock, psram: &mut Psram) {
    let (width, height) = (WIDTH as usize, HEIGHT as usize);
    let mut fixed = [(); 2].map(|()| psram.lend(CELLS, Fixed::default()).expect("memory enough"));
    let mut float = [(); 2].map(|()| psram.lend(CELLS, Float::default()).expect("memory enough"));
    for picture in Picture::ALL {
        picture.each(WIDTH as i32, HEIGHT as i32, |x, y, galpixel| {
            let cell = y as usize * width + x as usize;
            let argb = u32::from_be_bytes([255, galpixel.colour[0], galpixel.colour[1], galpixel.colour[2]]);
            let [vx, vy, _] = galpixel.velocity;
            let [exact_x, exact_y, depth] = [vx, vy, galpixel.depth].map(|number| (number.to_bits() >> 16) as i32);
            fixed[0][cell] = Fixed { offset: [0; 2], velocity: [exact_x, exact_y], depth, argb };
            let part = |bits: i32| bits as f32 / 65536.0;
            let velocity = [part(exact_x), part(exact_y)];
            float[0][cell] = Float { offset: [0.0; 2], velocity, depth: part(depth), argb };
        });
        let row = Row { layout: "", picture: picture.name(), mode: "-", stage: "sweep-alone", rung: "-" };
        let [old, new] = &mut fixed;
        let (ticks, ()) = clock.time(|| propagate_fixed(black_box(old), black_box(new), width, height));
        print(&Row { layout: "plain-i32", ..row }, ticks, WIDTH * HEIGHT);
        let [old, new] = &mut float;
        let (ticks, ()) = clock.time(|| propagate_float(black_box(old), black_box(new), width, height));
        print(&Row { layout: "plain-f32", ..row }, ticks, WIDTH * HEIGHT);
    }
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    eprintln!("{info}");
    process::exit(101)
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    eprintln!("hard fault at {:#010x}", frame.pc());
    process::exit(102)
}

#[exception]
unsafe fn DefaultHandler(number: i16) -> ! {
    eprintln!("exception {number}, which nothing here asks for");
    process::exit(103)
}
