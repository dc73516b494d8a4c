//! Steps a chunk field by field, for formats chosen at run time.
//!
//! The positions of the fields are then variables, which prevent vector code in a loop over galpixels. In a loop over
//! the lanes of a single field they are constant. The arithmetic is that of [`crate::frame::step::advance`] without
//! clamps.

use super::CHUNK;
use crate::format::record::{Extract, Field, MAX_WORDS, Record};
use crate::frame::step::{snap, step_position, step_velocity};
use crate::map::galpixel::Class;

/// A field of all lanes.
type Lanes = [i32; CHUNK];

/// `words[word][lane]`.
type Chunk = [[u32; CHUNK]; MAX_WORDS];

/// Extracts a field of all lanes with `extract_with`.
#[inline(always)]
pub(super) fn unpack(field: Field, words: &Chunk, lanes: &mut Lanes, extract_with: impl Fn(Extract, u32, u32) -> i32) {
    if !field.present() {
        *lanes = [0; CHUNK];
        return;
    }
    let (upper, lower) = field.words();
    let extract = field.extract();
    for ((lane, &upper), &lower) in lanes.iter_mut().zip(&words[upper]).zip(&words[lower]) {
        *lane = extract_with(extract, upper, lower);
    }
}

/// Extracts a field of all lanes as two's complement numbers.
#[inline(never)]
fn unpack_signed(field: Field, words: &Chunk, lanes: &mut Lanes) {
    unpack(field, words, lanes, |extract, upper, lower| extract.signed(upper, lower));
}

/// Extracts a field of all lanes as unsigned numbers.
#[inline(never)]
fn unpack_unsigned(field: Field, words: &Chunk, lanes: &mut Lanes) {
    unpack(field, words, lanes, |extract, upper, lower| extract.unsigned(upper, lower) as i32);
}

/// Replaces a field of all lanes by the low bits of `lanes`.
#[inline(never)]
fn pack(field: Field, words: &mut Chunk, lanes: &Lanes) {
    if !field.present() {
        return;
    }
    let (upper, lower) = field.words();
    let (mask, shift, spill) = field.upper_mask();
    for (word, &lane) in words[upper].iter_mut().zip(lanes) {
        *word = *word & !mask | (lane as u32 >> spill) << shift & mask;
    }
    if spill != 0 {
        let (keep, shift) = (u32::MAX >> spill, 32 - spill);
        for (word, &lane) in words[lower].iter_mut().zip(lanes) {
            *word = *word & keep | (lane as u32) << shift;
        }
    }
}

/// A step of a chunk, and memory for three fields of its lanes.
pub(super) struct Planes<'c> {
    record: &'c Record,
    thresholds: &'c [i32; 3],
    words: &'c mut Chunk,
    position: Lanes,
    v: Lanes,
    a: Lanes,
    /// Not 0 if a velocity or a depth of any lane left its field.
    overflowed: i32,
}

impl<'c> Planes<'c> {
    /// Prepares a step of the chunk `words`.
    pub fn new(record: &'c Record, thresholds: &'c [i32; 3], words: &'c mut Chunk) -> Self {
        let none = [0; CHUNK];
        Self { record, thresholds, words, position: none, v: none, a: none, overflowed: 0 }
    }

    /// Propagates all galpixels by one frame. Writes the displacements in cells into `dx` and `dy` and the keys after
    /// the step into `keys`. Returns a number that is not 0 if a field of any galpixel overflowed.
    pub fn step(mut self, dx: &mut Lanes, dy: &mut Lanes, keys: &mut [u32; CHUNK]) -> i32 {
        self.step_plane::<0>(dx);
        self.step_plane::<1>(dy);
        self.step_depth();
        self.step_luminosity();
        self.step_class(dx, keys);
        self.overflowed
    }

    /// Steps x (0) or y (1).
    fn step_plane<const COMPONENT: usize>(&mut self, moved: &mut Lanes) {
        let record = self.record;
        if !record.velocity(COMPONENT).present() {
            *moved = [0; CHUNK];
            return;
        }
        let offset = if COMPONENT == 0 { record.offset_x() } else { record.offset_y() };
        unpack_signed(offset, self.words, &mut self.position);
        self.step_component::<COMPONENT>();
        for (moved, &position) in moved.iter_mut().zip(&self.position) {
            *moved = snap(&record.scales[COMPONENT], position);
        }
        pack(offset, self.words, &self.position);
    }

    /// Steps the depth.
    fn step_depth(&mut self) {
        let record = self.record;
        if !record.velocity(2).present() {
            return;
        }
        unpack_unsigned(record.depth(), self.words, &mut self.position);
        self.step_component::<2>();
        let far = ((1u32 << record.depth().bits) - 1) as i32;
        self.overflowed |= self.position.iter().fold(0, |overflowed, position| overflowed | position & !far);
        pack(record.depth(), self.words, &self.position);
    }

    /// Steps `position` and the velocity of a component.
    fn step_component<const COMPONENT: usize>(&mut self) {
        let (record, threshold) = (self.record, self.thresholds[COMPONENT]);
        let scale = record.scales[COMPONENT];
        let (velocity, acceleration) = (record.velocity(COMPONENT), record.acceleration(COMPONENT));
        unpack_signed(velocity, self.words, &mut self.v);
        unpack_signed(acceleration, self.words, &mut self.a);
        for ((position, &v), &a) in self.position.iter_mut().zip(&self.v).zip(&self.a) {
            *position = step_position(&scale, threshold, *position, v, a);
        }
        if acceleration.present() {
            let unused = 32 - scale.velocity_bits;
            let mut overflowed = 0;
            for (v, &a) in self.v.iter_mut().zip(&self.a) {
                *v = step_velocity(&scale, *v, a);
                overflowed |= *v ^ (*v << unused >> unused);
            }
            self.overflowed |= overflowed;
            pack(velocity, self.words, &self.v);
        }
    }

    /// Steps the luminosity (shading inertia).
    fn step_luminosity(&mut self) {
        let record = self.record;
        if !record.layout().luminosity || !record.luminosity_rate().present() {
            return;
        }
        unpack_signed(record.luminosity_rate(), self.words, &mut self.v);
        unpack_unsigned(record.luminosity(), self.words, &mut self.position);
        unpack_unsigned(record.colour(), self.words, &mut self.a);
        for ((level, &rate), colour) in self.position.iter_mut().zip(&self.v).zip(&mut self.a) {
            *level += rate;
            *colour = record.colour_format().brightened(*colour as u32, *level >> record.luminosity_frac) as i32;
        }
        pack(record.luminosity(), self.words, &self.position);
        pack(record.colour(), self.words, &self.a);
    }

    /// Steps the class: just-unobscured becomes debris. Writes the keys, and inverts the bit of `dx` for empty cells.
    fn step_class(&mut self, dx: &mut Lanes, keys: &mut [u32; CHUNK]) {
        let record = self.record;
        unpack_unsigned(record.class(), self.words, &mut self.v);
        unpack_unsigned(record.depth(), self.words, &mut self.position);
        let lanes = self.v.iter_mut().zip(&self.position);
        for (((class, &depth), key), dx) in lanes.zip(keys).zip(dx) {
            *class += (*class == Class::JustUnobscured as i32) as i32;
            *key = (*class as u32) << record.depth().bits | depth as u32;
            *dx ^= ((*class == Class::Empty as i32) as i32) << super::EMPTY_BIT;
        }
        pack(record.class(), self.words, &self.v);
    }
}
