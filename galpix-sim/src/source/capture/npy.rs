//! NumPy `.npy`, versions 1 to 3: a magic, the length of a header that is a Python dictionary (`descr`,
//! `fortran_order`, `shape`), then the values. Read here: floats of 16, 32 and 64 bits and unsigned integers of 8 and
//! 16, either byte order.
//!
//! The dictionary is parsed by hand because its numbers are hostile input: sizes must be bounded before they are
//! multiplied, and nesting must not recurse.

use half::f16;

use super::error::CaptureError;
use super::source::{Bands, Size, Source, array};

/// The three entries of the header.
#[derive(Debug, PartialEq, Eq)]
struct Header {
    descr: String,
    fortran: bool,
    shape: Vec<u64>,
}

/// Reads an array of shape (rows, columns), or (rows, columns, bands) with 1 to 4 bands.
pub(super) fn read(source: &Source, expected: Size) -> Result<Bands, CaptureError> {
    let (text, start) = header_text(source)?;
    let header = parse(text).ok_or_else(|| source.damaged("its header is not descr, fortran_order and shape"))?;
    let (height, width, bands) = match header.shape[..] {
        [height, width] => (height, width, 1),
        [height, width, bands @ 1..=4] => (height, width, bands as usize),
        _ => {
            let what = format!("is an array of shape {:?}", header.shape);
            return Err(source.fault(what, "save it as (rows, columns) or (rows, columns, bands)"));
        }
    };
    let size = source.agree(width, height, Some(expected))?;
    let decode = decoder(&header.descr).ok_or_else(|| {
        let what = format!("holds values of type \"{}\"", header.descr);
        source.fault(what, "save it as float32 (float16, float64, uint8 and uint16 are read as well)")
    })?;
    let body = source.body(start, (size.cells() * bands * decode.width) as u64)?;
    let value = |index: usize| (decode.value)(&body[index * decode.width..][..decode.width]);
    let (w, h) = (size.width, size.height);
    let band = |b: usize| {
        // C order runs through bands first, Fortran order through rows first.
        let index = |(x, y): (usize, usize)| if header.fortran { y + h * (x + w * b) } else { b + bands * (x + w * y) };
        size.positions().map(|at| value(index(at))).collect()
    };
    Ok(Bands { bands: (0..bands).map(band).collect() })
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
    Some(match descr {
        "<f2" => decoder!(f16, from_le_bytes),
        ">f2" => decoder!(f16, from_be_bytes),
        "<f4" => decoder!(f32, from_le_bytes),
        ">f4" => decoder!(f32, from_be_bytes),
        "<f8" => decoder!(f64, from_le_bytes),
        ">f8" => decoder!(f64, from_be_bytes),
        "|u1" => decoder!(u8, from_le_bytes),
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
