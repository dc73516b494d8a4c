//! The verdict of a case, from what was measured.

use super::causes::{Followed, Row};
use super::exact::Px;
use super::setting::Law;

/// What floating point may add to a bound.
const FLOAT_PX: f64 = 1e-9;

/// How a case came out. The worst of several is the greatest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The error is within the certificate in every frame.
    Bounded,
    /// The arithmetic is within its law in every frame, and the certificate does not cover something that happened.
    NotCovered,
    /// The engine did what it may not do.
    Unstable,
}

impl Verdict {
    /// Returns the word in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bounded => "bounded",
            Self::NotCovered => "not covered",
            Self::Unstable => "UNSTABLE",
        }
    }
}

/// What the certificate does not cover of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, schemars::JsonSchema)]
pub struct Uncovered {
    /// The largest Taylor error where it takes a galpixel out of its bound, in pixels.
    pub taylor_px: Option<f64>,
    /// The largest error from clamped fields, in pixels.
    pub saturation_px: Option<f64>,
    /// The largest error of the arithmetic after the last certified frame, in pixels.
    pub past_prop_px: Option<f64>,
}

impl Uncovered {
    /// Returns both together.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        let larger = |one: Option<f64>, two: Option<f64>| one.into_iter().chain(two).reduce(f64::max);
        Self {
            taylor_px: larger(self.taylor_px, other.taylor_px),
            saturation_px: larger(self.saturation_px, other.saturation_px),
            past_prop_px: larger(self.past_prop_px, other.past_prop_px),
        }
    }
}

/// The verdict on a path, and what it rests on.
#[derive(Clone, Debug)]
pub struct Judged {
    /// How it came out.
    pub verdict: Verdict,
    /// What is not covered.
    pub uncovered: Uncovered,
    /// What the engine did and may not do.
    pub findings: Vec<String>,
}

/// Judges a path by the law of its component.
#[must_use]
pub fn judge(followed: &Followed, law: &Law) -> Judged {
    let mut findings = followed.findings.clone();
    let mut uncovered = Uncovered::default();
    let mut last_clean = 0;
    for row in &followed.rows {
        if row.since == 0 || !row.saturated {
            last_clean = row.since;
        }
        if let Some(finding) = broken(row, law, followed.aligned, last_clean)
            && findings.len() == followed.findings.len()
        {
            findings.push(format!("{finding} (frame {})", row.frame));
        }
        uncovered = uncovered.with(beyond(row, law, followed.aligned));
    }
    let verdict = if !findings.is_empty() {
        Verdict::Unstable
    } else if uncovered != Uncovered::default() {
        Verdict::NotCovered
    } else {
        Verdict::Bounded
    };
    Judged { verdict, uncovered, findings }
}

/// Returns the error of the arithmetic alone: what quantisation and drift make together, in pixels.
fn arithmetic_px(row: &Row) -> f64 {
    (row.causes.quantisation + row.causes.drift).abs().to_f64()
}

/// Returns the law that a frame breaks. Beyond a clamp the low bits of the velocity may stand still, and with them what
/// rounding drops: from there on each frame may drift by one last bit of the position.
fn broken(row: &Row, law: &Law, aligned: bool, last_clean: u32) -> Option<String> {
    let drift = row.causes.drift.abs().to_f64();
    let snapping = row.causes.snapping;
    let half = Px::of(1, 1);
    let stuck = law.last_bit_px * f64::from(row.since - last_clean.min(row.since));
    let clean = if row.steady { law.steady_drift_px(row.since, aligned) } else { law.drift_px(row.since, aligned) };
    let drift_law = clean + stuck;
    if !row.saturated && arithmetic_px(row) > law.bound_px(row.since, aligned) + FLOAT_PX {
        Some(format!("off by {:.4} px, over the bound of {:.4}", arithmetic_px(row), law.bound_px(row.since, aligned)))
    } else if drift > drift_law + FLOAT_PX {
        Some(format!("drifted {drift:.4} px, over {drift_law:.4}"))
    } else if snapping >= half || snapping < Px::default() - half {
        Some(format!("shown {:.4} px off: not in the nearest cell", snapping.to_f64()))
    } else {
        None
    }
}

/// Returns what the certificate does not cover in a frame.
fn beyond(row: &Row, law: &Law, aligned: bool) -> Uncovered {
    let px = |share: Px| share.abs().to_f64();
    let causes = &row.causes;
    let bound = law.bound_px(row.since, aligned);
    let off = px(causes.taylor + causes.quantisation + causes.drift);
    Uncovered {
        taylor_px: (px(causes.taylor) > FLOAT_PX && off > bound + FLOAT_PX).then_some(px(causes.taylor)),
        saturation_px: row.saturated.then_some(px(causes.saturation)),
        past_prop_px: (row.since > law.certified).then_some(arithmetic_px(row)),
    }
}
