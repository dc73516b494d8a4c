//! Pictures and masks.

use png::ColorType;

use super::super::colour::mask;
use super::encode::{self, Precision};
use super::folder::{Folder, H, SIZE, W, cells, check_refusal, colour, manifest, picture as read, source};
use crate::picture::Picture;

fn picture(bytes: Vec<u8>, channel: Option<&str>) -> Picture {
    read(&source("a.picture", bytes), channel, Some(SIZE)).unwrap()
}

#[test]
fn png_of_every_kind_is_read_exactly() {
    let (w, h) = (W as u32, H as u32);
    let wanted = cells(colour);
    let grey = cells(|x, y| (10 * x + 70 * y) as u8);
    let rgba = cells(|x, y| [colour(x, y).as_slice(), &[x as u8]].concat()).concat();
    let wide = |bytes: &[u8]| bytes.iter().map(|&b| u16::from(b) * 257).collect::<Vec<_>>();
    assert_eq!(picture(encode::png8(w, h, ColorType::Rgb, &wanted.concat()), None).pixels, wanted);
    assert_eq!(picture(encode::png8(w, h, ColorType::Rgba, &rgba), None).pixels, wanted);
    assert_eq!(picture(encode::png16(w, h, ColorType::Rgb, &wide(&wanted.concat())), None).pixels, wanted);
    assert_eq!(picture(encode::png16(w, h, ColorType::Rgba, &wide(&rgba)), None).pixels, wanted);
    let greys: Vec<[u8; 3]> = grey.iter().map(|&v| [v; 3]).collect();
    assert_eq!(picture(encode::png8(w, h, ColorType::Grayscale, &grey), None).pixels, greys);
    assert_eq!(picture(encode::png16(w, h, ColorType::Grayscale, &wide(&grey)), None).pixels, greys);
    let with_alpha: Vec<u8> = grey.iter().flat_map(|&v| [v, 7]).collect();
    assert_eq!(picture(encode::png8(w, h, ColorType::GrayscaleAlpha, &with_alpha), None).pixels, greys);
}

#[test]
fn sixteen_bits_are_rounded_to_the_nearest_code() {
    // 128 is just below half a step of 257, 129 just above.
    let values = [0, 128, 129, 257, 65_535, 65_406, 65_407, 32_768, 0, 0, 0, 0];
    let found = picture(encode::png16(4, 3, ColorType::Grayscale, &values), None).pixels;
    assert_eq!(found[..8].iter().map(|p| p[0]).collect::<Vec<_>>(), [0, 0, 1, 1, 255, 254, 255, 128]);
}

#[test]
fn jpeg_keeps_its_colours_and_their_places() {
    // Blocks of 16x16, so that no chroma is shared between colours.
    let colours = [[220, 40, 30], [30, 200, 60], [20, 60, 210]];
    let rgb: Vec<u8> = (0..32 * 48).flat_map(|i| colours[(i / 32 / 16 + i % 32 / 16) % 3]).collect();
    let found = read(&source("a.jpg", encode::jpeg(32, 48, &rgb)), None, None).unwrap();
    assert_eq!((found.width, found.height), (32, 48));
    for (found, wanted) in found.bytes().iter().zip(&rgb) {
        assert!(found.abs_diff(*wanted) <= 4, "{found} is not {wanted}");
    }
}

#[test]
fn exr_is_linear_light_under_any_of_its_names() {
    // sRGB codes by IEC 61966-2-1: 0.5 -> 188, 0.2140 -> 127, 0.002 -> 7 (linear part), above 1 -> 255, NaN -> 0.
    let level = [0.0, 0.002, 0.214_041, 0.5, 1.0, 7.0, -1.0, f32::NAN, 0.0, 0.0, 0.0, 0.0];
    let codes = [0, 7, 128, 188, 255, 255, 0, 0, 0, 0, 0, 0];
    let zero = vec![0.0; W * H];
    let check = |bytes: Vec<u8>, channel: Option<&str>| {
        let found = picture(bytes, channel).pixels;
        for (found, code) in found.iter().zip(codes) {
            assert!(found[1].abs_diff(code) <= 1 && found[0] == 0 && found[2] == 0, "{found:?} is not {code}");
        }
    };
    for precision in [Precision::Half, Precision::Float] {
        let named = |prefix: &str| {
            let names = ["R", "G", "B", "A"].map(|name| format!("{prefix}{name}"));
            let values = [zero.clone(), level.to_vec(), zero.clone(), vec![1.0; W * H]];
            encode::exr(W, H, precision, &encode::borrowed(&names.into_iter().zip(values).collect::<Vec<_>>()))
        };
        check(named(""), None);
        check(named("ViewLayer.Combined."), None);
        check(named("ViewLayer.Combined."), Some("ViewLayer.Combined"));
        check(named("ViewLayer.Combined."), Some("Combined"));
    }
    let part = |prefix: &str, green: &[f32]| {
        let names = ["R", "G", "B"].map(|n| format!("{prefix}{n}"));
        names.into_iter().zip([zero.clone(), green.to_vec(), zero.clone()]).collect::<Vec<_>>()
    };
    let parts = |prefix: &str, names: [&str; 2]| {
        let (wrong, right) = (part("", &[0.9; W * H]), part(prefix, &level));
        encode::exr_parts(W, H, &[(names[0], encode::borrowed(&wrong)), (names[1], encode::borrowed(&right))])
    };
    check(parts("", ["Albedo", "Combined"]), None);
    check(parts("", ["Albedo", "Combined"]), Some("Combined"));
    check(parts("ViewLayer.Combined.", ["Albedo", "ViewLayer.Combined"]), Some("ViewLayer.Combined"));
    let error = read(&source("a.exr", parts("", ["One", "Two"])), None, None).unwrap_err();
    check_refusal(&error, "a.exr", "more than one channel \"R\"");
    let error = read(&source("a.exr", parts("", ["One", "Two"])), Some("Beauty"), None).unwrap_err();
    check_refusal(&error, "a.exr", "no channel \"Beauty.R\"");
}

#[test]
fn the_update_may_be_an_exr_named_either_way() {
    let list = ["R", "G", "B"].map(|n| (format!("Layer.Combined.{n}"), vec![1.0; W * H]));
    let folder = Folder::new().with("all.exr", encode::exr(W, H, Precision::Half, &encode::borrowed(&list)));
    let folder = folder.with("f.flo", encode::pieh(4, 3, &[0.0; 24]));
    for colour in ["{ file = \"all.exr\", channel = \"Layer.Combined\" }", "\"all.exr\"\nchannel = \"Layer.Combined\""]
    {
        let text = manifest("{ kind = \"speed\" }", "{ kind = \"flow\", file = \"f.flo\" }", "")
            .replace("\"color.png\"", colour);
        let capture = folder.load(&text).unwrap();
        assert!(capture.update.samples.iter().all(|s| s.colour == [255; 3]));
    }
}

#[test]
fn a_mask_counts_where_any_colour_is_not_zero() {
    let wanted = cells(|x, y| x > y);
    let grey = cells(|x, y| if x > y { 1 } else { 0 });
    assert_eq!(mask(&source("m", encode::png8(4, 3, ColorType::Grayscale, &grey)), SIZE).unwrap(), wanted);
    let wide: Vec<u16> = grey.iter().map(|&v| u16::from(v)).collect();
    assert_eq!(mask(&source("m", encode::png16(4, 3, ColorType::Grayscale, &wide)), SIZE).unwrap(), wanted);
    // Only blue is set, and alpha is set everywhere.
    let rgba: Vec<u8> = grey.iter().flat_map(|&v| [0, 0, v, 255]).collect();
    assert_eq!(mask(&source("m", encode::png8(4, 3, ColorType::Rgba, &rgba)), SIZE).unwrap(), wanted);
    let opaque: Vec<u8> = grey.iter().flat_map(|&v| [v, 255]).collect();
    assert_eq!(mask(&source("m", encode::png8(4, 3, ColorType::GrayscaleAlpha, &opaque)), SIZE).unwrap(), wanted);
    let error = mask(&source("m.jpg", encode::jpeg(4, 3, &[0; 36])), SIZE).unwrap_err();
    check_refusal(&error, "m.jpg", "not a PNG");
}

#[test]
fn truths_come_in_the_order_of_their_frames_with_their_masks() {
    let folder = Folder::new()
        .with("f.flo", encode::pieh(4, 3, &[0.0; 24]))
        .with("late.png", encode::png8(4, 3, ColorType::Grayscale, &[9; 12]))
        .with("mask.png", encode::png8(4, 3, ColorType::Grayscale, &cells(|x, _| x as u8)));
    let truths =
        "[[truth]]\nframe = 8\ncolor = \"late.png\"\nmask = \"mask.png\"\n[[truth]]\nframe = 3\ncolor = \"color.png\"";
    let capture = folder.update("{ kind = \"speed\" }", "{ kind = \"flow\", file = \"f.flo\" }", truths).unwrap();
    assert_eq!(capture.truths.iter().map(|t| t.frame).collect::<Vec<_>>(), [3, 8]);
    assert_eq!(capture.truths[0].picture.pixels, cells(colour));
    assert_eq!(capture.truths[0].mask, None);
    assert_eq!(capture.truths[1].picture.pixels, vec![[9; 3]; 12]);
    assert_eq!(capture.truths[1].mask, Some(cells(|x, _| x > 0)));
    assert_eq!(capture.update.picture().pixels, cells(colour));
}
