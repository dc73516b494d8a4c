//! Maps of one number per pixel and flows of two, whatever file they are in.

use super::error::CaptureError;
use super::exr_planes::Planes;
use super::manifest::MapFormat;
use super::source::{Bands, Format, Size, Source};
use super::{dpt, flo, npy, pfm, png_raster};

/// Reads one raw number for each pixel; NaN where the format has "unknown".
///
/// `channel` is for EXR only, and may be left out where the file has one channel.
pub(super) fn numbers(
    source: &Source,
    channel: Option<&str>,
    format: MapFormat,
    size: Size,
) -> Result<Vec<f64>, CaptureError> {
    let kind = source.format()?;
    if kind == Format::Exr {
        let planes = Planes::read(source)?;
        let Some(name) = channel.or(planes.only()) else {
            return Err(source.fault("has several channels", "name one of them with the key channel"));
        };
        return planes.band(name, size);
    }
    if let Some(channel) = channel {
        return Err(source.fault(format!("is no EXR and has no channel \"{channel}\""), "leave the key channel out"));
    }
    let bands = match (format, kind) {
        (MapFormat::SintelDisparity, _) => png_raster::sintel_disparity(source, size)?,
        (MapFormat::KittiDisparity, _) => png_raster::kitti_disparity(source, size)?,
        (MapFormat::Raw, Format::Png) => png_raster::grey(source, size)?,
        (MapFormat::Raw, Format::Npy) => npy::read(source, size)?,
        (MapFormat::Raw, Format::Pfm) => pfm::read(source, size)?,
        (MapFormat::Raw, Format::Pieh) => dpt::read(source, size)?,
        (MapFormat::Raw, Format::Jpeg | Format::Exr) => {
            return Err(source.fault("is a JPEG, whose numbers are not exact", "save the map as PNG, EXR, PFM or .npy"));
        }
    };
    match <[Vec<f64>; 1]>::try_from(bands.bands) {
        Ok([numbers]) => Ok(numbers),
        Err(bands) => {
            Err(source.fault(format!("has {} numbers a pixel", bands.len()), "give a map of one number a pixel"))
        }
    }
}

/// Reads a displacement for each pixel: `None` where it is unknown (NaN, or a size of 1e9 and more).
pub(super) fn flow(source: &Source, size: Size) -> Result<Vec<Option<[f64; 2]>>, CaptureError> {
    let Bands { bands } = match source.format()? {
        Format::Pieh => flo::read(source, size)?,
        Format::Png => png_raster::kitti_flow(source, size)?,
        Format::Npy => npy::read(source, size)?,
        Format::Pfm => pfm::read(source, size)?,
        Format::Jpeg | Format::Exr => {
            let hint = "give a .flo, a KITTI 16-bit PNG, a .npy or a three-channel PFM (or kind = \"planes\" for EXR)";
            return Err(source.fault("is no optical flow", hint));
        }
    };
    let [u, v, ..] = &bands[..] else {
        return Err(source.fault("has one number a pixel", "a flow needs two, u and v"));
    };
    let known = |component: f64| component.abs() <= 1e9;
    Ok(u.iter().zip(v).map(|(&u, &v)| (known(u) && known(v)).then_some([u, v])).collect())
}
