//! Which configurations are measured: one axis at a time around the default, and the combinations that may lie on a
//! front.

use galpix_core::record::Component;
use galpix_core::{Bits, BudgetError, Colour, Demand, FillMode, Layout, Rounding};

use super::ranges::Ranges;
use crate::engine::Scheme;
use crate::engine::fill::Fill;

/// Which fields a galpixel carries besides its class and colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kept {
    /// None: the picture stands still.
    Still,
    /// Velocity in x and y; 16-bit depth that does not move.
    Velocity,
    /// Velocity in x, y and depth.
    VelocityDepth,
    /// Velocity and acceleration in x and y; depth that does not move.
    Acceleration,
    /// Velocity and acceleration in x, y and depth: the paper's galpixel.
    Full,
    /// Full, and the rate of the luminosity.
    Luminosity,
}

impl Kept {
    /// All of them, from poor to rich.
    pub const ALL: [Self; 6] =
        [Self::Still, Self::Velocity, Self::VelocityDepth, Self::Acceleration, Self::Full, Self::Luminosity];

    /// Returns the name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Still => "still",
            Self::Velocity => "velocity",
            Self::VelocityDepth => "velocity-depth",
            Self::Acceleration => "acceleration",
            Self::Full => "full",
            Self::Luminosity => "luminosity",
        }
    }

    /// Returns the layout.
    #[must_use]
    pub const fn layout(self) -> Layout {
        match self {
            Self::Still => Layout::STILL,
            Self::Velocity => Layout { colour: Colour::RGB888, ..Layout::VELOCITY565 },
            Self::VelocityDepth => Layout { acceleration: false, ..Layout::FULL },
            Self::Acceleration => Layout { depth_motion: false, ..Layout::FULL },
            Self::Full => Layout::FULL,
            Self::Luminosity => Layout { luminosity: true, ..Layout::FULL },
        }
    }
}

/// A budget, by how it departs from the one that the demand derives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Step {
    /// Fraction bits more (or fewer) of the position.
    pub position: i32,
    /// Fraction bits more (or fewer) of velocity and acceleration.
    pub motion: i32,
    /// Whether integer bits are taken off that the update does not need.
    pub fitted: bool,
}

impl Step {
    /// As derived.
    pub const DERIVED: Self = Self { position: 0, motion: 0, fitted: false };

    /// Returns what it does, in a few words.
    #[must_use]
    pub fn name(self) -> String {
        let fractions = match (self.position, self.motion) {
            (0, 0) => None,
            (position, 0) => Some(format!("position {position:+}")),
            (0, motion) => Some(format!("motion {motion:+}")),
            (position, motion) if position == motion => Some(format!("all {position:+}")),
            (position, motion) => Some(format!("position {position:+} motion {motion:+}")),
        };
        match (self.fitted, fractions) {
            (false, None) => "derived".to_owned(),
            (false, Some(fractions)) => fractions,
            (true, None) => "fitted".to_owned(),
            (true, Some(fractions)) => format!("fitted {fractions}"),
        }
    }

    /// Returns the widths for a layout. Without acceleration these depart from [`Bits::derive_without_acceleration`].
    ///
    /// *Errors:* a demand that gives no budget, a step that leaves none.
    pub fn bits(self, demand: Demand, layout: Layout, ranges: &Ranges) -> Result<Bits, BudgetError> {
        let derived =
            if layout.acceleration { Bits::derive(demand)? } else { Bits::derive_without_acceleration(demand)? };
        let [x, y, z] = [(0, derived.x), (1, derived.y), (2, derived.z)].map(|(axis, component)| {
            let bins = if axis == 2 { derived.depth_int } else { 0 };
            let component = if self.fitted { ranges.fit(component, axis, bins, layout) } else { component };
            self.stepped(component)
        });
        let (x, y, z) = (x?, y?, z?);
        // The fraction of the luminosity follows that of the position, as it does where it is derived.
        Ok(Bits { luminosity_frac: x.position_frac, ..derived }.with_xy(x, y).with_z(z, derived.depth_int))
    }

    fn stepped(self, component: Component) -> Result<Component, BudgetError> {
        let step = |bits: u32, by: i32| bits.checked_add_signed(by).ok_or(BudgetError::ShavedAway);
        let acceleration_frac =
            if component.has_acceleration() { step(component.acceleration_frac, self.motion)? } else { 0 };
        Component {
            position_frac: step(component.position_frac, self.position)?,
            velocity_frac: step(component.velocity_frac, self.motion)?,
            acceleration_frac,
            ..component
        }
        .checked()
    }
}

/// One way to run the engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Configuration {
    /// The fields.
    pub kept: Kept,
    /// The budget.
    pub step: Step,
    /// The rounding of positions.
    pub rounding: Rounding,
    /// What is put into holes.
    pub fill: Fill,
    /// How galpixels move.
    pub scheme: Scheme,
}

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Extent {
    /// The corners.
    Quick,
    /// As sensible, with a shorter ladder and none of single fields: for large pictures.
    Sparing,
    /// One axis at a time, and the combinations that may lie on a front.
    #[default]
    Sensible,
    /// All fields by all roundings by all fill modes, and all budgets by all roundings.
    Full,
}

/// What may be chosen from, each from cheap to rich and none of them empty.
#[derive(Clone, Debug)]
pub struct Axes {
    /// Fields.
    pub kept: Vec<Kept>,
    /// Roundings.
    pub roundings: Vec<Rounding>,
    /// Fill modes.
    pub fills: Vec<Fill>,
    /// Schemes.
    pub schemes: Vec<Scheme>,
}

impl Axes {
    /// Around what one axis at a time is varied: the richest fields, the richest fill mode of the first scheme, and the
    /// default rounding where it may be chosen.
    #[must_use]
    pub fn middle(&self) -> Configuration {
        let rounding = Rounding::default();
        let scheme = self.schemes.first().copied().unwrap_or_default();
        Configuration {
            kept: self.kept.last().copied().unwrap_or(Kept::Full),
            step: Step::DERIVED,
            rounding: if self.roundings.contains(&rounding) {
                rounding
            } else {
                self.roundings.last().copied().unwrap_or_default()
            },
            fill: self.fills.iter().rfind(|&&fill| scheme.takes(fill)).copied().unwrap_or_default(),
            scheme,
        }
    }

    /// Returns the configurations, none twice, the middle first; those of one scheme after those of the other, without
    /// the fill modes that it does not take.
    #[must_use]
    pub fn design(&self, extent: Extent) -> Vec<Configuration> {
        let middle = self.middle();
        let mut chosen = vec![middle];
        let steps = steps(extent);
        chosen.extend(steps.iter().map(|&step| Configuration { step, ..middle }));
        let coarse = Step { position: -2, motion: -2, fitted: false };
        for &rounding in &self.roundings {
            chosen.push(Configuration { rounding, ..middle });
            match extent {
                Extent::Quick | Extent::Sparing => {}
                Extent::Sensible => chosen.push(Configuration { rounding, step: coarse, ..middle }),
                Extent::Full => chosen.extend(steps.iter().map(|&step| Configuration { rounding, step, ..middle })),
            }
        }
        for &kept in &self.kept {
            let fitted = Step { fitted: true, ..Step::DERIVED };
            if extent != Extent::Sparing || kept == middle.kept {
                chosen.push(Configuration { kept, step: fitted, ..middle });
            }
            for &fill in &self.fills {
                let telling = matches!(fill, Fill::Mode(FillMode::Hold | FillMode::Bullet)) || fill == middle.fill;
                match extent {
                    Extent::Quick if !telling || fill == Fill::Mode(FillMode::Bullet) => continue,
                    Extent::Sparing if kept != middle.kept && (!telling || fill == Fill::Mode(FillMode::Bullet)) => {
                        continue;
                    }
                    Extent::Sensible if !telling && kept != middle.kept => continue,
                    _ => chosen.push(Configuration { kept, fill, ..middle }),
                }
                if extent == Extent::Full {
                    let each = |&rounding: &Rounding| Configuration { kept, fill, rounding, ..middle };
                    chosen.extend(self.roundings.iter().map(each));
                }
            }
        }
        let mut seen = std::collections::HashSet::new();
        chosen.retain(|&configuration| seen.insert(configuration));
        let in_scheme = |&scheme: &Scheme| {
            let of_scheme = chosen.iter().map(move |&configuration| Configuration { scheme, ..configuration });
            of_scheme.filter(move |configuration| scheme.takes(configuration.fill)).collect::<Vec<_>>()
        };
        self.schemes.iter().flat_map(in_scheme).collect()
    }
}

/// Returns the ladder of budgets.
fn steps(extent: Extent) -> Vec<Step> {
    let by: &[i32] = match extent {
        Extent::Quick => &[-2, 1],
        Extent::Sparing => &[-2, -1, 1],
        Extent::Sensible | Extent::Full => &[-3, -2, -1, 1, 2],
    };
    let mut steps: Vec<Step> = by.iter().map(|&by| Step { position: by, motion: by, fitted: false }).collect();
    if matches!(extent, Extent::Sensible | Extent::Full) {
        steps.extend(by.iter().map(|&position| Step { position, ..Step::DERIVED }));
        steps.extend(by.iter().map(|&motion| Step { motion, ..Step::DERIVED }));
        steps.extend([0, -1, -2].map(|by| Step { position: by, motion: by, fitted: true }));
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes() -> Axes {
        Axes {
            kept: Kept::ALL[..5].to_vec(),
            roundings: Rounding::ALL.to_vec(),
            fills: FillMode::ALL.map(Fill::from).to_vec(),
            schemes: vec![Scheme::Map],
        }
    }

    #[test]
    fn designs_begin_in_the_middle_hold_nothing_twice_and_grow() {
        let sizes = [Extent::Quick, Extent::Sparing, Extent::Sensible, Extent::Full].map(|extent| {
            let design = axes().design(extent);
            assert_eq!(design[0], axes().middle());
            let distinct: std::collections::HashSet<_> = design.iter().collect();
            assert_eq!(distinct.len(), design.len());
            for rounding in Rounding::ALL {
                assert!(design.iter().any(|configuration| configuration.rounding == rounding), "{extent:?}");
            }
            design.len()
        });
        assert!(sizes[0] < 24 && sizes[1] < 30 && sizes[1] < sizes[2] && sizes[2] < 70 && sizes[3] > 150, "{sizes:?}");
    }

    #[test]
    fn a_further_scheme_has_the_same_configurations_as_far_as_it_takes_their_fill() {
        let both = Axes { schemes: vec![Scheme::Map, Scheme::Source], ..axes() };
        let (map, design) = (axes().design(Extent::Sensible), both.design(Extent::Sensible));
        assert_eq!((both.middle(), &design[..map.len()]), (axes().middle(), map.as_slice()));
        let taken = map.iter().filter(|configuration| Scheme::Source.takes(configuration.fill));
        let taken: Vec<Configuration> =
            taken.map(|&of_map| Configuration { scheme: Scheme::Source, ..of_map }).collect();
        assert!(taken.len() < map.len());
        assert!(design[map.len()..] == taken, "{} of {}", design.len() - map.len(), taken.len());
    }

    #[test]
    fn a_list_of_one_is_all_that_is_run() {
        let one = Axes {
            kept: vec![Kept::Velocity],
            roundings: vec![Rounding::Truncate],
            fills: vec![FillMode::Hold.into()],
            schemes: vec![Scheme::Map],
        };
        for configuration in one.design(Extent::Full) {
            assert_eq!(
                (configuration.kept, configuration.rounding, configuration.fill),
                (Kept::Velocity, Rounding::Truncate, FillMode::Hold.into())
            );
        }
    }

    #[test]
    fn steps_depart_from_the_derived_widths() {
        let demand = Demand { extent: 256, recog: 8, prop: 16 };
        let bits = |step: Step| step.bits(demand, Layout::FULL, &Ranges::default());
        let derived = bits(Step::DERIVED).unwrap();
        assert_eq!(derived, Bits::derive(demand).unwrap());
        let step = bits(Step { position: -3, motion: 2, fitted: false }).unwrap();
        assert_eq!(step.x.position_frac + 3, derived.x.position_frac);
        assert_eq!(step.y.velocity_frac, derived.y.velocity_frac + 2);
        assert_eq!(step.z.acceleration_frac, derived.z.acceleration_frac + 2);
        assert_eq!(bits(Step { position: -9, motion: 0, fitted: false }), Err(BudgetError::ShavedAway));
    }
}
