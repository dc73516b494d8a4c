//! The keys of `capture.toml`. Whatever is not named here is refused, so that a misspelt key never goes unnoticed.

mod camera;
mod hidden;
mod vectors;

use std::fmt;

use serde::de::{self, MapAccess, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Serialize, Serializer};

pub(super) use camera::{Axes, Camera, PoseFormat, Quaternion, Transform};
pub(super) use hidden::{Hidden, View, Views};
pub(super) use vectors::{OneOrEach, Units, Upward, Vectors};

use super::error::CaptureError;
use super::source::Source;

/// Most display frames of a capture: eleven minutes at 100 frames a second.
const MAX_FRAMES: u32 = 65_535;

/// A whole manifest.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Manifest {
    /// Default: the folder's name.
    pub name: Option<String>,
    #[serde(default)]
    pub about: String,
    /// Display frames from the update to the last truth.
    pub frames: u32,
    pub update: Update,
    #[serde(default)]
    pub truth: Vec<Truth>,
}

/// `[update]`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Update {
    pub color: Color,
    /// For an EXR in `color`, where that is a plain name.
    pub channel: Option<String>,
    pub depth: Depth,
    pub motion: Motion,
    pub acceleration: Option<Acceleration>,
    /// Default: `camera` where a camera is given, else `still`.
    pub background: Option<Background>,
    /// What is pinned over the picture: a PNG with alpha.
    pub overlay: Option<Overlay>,
    /// For `background = "camera"` where the motion is not of the kind `camera`.
    pub camera: Option<Camera>,
    pub hidden: Option<Hidden>,
}

/// `overlay = { file }`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Overlay {
    pub file: String,
}

/// `[[truth]]`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Truth {
    pub frame: u32,
    pub color: Color,
    pub channel: Option<String>,
    pub mask: Option<String>,
}

/// A file's name, or `{ file, channel }`.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Color {
    pub file: String,
    pub channel: Option<String>,
}

/// `depth = { kind, … }`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub(super) enum Depth {
    /// Along the optical axis.
    Z(Map),
    /// Along the ray of each pixel.
    Ray(Map),
    /// What a depth buffer holds, between the two `planes`.
    Buffer(Map),
    Disparity(Map),
    Speed(Nothing),
}

impl Depth {
    /// Returns the map that it is read from, if there is one.
    pub const fn map(&self) -> Option<&Map> {
        match self {
            Self::Z(map) | Self::Ray(map) | Self::Buffer(map) | Self::Disparity(map) => Some(map),
            Self::Speed(_) => None,
        }
    }

    /// Returns whether it gives distances: disparities do with a baseline.
    pub const fn is_distance(&self) -> bool {
        match self {
            Self::Z(_) | Self::Ray(_) | Self::Buffer(_) => true,
            Self::Disparity(map) => map.baseline.is_some(),
            Self::Speed(_) => false,
        }
    }
}

/// A kind without further keys.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Nothing {}

/// A map of one number per pixel: `sign * scale * raw + offset`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Map {
    pub file: String,
    #[serde(default = "one")]
    pub scale: f64,
    #[serde(default = "one")]
    pub sign: f64,
    #[serde(default)]
    pub offset: f64,
    pub channel: Option<String>,
    #[serde(default)]
    pub invalid: Invalid,
    pub far: Option<f64>,
    #[serde(default)]
    pub format: MapFormat,
    pub rows: Option<Rows>,
    /// Whether another size than the colour's is stretched to it.
    #[serde(default)]
    pub resize: bool,
    /// A picture that is zero where the map is unknown.
    pub mask: Option<String>,
    /// The distances of a depth buffer's values 0 and 1.
    pub planes: Option<[f64; 2]>,
    /// Between the two cameras of a disparity, in the unit of the poses.
    pub baseline: Option<f64>,
    /// `fx fy cx cy`, where neither the motion nor `[update.camera]` gives them.
    pub intrinsics: Option<[f64; 4]>,
}

/// How the numbers of a map are packed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum MapFormat {
    /// One number per pixel, as stored in the file.
    #[default]
    Raw,
    /// 8-bit RGB, `4 R + G / 64 + B / 16384`.
    SintelDisparity,
    /// 16-bit grey, `value / 256`, 0 = unknown.
    KittiDisparity,
    /// 8-bit RGB, `R + 256 G + 65536 B`.
    Rgb24,
    /// 8-bit RGB, `65536 R + 256 G + B`.
    Bgr24,
}

/// Which row a file stores first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Rows {
    TopDown,
    BottomUp,
}

/// Raw values that mean "unknown": one number or a list.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(from = "OneOrMany")]
pub(super) struct Invalid(pub Vec<f64>);

#[derive(Deserialize)]
#[serde(untagged, expecting = "`invalid` must be a number or a list of numbers")]
enum OneOrMany {
    One(f64),
    Many(Vec<f64>),
}

impl Invalid {
    /// Returns whether `raw` is one of the values; compared as 32-bit floats, as most files hold them.
    pub fn holds(&self, raw: f64) -> bool {
        self.0.iter().any(|&value| value == raw || value as f32 == raw as f32)
    }
}

impl From<OneOrMany> for Invalid {
    fn from(given: OneOrMany) -> Self {
        match given {
            OneOrMany::One(value) => Self(vec![value]),
            OneOrMany::Many(values) => Self(values),
        }
    }
}

/// `motion = { kind, … }`.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub(super) enum Motion {
    Disparity(DisparityMotion),
    Flow(Vectors),
    Planes(Vectors),
    BlenderVector(Vectors),
    /// The motion buffer of `XR_FB_space_warp` and `XR_EXT_frame_synthesis`.
    SpaceWarp(Vectors),
    Camera(Camera),
}

impl Motion {
    /// Display frames that its displacement spans.
    pub const fn frames(&self) -> u32 {
        match self {
            Self::Disparity(motion) => motion.frames,
            Self::Flow(vectors) | Self::Planes(vectors) | Self::BlenderVector(vectors) | Self::SpaceWarp(vectors) => {
                vectors.frames
            }
            Self::Camera(camera) => camera.frames,
        }
    }
}

/// Horizontal motion of `sign * raw * scale` pixels in `frames` display frames.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DisparityMotion {
    pub file: String,
    #[serde(default = "one")]
    pub scale: f64,
    pub sign: f64,
    pub channel: Option<String>,
    #[serde(default)]
    pub invalid: Invalid,
    #[serde(default)]
    pub format: MapFormat,
    pub rows: Option<Rows>,
    #[serde(default)]
    pub resize: bool,
    pub mask: Option<String>,
    #[serde(default = "one_frame")]
    pub frames: u32,
}

/// `acceleration = false`, `true`, or `{ kind = "next-flow", … }`.
#[derive(Clone, Debug)]
pub(super) enum Acceleration {
    /// Left out.
    No,
    /// Whatever the motion gives, as without the key.
    AsMotion,
    NextFlow(Box<Vectors>),
}

#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
enum AccelerationTable {
    NextFlow(Vectors),
}

/// How an infinitely far cell moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Background {
    Still,
    /// As a point at infinity seen by the camera.
    Camera,
    /// Not at all: the cell starts empty.
    Empty,
    /// As given by the file of the motion.
    Given,
}

fn one() -> f64 {
    1.0
}

fn one_frame() -> u32 {
    1
}

impl<'de> Deserialize<'de> for Color {
    fn deserialize<D: de::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Table {
            file: String,
            channel: Option<String>,
        }
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = Color;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a file's name or { file, channel }")
            }
            fn visit_str<E: de::Error>(self, file: &str) -> Result<Color, E> {
                Ok(Color { file: file.to_owned(), channel: None })
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Color, A::Error> {
                let Table { file, channel } = Table::deserialize(MapAccessDeserializer::new(map))?;
                Ok(Color { file, channel })
            }
        }
        deserializer.deserialize_any(Either)
    }
}

impl<'de> Deserialize<'de> for Acceleration {
    fn deserialize<D: de::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = Acceleration;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("false or { kind = \"next-flow\", file, frames }")
            }
            fn visit_bool<E: de::Error>(self, wanted: bool) -> Result<Acceleration, E> {
                Ok(if wanted { Acceleration::AsMotion } else { Acceleration::No })
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Acceleration, A::Error> {
                let AccelerationTable::NextFlow(vectors) = Deserialize::deserialize(MapAccessDeserializer::new(map))?;
                Ok(Acceleration::NextFlow(Box::new(vectors)))
            }
        }
        deserializer.deserialize_any(Either)
    }
}

impl Serialize for Acceleration {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        #[serde(tag = "kind", rename_all = "kebab-case")]
        enum Table<'v> {
            NextFlow(&'v Vectors),
        }
        match self {
            Self::No => serializer.serialize_bool(false),
            Self::AsMotion => serializer.serialize_bool(true),
            Self::NextFlow(vectors) => Table::NextFlow(vectors).serialize(serializer),
        }
    }
}

impl Manifest {
    /// Returns the manifest as it was read, with what its keys are where they are not given.
    pub fn resolved(&self, name: &str) -> String {
        let mut manifest = Self { name: Some(name.to_owned()), ..self.clone() };
        manifest.update.background = Some(self.update.background());
        toml::to_string(&manifest).unwrap_or_default()
    }

    /// Reads and checks a manifest.
    pub fn read(source: &Source) -> Result<Self, CaptureError> {
        let text = source.text()?;
        let mut manifest: Self = toml::from_str(text).map_err(|e| syntax(source, text, &e))?;
        manifest.truth.sort_by_key(|truth| truth.frame);
        manifest.check().map_err(|(what, hint)| source.fault(what, hint))?;
        Ok(manifest)
    }

    /// Checks the values; errors are (what, hint).
    fn check(&self) -> Result<(), (String, &'static str)> {
        frames("frames", self.frames)?;
        self.update.depth.check("depth")?;
        self.update.motion.check("motion")?;
        if matches!(self.update.motion, Motion::Camera(_)) && !self.update.depth.is_distance() {
            let hint = "give a depth map of kind \"z\", \"ray\" or \"buffer\", a baseline of the disparities, or another motion";
            return Err(("moves a camera past cells whose distance is unknown".into(), hint));
        }
        if self.update.background == Some(Background::Camera) && self.update.viewer().is_none() {
            let hint = "add an [update.camera] with intrinsics and poses, or choose still or empty";
            return Err(("asks for background = \"camera\" and gives no camera".into(), hint));
        }
        if let Some(Acceleration::NextFlow(vectors)) = &self.update.acceleration {
            vectors.check("acceleration")?;
        }
        if let Some(camera) = &self.update.camera {
            camera.check("camera")?;
        }
        if let Some(hidden) = &self.update.hidden {
            hidden.check(self)?;
        }
        for truth in &self.truth {
            if truth.frame == 0 || truth.frame > self.frames {
                let what = format!("truth.frame is {}, outside of 1 to {} (frames)", truth.frame, self.frames);
                return Err((what, "correct the frame, or raise frames"));
            }
        }
        if let Some(twice) = self.truth.windows(2).find(|pair| pair[0].frame == pair[1].frame) {
            let what = format!("has two truths for frame {}", twice[0].frame);
            return Err((what, "remove one of them"));
        }
        Ok(())
    }
}

impl Update {
    /// Returns the camera whose poses are given, if there is one.
    pub const fn viewer(&self) -> Option<&Camera> {
        match (&self.camera, &self.motion) {
            (Some(camera), _) | (None, Motion::Camera(camera)) => Some(camera),
            _ => None,
        }
    }

    /// Returns how infinitely far cells move.
    pub fn background(&self) -> Background {
        let usual = if self.viewer().is_some() { Background::Camera } else { Background::Still };
        self.background.unwrap_or(usual)
    }
}

impl Depth {
    fn check(&self, table: &str) -> Result<(), (String, &'static str)> {
        let Some(map) = self.map() else { return Ok(()) };
        map.check(table)?;
        map.intrinsics.map_or(Ok(()), |intrinsics| camera::check_intrinsics(table, intrinsics))?;
        match (self, map.planes) {
            (Self::Buffer(_), Some([near, far])) => {
                if near.is_nan() || far.is_nan() || near <= 0.0 || far <= 0.0 || near == far {
                    let hint = "write the distances of the values 0 and 1, for example [0.1, 1000.0] or [inf, 0.1]";
                    return Err((format!("{table}.planes are [{near}, {far}]"), hint));
                }
            }
            (Self::Buffer(_), None) => {
                let hint = "write the distances of the values 0 and 1, for example planes = [0.1, 1000.0]";
                return Err((format!("{table} of kind \"buffer\" has no planes"), hint));
            }
            (_, Some(_)) => return Err((format!("{table}.planes are for kind \"buffer\""), "remove that key")),
            (_, None) => {}
        }
        match (self, map.baseline) {
            (Self::Disparity(_), Some(baseline)) => positive(&format!("{table}.baseline"), baseline),
            (_, Some(_)) => Err((format!("{table}.baseline is for kind \"disparity\""), "remove that key")),
            (_, None) => Ok(()),
        }
    }
}

impl Map {
    fn check(&self, table: &str) -> Result<(), (String, &'static str)> {
        positive(&format!("{table}.scale"), self.scale)?;
        one_or_minus_one(&format!("{table}.sign"), self.sign)?;
        if !self.offset.is_finite() {
            return Err((format!("{table}.offset is {}", self.offset), "write a finite number"));
        }
        if self.far.is_some_and(f64::is_nan) {
            return Err((format!("{table}.far is not a number"), "write a raw value, or leave the key out"));
        }
        Ok(())
    }
}

impl Motion {
    fn check(&self, table: &str) -> Result<(), (String, &'static str)> {
        let key = format!("{table}.frames");
        match self {
            Self::Disparity(motion) => {
                positive(&format!("{table}.scale"), motion.scale)?;
                one_or_minus_one(&format!("{table}.sign"), motion.sign)?;
                frames(&key, motion.frames)
            }
            Self::Flow(vectors) | Self::Planes(vectors) => vectors.check(table),
            Self::BlenderVector(vectors) => vectors.check_blender(table),
            Self::SpaceWarp(vectors) => vectors.check_space_warp(table),
            Self::Camera(camera) => camera.check(table),
        }
    }
}

fn frames(key: &str, value: u32) -> Result<(), (String, &'static str)> {
    if (1..=MAX_FRAMES).contains(&value) {
        return Ok(());
    }
    Err((format!("{key} is {value}, outside of 1 to {MAX_FRAMES}"), "write the number of display frames"))
}

fn positive(key: &str, value: f64) -> Result<(), (String, &'static str)> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err((format!("{key} is {value}"), "write a finite number above zero"))
}

fn one_or_minus_one(key: &str, value: f64) -> Result<(), (String, &'static str)> {
    if value.abs() == 1.0 {
        return Ok(());
    }
    Err((format!("{key} is {value}"), "write -1 or 1 and put the size into scale"))
}

/// Returns a parser's error as a sentence with the line and the hint.
fn syntax(source: &Source, text: &str, error: &toml::de::Error) -> CaptureError {
    let message = error.message().replace("unknown field", "unknown key").replace("missing field", "missing key");
    let hint = if message.contains("unknown key") {
        "remove that key or write an expected one"
    } else if message.contains("missing key") {
        "add that key"
    } else if message.contains("unknown variant") {
        "write one of the expected values"
    } else {
        "correct the manifest"
    };
    let line = error.span().and_then(|span| text.get(..span.start)).map(|before| before.matches('\n').count() + 1);
    let place = line.map(|line| format!("line {line}: ")).unwrap_or_default();
    source.fault(format!("{place}{message}"), hint)
}
