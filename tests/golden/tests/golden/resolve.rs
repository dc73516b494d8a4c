//! The order of candidates, the Laplacian and thresholds for it.

use galpix_core::Class;
use galpix_core::stages::{Candidate, laplacian, nearer, threshold_for_depth, threshold_for_speed};

/// Bits of the depth in the small candidates.
const DEPTH_BITS: u32 = 2;

fn candidates() -> Vec<Candidate> {
    let keys = (0..3).flat_map(|class| (0..1 << DEPTH_BITS).map(move |depth| class << DEPTH_BITS | depth));
    keys.flat_map(|key| (0..4).map(move |source| Candidate { key, source })).collect()
}

#[test]
fn nearer_is_a_strict_total_order() {
    let candidates = candidates();
    for &a in &candidates {
        assert!(!nearer(a, a), "irreflexive: {a:?}");
        for &b in &candidates {
            assert!(a == b || nearer(a, b) != nearer(b, a), "exactly one wins: {a:?} {b:?}");
            for &c in &candidates {
                assert!(!(nearer(a, b) && nearer(b, c)) || nearer(a, c), "transitive: {a:?} {b:?} {c:?}");
            }
        }
    }
}

/// Fully-fledged before debris, then the nearer, then the smaller source.
#[test]
fn nearer_decides_by_class_then_depth_then_source() {
    for a in candidates() {
        for b in candidates() {
            let rank = |candidate: Candidate| {
                let class = Class::from_bits(candidate.key >> DEPTH_BITS);
                let class = [Class::Galpixel, Class::JustUnobscured, Class::Debris].iter().position(|&c| c == class);
                (class.unwrap(), candidate.key & ((1 << DEPTH_BITS) - 1), candidate.source)
            };
            assert_eq!(nearer(a, b), rank(a) < rank(b), "{a:?} {b:?}");
        }
    }
}

#[test]
fn classes_are_their_own_numbers() {
    for bits in 0..=3 {
        assert_eq!(Class::from_bits(bits) as u32, bits);
        assert_eq!(Class::from_bits(bits | 0xffff_fffc), Class::from_bits(bits), "only the low two bits count");
    }
}

/// Equation (17), with the terms in the paper's order.
#[test]
fn laplacian_is_equation_17() {
    let depths = || 0..=9i32;
    for z in depths() {
        for right in depths() {
            for left in depths() {
                for down in depths() {
                    for up in depths() {
                        assert_eq!(laplacian(z, left, right, up, down), right + left + down + up - 4 * z);
                    }
                }
            }
        }
    }
}

#[test]
fn laplacian_of_any_plane_vanishes() {
    for (dx, dy, z) in (-9..=9).flat_map(|dx| (-9..=9).map(move |dy| (dx, dy, 500))) {
        assert_eq!(laplacian(z, z - dx, z + dx, z - dy, z + dy), 0);
    }
}

#[test]
fn thresholds_are_parts_of_the_range_and_never_nothing() {
    for bits in 0..=28 {
        let range = f64::from(1u32 << bits);
        assert_eq!(f64::from(threshold_for_depth(bits)), (range / 64.0).max(1.0), "{bits} bits");
        assert_eq!(f64::from(threshold_for_speed(bits)), (range / 128.0).max(1.0), "{bits} bits");
    }
}
