//! The seam: what a board gives. Everything else is shared.

use embedded_graphics::draw_target::DrawTarget;
use galpix_core::scan_out::PanelColour;

/// A board with its panel.
pub trait Board {
    /// A pixel of its panel.
    type Pixel: PanelColour;
    /// What a band of the picture is drawn on. Its coordinates are those of the whole panel; what lies outside of the
    /// band is not drawn. A pixel that it refuses is left out of the picture.
    type Band: DrawTarget<Color = Self::Pixel>;

    /// Ticks of [`Self::ticks`] between two vsyncs.
    const TICKS_PER_FRAME: u32;

    /// Waits for the panel's next vsync. Returns how many there were since the last call: 1 if the frame was in time.
    fn vsync(&mut self) -> u32;

    /// A clock; wraps.
    fn ticks(&self) -> u32;

    /// Bytes of the stack that were ever used, and bytes that it has; 0 if the board does not know.
    fn stack(&self) -> (u32, u32) {
        (0, 0)
    }

    /// Lets `draw` draw the whole picture, band by band from the top, each with its first row and its rows; then the
    /// panel shows it.
    fn show(&mut self, draw: impl FnMut(&mut Self::Band, u32, u32));

    /// The next byte from the host, if one has come. None ever comes to a board without a line.
    fn receive(&mut self) -> Option<u8> {
        None
    }

    /// Sends a byte to the host, once there is room. A board without a line drops it.
    fn send(&mut self, _byte: u8) {}
}
