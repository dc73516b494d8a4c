//! The scenes themselves.

use super::body::{Body, Number, Outline, Path, Pattern, Scene, Texture};

const fn squares(size_log2: u32, colours: [[u8; 3]; 2]) -> Texture {
    Texture { pattern: Pattern::Squares, size_log2, colours }
}

const fn number(text: &str) -> Number {
    Number::lit(text)
}

/// There and back at one speed: `frames` frames each way.
const fn swing(start: &str, velocity: &str, frames: u32) -> Path {
    Path { velocity: number(velocity), period: frames, mirrored: true, ..Path::still(number(start)) }
}

/// All built-in scenes; a scene's number on the line is its place here.
pub const ALL: [Scene; 3] = [
    Scene {
        name: "bounce",
        bodies: &[
            Body {
                outline: Outline::Disc(9),
                texture: squares(2, [[240, 96, 32], [255, 220, 160]]),
                depth: 3,
                paths: [
                    swing("-44", "0.8125", 108),
                    // Up and down again in 60 frames, and then anew.
                    Path {
                        velocity: number("-1.796875"),
                        acceleration: number("0.060546875"),
                        period: 60,
                        ..Path::still(number("20"))
                    },
                ],
            },
            Body {
                outline: Outline::Rectangle(70, 4),
                texture: Texture { pattern: Pattern::Bars, size_log2: 3, colours: [[32, 160, 96], [16, 96, 64]] },
                depth: 8,
                paths: [Path::still(Number::ZERO), Path::still(number("30"))],
            },
            Body {
                outline: Outline::All,
                texture: squares(3, [[40, 48, 88], [64, 80, 136]]),
                depth: 14,
                paths: [Path::still(Number::ZERO), Path::still(Number::ZERO)],
            },
        ],
    },
    Scene {
        name: "crossing",
        bodies: &[
            Body {
                outline: Outline::Disc(12),
                texture: squares(2, [[224, 208, 48], [128, 96, 16]]),
                depth: 2,
                paths: [swing("-48", "1.5", 64), swing("-8", "0.25", 64)],
            },
            Body {
                outline: Outline::Rectangle(10, 14),
                texture: squares(2, [[48, 176, 224], [16, 64, 112]]),
                depth: 6,
                paths: [swing("48", "-1.25", 77), swing("6", "-0.125", 77)],
            },
            Body {
                outline: Outline::All,
                texture: Texture { pattern: Pattern::Grid, size_log2: 3, colours: [[24, 24, 32], [120, 120, 144]] },
                depth: 14,
                paths: [swing("0", "0.3125", 200), swing("0", "0.15625", 200)],
            },
        ],
    },
    Scene {
        name: "pan",
        bodies: &[
            Body {
                outline: Outline::Rectangle(6, 22),
                texture: squares(1, [[208, 48, 64], [112, 16, 32]]),
                depth: 3,
                paths: [swing("40", "-3.0", 28), Path::still(number("4"))],
            },
            Body {
                outline: Outline::Rectangle(6, 16),
                texture: squares(1, [[64, 192, 80], [24, 96, 40]]),
                depth: 8,
                paths: [swing("-10", "-1.5", 28), Path::still(number("8"))],
            },
            Body {
                outline: Outline::All,
                texture: squares(3, [[96, 88, 72], [160, 152, 128]]),
                depth: 14,
                paths: [swing("0", "-0.75", 28), Path::still(Number::ZERO)],
            },
        ],
    },
];
