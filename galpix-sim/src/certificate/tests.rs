use super::*;
use galpix_core::record::Component;
use galpix_core::{Bits, Demand, Layout, Record};

fn demand(prop: u32) -> Demand {
    Demand { extent: 1024, recog: 8, prop }
}

fn certificate(prop: u32, rounding: Rounding) -> Certificate {
    let record = Record::plan(Bits::derive(demand(prop)).unwrap(), Layout::FULL).unwrap();
    Certificate::of(&record.scales[0], true, rounding, prop)
}

/// (tau_prop, rounding, quantisation, drift), worked out by hand from the lemma.
#[test]
fn the_papers_widths() {
    use Rounding::{LowDiscrepancy, Nearest, Truncate};
    for (prop, rounding, quantisation, drift) in [
        (8, Truncate, 0.6875, 0.75),
        (8, Nearest, 0.6875, 0.5),
        (8, LowDiscrepancy, 0.6875, 0.25),
        (16, Truncate, 0.59375, 0.875),
        (16, Nearest, 0.59375, 0.5),
        (16, LowDiscrepancy, 0.59375, 0.25),
        (32, Truncate, 0.546875, 0.9375),
        (32, Nearest, 0.546875, 0.5),
        (32, LowDiscrepancy, 0.546875, 0.25),
    ] {
        let certificate = certificate(prop, rounding);
        assert_eq!((certificate.quantisation_px, certificate.drift_px), (quantisation, drift), "{prop} {rounding:?}");
        assert_eq!(certificate.total_px, quantisation + drift);
        assert_eq!(certificate.keeps_one_pixel(), rounding == LowDiscrepancy, "{prop} {rounding:?}");
        assert_eq!(certificate.method, Method::Enumerated);
    }
}

#[test]
fn all_pairs_of_the_papers_example_are_128_classes() {
    let certificate = certificate(16, Rounding::LowDiscrepancy);
    assert_eq!((certificate.classes, certificate.phases), (128, 16));
}

#[test]
fn searched_tables_beat_the_counter_read_backwards_where_updates_enter_at_their_first_entry() {
    for (prop, drift, any_phase) in [
        (4, 2.0 / 16.0, 2.0 / 16.0),
        (8, 8.0 / 64.0, 10.0 / 64.0),
        (16, 23.0 / 256.0, 40.0 / 256.0),
        (32, 77.0 / 1024.0, 129.0 / 1024.0),
        (64, 257.0 / 4096.0, 443.0 / 4096.0),
    ] {
        let certificate = certificate(prop, Rounding::Searched);
        assert_eq!((certificate.drift_px, certificate.drift_any_phase_px), (drift, any_phase), "{prop}");
    }
}

/// With low-discrepancy rounding the paper's widths are the smallest that keep its promise; the others need a bit more.
#[test]
fn the_smallest_budget_for_one_pixel() {
    for prop in [8, 16, 32] {
        let paper = Component::derive(demand(prop)).unwrap();
        let bits = |rounding| smallest(paper, rounding, prop, 1.0).unwrap().0.motion_bits();
        assert_eq!(bits(Rounding::LowDiscrepancy), paper.motion_bits(), "{prop}");
        assert_eq!(bits(Rounding::Nearest), paper.motion_bits() + 1, "{prop}");
        assert_eq!(bits(Rounding::Truncate), paper.motion_bits() + 1, "{prop}");
    }
}

#[test]
fn the_smallest_budget_keeps_the_error_and_none_smaller_does() {
    let ranges = Component::derive(demand(16)).unwrap();
    for asked in [2.0, 0.5, 0.1, 0.03] {
        let (component, certificate) = smallest(ranges, Rounding::LowDiscrepancy, 16, asked).unwrap();
        assert!(certificate.total_px <= asked);
        for (position, velocity, acceleration) in [(1, 0, 0), (0, 1, 1), (0, 0, 1)] {
            let shaved = component.shaved(galpix_core::record::Shave {
                position_frac: position,
                velocity_frac: velocity,
                acceleration_frac: acceleration,
                ..Default::default()
            });
            let Ok(shaved) = shaved else { continue };
            let scale = Scale::new(shaved, shaved.position_frac);
            assert!(Certificate::of(&scale, true, Rounding::LowDiscrepancy, 16).total_px > asked, "{asked} {shaved:?}");
        }
    }
}

#[test]
fn without_acceleration_nothing_drifts_and_fewer_bits_do() {
    let ranges = Component::derive_without_acceleration(demand(16)).unwrap();
    let (component, certificate) = smallest(ranges, Rounding::Truncate, 16, 1.0).unwrap();
    assert!(component.motion_bits() < ranges.motion_bits() + 4 && certificate.total_px <= 1.0);
    assert!(!component.has_acceleration());
}

#[test]
fn an_error_that_no_budget_reaches_is_refused_with_what_is_reached() {
    let ranges = Component::derive(demand(16)).unwrap();
    let refused = smallest(ranges, Rounding::LowDiscrepancy, 16, 1e-9).unwrap_err();
    assert!(refused.best > 1e-9 && refused.best < 0.01, "{refused}");
}

/// Two states of one residue class drift alike: the lemma, on the kernel itself.
#[test]
fn states_of_one_class_drift_alike() {
    use galpix_core::stages::{step_position, step_velocity};
    let record = Record::plan(Bits::derive(demand(16)).unwrap(), Layout::FULL).unwrap();
    let scale = record.scales[0];
    let drifts = |v: i32, a: i32, rounding: Rounding| -> Vec<i64> {
        let (mut r, mut velocity, mut exact) = (0, v, 0i64);
        let frames = (0..16).map(|n| {
            exact += i64::from(2 * velocity + a);
            r = step_position(&scale, rounding.threshold(n, scale.down), r, velocity, a);
            velocity = step_velocity(&scale, velocity, a);
            (i64::from(r) << scale.down) - exact
        });
        frames.collect()
    };
    for rounding in Rounding::ALL {
        for v in 0..8 {
            for a in 0..16 {
                let class = drifts(v, a, rounding);
                for (dv, da) in [(8, 0), (0, 16), (-8, -16), (8 * 731, -16 * 97)] {
                    assert_eq!(drifts(v + dv, a + da, rounding), class, "{rounding:?} {v} {a}");
                }
            }
        }
    }
}

/// Every offset of up to eight fraction bits, as stationary sources show it.
#[test]
fn what_is_shown_is_off_by_at_most_as_much_as_stated() {
    use crate::engine::ScanOut;
    use galpix_core::fixed::types::I32F32;
    use galpix_core::source::{Source, Sources, Visibility, link_words};
    use galpix_core::{Dynamic, Galpixel, Galpixmap, Grid, Margin, Settings};

    for position_frac in 0..=8 {
        let plane = Bits::derive(demand(16)).unwrap();
        let component = Component { position_frac, ..plane.x };
        let format = Dynamic::new(plane.with_xy(component, component), Layout::FULL).unwrap();
        let mut starts = [0; 1];
        let grid = Grid::new(5, 1, Margin::NONE, &mut starts).unwrap();
        let mut worst = [0.0f64; 2];
        for offset in -(1i64 << position_frac >> 1)..=((1i64 << position_frac) - 1) >> 1 {
            let mut words = vec![0; Galpixmap::words(&grid, format)];
            let mut map = Galpixmap::new(grid, format, &mut words).unwrap();
            let offset = I32F32::from_bits(offset << (32 - position_frac));
            map.store(2, 0, &Galpixel { offset: [offset, I32F32::ZERO], ..Galpixel::default() });
            let (mut displacements, mut links) = (vec![0; 5], vec![0; link_words(&grid)]);
            let mut layers = [Source::new(map, &mut displacements, &mut links).unwrap()];
            layers[0].begin(0);
            let (mut keys, mut words, mut line) = (vec![0; 5], vec![0; 5], vec![0; Visibility::line_half_words(&grid)]);
            let visibility = Visibility::new(&grid, &mut keys, &mut words, &mut line).unwrap();
            let mut sources = Sources::new(&mut layers, visibility).unwrap();
            sources.show(&Settings::for_depth(16));
            let (_, word) = sources.entry(2).expect("the sample is seen in its cell");
            let residual = (word << 22) as i32 >> 27;
            let offset = offset.to_num::<f64>();
            worst[0] = worst[0].max(offset.abs());
            worst[1] = worst[1].max((offset + f64::from(residual) / 16.0).abs());
        }
        let stated = [ScanOut::Nearest, ScanOut::SubCell].map(|scan_out| shown_off_px(scan_out, position_frac));
        assert_eq!(worst, stated, "{position_frac} fraction bits");
    }
}
