//! The serial bus to the panel, which only sends.

use galpix_registers::lm3s6965::{
    GPIOA_AFSEL, GPIOA_DEN, RCGC1, RCGC2, SSI0_CPSR, SSI0_CR0, SSI0_CR1, SSI0_DR, SSI0_SR,
};

const IS_EMPTY: u32 = 1 << 0;
const CAN_SEND: u32 = 1 << 1;
const HAS_RECEIVED: u32 = 1 << 2;
const BUSY: u32 = 1 << 4;
/// Clock, select and data out of port A.
const PINS: u32 = 0x2c;

/// Starts it: 8 bits, the clock idles high and the panel takes the second edge, half of the processor's clock.
pub fn start() {
    RCGC1.set(1 << 4);
    RCGC2.set(1);
    // A peripheral needs some clocks until it may be touched.
    let _ = RCGC2.read();
    GPIOA_AFSEL.set(PINS);
    GPIOA_DEN.set(PINS);
    SSI0_CR1.write(0);
    SSI0_CPSR.write(2);
    SSI0_CR0.write(0xc7);
    SSI0_CR1.write(1 << 1);
}

/// Sends a byte, once there is room.
#[inline(always)]
pub fn send(byte: u8) {
    SSI0_SR.wait_for(CAN_SEND);
    SSI0_DR.write(u32::from(byte));
    drain();
}

/// Sends eight bytes, once all before are out: as many as the hardware holds.
#[inline(always)]
pub fn send_eight(bytes: [u8; 8]) {
    SSI0_SR.wait_for(IS_EMPTY);
    for byte in bytes {
        SSI0_DR.write(u32::from(byte));
    }
    // What came in meanwhile; reading when there is nothing does no harm.
    for _ in bytes {
        let _ = SSI0_DR.read();
    }
}

/// Waits until everything is out.
pub fn finish() {
    while SSI0_SR.read() & BUSY != 0 {}
    drain();
}

/// Throws away what came in: for each byte out there is one, and when eight wait nothing goes out any more.
#[inline(always)]
fn drain() {
    while SSI0_SR.read() & HAS_RECEIVED != 0 {
        let _ = SSI0_DR.read();
    }
}
