//! The columns of the table, a line a scene: means over the frames whose truth is known, and the worst position error
//! of all frames.

use super::Told;
use crate::metric::stats::mean;
use crate::output::column::{Column, Value};
use crate::study::run::{PositionReport, TruthReport};

fn decibels(told: &Told, of: fn(&TruthReport) -> Option<f64>) -> Value {
    mean(told.run.frames.iter().filter_map(|frame| of(&frame.truth?))).into()
}

fn worst(told: &Told, of: fn(&PositionReport) -> Option<f64>) -> Value {
    told.run.frames.iter().filter_map(|frame| of(&frame.position?)).reduce(f64::max).into()
}

fn holes_percent(told: &Told) -> f64 {
    let cells = (told.run.width * told.run.height * told.run.frames.len()).max(1) as f64;
    100.0 * told.run.frames.iter().map(|frame| f64::from(frame.holes)).sum::<f64>() / cells
}

/// Returns the columns.
pub fn columns() -> [Column<Told>; 11] {
    let column = Column::<Told>::new;
    [
        column(|told| told.run.source.as_str().into()).terminal("scene", 0).words(),
        column(|told| told.run.frames.len().into()).terminal("frames", 0),
        column(|told| decibels(told, |truth| truth.psnr_db)).terminal("galpix dB", 2),
        column(|told| decibels(told, |truth| truth.psnr_hold_db)).terminal("hold dB", 2),
        column(|told| decibels(told, |truth| truth.psnr_known_db)).terminal("known dB", 2),
        column(|told| worst(told, |position| Some(position.worst_px))).terminal("worst px", 4),
        column(|told| told.run.certificate.after(told.run.frames.len() as u32).into()).terminal("bound px", 4),
        column(|told| worst(told, |position| position.truth_worst_px)).terminal("truth px", 4),
        column(|told| holes_percent(told).into()).terminal("holes %", 2),
        column(|told| told.run.ns_per_galpixel.into()).terminal("ns/gal", 1),
        column(|told| told.gain.into()).terminal("x const", 1),
    ]
}

/// What the columns are.
pub const LEGEND: &str = "dB: mean over the frames whose truth is known. worst px: from the exact second-order path, bounded by bound px; \
truth px: from the true motion. x const: a frame with constant work by one that skips.";
