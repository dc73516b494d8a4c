//! Which sample of which layer each cell holds and shows.

use galpix_core::stages::FILLED;
use galpix_core::{Class, Dynamic, Maps};

use super::layer::HiddenLayer;
use crate::update::{Known, Update};

/// In an origin map: this cell does not hold a galpixel of the update.
pub const NO_ORIGIN: u32 = u32::MAX;

/// The origins of all layers. A sample's number is its cell, plus the cells of an update for each layer above its own.
pub(super) struct Origins {
    /// For each layer, for each cell of its own map.
    own: Vec<Vec<u32>>,
    /// For each cell of what is shown.
    pub shown: Vec<u32>,
    /// For each sample, whether the display ever showed it.
    pub used: Vec<bool>,
    cells: usize,
}

impl Origins {
    /// Returns the origins of the update itself.
    pub fn new(update: &Update, hidden: &[HiddenLayer<'_>]) -> Self {
        let cells = update.samples.len();
        let layers = std::iter::once(update).chain(hidden.iter().map(HiddenLayer::update));
        let own: Vec<Vec<u32>> = (0u32..)
            .zip(layers)
            .map(|(layer, update)| {
                let known = (layer * cells as u32..).zip(&update.samples);
                known.map(|(origin, sample)| if sample.known == Known::Motion { origin } else { NO_ORIGIN }).collect()
            })
            .collect();
        Self { shown: own[0].clone(), used: vec![false; own.len() * cells], own, cells }
    }

    /// Follows a step that was made with these hidden layers.
    pub fn follow<'p>(&mut self, maps: &impl Maps<'p, Format = Dynamic>, hidden: &[HiddenLayer<'_>]) {
        for (layer, own) in self.own.iter_mut().enumerate() {
            // Samples that stay where they are stored keep their numbers.
            if layer == 0 || matches!(hidden[layer - 1], HiddenLayer::Moving(_)) {
                *own = maps.winners(layer).iter().map(|&winner| origin(own, winner)).collect();
            }
        }
    }

    /// Notes what is shown; `seen` are the cells of the display.
    pub fn look<'p>(
        &mut self,
        maps: &impl Maps<'p, Format = Dynamic>,
        hidden: &[HiddenLayer<'_>],
        seen: impl Iterator<Item = u32>,
    ) {
        let shown = (0..self.cells as u32).map(|cell| {
            if maps.shown().class(cell) != Class::Galpixel {
                return NO_ORIGIN;
            }
            let layer = maps.layer_at(cell);
            let Some(own) = self.own.get(layer) else { return NO_ORIGIN };
            match layer.checked_sub(1).map(|index| &hidden[index]) {
                Some(HiddenLayer::Stationary { .. }) => {
                    maps.winners(layer).get(cell as usize).map_or(NO_ORIGIN, |&stored| origin(own, stored))
                }
                _ => own[cell as usize],
            }
        });
        self.shown = shown.collect();
        for cell in seen {
            if let Some(used) = self.used.get_mut(self.shown[cell as usize] as usize) {
                *used = true;
            }
        }
    }
}

/// Returns the origin of what `winner` was.
fn origin(before: &[u32], winner: u32) -> u32 {
    if winner >= FILLED { NO_ORIGIN } else { before.get(winner as usize).copied().unwrap_or(NO_ORIGIN) }
}
