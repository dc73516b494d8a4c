//! What was shown before, while the layers have their own galpixels back.

use crate::constant::choose_words;
use crate::fill::Around;
use crate::galpixel::Budget;
use crate::galpixmap::Galpixmap;
use crate::layers::layer::Layer;
use crate::layers::seat;
use crate::layout::Layout;
use crate::record::{Record, Words};

/// The front maps, each with its own galpixels, and where the layers had and have their seats.
pub(super) struct Shown<'s, 'p, L, B, const HIDDEN: usize> {
    pub front: &'s Galpixmap<'p, L, B>,
    pub hidden: &'s [Layer<'p, L, B>; HIDDEN],
}

impl<L: Layout, B: Budget<L>, const HIDDEN: usize> Around for Shown<'_, '_, L, B, HIDDEN> {
    #[inline(always)]
    fn record(&self) -> &Record {
        self.front.record()
    }

    #[inline(always)]
    fn before(&self, cell: u32) -> Option<Words> {
        let mut shown = self.front.words_at(cell)?;
        for layer in self.hidden {
            let seated = seat::bit(layer.seats_before(), cell);
            shown = choose_words(self.front.record(), seated, &layer.front.words_at(cell)?, &shown);
        }
        Some(shown)
    }

    #[inline(always)]
    fn foreign(&self, cell: u32) -> u32 {
        self.hidden.iter().fold(0, |foreign, layer| foreign | seat::bit(layer.seats(), cell))
    }
}
