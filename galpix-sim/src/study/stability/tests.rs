use galpix_core::Tally;
use galpix_core::stages::{clamp_velocity, snap, step_position, step_velocity};

use super::causes::{Followed, follow};
use super::mover::{Moved, State};
use super::path::{Given, Motion, Path};
use super::picture::Census;
use super::*;

fn setting() -> Setting {
    Setting::new(Request::default().demand).unwrap()
}

/// What a planted engine does wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// A velocity that leaves its field comes in again at the other end.
    VelocityWraps,
    /// The position does, at 2^12 cells.
    PositionWraps,
    /// The threshold is left out.
    Threshold,
    /// Clamps are not counted.
    Count,
    /// Velocities are cut off when they are stored.
    Store,
    /// The next cell is shown.
    Cell,
    /// The galpixel is gone after frame 5.
    Gone,
}

/// The kernels of the engine, called one after the other, with a fault.
struct Planted {
    ranges: Ranges,
    rounding: Rounding,
    fault: Fault,
    state: State,
}

impl Planted {
    fn new(setting: &Setting, rounding: Rounding, fault: Fault) -> Self {
        let state = State { cell: 0, position: 0, velocity: 0, acceleration: 0 };
        Self { ranges: setting.ranges(0), rounding, fault, state }
    }
}

impl Mover for Planted {
    fn load(&mut self, given: &Given) -> Moved {
        let scale = &self.ranges.scale;
        let [r, v, a] = given.exact;
        let velocity = v.nearest(scale.velocity_frac) - i64::from(self.fault == Fault::Store);
        let kept = velocity.clamp(-1 - self.ranges.velocity_top, self.ranges.velocity_top);
        self.state = State {
            cell: given.cell,
            position: r.nearest(scale.position_frac),
            velocity: kept,
            acceleration: a.nearest(scale.acceleration_frac),
        };
        Moved { state: self.state, clamped: u32::from(kept != velocity) }
    }

    fn step(&mut self, counter: u32) -> Option<Moved> {
        let (scale, state) = (&self.ranges.scale, self.state);
        let [r, v, a] = [state.position, state.velocity, state.acceleration].map(|field| field as i32);
        let threshold = self.rounding.threshold(counter, scale.down);
        let threshold = if self.fault == Fault::Threshold { 0 } else { threshold };
        let mut position = step_position(scale, threshold, r, v, a);
        if self.fault == Fault::PositionWraps && position >= 1 << (12 + scale.position_frac) {
            position -= 1 << (13 + scale.position_frac);
        }
        let next = step_velocity(scale, v, a);
        let unused = 32 - scale.velocity_bits;
        let velocity = match self.fault {
            Fault::VelocityWraps => next << unused >> unused,
            _ => clamp_velocity(scale, next),
        };
        let clamped = velocity != next && self.fault != Fault::Count;
        let cell = snap(scale, position) + i32::from(self.fault == Fault::Cell);
        self.state = State { cell: cell.into(), position: position.into(), velocity: velocity.into(), ..state };
        (self.fault != Fault::Gone || counter < 5).then_some(Moved { state: self.state, clamped: clamped.into() })
    }
}

/// v and a in last bits, for `frames` frames.
fn path(v: f64, a: f64, frames: u32) -> Path {
    let bit = 1.0 / 128.0;
    Path::new("planted", 0, Motion::SecondOrder([Px::default(), Px::near(v * bit), Px::near(a * bit)]), frames)
}

fn planted(path: &Path, rounding: Rounding, fault: Fault) -> PathReport {
    let setting = setting();
    let law = Law::of(&setting, 0, rounding, path.frames);
    run_path(path, &setting, rounding, &law, &mut Planted::new(&setting, rounding, fault))
}

#[test]
fn the_kernels_one_after_the_other_are_the_engine_on_its_strip() {
    let setting = setting();
    for rounding in Rounding::ALL {
        for (v, a) in [(0.0, 0.0), (731.0, -90.0), (-5.0, 3.0), (65_000.0, 16_000.0), (65_535.0, -16_384.0), (1.4, 0.3)]
        {
            let path = path(v, a, 40);
            let law = Law::of(&setting, 0, rounding, 40);
            let mut strip = Strip::new(&setting, 0, rounding).unwrap();
            let engine = run_path(&path, &setting, rounding, &law, &mut strip);
            let kernels = planted(&path, rounding, Fault::None);
            assert_eq!(engine.series, kernels.series, "{rounding:?} {v} {a}");
            assert_eq!((engine.verdict, engine.clamped), (kernels.verdict, kernels.clamped));
        }
    }
}

#[test]
fn the_shares_of_a_path_worked_out_by_hand() {
    let setting = setting();
    let mut strip = Strip::new(&setting, 0, Rounding::Truncate).unwrap();
    // 1.375 last bits of 1/128 are stored as 1; twice that is less than a last bit of the position: it never moves.
    let followed = follow(&path(1.375, 0.0, 10), &setting, Rounding::Truncate, &mut strip);
    let row = followed.rows.last().unwrap();
    let shares =
        [row.causes.taylor, row.causes.quantisation, row.causes.saturation, row.causes.drift, row.causes.snapping];
    assert_eq!(shares.map(Px::to_f64), [0.0, 3.75 / 128.0, 0.0, 10.0 / 128.0, 0.0]);
    // A velocity one last bit beyond its field, and an acceleration that takes it farther by one more each frame: the
    // stored one stands still at the end of its field.
    let mut strip = Strip::new(&setting, 0, Rounding::Nearest).unwrap();
    let followed = follow(&path(65_536.0, 1.0, 4), &setting, Rounding::Nearest, &mut strip);
    let row = followed.rows.last().unwrap();
    // By the load 4 frames of 1; by the clamps 1 + 2 + 3.
    assert_eq!(row.causes.saturation.to_f64(), (4.0 + 6.0) / 128.0);
    assert_eq!(followed.clamped, 1 + 4);
}

#[test]
fn shares_add_up_to_the_error_exactly() {
    let setting = setting();
    let mut rows = 0;
    for case in &ALL {
        for path in (case.paths)(&setting) {
            let mut strip = Strip::new(&setting, path.component, Rounding::LowDiscrepancy).unwrap();
            let Followed { rows: all, findings, .. } = follow(&path, &setting, Rounding::LowDiscrepancy, &mut strip);
            assert!(findings.is_empty(), "{}: {findings:?}", path.name);
            for row in &all {
                assert_eq!(row.causes.total(), row.place - row.shown, "{}, frame {}", path.name, row.frame);
            }
            rows += all.len();
        }
    }
    assert!(rows > 5000, "only {rows} rows");
}

#[test]
fn every_fault_is_found_and_its_absence_is_not() {
    let fast = path(60_000.0, 1_000.0, 16);
    let slow = path(1.0, 0.0, 16);
    let far = path(40_000.0, 0.0, 16);
    for (path, fault, words) in [
        (&fast, Fault::VelocityWraps, "the velocity changed by more than the acceleration: it wrapped"),
        (&far, Fault::PositionWraps, "the position jumped farther than the largest velocity allows: it wrapped"),
        (&fast, Fault::Count, "a clamped field was not counted"),
        (&slow, Fault::Threshold, "drifted"),
        (&slow, Fault::Store, "a stored field is not the nearest"),
        (&slow, Fault::Cell, "not in the nearest cell"),
        (&slow, Fault::Gone, "the galpixel is nowhere"),
    ] {
        let path = if fault == Fault::Threshold { &self::path(7.0, 0.0, 16) } else { path };
        let found = planted(path, Rounding::LowDiscrepancy, fault);
        assert_eq!(found.verdict, Verdict::Unstable, "{fault:?}");
        assert!(found.findings.iter().any(|finding| finding.contains(words)), "{fault:?}: {:?}", found.findings);
        let clean = planted(path, Rounding::LowDiscrepancy, Fault::None);
        assert_ne!(clean.verdict, Verdict::Unstable, "{fault:?}: {:?}", clean.findings);
    }
}

/// The drift of a planted engine grows by less than a last bit per frame, far below a jump: the law finds it.
#[test]
fn a_slow_growth_without_an_update_is_found_by_the_law_beyond_the_certificate() {
    let path = path(1.0, 0.0, 512);
    let found = planted(&path, Rounding::LowDiscrepancy, Fault::Threshold);
    assert_eq!(found.verdict, Verdict::Unstable);
    assert_eq!(
        planted(&path, Rounding::LowDiscrepancy, Fault::None).verdict,
        Verdict::NotCovered,
        "only that it is late"
    );
}

#[test]
fn verdicts_say_what_is_not_covered() {
    let run = |path: Path| {
        let setting = setting();
        let law = Law::of(&setting, 0, Rounding::LowDiscrepancy, path.frames);
        let mut strip = Strip::new(&setting, 0, Rounding::LowDiscrepancy).unwrap();
        let report = run_path(&path, &setting, Rounding::LowDiscrepancy, &law, &mut strip);
        let uncovered = report.uncovered;
        (report.verdict, [uncovered.taylor_px, uncovered.saturation_px, uncovered.past_prop_px].map(|px| px.is_some()))
    };
    let cubic =
        |part: f64| Motion::Analytic(Box::new(move |t: f64| [part * t * t * t, 3.0 * part * t * t, 6.0 * part * t]));
    assert_eq!(run(path(100.3, 7.7, 16)), (Verdict::Bounded, [false; 3]));
    assert_eq!(run(path(100.3, 7.7, 17)), (Verdict::NotCovered, [false, false, true]));
    assert_eq!(run(path(70_000.0, 0.0, 16)), (Verdict::NotCovered, [false, true, false]));
    assert_eq!(run(Path::new("cubic", 0, cubic(0.01), 16)), (Verdict::NotCovered, [true, false, false]));
    assert_eq!(run(Path::new("hardly cubic", 0, cubic(1e-6), 16)), (Verdict::Bounded, [false; 3]), "within the bound");
}

#[test]
fn a_census_that_does_not_add_up_is_found() {
    let good = Census {
        cells: 10,
        held: 7,
        settled: 4,
        strange: 0,
        empty: 1,
        tally: Tally {
            moved: 7,
            lost: 2,
            collided: 1,
            holes: 6,
            bullets: 2,
            debris: 2,
            galdebris: 1,
            empty: 1,
            ..Tally::default()
        },
    };
    assert!(good.findings().is_empty(), "{:?}", good.findings());
    let spoil = |spoil: fn(&mut Census)| {
        let mut census = good;
        spoil(&mut census);
        census.findings().len()
    };
    for (name, findings) in [
        ("a galpixel that was not moved", spoil(|census| census.held += 1)),
        ("one that vanished", spoil(|census| census.tally.lost -= 1)),
        ("a hole that was not counted", spoil(|census| census.tally.holes -= 1)),
        ("one that was filled twice", spoil(|census| census.tally.debris += 1)),
        ("an empty cell more", spoil(|census| census.empty += 1)),
        ("one that came twice", spoil(|census| census.strange += 1)),
        ("more edges than cells", spoil(|census| census.tally.edges = 11)),
    ] {
        assert!(findings > 0, "{name}");
    }
}

#[test]
fn cases_and_their_demands_are_refused_in_one_sentence() {
    let of = |extent: u32, recog: u32, prop: u32, case: &str| {
        let request = Request { demand: Demand { extent, recog, prop }, cases: vec![case.to_owned()], rounding: None };
        request.check().unwrap_err().to_string()
    };
    assert!(of(1024, 8, 16, "nowhere").contains("`nowhere`: give one or more of turn-round, rotation"));
    assert!(of(0, 8, 16, "empty").contains("positive number"));
    assert!(of(32768, 1, 16, "empty").contains("lower --extent or raise --recog"));
}

#[test]
fn exact_numbers_round_to_nearest_halves_upwards() {
    for (value, frac, nearest) in [(0.5, 0, 1), (-0.5, 0, 0), (0.49, 0, 0), (1.25, 1, 3), (-1.25, 1, -2), (3.0, 2, 12)]
    {
        assert_eq!(Px::near(value).nearest(frac), nearest, "{value}");
    }
    assert_eq!(Px::of(3, 1), Px::near(1.5));
    assert_eq!(Px::of(1, 7).accelerated(3).to_f64(), 9.0 / 256.0);
}
