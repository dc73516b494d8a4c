//! Chips and boards by name: memory and clock from their data sheets, cycles an instruction as a stated range.

/// A processor's instructions, and what stands in for them where they were not counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Core {
    /// Armv6-M: counted.
    M0,
    /// Armv7-M: counted.
    M3,
    /// Armv7E-M, and Armv8-M, which runs the same: counted.
    M4,
    /// Another one: as many instructions as between an M4 and an M0 takes.
    Other,
}

/// A chip or a board, and a panel that is usual for it.
#[derive(Clone, Copy, Debug)]
pub struct Board {
    /// Its name on the command line.
    pub name: &'static str,
    /// Chip and processor in words.
    pub chip: &'static str,
    /// What counts its instructions.
    pub core: Core,
    /// MHz.
    pub clock: f64,
    /// Cycles an instruction, from and to: an assumption that is printed.
    pub cycles: [f64; 2],
    /// KiB of RAM in one piece.
    pub ram: u32,
    /// KiB of flash.
    pub flash: u32,
    /// The panel.
    pub panel: Panel,
}

/// A panel and its bus.
#[derive(Clone, Copy, Debug)]
pub struct Panel {
    /// Its name.
    pub name: &'static str,
    /// Columns of pixels.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Bits of a pixel on the bus.
    pub bits: u32,
    /// Mbit/s of the bus; `None` for a panel that is scanned out of memory.
    pub bus: Option<f64>,
}

const fn spi(width: u32, height: u32, bus: f64) -> Panel {
    Panel { name: "ST7789", width, height, bits: 16, bus: Some(bus) }
}

/// Scanned out of a picture in memory.
const fn scanned(name: &'static str, width: u32, height: u32) -> Panel {
    Panel { name, width, height, bits: 16, bus: None }
}

const fn board([name, chip]: [&'static str; 2], core: Core, clock: f64, memory: [u32; 2], panel: Panel) -> Board {
    let cycles = match core {
        Core::M0 => [1.2, 1.8],
        Core::M3 | Core::M4 => [1.1, 1.6],
        Core::Other => [1.1, 2.0],
    };
    let [ram, flash] = memory;
    Board { name, chip, core, clock, cycles, ram, flash, panel }
}

/// All of them.
pub const ALL: [Board; 14] = [
    board(["rp2040", "RP2040, Cortex-M0+"], Core::M0, 125.0, [264, 2048], spi(320, 240, 62.5)),
    board(["rp2350", "RP2350, Cortex-M33"], Core::M4, 150.0, [520, 4096], spi(320, 240, 75.0)),
    board(["stm32f103", "STM32F103, Cortex-M3"], Core::M3, 72.0, [20, 64], spi(160, 128, 18.0)),
    board(["stm32f407", "STM32F407, Cortex-M4"], Core::M4, 168.0, [128, 1024], spi(240, 240, 42.0)),
    board(["stm32f429", "STM32F429 DISCO, Cortex-M4"], Core::M4, 180.0, [8192, 2048], scanned("LTDC", 240, 320)),
    Board {
        // Two instructions at once at best.
        cycles: [0.6, 1.1],
        ..board(["stm32h743", "STM32H743, Cortex-M7"], Core::M4, 480.0, [512, 2048], spi(320, 240, 60.0))
    },
    board(["nrf52840", "nRF52840, Cortex-M4"], Core::M4, 64.0, [256, 1024], spi(240, 240, 32.0)),
    board(["esp32c3", "ESP32-C3, RISC-V"], Core::Other, 160.0, [320, 4096], spi(320, 240, 40.0)),
    board(["esp32s3", "ESP32-S3, Xtensa LX7"], Core::Other, 240.0, [320, 8192], spi(320, 240, 80.0)),
    board(["samd51", "SAMD51, Cortex-M4"], Core::M4, 120.0, [192, 512], spi(240, 240, 24.0)),
    board(
        ["lm3s6965", "LM3S6965, Cortex-M3"],
        Core::M3,
        50.0,
        [64, 256],
        Panel { name: "SSD0323", width: 128, height: 64, bits: 4, bus: Some(10.0) },
    ),
    board(["vexpress-a9", "Cortex-A9, as a stand-in"], Core::M4, 400.0, [65_536, 65_536], scanned("PL111", 320, 240)),
    board(["artix", "Artix-7 35T, soft RV32 core"], Core::Other, 100.0, [225, 2048], spi(240, 240, 50.0)),
    board(["ecp5", "ECP5 45F, soft RV32 core"], Core::Other, 60.0, [243, 2048], spi(240, 240, 30.0)),
];

/// Returns the board of this name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Board> {
    ALL.iter().find(|board| board.name == name)
}
