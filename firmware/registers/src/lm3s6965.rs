//! LM3S6965: the microcontroller of the board with the OLED.

crate::registers! {
    /// Clock gates of UARTs and SSI.
    RCGC1 = 0x400f_e104;
    /// Clock gates of the ports.
    RCGC2 = 0x400f_e108;

    /// Port A: which pins belong to a peripheral.
    GPIOA_AFSEL = 0x4000_4420;
    /// Port A: which pins are digital.
    GPIOA_DEN = 0x4000_451c;
    /// Port C, pin 7 only: the address masks the others.
    GPIOC_PIN7 = 0x4000_6000 + (0x80 << 2);
    /// Port C: which pins are outputs.
    GPIOC_DIR = 0x4000_6400;
    /// Port C: which pins drive 8 mA.
    GPIOC_DR8R = 0x4000_6508;
    /// Port C: which pins are digital.
    GPIOC_DEN = 0x4000_651c;

    /// SSI: format of a byte.
    SSI0_CR0 = 0x4000_8000;
    /// SSI: on or off.
    SSI0_CR1 = 0x4000_8004;
    /// SSI: a byte out, a byte in.
    SSI0_DR = 0x4000_8008;
    /// SSI: status.
    SSI0_SR = 0x4000_800c;
    /// SSI: clock divider.
    SSI0_CPSR = 0x4000_8010;

    /// UART: a byte out, a byte in.
    UART0_DR = 0x4000_c000;
    /// UART: flags.
    UART0_FR = 0x4000_c018;
    /// UART: whole part of the baud rate divisor.
    UART0_IBRD = 0x4000_c024;
    /// UART: 64ths of the baud rate divisor.
    UART0_FBRD = 0x4000_c028;
    /// UART: format and FIFOs.
    UART0_LCRH = 0x4000_c02c;
    /// UART: on or off.
    UART0_CTL = 0x4000_c030;
    /// UART: which interrupts are let through.
    UART0_IM = 0x4000_c038;
    /// UART: acknowledges interrupts.
    UART0_ICR = 0x4000_c044;
}
