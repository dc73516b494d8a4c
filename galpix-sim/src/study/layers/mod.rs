//! The ways to know what was hidden side by side: how much of what the warp leaves open each of them fills, for how many samples and at what
//! cost, and how far the picture is from the truth after the fill ladder did the rest.
//!
//! ```text
//! holes (the warp of the first layer alone) ─┬─▶ shown (each way's frames) ─┬─▶ report ─▶ table, csv, page
//! ways ──────────────────────────────────────┴─▶ times (each way's frames) ─┘
//! ```
//!
//! Errors are measured on all processors, times afterwards on one, each beside a memory copy.

pub mod csv;
pub mod map;
pub mod page;
pub mod report;
pub mod table;
pub mod times;

use rayon::prelude::*;

use crate::metric;
use crate::picture::Picture;
use crate::source::Source;
use crate::source::hidden::{self, Arrangement, Kind, RADIUS, SEPARATION, Way};
use crate::study::fills::crops;
use crate::study::fills::holes::{self, Holes, count};
use crate::study::run::{self, ExperimentError, Request};
use report::{FrameCells, SourceReport, WayFrame, WayReport};

/// What to compare.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Frames, design numbers, rounding, fill; its way does not count.
    pub request: Request,
    /// The ways; the first one is [`Way::ONE`], that the others are compared with.
    pub ways: Vec<Way>,
}

/// All of them: the first layer alone, and each kind as it comes and culled.
#[must_use]
pub fn ways(separation: f64) -> Vec<Way> {
    let whole = Way { kind: Kind::Second { separation }, ..Way::ONE };
    let ways = [
        Way { kind: Kind::Second { separation: 0.0 }, ..whole },
        Way { arrangement: Arrangement::Nearer, ..whole },
        whole,
        Way { kind: Kind::Ddoc { radius: RADIUS }, arrangement: Arrangement::Nearer, ..whole },
        Way { kind: Kind::Ddoc { radius: RADIUS }, ..whole },
        Way { kind: Kind::Unlimited, ..whole },
    ];
    let both = ways.iter().flat_map(|&way| [false, true].map(|culled| Way { culled, ..way }));
    std::iter::once(Way::ONE).chain(both).collect()
}

impl Default for Plan {
    fn default() -> Self {
        Self { request: Request::default(), ways: ways(SEPARATION) }
    }
}

/// What a source had to say.
pub enum Study {
    /// Nothing is disoccluded in it.
    NothingDisoccluded,
    /// It knows nothing behind its first layer.
    NothingHidden,
    /// How the ways compare, without those that it does not have.
    Compared(Box<SourceReport>),
}

/// Compares the ways on a source. `done` is told of each way that is through.
///
/// *Errors:* a budget that cannot exist or does not fit.
pub fn study(source: &Source, plan: &Plan, done: impl Fn() + Sync) -> Result<Study, ExperimentError> {
    let ways: Vec<Way> = plan.ways.iter().copied().filter(|way| hidden::has(source, way.kind)).collect();
    if ways.iter().all(|way| way.kind == Kind::None) {
        return Ok(Study::NothingHidden);
    }
    let one = Request { way: Way::ONE, ..plan.request };
    let holes = holes::of(source, &one, None)?;
    let Some(largest) = crops::largest(&holes) else { return Ok(Study::NothingDisoccluded) };
    let shown: Vec<Shown> = ways
        .par_iter()
        .map(|&way| {
            let shown = show(source, plan, way, &holes, largest.frame);
            done();
            shown
        })
        .collect::<Result<_, _>>()?;
    let times = times::of(source, plan, &ways)?;
    let of_one = times.first().and_then(|(time, _)| *time);
    let mut crops = crops::of_truth(&holes, &largest);
    let reports = shown.into_iter().zip(&ways).zip(times).map(|((shown, &way), (time, update_us))| {
        crops.extend(shown.largest.map(|picture| crops::crop(way.name(), &picture, &largest)));
        let x_one = time.zip(of_one).map(|(time, one)| time.frame_us / one.frame_us.max(1e-9));
        WayReport { hidden: shown.hidden, time, x_one, update_us, ..WayReport::of(way, shown.frames) }
    });
    let ways = reports.collect();
    let update = source.update();
    Ok(Study::Compared(Box::new(SourceReport {
        source: source.name().to_owned(),
        about: source.about().to_owned(),
        width: update.display_width(),
        height: update.display_height(),
        frames: plan.request.frames.unwrap_or(source.frames()),
        cells: holes.iter().map(cells).collect(),
        ways,
        largest,
        crops,
        map: Some(map::picture(source, plan)?),
    })))
}

fn cells(holes: &Holes) -> FrameCells {
    FrameCells { frame: holes.frame, missing: count(&holes.all), disoccluded: count(&holes.disoccluded) }
}

/// What a way showed.
struct Shown {
    frames: Vec<WayFrame>,
    hidden: Option<hidden::HiddenReport>,
    /// The picture with the largest disocclusion.
    largest: Option<Picture>,
}

fn show(source: &Source, plan: &Plan, way: Way, holes: &[Holes], wanted: u32) -> Result<Shown, ExperimentError> {
    let request = Request { way, perceptual: false, ..plan.request };
    let (mut frames, mut largest) = (Vec::with_capacity(holes.len()), None);
    let mut rest = holes.iter().peekable();
    let report = run::run(source, &request, |frame| {
        let Some(holes) = rest.next_if(|holes| holes.frame == frame.frame) else { return };
        let counts = |cell: usize| frame.truth.is_none_or(|truth| truth.mask.as_ref().is_none_or(|mask| mask[cell]));
        let missing: Vec<bool> = (0..frame.reached.len()).map(|cell| !frame.reached[cell] && counts(cell)).collect();
        let inside: Vec<bool> = missing.iter().zip(&holes.disoccluded).map(|(&a, &b)| a && b).collect();
        let mask = frame.truth.and_then(|truth| truth.mask.as_deref());
        frames.push(WayFrame {
            frame: holes.frame,
            missing: count(&missing),
            disoccluded: count(&inside),
            psnr_db: metric::psnr_db(frame.picture, &holes.truth, mask),
            flip: metric::flip(frame.picture, &holes.truth, mask),
            disoccluded_db: metric::psnr_db(frame.picture, &holes.truth, Some(&holes.disoccluded)),
        });
        if holes.frame == wanted {
            largest = Some(frame.picture.clone());
        }
    })?;
    Ok(Shown { frames, hidden: report.hidden, largest })
}
