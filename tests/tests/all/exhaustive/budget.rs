//! Equations (8) to (14) against logarithms in floating point, and budgets that cannot exist.

use galpix_core::record::{Component, Shave, WIDEST_FIELD};
use galpix_core::{Bits, BudgetError, Colour, Demand, Layout, Record};

/// Returns `log2` of a ratio, rounded up. Exact for powers of two; elsewhere far enough from whole numbers for these
/// sizes.
fn log2_up(numerator: f64, denominator: f64) -> i64 {
    (numerator / denominator).log2().ceil() as i64
}

/// The widths by the paper's equations: position, velocity int and frac, acceleration int and frac.
fn by_the_equations(Demand { extent, recog, prop }: Demand) -> [i64; 5] {
    let [extent, recog, prop] = [extent, recog, prop].map(f64::from);
    let velocity_int = log2_up(extent, recog) + 3; // (8): 4 D / tau_recog, and the sign
    let acceleration_int = log2_up(extent, recog * recog) + 4; // (9): 8 D / tau_recog^2, and the sign
    let position_frac = log2_up(prop, 1.0); // (11)
    let acceleration_frac = log2_up(prop * prop, 2.0); // (12): half of it, over tau_prop^2 / 2 frames, is half a pixel
    [position_frac, velocity_int, acceleration_frac, acceleration_int, acceleration_frac] // (13): v as fine as a
}

fn widths(component: Component) -> [i64; 5] {
    let Component { position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac } = component;
    [position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac].map(i64::from)
}

/// Powers of two, their neighbours, and numbers between.
fn numbers(most: u32) -> Vec<u32> {
    let powers = (0..).map(|n| 1 << n).take_while(|&n| n <= most);
    let mut numbers: Vec<u32> = powers.flat_map(|n: u32| [n - 1, n, n + 1, n + n / 2, n + n / 3]).collect();
    numbers.retain(|&n| n > 0 && n <= most);
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

fn demands() -> impl Iterator<Item = Demand> {
    numbers(1 << 15).into_iter().flat_map(|extent| {
        numbers(1 << 7)
            .into_iter()
            .flat_map(move |recog| numbers(1 << 14).into_iter().map(move |prop| Demand { extent, recog, prop }))
    })
}

#[test]
fn widths_and_refusals_follow_the_equations() {
    let (mut made, mut refused) = (0, [0; 5]);
    for demand in demands() {
        let expected = by_the_equations(demand);
        let [position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac] = expected;
        let lift = (position_frac - velocity_frac - 1).max(0);
        let widest = (velocity_int + velocity_frac).max(acceleration_int + acceleration_frac) + lift;
        let expected = if demand.prop == 1 {
            refused[0] += 1;
            Err(BudgetError::PropagationTooShort)
        } else if velocity_int < 1 {
            refused[1] += 1;
            Err(BudgetError::VelocityVanishes { integer_bits: velocity_int as i32 })
        } else if acceleration_int < 1 {
            refused[2] += 1;
            Err(BudgetError::AccelerationVanishes { integer_bits: acceleration_int as i32 })
        } else if widest > i64::from(WIDEST_FIELD) {
            refused[3] += 1;
            Err(BudgetError::FieldTooWide { bits: widest as u32, most: WIDEST_FIELD })
        } else if position_frac > 16 {
            refused[4] += 1;
            Err(BudgetError::FieldTooWide { bits: position_frac as u32, most: 16 })
        } else {
            made += 1;
            Ok(expected)
        };
        assert_eq!(Component::derive(demand).map(widths), expected, "{demand:?}");
    }
    assert!(made > 10_000 && refused[..4].iter().all(|&n| n > 100), "{made} made, {refused:?} refused");
}

#[test]
fn the_total_is_equation_14_for_powers_of_two() {
    for (log_extent, log_recog, log_prop) in
        (1..=14).flat_map(|d| (0..=6).flat_map(move |r| (1..=10).map(move |p| (d, r, p))))
    {
        let demand = Demand { extent: 1 << log_extent, recog: 1 << log_recog, prop: 1 << log_prop };
        if let Ok(component) = Component::derive(demand) {
            let total = 2 * log_extent - 3 * log_recog + 5 * log_prop + 5;
            assert_eq!(component.motion_bits() as i32, total, "{demand:?}");
        }
    }
}

#[test]
fn without_acceleration_the_largest_speed_is_the_extent_over_tau_recog() {
    for demand in demands().filter(|demand| demand.prop > 1) {
        let velocity_int = log2_up(demand.extent.into(), demand.recog.into()) + 1;
        let frac = log2_up(demand.prop.into(), 1.0);
        match Component::derive_without_acceleration(demand) {
            Ok(component) => assert_eq!(widths(component), [frac, velocity_int, frac, 0, 0], "{demand:?}"),
            Err(BudgetError::VelocityVanishes { integer_bits }) => {
                assert!(velocity_int < 1 && i64::from(integer_bits) == velocity_int, "{demand:?}");
            }
            Err(error) => assert!(velocity_int + frac > 30, "{demand:?}: {error}"),
        }
    }
}

#[test]
fn zeros_are_refused() {
    for (extent, recog, prop) in [(0, 8, 16), (1024, 0, 16), (1024, 8, 0), (0, 0, 0), (0, 8, 1)] {
        let demand = Demand { extent, recog, prop };
        assert_eq!(Bits::derive(demand), Err(BudgetError::Zero));
        assert_eq!(Bits::derive_without_acceleration(demand), Err(BudgetError::Zero));
    }
}

#[test]
fn the_largest_numbers_are_refused_and_do_not_overflow() {
    for (extent, recog, prop) in [u32::MAX, 1]
        .into_iter()
        .flat_map(|d| [u32::MAX, 1].into_iter().flat_map(move |r| [(d, r, u32::MAX), (d, r, 2)]))
    {
        let demand = Demand { extent, recog, prop };
        let expected = by_the_equations(demand);
        match Component::derive(demand) {
            Ok(component) => assert_eq!(widths(component), expected),
            Err(error) => assert!(expected[1] < 1 || expected[3] < 1 || expected[1] + expected[2] > 30, "{error}"),
        }
        let _ = Component::derive_without_acceleration(demand);
    }
}

#[test]
fn the_number_of_cells_is_rounded_up_to_bits() {
    for extent in numbers(1 << 15) {
        let bits = Demand { extent, recog: 1, prop: 2 }.extent_bits();
        assert_eq!(i64::from(bits), log2_up(extent.into(), 1.0), "{extent}");
    }
}

#[test]
fn shaving_takes_bits_off_and_stops_before_a_field_vanishes() {
    let whole = Component::derive(Demand { extent: 1024, recog: 8, prop: 16 }).unwrap();
    let least = [0, 1, 0, 1, 0];
    for field in 0..5 {
        for bits in 0..=12u32 {
            let mut shaved = [0; 5];
            shaved[field] = bits;
            let [position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac] = shaved;
            let shave = Shave { position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac };
            let mut expected = widths(whole);
            expected[field] -= i64::from(bits);
            let expected = if expected[field] < least[field] {
                Err(BudgetError::ShavedAway)
            } else if expected[2] < expected[4] {
                let (velocity, acceleration) = (expected[2] as u32, expected[4] as u32);
                Err(BudgetError::VelocityCoarserThanAcceleration { velocity, acceleration })
            } else {
                Ok(expected)
            };
            assert_eq!(whole.shaved(shave).map(widths), expected, "field {field}, {bits} bits");
        }
    }
}

#[test]
fn layouts_that_do_not_fit_are_refused() {
    let bits = Bits::derive(Demand { extent: 1024, recog: 8, prop: 16 }).unwrap();
    let slide = Bits::derive_without_acceleration(Demand { extent: 1024, recog: 8, prop: 16 }).unwrap();
    let still = Layout::STILL;
    for (bits, layout, expected) in [
        (bits, Layout { acceleration: true, ..still }, BudgetError::FieldWithoutItsBase),
        (bits, Layout { depth_motion: true, velocity: true, ..still }, BudgetError::FieldWithoutItsBase),
        (bits, Layout { depth_motion: true, depth_bits: 16, ..still }, BudgetError::FieldWithoutItsBase),
        (bits, Layout { depth_bits: 5, ..Layout::FULL }, BudgetError::DepthTooCoarse { bits: 9, needed: 10 }),
        (bits, Layout { depth_bits: 25, ..Layout::FULL }, BudgetError::FieldTooWide { bits: 29, most: 28 }),
        (bits, Layout { tag_bits: 33, ..Layout::FULL }, BudgetError::FieldTooWide { bits: 33, most: 32 }),
        (slide, Layout::FULL, BudgetError::AccelerationVanishes { integer_bits: 0 }),
        (
            Bits::derive(Demand { extent: 1 << 14, recog: 2, prop: 32 }).unwrap(),
            Layout { depth_bits: 20, tag_bits: 32, ..Layout::SHADED },
            // 2 class, 25 depth, 2 x 5 offset, 3 x (25 + 25) motion, 24 colour, 32 tag, 8 + 5 + 5 luminosity
            BudgetError::RecordTooLong { bits: 261, most: 256 },
        ),
    ] {
        assert_eq!(Record::plan(bits, layout), Err(expected), "{layout:?}");
    }
    for bits in [0, 9, 33] {
        let expected = Err(BudgetError::ChannelBits { bits });
        assert_eq!(Colour::gray(bits), expected);
        assert_eq!([Colour::rgb(bits, 8, 8), Colour::rgb(8, bits, 8), Colour::rgb(8, 8, bits)], [expected; 3]);
    }
}

#[test]
fn components_that_the_arithmetic_cannot_carry_are_refused() {
    let base = Component::derive(Demand { extent: 1024, recog: 8, prop: 16 }).unwrap();
    let too_wide = Component { velocity_int: 24, ..base };
    assert_eq!(too_wide.checked(), Err(BudgetError::FieldTooWide { bits: 31, most: WIDEST_FIELD }));
    let too_fine = Component { position_frac: 17, velocity_frac: 16, acceleration_frac: 16, ..base };
    assert_eq!(too_fine.checked(), Err(BudgetError::FieldTooWide { bits: 17, most: 16 }));
    // 30 bits, but in the position's unit, two bits finer than the step, they would be 32.
    let lifted = Component { position_frac: 10, velocity_int: 23, velocity_frac: 7, ..base };
    assert_eq!(lifted.checked(), Err(BudgetError::FieldTooWide { bits: 32, most: WIDEST_FIELD }));
}

/// A component that was written by hand and not checked is refused when a record is planned with it.
#[test]
fn unchecked_components_are_refused_by_the_record() {
    let bits = Bits::derive(Demand { extent: 1024, recog: 8, prop: 16 }).unwrap();
    let too_fine = Component { position_frac: 20, ..bits.x };
    let too_wide = Component { velocity_int: 25, ..bits.x };
    for wrong in [too_fine, too_wide] {
        let expected = wrong.checked().map(|_| ()).unwrap_err();
        let plan = |bits: Bits| Record::plan(bits, Layout::FULL).map(|_| ());
        assert_eq!(plan(bits.with_xy(wrong, bits.y)), Err(expected));
        assert_eq!(plan(bits.with_xy(bits.x, wrong)), Err(expected));
        assert_eq!(plan(bits.with_z(wrong, bits.depth_int)), Err(expected));
    }
}
