//! From configurations to points: errors on all processors, then times on one.

use std::collections::HashMap;

use galpix_core::{Bits, BudgetError, Dynamic, FillMode, Format, Record, Rounding, Settings};
use rayon::prelude::*;

use super::design::{Configuration, Kept, Step};
use super::frames::{FrameError, Summary};
use super::report::{Point, Scheme};
use super::{Run, Shard, float, measure, stand_in};
use crate::certificate::Certificate;
use crate::engine;
use crate::engine::fill::Fill;
use crate::study::Work;
use crate::study::job::{ExperimentError, Request};
use crate::study::timing::{Contender, Engine, Maker, Noise, Race, Time, Whole, race};
use crate::update::Update;

/// A configuration whose budget exists.
struct Candidate {
    configuration: Configuration,
    bits: Bits,
    format: Dynamic,
    settings: Settings,
}

impl Candidate {
    /// Returns whether another one would do the same.
    fn is(&self, other: &Self) -> bool {
        let how = |of: &Self| (of.configuration.kept, of.configuration.fill, of.configuration.scheme);
        let what = |of: &Self| (of.bits, of.settings, how(of));
        what(self) == what(other)
    }
}

impl Candidate {
    /// Returns the engine that makes its frames.
    fn contender<'u>(&self, update: &'u Update) -> Option<Box<dyn Contender + 'u>> {
        let Self { configuration: Configuration { fill, scheme, .. }, format, settings, .. } = *self;
        let inpaint = fill.inpaint();
        Some(match scheme {
            engine::Scheme::Map => Box::new(Engine::new(update, format, settings, inpaint)?),
            engine::Scheme::Source => {
                let engine = engine::Engine::new(format, settings).inpainting(inpaint);
                Box::new(Whole::new(engine.showing(scheme, scheme.scan_out()), format, update, Vec::new()).ok()?)
            }
        })
    }
}

/// Returns the compile-time budget that a configuration is timed with, if there is one.
fn stand_in(configuration: &Configuration) -> Option<&'static stand_in::StandIn> {
    stand_in::of(configuration.kept).filter(|_| configuration.scheme == engine::Scheme::Map)
}

impl Run<'_> {
    /// Returns how the frames of a configuration are made in maps of a stored form.
    pub(super) fn settings(&self, configuration: &Configuration, record: &Record) -> Settings {
        let request = Request { rounding: configuration.rounding, fill: configuration.fill, ..self.job.request };
        request.settings(record, self.job.update.depth_kind)
    }

    fn candidate(&self, configuration: Configuration) -> Result<Candidate, BudgetError> {
        let bits = self.bits(configuration.kept, configuration.step)?;
        let format = Dynamic::new(bits, configuration.kept.layout())?;
        let settings = self.settings(&configuration, format.record());
        Ok(Candidate { configuration, bits, format, settings })
    }

    /// Measures the configurations, and floats: of both those of the shard. What has no budget is left out, with the
    /// reason.
    pub(super) fn points(
        &self,
        (design, shard): (&[Configuration], Shard),
        left_out: &mut Vec<String>,
        notify: &(dyn Fn(Work<'_>) + Sync),
    ) -> Result<(Vec<Point>, Option<Noise>), ExperimentError> {
        let mut candidates: Vec<Candidate> = Vec::new();
        for &configuration in design {
            match self.candidate(configuration) {
                // A step may lead to widths that are there already.
                Ok(new) if candidates.iter().any(|old| old.is(&new)) => {}
                Ok(new) => candidates.push(new),
                Err(error) if configuration.step == Step::DERIVED => return Err(error.into()),
                Err(error) => left_out.push(format!(
                    "Budget {} with fields {} does not exist: {error}.",
                    configuration.step.name(),
                    configuration.kept.name()
                )),
            }
        }
        let floats = Self::float_configurations(&candidates);
        // A point has the same number in every shard.
        let ids: Vec<usize> = (1..=candidates.len() + floats.len()).filter(|&id| shard.takes(id)).collect();
        let engines = candidates.len();
        let candidates: Vec<Candidate> =
            (1..).zip(candidates).filter(|&(id, _)| shard.takes(id)).map(|(_, candidate)| candidate).collect();
        let floats: Vec<Configuration> =
            (engines + 1..).zip(floats).filter(|&(id, _)| shard.takes(id)).map(|(_, float)| float).collect();
        notify(Work::Ahead(candidates.len() as u64));
        let certificates = self.certificates(&candidates);
        let mut points: Vec<Point> = candidates
            .par_iter()
            .map(|candidate| {
                let point = self.galpix(candidate, &certificates);
                notify(Work::Done);
                point
            })
            .collect::<Result<_, _>>()?;
        points.par_extend(floats.par_iter().map(|configuration| self.floats(configuration)));
        let noise = self.time(&candidates, &floats, &mut points, notify);
        for (point, id) in points.iter_mut().zip(ids) {
            point.id = id;
        }
        Ok((points, noise))
    }

    /// Returns the fields of the candidates in floats, with the fill modes that floats have.
    fn float_configurations(candidates: &[Candidate]) -> Vec<Configuration> {
        let mut floats: Vec<Configuration> = Vec::new();
        let Some(middle) = candidates.first().map(|candidate| candidate.configuration.kept) else { return floats };
        let none = candidates.iter().any(|candidate| candidate.configuration.fill == FillMode::None.into());
        for Candidate { configuration, .. } in candidates {
            for fill in [FillMode::None, FillMode::Hold].map(Fill::from) {
                // Black holes are for study: the richest fields show them.
                let shown = fill == FillMode::Hold.into() || none && configuration.kept == middle;
                let (rounding, scheme) = (Rounding::Nearest, engine::Scheme::Map);
                let float = Configuration { fill, step: Step::DERIVED, rounding, scheme, ..*configuration };
                if shown && configuration.kept != Kept::Still && !floats.contains(&float) {
                    floats.push(float);
                }
            }
        }
        floats
    }

    /// Returns the certificate of each kind of arithmetic among the candidates.
    fn certificates(&self, candidates: &[Candidate]) -> HashMap<Arithmetic, Certificate> {
        let mut kinds: Vec<(Arithmetic, &Candidate)> =
            candidates.iter().map(|candidate| (Arithmetic::of(candidate), candidate)).collect();
        kinds.sort_by_key(|kind| kind.0);
        kinds.dedup_by_key(|kind| kind.0);
        let certify = |&(kind, candidate): &(Arithmetic, &Candidate)| {
            let record = candidate.format.record();
            let rounding = candidate.settings.rounding;
            (kind, Certificate::of(&record.scales[0], record.layout().acceleration, rounding, self.job.demand.prop))
        };
        kinds.par_iter().map(certify).collect()
    }

    fn galpix(
        &self,
        candidate: &Candidate,
        certificates: &HashMap<Arithmetic, Certificate>,
    ) -> Result<Point, ExperimentError> {
        let Candidate { configuration, bits, format, settings } = candidate;
        let mut measured = measure::engine(&self.reference, configuration, *bits, *settings)?;
        let (record, layout) = (format.record(), configuration.kept.layout());
        let certificate = certificates.get(&Arithmetic::of(candidate));
        for frame in &mut measured.frames {
            // What has no velocity stays where it is, exactly.
            frame.certified_px =
                if layout.velocity { certificate.and_then(|bound| bound.after(frame.frame)) } else { Some(0.0) };
            frame.left_out_px = self.reference.left_out_px(layout, frame.frame);
        }
        let x = bits.x;
        Ok(Point {
            bits: Some([x.position_frac, x.velocity_int, x.velocity_frac, x.acceleration_int, x.acceleration_frac]),
            rounding: Some(settings.rounding.name()),
            bytes: record.bytes(),
            used_bits: record.bits(),
            saturated: u64::from(measured.loaded.saturated) + measured.saturated,
            budget: configuration.step.name(),
            stand_in: stand_in(configuration).map(stand_in::StandIn::name),
            ..point(Scheme::of(configuration.scheme), configuration, measured.frames)
        })
    }

    fn floats(&self, configuration: &Configuration) -> Point {
        let mut measured = measure::floats(&self.reference, configuration);
        for frame in &mut measured.frames {
            frame.left_out_px = self.reference.left_out_px(configuration.kept.layout(), frame.frame);
        }
        let bytes = float::maps(configuration.kept, 1, 1).map_or(0, |maps| maps.bytes_per_pixel());
        let used_bits = 8 * bytes as u32;
        Point { bytes, used_bits, ..point(Scheme::F32, configuration, measured.frames) }
    }

    /// Times all points: each galpix point with its own budget chosen at run time, each stand-in once for each fill
    /// mode, floats.
    fn time(
        &self,
        candidates: &[Candidate],
        floats: &[Configuration],
        points: &mut [Point],
        notify: &(dyn Fn(Work<'_>) + Sync),
    ) -> Option<Noise> {
        let update = &self.reference.update;
        let mut makers: Vec<Maker<'_>> = Vec::new();
        for candidate in candidates {
            makers.push(Box::new(move || candidate.contender(update)));
        }
        for configuration in floats {
            let cells = update.samples.len();
            makers.push(Box::new(move || {
                let maps = float::maps(configuration.kept, update.width, update.height)?;
                Some(Box::new(float::InFloats { maps, fill_mode: configuration.fill.mode(), cells }))
            }));
        }
        let mut fixed: Vec<(String, Fill)> = Vec::new();
        for candidate in candidates {
            let Some(stand_in) = stand_in(&candidate.configuration) else { continue };
            let kind = (stand_in.name(), candidate.configuration.fill);
            if !fixed.contains(&kind) {
                fixed.push(kind);
                // The edge threshold stands in units of the depth's last bit, of which the stand-in may have another
                // number.
                let settings = self.settings(&candidate.configuration, &stand_in.record);
                let inpaint = candidate.configuration.fill.inpaint();
                makers.push(Box::new(move || stand_in.contender(update, settings, inpaint)));
            }
        }
        notify(Work::Ahead(makers.len() as u64 * u64::from(self.effort.rounds + 1)));
        let Race { times, noise } = race(update, self.effort, &makers, || notify(Work::Done));
        let (own, fixed_times) = times.split_at(candidates.len() + floats.len());
        for (index, (point, &time)) in points.iter_mut().zip(own).enumerate() {
            match candidates.get(index) {
                Some(candidate) => {
                    point.run_time = time;
                    let place = fixed.iter().position(|(name, fill)| {
                        Some(name) == point.stand_in.as_ref() && *fill == candidate.configuration.fill
                    });
                    point.compile_time = place.and_then(|place| fixed_times[place]);
                }
                None => point.compile_time = time,
            }
        }
        noise
    }
}

/// Returns a point without its number, its widths and its times.
fn point(scheme: Scheme, configuration: &Configuration, frames: Vec<FrameError>) -> Point {
    Point {
        id: 0,
        scheme,
        fields: configuration.kept.name(),
        budget: String::new(),
        bits: None,
        rounding: None,
        fill: configuration.fill.name(),
        bytes: 0,
        used_bits: 0,
        saturated: 0,
        run_time: None::<Time>,
        compile_time: None,
        stand_in: None,
        summary: Summary::of(&frames),
        frames,
    }
}

/// What a certificate depends on, besides `tau_prop`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Arithmetic([u32; 6], bool, &'static str);

impl Arithmetic {
    fn of(candidate: &Candidate) -> Self {
        let record = candidate.format.record();
        let scale = &record.scales[0];
        Self(
            [
                scale.acceleration_up,
                scale.down,
                scale.up,
                scale.position_frac,
                scale.velocity_frac,
                scale.acceleration_frac,
            ],
            record.layout().acceleration,
            candidate.settings.rounding.name(),
        )
    }
}
