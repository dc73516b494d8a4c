//! A line of text over the picture: the frame counter and what the frame counted.
//!
//! It is drawn over each band after the galpixmap, and never into it: what it covers goes on moving underneath.

use embedded_graphics::Drawable;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Dimensions, Point};
use embedded_graphics::mono_font::ascii::FONT_4X6;
use embedded_graphics::mono_font::{MonoTextStyle, MonoTextStyleBuilder};
use embedded_graphics::pixelcolor::PixelColor;
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::{Baseline, Text};
use galpix_core::Tally;
use heapless::String;

/// Where its text begins.
const CORNER: Point = Point::new(1, 1);

/// The line of one frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Overlay {
    text: String<48>,
}

impl Overlay {
    /// The line for a frame with this counter.
    #[must_use]
    pub fn new(frame: u32, tally: &Tally) -> Self {
        let mut overlay = Self::default();
        overlay.number("f", frame);
        overlay.number(" lost", tally.lost);
        overlay.number(" hit", tally.collided);
        overlay.number(" holes", tally.holes);
        overlay
    }

    /// Appends a name and a number; what is too long is cut off.
    fn number(&mut self, name: &str, number: u32) {
        let _ = self.text.push_str(name);
        let _ = self.text.push(' ');
        let mut rest = number;
        let mut begun = false;
        for power in [1_000_000_000, 100_000_000, 10_000_000, 1_000_000, 100_000, 10_000, 1000, 100, 10, 1] {
            // Digits by subtraction: this is part of every frame, and some processors have no divider.
            let mut digit = b'0';
            while rest >= power {
                rest -= power;
                digit += 1;
            }
            begun |= digit > b'0' || power == 1;
            if begun {
                let _ = self.text.push(char::from(digit));
            }
        }
    }

    /// The text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Draws the line where it meets rows `top` to `top + rows` of the panel.
    pub fn draw<C: PixelColor, D: DrawTarget<Color = C>>(
        &self,
        target: &mut D,
        (top, rows): (u32, u32),
        [ink, ground]: [C; 2],
    ) -> Result<(), D::Error> {
        let style: MonoTextStyle<'_, C> =
            MonoTextStyleBuilder::new().font(&FONT_4X6).text_color(ink).background_color(ground).build();
        let text = Text::with_baseline(&self.text, CORNER, style, Baseline::Top);
        let Rectangle { top_left, size } = text.bounding_box();
        if (top as i32) < top_left.y + size.height as i32 && top_left.y < (top + rows) as i32 {
            text.draw(target)?;
        }
        Ok(())
    }
}
