//! What a user chooses of an inpainting.

use super::pyramid::DEPTH_BITS;
use super::validity::Gamma;
use crate::frame::edge;

/// How what was just uncovered is filled after a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Inpainting<'m> {
    /// The power of the validity: how far coarser levels are needed.
    pub gamma: Gamma,
    /// How much nearer than the background foreground is at least, in units of the last of [`Self::DEPTH_BITS`] bits,
    /// or of the depth's last bit where it has fewer; `u32::MAX` makes no difference between them.
    pub threshold: u32,
    /// Whether holes get the depth of the background from stretched quads first.
    pub quads: bool,
    /// Which holes are filled: bit `c mod 32` of word `c / 32` for cell `c`, and none beyond the last word.
    /// Empty for all of them.
    pub mask: &'m [u32],
}

impl Inpainting<'_> {
    /// Bits of a depth that count. Deeper z-buffers drop their lowest bits.
    pub const DEPTH_BITS: u32 = DEPTH_BITS;

    /// Returns an inpainting that separates foreground from background by depths of `depth_bits` bits, as the edge map
    /// does by default, with quads and everywhere.
    #[must_use]
    pub const fn for_depth(depth_bits: u32, gamma: Gamma) -> Self {
        Self::for_edge_threshold(edge::threshold_for_depth(depth_bits), depth_bits, gamma)
    }

    /// Returns an inpainting that separates foreground from background by this threshold of an edge map
    /// ([`Settings::edge_threshold`](crate::Settings::edge_threshold)), for depths of `depth_bits` bits, with quads and
    /// everywhere.
    #[must_use]
    pub const fn for_edge_threshold(threshold: u32, depth_bits: u32, gamma: Gamma) -> Self {
        Self { gamma, threshold: threshold >> depth_bits.saturating_sub(DEPTH_BITS), quads: true, mask: &[] }
    }

    /// Returns the classic push-pull, which knows no depth, everywhere.
    #[must_use]
    pub const fn classic() -> Self {
        Self { gamma: Gamma::Zero, threshold: u32::MAX, quads: false, mask: &[] }
    }
}
