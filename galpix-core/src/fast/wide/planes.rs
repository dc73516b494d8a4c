//! The step of a chunk, field by field: for budgets chosen at run time.
//!
//! Where a field lies is then a variable. In a loop over galpixels such variables end vector code; in a loop over the lanes of
//! one field they do not change. The arithmetic is that of [`crate::frame::step::advance`], without clamps.

use super::CHUNK;
use crate::format::record::{Extract, Field, MAX_WORDS, Record};
use crate::frame::step::{snap, step_position, step_velocity};
use crate::map::galpixel::Class;

/// One field of all lanes.
type Lanes = [i32; CHUNK];

/// `words[word][lane]`.
type Chunk = [[u32; CHUNK]; MAX_WORDS];

/// Takes a field out of all lanes with `take`.
#[inline(always)]
fn unpack(field: Field, words: &Chunk, lanes: &mut Lanes, take: impl Fn(Extract, u32, u32) -> i32) {
    if !field.present() {
        *lanes = [0; CHUNK];
        return;
    }
    let (upper, lower) = field.words();
    let extract = field.extract();
    for ((lane, &upper), &lower) in lanes.iter_mut().zip(&words[upper]).zip(&words[lower]) {
        *lane = take(extract, upper, lower);
    }
}

#[inline(never)]
fn unpack_signed(field: Field, words: &Chunk, lanes: &mut Lanes) {
    unpack(field, words, lanes, |extract, upper, lower| extract.signed(upper, lower));
}

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

/// What a step of a chunk is made with, and memory for three fields of it.
pub(super) struct Planes<'c> {
    record: &'c Record,
    thresholds: &'c [i32; 3],
    words: &'c mut Chunk,
    position: Lanes,
    v: Lanes,
    a: Lanes,
    /// The bits by which a velocity or a depth of any lane left its field.
    overflowed: i32,
}

impl<'c> Planes<'c> {
    pub fn new(record: &'c Record, thresholds: &'c [i32; 3], words: &'c mut Chunk) -> Self {
        let none = [0; CHUNK];
        Self { record, thresholds, words, position: none, v: none, a: none, overflowed: 0 }
    }

    /// Moves all galpixels forward by one frame: the cells moved in `dx` and `dy`, the keys after the step in `keys`, and by
    /// which bits fields of any of them overflowed.
    pub fn step(mut self, dx: &mut Lanes, dy: &mut Lanes, keys: &mut [u32; CHUNK]) -> i32 {
        self.step_plane::<0>(dx);
        self.step_plane::<1>(dy);
        self.step_depth();
        self.step_luminosity();
        self.age(dx, keys);
        self.overflowed
    }

    /// A step in x (0) or y (1).
    fn step_plane<const COMPONENT: usize>(&mut self, moved: &mut Lanes) {
        let record = self.record;
        if !record.velocity(COMPONENT).present() {
            *moved = [0; CHUNK];
            return;
        }
        let offset = if COMPONENT == 0 { record.offset_x() } else { record.offset_y() };
        unpack_signed(offset, self.words, &mut self.position);
        self.move_on::<COMPONENT>();
        for (moved, &position) in moved.iter_mut().zip(&self.position) {
            *moved = snap(&record.scales[COMPONENT], position);
        }
        pack(offset, self.words, &self.position);
    }

    /// A step in depth.
    fn step_depth(&mut self) {
        let record = self.record;
        if !record.velocity(2).present() {
            return;
        }
        unpack_unsigned(record.depth(), self.words, &mut self.position);
        self.move_on::<2>();
        let far = ((1u32 << record.depth().bits) - 1) as i32;
        self.overflowed |= self.position.iter().fold(0, |overflowed, position| overflowed | position & !far);
        pack(record.depth(), self.words, &self.position);
    }

    /// Takes `position` and the velocity of a component one frame further.
    fn move_on<const COMPONENT: usize>(&mut self) {
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

    /// Shading inertia.
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

    /// What was just unobscured is debris from now on. Class and depth as keys, and a way of their own for empty cells.
    fn age(&mut self, dx: &mut Lanes, keys: &mut [u32; CHUNK]) {
        let record = self.record;
        unpack_unsigned(record.class(), self.words, &mut self.v);
        unpack_unsigned(record.depth(), self.words, &mut self.position);
        let lanes = self.v.iter_mut().zip(&self.position);
        for (((class, &depth), key), dx) in lanes.zip(keys).zip(dx) {
            *class += (*class == Class::JustUnobscured as i32) as i32;
            *key = (*class as u32) << record.depth().bits | depth as u32;
            *dx ^= ((*class == Class::Empty as i32) as i32) << super::NOWHERE;
        }
        pack(record.class(), self.words, &self.v);
    }
}
