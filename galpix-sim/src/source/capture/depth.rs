//! The depth of an update as the manifest describes it.

use super::camera::Distance;
use super::error::CaptureError;
use super::folder::Folder;
use super::manifest::{Depth, Map, Update};
use super::poses;
use super::raster::{self, Canvas, Fitted, Layout};
use super::source::Source;

/// Returns the distance of each cell in the manifest's unit (disparities without a baseline stay disparities); `None`
/// if there is no depth at all. `update`: whose camera may give the intrinsics.
///
/// *Errors:* no cell has a usable depth; the rest as of reading the file.
pub(super) fn read(
    depth: &Depth,
    update: &Update,
    folder: Folder<'_>,
    canvas: &mut Canvas<'_>,
) -> Result<Option<Vec<Distance>>, CaptureError> {
    let Some(map) = depth.map() else { return Ok(None) };
    let numbers = read_map(map, folder, canvas)?;
    let size = canvas.size;
    let distances: Vec<Distance> = match depth {
        Depth::Speed(_) => return Ok(None),
        Depth::Z(_) => numbers.iter().map(|number| number.distance(map)).collect(),
        Depth::Ray(_) => {
            let [fx, fy, cx, cy] = intrinsics(map, update, folder, canvas)?;
            let cosine = |(x, y): (usize, usize)| {
                let ray = [(x as f64 - cx) / fx, (y as f64 - cy) / fy];
                1.0 / (ray[0] * ray[0] + ray[1] * ray[1] + 1.0).sqrt()
            };
            let planar = |(at, number): ((usize, usize), &Number)| match number.distance(map) {
                Distance::At(along) => Distance::At(along * cosine(at)),
                other => other,
            };
            size.positions().zip(&numbers).map(planar).collect()
        }
        Depth::Buffer(_) => {
            let planes = map.planes.unwrap_or([1.0, f64::INFINITY]);
            numbers.iter().map(|number| number.in_buffer(map, planes)).collect()
        }
        Depth::Disparity(_) => match map.baseline {
            None => numbers.iter().map(|number| number.disparity(map)).collect(),
            Some(baseline) => {
                let [fx, ..] = intrinsics(map, update, folder, canvas)?;
                let planar = |number: &Number| match number.disparity(map) {
                    Distance::At(disparity) => Distance::At(baseline * fx / disparity),
                    other => other,
                };
                numbers.iter().map(planar).collect()
            }
        },
    };
    let usual = Usual::of(&numbers, map);
    if distances.iter().all(|distance| *distance == Distance::Unknown) {
        let (what, hint) = usual.nothing(depth, numbers.len());
        return Err(CaptureError::new(&folder.path(&map.file), what, hint));
    }
    let source = Source { path: folder.path(&map.file), bytes: Vec::new() };
    usual.remarks(depth, numbers.len()).iter().for_each(|note| canvas.note(&source, note));
    Ok(Some(distances))
}

/// What the numbers of a map are that are no distance.
struct Usual {
    invalid: usize,
    nan: usize,
    infinite: usize,
    negative: usize,
    zero: usize,
    least: f64,
    most: f64,
    /// Cells that share the largest number, if it lies far beyond many others.
    farthest: Option<usize>,
}

impl Usual {
    fn of(numbers: &[Number], map: &Map) -> Self {
        let count = |is: &dyn Fn(&f64) -> bool| numbers.iter().map(|number| &number.raw).filter(|raw| is(raw)).count();
        let valid: Vec<f64> = numbers.iter().map(|n| n.raw).filter(|raw| !map.invalid.holds(*raw)).collect();
        let mut finite: Vec<f64> = valid.iter().copied().filter(|raw| raw.is_finite()).collect();
        finite.sort_by(f64::total_cmp);
        Self {
            invalid: numbers.len() - valid.len(),
            nan: count(&|raw| raw.is_nan()),
            infinite: valid.iter().filter(|raw| **raw == f64::INFINITY).count(),
            negative: valid.iter().filter(|raw| **raw < 0.0).count(),
            zero: valid.iter().filter(|raw| **raw == 0.0).count(),
            least: finite.first().copied().unwrap_or(f64::NAN),
            most: finite.last().copied().unwrap_or(f64::NAN),
            farthest: farthest(&finite),
        }
    }

    /// Returns why no cell has a usable depth: (what, hint).
    fn nothing(&self, depth: &Depth, cells: usize) -> (String, &'static str) {
        let Self { least, most, .. } = self;
        let most_are = |count: usize| 2 * count > cells;
        let (why, hint) = if most_are(self.negative) && !matches!(depth, Depth::Buffer(_)) {
            let why = format!("its numbers are negative, {least} to {most}");
            (why, "add sign = -1 to the depth, if it is counted against the direction of view")
        } else if most_are(self.invalid) {
            ("most of its numbers are those of the key invalid".to_owned(), "correct the key invalid")
        } else if most_are(self.nan) {
            (
                "its numbers are NaN, or masked, or outside of the data window".to_owned(),
                "export it again, or correct the key mask",
            )
        } else if most_are(self.infinite) {
            ("its numbers are infinite".to_owned(), "add far = inf to the depth, if all is far, or export it again")
        } else if most_are(self.zero) {
            ("its numbers are zero".to_owned(), "export the pass again")
        } else if matches!(depth, Depth::Buffer(_)) {
            let why = format!("its values, {least} to {most}, leave the range from 0 to 1");
            (why, "bring them there with scale and offset (0.5 both for -1 to 1), or use kind = \"z\"")
        } else {
            (format!("its numbers are {least} to {most}"), "correct the keys scale, offset, sign and invalid")
        };
        (format!("gives no cell a usable depth: {why}"), hint)
    }

    /// Returns what is noteworthy where some cells have one.
    fn remarks(&self, depth: &Depth, cells: usize) -> Vec<String> {
        /// Fewer cells in a hundred are not worth a word.
        const FEW: usize = 100;
        let Some(map) = depth.map() else { return Vec::new() };
        let mut notes = Vec::new();
        let buffer = matches!(depth, Depth::Buffer(_));
        if map.far.is_none() && self.infinite > 0 && !buffer && !matches!(depth, Depth::Disparity(_)) {
            notes.push(format!(
                "has {} infinite depths, which count as unknown: far = inf makes them background",
                self.infinite
            ));
        }
        if map.sign > 0.0 && self.negative * FEW > cells && !buffer {
            notes
                .push(format!("has {} negative numbers, which count as unknown (least {})", self.negative, self.least));
        }
        if let Some(count) = self.farthest.filter(|_| map.far.is_none() && matches!(depth, Depth::Z(_) | Depth::Ray(_)))
        {
            notes.push(format!(
                "has its largest number, {}, in {count} cells, far beyond all others: if it means unknown or background, \
                 give it with the key invalid or far",
                self.most
            ));
        }
        notes
    }
}

/// Returns how many numbers share the largest one, if they are many, many others differ, and it lies far beyond them.
fn farthest(sorted: &[f64]) -> Option<usize> {
    /// Different numbers below it, at least.
    const LEAST: usize = 16;
    /// How many times it is the next one, at least.
    const BEYOND: f64 = 2.0;
    let most = *sorted.last()?;
    let below = sorted.partition_point(|&number| number < most);
    let count = sorted.len() - below;
    let next = *sorted[..below].last()?;
    let different = sorted[..below].windows(2).filter(|pair| pair[0] != pair[1]).take(LEAST).count();
    (count * 100 > sorted.len() && different >= LEAST && next > 0.0 && most > BEYOND * next).then_some(count)
}

/// Returns the distances of a map along the optical axis.
pub(super) fn planar(map: &Map, folder: Folder<'_>, canvas: &mut Canvas<'_>) -> Result<Vec<Distance>, CaptureError> {
    Ok(read_map(map, folder, canvas)?.iter().map(|number| number.distance(map)).collect())
}

/// One number of a map: as stored, and by how much the map was stretched in x. NaN outside of its mask.
#[derive(Clone, Copy)]
struct Number {
    raw: f64,
    stretch: f64,
}

fn read_map(map: &Map, folder: Folder<'_>, canvas: &mut Canvas<'_>) -> Result<Vec<Number>, CaptureError> {
    let layout = Layout {
        channel: map.channel.as_deref(),
        format: map.format,
        rows: map.rows,
        resize: map.resize,
        ..Layout::default()
    };
    let Fitted { mut bands, stretch } = raster::numbers(&folder.open(&map.file)?, &layout, canvas)?;
    let mut numbers = bands.swap_remove(0);
    if let Some(file) = &map.mask {
        let layout = Layout { rows: map.rows, resize: map.resize, ..Layout::default() };
        let mask = raster::mask(&folder.open(file)?, &layout, canvas)?;
        for (number, _) in numbers.iter_mut().zip(mask).filter(|(_, known)| !known) {
            *number = f64::NAN;
        }
    }
    Ok(numbers.into_iter().map(|raw| Number { raw, stretch: stretch[0] }).collect())
}

/// Returns `fx fy cx cy` of the update's camera.
fn intrinsics(
    map: &Map,
    update: &Update,
    folder: Folder<'_>,
    canvas: &mut Canvas<'_>,
) -> Result<[f64; 4], CaptureError> {
    match (map.intrinsics, update.viewer()) {
        (Some(intrinsics), _) => Ok(intrinsics),
        (None, Some(camera)) => Ok(poses::read(camera, folder, canvas.size)?.intrinsics),
        (None, None) => {
            let hint = "add intrinsics = [fx, fy, cx, cy] to the depth, or an [update.camera]";
            Err(CaptureError::new(&folder.path(&map.file), "holds distances that need the camera's intrinsics", hint))
        }
    }
}

impl Number {
    /// Returns the value in the manifest's unit, or what the raw number says instead.
    fn value(self, map: &Map) -> Result<f64, Distance> {
        let turned = self.raw * map.sign;
        let far = |far: f64| turned >= if map.sign < 0.0 { far.abs() } else { far };
        if map.invalid.holds(self.raw) {
            Err(Distance::Unknown)
        } else if map.far.is_some_and(far) {
            Err(Distance::Far)
        } else {
            Ok(turned * map.scale + map.offset)
        }
    }

    fn distance(self, map: &Map) -> Distance {
        match self.value(map) {
            Ok(value) if value.is_finite() && value > 0.0 => Distance::At(value),
            Ok(_) => Distance::Unknown,
            Err(distance) => distance,
        }
    }

    /// A depth buffer is linear in the inverse distance. What nothing was drawn over holds the value of the far plane.
    fn in_buffer(self, map: &Map, planes: [f64; 2]) -> Distance {
        /// By how much a float buffer may leave the range from 0 to 1.
        const ROUNDING: f64 = 1e-6;
        match self.value(map) {
            Ok(value) if (-ROUNDING..=1.0 + ROUNDING).contains(&value) => {
                let value = value.clamp(0.0, 1.0);
                let inverse = (1.0 - value) / planes[0] + value / planes[1];
                let cleared = if planes[0] > planes[1] { 0.0 } else { 1.0 };
                if value == cleared || inverse <= 0.0 { Distance::Far } else { Distance::At(1.0 / inverse) }
            }
            Ok(_) => Distance::Unknown,
            Err(distance) => distance,
        }
    }

    /// No parallax at all is infinitely far, unless zero means unknown by the manifest.
    fn disparity(self, map: &Map) -> Distance {
        match self.value(map) {
            Ok(value) if value.is_finite() && value > 0.0 => Distance::At(value * self.stretch),
            Ok(0.0) => Distance::Far,
            Ok(_) => Distance::Unknown,
            Err(distance) => distance,
        }
    }
}
