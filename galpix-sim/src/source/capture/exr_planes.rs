//! Channels of OpenEXR files, single or multi-part, half, float or integer, found by name.
//!
//! Blender names a channel `<view layer>.<pass>.<channel>`, in single- and multi-part files alike; other writers put
//! the pass into the part's name. So a channel is known here by its own name and by `<part>.<name>`, and may be asked
//! for by the end of its name from a dot on (`Depth.Z` finds `ViewLayer.Depth.Z`) where that is unambiguous.

use std::io::Cursor;

use exr::block::chunk::TileCoordinates;
use exr::block::reader::ChunksReader;
use exr::compression::Compression;
use exr::error::Error;
use exr::image::{AnyChannel, FlatSamples};
use exr::math::Vec2;
use exr::meta::BlockDescription;
use exr::meta::MetaData;
use exr::meta::attribute::{Chromaticities, SampleType};
use exr::prelude::{ReadChannels, ReadLayers, read};

use super::error::CaptureError;
use super::raster::Canvas;
use super::source::{Bands, Size, Source, array};

/// Most bytes that all channels of a file may take when decoded.
const MAX_DECODED: u64 = 4 << 30;

/// Most numbers of a tile that is larger than its picture.
const LARGEST_TILE: usize = 16 << 20;

/// All channels of one file.
pub(super) struct Planes<'a> {
    source: &'a Source,
    channels: Vec<Named>,
    /// Columns and rows of the display window.
    display: [u64; 2],
    /// The compression of a part that changes its numbers.
    lossy: Option<Compression>,
    /// Whether colours are meant for other primaries than sRGB's.
    foreign: bool,
}

/// One channel, where its part's data window lies.
struct Named {
    /// Its name in the file.
    name: String,
    /// With the part's name before it, if the part has one.
    in_part: Option<String>,
    size: [u64; 2],
    /// The first column and row, seen from the display window's.
    place: [i64; 2],
    samples: FlatSamples,
}

impl<'a> Planes<'a> {
    /// Decodes the file; sizes are checked before any pixel is read.
    pub fn read(source: &'a Source) -> Result<Self, CaptureError> {
        check_headers(source)?;
        check_chunks(source).map_err(|e| source.damaged(e))?;
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .all_layers()
            .all_attributes()
            .non_parallel()
            .from_buffered(Cursor::new(source.bytes.as_slice()))
            .map_err(|e| source.damaged(e))?;
        let window = image.attributes.display_window;
        let display = [window.size.0 as u64, window.size.1 as u64];
        let foreign = image.attributes.chromaticities.is_some_and(|found| !is_srgb(found));
        let mut lossy = None;
        let mut channels = Vec::new();
        for layer in image.layer_data {
            let part = layer.attributes.layer_name.map(|name| name.to_string()).filter(|name| !name.is_empty());
            let compression = layer.encoding.compression;
            let loses = |channel: &AnyChannel<FlatSamples>| {
                let kind = match channel.sample_data {
                    FlatSamples::F16(_) => SampleType::F16,
                    FlatSamples::F32(_) => SampleType::F32,
                    FlatSamples::U32(_) => SampleType::U32,
                };
                !compression.is_lossless_for(kind)
            };
            lossy = lossy.or(layer.channel_data.list.iter().any(loses).then_some(compression));
            let size = [layer.size.0 as u64, layer.size.1 as u64];
            let first = layer.attributes.layer_position;
            let place =
                [i64::from(first.0) - i64::from(window.position.0), i64::from(first.1) - i64::from(window.position.1)];
            for AnyChannel { name, sample_data, .. } in layer.channel_data.list {
                let name = name.to_string();
                let in_part = part.as_ref().map(|part| format!("{part}.{name}"));
                channels.push(Named { name, in_part, size, place, samples: sample_data });
            }
        }
        Ok(Self { source, channels, display, lossy, foreign })
    }

    /// Returns the only channel of the file, if it has just one.
    pub fn only(&self) -> Option<&str> {
        if let [only] = &self.channels[..] { Some(&only.name) } else { None }
    }

    /// Returns the names of all channels, with their parts' where they say nothing of a pass themselves.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.channels.iter().map(|channel| match &channel.in_part {
            Some(in_part) if !channel.name.contains('.') => in_part.as_str(),
            _ => channel.name.as_str(),
        })
    }

    /// Returns the values of a channel as they stand there; nothing if there is none of this name, or more than one.
    pub fn values(&self, name: &str) -> Option<Vec<f64>> {
        Some(self.channel(name).ok()?.samples.values_as_f32().map(f64::from).collect())
    }

    /// Returns whether `name` names a channel; ambiguous counts as yes.
    pub fn has(&self, name: &str) -> bool {
        !self.candidates(name).is_empty()
    }

    /// Notes what was lost in numbers that are no colours.
    pub fn note_losses(&self, canvas: &mut Canvas<'_>) {
        if let Some(compression) = self.lossy {
            canvas.note(self.source, &format!("has {compression}, which has losses: its numbers are not exact"));
        }
    }

    /// Notes what its colours are meant for and is not followed.
    pub fn note_primaries(&self, canvas: &mut Canvas<'_>) {
        if self.foreign {
            canvas.note(self.source, "says that its colours are not those of sRGB; it is read as sRGB");
        }
    }

    /// Returns the display window's size, within the importers' limits.
    pub fn display(&self) -> Result<Size, CaptureError> {
        self.source.agree(self.display[0], self.display[1], None)
    }

    /// Returns the values of channels of one part, as they lie in the display window; NaN where the data window leaves
    /// it open. Where only the data window has the picture's size, that is taken.
    pub fn bands(&self, names: &[String], canvas: &mut Canvas<'_>) -> Result<Bands, CaptureError> {
        let display = self.display()?;
        let mut bands = Vec::with_capacity(names.len());
        let mut size = display;
        for name in names {
            let channel = self.channel(name)?;
            let own = self.source.agree(channel.size[0], channel.size[1], None)?;
            let values: Vec<f64> = channel.samples.values_as_f32().map(f64::from).collect();
            if values.len() != own.cells() {
                return Err(self.source.damaged(format_args!("channel {name} does not fill the picture")));
            }
            let windows = format!(
                "has a data window of {}x{} at ({}, {}) in a display window of {}x{}",
                own.width, own.height, channel.place[0], channel.place[1], display.width, display.height
            );
            if own == display && channel.place == [0, 0] {
                bands.push(values);
            } else if own == canvas.size && display != canvas.size {
                canvas.note(self.source, &format!("{windows}: the data window is taken, which has the colour's size"));
                size = own;
                bands.push(values);
            } else {
                canvas.note(self.source, &format!("{windows}: {}", placed_note(own, channel.place, display)));
                bands.push(placed(&values, own, channel.place, display));
            }
        }
        if bands.iter().any(|band| band.len() != size.cells()) {
            let hint = "export all channels with one data window";
            return Err(self.source.fault("has channels with different data windows", hint));
        }
        Ok(Bands::new(size, bands))
    }

    /// Returns the channel `name`, or an error that lists what there is.
    fn channel(&self, name: &str) -> Result<&Named, CaptureError> {
        match self.candidates(name)[..] {
            [channel] => Ok(channel),
            [] => Err(self
                .source
                .fault(format!("has no channel \"{name}\""), format!("name one of its channels: {}", self.list()))),
            _ => Err(self.source.fault(
                format!("has more than one channel \"{name}\""),
                format!("give the full name, one of {}", self.list()),
            )),
        }
    }

    /// Returns the channels that `name` may mean: by full name, else by name with the part, else by the end of the
    /// name.
    fn candidates(&self, name: &str) -> Vec<&Named> {
        let ends = |full: &str| full.strip_suffix(name).is_some_and(|before| before.ends_with('.'));
        let exact: Vec<&Named> = self.channels.iter().filter(|c| c.name == name).collect();
        let in_part: Vec<&Named> = self.channels.iter().filter(|c| c.in_part.as_deref() == Some(name)).collect();
        let by_end =
            || self.channels.iter().filter(|c| ends(&c.name) || c.in_part.as_deref().is_some_and(ends)).collect();
        [exact, in_part].into_iter().find(|found| !found.is_empty()).unwrap_or_else(by_end)
    }

    /// Returns the names of the first channels, for a message.
    pub fn list(&self) -> String {
        const SHOWN: usize = 24;
        let names: Vec<&str> = self.channels.iter().take(SHOWN).map(|c| c.name.as_str()).collect();
        let more = if self.channels.len() > SHOWN { ", ..." } else { "" };
        names.join(", ") + more
    }
}

/// Returns whether colours have the primaries and white of sRGB, as Rec. 709 has them.
fn is_srgb(found: Chromaticities) -> bool {
    let near = |found: Vec2<f32>, [x, y]: [f32; 2]| (found.0 - x).abs() < 0.002 && (found.1 - y).abs() < 0.002;
    near(found.red, [0.64, 0.33])
        && near(found.green, [0.30, 0.60])
        && near(found.blue, [0.15, 0.06])
        && near(found.white, [0.3127, 0.3290])
}

/// Says what becomes of a data window that is not the display window.
fn placed_note(own: Size, [x, y]: [i64; 2], display: Size) -> &'static str {
    let beyond =
        x < 0 || y < 0 || x + own.width as i64 > display.width as i64 || y + own.height as i64 > display.height as i64;
    let open = x > 0
        || y > 0
        || x + (own.width as i64) < display.width as i64
        || y + (own.height as i64) < display.height as i64;
    match (beyond, open) {
        (true, true) => "what lies beyond is left out, the rest is unknown",
        (true, false) => "what lies beyond is left out",
        _ => "the rest is unknown",
    }
}

/// Returns values as they lie in the display window.
fn placed(values: &[f64], own: Size, [left, top]: [i64; 2], display: Size) -> Vec<f64> {
    let along =
        |at: usize, first: i64, length: usize| usize::try_from(at as i64 - first).ok().filter(|&at| at < length);
    let value = |(x, y): (usize, usize)| {
        let (x, y) = (along(x, left, own.width)?, along(y, top, own.height)?);
        values.get(y * own.width + x).copied()
    };
    display.positions().map(|at| value(at).unwrap_or(f64::NAN)).collect()
}

/// Returns `prefix.name`, or `name` alone under an empty prefix.
pub(super) fn under(prefix: &str, name: &str) -> String {
    if prefix.is_empty() { name.to_owned() } else { format!("{prefix}.{name}") }
}

/// Refuses what would cost absurd memory, or is not read, from the headers alone.
fn check_headers(source: &Source) -> Result<(), CaptureError> {
    check_compression(source)?;
    let meta =
        MetaData::read_from_buffered(Cursor::new(source.bytes.as_slice()), false).map_err(|e| source.damaged(e))?;
    let mut decoded = 0_u64;
    for header in &meta.headers {
        if header.deep {
            return Err(source.fault("holds deep pixels", "export flat ones"));
        }
        let size = source.agree(header.layer_size.0 as u64, header.layer_size.1 as u64, None)?;
        let channels = &header.channels.list;
        if channels.iter().any(|c| c.sampling.0 != 1 || c.sampling.1 != 1) {
            return Err(
                source.fault("has a channel with fewer pixels than the picture", "export all at full resolution")
            );
        }
        // The decoder makes room for a whole tile, however little of it the picture fills.
        if let BlockDescription::Tiles(tiles) = header.blocks {
            let Vec2(width, height) = tiles.tile_size;
            let numbers = |cells: usize| cells.saturating_mul(channels.len());
            if numbers(width.saturating_mul(height)) > LARGEST_TILE.max(numbers(size.cells())) {
                let what =
                    format!("has tiles of {width}x{height}, beyond its picture of {}x{}", size.width, size.height);
                return Err(source.fault(what, "export it with smaller tiles, or in lines"));
            }
        }
        // Each chunk has an entry of 8 bytes in the offset table, so a file cannot hold more of them than this.
        if header.chunk_count as u64 > source.bytes.len() as u64 / 8 {
            return Err(source.damaged("it promises more chunks than it has bytes for"));
        }
        decoded = decoded.saturating_add((size.cells() * 4) as u64 * channels.len() as u64);
    }
    if decoded > MAX_DECODED {
        return Err(source.fault(format!("would take {decoded} bytes when decoded"), "export only the passes named"));
    }
    Ok(())
}

/// Refuses chunks that say they lie elsewhere than the table of offsets has them: the decoder takes them at their word,
/// and writes beyond its picture.
fn check_chunks(source: &Source) -> exr::error::UnitResult {
    let chunks = exr::block::read(Cursor::new(source.bytes.as_slice()), false)?;
    let largest = |tile: TileCoordinates| tile.level_index == Vec2(0, 0);
    let chunks = chunks.filter_chunks(false, |_, tile, _| largest(tile))?;
    let meta = chunks.meta_data().clone();
    for chunk in chunks {
        let chunk = chunk?;
        let header = meta.headers.get(chunk.layer_index).ok_or(Error::Invalid("part of a chunk".into()))?;
        let tile = header.get_block_data_indices(&chunk.compressed_block)?;
        if !largest(tile) {
            return Err(Error::Invalid("level of a chunk".into()));
        }
        header.get_absolute_block_pixel_coordinates(tile)?;
    }
    Ok(())
}

/// Refuses compressions that are not read, by their names: the decoder calls the newer ones invalid.
///
/// A header is a list of attributes, each a name, a type, a length and so many bytes, and ends with an empty name.
fn check_compression(source: &Source) -> Result<(), CaptureError> {
    /// Most attributes that are looked at, of all parts.
    const MOST: usize = 4096;
    let bytes = &source.bytes;
    let text = |at: usize| {
        let rest = bytes.get(at..)?;
        let length = rest.iter().take(256).position(|&b| b == 0)?;
        Some((&rest[..length], at + length + 1))
    };
    let attribute = |at: usize| {
        let (name, at) = text(at)?;
        if name.is_empty() {
            return Some((name, &bytes[..0], at));
        }
        let (_, at) = text(at)?;
        let length = usize::try_from(u32::from_le_bytes(array(bytes, at)?)).ok()?;
        let end = at.checked_add(4)?.checked_add(length)?;
        Some((name, bytes.get(at + 4..end)?, end))
    };
    let (mut at, mut just_ended) = (8, false);
    for _ in 0..MOST {
        let Some((name, value, next)) = attribute(at) else { break };
        // Two empty names end the headers of a multi-part file; one those of a file with one part.
        let multi_part = bytes.get(5).is_some_and(|flags| flags & 0x10 != 0);
        if name.is_empty() && (just_ended || !multi_part) {
            break;
        }
        just_ended = name.is_empty();
        at = next;
        let unread = match (name, value) {
            (b"compression", [10]) => "HTJ2K (256 rows)",
            (b"compression", [11]) => "HTJ2K (32 rows)",
            (b"compression", [kind]) if *kind > 11 => "a kind newer than HTJ2K",
            _ => continue,
        };
        let hint = "export it with ZIP, ZIPS, PIZ, RLE or no compression";
        return Err(source.fault(format!("is compressed with {unread}, which is not read"), hint));
    }
    Ok(())
}
