//! Maps of one number per pixel, read back as they were written.

use half::f16;
use png::ColorType;

use super::super::manifest::MapFormat;
use super::encode::{self, Precision};
use super::folder::{H, W, cells, check_refusal, near, numbers, source};

#[track_caller]
fn read(bytes: Vec<u8>, channel: Option<&str>, format: MapFormat, wanted: &[f64]) {
    near(&numbers(&source("a.map", bytes), channel, format).unwrap(), wanted, 0.0);
}

#[track_caller]
fn refused(bytes: Vec<u8>, channel: Option<&str>, format: MapFormat, what: &str) {
    let error = numbers(&source("a.map", bytes), channel, format).unwrap_err();
    check_refusal(&error, "a.map", what);
}

/// Values that half floats hold exactly.
fn value(x: usize, y: usize) -> f32 {
    0.5 + x as f32 + 16.0 * y as f32
}

#[test]
fn png_maps_are_raw_numbers() {
    let narrow = cells(|x, y| (x + 50 * y) as u8);
    let wide = cells(|x, y| (1000 * x + 20_000 * y) as u16);
    let [narrow_raw, wide_raw] =
        [narrow.iter().map(|&v| f64::from(v)).collect(), wide.iter().map(|&v| f64::from(v)).collect::<Vec<_>>()];
    let narrow_raw: Vec<f64> = narrow_raw;
    read(encode::png8(4, 3, ColorType::Grayscale, &narrow), None, MapFormat::Raw, &narrow_raw);
    read(encode::png16(4, 3, ColorType::Grayscale, &wide), None, MapFormat::Raw, &wide_raw);
    let repeated: Vec<u8> = narrow.iter().flat_map(|&v| [v; 3]).collect();
    read(encode::png8(4, 3, ColorType::Rgb, &repeated), None, MapFormat::Raw, &narrow_raw);
    let mut coloured = repeated;
    coloured[35] ^= 1;
    refused(encode::png8(4, 3, ColorType::Rgb, &coloured), None, MapFormat::Raw, "coloured picture");
    refused(encode::png8(4, 3, ColorType::Grayscale, &narrow), Some("Z"), MapFormat::Raw, "no channel \"Z\"");
}

#[test]
fn packed_disparities_are_unpacked() {
    let wide = cells(|x, y| (256 * x + 1280 * y) as u16 + x as u16);
    let wanted: Vec<f64> = wide.iter().map(|&v| if v == 0 { f64::NAN } else { f64::from(v) / 256.0 }).collect();
    read(encode::png16(4, 3, ColorType::Grayscale, &wide), None, MapFormat::KittiDisparity, &wanted);
    refused(encode::png8(4, 3, ColorType::Grayscale, &[1; 12]), None, MapFormat::KittiDisparity, "16-bit grey");
    let rgb = cells(|x, y| [x as u8, 16 * y as u8, 128 * (x as u8 & 1)]).concat();
    let wanted = cells(|x, y| 4.0 * x as f64 + 16.0 * y as f64 / 64.0 + 128.0 * (x & 1) as f64 / 16384.0);
    read(encode::png8(4, 3, ColorType::Rgb, &rgb), None, MapFormat::SintelDisparity, &wanted);
    refused(encode::png8(4, 3, ColorType::Grayscale, &[1; 12]), None, MapFormat::SintelDisparity, "8-bit RGB");
}

#[test]
fn npy_of_every_type_order_and_version() {
    let values = cells(value);
    let wanted: Vec<f64> = values.iter().map(|&v| v.into()).collect();
    macro_rules! both_orders {
        ($descr:literal, $convert:expr) => {
            for (order, big) in [("<", false), (">", true)] {
                let bytes = |&v: &f32| {
                    let v = $convert(v);
                    if big { v.to_be_bytes() } else { v.to_le_bytes() }
                };
                let body: Vec<u8> = values.iter().flat_map(bytes).collect();
                for version in 1..=3 {
                    let file = encode::npy(version, &format!("{order}{}", $descr), false, "(3, 4)", &body);
                    read(file, None, MapFormat::Raw, &wanted);
                }
            }
        };
    }
    both_orders!("f2", f16::from_f32);
    both_orders!("f4", |v: f32| v);
    both_orders!("f8", f64::from);
    let whole: Vec<f64> = values.iter().map(|v| f64::from(v.floor())).collect();
    let body: Vec<u8> = whole.iter().flat_map(|&v| (v as u16).to_be_bytes()).collect();
    read(encode::npy(1, ">u2", false, "(3, 4)", &body), None, MapFormat::Raw, &whole);
    let body: Vec<u8> = whole.iter().map(|&v| v as u8).collect();
    read(encode::npy(1, "|u1", false, "(3, 4, 1)", &body), None, MapFormat::Raw, &whole);
}

#[test]
fn npy_in_fortran_order_and_what_is_refused() {
    let columns: Vec<u8> = (0..W).flat_map(|x| (0..H).flat_map(move |y| value(x, y).to_le_bytes())).collect();
    let wanted: Vec<f64> = cells(value).iter().map(|&v| v.into()).collect();
    read(encode::npy(1, "<f4", true, "(3, 4)", &columns), None, MapFormat::Raw, &wanted);
    refused(encode::npy_f4("(4, 3)", &[0.0; 12]), None, MapFormat::Raw, "is 3x4 but the update's colour is 4x3");
    refused(encode::npy_f4("(12,)", &[0.0; 12]), None, MapFormat::Raw, "shape [12]");
    refused(encode::npy_f4("(3, 4, 2)", &[0.0; 24]), None, MapFormat::Raw, "2 numbers a pixel");
    refused(encode::npy(1, "<c8", false, "(3, 4)", &[0; 96]), None, MapFormat::Raw, "type \"<c8\"");
    refused(encode::npy(9, "<f4", false, "(3, 4)", &[0; 48]), None, MapFormat::Raw, "version 9");
}

#[test]
fn pfm_is_bottom_up_in_either_byte_order() {
    let values = cells(value);
    let wanted: Vec<f64> = values.iter().map(|&v| v.into()).collect();
    for little in [false, true] {
        read(encode::pfm(W, H, 1, little, &values), None, MapFormat::Raw, &wanted);
    }
    let colours: Vec<f32> = (0..36_u8).map(f32::from).collect();
    refused(encode::pfm(W, H, 3, true, &colours), None, MapFormat::Raw, "3 numbers a pixel");
    let zero = encode::pfm(W, H, 1, false, &values);
    let zero = [b"Pf\n4 3\n0.0\n", &zero[zero.len() - 48..]].concat();
    refused(zero, None, MapFormat::Raw, "scale \"0.0\"");
}

#[test]
fn dpt_is_top_down() {
    let values = cells(value);
    let wanted: Vec<f64> = values.iter().map(|&v| v.into()).collect();
    read(encode::pieh(4, 3, &values), None, MapFormat::Raw, &wanted);
}

#[test]
fn exr_maps_by_name_by_end_of_name_and_alone() {
    let values = cells(value);
    let wanted: Vec<f64> = values.iter().map(|&v| v.into()).collect();
    for precision in [Precision::Half, Precision::Float] {
        let alone = encode::exr(W, H, precision, &[("Z", values.clone())]);
        read(alone.clone(), None, MapFormat::Raw, &wanted);
        read(alone, Some("Z"), MapFormat::Raw, &wanted);
        let other = ("ViewLayer.Mist.Z", vec![0.0; W * H]);
        let two = encode::exr(W, H, precision, &[("ViewLayer.Depth.Z", values.clone()), other]);
        read(two.clone(), Some("ViewLayer.Depth.Z"), MapFormat::Raw, &wanted);
        read(two.clone(), Some("Depth.Z"), MapFormat::Raw, &wanted);
        refused(two.clone(), Some("Z"), MapFormat::Raw, "more than one channel \"Z\"");
        refused(two.clone(), Some("pth.Z"), MapFormat::Raw, "no channel \"pth.Z\"");
        refused(two, None, MapFormat::Raw, "several channels");
    }
    let parts = [("Mist", vec![("Z", vec![0.0; W * H])]), ("Depth", vec![("Z", values)])];
    read(encode::exr_parts(W, H, &parts), Some("Depth.Z"), MapFormat::Raw, &wanted);
}

#[test]
fn a_jpeg_is_no_map() {
    refused(encode::jpeg(4, 3, &[0; 36]), None, MapFormat::Raw, "JPEG");
}
