//! Square roots of whole numbers, without a division: bit by bit, in as many steps as the root has bits.

/// Returns the largest whole number whose square is not above `value`.
#[inline(always)]
#[must_use]
pub const fn floor(value: u32) -> u32 {
    split(value).0
}

/// Returns the whole number nearest to the square root; there are no ties.
#[inline(always)]
#[must_use]
pub const fn nearest(value: u32) -> u32 {
    let (root, rest) = split(value);
    // (root + 1/2)^2 = root^2 + root + 1/4.
    root + (rest > root) as u32
}

/// Returns [`nearest`] of some numbers below 2^26, side by side.
#[inline(always)]
#[must_use]
pub fn nearest_of<const COUNT: usize>(values: [u32; COUNT]) -> [u32; COUNT] {
    // Signed numbers, which all vector registers can compare, and masks.
    let (mut roots, mut rests) = ([0i32; COUNT], values.map(|value| value as i32));
    let mut bit = 1 << 24;
    while bit != 0 {
        for (root, rest) in roots.iter_mut().zip(&mut rests) {
            let trial = *root + bit;
            let fits = -((*rest >= trial) as i32);
            *rest -= trial & fits;
            *root = (*root >> 1) + (bit & fits);
        }
        bit >>= 2;
    }
    for (root, rest) in roots.iter_mut().zip(rests) {
        *root += (rest > *root) as i32;
    }
    roots.map(|root| root as u32)
}

/// Returns root and rest: `value = root^2 + rest`, `rest <= 2 root`.
#[inline(always)]
const fn split(value: u32) -> (u32, u32) {
    let (mut root, mut rest) = (0, value);
    let mut bit = 1 << 30;
    // A fixed number of steps: neighbours can be worked out side by side.
    while bit != 0 {
        let trial = root + bit;
        let fits = rest >= trial;
        rest -= if fits { trial } else { 0 };
        root = (root >> 1) + if fits { bit } else { 0 };
        bit >>= 2;
    }
    (root, rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_sixteen_bits_are_the_nearest() {
        let mut root = 0u32;
        for value in 0..=0xffff {
            while (root + 1) * (root + 1) <= value {
                root += 1;
            }
            assert_eq!(floor(value), root);
            assert_eq!(nearest(value), root + u32::from(value - root * root > root));
            assert_eq!(nearest_of([value, value << 10]), [nearest(value), nearest(value << 10)]);
        }
    }

    #[test]
    fn roots_change_at_every_square_of_thirty_two_bits() {
        for root in 1..=0xffffu32 {
            let square = root * root;
            assert_eq!((floor(square - 1), floor(square)), (root - 1, root));
            assert_eq!((nearest(square), nearest(square - root), nearest(square - root + 1)), (root, root - 1, root));
        }
        assert_eq!((floor(u32::MAX), nearest(u32::MAX)), (0xffff, 0x1_0000));
    }
}
