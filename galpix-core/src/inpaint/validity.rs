//! How much of what lies under a cell of a coarse level is known.
//!
//! Equal parts of a whole are counted: a cell of the picture is known or not, [`FULL`] or 0; a coarser one has the mean
//! of the four below it, raised to gamma (section 3.3.1 of the paper) and rounded to sixteenths. Sixteen steps are
//! enough to keep a small hole from mattering far up: a cell 31/32 of which are known counts as known, and nothing
//! above it need be looked at.

/// The validity of a cell that is known.
pub const FULL: u32 = 16;

/// The power to which the validity is raised at each level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Gamma {
    /// 0: a cell is known if anything below it is. The classic push-pull: sharp, and quick, for it seldom goes far up.
    #[default]
    Zero,
    /// 1/2: the paper's compromise.
    Half,
    /// 1: smooth in space and steady in time.
    One,
}

/// Twice the square root of each sum of four validities below the largest, to the nearest.
const ROOTS: [u8; 64] = {
    let mut roots = [0; 64];
    let mut sum = 0;
    while sum < roots.len() {
        let mut root = 0;
        // (root + 1/2)^2 <= 4 sum: the next root is nearer.
        while (2 * root + 1) * (2 * root + 1) <= 16 * sum {
            root += 1;
        }
        roots[sum] = root as u8;
        sum += 1;
    }
    roots
};

impl Gamma {
    /// All powers.
    pub const ALL: [Self; 3] = [Self::Zero, Self::Half, Self::One];

    /// Returns the name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Zero => "0",
            Self::Half => "1/2",
            Self::One => "1",
        }
    }

    /// Raises the mean of four validities to gamma, from their sum (0 to 64): 0 for 0, else 1 to [`FULL`]. To the
    /// nearest sixteenth, halves upwards, but never so far down that what is known is forgotten.
    #[inline(always)]
    #[must_use]
    pub(super) const fn raised(self, sum: u32) -> u32 {
        let raised = match self {
            _ if sum == 0 => return 0,
            Self::Zero => FULL,
            Self::Half => {
                if sum < 4 * FULL {
                    ROOTS[(sum & 63) as usize] as u32
                } else {
                    FULL
                }
            }
            Self::One => (sum + 2) >> 2,
        };
        if raised == 0 { 1 } else { raised }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_the_nearest_sixteenths() {
        for sum in 0..=4 * FULL {
            let mean = f64::from(sum) / 64.0;
            for (gamma, power) in [(Gamma::Half, mean.sqrt()), (Gamma::One, mean)] {
                let nearest = ((power * 16.0 + 0.5).floor() as u32).max(u32::from(sum > 0));
                assert_eq!(gamma.raised(sum), nearest, "{gamma:?} {sum}");
            }
            assert_eq!(Gamma::Zero.raised(sum), if sum > 0 { FULL } else { 0 });
        }
    }
}
