//! Grafting objects: a new rendering of one object replaces that object's galpixels while everything else moves on.
//!
//! "One must remove the 'global-update' philosophy of most current VR rendering systems and implement display buffers
//! that allow individual objects' images to be grafted onto the existing (propagating) galpixmap. This may necessitate
//! the use of object tags" (J. P. Costella, "Motion Extrapolation at the Pixel Level", 1993, the end).
//!
//! Here an object is a tag in a layer. Its new rendering is a rectangle of galpixels that are exact at one frame, its
//! *stamp*. When it arrives the map has moved on, so it enters in two steps:
//!
//! 1. Every galpixel of the layer with the object's tag, debris too, becomes empty. The cell is a hole only if no other
//!    layer holds a galpixel there.
//! 2. Each new galpixel makes the steps that it has missed, with their thresholds, and enters the cell that it has
//!    reached. There the smallest by class and depth stays, as in [`crate::stages::sweep`]; of equal ones the one that
//!    was there.
//!
//! So the objects of one picture are updated at different rates, and an object that was covered reappears from its own
//! layer without a new rendering (see [`crate::layers`]): the layer acts as a cache. [`graft()`](crate::graft()) is for
//! streams of single galpixels that replace whatever is there.
//!
//! Renderings wait in a bounded [`Queue`]. A rendering that does not fit in is refused with a reason and counted;
//! nothing that was there is lost.
//!
//! *Cost* per rendering: a search of all cells of its layer, and a step for each of its galpixels and each frame that
//! it is late. The work depends on the renderings, not on the picture.

pub(crate) mod graft;
mod queue;
mod refusal;
mod remove;

pub use graft::Delay;
pub use queue::{Limits, Pending, Places, Queue};
pub use refusal::{Refusal, Refusals};

use crate::format::Format;
use crate::format::record::MAX_WORDS;
use crate::format::rounding::Rounding;
use crate::frame::resolve;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;
use crate::objects::graft::catch_up;

/// An object's new rendering, without its galpixels.
///
/// The galpixels are the words of a rectangle of cells, row by row from its top left corner, all words of a cell
/// together, as [`Galpixmap::stored`] returns them. Their own tags are ignored: all get the tag of the object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Object {
    /// The object's tag; it must fit the layout's tag field.
    pub tag: u32,
    /// The object's layer; 0 is the base.
    pub layer: u32,
    /// The frame counter at which the rendering is exact.
    pub stamp: u32,
    /// Column and row of the rectangle's top left corner in the map, margin included.
    pub place: [u32; 2],
    /// Columns and rows of the rectangle. If one of them is 0 the object is removed.
    pub size: [u32; 2],
}

/// Counts of renderings that entered a map. Each cell of their rectangles counts as one of `put`, `behind`, `lost` and
/// `empty`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ObjectsTally {
    /// Renderings that replaced their objects.
    pub renderings: u32,
    /// Cells that held the objects before and were made empty.
    pub removed: u32,
    /// New galpixels that are in the map.
    pub put: u32,
    /// New galpixels that lost against a nearer one, of another object or of their own.
    pub behind: u32,
    /// New galpixels that have left the map by now.
    pub lost: u32,
    /// Cells of the rectangles that held nothing.
    pub empty: u32,
    /// Galpixels and debris of other objects that lost their cells to the new ones: gone, as after any collision.
    pub replaced: u32,
    /// Fields of new galpixels that were clamped in the missed steps.
    pub saturated: u32,
}

impl ObjectsTally {
    fn add(&mut self, other: &Self) {
        let fields = [
            (&mut self.renderings, other.renderings),
            (&mut self.removed, other.removed),
            (&mut self.put, other.put),
            (&mut self.behind, other.behind),
            (&mut self.lost, other.lost),
            (&mut self.empty, other.empty),
            (&mut self.replaced, other.replaced),
            (&mut self.saturated, other.saturated),
        ];
        for (sum, more) in fields {
            *sum = sum.saturating_add(more);
        }
    }
}

/// Replaces an object in a map whose frame counter is `now`, without a [`Queue`]. Ignores `object.layer`.
///
/// `words` are those of the rectangle, see [`Object`]. If there are too few, the rendering ends with them; surplus
/// words are not read. The layout must have a tag: otherwise every galpixel counts as tagged 0. [`Queue`] checks that,
/// and bounds the cells of a rendering and the frames that it may be late.
pub fn replace<F: Format>(
    map: &mut Galpixmap<'_, F>,
    object: &Object,
    words: impl IntoIterator<Item = u32>,
    rounding: Rounding,
    now: u32,
) -> ObjectsTally {
    let mut tally = ObjectsTally { renderings: 1, removed: remove::by_tag(map, object.tag), ..ObjectsTally::default() };
    let format = map.format();
    let record = format.record();
    let mut words = words.into_iter();
    let delay = Delay { stamp: object.stamp, now, rounding };
    let [left, top] = object.place;
    for y in (top..).take(object.size[1] as usize) {
        for x in (left..).take(object.size[0] as usize) {
            let mut galpixel = [0; MAX_WORDS];
            for to in galpixel.iter_mut().take(record.words()) {
                let Some(word) = words.next() else { return tally };
                *to = word;
            }
            record.tag().set(&mut galpixel, object.tag);
            if record.class().unsigned(&galpixel) == Class::Empty as u32 {
                tally.empty += 1;
                continue;
            }
            let place = (x as i32, y as i32);
            let (reached, saturated) = catch_up(map, place, &mut galpixel, delay);
            tally.saturated += saturated;
            let Some((cell, incumbent)) = reached.and_then(|cell| Some((cell, map.words_at(cell)?))) else {
                tally.lost += 1;
                continue;
            };
            if resolve::key(record, &galpixel) >= resolve::key(record, &incumbent) {
                tally.behind += 1;
                continue;
            }
            map.put(cell, &galpixel);
            let there = record.class().unsigned(&incumbent) != Class::Empty as u32;
            if there && record.tag().unsigned(&incumbent) == object.tag {
                // A galpixel of the same rendering: all others of this tag are gone.
                tally.behind += 1;
            } else {
                tally.put += 1;
                tally.replaced += there as u32;
            }
        }
    }
    tally
}
