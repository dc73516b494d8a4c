//! Sintel `.dpt`: the layout of `.flo` with one 32-bit float per pixel, the planar depth in metres.

use super::error::CaptureError;
use super::source::{Bands, Source};

/// Reads a `.dpt` file: one band.
pub(super) fn read(source: &Source) -> Result<Bands, CaptureError> {
    super::flo::read_tagged(source, 1)
}
