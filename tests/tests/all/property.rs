//! What holds for any map: nothing is lost in silence, nothing wraps, counts add up.

use fixed::types::I32F32;
use galpix_core::stages::FILLED;
use galpix_core::{Class, Controller, Dynamic, FillMode, Format, Galpixel, Layout, Rounding, Settings, Tally};
use galpix_tests::memory::{Mode, Run, Shape, Trace, with_controller, words};
use galpix_tests::profiles::{PAPER, dynamic, formats};
use galpix_tests::{packed, random};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(1993), ..ProptestConfig::default() }
}

fn shapes() -> impl Strategy<Value = Shape> {
    let beyond = || prop_oneof![3 => Just(0u32), 1 => 0..9u32];
    let margin = [beyond(), beyond(), beyond(), beyond()];
    (1..=40u32, 1..=14u32, margin).prop_map(|(width, height, margin)| Shape::new(width, height, margin))
}

fn any_settings() -> impl Strategy<Value = Settings> {
    let fill_mode = prop::sample::select(&FillMode::ALL[..]);
    let rounding = prop::sample::select(&Rounding::ALL[..]);
    let threshold = prop_oneof![Just(0u32), Just(u32::MAX), 0..1u32 << 20];
    (fill_mode, rounding, threshold, 0..20u32).prop_map(|(fill_mode, rounding, edge_threshold, reach)| Settings {
        rounding,
        fill_mode,
        edge_threshold,
        reach,
    })
}

fn modes() -> impl Strategy<Value = Mode> {
    prop::sample::select(&Mode::ALL[..])
}

/// Returns random words, or words with few empty cells and slow motion, so that much happens on the map.
fn content(format: Dynamic, shape: Shape, seed: u64) -> Vec<u32> {
    let record = format.record();
    let cells = shape.cells() as usize;
    let mut content = random::words(seed, cells * record.words());
    if seed.is_multiple_of(3) {
        return content;
    }
    let mut generator = random::generator(!seed);
    for cell in 0..cells {
        let mut words: Vec<u32> = (0..record.words()).map(|word| content[word * cells + cell]).collect();
        let class = if random::below(&mut generator, 10) == 0 { 3 } else { random::below(&mut generator, 20) / 18 * 2 };
        packed::set(record.class(), &mut words, class.into());
        for component in 0..2 {
            let field = record.velocity(component);
            let slow = packed::signed(field, &words) >> (u32::from(field.bits) / 3);
            packed::set(field, &mut words, slow);
        }
        for (word, value) in words.into_iter().enumerate() {
            content[word * cells + cell] = value;
        }
    }
    content
}

/// What must hold after any frame.
fn check_frame(controller: &Controller<'_, Dynamic>, before: &[Class], tally: Tally, settings: &Settings) {
    let front = controller.front();
    let cells = front.grid().cells();
    let classes: Vec<Class> = (0..cells).map(|cell| front.class(cell)).collect();
    let count = |wanted: Class| classes.iter().filter(|&&class| class == wanted).count() as u32;
    let winners = controller.winners();
    let resolved = winners.iter().filter(|&&winner| winner < FILLED).count() as u32;

    assert_eq!(tally.moved, before.iter().filter(|&&class| class != Class::Empty).count() as u32, "{settings:?}");
    assert_eq!(tally.moved, resolved + tally.lost + tally.collided, "{settings:?} {tally:?}");
    assert_eq!(cells, resolved + tally.holes, "{settings:?} {tally:?}");
    assert_eq!(tally.holes, tally.bullets + tally.debris + tally.galdebris + tally.empty, "{settings:?} {tally:?}");
    assert_eq!(tally.filled() + tally.empty, tally.holes);
    assert_eq!(count(Class::Empty), tally.empty, "{settings:?} {tally:?}");

    let surfaces = settings.fill_mode.uses_edges();
    for (&winner, &class) in winners.iter().zip(&classes) {
        match class {
            // Who won was there, and kept its class; what was just unobscured has become debris.
            _ if winner < cells => {
                let was = before[winner as usize];
                let expected = if was == Class::JustUnobscured { Class::Debris } else { was };
                assert_eq!(class, expected, "{settings:?}");
                assert_ne!(class, Class::Empty, "{settings:?}");
            }
            Class::Galpixel => panic!("{settings:?}: what was filled is a galpixel, {winner:x}"),
            Class::JustUnobscured => assert!(surfaces && winner == u32::MAX, "{settings:?} {winner:x}"),
            Class::Debris if surfaces => assert!((FILLED..FILLED + 16).contains(&winner), "{settings:?} {winner:x}"),
            Class::Debris => {
                assert!(settings.fill_mode == FillMode::Debris && winner == u32::MAX, "{settings:?} {winner:x}")
            }
            Class::Empty => assert_eq!(winner, u32::MAX, "{settings:?}"),
        }
    }
    let allowed = match settings.fill_mode {
        FillMode::None | FillMode::Hold => [tally.bullets, tally.debris, tally.galdebris].iter().sum::<u32>(),
        FillMode::Debris => tally.bullets + tally.galdebris,
        FillMode::Bullet => tally.galdebris,
        FillMode::Galdebris | FillMode::Extend => tally.debris,
    };
    assert_eq!(allowed, 0, "{settings:?} fills only by its own means: {tally:?}");
    assert!(tally.edges <= cells && (surfaces || tally.edges == 0));
    assert!(tally.saturated <= 6 * cells);
}

fn any_content(format: Dynamic, shape: Shape, settings: &Settings, mode: Mode, seed: u64) {
    let content = content(format, shape, seed);
    let run = || {
        with_controller(shape, format, Some(&content), |controller| {
            let mut traces = Vec::new();
            for _ in 0..4 {
                let before: Vec<Class> = (0..shape.cells()).map(|cell| controller.front().class(cell)).collect();
                let tally = mode.step(controller, settings);
                check_frame(controller, &before, tally, settings);
                traces.push(Trace::of(controller, tally));
            }
            traces
        })
    };
    assert!(run() == run(), "two identical runs differ");
}

proptest! {
    #![proptest_config(config(128))]

    #[test]
    fn any_content_of_memory_is_a_map(shape in shapes(), settings in any_settings(), mode in modes(), seed: u64) {
        for (_, format) in formats() {
            any_content(format, shape, &settings, mode, seed);
        }
    }

    /// The galpixels of all frames are the same bits, whatever is filled and how: what was filled takes nothing away.
    #[test]
    fn what_is_filled_changes_no_galpixel(shape in shapes(), settings in any_settings(), mode in modes(), seed: u64) {
        for (_, format) in formats() {
            let content = content(format, shape, seed);
            let run = |fill_mode| {
                with_controller(shape, format, Some(&content), |controller| {
                    let mut frames = Vec::new();
                    for _ in 0..6 {
                        mode.step(controller, &Settings { fill_mode, ..settings });
                        let (front, words) = (controller.front(), words(controller.front()));
                        let cells = shape.cells() as usize;
                        let galpixels = (0..cells).filter(|&cell| front.class(cell as u32) == Class::Galpixel);
                        let whole = |cell: usize| words.iter().skip(cell).step_by(cells).copied().collect::<Vec<_>>();
                        frames.push(galpixels.map(|cell| (cell, whole(cell))).collect::<Vec<_>>());
                    }
                    frames
                })
            };
            let alone = run(FillMode::None);
            for fill_mode in FillMode::ALL {
                prop_assert!(run(fill_mode) == alone, "{:?}", fill_mode);
            }
        }
    }

    /// The frame counter wraps: the frames around 2^32 are those of the same phase anywhere else.
    #[test]
    fn the_frame_counter_may_wrap(shape in shapes(), settings in any_settings(), mode in modes(), seed: u64) {
        let format = dynamic(Layout::FULL, PAPER);
        let content = content(format, shape, seed);
        let run = |first: u32| Run { first, ..Run::new(settings, 6).by(mode) }.traces(shape, format, &content).pop().unwrap();
        // The threshold has a period of 16 frames.
        prop_assert!(run(u32::MAX - 2) == run(13));
    }

    #[test]
    fn a_picture_without_motion_stays_as_it_is(shape in shapes(), settings in any_settings(), mode in modes(), seed: u64) {
        let format = dynamic(Layout::FULL, PAPER);
        with_controller(shape, format, None, |controller| {
            let mut generator = random::generator(seed);
            for (x, y) in (0..shape.rows() as i32).flat_map(|y| (0..shape.columns() as i32).map(move |x| (x, y))) {
                let mut byte = || random::below(&mut generator, 256);
                let galpixel = Galpixel {
                    colour: [byte() as u8, byte() as u8, byte() as u8],
                    offset: [0, 0].map(|_| I32F32::from_bits((i64::from(byte()) - 128) << 24)),
                    depth: I32F32::from_bits(i64::from(byte()) << 24),
                    ..Galpixel::default()
                };
                assert_eq!(controller.front_mut().store(x, y, &galpixel), Some(0));
            }
            let before = words(controller.front());
            for _ in 0..20 {
                let tally = mode.step(controller, &settings);
                prop_assert_eq!(tally, Tally { moved: shape.cells(), edges: tally.edges, ..Tally::default() });
                prop_assert!(words(controller.front()) == before);
            }
            Ok(())
        })?;
    }

    /// One galpixel in each row, with any motion: as long as it is in view it is there.
    #[test]
    fn what_stays_in_view_and_meets_nobody_is_never_lost(
        starts in prop::collection::vec((0..64i32, -4096..4096i64, -96..96i64), 12),
        settings in any_settings(), mode in modes(),
    ) {
        let settings = Settings { fill_mode: FillMode::None, ..settings };
        let format = dynamic(Layout::FULL, PAPER);
        with_controller(Shape::plain(64, 12), format, None, |controller| {
            for (y, &(x, v, a)) in (0..).zip(&starts) {
                let unit = |raw: i64| I32F32::from_bits(raw << 25);
                let velocity = [unit(v / 8), I32F32::ZERO, I32F32::ZERO];
                let acceleration = [unit(a / 8), I32F32::ZERO, I32F32::ZERO];
                controller.front_mut().store(x, y, &Galpixel { velocity, acceleration, ..Galpixel::default() });
            }
            let mut alive: Vec<bool> = vec![true; starts.len()];
            for n in 1..=16 {
                let tally = mode.step(controller, &settings);
                for (y, &(x, v, a)) in (0..).zip(&starts) {
                    let n = f64::from(n);
                    let place = f64::from(x) + ((v / 8) as f64 * n + (a / 8) as f64 * n * n / 2.0) / 128.0;
                    let there = (0..64).any(|x| controller.front().load(x, y).unwrap().class == Class::Galpixel);
                    // Rounding drifts by less than a cell, and snapping by half of one.
                    let (inside, outside) = ((1.5..=61.5).contains(&place), !(-2.0..=65.0).contains(&place));
                    let was = &mut alive[y as usize];
                    prop_assert!(!(*was && inside) || there, "row {y}, frame {n}: at {place} and not there");
                    prop_assert!(!(outside && there), "row {y}, frame {n}: at {place} and still there");
                    *was &= there;
                }
                prop_assert_eq!(alive.iter().filter(|&&alive| alive).count() as u32, tally.moved - tally.lost);
            }
            Ok(())
        })?;
    }

    /// Extreme motion saturates: what moves to the right and is pushed to the right never turns round.
    #[test]
    fn nothing_wraps(seed: u64, settings in any_settings(), mode in modes()) {
        let format = dynamic(Layout::FULL, PAPER);
        let (record, shape) = (format.record(), Shape::plain(31, 7));
        let content = content(format, shape, seed / 3 * 3);
        with_controller(shape, format, Some(&content), |controller| {
            let state = |controller: &Controller<'_, Dynamic>, cell: u32| {
                let words: Vec<u32> = (0..record.words()).map(|w| controller.front().plane(w).unwrap()[cell as usize]).collect();
                let of = |field| packed::signed(field, &words);
                [0, 1, 2].map(|i| (of(record.velocity(i)), of(record.acceleration(i))))
            };
            for _ in 0..4 {
                let before: Vec<_> = (0..shape.cells()).map(|cell| state(controller, cell)).collect();
                mode.step(controller, &settings);
                for (cell, &winner) in (0..).zip(controller.winners()).filter(|(_, winner)| **winner < shape.cells()) {
                    for ((v0, a0), (v1, a1)) in before[winner as usize].into_iter().zip(state(controller, cell)) {
                        prop_assert_eq!(a0, a1, "equation (5)");
                        prop_assert!((v1 - v0).signum() == a0.signum() || v1 == v0, "{} by {} became {}", v0, a0, v1);
                        prop_assert!(v0.signum() != a0.signum() || v1.signum() == v0.signum(), "{} by {} turned", v0, a0);
                        prop_assert!((v1 - v0).abs() <= a0.abs());
                    }
                }
            }
            Ok(())
        })?;
    }
}

/// The widest motion in every direction, and depth at both ends: every field stops at its end and is counted.
#[test]
fn extremes_stop_at_the_ends_of_their_fields() {
    let format = dynamic(Layout::FULL, PAPER);
    let settings = Settings { fill_mode: FillMode::None, ..Settings::for_depth(20) };
    for sign in [-1, 1] {
        with_controller(Shape::plain(1, 1), format, None, |controller| {
            let end = I32F32::from_num(sign * 1000);
            // In the plane the galpixel stays, with the depth alone at its extreme.
            let galpixel = Galpixel {
                velocity: [I32F32::ZERO, I32F32::ZERO, end],
                acceleration: [I32F32::ZERO, I32F32::ZERO, end],
                depth: I32F32::lit("0.5"),
                ..Galpixel::default()
            };
            assert_eq!(controller.front_mut().store(0, 0, &galpixel), Some(2));
            let before = controller.front().load(0, 0).unwrap();
            for frame in 1..=40 {
                let tally = controller.step(&settings);
                let after = controller.front().load(0, 0).unwrap();
                assert_eq!(after.velocity, before.velocity, "frame {frame}: at its end already");
                assert!(tally.saturated >= 1, "frame {frame}: the velocity would have left its field");
                assert!((after.depth - before.depth) * sign > 0, "frame {frame}: {}", after.depth);
                assert!((0..=1).contains(&after.depth.to_num::<i32>()));
            }
            let after = controller.front().load(0, 0).unwrap().depth;
            assert!(if sign > 0 { after > 0.9999 } else { after == 0 }, "{after}");
            assert_eq!(controller.step(&settings).saturated, 2, "depth and its velocity");
        });
    }
}
