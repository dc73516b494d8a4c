//! `transforms.json` of NeRF, instant-ngp and nerfstudio.

use serde_json::Value;

use super::super::error::CaptureError;
use super::super::source::{Size, Source};
use super::{List, from_matrix, scaled, stamps_of};

/// Coefficients of a lens, in the file or in one of its frames.
const DISTORTION: [&str; 6] = ["k1", "k2", "k3", "k4", "p1", "p2"];

/// Camera models without a lens that bends, but for the coefficients.
const STRAIGHT: [&str; 4] = ["PINHOLE", "SIMPLE_PINHOLE", "OPENCV", "PERSPECTIVE"];

/// Returns the poses of a file, stamped by their times, else by their pictures' names, and its intrinsics for pictures
/// of `size`; `given`: whether the manifest has its own.
pub(super) fn read(source: &Source, size: Size, given: bool) -> Result<List, CaptureError> {
    let document: Value = serde_json::from_str(source.text()?).map_err(|e| source.damaged(e))?;
    let frames = document.get("frames").and_then(Value::as_array);
    let frames =
        frames.ok_or_else(|| source.fault("has no list \"frames\"", "give a transforms.json of nerfstudio"))?;
    check_model(source, &document)?;
    let mut list = List::default();
    for (index, frame) in frames.iter().enumerate() {
        let rows = frame.get("transform_matrix").and_then(Value::as_array);
        let values = rows.map(|rows| {
            let cells = rows.iter().flat_map(|row| row.as_array().into_iter().flatten());
            cells.map(|v| v.as_f64().unwrap_or(f64::NAN)).collect::<Vec<f64>>()
        });
        let pose = values
            .ok_or_else(|| "has no transform_matrix".to_owned())
            .and_then(|matrix| from_matrix(&matrix))
            .map_err(|what| source.fault(format!("frame {index} {what}"), "correct or remove that frame"))?;
        list.poses.push(pose);
        if let (false, Some((own, picture))) = (given, intrinsics(frame, &document, size)) {
            let (own, note) = scaled(source, own, picture, size)?;
            list.intrinsics.push(own);
            list.notes.extend(note.filter(|note| !list.notes.contains(note)));
        }
    }
    if list.intrinsics.len() != list.poses.len() {
        // Kept to recognise a manifest's that were taken from the file.
        list.intrinsics = match (given, intrinsics(&Value::Null, &document, size)) {
            (true, Some((own, _))) => vec![own; list.poses.len()],
            _ => Vec::new(),
        };
    }
    if let Some(bent) = DISTORTION.iter().find(|key| is_bent(&document, key) || frames.iter().any(|f| is_bent(f, key)))
    {
        let name = source.path.file_name().unwrap_or(source.path.as_os_str()).to_string_lossy();
        list.notes.push(format!("{name} gives a lens distortion ({bent}), which is not used: undistort the pictures"));
    }
    list.stamps = stamps(frames);
    Ok(list)
}

fn check_model(source: &Source, document: &Value) -> Result<(), CaptureError> {
    let model = document.get("camera_model").and_then(Value::as_str).unwrap_or("PINHOLE");
    let fisheye = document.get("is_fisheye").and_then(Value::as_bool) == Some(true);
    if STRAIGHT.contains(&model) && !fisheye {
        return Ok(());
    }
    let model = if fisheye { "a fisheye" } else { model };
    let hint = "undistort the pictures, and give the intrinsics of a pinhole";
    Err(source.fault(format!("has a camera of the model {model}, whose rays are not a pinhole's"), hint))
}

fn is_bent(table: &Value, key: &str) -> bool {
    table.get(key).and_then(Value::as_f64).is_some_and(|value| value != 0.0)
}

/// Returns `fx fy cx cy` of a frame, else of the file, and the size of the pictures that they are for.
fn intrinsics(frame: &Value, document: &Value, size: Size) -> Option<([f64; 4], Option<[f64; 2]>)> {
    let number = |key: &str| frame.get(key).or_else(|| document.get(key)).and_then(Value::as_f64);
    let number = |key: &str| number(key).filter(|value| value.is_finite());
    let positive = |key: &str| number(key).filter(|&value| value > 0.0);
    let own = positive("w").zip(positive("h")).map(|(w, h)| [w, h]);
    let [w, h] = own.unwrap_or([size.width as f64, size.height as f64]);
    let by_angle = |key: &str, side: f64| {
        number(key).filter(|angle| *angle > 0.0 && *angle < std::f64::consts::PI).map(|a| side / 2.0 / (a / 2.0).tan())
    };
    let fx = positive("fl_x").or_else(|| by_angle("camera_angle_x", w))?;
    let fy = positive("fl_y").or_else(|| by_angle("camera_angle_y", h)).unwrap_or(fx);
    Some(([fx, fy, number("cx").unwrap_or(w / 2.0), number("cy").unwrap_or(h / 2.0)], own))
}

/// Returns the frames' times if all are there and different, else stamps by their names; none without either.
fn stamps(frames: &[Value]) -> Vec<f64> {
    let times: Vec<f64> = frames.iter().filter_map(|frame| frame.get("time").and_then(Value::as_f64)).collect();
    let mut sorted = times.clone();
    sorted.sort_by(f64::total_cmp);
    if times.len() == frames.len() && sorted.windows(2).all(|pair| pair[0] < pair[1]) {
        return times;
    }
    let names: Vec<String> =
        frames.iter().filter_map(|frame| frame.get("file_path")?.as_str().map(str::to_owned)).collect();
    if names.len() == frames.len() { stamps_of(&names) } else { Vec::new() }
}
