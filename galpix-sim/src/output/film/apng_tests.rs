//! Films are read back with the decoder of `png` and composed as the specification requires.

use super::*;
use crate::output::film::side_by_side;
use png::{Decoder, Transformations};
use std::io::Cursor;

struct Shown {
    frames: Vec<Picture>,
    plays: u32,
    delays: Vec<(u16, u16)>,
    stored_pixels: Vec<u32>,
}

/// Plays a film: every frame as a viewer shows it.
fn played(bytes: &[u8]) -> Shown {
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().expect("a header");
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    let control = reader.info().animation_control.expect("an animation");
    let mut canvas = Picture::filled(width, height, [1, 2, 3]);
    let mut shown =
        Shown { frames: Vec::new(), plays: control.num_plays, delays: Vec::new(), stored_pixels: Vec::new() };
    for _ in 0..control.num_frames {
        let mut buffer = vec![0; reader.output_buffer_size().expect("a size")];
        let output = reader.next_frame(&mut buffer).expect("a frame");
        let fctl = *reader.info().frame_control().expect("a frame control");
        let channels = output.color_type.samples();
        for (n, pixel) in buffer[..output.buffer_size()].chunks(channels).enumerate() {
            let x = fctl.x_offset as usize + n % fctl.width as usize;
            let y = fctl.y_offset as usize + n / fctl.width as usize;
            let opaque = channels == 3 || pixel[3] == 255;
            if opaque || fctl.blend_op == BlendOp::Source {
                assert!(opaque, "a pixel became transparent");
                canvas.pixels[y * width + x] = [pixel[0], pixel[1], pixel[2]];
            }
        }
        shown.frames.push(canvas.clone());
        shown.delays.push((fctl.delay_num, fctl.delay_den));
        shown.stored_pixels.push(fctl.width * fctl.height);
    }
    shown
}

/// Colours without pattern, many of them; the same at each run.
fn noise(width: usize, height: usize, seed: u32) -> Picture {
    let mut state = seed.wrapping_mul(2_654_435_761) | 1;
    let mut byte = || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        (state >> 24) as u8
    };
    Picture { width, height, pixels: (0..width * height).map(|_| [byte(), byte(), byte()]).collect() }
}

#[test]
fn an_exact_film_plays_back_bit_by_bit() {
    let still = noise(20, 16, 1);
    let frames: Vec<_> = (0..5).map(|n| side_by_side(&[&noise(20, 16, 7 + n / 2), &still], 2)).collect();
    let film = played(&apng(&frames, 80, Colours::Exact).expect("a film"));
    assert_eq!(film.frames, frames);
    assert_eq!(film.plays, 0, "0 is for ever");
    assert_eq!(film.delays, vec![(80, 1000); 5]);
    // frames 1 and 3 repeat the one before: one pixel; 2 and 4 change the left panel alone
    assert_eq!(film.stored_pixels, [42 * 16, 1, 20 * 16, 1, 20 * 16]);
}

#[test]
fn scattered_changes_leave_the_rest_transparent() {
    let first = noise(40, 40, 3);
    let mut second = first.clone();
    (second.pixels[0], second.pixels[820], second.pixels[1599]) = ([9, 8, 7], [6, 5, 4], [3, 2, 1]);
    let frames = [first.clone(), second, first.clone()];
    let bytes = apng(&frames, 40, Colours::Exact).expect("a film");
    assert_eq!(played(&bytes).frames, frames);
    let alone = apng(&frames[..1], 40, Colours::Exact).expect("a film").len();
    assert!(bytes.len() < alone + 400, "two frames of three pixels took {} bytes", bytes.len() - alone);
}

#[test]
fn few_colours_are_exact_in_both_modes() {
    let frames: Vec<_> = (0..3).map(|n| Picture::filled(5, 4, [n, 0, 200])).collect();
    for colours in [Colours::Exact, Colours::Palette] {
        assert_eq!(played(&apng(&frames, 40, colours).expect("a film")).frames, frames);
    }
}

#[test]
fn a_film_too_large_becomes_a_palette() {
    let frames: Vec<_> = (0..4).map(|n| noise(32, 32, n)).collect();
    let (exact, colours) = apng_within(&frames, 40, usize::MAX).expect("a film");
    assert_eq!(colours, Colours::Exact);
    let (small, colours) = apng_within(&frames, 40, exact.len() - 1).expect("a film");
    assert_eq!(colours, Colours::Palette);
    assert!(small.len() < exact.len() / 2, "{} of {}", small.len(), exact.len());
    assert_eq!(apng(&frames, 40, Colours::Palette).expect("a film"), small, "the same at each run");
    assert!(played(&small).frames.iter().zip(&frames).all(|(a, b)| crate::metric::psnr_db(a, b, None) > Some(15.0)));
}

#[test]
fn a_film_of_one_pixel() {
    let frames = [Picture::filled(1, 1, [1, 2, 3]), Picture::filled(1, 1, [1, 2, 3])];
    assert_eq!(played(&apng(&frames, 0, Colours::Exact).expect("a film")).frames, frames);
}

#[test]
fn unusable_frames_are_refused_with_a_sentence() {
    let (small, large) = (Picture::filled(2, 2, [0; 3]), Picture::filled(3, 2, [0; 3]));
    let torn = Picture { width: 2, height: 2, pixels: vec![[0; 3]; 3] };
    let refused = |frames: &[Picture]| apng(frames, 40, Colours::Exact).expect_err("no film").to_string();
    assert_eq!(refused(&[]), "a film needs at least one frame, of at least one pixel");
    assert_eq!(refused(&[Picture::filled(0, 4, [0; 3])]), refused(&[]));
    assert!(refused(&[small.clone(), large]).starts_with("frame 1 of the film is not 2x2"));
    assert!(refused(&[small, torn]).starts_with("frame 1 of the film is not 2x2"));
}
