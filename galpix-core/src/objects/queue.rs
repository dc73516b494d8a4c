//! Renderings that have arrived and wait for a frame boundary, in memory that is bounded beforehand.

use heapless::Deque;
use heapless::deque::DequeView;

use crate::error::SetupError;
use crate::format::Format;
use crate::format::rounding::Rounding;
use crate::objects::{Object, ObjectsTally, Refusal, Refusals, Stack, replace};

/// What a queue takes, beside the number of renderings that may wait, which its type says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limits {
    /// Cells of one rendering's rectangle.
    pub cells_each: u32,
    /// Cells of all renderings that wait.
    pub cells: u32,
    /// Frames from a rendering's stamp until it enters.
    pub age: u32,
}

/// The place of a rendering that waits.
#[derive(Clone, Copy, Debug)]
pub struct Pending {
    tag: u32,
    layer: u32,
    stamp: u32,
    /// Within the map, whose sides are at most 2^15.
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

/// Places for `N` renderings that wait.
pub type Places<const N: usize> = Deque<Pending, N>;

/// Renderings that wait, first come, first served; their galpixels lie in a ring over a caller-provided buffer.
#[derive(Debug)]
pub struct Queue<'q, F> {
    format: F,
    limits: Limits,
    pending: &'q mut DequeView<Pending>,
    ring: &'q mut [u32],
    /// Where the first rendering's words begin, and how many words all have.
    head: usize,
    used: usize,
    /// Cells that still fit.
    left: u32,
    refusals: Refusals,
}

impl<'q, F: Format> Queue<'q, F> {
    /// Words of memory for `cells` cells that wait.
    #[must_use]
    pub fn words(format: F, cells: u32) -> usize {
        format.record().words().saturating_mul(cells as usize)
    }

    /// An empty queue for maps of a layout and budget.
    ///
    /// *Errors:* a layout without a tag lane, memory shorter than [`Self::words`] of `limits.cells`.
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

    /// Takes a new rendering of an object, to enter at one of the next frame boundaries. Its words are copied.
    ///
    /// *Errors:* see [`Refusal`]; a refused rendering is counted, and whatever was there stays.
    pub fn submit<'p>(&mut self, stack: &impl Stack<'p, F>, object: &Object, words: &[u32]) -> Result<(), Refusal> {
        let checked = self.checked(stack, object, words);
        match checked {
            Ok(pending) => {
                // Not full, as was checked.
                let _ = self.pending.push_back(pending);
                self.write(words);
                self.left -= pending.cells;
            }
            Err(refusal) => self.refusals.count(refusal),
        }
        checked.map(|_| ())
    }

    fn checked<'p>(&self, stack: &impl Stack<'p, F>, object: &Object, words: &[u32]) -> Result<Pending, Refusal> {
        let record = self.format.record();
        let Object { tag, layer, stamp, place, size } = *object;
        let bits = u32::from(record.tag().bits);
        if bits < 32 && tag >> bits != 0 {
            return Err(Refusal::Tag { tag, bits });
        }
        if !stack.takes(layer) {
            return Err(Refusal::Layer { layer });
        }
        let grid = stack.shown().grid();
        let [right, bottom] = [place[0].saturating_add(size[0]), place[1].saturating_add(size[1])];
        if right > grid.width() || bottom > grid.height() {
            return Err(Refusal::Place { place, size });
        }
        // Within the map, so that the product is at most its number of cells.
        let cells = size[0].wrapping_mul(size[1]);
        let most = self.limits.cells_each.min(self.limits.cells);
        if cells > most {
            return Err(Refusal::Cells { cells, most });
        }
        let (need, have) = (record.words().wrapping_mul(cells as usize), words.len());
        if need != have {
            return Err(Refusal::Words { need, have });
        }
        let age = stack.now().wrapping_sub(stamp);
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

    /// Replaces the objects whose renderings wait, first come, first served, at a frame boundary. No rendering is begun that
    /// would bring the cells of this call above `most`, but the first one: an object is replaced as a whole or not yet. So a
    /// call handles at most `most` or [`Limits::cells_each`] cells, whichever is more, each with at most [`Limits::age`] steps.
    ///
    /// A rendering that has become too old, or whose layer is gone, is dropped and counted, see [`Self::refusals`].
    pub fn apply<'p>(&mut self, stack: &mut impl Stack<'p, F>, rounding: Rounding, most: u32) -> ObjectsTally {
        let now = stack.now();
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
            } else if let Some(map) = stack.layer(object.layer) {
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

    /// Renderings that wait.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.pending.storage_len()
    }

    /// Cells that the memory still has room for.
    #[must_use]
    pub const fn left(&self) -> u32 {
        self.left
    }

    /// The limits.
    #[must_use]
    pub const fn limits(&self) -> Limits {
        self.limits
    }

    /// What was refused since the queue was made.
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

/// A place in a ring of `len` words, of a number below twice that.
const fn wrapped(place: usize, len: usize) -> usize {
    if place >= len { place - len } else { place }
}

/// `words` words of a ring from `head` on: up to its end, and from its beginning.
fn slices(ring: &[u32], head: usize, words: usize) -> (&[u32], &[u32]) {
    let above = ring.get(head..).unwrap_or_default();
    match above.get(..words) {
        Some(whole) => (whole, &[]),
        None => (above, ring.get(..words - above.len()).unwrap_or_default()),
    }
}
