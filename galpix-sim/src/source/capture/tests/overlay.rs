//! What a capture pins over its picture.

use png::ColorType;

use super::encode;
use super::folder::{Folder, H, W, cells, colour, manifest};
use crate::overlay::Overlay;

const SPEED: &str = "{ kind = \"speed\" }";
const FLOW: &str = "{ kind = \"flow\", file = \"f.flo\" }";
const HUD: &str = "overlay = { file = \"hud.png\" }";

fn folder() -> Folder {
    Folder::new().with("f.flo", encode::pieh(4, 3, &[0.0; 24]))
}

/// Returns the pixels of `[1, x, y]` with these alphas.
fn rgba(alpha: impl Fn(usize, usize) -> u8) -> Vec<u8> {
    let pixels = cells(|x, y| [1, x as u8, y as u8, alpha(x, y)]).concat();
    encode::png8(W as u32, H as u32, ColorType::Rgba, &pixels)
}

#[test]
fn opaque_pixels_are_pinned_and_nothing_else_changes() {
    let without = folder().update(SPEED, FLOW, "").unwrap();
    let capture = folder().with("hud.png", rgba(|x, y| if x > y { 255 } else { 0 })).update(SPEED, FLOW, HUD).unwrap();
    let expected = Overlay::draw(W, H, |x, y| (x > y).then_some([1, x as u8, y as u8]));
    assert_eq!(capture.update.overlay, Some(expected));
    assert_eq!(capture.update.samples, without.update.samples);
    assert_eq!(capture.census, without.census);
    let shown = cells(|x, y| if x > y { [1, x as u8, y as u8] } else { colour(x, y) });
    assert_eq!(capture.update.picture().pixels, shown);
    assert_eq!(without.update.overlay, None);
}

#[test]
fn what_is_translucent_is_pinned_from_one_half_on_and_noted() {
    let alphas = [0, 1, 127, 128, 254, 255, 0, 0, 0, 0, 0, 0];
    let folder = folder().with("hud.png", rgba(|x, y| alphas[y * W + x]));
    let capture = folder.update(SPEED, FLOW, HUD).unwrap();
    let pinned: Vec<bool> = capture.update.overlay.unwrap().pixels.iter().map(Option::is_some).collect();
    assert_eq!(pinned, alphas.map(|alpha| alpha >= 128));
    assert!(capture.census.notes[0].starts_with("4 translucent pixels"), "{:?}", capture.census.notes);
}

#[test]
fn grey_with_alpha_is_an_overlay_too() {
    let pixels = cells(|x, _| [10 * x as u8, if x == 2 { 255 } else { 0 }]).concat();
    let folder = folder().with("hud.png", encode::png8(W as u32, H as u32, ColorType::GrayscaleAlpha, &pixels));
    let capture = folder.update(SPEED, FLOW, HUD).unwrap();
    assert_eq!(capture.update.overlay, Some(Overlay::draw(W, H, |x, _| (x == 2).then_some([20; 3]))));
}

#[test]
fn overlays_that_cannot_be_are_refused() {
    let text = manifest(SPEED, FLOW, HUD);
    folder().refused(&text, "hud.png", "cannot be read");
    let rgb: Vec<u8> = cells(colour).concat();
    folder().with("hud.png", encode::png8(4, 3, ColorType::Rgb, &rgb)).refused(&text, "hud.png", "has no alpha");
    folder().with("hud.png", encode::pieh(4, 3, &[0.0; 24])).refused(&text, "hud.png", "is not a PNG");
    let small = encode::png8(2, 3, ColorType::Rgba, &[255; 24]);
    folder().with("hud.png", small).refused(&text, "hud.png", "is 2x3 but the update's colour is 4x3");
    let whole = rgba(|_, _| 255);
    folder().with("hud.png", &whole[..whole.len() - 9]).refused(&text, "hud.png", "truncated or damaged");
    folder().refused(&manifest(SPEED, FLOW, "overlay = { file = \"hud.png\", alpha = 3 }"), "capture.toml", "alpha");
    folder().refused(&manifest(SPEED, FLOW, "overlay = {}"), "capture.toml", "file");
}
