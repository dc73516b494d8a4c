//! The columns of the table, a line per scene: means over the frames whose truth is known, and the worst position error
//! of all frames.

use super::SceneReport;
use crate::metric::measures::Measures;
use crate::metric::stats::mean;
use crate::output::column::{Column, Value};
use crate::output::measures::{self, Measured};
use crate::study::run::{PositionReport, TruthReport};

fn decibels(scene: &SceneReport, of: fn(&TruthReport) -> Option<f64>) -> Value {
    mean(scene.run.frames.iter().filter_map(|frame| of(&frame.truth?))).into()
}

fn worst(scene: &SceneReport, of: fn(&PositionReport) -> Option<f64>) -> Value {
    scene.run.frames.iter().filter_map(|frame| of(&frame.position?)).reduce(f64::max).into()
}

impl Measured for SceneReport {
    fn measures(&self) -> Measures {
        self.run.measures()
    }
}

/// Returns the columns.
pub fn columns() -> Vec<Column<SceneReport>> {
    let column = Column::<SceneReport>::new;
    let mut columns = vec![
        column(|scene| scene.run.source.as_str().into()).terminal("scene", 0).words(),
        column(|scene| scene.run.frames.len().into()).terminal("frames", 0),
        column(|scene| scene.measures().psnr_db.into()).terminal("galpix dB", 2),
        column(|scene| decibels(scene, |truth| truth.psnr_hold_db)).terminal("hold dB", 2),
        column(|scene| decibels(scene, |truth| truth.psnr_known_db)).terminal("known dB", 2),
    ];
    columns.extend(measures::columns());
    columns.extend([
        column(|scene| worst(scene, |position| Some(position.worst_px))).terminal("worst px", 4),
        column(|scene| scene.run.certificate.after(scene.run.frames.len() as u32).into()).terminal("bound px", 4),
        column(|scene| worst(scene, |position| position.truth_worst_px)).terminal("truth px", 4),
        column(|scene| scene.run.ns_per_galpixel.into()).terminal("ns/gal", 1),
        column(|scene| scene.gain.into()).terminal("x const", 1),
    ]);
    columns
}

/// What the columns are.
pub const LEGEND: &str = "dB, change, judder, missing: means over the frames whose truth is known. worst px: from the exact second-order path, bounded by bound px; \
truth px: from the true motion. x const: time of a constant-time frame / of a data-dependent one.";
