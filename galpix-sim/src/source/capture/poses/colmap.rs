//! COLMAP's text model: `images.txt`, and `cameras.txt` beside it.

use std::collections::HashMap;
use std::path::Path;

use super::super::error::CaptureError;
use super::super::folder::Folder;
use super::super::manifest::Camera;
use super::super::source::{Size, Source};
use super::text::{in_line, numbers};
use super::{List, from_quaternion, scaled, stamps_of};

/// One of the cameras.
struct Model {
    intrinsics: [f64; 4],
    picture: [f64; 2],
    bent: bool,
}

/// Returns the poses of an `images.txt` as they stand there, world to camera, stamped by the pictures' names, and the
/// intrinsics of the cameras beside it for pictures of `size`, unless the manifest has its own.
///
/// Each picture has two lines: `id qw qx qy qz tx ty tz camera name`, and its points, which may be none.
pub(super) fn read(source: &Source, camera: &Camera, folder: Folder<'_>, size: Size) -> Result<List, CaptureError> {
    let mut list = List::default();
    let given = camera.intrinsics;
    let beside = Path::new(&camera.poses).with_file_name("cameras.txt");
    let (mut names, mut cameras) = (Vec::new(), Vec::new());
    let numbered = source.text()?.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    let mut lines = numbered.filter(|(_, line)| !line.starts_with('#'));
    while let Some((number, line)) = lines.next() {
        if line.is_empty() {
            continue;
        }
        let words: Vec<&str> = line.splitn(10, char::is_whitespace).collect();
        let read = || {
            let [_, pose @ .., camera, name] = &words[..] else {
                return Err(format!("has {} words, not 10", words.len()));
            };
            let [w, x, y, z, tx, ty, tz] = numbers(&pose.join(" "))?[..] else {
                return Err("has no quaternion and place of seven numbers".to_owned());
            };
            Ok((from_quaternion(&[tx, ty, tz, x, y, z, w])?, (*camera).to_owned(), (*name).to_owned()))
        };
        let (pose, camera, name) = read().map_err(|what: String| in_line(source, number, &what))?;
        list.poses.push(pose);
        names.push(name);
        cameras.push(camera);
        // The points.
        lines.next();
    }
    list.stamps = stamps_of(&names);
    if let (None, Some(beside)) = (given, beside.to_str().filter(|name| folder.holds(name))) {
        let file = folder.open(beside)?;
        let models = models(&file)?;
        for camera in &cameras {
            let model = models.get(camera).ok_or_else(|| {
                file.fault(format!("has no camera {camera}"), "add it, or the key intrinsics to the manifest")
            })?;
            let (own, note) = scaled(&file, model.intrinsics, Some(model.picture), size)?;
            list.intrinsics.push(own);
            let bent = "cameras.txt gives a lens distortion, which is not used: undistort the pictures".to_owned();
            for note in note.into_iter().chain(model.bent.then_some(bent)) {
                if !list.notes.contains(&note) {
                    list.notes.push(note);
                }
            }
        }
    }
    Ok(list)
}

/// Reads `id model width height parameters…` of each line.
fn models(source: &Source) -> Result<HashMap<String, Model>, CaptureError> {
    let mut models = HashMap::new();
    let numbered = source.text()?.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    for (number, line) in numbered.filter(|(_, line)| !line.is_empty() && !line.starts_with('#')) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let read = || {
            let [id, model, rest @ ..] = &words[..] else { return Err("has no model".to_owned()) };
            let values = numbers(&rest.join(" "))?;
            let [width, height, parameters @ ..] = &values[..] else { return Err("has no size".to_owned()) };
            let (intrinsics, lens) = match (*model, parameters) {
                ("SIMPLE_PINHOLE" | "SIMPLE_RADIAL" | "RADIAL", &[f, cx, cy, ref lens @ ..]) => ([f, f, cx, cy], lens),
                ("PINHOLE" | "OPENCV" | "FULL_OPENCV", &[fx, fy, cx, cy, ref lens @ ..]) => ([fx, fy, cx, cy], lens),
                _ => return Err(format!("has a camera of the model {model}, whose rays are not a pinhole's")),
            };
            let bent = lens.iter().any(|&value| value != 0.0);
            Ok(((*id).to_owned(), Model { intrinsics, picture: [*width, *height], bent }))
        };
        let (id, model) = read().map_err(|what: String| in_line(source, number, &what))?;
        models.insert(id, model);
    }
    Ok(models)
}
