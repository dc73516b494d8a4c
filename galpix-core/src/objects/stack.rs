//! Targets of objects: one map or several layers.

use crate::format::Format;
use crate::frame::Controller;
use crate::layers::Layers;
use crate::map::Galpixmap;

/// Maps over one grid that move together, and their frame counter.
pub trait Stack<'p, F> {
    /// Returns the map that is shown.
    fn shown(&self) -> &Galpixmap<'p, F>;

    /// Returns the frame counter.
    fn now(&self) -> u32;

    /// Returns whether there is such a layer and its galpixels move from cell to cell. Objects cannot be grafted into a
    /// stationary-source layer: it is delivered as a whole.
    fn takes(&self, layer: u32) -> bool;

    /// Returns the galpixels of a layer, `None` if there is no such layer.
    fn layer(&mut self, layer: u32) -> Option<&mut Galpixmap<'p, F>>;
}

impl<'p, F: Format> Stack<'p, F> for Controller<'p, F> {
    fn shown(&self) -> &Galpixmap<'p, F> {
        self.front()
    }

    fn now(&self) -> u32 {
        self.frame()
    }

    fn takes(&self, layer: u32) -> bool {
        layer == 0
    }

    fn layer(&mut self, layer: u32) -> Option<&mut Galpixmap<'p, F>> {
        if layer == 0 { Some(self.front_mut()) } else { None }
    }
}

impl<'p, F: Format> Stack<'p, F> for Layers<'p, '_, F> {
    fn shown(&self) -> &Galpixmap<'p, F> {
        self.front()
    }

    fn now(&self) -> u32 {
        self.frame()
    }

    fn takes(&self, layer: u32) -> bool {
        layer as usize <= self.hidden().len() && !self.is_stationary(layer as usize)
    }

    fn layer(&mut self, layer: u32) -> Option<&mut Galpixmap<'p, F>> {
        self.layer_mut(layer as usize)
    }
}
