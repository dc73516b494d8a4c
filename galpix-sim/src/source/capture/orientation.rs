//! How a camera says that its picture is turned: the tag Orientation (0x0112) of Exif, in a TIFF structure.

use super::source::{Size, array};

/// How stored pixels become an upright picture: the values 2 to 8 of the tag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Orientation(u16);

impl Orientation {
    /// Returns what an Exif block says, if the picture is not upright as it is stored.
    pub fn of(exif: &[u8]) -> Option<Self> {
        let exif = exif.strip_prefix(b"Exif\0\0").unwrap_or(exif);
        let big = match exif.get(..4)? {
            b"II*\0" => false,
            b"MM\0*" => true,
            _ => return None,
        };
        let half = |at| array(exif, at).map(|b| if big { u16::from_be_bytes(b) } else { u16::from_le_bytes(b) });
        let word = |at| array(exif, at).map(|b| if big { u32::from_be_bytes(b) } else { u32::from_le_bytes(b) });
        let first = word(4)? as usize;
        let count = usize::from(half(first)?);
        let entries = (0..count).filter_map(|entry| first.checked_add(2 + entry * 12));
        let value = entries.filter(|&at| half(at) == Some(0x0112)).find_map(|at| half(at.checked_add(8)?))?;
        (2..=8).contains(&value).then_some(Self(value))
    }

    /// Returns what it says in words.
    pub const fn text(self) -> &'static str {
        match self.0 {
            2 => "mirrored",
            3 => "turned by 180 degrees",
            4 => "upside down and mirrored",
            5 | 7 => "turned by 90 degrees and mirrored",
            6 => "turned by 90 degrees",
            _ => "turned by 270 degrees",
        }
    }

    /// Returns the upright picture.
    pub fn upright<T: Copy>(self, size: Size, pixels: &[T]) -> (Size, Vec<T>) {
        let Size { width, height } = size;
        let upright = if self.0 >= 5 { Size { width: height, height: width } } else { size };
        let stored = |(x, y): (usize, usize)| {
            let (right, below) = (upright.width - 1 - x, upright.height - 1 - y);
            let (column, row) = match self.0 {
                2 => (right, y),
                3 => (right, below),
                4 => (x, below),
                5 => (y, x),
                6 => (y, right),
                7 => (below, right),
                _ => (below, x),
            };
            pixels[row * width + column]
        };
        (upright, upright.positions().map(stored).collect())
    }
}
