//! The measures that every table and every page has of a run, in one form.

use schemars::JsonSchema;
use serde::Serialize;

use super::stats;

/// How far a frame is from the truth, or the frames of a run: means over those whose truth is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct Measures {
    /// PSNR of the whole picture, decibels.
    pub psnr_db: Option<f64>,
    /// PSNR inside, decibels: without the cells that are missing in connection with the border. The same cells for all
    /// schemes and fills.
    pub psnr_inside_db: Option<f64>,
    /// Mean of |change shown - true change| of luma from the frame before, inside, in code values: the temporal error.
    pub change_error: Option<f64>,
    /// Root mean square change, from the frame before, of the displacement of blocks against the truth, in pixels.
    pub judder_px: Option<f64>,
    /// Cells that no galpixel of the update reached, per cent of those that the truth counts.
    pub missing_percent: Option<f64>,
}

impl Measures {
    /// Returns the mean of each measure over the frames that have it.
    #[must_use]
    pub fn mean(frames: impl IntoIterator<Item = Self>) -> Self {
        let frames: Vec<Self> = frames.into_iter().collect();
        let mean = |of: fn(&Self) -> Option<f64>| stats::mean(frames.iter().filter_map(of));
        Self {
            psnr_db: mean(|frame| frame.psnr_db),
            psnr_inside_db: mean(|frame| frame.psnr_inside_db),
            change_error: mean(|frame| frame.change_error),
            judder_px: mean(|frame| frame.judder_px),
            missing_percent: mean(|frame| frame.missing_percent),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_is_over_the_frames_that_have_the_measure() {
        let frame =
            |inside: f64, judder_px| Measures { psnr_inside_db: Some(inside), judder_px, ..Measures::default() };
        let mean = Measures::mean([frame(20.0, None), frame(30.0, Some(0.5)), frame(40.0, Some(0.1))]);
        assert_eq!((mean.psnr_inside_db, mean.judder_px, mean.psnr_db), (Some(30.0), Some(0.3), None));
        assert_eq!(Measures::mean([]), Measures::default());
    }
}
