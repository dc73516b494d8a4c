//! The interrupts: the vsync of the display controller, and bytes from the host.

use core::sync::atomic::{AtomicU32, Ordering};

use galpix_registers::vexpress::{
    GICC_CTLR, GICC_EOIR, GICC_IAR, GICC_PMR, GICD_CTLR, GICD_IPRIORITYR9, GICD_IPRIORITYR19, GICD_ISENABLER1,
    GICD_ISENABLER2, GICD_ITARGETSR9, GICD_ITARGETSR19, LCD_ICR, enable_interrupts,
};

use crate::uart;

/// Of the UART: a shared one, number 5.
const UART: u32 = 32 + 5;
/// Of the display controller: a shared one, number 44.
const LCD: u32 = 32 + 44;

static VSYNCS: AtomicU32 = AtomicU32::new(0);

/// Lets both through to this processor.
pub fn start() {
    GICD_CTLR.write(1);
    GICD_ISENABLER1.write(1 << (UART - 32));
    GICD_ISENABLER2.write(1 << (LCD - 64));
    // A byte for each interrupt: the UART's is the second of its word, the display's the first.
    GICD_ITARGETSR9.set(1 << 8);
    GICD_ITARGETSR19.set(1);
    GICD_IPRIORITYR9.set(0xa0 << 8);
    GICD_IPRIORITYR19.set(0xa0);
    GICC_PMR.write(0xf0);
    GICC_CTLR.write(1);
    enable_interrupts();
}

#[aarch32_rt::irq]
fn interrupt() {
    let taken = GICC_IAR.read();
    match taken & 0x3ff {
        LCD => {
            LCD_ICR.write(0xc);
            VSYNCS.store(VSYNCS.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
        }
        UART => uart::LINE.take(),
        _ => {}
    }
    GICC_EOIR.write(taken);
}

/// Sleeps until there have been other than `seen` vsyncs: how many there have been.
pub fn wait_beyond(seen: u32) -> u32 {
    loop {
        let now = VSYNCS.load(Ordering::Relaxed);
        if now != seen {
            return now;
        }
        // With interrupts held back none can come between the look and the sleep; it wakes the processor all the same.
        critical_section::with(|_| {
            if VSYNCS.load(Ordering::Relaxed) == seen {
                aarch32_cpu::asm::wfi();
            }
        });
    }
}
