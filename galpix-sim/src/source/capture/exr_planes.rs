//! Channels of OpenEXR files, single or multi-part, half, float or integer, found by name.
//!
//! Blender names a channel `<view layer>.<pass>.<channel>`, in single- and multi-part files alike; other writers put
//! the pass into the part's name. So a channel is known here by its own name and by `<part>.<name>`, and may be asked
//! for by the end of its name from a dot on (`Depth.Z` finds `ViewLayer.Depth.Z`) where that is unambiguous.

use std::io::Cursor;

use exr::image::{AnyChannel, FlatSamples};
use exr::meta::MetaData;
use exr::prelude::{ReadChannels, ReadLayers, read};

use super::error::CaptureError;
use super::source::{Size, Source};

/// Most bytes that all channels of a file may take when decoded.
const MAX_DECODED: u64 = 4 << 30;

/// All channels of one file.
pub(super) struct Planes<'a> {
    source: &'a Source,
    channels: Vec<Named>,
}

/// One channel.
struct Named {
    /// Its name in the file.
    name: String,
    /// With the part's name before it, if the part has one.
    in_part: Option<String>,
    size: [u64; 2],
    samples: FlatSamples,
}

impl<'a> Planes<'a> {
    /// Decodes the file; sizes are checked before any pixel is read.
    pub fn read(source: &'a Source) -> Result<Self, CaptureError> {
        check_headers(source)?;
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .all_layers()
            .all_attributes()
            .non_parallel()
            .from_buffered(Cursor::new(source.bytes.as_slice()))
            .map_err(|e| source.damaged(e))?;
        let mut channels = Vec::new();
        for layer in image.layer_data {
            let part = layer.attributes.layer_name.map(|name| name.to_string()).filter(|name| !name.is_empty());
            let size = [layer.size.0 as u64, layer.size.1 as u64];
            for AnyChannel { name, sample_data, .. } in layer.channel_data.list {
                let name = name.to_string();
                let in_part = part.as_ref().map(|part| format!("{part}.{name}"));
                channels.push(Named { name, in_part, size, samples: sample_data });
            }
        }
        Ok(Self { source, channels })
    }

    /// Returns the only channel of the file, if it has just one.
    pub fn only(&self) -> Option<&str> {
        if let [only] = &self.channels[..] { Some(&only.name) } else { None }
    }

    /// Returns whether `name` names a channel; ambiguous counts as yes.
    pub fn has(&self, name: &str) -> bool {
        !self.candidates(name).is_empty()
    }

    /// Returns the size of the channel `name`, within the importers' limits and equal to `expected` if that is given.
    pub fn size(&self, name: &str, expected: Option<Size>) -> Result<Size, CaptureError> {
        let [width, height] = self.channel(name)?.size;
        self.source.agree(width, height, expected)
    }

    /// Returns the values of the channel `name`, row-major.
    pub fn band(&self, name: &str, expected: Size) -> Result<Vec<f64>, CaptureError> {
        let size = self.size(name, Some(expected))?;
        let values: Vec<f64> = self.channel(name)?.samples.values_as_f32().map(f64::from).collect();
        if values.len() == size.cells() {
            Ok(values)
        } else {
            Err(self.source.damaged(format_args!("channel {name} does not fill the picture")))
        }
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
    fn list(&self) -> String {
        const SHOWN: usize = 24;
        let names: Vec<&str> = self.channels.iter().take(SHOWN).map(|c| c.name.as_str()).collect();
        let more = if self.channels.len() > SHOWN { ", ..." } else { "" };
        names.join(", ") + more
    }
}

/// Returns `prefix.name`, or `name` alone under an empty prefix.
pub(super) fn under(prefix: &str, name: &str) -> String {
    if prefix.is_empty() { name.to_owned() } else { format!("{prefix}.{name}") }
}

/// Refuses what would cost absurd memory, or is not read, from the headers alone.
fn check_headers(source: &Source) -> Result<(), CaptureError> {
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
