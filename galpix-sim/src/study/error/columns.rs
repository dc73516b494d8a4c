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

    /// Returns how far that time is from its median at most, in per cent.
    fn compiled_percent(&self) -> Value {
        self.of(|point| point.compile_time.map(|time| time.uncertain_percent()))
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
        Column::new(|row: &Row| row.of(|point| point.id)).csv("id").terminal("no", 0).means("the number of the point"),
        Column::new(|row: &Row| row.name.as_str().into()).page("", 0),
        Column::new(|row: &Row| row.scheme())
            .csv("scheme")
            .both("scheme", 0)
            .words()
            .means("galpix: the map; source: stationary sources; f32: the map in floats"),
        Column::new(|row: &Row| row.of(|point| point.fields))
            .csv("lanes")
            .both("lanes", 0)
            .words()
            .means("the fields that a galpixel carries"),
        Column::new(|row: &Row| row.of(|point| point.budget.as_str())).csv("budget"),
        Column::new(|row: &Row| row.budget())
            .both("budget", 0)
            .words()
            .means("how its widths differ from those of the equations, in bits"),
        Column::new(|row: &Row| row.of(|point| point.rounding))
            .csv("rounding")
            .both("rounding", 0)
            .words()
            .means("how positions are rounded"),
        Column::new(|row: &Row| row.of(|point| point.fill))
            .csv("rung")
            .both("rung", 0)
            .words()
            .means("what is put into holes: the fill mode"),
    ]
}

fn widths<'r>() -> [Column<Row<'r>>; 7] {
    [
        Column::new(|row: &Row| row.bits(0)).csv("position_frac_bits"),
        Column::new(|row: &Row| row.bits(1)).csv("velocity_int_bits"),
        Column::new(|row: &Row| row.bits(2)).csv("velocity_frac_bits"),
        Column::new(|row: &Row| row.bits(3)).csv("acceleration_int_bits"),
        Column::new(|row: &Row| row.bits(4)).csv("acceleration_frac_bits"),
        Column::new(|row: &Row| row.of(|point| point.bytes))
            .csv("bytes")
            .both("bytes", 0)
            .means("of a stored galpixel, in whole words"),
        Column::new(|row: &Row| row.of(|point| point.used_bits)).csv("used_bits"),
    ]
}

fn times<'r>() -> [Column<Row<'r>>; 12] {
    [
        Column::new(|row: &Row| row.compiled(|time| time.frame_us))
            .csv("compile_time_us")
            .both("us/frame", 1)
            .means("time of a frame with the budget fixed at compile time, by a stand-in: the median of the rounds"),
        Column::new(|row: &Row| row.compiled_percent())
            .both("+- %", 0)
            .means("half the range of the rounds, of the median: times that differ by less are not told apart"),
        Column::new(|row: &Row| row.compiled(|time| time.frame_us_range[0])).csv("compile_time_us_low"),
        Column::new(|row: &Row| row.compiled(|time| time.frame_us_range[1])).csv("compile_time_us_high"),
        Column::new(|row: &Row| row.compiled(|time| time.ns_per_cell)).csv("compile_time_ns_per_cell"),
        Column::new(|row: &Row| row.compiled(|time| time.x_copy))
            .csv("compile_time_x_copy")
            .both("x copy", 2)
            .means("that time by a copy of as many bytes as the map has"),
        Column::new(|row: &Row| row.of(|point| point.stand_in.clone())).csv("stand_in"),
        Column::new(|row: &Row| row.run(|time| time.frame_us))
            .csv("run_time_us")
            .both("run-time us", 1)
            .means("time of a frame with the budget chosen at run time, as the simulator runs it"),
        Column::new(|row: &Row| row.run(|time| time.frame_us_range[0])).csv("run_time_us_low"),
        Column::new(|row: &Row| row.run(|time| time.frame_us_range[1])).csv("run_time_us_high"),
        Column::new(|row: &Row| row.run(|time| time.ns_per_cell)).csv("run_time_ns_per_cell"),
        Column::new(|row: &Row| row.run(|time| time.x_copy)).csv("run_time_x_copy"),
    ]
}

/// Returns the columns of the results of the frames: the bound first, by which the fronts are ranked.
fn errors<'r>() -> [Column<Row<'r>>; 11] {
    [
        Column::new(|row: &Row| row.summary(|all| all.certified_px)).csv("certified_px"),
        Column::new(|row: &Row| row.summary(|all| all.bound_px))
            .csv("bound_px")
            .both("bound px", 4)
            .means("the certificate and what fields that are left out would have moved: ranks the fronts"),
        Column::new(|row: &Row| row.summary(|all| all.worst_px))
            .csv("worst_px")
            .both("path px", 4)
            .means("the worst distance measured from the second-order path, in the frames looked at"),
        Column::new(|row: &Row| row.summary(|all| all.mean_px)).csv("mean_px"),
        Column::new(|row: &Row| row.summary(|all| all.truth_worst_px))
            .csv("truth_worst_px")
            .both("truth px", 4)
            .means("the worst distance from the true motion, where that is known: what no certificate covers"),
        Column::new(|row: &Row| row.summary(|all| all.truth_mean_px)).csv("truth_mean_px"),
        Column::new(|row: &Row| row.measures().psnr_db.into())
            .csv("psnr_db")
            .both("PSNR dB", 2)
            .means("of the whole picture; like all that follow a mean over the pictures compared"),
        Column::new(|row: &Row| row.summary(|all| all.ssim))
            .csv("ssim")
            .both("SSIM", 4)
            .means("structural similarity, 1 for equals"),
        Column::new(|row: &Row| row.summary(|all| all.flip)).csv("flip").both("FLIP", 4).means("0 for equals"),
        Column::new(|row: &Row| row.of(|point| point.saturated))
            .csv("saturated")
            .page("clamped", 0)
            .means("fields that a range had to stop: their galpixels are outside of the certificate"),
        Column::new(|row: &Row| row.summary(|all| all.psnr_known_db)).csv("psnr_known_db"),
    ]
}

/// Returns the columns of what was found of the errors.
fn verdicts<'r>() -> [Column<Row<'r>>; 3] {
    [
        Column::new(|row: &Row| row.on(&row.source.fronts.position)).csv("front_position"),
        Column::new(|row: &Row| row.on(&row.source.fronts.picture)).csv("front_picture"),
        Column::new(|row: &Row| row.on(&row.source.fronts.bytes)).csv("front_bytes"),
    ]
}
