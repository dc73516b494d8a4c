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

/// Returns a figure of the last frame whose truth is known.
fn last(scene: &SceneReport, of: fn(&TruthReport) -> f64) -> Value {
    scene.run.frames.iter().rev().find_map(|frame| frame.truth.as_ref().map(of)).into()
}

/// Returns the columns.
pub fn columns() -> Vec<Column<SceneReport>> {
    let column = Column::<SceneReport>::new;
    let mut columns = vec![
        column(|scene| scene.run.source.as_str().into()).terminal("scene", 0).words(),
        column(|scene| scene.run.frames.len().into()).terminal("frames", 0).means("frames made of one update"),
        column(|scene| scene.measures().psnr_db.into()).terminal("galpix dB", 2).means(
            "PSNR of what is shown against the truth; all but worst figures are means over the frames with a truth",
        ),
        column(|scene| decibels(scene, |truth| truth.psnr_hold_db))
            .terminal("hold dB", 2)
            .means("the same of sample-and-hold: the update, unmoved"),
        column(|scene| decibels(scene, |truth| truth.psnr_known_db))
            .terminal("reached dB", 2)
            .means("PSNR of the cells that a galpixel of the update reached: all but those of missing %"),
    ];
    columns.extend(measures::columns());
    // Beside the mean: a mean hides how little is left at the end.
    let at_end = column(|scene| last(scene, |truth| truth.missing_percent));
    columns.insert(6, at_end.terminal("at end %", 2).means("the same in the last frame"));
    columns.extend(places());
    columns.extend([
        column(|scene| scene.run.ns_per_galpixel.into())
            .terminal("ns/gal", 1)
            .means("nanoseconds a galpixel moved, the median of the frames"),
        column(|scene| scene.gain.into())
            .terminal("x const", 1)
            .means("time of a constant-time frame by that of a data-dependent one; the map only"),
    ]);
    columns
}

/// Returns the columns of where galpixels are.
fn places() -> [Column<SceneReport>; 3] {
    let column = Column::<SceneReport>::new;
    [
        column(|scene| worst(scene, |position| Some(position.worst_px)))
            .terminal("path px", 4)
            .means("the worst distance of a galpixel from the update's second-order path, before the snap to a cell"),
        column(|scene| scene.run.certificate.after(scene.run.frames.len() as u32).into())
            .terminal("bound px", 4)
            .means("the certificate for that distance in these frames; up to tau_prop it is larger"),
        column(|scene| worst(scene, |position| position.truth_worst_px))
            .terminal("truth px", 4)
            .means("the worst distance from the true motion: what no certificate covers"),
    ]
}
