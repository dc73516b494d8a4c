//! A picture in memory: what a renderer delivers, what a display shows, what a truth looks like.

use std::path::Path;

use png::{BitDepth, ColorType, Compression};

/// An 8-bit sRGB picture, rows from top to bottom, `width * height` pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `[red, green, blue]`, row-major.
    pub pixels: Vec<[u8; 3]>,
}

impl Picture {
    /// A picture of one colour.
    #[must_use]
    pub fn filled(width: usize, height: usize, colour: [u8; 3]) -> Self {
        Self { width, height, pixels: vec![colour; width * height] }
    }

    /// Returns the pixel in column `x` of row `y`. Panics outside of the picture.
    #[must_use]
    pub fn at(&self, x: usize, y: usize) -> [u8; 3] {
        self.pixels[y * self.width + x]
    }

    /// Returns the pixels as one run of bytes, red first.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        self.pixels.as_flattened()
    }

    /// Returns the window of `width` x `height` pixels whose top left corner is (`left`, `top`). Panics if it is not
    /// inside.
    #[must_use]
    pub fn crop(&self, left: usize, top: usize, width: usize, height: usize) -> Self {
        let pixels =
            (top..top + height).flat_map(|y| self.pixels[y * self.width + left..][..width].iter().copied()).collect();
        Self { width, height, pixels }
    }

    /// Returns the picture as an 8-bit PNG.
    pub fn png(&self) -> std::io::Result<Vec<u8>> {
        self.png_with(&[])
    }

    /// Returns the same with texts, each with its keyword, for who reads more than pixels.
    pub fn png_with(&self, texts: &[(&str, &str)]) -> std::io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::Fast);
        for &(keyword, text) in texts {
            encoder.add_text_chunk(keyword.to_owned(), text.to_owned())?;
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.bytes())?;
        writer.finish()?;
        Ok(bytes)
    }

    /// Writes the picture as an 8-bit PNG, whole or not at all.
    pub fn write_png(&self, path: &Path) -> std::io::Result<()> {
        crate::output::html::write_atomically(path, &self.png()?)
    }
}
