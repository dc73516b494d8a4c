//! The line to the host, received by interrupt into a queue: for the PL011 and what is built like it.
//!
//! When the queue is full the interrupt is held back until it is empty: the bytes stay in the hardware, which stops the
//! sender where the line has flow control.

#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

use core::cell::RefCell;

use critical_section::Mutex;
use galpix_registers::Register;
use heapless::Deque;

const RECEIVE_EMPTY: u32 = 1 << 4;
const SEND_FULL: u32 = 1 << 5;
/// Interrupts for bytes that have come: enough of them, or none after them for a while.
const RECEIVED: u32 = 1 << 4 | 1 << 6;

/// Where the parts of the hardware are on a board.
#[derive(Debug)]
pub struct Registers {
    /// A byte that has come or goes.
    pub data: Register,
    /// Whether there is one, and room for one.
    pub flags: Register,
    /// Which interrupts are let through.
    pub mask: Register,
    /// Takes back what interrupts ask for.
    pub clear: Register,
}

/// A line with a queue of `QUEUE` bytes.
#[derive(Debug)]
pub struct Uart<const QUEUE: usize> {
    registers: Registers,
    queued: Mutex<RefCell<Deque<u8, QUEUE>>>,
}

impl<const QUEUE: usize> Uart<QUEUE> {
    /// A line that has not been started.
    #[must_use]
    pub const fn new(registers: Registers) -> Self {
        Self { registers, queued: Mutex::new(RefCell::new(Deque::new())) }
    }

    /// Lets the interrupt through. Rate and format are the board's to set before.
    pub fn start(&self) {
        self.registers.mask.write(RECEIVED);
    }

    /// Takes what has come: the interrupt.
    pub fn take(&self) {
        critical_section::with(|section| {
            let mut queued = self.queued.borrow_ref_mut(section);
            // First of all: what comes while the bytes are taken out asks again.
            self.registers.clear.write(RECEIVED);
            self.fill(&mut queued);
        });
    }

    /// Takes what the hardware holds, as far as there is room.
    fn fill(&self, queued: &mut Deque<u8, QUEUE>) {
        while self.registers.flags.read() & RECEIVE_EMPTY == 0 {
            if queued.is_full() {
                self.registers.mask.write(0);
                return;
            }
            let _ = queued.push_back(self.registers.data.read() as u8);
        }
    }

    /// The next byte that has come.
    pub fn receive(&self) -> Option<u8> {
        critical_section::with(|section| {
            let mut queued = self.queued.borrow_ref_mut(section);
            if queued.is_empty() {
                // Also what came while the interrupt was held back.
                self.fill(&mut queued);
                self.registers.mask.write(RECEIVED);
            }
            queued.pop_front()
        })
    }

    /// Sends a byte, once there is room.
    pub fn send(&self, byte: u8) {
        while self.registers.flags.read() & SEND_FULL != 0 {}
        self.registers.data.write(u32::from(byte));
    }
}
