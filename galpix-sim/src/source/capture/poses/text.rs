//! Poses in lines of text.

use super::super::error::CaptureError;
use super::super::manifest::Quaternion;
use super::super::source::Source;
use super::{List, Pose, from_matrix, from_quaternion};

/// Returns the numbers of a line, or the word that is none.
pub(in super::super) fn numbers(line: &str) -> Result<Vec<f64>, String> {
    let number = |word: &str| word.parse().map_err(|_| format!("has \"{word}\" where a number belongs"));
    line.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty()).map(number).collect()
}

/// Returns the lines that carry something, with their numbers counted from 1.
fn meaningful(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let numbered = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    numbered.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
}

/// Returns an error in a line of a file of poses.
pub(super) fn in_line(source: &Source, line: usize, what: &str) -> CaptureError {
    source.fault(format!("line {line} {what}"), "correct or remove that pose")
}

/// TUM (`skipped` = 1, the time stamp) and TartanAir (0): `tx ty tz qx qy qz qw` in each line.
pub(super) fn lines(source: &Source, skipped: usize, order: Quaternion) -> Result<List, CaptureError> {
    let mut list = List::default();
    for (number, line) in meaningful(source.text()?) {
        let read = || {
            let values = numbers(line)?;
            let place = values.get(skipped..).and_then(|rest| <&[f64; 7]>::try_from(rest).ok());
            let place = place.ok_or_else(|| format!("has {} numbers, not {}", values.len(), 7 + skipped))?;
            Ok((stamp(&values, skipped)?, from_quaternion(&in_order(*place, order))?))
        };
        let (stamp, pose) = read().map_err(|what: String| in_line(source, number, &what))?;
        list.stamps.extend(stamp);
        list.poses.push(pose);
    }
    Ok(list)
}

fn stamp(values: &[f64], skipped: usize) -> Result<Option<f64>, String> {
    match values.first().filter(|_| skipped > 0) {
        Some(stamp) if !stamp.is_finite() => Err("has a time that is not finite".to_owned()),
        stamp => Ok(stamp.copied()),
    }
}

/// Returns a place and a quaternion with the numbers of the latter in the order x y z w.
const fn in_order([tx, ty, tz, a, b, c, d]: [f64; 7], order: Quaternion) -> [f64; 7] {
    match order {
        Quaternion::Xyzw => [tx, ty, tz, a, b, c, d],
        Quaternion::Wxyz => [tx, ty, tz, b, c, d, a],
    }
}

/// KITTI: twelve numbers in each line, the upper three rows of a matrix.
pub(super) fn kitti(source: &Source) -> Result<List, CaptureError> {
    let pose = |(number, line): (usize, &str)| {
        numbers(line).and_then(|matrix| from_matrix(&matrix)).map_err(|what| in_line(source, number, &what))
    };
    let poses = meaningful(source.text()?).map(pose).collect::<Result<_, _>>()?;
    Ok(List { poses, ..List::default() })
}

/// EuRoC: `time [ns], x, y, z, qw, qx, qy, qz` and more in each line, of the body that carries the cameras.
pub(super) fn euroc(source: &Source, mounted: bool, order: Quaternion) -> Result<List, CaptureError> {
    let mut list = List::default();
    for (number, line) in meaningful(source.text()?) {
        let read = || {
            let values = numbers(line)?;
            let place = values.get(1..8).and_then(|rest| <&[f64; 7]>::try_from(rest).ok());
            let place = place.ok_or_else(|| format!("has {} numbers, not 8 or more", values.len()))?;
            Ok((stamp(&values, 1)?, from_quaternion(&in_order(*place, order))?))
        };
        let (stamp, pose) = read().map_err(|what: String| in_line(source, number, &what))?;
        list.stamps.extend(stamp.map(|nanoseconds| nanoseconds * 1e-9));
        list.poses.push(pose);
    }
    if !mounted {
        list.notes.push("EuRoC's poses are those of a body: mount = [16 numbers] puts the camera on it".to_owned());
    }
    Ok(list)
}

/// One time in each line, in its first word.
pub(super) fn times(source: &Source) -> Result<Vec<f64>, CaptureError> {
    let time = |(number, line): (usize, &str)| {
        let first = numbers(line).map(|values| values.first().copied().filter(|time| time.is_finite()));
        first
            .and_then(|time| time.ok_or_else(|| "has no time".to_owned()))
            .map_err(|what| in_line(source, number, &what))
    };
    meaningful(source.text()?).map(time).collect()
}

/// Redwood: blocks of a header of three integers, of which the first numbers the frames, and the four rows of a matrix.
pub(super) fn log(source: &Source) -> Result<List, CaptureError> {
    let all: Vec<(usize, &str)> = meaningful(source.text()?).collect();
    let mut stamps = Vec::new();
    let mut pose = |block: &[(usize, &str)]| {
        let first = block.first().map_or(0, |(number, _)| *number);
        let mut read = || {
            if block.len() != 5 {
                return Err("begins a pose that is incomplete".to_owned());
            }
            let header = numbers(block[0].1)?;
            if header.len() != 3 {
                return Err("is not a header of three integers".to_owned());
            }
            stamps.push(header[0]);
            let mut matrix = Vec::with_capacity(16);
            for (_, line) in &block[1..] {
                matrix.extend(numbers(line)?);
            }
            from_matrix(&matrix)
        };
        read().map_err(|what| in_line(source, first, &what))
    };
    let poses = all.chunks(5).map(&mut pose).collect::<Result<Vec<_>, _>>()?;
    // Some writers leave the numbers zero.
    if stamps.iter().any(|stamp| !stamp.is_finite()) || stamps.windows(2).any(|pair| pair[0] == pair[1]) {
        stamps.clear();
    }
    Ok(List { poses, stamps, ..List::default() })
}

/// Returns one matrix: 16 (or 12) numbers.
pub(super) fn matrix_file(source: &Source) -> Result<Pose, CaptureError> {
    numbers(source.text()?)
        .and_then(|matrix| from_matrix(&matrix))
        .map_err(|what| source.fault(what, "give a 4x4 camera-to-world matrix, or choose another pose"))
}
