//! A layer as it is handed over.

use galpix_core::layers::Displacement;

use crate::engine::Beside;
use crate::update::Update;

/// A layer as it is handed over.
#[derive(Clone, Debug)]
pub enum Layer {
    /// See [`Beside::Moving`].
    Moving(Update),
    /// See [`Beside::Anchored`].
    Anchored {
        /// The samples, where they are stored.
        update: Update,
        /// From there to the cells in which they are seen.
        displacements: Vec<Displacement>,
        /// Where in these cells they are.
        offsets: Vec<[f64; 2]>,
    },
}

impl Layer {
    /// Its samples.
    #[must_use]
    pub const fn update(&self) -> &Update {
        match self {
            Self::Moving(update) | Self::Anchored { update, .. } => update,
        }
    }

    pub(super) fn into_update(self) -> Update {
        match self {
            Self::Moving(update) | Self::Anchored { update, .. } => update,
        }
    }

    pub(super) const fn update_mut(&mut self) -> &mut Update {
        match self {
            Self::Moving(update) | Self::Anchored { update, .. } => update,
        }
    }

    /// As the engine takes it.
    #[must_use]
    pub fn beside(&self) -> Beside<'_> {
        match self {
            Self::Moving(update) => Beside::Moving(update),
            Self::Anchored { update, displacements, offsets } => Beside::Anchored { update, displacements, offsets },
        }
    }

    /// The cell in which a sample is seen, before anything moves; it may lie outside of the map.
    pub(super) fn seen_at(&self, stored: usize) -> Option<usize> {
        let Self::Anchored { update, displacements, .. } = self else { return Some(stored) };
        let [dx, dy] = displacements.get(stored).copied()?;
        let (x, y) = ((stored % update.width) as i64 + i64::from(dx), (stored / update.width) as i64 + i64::from(dy));
        let inside = (0..update.width as i64).contains(&x) && (0..update.height as i64).contains(&y);
        inside.then(|| y as usize * update.width + x as usize)
    }
}
