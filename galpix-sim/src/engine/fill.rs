//! What is put into holes, as the command line means it: a fill mode of the core, or inpainting after its
//! richest one.

use galpix_core::FillMode;

pub use self::stage::Inpainter;
pub use galpix_core::inpaint::Gamma;

mod stage;

/// The kind of inpainting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// Push-pull: smooth colour from all around.
    PushPull,
    /// Push-pull of colour and of the statistics of texture, and a texture of those statistics.
    Metamer,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::PushPull, Self::Metamer];
}

/// Inpainting: what it makes, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Inpaint {
    /// The picture.
    pub kind: Kind,
    /// The weight of partial knowledge.
    pub gamma: Gamma,
    /// Whether what is nearer than a hole is kept out of it.
    pub depth_aware: bool,
    /// The radius in pixels of a disc in the middle of the display inside of which nothing is inpainted.
    pub fovea: Option<u32>,
}

impl Inpaint {
    /// Creates a kind with its usual gamma, depth aware, everywhere.
    #[must_use]
    pub const fn new(kind: Kind) -> Self {
        let gamma = match kind {
            Kind::PushPull => Gamma::Zero,
            Kind::Metamer => Gamma::Half,
        };
        Self { kind, gamma, depth_aware: true, fovea: None }
    }
}

/// What is put into holes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fill {
    /// What a fill mode of the core puts there.
    Mode(FillMode),
    /// What the richest fill mode puts there, inpainted in the frame in which the hole opens.
    Inpaint(Inpaint),
}

impl Default for Fill {
    fn default() -> Self {
        Self::Mode(FillMode::default())
    }
}

impl From<FillMode> for Fill {
    fn from(mode: FillMode) -> Self {
        Self::Mode(mode)
    }
}

impl From<Kind> for Fill {
    fn from(kind: Kind) -> Self {
        Self::Inpaint(Inpaint::new(kind))
    }
}

impl Fill {
    /// Returns one of each name, from cheap to rich.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let inpainted = Kind::ALL.map(Self::from);
        FillMode::ALL.into_iter().map(Self::from).chain(inpainted).collect()
    }

    /// Returns the name on the command line and in JSON.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mode(mode) => mode.name(),
            Self::Inpaint(Inpaint { kind: Kind::PushPull, .. }) => "push-pull",
            Self::Inpaint(Inpaint { kind: Kind::Metamer, .. }) => "metamer",
        }
    }

    /// Returns the fill mode of the core with which a frame is made.
    #[must_use]
    pub const fn mode(self) -> FillMode {
        match self {
            Self::Mode(mode) => mode,
            Self::Inpaint(_) => FillMode::Extend,
        }
    }

    /// Returns what follows each frame.
    #[must_use]
    pub const fn inpaint(self) -> Option<Inpaint> {
        match self {
            Self::Mode(_) => None,
            Self::Inpaint(inpaint) => Some(inpaint),
        }
    }
}

/// Returns whether a cell of the display lies within the disc of this radius around its middle.
#[must_use]
pub fn in_fovea(fovea: Option<u32>, cell: usize, width: usize, height: usize) -> bool {
    // From the middle in half cells, so that it lies between cells where a side is even.
    let apart = |at: usize, length: usize| (2 * at as i64 + 1 - length as i64).pow(2);
    let Some(radius) = fovea else { return false };
    apart(cell % width, width) + apart(cell / width, height) <= (2 * i64::from(radius)).pow(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fovea_is_a_disc_in_the_middle() {
        let inside: Vec<usize> = (0..25).filter(|&cell| in_fovea(Some(1), cell, 5, 5)).collect();
        assert_eq!(inside, [7, 11, 12, 13, 17]);
        assert!((0..25).all(|cell| !in_fovea(None, cell, 5, 5)));
        assert_eq!((0..16).filter(|&cell| in_fovea(Some(1), cell, 4, 4)).count(), 4);
    }

    #[test]
    fn every_fill_has_a_name_of_its_own_and_inpainting_stands_on_the_richest_mode() {
        let names: std::collections::HashSet<&str> = Fill::all().into_iter().map(Fill::name).collect();
        assert_eq!(names.len(), 6 + Kind::ALL.len());
        for fill in Fill::all() {
            assert_eq!(fill.inpaint().is_some(), !FillMode::ALL.iter().any(|mode| mode.name() == fill.name()));
            assert!(fill.inpaint().is_none() || fill.mode() == FillMode::Extend);
        }
    }
}
