//! Writers of small files, each from the format's description and none from the readers.

use std::io::Cursor;

use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, Layer, LayerAttributes, WritableImage};
use half::f16;
use png::{BitDepth, ColorType};

/// Returns a PNG of 8-bit values.
pub fn png8(width: u32, height: u32, colour: ColorType, values: &[u8]) -> Vec<u8> {
    png(width, height, colour, BitDepth::Eight, values)
}

/// Returns a PNG of 16-bit values.
pub fn png16(width: u32, height: u32, colour: ColorType, values: &[u16]) -> Vec<u8> {
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_be_bytes()).collect();
    png(width, height, colour, BitDepth::Sixteen, &bytes)
}

fn png(width: u32, height: u32, colour: ColorType, depth: BitDepth, bytes: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    encoder.write_header().unwrap().write_image_data(bytes).unwrap();
    file
}

/// Returns a JPEG of the best quality.
pub fn jpeg(width: u32, height: u32, rgb: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let (width, height) = (width.try_into().unwrap(), height.try_into().unwrap());
    jpeg_encoder::Encoder::new(&mut file, 100).encode(rgb, width, height, jpeg_encoder::ColorType::Rgb).unwrap();
    file
}

/// How an EXR stores its channels.
#[derive(Clone, Copy, Debug)]
pub enum Precision {
    Half,
    Float,
}

/// One name and its values.
pub type Channel<'a> = (&'a str, Vec<f32>);

/// Returns the channels with their names borrowed.
pub fn borrowed(list: &[(String, Vec<f32>)]) -> Vec<Channel<'_>> {
    list.iter().map(|(name, values)| (name.as_str(), values.clone())).collect()
}

fn channels(channels: &[Channel], precision: Precision) -> AnyChannels<FlatSamples> {
    let channel = |(name, values): &Channel| {
        let samples = match precision {
            Precision::Half => FlatSamples::F16(values.iter().map(|&v| f16::from_f32(v)).collect()),
            Precision::Float => FlatSamples::F32(values.clone()),
        };
        AnyChannel::new(*name, samples)
    };
    AnyChannels::sort(channels.iter().map(channel).collect())
}

/// Returns an EXR with one part.
pub fn exr(width: usize, height: usize, precision: Precision, list: &[Channel]) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    Image::from_channels((width, height), channels(list, precision)).write().to_buffered(&mut file).unwrap();
    file.into_inner()
}

/// Returns an EXR whose data window of `size` lies at `place` in a display window of `display`.
pub fn exr_window(size: [usize; 2], place: [i32; 2], display: [usize; 2], list: &[Channel]) -> Vec<u8> {
    let attributes =
        LayerAttributes { layer_position: exr::math::Vec2(place[0], place[1]), ..LayerAttributes::default() };
    let encoding = exr::prelude::Encoding::FAST_LOSSLESS;
    let layer = Layer::new((size[0], size[1]), attributes, encoding, channels(list, Precision::Float));
    let bounds = exr::prelude::IntegerBounds::from_dimensions((display[0], display[1]));
    let image = Image::new(exr::prelude::ImageAttributes::new(bounds), layer);
    let mut file = Cursor::new(Vec::new());
    image.write().to_buffered(&mut file).unwrap();
    file.into_inner()
}

/// Returns an EXR of 4x3 with these primaries and this compression.
pub fn exr_with(
    chromaticities: Option<exr::meta::attribute::Chromaticities>,
    compression: exr::prelude::Compression,
    list: &[Channel],
) -> Vec<u8> {
    let encoding = exr::prelude::Encoding { compression, ..exr::prelude::Encoding::UNCOMPRESSED };
    let layer = Layer::new((4, 3), LayerAttributes::default(), encoding, channels(list, Precision::Float));
    let bounds = exr::prelude::IntegerBounds::from_dimensions((4, 3));
    let mut image = Image::new(exr::prelude::ImageAttributes::new(bounds), layer);
    image.attributes.chromaticities = chromaticities;
    let mut file = Cursor::new(Vec::new());
    image.write().to_buffered(&mut file).unwrap();
    file.into_inner()
}

/// Returns an EXR in tiles of 64x64.
pub fn exr_tiled(width: usize, height: usize, list: &[Channel]) -> Vec<u8> {
    let blocks = exr::prelude::Blocks::Tiles(exr::math::Vec2(64, 64));
    let encoding = exr::prelude::Encoding { blocks, ..exr::prelude::Encoding::UNCOMPRESSED };
    let layer = Layer::new((width, height), LayerAttributes::default(), encoding, channels(list, Precision::Float));
    let bounds = exr::prelude::IntegerBounds::from_dimensions((width, height));
    let mut file = Cursor::new(Vec::new());
    Image::new(exr::prelude::ImageAttributes::new(bounds), layer).write().to_buffered(&mut file).unwrap();
    file.into_inner()
}

/// Returns an EXR with several named parts.
pub fn exr_parts(width: usize, height: usize, parts: &[(&str, Vec<Channel>)]) -> Vec<u8> {
    let part = |(name, list): &(&str, Vec<Channel>)| {
        let attributes = LayerAttributes::named(*name);
        Layer::new((width, height), attributes, exr::prelude::Encoding::FAST_LOSSLESS, channels(list, Precision::Float))
    };
    let layers: Vec<_> = parts.iter().map(part).collect();
    let bounds = exr::prelude::IntegerBounds::from_dimensions((width, height));
    let image = Image::from_layers(exr::prelude::ImageAttributes::new(bounds), layers);
    let mut file = Cursor::new(Vec::new());
    image.write().to_buffered(&mut file).unwrap();
    file.into_inner()
}

/// Returns the layout of `.flo` and `.dpt`.
pub fn pieh(width: i32, height: i32, values: &[f32]) -> Vec<u8> {
    let mut file = 202_021.25_f32.to_le_bytes().to_vec();
    file.extend([width, height].iter().flat_map(|side| side.to_le_bytes()));
    file.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    file
}

/// Returns a `.npy` of version 1 or, above 1, with the longer header.
pub fn npy(version: u8, descr: &str, fortran: bool, shape: &str, body: &[u8]) -> Vec<u8> {
    let fortran = if fortran { "True" } else { "False" };
    let mut header = format!("{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}");
    let before = if version == 1 { 10 } else { 12 };
    while (before + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut file = b"\x93NUMPY".to_vec();
    file.extend([version, 0]);
    match version {
        1 => file.extend((header.len() as u16).to_le_bytes()),
        _ => file.extend((header.len() as u32).to_le_bytes()),
    }
    file.extend(header.as_bytes());
    file.extend(body);
    file
}

/// Returns a little-endian float32 `.npy`.
pub fn npy_f4(shape: &str, values: &[f32]) -> Vec<u8> {
    let body: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    npy(1, "<f4", false, shape, &body)
}

/// Returns a PFM from rows given from top to bottom, `width * bands` values each.
pub fn pfm(width: usize, height: usize, bands: usize, little: bool, values: &[f32]) -> Vec<u8> {
    let (tag, scale) = (if bands == 3 { "PF" } else { "Pf" }, if little { "-1.0" } else { "1.0" });
    let mut file = format!("{tag}\n{width} {height}\n{scale}\n").into_bytes();
    for row in values.chunks(width * bands).rev() {
        let bytes = |v: &f32| if little { v.to_le_bytes() } else { v.to_be_bytes() };
        file.extend(row.iter().flat_map(bytes));
    }
    file
}

/// Returns an `.npz` of arrays that are stored as they are, or compressed.
pub fn npz(arrays: &[(&str, Vec<u8>)], compressed: bool) -> Vec<u8> {
    let mut file = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let method = if compressed { zip::CompressionMethod::Deflated } else { zip::CompressionMethod::Stored };
    for (name, bytes) in arrays {
        let options = zip::write::SimpleFileOptions::default().compression_method(method);
        file.start_file(format!("{name}.npy"), options).unwrap();
        std::io::Write::write_all(&mut file, bytes).unwrap();
    }
    file.finish().unwrap().into_inner()
}

/// Returns an Exif block that gives an orientation.
pub fn exif(orientation: u16) -> Vec<u8> {
    let mut block = b"II*\0\x08\0\0\0\x01\0".to_vec();
    block.extend(0x0112_u16.to_le_bytes());
    block.extend([3, 0, 1, 0, 0, 0]);
    block.extend(orientation.to_le_bytes());
    block.extend([0; 6]);
    block
}

/// Returns a JPEG with this Exif block.
pub fn jpeg_with_exif(jpeg: &[u8], exif: &[u8]) -> Vec<u8> {
    let length = (exif.len() + 8) as u16;
    [&jpeg[..2], &[0xff, 0xe1], &length.to_be_bytes(), b"Exif\0\0", exif, &jpeg[2..]].concat()
}
