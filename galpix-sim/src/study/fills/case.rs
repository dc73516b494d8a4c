//! The fills that are compared.

use galpix_core::FillMode;

use crate::engine::fill::{Fill, Gamma, Inpaint, Kind};

/// A fill and what it is called here: push-pull is compared in two forms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Case {
    /// The name in tables and files.
    pub name: &'static str,
    /// What is put into holes.
    pub fill: Fill,
}

/// What the fills are compared with: cells that nothing reached are black.
pub const NOTHING: Case = Case { name: "none", fill: Fill::Mode(FillMode::None) };

/// Push-pull without depth.
pub const CLASSIC: &str = "push-pull-classic";

/// Returns all of them, from cheap to rich; those that inpaint with this gamma, if one is given, and not within a fovea
/// of this radius. The classic push-pull has no gamma.
#[must_use]
pub fn all(gamma: Option<Gamma>, fovea: Option<u32>) -> Vec<Case> {
    let modes = FillMode::ALL.map(|mode| Case { name: mode.name(), fill: mode.into() });
    let inpainted = Kind::ALL.map(|kind| {
        let usual = Inpaint::new(kind);
        let fill = Fill::Inpaint(Inpaint { gamma: gamma.unwrap_or(usual.gamma), fovea, ..usual });
        Case { name: fill.name(), fill }
    });
    let classic = Inpaint { gamma: Gamma::Zero, depth_aware: false, fovea, ..Inpaint::new(Kind::PushPull) };
    let classic = Case { name: CLASSIC, fill: Fill::Inpaint(classic) };
    modes.into_iter().chain([classic]).chain(inpainted).collect()
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
        let gammas = |case: &Case| case.fill.inpaint().map(|inpaint| inpaint.gamma);
        let given: Vec<_> = all(Some(Gamma::One), Some(9)).iter().filter_map(gammas).collect();
        assert_eq!((given[0], &given[1..]), (Gamma::Zero, [Gamma::One; Kind::ALL.len()].as_slice()));
    }
}
