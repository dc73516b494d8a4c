//! What is pinned over the picture, as a renderer or a capture delivers it: apart from the picture, so that it never
//! moves.

use galpix_core::overlay;

use crate::picture::Picture;

/// A surface of the display's size of which some pixels are pinned: they are shown in every frame, whatever moves
/// underneath.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Overlay {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `[red, green, blue]` where something is pinned, row-major.
    pub pixels: Vec<Option<[u8; 3]>>,
}

impl Overlay {
    /// Returns a surface with what `pinned` returns for each column and row.
    #[must_use]
    pub fn draw(width: usize, height: usize, pinned: impl Fn(usize, usize) -> Option<[u8; 3]>) -> Self {
        let pixels = (0..width * height).map(|cell| pinned(cell % width, cell / width)).collect();
        Self { width, height, pixels }
    }

    /// Returns a picture under this surface.
    #[must_use]
    pub fn over(&self, mut picture: Picture) -> Picture {
        for (pixel, pinned) in picture.pixels.iter_mut().zip(&self.pixels) {
            *pixel = pinned.unwrap_or(*pixel);
        }
        picture
    }

    /// Returns how many pixels are pinned.
    #[must_use]
    pub fn pinned(&self) -> usize {
        self.pixels.iter().flatten().count()
    }

    /// Pins the same in the core's form, whose size must be this one's.
    pub fn pin(&self, to: &mut overlay::Overlay<'_>) {
        for (y, row) in (0..).zip(self.pixels.chunks(self.width.max(1))) {
            for (x, pinned) in (0..).zip(row) {
                if let Some(colour) = pinned {
                    to.pin(x, y, *colour);
                }
            }
        }
    }
}
