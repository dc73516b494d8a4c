//! `[update.hidden]`: what is known behind the update's samples.

use serde::{Deserialize, Serialize};

use super::{Color, Depth, Manifest, Map, Motion};
use crate::source::hidden::SEPARATION;

/// Most views of a capture.
const MAX_VIEWS: usize = 64;

/// Where the hidden samples come from.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub(in super::super) enum Hidden {
    /// A second layer of depth, over the same pixels.
    Layer(Box<Layer>),
    /// Pictures of the same still scene from elsewhere.
    Views(Views),
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct Layer {
    pub color: Color,
    pub channel: Option<String>,
    pub depth: Depth,
    /// May be left out where the update's motion is that of a camera.
    pub motion: Option<Motion>,
}

#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct Views {
    pub views: Vec<View>,
    /// Normalised depth that a sample lies behind the first layer at least.
    #[serde(default = "separation")]
    pub separation: f64,
}

/// A picture from elsewhere, with the intrinsics and the file of poses of the update's motion.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(in super::super) struct View {
    /// Its number among the poses.
    pub pose: u32,
    pub color: Color,
    pub channel: Option<String>,
    pub depth: Map,
}

fn separation() -> f64 {
    SEPARATION
}

impl Hidden {
    /// Checks the values; errors are (what, hint).
    pub fn check(&self, manifest: &Manifest) -> Result<(), (String, &'static str)> {
        let update = &manifest.update;
        match self {
            Self::Layer(layer) => {
                layer.depth.check("hidden.depth")?;
                if std::mem::discriminant(&layer.depth) != std::mem::discriminant(&update.depth) {
                    return Err((
                        "has a hidden.depth of another kind than update.depth".into(),
                        "give both layers depths of one kind",
                    ));
                }
                if matches!(layer.depth, Depth::Speed(_)) {
                    let hint = "give both layers depths of kind \"z\" or \"disparity\"";
                    return Err(("has a hidden layer and no depth that says what is behind".into(), hint));
                }
                match &layer.motion {
                    Some(motion) => motion.check("hidden.motion"),
                    None if matches!(update.motion, Motion::Camera(_)) => Ok(()),
                    None => {
                        Err(("has a hidden layer without a motion".into(), "add the key motion to [update.hidden]"))
                    }
                }
            }
            Self::Views(views) => {
                if !matches!((&update.motion, &update.depth), (Motion::Camera(_), Depth::Z(_))) {
                    let hint = "give update.motion of kind \"camera\" and update.depth of kind \"z\"";
                    return Err(("has hidden.views of a scene whose camera is unknown".into(), hint));
                }
                if views.views.is_empty() || views.views.len() > MAX_VIEWS {
                    let what = format!("has {} hidden.views, not 1 to {MAX_VIEWS}", views.views.len());
                    return Err((what, "list some views, or remove [update.hidden]"));
                }
                if !(0.0..1.0).contains(&views.separation) {
                    let what = format!("hidden.separation is {}", views.separation);
                    return Err((what, "write a part of the depth range from 0 to below 1"));
                }
                views.views.iter().try_for_each(|view| view.depth.check("hidden.views.depth"))
            }
        }
    }
}
