//! The line to the host: 115 200 baud, received by interrupt into a queue.
//!
//! When the queue is full the interrupt is held back until it is empty: the bytes stay in the hardware, which
//! stops the sender where the line has flow control.

use core::cell::RefCell;

use critical_section::Mutex;
use galpix_registers::lm3s6965::{
    RCGC1, UART0_CTL, UART0_DR, UART0_FBRD, UART0_FR, UART0_IBRD, UART0_ICR, UART0_IM, UART0_LCRH, unmask,
};
use heapless::Deque;
use lm3s6965::{Interrupt, interrupt};

/// Bytes of the queue: those of five frames of the display.
pub const QUEUE: usize = 1024;

const RECEIVE_EMPTY: u32 = 1 << 4;
const SEND_FULL: u32 = 1 << 5;
/// Interrupts for bytes that have come: enough of them, or none after them for a while.
const RECEIVED: u32 = 1 << 4 | 1 << 6;

static QUEUED: Mutex<RefCell<Deque<u8, QUEUE>>> = Mutex::new(RefCell::new(Deque::new()));

/// Starts it.
pub fn start() {
    RCGC1.set(1);
    let _ = RCGC1.read();
    UART0_CTL.write(0);
    // 12.5 MHz / (16 * 115 200) = 6 + 50/64.
    UART0_IBRD.write(6);
    UART0_FBRD.write(50);
    UART0_LCRH.write(0x70);
    UART0_CTL.write(0x301);
    UART0_IM.write(RECEIVED);
    unmask(Interrupt::UART0 as u16);
}

#[interrupt]
fn UART0() {
    critical_section::with(|section| {
        let mut queued = QUEUED.borrow_ref_mut(section);
        // First of all: what comes while the bytes are taken out asks again.
        UART0_ICR.write(RECEIVED);
        fill(&mut queued);
    });
}

/// Takes what the hardware holds, as far as there is room.
fn fill(queued: &mut Deque<u8, QUEUE>) {
    while UART0_FR.read() & RECEIVE_EMPTY == 0 {
        if queued.is_full() {
            UART0_IM.write(0);
            return;
        }
        let _ = queued.push_back(UART0_DR.read() as u8);
    }
}

/// The next byte that has come.
pub fn receive() -> Option<u8> {
    critical_section::with(|section| {
        let mut queued = QUEUED.borrow_ref_mut(section);
        if queued.is_empty() {
            // Also what came while the interrupt was held back.
            fill(&mut queued);
            UART0_IM.write(RECEIVED);
        }
        queued.pop_front()
    })
}

/// Sends a byte, once there is room.
pub fn send(byte: u8) {
    while UART0_FR.read() & SEND_FULL != 0 {}
    UART0_DR.write(u32::from(byte));
}
