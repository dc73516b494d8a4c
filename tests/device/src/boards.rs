//! The boards, and how their screens are read.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use galpix_link::panel::{Description, Lcd, Oled, Panel, Tft};
use galpix_sim::picture::Picture;

use crate::failure::Failure;

/// A board in the emulator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Board {
    /// The Cortex-M3 with the gray OLED.
    #[value(name = "lm3s6965evb")]
    Lm3s6965evb,
    /// The Raspberry Pi Pico with the colour panel over SPI.
    #[value(name = "rp2040")]
    Rp2040,
    /// The board with the PL111 and a colour panel.
    #[value(name = "vexpress-a9")]
    VexpressA9,
}

/// How a board's program fills what a frame uncovers. Each is a program of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filling {
    /// By the fill mode.
    FillMode,
    /// By push-pull after it: the feature `push-pull` of the boards.
    PushPull,
}

impl Filling {
    /// Returns what is added to the name of a program or a scene.
    pub const fn suffix(self) -> &'static str {
        match self {
            Self::FillMode => "",
            Self::PushPull => "-push-pull",
        }
    }
}

impl Board {
    /// All.
    pub const ALL: [Self; 3] = [Self::Lm3s6965evb, Self::Rp2040, Self::VexpressA9];

    /// Returns the ways of filling for which it has a program.
    pub const fn fillings(self) -> &'static [Filling] {
        match self {
            Self::Rp2040 => &[Filling::FillMode],
            Self::Lm3s6965evb | Self::VexpressA9 => &[Filling::FillMode, Filling::PushPull],
        }
    }

    /// Returns the programs of some boards: each with each of its ways of filling.
    pub fn programs(boards: &[Self]) -> impl Iterator<Item = (Self, Filling)> {
        boards.iter().flat_map(|&board| board.fillings().iter().map(move |&filling| (board, filling)))
    }

    /// Returns its name: the emulator's, and that of its program.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Lm3s6965evb => "lm3s6965evb",
            Self::Rp2040 => "rp2040",
            Self::VexpressA9 => "vexpress-a9",
        }
    }

    /// Returns its panel.
    pub const fn panel(self) -> Description {
        match self {
            Self::Lm3s6965evb => Oled::DESCRIPTION,
            Self::Rp2040 => Tft::DESCRIPTION,
            Self::VexpressA9 => Lcd::DESCRIPTION,
        }
    }

    /// Frames a second that its program makes if it is in time.
    pub const fn rate(self) -> f64 {
        match self {
            Self::Rp2040 => 15.0,
            Self::Lm3s6965evb | Self::VexpressA9 => 60.0,
        }
    }

    /// Frames after which the thresholds of its rounding come again.
    pub fn period(self) -> u32 {
        let scales = match self {
            Self::Lm3s6965evb => Oled::RECORD.scales,
            Self::Rp2040 => Tft::RECORD.scales,
            Self::VexpressA9 => Lcd::RECORD.scales,
        };
        scales.iter().map(|scale| 1 << scale.down).max().unwrap_or(1)
    }

    /// Returns its program.
    pub fn program(self, firmware: &Path, filling: Filling) -> PathBuf {
        let target = match self {
            Self::Lm3s6965evb => "thumbv7m-none-eabi",
            Self::Rp2040 => "thumbv6m-none-eabi",
            Self::VexpressA9 => "armv7a-none-eabi",
        };
        firmware.join("target").join(target).join("release").join(format!("{}{}", self.name(), filling.suffix()))
    }

    /// Returns the panel's pixels on the emulated screen, with 8 bits per channel as [`Self::shown`] makes them.
    ///
    /// The OLED is drawn four times as large by the emulator, the Pico's map twice as large by its program; each
    /// pixel's block must be of one colour. The LCD's pixels are as they are.
    pub fn pixels(self, screen: &Picture) -> Result<Picture, Failure> {
        let scale = match self {
            Self::Lm3s6965evb => 4,
            Self::Rp2040 => 2,
            Self::VexpressA9 => 1,
        };
        let (width, height) = (usize::from(self.panel().width), usize::from(self.panel().height));
        if (screen.width, screen.height) != (width * scale, height * scale) {
            return Err(Failure::new(format!(
                "{}: the screen has {} x {} pixels and not {} x {}",
                self.name(),
                screen.width,
                screen.height,
                width * scale,
                height * scale
            )));
        }
        let mut pixels = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let first = screen.at(x * scale, y * scale);
                let mut block = (0..scale * scale).map(|at| screen.at(x * scale + at % scale, y * scale + at / scale));
                if block.any(|pixel| pixel != first) {
                    return Err(Failure::new(format!("{}: a pixel of the screen has two colours", self.name())));
                }
                pixels.push(first);
            }
        }
        Ok(Picture { width, height, pixels })
    }

    /// Returns how the emulator shows a colour word: gray levels times 17, and the 5 or 6 bits of a channel at its top.
    pub fn shown(self, colour: u32) -> [u8; 3] {
        match self {
            Self::Lm3s6965evb => [(colour * 17) as u8; 3],
            Self::Rp2040 | Self::VexpressA9 => {
                [(colour >> 11 << 3) as u8, ((colour >> 5 & 63) << 2) as u8, ((colour & 31) << 3) as u8]
            }
        }
    }
}
