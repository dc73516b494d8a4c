//! The budget that the suite runs under: what its fields hold, and its certificate frame by frame.

use galpix_core::record::{Component, Record, Scale};
use galpix_core::{Bits, BudgetError, Demand, Layout, Rounding};

use crate::certificate::{Certificate, FrameBound};

/// Columns that a map can have.
const MOST_COLUMNS: u64 = 1 << 15;

/// Why the suite cannot run under a demand.
#[derive(Clone, Copy, Debug, thiserror::Error)]
pub enum SettingError {
    /// There is no such budget.
    #[error("this budget cannot exist: {0}")]
    Budget(#[from] BudgetError),
    /// A galpixel could leave any map in one step.
    #[error(
        "a galpixel of this budget can move {0} cells in a frame, and a map has at most {MOST_COLUMNS}: \
         lower --extent or raise --recog"
    )]
    TooFast(u64),
}

/// A budget and its numbers.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// The three design numbers.
    pub demand: Demand,
    /// The widths.
    pub bits: Bits,
    /// The stored form of the layout [`Layout::FULL`].
    pub record: Record,
}

/// What the fields of a component hold, in units of their last bits.
#[derive(Clone, Copy, Debug)]
pub struct Ranges {
    /// The arithmetic.
    pub scale: Scale,
    /// The largest velocity; the smallest is one less than its opposite.
    pub velocity_top: i64,
    /// The largest acceleration; the smallest is one less than its opposite.
    pub acceleration_top: i64,
    /// In depth the largest position; in x and y there is none.
    pub far: Option<i64>,
}

impl Setting {
    /// Creates the paper's budget for a demand.
    ///
    /// *Errors:* a budget that cannot exist, or whose steps no map can hold.
    pub fn new(demand: Demand) -> Result<Self, SettingError> {
        let bits = Bits::derive(demand)?;
        let record = Record::plan(bits, Layout::FULL)?;
        let fastest = (1u64 << (bits.x.velocity_int - 1)) + (1u64 << (bits.x.acceleration_int - 1)) / 2 + 4;
        if fastest > MOST_COLUMNS {
            return Err(SettingError::TooFast(fastest));
        }
        Ok(Self { demand, bits, record })
    }

    /// Returns the widths of a component.
    #[must_use]
    pub const fn component(&self, component: usize) -> Component {
        match component {
            0 => self.bits.x,
            1 => self.bits.y,
            _ => self.bits.z,
        }
    }

    /// Returns what the fields of a component hold.
    #[must_use]
    pub fn ranges(&self, component: usize) -> Ranges {
        let widths = self.component(component);
        Ranges {
            scale: self.record.scales[component],
            velocity_top: (1 << (widths.velocity_bits() - 1)) - 1,
            acceleration_top: (1 << (widths.acceleration_bits() - 1)) - 1,
            far: (component == 2).then(|| (1 << self.record.depth().bits) - 1),
        }
    }

    /// Returns the power of two of the unit that an update gives a component in: cells, in depth the whole range.
    #[must_use]
    pub const fn unit(&self, component: usize) -> u32 {
        if component == 2 { self.bits.depth_int } else { 0 }
    }
}

/// What a component may be off by, frame by frame: the certificate up to `tau_prop`, and the same enumeration beyond.
#[derive(Clone, Debug)]
pub struct Law {
    /// Frames that the budget is certified for.
    pub certified: u32,
    /// A last bit of the position, in pixels.
    pub last_bit_px: f64,
    /// Whether a table is aligned with the updates, or has the same bounds from any frame of the counter on.
    searched: bool,
    /// For the frames that are certified.
    certificate: Certificate,
    /// The same enumeration for all frames.
    beyond: Certificate,
    /// The same of the states without acceleration, which drift less.
    steady: Certificate,
}

impl Law {
    /// Creates the law of a component for `frames` frames without an update.
    #[must_use]
    pub fn of(setting: &Setting, component: usize, rounding: Rounding, frames: u32) -> Self {
        let scale = &setting.record.scales[component];
        let longest = frames.max(setting.demand.prop);
        let of = |frames: u32| Certificate::of(scale, true, rounding, frames);
        Self {
            certified: setting.demand.prop,
            last_bit_px: 0.5f64.powi(scale.position_frac as i32),
            searched: rounding == Rounding::Searched,
            certificate: of(setting.demand.prop),
            beyond: of(longest),
            steady: Certificate::of(scale, false, rounding, longest),
        }
    }

    /// Returns the quantisation and drift after `frame` frames, in pixels. `aligned`: the update entered at frame 0 of
    /// the counter.
    #[must_use]
    pub fn bound_px(&self, frame: u32, aligned: bool) -> f64 {
        match self.after(frame) {
            Some(bound) => bound.quantisation_px + self.drift_px(frame, aligned),
            None if frame == 0 => self.last_bit_px / 2.0,
            None => f64::INFINITY,
        }
    }

    /// Returns the drift alone after `frame` frames, in pixels.
    #[must_use]
    pub fn drift_px(&self, frame: u32, aligned: bool) -> f64 {
        // Of a searched table that an update does not enter at its first entry only the largest drift is known.
        let any = if frame <= self.certified { &self.certificate } else { &self.beyond };
        self.drift_of(&self.beyond, any, frame, aligned)
    }

    /// Returns the same for a galpixel without acceleration.
    #[must_use]
    pub fn steady_drift_px(&self, frame: u32, aligned: bool) -> f64 {
        self.drift_of(&self.steady, &self.steady, frame, aligned)
    }

    fn drift_of(&self, by_frame: &Certificate, any: &Certificate, frame: u32, aligned: bool) -> f64 {
        let Some(index) = frame.checked_sub(1) else { return 0.0 };
        match by_frame.frames.get(index as usize) {
            Some(_) if self.searched && !aligned => any.drift_any_phase_px,
            Some(bound) => bound.drift_px,
            None => f64::INFINITY,
        }
    }

    fn after(&self, frame: u32) -> Option<&FrameBound> {
        self.beyond.frames.get(frame.checked_sub(1)? as usize)
    }
}
