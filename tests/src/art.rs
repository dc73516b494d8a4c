//! Maps drawn as text: one panel for each thing that can be seen, side by side, and a diff where they are not as
//! expected.
//!
//! ```text
//! AB.a   35.0   >>.-
//! colour depth  motion
//! ```
//!
//! In every panel `.` is a hole. Colour: a letter, upper case for a galpixel, lower case for debris. Class: `#`
//! galpixel, `!` just unobscured, `~` debris. Depth: sixteenths of the range, `*` for the far end. Motion: the velocity
//! in cells per frame, see [`MOTIONS`]; `-` is still and `?` anything else. Shown: the letter of the colour that the
//! display shows, be there a galpixel or not, `_` for black.

use std::fmt;

use galpix_core::{Bits, Class, Controller, Demand, Dynamic, Format, Galpixel, Galpixmap, Layout};

use crate::memory::{Shape, with_controller};
use crate::stage::number;

/// What can be seen of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Panel {
    /// Letters of the colours of galpixels and debris.
    Colour,
    /// Classes.
    Class,
    /// Depths.
    Depth,
    /// Velocities.
    Motion,
    /// What the display shows.
    Shown,
}

/// Velocities that have a sign.
pub const MOTIONS: [(char, [f64; 2]); 11] = [
    ('-', [0.0, 0.0]),
    ('>', [1.0, 0.0]),
    ('<', [-1.0, 0.0]),
    ('^', [0.0, -1.0]),
    ('v', [0.0, 1.0]),
    (')', [0.5, 0.0]),
    ('(', [-0.5, 0.0]),
    ('}', [2.0, 0.0]),
    ('{', [-2.0, 0.0]),
    ('r', [1.0, 1.0]),
    ('l', [-1.0, -1.0]),
];

/// The colours of `A` to `Z`: eight levels apart, so that the mean of two letters is the letter between them.
const STEP: u8 = 8;

fn level(letter: char) -> u8 {
    (letter.to_ascii_uppercase() as u8 - b'A' + 1) * STEP
}

fn letter([red, ..]: [u8; 3]) -> char {
    match red {
        0 => '_',
        _ if red % STEP == 0 && red / STEP <= 26 => char::from(b'A' + red / STEP - 1),
        _ => '?',
    }
}

fn sign(galpixel: &Galpixel, panel: Panel) -> char {
    if panel == Panel::Shown {
        return letter(galpixel.colour);
    }
    if galpixel.class == Class::Empty {
        return '.';
    }
    match panel {
        Panel::Colour if galpixel.class == Class::Galpixel => letter(galpixel.colour),
        Panel::Colour => letter(galpixel.colour).to_ascii_lowercase(),
        Panel::Class if galpixel.class == Class::Galpixel => '#',
        Panel::Class if galpixel.class == Class::JustUnobscured => '!',
        Panel::Class => '~',
        Panel::Depth => {
            let sixteenths = (galpixel.depth.to_num::<f64>() * 16.0).round() as u32;
            char::from_digit(sixteenths, 16).unwrap_or('*')
        }
        _ => {
            let [x, y, _] = galpixel.velocity.map(|v| v.to_num::<f64>());
            MOTIONS.iter().find(|(_, velocity)| *velocity == [x, y]).map_or('?', |(sign, _)| *sign)
        }
    }
}

/// A drawn map. Equal to another if every line is.
#[derive(Clone, PartialEq, Eq)]
pub struct Art(Vec<String>);

impl fmt::Debug for Art {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|line| writeln!(f, "    {line}"))
    }
}

impl Art {
    /// Draws the whole map, margin included.
    #[must_use]
    pub fn of<F: Format>(map: &Galpixmap<'_, F>, panels: &[Panel]) -> Self {
        let line = |y: u32, panel: Panel| -> String {
            let cells = (0..map.grid().width()).map(|x| map.load(x as i32, y as i32).expect("in the map"));
            cells.map(|galpixel| sign(&galpixel, panel)).collect()
        };
        let lines = 0..map.grid().height();
        Self(lines.map(|y| panels.iter().map(|&panel| line(y, panel)).collect::<Vec<_>>().join("  ")).collect())
    }

    /// Panics with both pictures and the cells that differ, unless this is the `expected` picture.
    pub fn assert(&self, what: &str, expected: &[&str]) {
        let expected = Self(expected.iter().map(|line| (*line).to_owned()).collect());
        if *self == expected {
            return;
        }
        let mut diff = String::new();
        for n in 0..self.0.len().max(expected.0.len()) {
            let [wanted, got] = [&expected, self].map(|art| art.0.get(n).map_or("", String::as_str));
            let marks: String = wanted
                .chars()
                .zip(got.chars().chain(std::iter::repeat(' ')))
                .map(|(wanted, got)| if wanted == got { ' ' } else { 'x' })
                .collect();
            diff += &format!("    {wanted}   {got}   {}\n", marks.trim_end());
        }
        panic!("{what}: expected, got, and where they differ:\n{diff}");
    }
}

/// A map as it is written down: lines of a colour, a depth and a motion panel. Lower-case letters are debris.
#[derive(Clone, Copy, Debug)]
pub struct Drawing<'d>(pub &'d [&'d str]);

impl Drawing<'_> {
    /// Returns the columns and rows.
    #[must_use]
    pub fn shape(&self) -> Shape {
        let width = self.0[0].split_whitespace().next().expect("a panel").len();
        Shape::plain(width as u32, self.0.len() as u32)
    }

    /// Stores every cell, each galpixel after `change`.
    ///
    /// Panics if panels are missing or of different widths, or if a sign means nothing.
    pub fn store<F: Format>(&self, map: &mut Galpixmap<'_, F>, change: impl Fn(&mut Galpixel)) {
        for (y, line) in (0..).zip(self.0) {
            let panels: Vec<Vec<char>> = line.split_whitespace().map(|panel| panel.chars().collect()).collect();
            let [colours, depths, motions] = panels.try_into().expect("colour, depth and motion");
            assert!(colours.len() == depths.len() && colours.len() == motions.len(), "{line}");
            for (x, ((colour, depth), motion)) in (0..).zip(colours.into_iter().zip(depths).zip(motions)) {
                if colour == '.' {
                    assert!(depth == '.' && motion == '.', "a hole has neither depth nor motion: {line}");
                    continue;
                }
                let (_, [vx, vy]) = MOTIONS.into_iter().find(|(sign, _)| *sign == motion).expect("a motion");
                let mut galpixel = Galpixel {
                    class: if colour.is_ascii_uppercase() { Class::Galpixel } else { Class::Debris },
                    colour: [level(colour); 3],
                    depth: number(f64::from(depth.to_digit(16).expect("a depth")) / 16.0),
                    velocity: [number(vx), number(vy), number(0.0)],
                    ..Galpixel::default()
                };
                change(&mut galpixel);
                map.store(x, y, &galpixel).expect("the drawing fits");
            }
        }
    }
}

/// Returns the format of drawings: the paper's example.
#[must_use]
pub fn format() -> Dynamic {
    let bits = Bits::derive(Demand { extent: 1024, recog: 8, prop: 16 }).expect("the paper's example");
    Dynamic::new(bits, Layout::FULL).expect("the paper's layout")
}

/// Runs a closure with a controller whose map shows a drawing on a display without margin.
pub fn with_drawing<R>(drawing: &[&str], work: impl for<'p> FnOnce(&mut Controller<'p, Dynamic>) -> R) -> R {
    let drawing = Drawing(drawing);
    with_controller(drawing.shape(), format(), None, |controller| {
        drawing.store(controller.front_mut(), |_| ());
        work(controller)
    })
}
