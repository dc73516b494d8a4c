//! The picture before a frame, read from layers that hold their own galpixels again.

use crate::format::Format;
use crate::format::record::{Record, Words};
use crate::frame::fill::Around;
use crate::frame::reference::choose_words;
use crate::layers::composite;
use crate::layers::layer::Layer;
use crate::map::Galpixmap;

/// The front maps, each with its own galpixels, and the composite masks of the frame before and of this one.
pub(super) struct Shown<'s, 'p, F> {
    pub front: &'s Galpixmap<'p, F>,
    pub hidden: &'s [Layer<'p, F>],
}

impl<F: Format> Around for Shown<'_, '_, F> {
    #[inline(always)]
    fn record(&self) -> &Record {
        self.front.record()
    }

    #[inline(always)]
    fn before(&self, cell: u32) -> Option<Words> {
        let mut shown = self.front.words_at(cell)?;
        for layer in self.hidden {
            let mask = composite::mask(layer.composited_before(), cell);
            shown = choose_words(self.front.record(), mask, &layer.front.words_at(cell)?, &shown);
        }
        Some(shown)
    }

    #[inline(always)]
    fn foreign(&self, cell: u32) -> u32 {
        self.hidden.iter().fold(0, |foreign, layer| foreign | composite::mask(layer.composited(), cell))
    }
}
