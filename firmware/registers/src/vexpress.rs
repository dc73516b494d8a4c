//! Versatile Express A9: the board with the PL111 display controller.

crate::registers! {
    /// Display: horizontal timing.
    LCD_TIMING0 = 0x1002_0000;
    /// Display: vertical timing.
    LCD_TIMING1 = 0x1002_0004;
    /// Display: clocks.
    LCD_TIMING2 = 0x1002_0008;
    /// Display: where the picture is, from the next one on. The display only reads there.
    LCD_UPBASE = 0x1002_0010;
    /// Display: on or off, and the form of a pixel.
    LCD_CONTROL = 0x1002_0018;
    /// Display: which interrupts are let through.
    LCD_IMSC = 0x1002_001c;
    /// Display: which interrupts wait.
    LCD_RIS = 0x1002_0020;
    /// Display: acknowledges interrupts.
    LCD_ICR = 0x1002_0028;

    /// UART: a byte out, a byte in.
    UART0_DR = 0x1000_9000;
    /// UART: flags.
    UART0_FR = 0x1000_9018;
    /// UART: format and FIFOs.
    UART0_LCRH = 0x1000_902c;
    /// UART: on or off.
    UART0_CR = 0x1000_9030;
    /// UART: which interrupts are let through.
    UART0_IMSC = 0x1000_9038;
    /// UART: acknowledges interrupts.
    UART0_ICR = 0x1000_9044;

    /// Private timer: starts here again.
    TIMER_LOAD = 0x1e00_0600;
    /// Private timer: counts down.
    TIMER_COUNTER = 0x1e00_0604;
    /// Private timer: on or off.
    TIMER_CONTROL = 0x1e00_0608;

    /// Interrupt controller, processor's side: on or off.
    GICC_CTLR = 0x1e00_0100;
    /// Interrupt controller: lowest priority that is let through.
    GICC_PMR = 0x1e00_0104;
    /// Interrupt controller: takes the next interrupt.
    GICC_IAR = 0x1e00_010c;
    /// Interrupt controller: gives it back.
    GICC_EOIR = 0x1e00_0110;
    /// Interrupt controller, devices' side: on or off.
    GICD_CTLR = 0x1e00_1000;
    /// Interrupt controller: enables interrupts 32 to 63.
    GICD_ISENABLER1 = 0x1e00_1104;
    /// Interrupt controller: enables interrupts 64 to 95.
    GICD_ISENABLER2 = 0x1e00_1108;
    /// Interrupt controller: priorities of interrupts 36 to 39, a byte each.
    GICD_IPRIORITYR9 = 0x1e00_1424;
    /// Interrupt controller: priorities of interrupts 76 to 79.
    GICD_IPRIORITYR19 = 0x1e00_144c;
    /// Interrupt controller: processors for interrupts 36 to 39.
    GICD_ITARGETSR9 = 0x1e00_1824;
    /// Interrupt controller: processors for interrupts 76 to 79.
    GICD_ITARGETSR19 = 0x1e00_184c;
}

/// Lets interrupts through to the processor: only handlers that are safe at any time may stand behind them.
#[cfg(feature = "vexpress")]
pub fn enable_interrupts() {
    // SAFETY: the handlers of the firmware use atomics and critical sections only; it is called once, outside of any.
    unsafe { aarch32_cpu::interrupt::enable() }
}
