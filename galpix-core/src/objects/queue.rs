//! Queue of renderings that wait for a frame boundary, in caller-provided buffers of fixed size.

use heapless::Deque;
use heapless::deque::DequeView;

use crate::error::SetupError;
use crate::format::Format;
use crate::format::rounding::Rounding;
use crate::maps::Maps;
use crate::objects::{Object, ObjectsTally, Refusal, Refusals, replace};

/// Limits of a queue. The number of renderings that may wait is that of its [`Places`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limits {
    /// Most cells of one rendering's rectangle; at most `cells` in any case.
    pub cells_each: u32,
    /// Most cells of all renderings that wait.
    pub cells: u32,
    /// Most frames from a rendering's stamp until it enters the map.
    pub age: u32,
}

/// A rendering that waits, without its galpixels.
#[derive(Clone, Copy, Debug)]
pub struct Pending {
    tag: u32,
    layer: u32,
    stamp: u32,
    /// 16 bits: within the map, whose sides are at most 2^15.
    place: [u16; 2],
    size: [u16; 2],
    cells: u32,
    words: u32,
}

impl Pending {
    const fn object(&self) -> Object {
        let Self { tag, layer, stamp, place: [x, y], size: [width, height], .. } = *self;
        Object { tag, layer, stamp, place: [x as u32, y as u32], size: [width as u32, height as u32] }
    }
}

/// Memory for `N` renderings that wait.
pub type Places<const N: usize> = Deque<Pending, N>;

/// A first-in, first-out queue of renderings. Their galpixels are in a ring over a caller-provided buffer.
#[derive(Debug)]
pub struct Queue<'q, F> {
    format: F,
    limits: Limits,
    pending: &'q mut DequeView<Pending>,
    ring: &'q mut [u32],
    /// Index of the first rendering's first word.
    head: usize,
    /// Words of all renderings that wait.
    used: usize,
    /// Cells that still fit in.
    left: u32,
    refusals: Refusals,
}

impl<'q, F: Format> Queue<'q, F> {
    /// Returns the words of memory that `cells` waiting cells need.
    #[must_use]
    pub fn words(format: F, cells: u32) -> usize {
        format.record().words().saturating_mul(cells as usize)
    }

    /// Creates an empty queue for maps of a format. `memory` holds the words of waiting renderings.
    ///
    /// *Errors:* a layout without a tag, `memory` shorter than [`Self::words`] of `limits.cells`.
    pub fn new(
        format: F,
        limits: Limits,
        places: &'q mut DequeView<Pending>,
        memory: &'q mut [u32],
    ) -> Result<Self, SetupError> {
        if !format.record().tag().present() {
            return Err(SetupError::NoTag);
        }
        let (need, have) = (Self::words(format, limits.cells), memory.len());
        let Some(ring) = memory.get_mut(..need) else {
            return Err(SetupError::TooShort { plane: "memory of waiting renderings", need, have });
        };
        places.clear();
        Ok(Self {
            format,
            limits,
            pending: places,
            ring,
            head: 0,
            used: 0,
            left: limits.cells,
            refusals: Refusals::default(),
        })
    }

    /// Appends a new rendering of an object, which enters its layer in a later [`Self::apply`]. Copies `words`.
    ///
    /// *Errors:* see [`Refusal`]. A refused rendering is counted and changes nothing else.
    pub fn submit<'p>(
        &mut self,
        maps: &impl Maps<'p, Format = F>,
        object: &Object,
        words: &[u32],
    ) -> Result<(), Refusal> {
        let checked = self.checked(maps, object, words);
        match checked {
            Ok(pending) => {
                // `checked` has found a free place.
                let _ = self.pending.push_back(pending);
                self.write(words);
                self.left -= pending.cells;
            }
            Err(refusal) => self.refusals.count(refusal),
        }
        checked.map(|_| ())
    }

    fn checked<'p>(
        &self,
        maps: &impl Maps<'p, Format = F>,
        object: &Object,
        words: &[u32],
    ) -> Result<Pending, Refusal> {
        let record = self.format.record();
        let Object { tag, layer, stamp, place, size } = *object;
        let bits = u32::from(record.tag().bits);
        if bits < 32 && tag >> bits != 0 {
            return Err(Refusal::Tag { tag, bits });
        }
        if !maps.takes(layer as usize) {
            return Err(Refusal::Layer { layer });
        }
        let grid = maps.shown().grid();
        let [right, bottom] = [place[0].saturating_add(size[0]), place[1].saturating_add(size[1])];
        if right > grid.width() || bottom > grid.height() {
            return Err(Refusal::Place { place, size });
        }
        // Does not wrap: the rectangle is within the map.
        let cells = size[0].wrapping_mul(size[1]);
        let most = self.limits.cells_each.min(self.limits.cells);
        if cells > most {
            return Err(Refusal::Cells { cells, most });
        }
        let (need, have) = (record.words().wrapping_mul(cells as usize), words.len());
        if need != have {
            return Err(Refusal::Words { need, have });
        }
        let age = maps.frame().wrapping_sub(stamp);
        if (age as i32) < 0 {
            return Err(Refusal::Ahead { frames: age.wrapping_neg() });
        }
        if age > self.limits.age {
            return Err(Refusal::Age { age, most: self.limits.age });
        }
        if self.pending.is_full() {
            return Err(Refusal::Queue { most: self.pending.storage_capacity() });
        }
        if cells > self.left {
            return Err(Refusal::Memory { cells, left: self.left });
        }
        let [place, size] = [place, size].map(|[x, y]| [x as u16, y as u16]);
        Ok(Pending { tag, layer, stamp, place, size, cells, words: need as u32 })
    }

    /// Replaces objects by the renderings that wait, in their order, at a frame boundary.
    ///
    /// Stops before a rendering that would raise the cells of this call above `most`, unless it is the first one: an
    /// object is replaced as a whole. A rendering that has become too old, or whose layer no longer exists, is dropped
    /// and counted in [`Self::refusals`].
    ///
    /// *Cost:* at most `most` or [`Limits::cells_each`] cells, whichever is more, with at most [`Limits::age`] steps
    /// each. For each rendering all cells of its layer are searched for the tag.
    pub fn apply<'p>(&mut self, maps: &mut impl Maps<'p, Format = F>, rounding: Rounding, most: u32) -> ObjectsTally {
        let now = maps.frame();
        let (mut tally, mut handled) = (ObjectsTally::default(), 0u32);
        while let Some(&pending) = self.pending.front() {
            let begun = tally.renderings != 0;
            let (object, cells, words) = (pending.object(), pending.cells, pending.words as usize);
            if begun && handled.saturating_add(cells) > most {
                break;
            }
            let age = now.wrapping_sub(object.stamp);
            if age > self.limits.age {
                self.refusals.count(Refusal::Age { age, most: self.limits.age });
            } else if let Some(map) = maps.layer_mut(object.layer as usize) {
                let (first, rest) = slices(self.ring, self.head, words);
                tally.add(&replace(map, &object, first.iter().chain(rest).copied(), rounding, now));
                handled = handled.saturating_add(cells);
            } else {
                self.refusals.count(Refusal::Layer { layer: object.layer });
            }
            self.pending.pop_front();
            self.head = wrapped(self.head + words, self.ring.len());
            self.used -= words;
            self.left += cells;
        }
        tally
    }

    /// Returns the number of renderings that wait.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.pending.storage_len()
    }

    /// Returns the number of cells that still fit in.
    #[must_use]
    pub const fn left(&self) -> u32 {
        self.left
    }

    /// Returns the counts of refused renderings since the queue was created.
    #[must_use]
    pub const fn refusals(&self) -> Refusals {
        self.refusals
    }

    fn write(&mut self, words: &[u32]) {
        let start = wrapped(self.head + self.used, self.ring.len());
        let (below, above) = self.ring.split_at_mut_checked(start).unwrap_or_default();
        for (to, &word) in above.iter_mut().chain(below).zip(words) {
            *to = word;
        }
        self.used += words.len();
    }
}

/// Returns `place` modulo `len`, for a place below `2 * len`.
const fn wrapped(place: usize, len: usize) -> usize {
    if place >= len { place - len } else { place }
}

/// Returns `words` words of a ring from `head` on in two parts: up to the end of the ring, and from its beginning.
fn slices(ring: &[u32], head: usize, words: usize) -> (&[u32], &[u32]) {
    let above = ring.get(head..).unwrap_or_default();
    match above.get(..words) {
        Some(whole) => (whole, &[]),
        None => (above, ring.get(..words - above.len()).unwrap_or_default()),
    }
}
