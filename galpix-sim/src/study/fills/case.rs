//! The fills that are compared.

use galpix_core::FillMode;

use crate::engine::Scheme;
use crate::engine::fill::{Fill, Gamma, Inpaint, Kind};

/// A fill in a scheme, and what the fill is called here: push-pull is compared in two forms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Case {
    /// The name in tables.
    pub name: &'static str,
    /// What is put into holes.
    pub fill: Fill,
    /// How galpixels move.
    pub scheme: Scheme,
}

impl Case {
    /// Returns the name of its files and marks, which is that of the fill in the map.
    #[must_use]
    pub fn label(&self) -> String {
        match self.scheme {
            Scheme::Map => self.name.to_owned(),
            Scheme::Source => format!("{}-{}", self.scheme.name(), self.name),
        }
    }
}

/// What the fills are compared with: cells that nothing reached are black.
pub const NOTHING: Case = Case { name: "none", fill: Fill::Mode(FillMode::None), scheme: Scheme::Map };

/// Push-pull without depth.
pub const CLASSIC: &str = "push-pull-classic";

/// Returns all of them in the map, from cheap to rich; those that inpaint with this gamma, if one is given, and not
/// within a fovea of this radius. The classic push-pull has no gamma.
#[must_use]
pub fn all(gamma: Option<Gamma>, fovea: Option<u32>) -> Vec<Case> {
    let scheme = Scheme::Map;
    let modes = FillMode::ALL.map(|mode| Case { name: mode.name(), fill: mode.into(), scheme });
    let inpainted = Kind::ALL.map(|kind| {
        let usual = Inpaint::new(kind);
        let fill = Fill::Inpaint(Inpaint { gamma: gamma.unwrap_or(usual.gamma), fovea, ..usual });
        Case { name: fill.name(), fill, scheme }
    });
    let classic = Inpaint { gamma: Gamma::Zero, depth_aware: false, fovea, ..Inpaint::new(Kind::PushPull) };
    let classic = Case { name: CLASSIC, fill: Fill::Inpaint(classic), scheme };
    modes.into_iter().chain([classic]).chain(inpainted).collect()
}

/// Returns these cases in each of some schemes, as far as it takes the fill, and a sentence on what a scheme does not
/// take.
#[must_use]
pub fn in_schemes(cases: &[Case], schemes: &[Scheme]) -> (Vec<Case>, Vec<String>) {
    let (mut taken, mut left_out) = (Vec::new(), Vec::new());
    for &scheme in schemes {
        let of_scheme = cases.iter().map(|&case| Case { scheme, ..case });
        let (takes, not): (Vec<Case>, Vec<Case>) = of_scheme.partition(|case| scheme.takes(case.fill));
        taken.extend(takes);
        let names: Vec<&str> = not.iter().map(|case| case.name).collect();
        if !names.is_empty() {
            left_out.push(format!("Stationary sources do not have {}: left out.", names.join(", ")));
        }
    }
    (taken, left_out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_cases_are_the_same() {
        let cases = all(None, None);
        assert_eq!((cases.len(), cases[0]), (7 + Kind::ALL.len(), NOTHING));
        for (i, case) in cases.iter().enumerate() {
            assert!(cases[..i].iter().all(|other| other.name != case.name && other.fill != case.fill));
        }
        let (both, left_out) = in_schemes(&cases, &[Scheme::Map, Scheme::Source]);
        let sources: Vec<String> = both[cases.len()..].iter().map(Case::label).collect();
        assert_eq!(both[..cases.len()], cases);
        let expected = ["none", "hold", "extend", CLASSIC, "push-pull", "metamer"].map(|name| format!("source-{name}"));
        assert_eq!(sources, expected);
        assert_eq!(left_out, ["Stationary sources do not have debris, bullet, galdebris: left out."]);
        let gammas = |case: &Case| case.fill.inpaint().map(|inpaint| inpaint.gamma);
        let given: Vec<_> = all(Some(Gamma::One), Some(9)).iter().filter_map(gammas).collect();
        assert_eq!((given[0], &given[1..]), (Gamma::Zero, [Gamma::One; Kind::ALL.len()].as_slice()));
    }
}
