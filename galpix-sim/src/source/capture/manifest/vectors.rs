//! `motion = { kind = "flow" | "planes" | "blender-vector" | "space-warp", … }`: a vector for each pixel.

use serde::{Deserialize, Serialize};

use super::{Invalid, Rows, frames, one_frame};

/// Vectors: `(scale * raw + offset) * sign`, in `units`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct Vectors {
    pub file: String,
    /// What stands before the last dot of the channels' names in an EXR, or an array of an `.npz`.
    pub channel: Option<String>,
    /// The names of the channels themselves: x, y, and where present depth and the three accelerations.
    pub channels: Option<Vec<String>>,
    #[serde(default = "one_frame")]
    pub frames: u32,
    pub scale: Option<OneOrEach>,
    pub offset: Option<OneOrEach>,
    /// 1: to the next frame. -1: to the previous one.
    pub sign: Option<f64>,
    /// Where y grows.
    pub y: Option<Upward>,
    pub units: Option<Units>,
    #[serde(default)]
    pub invalid: Invalid,
    /// A picture that is zero where the motion is unknown.
    pub mask: Option<String>,
    pub rows: Option<Rows>,
    /// Whether another size than the colour's is stretched to it, vectors in pixels with it.
    #[serde(default)]
    pub resize: bool,
    /// The step in which the file's numbers come; found in them if absent.
    pub step: Option<f64>,
    /// Whether the depth channel of a motion buffer is left out.
    pub flat: Option<bool>,
    /// Whether nothing is to be synthesised from this update.
    pub skip: Option<bool>,
    /// `x y z qx qy qz qw`: the movement of the application's space since the last frame, in camera axes.
    pub pose_delta: Option<[f64; 7]>,
}

/// One number for all components, or one for each of the first ones.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(untagged, expecting = "a number or a list of two to four numbers is wanted")]
pub(in super::super) enum OneOrEach {
    One(f64),
    Each(Vec<f64>),
}

impl OneOrEach {
    /// Returns the number of a component: 0 x, 1 y, 2 depth.
    pub fn of(&self, component: usize, usual: f64) -> f64 {
        match self {
            Self::One(value) => *value,
            Self::Each(values) => values.get(component).copied().unwrap_or(usual),
        }
    }

    fn check(&self, key: &str) -> Result<(), (String, &'static str)> {
        let values: &[f64] = match self {
            Self::One(value) => std::slice::from_ref(value),
            Self::Each(values) => values,
        };
        let usual = matches!(self, Self::One(_)) || (2..=4).contains(&values.len());
        if usual && values.iter().all(|value| value.is_finite()) {
            return Ok(());
        }
        Err((format!("{key} is {values:?}"), "write a finite number, or one for x and one for y"))
    }
}

/// Where y grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(in super::super) enum Upward {
    Down,
    Up,
}

/// What a vector of length 1 spans.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(in super::super) enum Units {
    /// A pixel of the file.
    Pixels,
    /// A pixel of the update's colour.
    ColorPixels,
    /// The width, and the height, of the picture.
    Picture,
    /// Half of the width, and of the height: normalised device coordinates from -1 to 1.
    Ndc,
}

impl Vectors {
    /// Checks the values; errors are (what, hint).
    pub fn check(&self, table: &str) -> Result<(), (String, &'static str)> {
        let for_buffers = [("flat", self.flat.is_some()), ("skip", self.skip.is_some())];
        let refused = for_buffers.into_iter().chain([("pose_delta", self.pose_delta.is_some())]).find(|(_, is)| *is);
        if let Some((key, _)) = refused {
            return Err((format!("{table}.{key} is for kind \"space-warp\""), "remove that key"));
        }
        self.check_numbers(table)
    }

    /// Checks those of Blender's pass, whose conventions are known.
    pub fn check_blender(&self, table: &str) -> Result<(), (String, &'static str)> {
        let known = [
            ("sign", self.sign.is_some()),
            ("y", self.y.is_some()),
            ("units", self.units.is_some_and(|units| units != Units::ColorPixels && units != Units::Pixels)),
            ("channels", self.channels.is_some()),
            ("offset", self.offset.is_some()),
        ];
        if let Some((key, _)) = known.into_iter().find(|(_, is)| *is) {
            let hint = "remove that key, or use kind \"planes\" with channels";
            return Err((format!("{table}.{key} does not belong to Blender's pass, which has its own"), hint));
        }
        self.check(table)
    }

    /// Checks those of a motion buffer.
    pub fn check_space_warp(&self, table: &str) -> Result<(), (String, &'static str)> {
        if self.units.is_some_and(|units| units != Units::Ndc) {
            let hint = "remove that key, or use kind \"planes\" with channels";
            return Err((format!("{table}.units are not those of a motion buffer, which is in NDC"), hint));
        }
        if self.pose_delta.is_some_and(|delta| delta.iter().any(|value| !value.is_finite())) {
            let hint = "write [x, y, z, qx, qy, qz, qw]";
            return Err((format!("{table}.pose_delta is not finite"), hint));
        }
        self.check_numbers(table)
    }

    fn check_numbers(&self, table: &str) -> Result<(), (String, &'static str)> {
        frames(&format!("{table}.frames"), self.frames)?;
        for (key, value) in [("scale", &self.scale), ("offset", &self.offset)] {
            value.as_ref().map_or(Ok(()), |value| value.check(&format!("{table}.{key}")))?;
        }
        if let Some(sign) = self.sign {
            super::one_or_minus_one(&format!("{table}.sign"), sign)?;
        }
        if let Some(step) = self.step
            && !(step.is_finite() && step >= 0.0)
        {
            return Err((
                format!("{table}.step is {step}"),
                "write the step of the numbers in the file, or 0 for none",
            ));
        }
        match &self.channels {
            Some(names) if !matches!(names.len(), 2 | 3 | 6) => {
                let hint = "name x and y, or x, y and depth, or these and their three accelerations";
                Err((format!("{table}.channels has {} names", names.len()), hint))
            }
            _ => Ok(()),
        }
    }
}
