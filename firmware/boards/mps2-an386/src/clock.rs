//! Instructions, counted by a timer.
//!
//! Under QEMU's `-icount shift=6` each instruction takes 64 ns of the guest's time, 1.6 ticks of the board's timer, and
//! a timer that is read is exact to the instruction. So a count repeats exactly. Without `-icount` the timer follows
//! the host's clock; then there is no [`Clock`] to be had.

use core::sync::atomic::{Ordering, compiler_fence};

use crate::machine::{Timer, two_instructions};

/// Iterations of a loop of two instructions, less and more: a difference of [`LOOPED`] instructions.
const LOOPS: [u32; 2] = [1_000, 101_000];

/// See [`LOOPS`].
const LOOPED: u64 = 200_000;

/// The ticks that these take.
const TICKS: u64 = 320_000;

/// By how much a reading may be off, for ticks are longer than instructions.
const TOLERANCE: u64 = 2;

/// How often the loop is timed. A host's clock may be right once.
const CALIBRATIONS: usize = 5;

/// A timer that counts instructions.
#[derive(Clone, Copy)]
pub struct Clock(Timer);

impl Clock {
    /// The timer, if it does count instructions.
    ///
    /// *Errors:* the ticks that the loop took, if not those that it must take.
    pub fn calibrated(timer: Timer) -> Result<Self, u64> {
        let clock = Self(timer);
        for _ in 0..CALIBRATIONS {
            let [less, more] = LOOPS.map(|times| clock.time_loop(times));
            let ticks = more.wrapping_sub(less);
            if ticks.abs_diff(TICKS) > TOLERANCE {
                return Err(ticks);
            }
        }
        Ok(clock)
    }

    /// The ticks of a loop. The same code for all of them, so that what lies around it falls out of their differences.
    #[inline(never)]
    fn time_loop(self, times: u32) -> u64 {
        self.time(|| two_instructions(times)).0
    }

    /// The ticks that some work takes, and what comes of it. Less than 2^32 ticks, 2.7 thousand million instructions.
    pub fn time<R>(self, work: impl FnOnce() -> R) -> (u64, R) {
        let start = self.0.now();
        compiler_fence(Ordering::SeqCst);
        let result = core::hint::black_box(work());
        compiler_fence(Ordering::SeqCst);
        (self.0.now().wrapping_sub(start).into(), result)
    }
}

/// Hundredths of an instruction for each of `parts`, to nearest.
pub fn hundredths(ticks: u64, parts: u32) -> u64 {
    let (instructions, parts) = (ticks * LOOPED * 100, TICKS * u64::from(parts));
    (instructions + parts / 2) / parts
}
