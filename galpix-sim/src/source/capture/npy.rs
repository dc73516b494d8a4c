//! NumPy `.npy`, versions 1 to 3: a magic, the length of a header that is a Python dictionary (`descr`,
//! `fortran_order`, `shape`), then the values. Read here: floats of 16, 32 and 64 bits, integers of 8 to 64, either
//! byte order, and truth values. `.npz` is a ZIP archive of such files.
//!
//! The dictionary is parsed by hand because its numbers are hostile input: sizes must be bounded before they are
//! multiplied, and nesting must not recurse.

use std::io::{Cursor, Read};

use half::f16;
use zip::ZipArchive;

use super::error::CaptureError;
use super::source::{Bands, Size, Source, array};

/// The three entries of the header.
#[derive(Debug, PartialEq, Eq)]
struct Header {
    descr: String,
    fortran: bool,
    shape: Vec<u64>,
}

/// Most bytes of one array of an archive when unpacked.
const MAX_UNPACKED: u64 = 2 << 30;

/// Reads an array of shape (rows, columns), (rows, columns, bands) or (bands, rows, columns) with 1 to 4 bands. Leading
/// sides of length 1 are left out, as of a batch of one picture. `size`: the picture's, which says which sides are its
/// own where both may be.
pub(super) fn read(source: &Source, size: Size) -> Result<Bands, CaptureError> {
    let (text, start) = header_text(source)?;
    let header = parse(text).ok_or_else(|| source.damaged("its header is not descr, fortran_order and shape"))?;
    let mut shape = &header.shape[..];
    while let [1, rest @ ..] = shape
        && rest.len() >= 2
    {
        shape = rest;
    }
    let pictures = [size.height as u64, size.width as u64];
    let (height, width, bands, planar) = match *shape {
        [bands @ 2..=4, height, width] if [height, width] == pictures && shape[..2] != pictures => {
            (height, width, bands as usize, true)
        }
        [height, width] => (height, width, 1, false),
        [height, width, bands @ 1..=4] => (height, width, bands as usize, false),
        [bands @ 2..=4, height, width] => (height, width, bands as usize, true),
        _ => {
            let what = format!("is an array of shape {:?}", header.shape);
            return Err(source.fault(what, "save it as (rows, columns) or (rows, columns, bands)"));
        }
    };
    let size = source.agree(width, height, None)?;
    let decode = decoder(&header.descr).ok_or_else(|| {
        let what = format!("holds values of type \"{}\"", header.descr);
        source.fault(what, "save it as float32 (other floats and integers of up to 64 bits are read as well)")
    })?;
    let body = source.body(start, (size.cells() * bands * decode.width) as u64)?;
    let value = |index: usize| (decode.value)(&body[index * decode.width..][..decode.width]);
    let (w, h) = (size.width, size.height);
    let band = |b: usize| {
        // C order runs through the last side first, Fortran order through the first.
        let index = |(x, y): (usize, usize)| match (header.fortran, planar) {
            (true, false) => y + h * (x + w * b),
            (false, false) => b + bands * (x + w * y),
            (true, true) => b + bands * (y + h * x),
            (false, true) => x + w * (y + h * b),
        };
        size.positions().map(|at| value(index(at))).collect()
    };
    Ok(Bands::new(size, (0..bands).map(band).collect()))
}

/// Returns the names of the arrays of an `.npz`.
pub(super) fn names(source: &Source) -> Result<Vec<String>, CaptureError> {
    let archive = ZipArchive::new(Cursor::new(source.bytes.as_slice())).map_err(|e| source.damaged(e))?;
    Ok(archive.file_names().filter_map(|name| Some(bare(&name.ok()?).to_owned())).collect())
}

/// Returns a file's name without its ending.
fn bare(file: &str) -> &str {
    file.strip_suffix(".npy").unwrap_or(file)
}

/// Reads an array of an `.npz`: the one of this name, or the only one.
pub(super) fn read_archive(source: &Source, name: Option<&str>, size: Size) -> Result<Bands, CaptureError> {
    let mut archive = ZipArchive::new(Cursor::new(source.bytes.as_slice())).map_err(|e| source.damaged(e))?;
    let names: Vec<String> = archive.file_names().filter_map(|name| Some(name.ok()?.into_owned())).collect();
    let wanted = match name {
        Some(name) => names.iter().find(|file| bare(file) == name || *file == name),
        None => names.first().filter(|_| names.len() == 1),
    };
    let list = names.iter().take(24).map(|name| bare(name)).collect::<Vec<_>>().join(", ");
    let Some(wanted) = wanted else {
        let what = match name {
            Some(name) => format!("has no array \"{name}\""),
            None => format!("has {} arrays", names.len()),
        };
        return Err(source.fault(what, format!("name one of them with the key channel: {list}")));
    };
    let file = archive.by_name(wanted).map_err(|e| source.damaged(e))?;
    if file.size() > MAX_UNPACKED {
        let what = format!("has an array of {} bytes, more than the {MAX_UNPACKED} that are read", file.size());
        return Err(source.fault(what, "crop or scale the capture down"));
    }
    let mut bytes = Vec::new();
    file.take(MAX_UNPACKED).read_to_end(&mut bytes).map_err(|e| source.damaged(e))?;
    let array = Source { path: source.path.clone(), bytes };
    if !array.bytes.starts_with(b"\x93NUMPY") {
        return Err(source.fault(format!("holds \"{wanted}\", which is no .npy"), "save it with numpy.savez"));
    }
    read(&array, size)
}

/// How one value is stored.
struct Decoder {
    /// Bytes a value.
    width: usize,
    /// From exactly so many bytes.
    value: fn(&[u8]) -> f64,
}

/// Returns the decoder of a type such as `<f4`, or `None` for a type that is not read.
fn decoder(descr: &str) -> Option<Decoder> {
    macro_rules! decoder {
        ($number:ty, $from:ident) => {
            Decoder {
                width: size_of::<$number>(),
                value: |bytes| bytes.try_into().map_or(f64::NAN, |bytes| <$number>::$from(bytes).into()),
            }
        };
    }
    // Nearest, as doubles cannot hold all of them.
    macro_rules! wide {
        ($number:ty, $from:ident) => {
            Decoder {
                width: size_of::<$number>(),
                value: |bytes| bytes.try_into().map_or(f64::NAN, |bytes| <$number>::$from(bytes) as f64),
            }
        };
    }
    Some(match descr {
        "<f2" => decoder!(f16, from_le_bytes),
        ">f2" => decoder!(f16, from_be_bytes),
        "<f4" => decoder!(f32, from_le_bytes),
        ">f4" => decoder!(f32, from_be_bytes),
        "<f8" => decoder!(f64, from_le_bytes),
        ">f8" => decoder!(f64, from_be_bytes),
        "|u1" | "|b1" => decoder!(u8, from_le_bytes),
        "|i1" => decoder!(i8, from_le_bytes),
        "<i2" => decoder!(i16, from_le_bytes),
        ">i2" => decoder!(i16, from_be_bytes),
        "<i4" => decoder!(i32, from_le_bytes),
        ">i4" => decoder!(i32, from_be_bytes),
        "<u4" => decoder!(u32, from_le_bytes),
        ">u4" => decoder!(u32, from_be_bytes),
        "<i8" => wide!(i64, from_le_bytes),
        ">i8" => wide!(i64, from_be_bytes),
        "<u8" => wide!(u64, from_le_bytes),
        ">u8" => wide!(u64, from_be_bytes),
        "<u2" => decoder!(u16, from_le_bytes),
        ">u2" => decoder!(u16, from_be_bytes),
        _ => return None,
    })
}

/// Returns the text of the header and the place where the values begin.
fn header_text(source: &Source) -> Result<(&str, usize), CaptureError> {
    let bytes = &source.bytes;
    let found = match bytes.get(6) {
        Some(1) => array(bytes, 8).map(|length| (10, usize::from(u16::from_le_bytes(length)))),
        Some(2 | 3) => array(bytes, 8).map(|length| (12, u32::from_le_bytes(length) as usize)),
        Some(version) => {
            return Err(source.fault(format!("is NumPy format version {version}"), "save it as version 1"));
        }
        None => None,
    };
    found
        .and_then(|(start, length)| {
            let end = usize::checked_add(start, length)?;
            Some((std::str::from_utf8(bytes.get(start..end)?).ok()?, end))
        })
        .ok_or_else(|| source.damaged("its header is incomplete"))
}

/// Parses `{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }`; nothing may follow but blanks.
fn parse(text: &str) -> Option<Header> {
    let mut rest = text.trim().strip_prefix('{')?.strip_suffix('}')?.trim_start();
    let (mut descr, mut fortran, mut shape) = (None, None, None);
    while !rest.is_empty() {
        let (key, after) = quoted(rest)?;
        let value = after.trim_start().strip_prefix(':')?.trim_start();
        rest = match key {
            "descr" => {
                let (text, after) = quoted(value)?;
                descr = Some(text.to_owned());
                after
            }
            "fortran_order" => {
                let (yes, after) = match value.strip_prefix("False") {
                    Some(after) => (false, after),
                    None => (true, value.strip_prefix("True")?),
                };
                fortran = Some(yes);
                after
            }
            "shape" => {
                let (inside, after) = value.strip_prefix('(')?.split_once(')')?;
                let sides = inside.split(',').map(str::trim).filter(|side| !side.is_empty());
                shape = Some(sides.map(|side| side.parse().ok()).collect::<Option<_>>()?);
                after
            }
            _ => return None,
        };
        rest = rest.trim_start();
        rest = rest.strip_prefix(',').unwrap_or(rest).trim_start();
    }
    Some(Header { descr: descr?, fortran: fortran?, shape: shape? })
}

/// Returns a Python string at the beginning of `text`, and what follows it.
fn quoted(text: &str) -> Option<(&str, &str)> {
    let quote = text.chars().next().filter(|&c| c == '\'' || c == '"')?;
    text[1..].split_once(quote)
}
