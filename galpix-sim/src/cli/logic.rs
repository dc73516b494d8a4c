//! What a budget asks of logic: how far galpixels move, the band of rows for it, memory traffic, adders.

use galpix_core::record::Component;
use galpix_core::{Bits, Record, rolling};
use schemars::JsonSchema;
use serde::Serialize;

/// What hardware asks first.
#[derive(Serialize, JsonSchema)]
pub struct LogicReport {
    /// Columns of the map that the figures below are for.
    columns: u32,
    /// Its rows.
    rows: u32,
    /// Frames a second.
    rate_hz: u32,
    /// The most columns by which a galpixel moves in a frame.
    reach_columns: u32,
    /// The most rows by which a galpixel moves in a frame.
    reach_rows: u32,
    /// Rows of a band that rotates, for one round of bullets: `2 reach + 3`, at most all rows.
    band_rows: u32,
    /// What they hold.
    band_bytes: u64,
    /// Read of the map in a second, and written as much.
    bytes_a_second: u64,
    /// Bits of `2v + a` with its threshold, in x, y and depth; 0 where it does not move.
    step_adder_bits: [u32; 3],
    /// Bits of the position after the step, before it is snapped or clamped.
    position_adder_bits: [u32; 3],
}

/// The map that the figures are for.
#[derive(Clone, Copy, Debug)]
pub struct Display {
    /// Columns.
    pub columns: u32,
    /// Rows.
    pub rows: u32,
    /// Frames a second.
    pub rate: u32,
}

impl LogicReport {
    /// Derives the figures from a stored form.
    pub fn of(record: &Record, Display { columns, rows, rate }: Display) -> Self {
        let band_rows = rolling::rows(record, 1).min(rows);
        let bytes = record.bytes() as u64;
        let adders = [0, 1, 2].map(|component| adder_bits(record, component));
        Self {
            columns,
            rows,
            rate_hz: rate,
            reach_columns: rolling::reach_along(record, 0),
            reach_rows: rolling::reach(record),
            band_rows,
            band_bytes: u64::from(band_rows) * u64::from(columns) * bytes,
            bytes_a_second: u64::from(columns) * u64::from(rows) * u64::from(rate) * bytes,
            step_adder_bits: adders.map(|[step, _]| step),
            position_adder_bits: adders.map(|[_, position]| position),
        }
    }

    /// Says them in lines.
    pub fn text(&self) -> String {
        let megabytes = |bytes: u64| bytes as f64 / 1e6;
        let [step, position] = [self.step_adder_bits, self.position_adder_bits].map(|bits| bits.map(|n| n.to_string()));
        format!(
            "in logic, {} x {} at {} Hz\n  reach in a frame         {} columns, {} rows\n  band that rotates        {} rows, {:.3} \
             MB\n  read, and written        {:.1} MB/s each\n  adders in x, y, depth    step {} bits, position {} bits\n",
            self.columns,
            self.rows,
            self.rate_hz,
            self.reach_columns,
            self.reach_rows,
            self.band_rows,
            megabytes(self.band_bytes),
            megabytes(self.bytes_a_second),
            step.join(", "),
            position.join(", "),
        )
    }
}

/// Returns the bits that hold any `2v + a + threshold` of a component, and any position after the step.
fn adder_bits(record: &Record, component: usize) -> [u32; 2] {
    let scale = &record.scales[component];
    let [velocity, acceleration] =
        [record.velocity(component).bits, record.acceleration(component).bits].map(u32::from);
    if velocity == 0 {
        return [0; 2];
    }
    let half = |bits: u32| if bits == 0 { 0 } else { 1i64 << (bits - 1) };
    let (v, a) = (half(velocity), half(acceleration) << scale.acceleration_up);
    let lowest = -2 * v - a;
    let highest = 2 * (v - 1) + (a - 1).max(0) + (1i64 << scale.down) - 1;
    let stored = if component == 2 { u32::from(record.depth().bits) } else { scale.position_frac };
    let [least, most] =
        if component == 2 { [0, (1i64 << stored) - 1] } else { [-half(stored), (half(stored) - 1).max(0)] };
    let moved = |step: i64| (step >> scale.down) << scale.up;
    [signed_bits(lowest, highest), signed_bits(least + moved(lowest), most + moved(highest))]
}

/// Returns the bits of the least two's complement number that holds both.
const fn signed_bits(lowest: i64, highest: i64) -> u32 {
    let least = 65 - if lowest < 0 { !lowest } else { lowest }.leading_zeros();
    let most = 65 - highest.unsigned_abs().leading_zeros();
    if least > most { least } else { most }
}

/// Takes integer bits off the motion in y until no galpixel moves by more rows than `limit`. The fraction bits stay,
/// and with them the certificate: what is cut is how fast anything may be, along y alone.
///
/// *Errors:* if even the narrowest field that can be stored moves farther.
pub fn limited(bits: Bits, limit: u32, plan: impl Fn(Bits) -> Option<Record>) -> Result<Bits, String> {
    let mut y = bits.y;
    loop {
        let narrowed = bits.with_xy(bits.x, y);
        let Some(record) = plan(narrowed) else {
            return Err(format!(
                "no width of the motion in y keeps within {limit} rows: give `--limit-y` a larger number"
            ));
        };
        if rolling::reach(&record) <= limit {
            return Ok(narrowed);
        }
        // The field that may move farther goes first; an acceleration only ever adds half of itself in one frame.
        let Component { velocity_int, acceleration_int, .. } = y;
        if acceleration_int > velocity_int || (velocity_int == 1 && acceleration_int > 1) {
            y.acceleration_int -= 1;
        } else if velocity_int > 1 {
            y.velocity_int -= 1;
        } else {
            return Err(format!(
                "no width of the motion in y keeps within {limit} rows: give `--limit-y` a larger number"
            ));
        }
    }
}
