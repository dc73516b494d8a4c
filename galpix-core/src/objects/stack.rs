//! What objects can be grafted into: one map or several layers.

use crate::frame::Controller;
use crate::galpixel::Budget;
use crate::galpixmap::Galpixmap;
use crate::layers::Layers;
use crate::layout::Layout;

/// Maps of one grid that move together, and their frame counter.
pub trait Stack<'p, L, B> {
    /// The map that is shown.
    fn shown(&self) -> &Galpixmap<'p, L, B>;

    /// The frame counter.
    fn now(&self) -> u32;

    /// Whether there is such a layer, and its galpixels move from cell to cell. Into an anchored layer nothing is grafted: it is
    /// delivered as a whole.
    fn takes(&self, layer: u32) -> bool;

    /// The galpixels of a layer; nothing if there is no such layer.
    fn layer(&mut self, layer: u32) -> Option<&mut Galpixmap<'p, L, B>>;
}

impl<'p, L: Layout, B: Budget<L>> Stack<'p, L, B> for Controller<'p, L, B> {
    fn shown(&self) -> &Galpixmap<'p, L, B> {
        self.front()
    }

    fn now(&self) -> u32 {
        self.frame()
    }

    fn takes(&self, layer: u32) -> bool {
        layer == 0
    }

    fn layer(&mut self, layer: u32) -> Option<&mut Galpixmap<'p, L, B>> {
        if layer == 0 { Some(self.front_mut()) } else { None }
    }
}

impl<'p, L: Layout, B: Budget<L>, const HIDDEN: usize> Stack<'p, L, B> for Layers<'p, L, B, HIDDEN> {
    fn shown(&self) -> &Galpixmap<'p, L, B> {
        self.front()
    }

    fn now(&self) -> u32 {
        self.frame()
    }

    fn takes(&self, layer: u32) -> bool {
        layer as usize <= HIDDEN && !self.is_anchored(layer as usize)
    }

    fn layer(&mut self, layer: u32) -> Option<&mut Galpixmap<'p, L, B>> {
        self.layer_mut(layer as usize)
    }
}
