//! The depth of an update as the manifest describes it.

use std::path::Path;

use super::camera::Distance;
use super::error::CaptureError;
use super::manifest::{Depth, Map};
use super::raster;
use super::source::{Size, Source};

/// Returns the distance of each cell in the manifest's unit (disparities stay disparities); `None` if there is no depth
/// at all.
pub(super) fn read(depth: &Depth, folder: &Path, size: Size) -> Result<Option<Vec<Distance>>, CaptureError> {
    match depth {
        Depth::Speed(_) => Ok(None),
        Depth::Z(map) => Ok(Some(planar(map, folder, size)?)),
        Depth::Disparity(map) => {
            let distances = numbers(map, folder, size)?.into_iter();
            Ok(Some(distances.map(|raw| if raw == 0.0 { zero_disparity(map) } else { distance(map, raw) }).collect()))
        }
    }
}

/// Returns the distances of a map along the optical axis.
pub(super) fn planar(map: &Map, folder: &Path, size: Size) -> Result<Vec<Distance>, CaptureError> {
    Ok(numbers(map, folder, size)?.into_iter().map(|raw| distance(map, raw)).collect())
}

fn numbers(map: &Map, folder: &Path, size: Size) -> Result<Vec<f64>, CaptureError> {
    raster::numbers(&Source::open(&folder.join(&map.file))?, map.channel.as_deref(), map.format, size)
}

fn distance(map: &Map, raw: f64) -> Distance {
    let value = raw * map.scale;
    if map.invalid.holds(raw) {
        Distance::Unknown
    } else if map.far.is_some_and(|far| raw >= far) {
        Distance::Far
    } else if value.is_finite() && value > 0.0 {
        Distance::At(value)
    } else {
        Distance::Unknown
    }
}

/// Returns no parallax at all: infinitely far, unless zero means unknown by the manifest.
fn zero_disparity(map: &Map) -> Distance {
    if map.invalid.holds(0.0) { Distance::Unknown } else { Distance::Far }
}
