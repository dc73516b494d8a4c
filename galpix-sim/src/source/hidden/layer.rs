//! A layer as it is handed over.

use galpix_core::layers::Displacement;

use crate::engine::HiddenLayer;
use crate::update::Update;

/// A layer as it is handed over.
#[derive(Clone, Debug)]
pub enum Layer {
    /// See [`HiddenLayer::Moving`].
    Moving(Update),
    /// See [`HiddenLayer::Stationary`].
    Stationary {
        /// The samples, where they are stored.
        update: Update,
        /// From there to the cells in which they are seen.
        displacements: Vec<Displacement>,
        /// Where in these cells they are.
        offsets: Vec<[f64; 2]>,
    },
}

impl Layer {
    /// Returns its samples.
    #[must_use]
    pub const fn update(&self) -> &Update {
        match self {
            Self::Moving(update) | Self::Stationary { update, .. } => update,
        }
    }

    pub(super) fn into_update(self) -> Update {
        match self {
            Self::Moving(update) | Self::Stationary { update, .. } => update,
        }
    }

    pub(super) const fn update_mut(&mut self) -> &mut Update {
        match self {
            Self::Moving(update) | Self::Stationary { update, .. } => update,
        }
    }

    /// As the engine takes it.
    #[must_use]
    pub fn for_engine(&self) -> HiddenLayer<'_> {
        match self {
            Self::Moving(update) => HiddenLayer::Moving(update),
            Self::Stationary { update, displacements, offsets } => {
                HiddenLayer::Stationary { update, displacements, offsets }
            }
        }
    }

    /// Returns the cell in which a sample is seen, before anything moves; it may lie outside of the map.
    pub(super) fn seen_at(&self, stored: usize) -> Option<usize> {
        let Self::Stationary { update, displacements, .. } = self else { return Some(stored) };
        let [dx, dy] = displacements.get(stored).copied()?;
        let (x, y) = ((stored % update.width) as i64 + i64::from(dx), (stored / update.width) as i64 + i64::from(dy));
        let inside = (0..update.width as i64).contains(&x) && (0..update.height as i64).contains(&y);
        inside.then(|| y as usize * update.width + x as usize)
    }
}
