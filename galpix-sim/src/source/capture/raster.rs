//! Maps of one number per pixel and flows of two, whatever file they are in, brought to the size of the picture.

use super::error::CaptureError;
use super::exr_planes::{Planes, under};
use super::manifest::{MapFormat, Rows};
use super::source::{Bands, Format, Size, Source};
use super::{dpt, flo, npy, pfm, png_raster};

/// How the manifest wants a file to be read.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Layout<'m> {
    /// Of an EXR, or an array of an `.npz`.
    pub channel: Option<&'m str>,
    /// The channels themselves, of an EXR.
    pub channels: Option<&'m [String]>,
    pub format: MapFormat,
    /// Default: the format's own.
    pub rows: Option<Rows>,
    /// Whether another size than the picture's is stretched to it.
    pub resize: bool,
}

/// The picture that a file must fit, and the remarks about the files that do.
pub(super) struct Canvas<'n> {
    pub size: Size,
    pub notes: &'n mut Vec<String>,
}

impl Canvas<'_> {
    /// Adds a remark about a file, once.
    pub fn note(&mut self, source: &Source, what: &str) {
        let name = source.path.file_name().unwrap_or(source.path.as_os_str()).to_string_lossy();
        let note = format!("{name} {what}");
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }
}

/// Numbers of the picture's size, and how far they were stretched to it in x and y.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub bands: Vec<Vec<f64>>,
    pub stretch: [f64; 2],
}

/// Reads one raw number for each pixel; NaN where the format has "unknown".
///
/// A channel is for EXR and `.npz` only, and may be left out where the file has one.
pub(super) fn numbers(source: &Source, layout: &Layout<'_>, canvas: &mut Canvas<'_>) -> Result<Fitted, CaptureError> {
    let kind = source.format()?;
    if kind == Format::Exr {
        let planes = Planes::read(source)?;
        let Some(name) = layout.channel.or(planes.only()) else {
            let hint = format!("name one of them with the key channel: {}", planes.list());
            return Err(source.fault("has several channels", hint));
        };
        planes.note_losses(canvas);
        let bands = planes.bands(&[name.to_owned()], canvas)?;
        return fitted(source, bands, layout, canvas);
    }
    refuse_channel(source, layout, kind)?;
    let bands = match (layout.format, kind) {
        (MapFormat::SintelDisparity, _) => png_raster::sintel_disparity(source)?,
        (MapFormat::KittiDisparity, _) => png_raster::kitti_disparity(source)?,
        (MapFormat::Rgb24, _) => png_raster::packed24(source, [1.0, 256.0, 65_536.0])?,
        (MapFormat::Bgr24, _) => png_raster::packed24(source, [65_536.0, 256.0, 1.0])?,
        (MapFormat::Raw, Format::Png) => png_raster::grey(source)?,
        (MapFormat::Raw, Format::Npy) => npy::read(source, canvas.size)?,
        (MapFormat::Raw, Format::Npz) => npy::read_archive(source, layout.channel, canvas.size)?,
        (MapFormat::Raw, Format::Pfm) => pfm::read(source)?,
        (MapFormat::Raw, Format::Pieh) => dpt::read(source)?,
        (MapFormat::Raw, Format::Jpeg | Format::Exr) => {
            return Err(source.fault("is a JPEG, whose numbers are not exact", "save the map as PNG, EXR, PFM or .npy"));
        }
    };
    let mut fitted = fitted(source, bands, layout, canvas)?;
    let bands = &fitted.bands;
    // Writers that know just three bands repeat the number in each.
    if bands.len() != 2 && bands[1..].iter().all(|band| *band == bands[0]) {
        fitted.bands.truncate(1);
        return Ok(fitted);
    }
    Err(source.fault(format!("has {} numbers a pixel", bands.len()), "give a map of one number a pixel"))
}

/// Vectors of the picture's size as they stand in a file: `None` where they are unknown.
#[derive(Clone, Debug)]
pub(super) struct Flow {
    pub vectors: Vec<Option<[f64; 2]>>,
    pub stretch: [f64; 2],
}

/// Reads a displacement for each pixel: `None` where it is unknown (NaN, a size of 1e9 and more, or marked so by the
/// format).
pub(super) fn flow(source: &Source, layout: &Layout<'_>, canvas: &mut Canvas<'_>) -> Result<Flow, CaptureError> {
    let kind = source.format()?;
    let bands = match kind {
        Format::Pieh => flo::read(source)?,
        Format::Png => png_raster::kitti_flow(source)?,
        Format::Npy => npy::read(source, canvas.size)?,
        Format::Npz => npy::read_archive(source, layout.channel, canvas.size)?,
        Format::Pfm => pfm::read(source)?,
        Format::Exr => {
            let planes = Planes::read(source)?;
            planes.note_losses(canvas);
            let names = pair(source, &planes, layout)?;
            planes.bands(&names, canvas)?
        }
        Format::Jpeg => {
            let hint = "give a .flo, a KITTI 16-bit PNG, a .npy, a three-channel PFM or an EXR";
            return Err(source.fault("is no optical flow", hint));
        }
    };
    if kind != Format::Exr {
        refuse_channel(source, layout, kind)?;
    }
    let Fitted { bands, stretch } = fitted(source, bands, layout, canvas)?;
    let [u, v, rest @ ..] = &bands[..] else {
        return Err(source.fault("has one number a pixel", "a flow needs two, u and v"));
    };
    let valid = rest.first().and_then(|third| validity(third));
    match (rest.len(), &valid) {
        (0, _) => {}
        (_, Some(_)) => canvas.note(source, "has a third band of two values: where it is zero the motion is unknown"),
        // In a PFM of a flow the third band has no meaning, and most writers leave it constant.
        (1, None) if rest[0].iter().all(|&value| value == rest[0][0]) => {}
        (_, None) => canvas.note(source, "has more than two bands: only the first two are used"),
    }
    let known = |cell: usize| {
        let components = [u[cell], v[cell]];
        let usable = components.iter().all(|component| component.abs() < 1e9);
        (usable && valid.as_ref().is_none_or(|valid| valid[cell])).then_some(components)
    };
    Ok(Flow { vectors: (0..u.len()).map(known).collect(), stretch })
}

/// Reads where a mask is not zero.
pub(super) fn mask(source: &Source, layout: &Layout<'_>, canvas: &mut Canvas<'_>) -> Result<Vec<bool>, CaptureError> {
    if source.format()? != Format::Png {
        let numbers = numbers(source, layout, canvas)?.bands.swap_remove(0);
        return Ok(numbers.into_iter().map(|value| value != 0.0).collect());
    }
    let raster = png_raster::read(source, None)?;
    let numbers = raster.counting().into_iter().map(|counts| f64::from(u8::from(counts))).collect();
    let bands = Bands::new(raster.size, vec![numbers]);
    let numbers = fitted(source, bands, layout, canvas)?.bands.swap_remove(0);
    Ok(numbers.into_iter().map(|value| value != 0.0).collect())
}

/// Returns the names of the channels x and y: those in the manifest, else a usual pair under the prefix.
pub(super) fn pair(source: &Source, planes: &Planes<'_>, layout: &Layout<'_>) -> Result<Vec<String>, CaptureError> {
    const USUAL: [[&str; 2]; 6] = [["VX", "VY"], ["u", "v"], ["U", "V"], ["x", "y"], ["X", "Y"], ["R", "G"]];
    let prefix = layout.channel.unwrap_or("");
    if let Some(names) = layout.channels {
        return Ok(names.iter().map(|name| under(prefix, name)).collect());
    }
    let found = USUAL.iter().map(|pair| pair.map(|name| under(prefix, name)));
    let found: Vec<[String; 2]> = found.filter(|pair| pair.iter().all(|name| planes.has(name))).collect();
    match &found[..] {
        [pair] => Ok(pair.to_vec()),
        _ => {
            let hint = format!("name x and y with the key channels, two of {}", planes.list());
            let usual = under(prefix, "VX");
            let what = format!("has no channel \"{usual}\", and none whose name says that it is the motion");
            Err(source.fault(what, hint))
        }
    }
}

/// Returns where a band of just zero and one other positive value is not zero; nothing if it is another band.
fn validity(band: &[f64]) -> Option<Vec<bool>> {
    let other = *band.iter().find(|&&value| value != 0.0)?;
    let two = other > 0.0 && band.contains(&0.0) && band.iter().all(|&value| value == 0.0 || value == other);
    two.then(|| band.iter().map(|&value| value != 0.0).collect())
}

fn refuse_channel(source: &Source, layout: &Layout<'_>, kind: Format) -> Result<(), CaptureError> {
    if let Some(channel) = layout.channel.filter(|_| kind != Format::Npz) {
        return Err(source.fault(format!("is no EXR and has no channel \"{channel}\""), "leave the key channel out"));
    }
    if layout.channels.is_some() {
        return Err(source.fault("is no EXR and has no named channels", "leave the key channels out"));
    }
    Ok(())
}

/// Returns bands with rows from top to bottom and of the picture's size. A cell takes the number that is nearest to its
/// centre: numbers of two surfaces are never mixed.
pub(super) fn fitted(
    source: &Source,
    file: Bands,
    layout: &Layout<'_>,
    canvas: &mut Canvas<'_>,
) -> Result<Fitted, CaptureError> {
    let Bands { size, mut bands, rows, notes } = file;
    notes.iter().for_each(|note| canvas.note(source, note));
    if rows == Rows::TopDown && layout.rows.is_none() && source.format()? == Format::Pfm {
        let what = "gives its columns and rows in lines of their own, as a writer does that stores rows from top to \
                    bottom: read so (rows = \"bottom-up\" reads it in the usual order)";
        canvas.note(source, what);
    }
    if layout.rows.unwrap_or(rows) == Rows::BottomUp {
        for band in &mut bands {
            *band = band.chunks(size.width).rev().flatten().copied().collect();
        }
    }
    let wanted = canvas.size;
    if size == wanted {
        return Ok(Fitted { bands, stretch: [1.0; 2] });
    }
    if !layout.resize {
        let hint = "export both at the same size, or add resize = true, which stretches it, and vectors in its own \
                    pixels with it";
        return Err(source.fault(
            format!("is {}x{} but the update's colour is {}x{}", size.width, size.height, wanted.width, wanted.height),
            hint,
        ));
    }
    // Both along the same part of the picture, to the pixel that rounding can make.
    let (across, down) = (size.width * wanted.height, size.height * wanted.width);
    if across.abs_diff(down) > wanted.width.max(wanted.height) {
        let what = format!(
            "is {}x{}, of another shape than the update's colour of {}x{}",
            size.width, size.height, wanted.width, wanted.height
        );
        return Err(source.fault(what, "export both with the same aspect ratio"));
    }
    let nearest = |at: usize, from: usize, to: usize| ((2 * at + 1) * from / (2 * to)).min(from - 1);
    let cells: Vec<usize> = wanted
        .positions()
        .map(|(x, y)| nearest(y, size.height, wanted.height) * size.width + nearest(x, size.width, wanted.width))
        .collect();
    let bands = bands.into_iter().map(|band| cells.iter().map(|&cell| band[cell]).collect()).collect();
    let stretch = [wanted.width as f64 / size.width as f64, wanted.height as f64 / size.height as f64];
    Ok(Fitted { bands, stretch })
}
