//! The columns of the points: a line per point, and in the CSV one for sample-and-hold of each source.

use super::frames::Summary;
use super::report::{Point, Scheme, SourceReport};
use crate::metric::measures::Measures;
use crate::output::column::{Column, Value};
use crate::output::measures::{self, Measured};
use crate::study::timing::Time;

/// A point, or sample-and-hold.
pub struct Row<'r> {
    source: &'r SourceReport,
    /// Its letter in the plots, or its number.
    name: String,
    point: Option<&'r Point>,
}

impl Measured for Row<'_> {
    fn measures(&self) -> Measures {
        self.summary_of().measures
    }
}

impl<'r> Row<'r> {
    /// Makes the row of a point.
    pub fn new(source: &'r SourceReport, point: &'r Point, name: String) -> Self {
        Self { source, name, point: Some(point) }
    }

    fn of<V: Into<Value>>(&self, of: impl Fn(&'r Point) -> V) -> Value {
        self.point.map(of).into()
    }

    fn summary(&self, of: fn(&Summary) -> Option<f64>) -> Value {
        of(self.summary_of()).into()
    }

    fn summary_of(&self) -> &'r Summary {
        self.point.map_or(&self.source.hold, |point| &point.summary)
    }

    fn scheme(&self) -> Value {
        let Some(point) = self.point else { return "hold".into() };
        match point.scheme {
            Scheme::Galpix => "galpix".into(),
            Scheme::F32 => "f32".into(),
            Scheme::Source => "source".into(),
        }
    }

    /// Returns the budget, or that there is none.
    fn budget(&self) -> Value {
        self.of(|point| if point.scheme == Scheme::F32 { "f32" } else { point.budget.as_str() })
    }

    fn bits(&self, place: usize) -> Value {
        self.of(|point| point.bits.map(|bits| bits[place]))
    }

    /// Returns the time of a product's form.
    fn compiled(&self, of: fn(Time) -> f64) -> Value {
        self.of(|point| point.compile_time.map(of))
    }

    /// Returns the time of the simulator's form.
    fn run(&self, of: fn(Time) -> f64) -> Value {
        self.of(|point| point.run_time.map(of))
    }

    /// Returns whether it is on a front.
    fn on(&self, front: &[usize]) -> Value {
        self.of(|point| front.contains(&point.id))
    }
}

/// Returns the lines of the CSV of a source.
pub fn rows(source: &SourceReport) -> impl Iterator<Item = Row<'_>> {
    let points = source.points.iter().map(move |point| Row::new(source, point, String::new()));
    points.chain([Row { source, name: String::new(), point: None }])
}

/// Returns the columns.
pub fn columns<'r>() -> Vec<Column<Row<'r>>> {
    let mut columns = Vec::from(kinds());
    columns.extend(widths());
    columns.extend(times());
    columns.extend(errors());
    columns.extend(measures::columns());
    columns.extend(verdicts());
    columns
}

/// Returns what a point is.
fn kinds<'r>() -> [Column<Row<'r>>; 9] {
    [
        Column::new(|row: &Row| row.source.source.as_str().into()).csv("source"),
        Column::new(|row: &Row| row.of(|point| point.id)).csv("id").terminal("no", 0),
        Column::new(|row: &Row| row.name.as_str().into()).page("", 0),
        Column::new(|row: &Row| row.scheme()).csv("scheme").both("scheme", 0).words(),
        Column::new(|row: &Row| row.of(|point| point.fields)).csv("lanes").both("lanes", 0).words(),
        Column::new(|row: &Row| row.of(|point| point.budget.as_str())).csv("budget"),
        Column::new(|row: &Row| row.budget()).both("budget", 0).words(),
        Column::new(|row: &Row| row.of(|point| point.rounding)).csv("rounding").both("rounding", 0).words(),
        Column::new(|row: &Row| row.of(|point| point.fill)).csv("rung").both("rung", 0).words(),
    ]
}

fn widths<'r>() -> [Column<Row<'r>>; 7] {
    [
        Column::new(|row: &Row| row.bits(0)).csv("position_frac_bits"),
        Column::new(|row: &Row| row.bits(1)).csv("velocity_int_bits"),
        Column::new(|row: &Row| row.bits(2)).csv("velocity_frac_bits"),
        Column::new(|row: &Row| row.bits(3)).csv("acceleration_int_bits"),
        Column::new(|row: &Row| row.bits(4)).csv("acceleration_frac_bits"),
        Column::new(|row: &Row| row.of(|point| point.bytes)).csv("bytes").both("bytes", 0),
        Column::new(|row: &Row| row.of(|point| point.used_bits)).csv("used_bits"),
    ]
}

fn times<'r>() -> [Column<Row<'r>>; 7] {
    [
        Column::new(|row: &Row| row.compiled(|time| time.frame_us))
            .csv("compile_time_us")
            .terminal("us/frame", 1)
            .page("\u{00B5}s a frame", 0),
        Column::new(|row: &Row| row.compiled(|time| time.ns_per_cell)).csv("compile_time_ns_per_cell"),
        Column::new(|row: &Row| row.compiled(|time| time.x_copy))
            .csv("compile_time_x_copy")
            .terminal("x copy", 2)
            .page("\u{00D7} copy", 1),
        Column::new(|row: &Row| row.of(|point| point.stand_in.clone())).csv("stand_in"),
        Column::new(|row: &Row| row.run(|time| time.frame_us))
            .csv("run_time_us")
            .terminal("run-time", 1)
            .page("run-time form, \u{00B5}s", 0),
        Column::new(|row: &Row| row.run(|time| time.ns_per_cell)).csv("run_time_ns_per_cell"),
        Column::new(|row: &Row| row.run(|time| time.x_copy)).csv("run_time_x_copy"),
    ]
}

/// Returns the columns of the results of the frames. On the page the mean follows the bound.
fn errors<'r>() -> [Column<Row<'r>>; 11] {
    [
        Column::new(|row: &Row| row.summary(|all| all.worst_px)).csv("worst_px").both("worst px", 4),
        Column::new(|row: &Row| row.summary(|all| all.mean_px)).csv("mean_px"),
        Column::new(|row: &Row| row.summary(|all| all.certified_px)).csv("certified_px"),
        Column::new(|row: &Row| row.summary(|all| all.bound_px))
            .csv("bound_px")
            .terminal("bound px", 4)
            .page("at most px", 4),
        Column::new(|row: &Row| row.summary(|all| all.mean_px)).page("mean px", 4),
        Column::new(|row: &Row| row.summary(|all| all.truth_worst_px))
            .csv("truth_worst_px")
            .terminal("truth px", 4)
            .page("worst, true motion px", 3),
        Column::new(|row: &Row| row.summary(|all| all.truth_mean_px)).csv("truth_mean_px"),
        Column::new(|row: &Row| row.measures().psnr_db.into()).csv("psnr_db").terminal("PSNR", 2).page("PSNR dB", 2),
        Column::new(|row: &Row| row.summary(|all| all.psnr_known_db)).csv("psnr_known_db"),
        Column::new(|row: &Row| row.summary(|all| all.ssim)).csv("ssim").both("SSIM", 4),
        Column::new(|row: &Row| row.summary(|all| all.flip)).csv("flip").both("FLIP", 4),
    ]
}

/// Returns the columns of what was found of the errors.
fn verdicts<'r>() -> [Column<Row<'r>>; 4] {
    [
        Column::new(|row: &Row| row.of(|point| point.saturated)).csv("saturated"),
        Column::new(|row: &Row| row.on(&row.source.fronts.position)).csv("front_position"),
        Column::new(|row: &Row| row.on(&row.source.fronts.picture)).csv("front_picture"),
        Column::new(|row: &Row| row.on(&row.source.fronts.bytes)).csv("front_bytes"),
    ]
}
