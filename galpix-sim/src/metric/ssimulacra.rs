//! SSIMULACRA2, as its library computes it.

use ssimulacra2::{ColorPrimaries, Rgb, TransferCharacteristic, compute_frame_ssimulacra2};

use crate::picture::Picture;

/// Returns the score, or `None` where the library has none.
pub fn score(shown: &Picture, truth: &Picture) -> Option<f64> {
    let rgb = |picture: &Picture| {
        let pixels = picture.pixels.iter().map(|pixel| pixel.map(|channel| f32::from(channel) / 255.0)).collect();
        Rgb::new(pixels, picture.width, picture.height, TransferCharacteristic::SRGB, ColorPrimaries::BT709).ok()
    };
    compute_frame_ssimulacra2(rgb(truth)?, rgb(shown)?).ok().filter(|score| score.is_finite())
}
