//! A galpixmap as a scene for metamers.

use super::scene::Scene;
use super::steerable::COLUMNS;
use super::surroundings::Row;
use super::tone::Tone;
use crate::format::Format;
use crate::inpaint::map::{Uncovered, pyramid_depth};
use crate::map::galpixel::Class;

impl<F: Format> Scene for Uncovered<'_, '_, F, Tone> {
    fn each_hole(&mut self, mut hole: impl FnMut(u32, u32)) {
        Uncovered::each_hole(self, |_, x, y, _| hole(x, y));
    }

    #[inline]
    fn row(&self, left: u32, y: u32, cells: &mut Row) {
        let Some(row) = self.map.grid().row(y as i32) else { return };
        let count = ((self.map.grid().width() - left) as usize).min(COLUMNS);
        let (first, bits) = ((row + left) as usize, u32::from(self.map.record().depth().bits));
        let (mut keys, mut colours) = ([0; COLUMNS], [0; COLUMNS]);
        for (to, key) in keys.iter_mut().zip(self.map.keys(first..first + count)) {
            *to = key;
        }
        for (to, colour) in colours.iter_mut().zip(self.map.colours(first..first + count)) {
            *to = colour;
        }
        let read = self.reader();
        for x in 0..COLUMNS {
            let depth = pyramid_depth(keys[x] & ((1 << bits) - 1), bits);
            let class = keys[x] >> bits;
            cells.depths[x] = if class == Class::Empty as u32 { 0 } else { depth as i32 };
            // Galpixels and debris: the classes without the lower bit.
            cells.known[x] = (class & 1) as i32 - 1;
            let [luma, blue, red] = read(colours[x], 0).channels;
            cells.channels[0][x] = luma;
            cells.channels[1][x] = blue;
            cells.channels[2][x] = red;
        }
    }

    #[inline]
    fn depth(&self, x: u32, y: u32) -> u32 {
        let bits = u32::from(self.map.record().depth().bits);
        let key = self.map.grid().cell(x as i32, y as i32).and_then(|cell| self.map.key_at(cell));
        key.map_or(0, |key| pyramid_depth(key & ((1 << bits) - 1), bits))
    }

    #[inline]
    fn source(&self, x: u32, y: u32) -> u32 {
        self.map.grid().cell(x as i32, y as i32).unwrap_or_default()
    }

    fn displacement(&self, source: u32, age: u32) -> [i32; 2] {
        if !self.map.record().layout().velocity {
            return [0; 2];
        }
        let Some(words) = self.map.words_at(source) else { return [0; 2] };
        let (record, age) = (self.map.record(), i64::from(age.min(0xffff)));
        [0, 1].map(|component| {
            let scale = &record.scales[component];
            let v = i64::from(record.velocity(component).signed(&words));
            let a = i64::from(record.acceleration(component).signed(&words)) << scale.acceleration_up;
            let twice = 2 * v * age - a * age * age;
            ((twice + (1 << scale.velocity_frac)) >> (scale.velocity_frac + 1)) as i32
        })
    }

    fn put(&mut self, x: u32, y: u32, tone: Tone) {
        let Some(cell) = self.map.grid().cell(x as i32, y as i32) else { return };
        self.set(cell, tone);
    }
}
