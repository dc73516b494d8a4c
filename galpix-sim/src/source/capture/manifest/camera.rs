//! `motion = { kind = "camera", … }` and `[update.camera]`.

use serde::{Deserialize, Serialize};

use super::{frames, one_frame, positive};

/// A camera's path.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct Camera {
    /// `fx fy cx cy` in pixels; may be left out where the poses' file has them (`transforms`, `colmap`).
    pub intrinsics: Option<[f64; 4]>,
    pub poses: String,
    pub format: PoseFormat,
    pub axes: Option<Axes>,
    /// The update's, counted from 0 in the order of time or of names; for `matrix-files` the file's number.
    pub pose: Option<u32>,
    /// The update's time, in the file's time stamps, instead of `pose`.
    pub time: Option<f64>,
    /// Display frames in a unit of the time stamps, instead of `frames`.
    pub rate: Option<f64>,
    /// Display frames between two poses.
    #[serde(default = "one_frame")]
    pub frames: u32,
    /// Where the centre of the first pixel lies in the intrinsics' coordinates: 0 or 0.5.
    pub pixel_centre: Option<f64>,
    pub transform: Option<Transform>,
    pub quaternion: Option<Quaternion>,
    /// A text file with the time of each pose, one a line, for formats that have none.
    pub times: Option<String>,
    /// The camera on the body whose poses are given: a camera-to-body matrix, 16 numbers row by row.
    pub mount: Option<[f64; 16]>,
}

/// Layout of a file of poses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(in super::super) enum PoseFormat {
    Log,
    Tum,
    Transforms,
    Tartanair,
    MatrixFiles,
    /// Twelve numbers a line: the upper three rows of a matrix.
    Kitti,
    /// Comma-separated: a time in nanoseconds, a place, a quaternion `w x y z`.
    Euroc,
    /// `images.txt`.
    Colmap,
}

/// What a file's poses map to what.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(in super::super) enum Transform {
    CameraToWorld,
    WorldToCamera,
}

/// The order of a quaternion's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(in super::super) enum Quaternion {
    Xyzw,
    Wxyz,
}

/// How the camera's own axes lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(in super::super) enum Axes {
    /// x right, y down, z forward.
    Opencv,
    /// x right, y up, z backward.
    Opengl,
    /// x forward, y right, z down.
    Ned,
}

impl Camera {
    /// Checks the values; errors are (what, hint).
    pub fn check(&self, table: &str) -> Result<(), (String, &'static str)> {
        frames(&format!("{table}.frames"), self.frames)?;
        if let Some(intrinsics) = self.intrinsics {
            check_intrinsics(table, intrinsics)?;
        }
        if let Some(rate) = self.rate {
            positive(&format!("{table}.rate"), rate)?;
            if self.frames != 1 {
                return Err((format!("{table} has a rate and frames"), "remove one of them"));
            }
        }
        match (self.pose, self.time) {
            (Some(_), Some(_)) => return Err((format!("{table} has a pose and a time"), "remove one of them")),
            (None, None) => return Err((format!("{table} has no key pose"), "add pose, or time")),
            (None, Some(time)) if !time.is_finite() => {
                return Err((format!("{table}.time is {time}"), "write one of the file's time stamps"));
            }
            _ => {}
        }
        if self.mount.is_some_and(|mount| mount.iter().any(|value| !value.is_finite())) {
            return Err((format!("{table}.mount is not finite"), "write a camera-to-body matrix, 16 numbers"));
        }
        match self.pixel_centre {
            Some(centre) if centre != 0.0 && centre != 0.5 => {
                Err((format!("{table}.pixel_centre is {centre}"), "write 0.0 or 0.5"))
            }
            _ => Ok(()),
        }
    }
}

/// Checks `fx fy cx cy`; errors are (what, hint).
pub(super) fn check_intrinsics(table: &str, [fx, fy, cx, cy]: [f64; 4]) -> Result<(), (String, &'static str)> {
    positive(&format!("the focal length in {table}.intrinsics"), fx)?;
    positive(&format!("the focal length in {table}.intrinsics"), fy)?;
    if cx.is_finite() && cy.is_finite() {
        return Ok(());
    }
    Err((format!("{table}.intrinsics are not finite"), "write [fx, fy, cx, cy] in pixels"))
}
