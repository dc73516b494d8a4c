//! RP2040: the microcontroller of the Raspberry Pi Pico. Its other registers are those of its HAL.

crate::registers! {
    /// UART: a byte out, a byte in.
    UART0_DR = 0x4003_4000;
    /// UART: flags.
    UART0_FR = 0x4003_4018;
    /// UART: which interrupts are let through.
    UART0_IM = 0x4003_4038;
    /// UART: acknowledges interrupts.
    UART0_ICR = 0x4003_4044;
}

/// The second-stage boot loader, which makes the flash of a Pico readable as memory: the first 256 bytes of it.
#[cfg(target_os = "none")]
// SAFETY: the linker script keeps this section for the boot loader alone.
#[unsafe(link_section = ".boot2")]
#[used]
static BOOT_LOADER: [u8; 256] = rp2040_boot2::BOOT_LOADER_W25Q080;
