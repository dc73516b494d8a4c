//! The value that every cell would take as a bullet hole: always a mean of four cells.
//!
//! Means of one and of two cells are means of four cells with repetitions, see [`mean4`].

use super::{below, choose, negative, not_zero, opaque};
use crate::format::Format;
use crate::format::record::Words;
use crate::frame::edge::on_edge;
use crate::frame::fill::{Around, FILLED, mean4};
use crate::frame::resolve::NO_WINNER;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// What the cells around a hole hold, and where it came from.
pub(super) struct Surroundings<'s, 'p, A, F> {
    pub around: &'s A,
    pub back: &'s Galpixmap<'p, F>,
    pub winners: &'s [u32],
    pub edges: &'s [u32],
    pub round: u32,
}

/// A neighbour of a cell: beyond the border the cell itself, and `exists` is 0 instead of all ones.
#[derive(Clone, Copy)]
struct Place {
    cell: u32,
    exists: u32,
}

/// The four cells of which a mean is taken.
struct Chosen {
    first: u32,
    second: u32,
    /// The third and the fourth of four cells; else the first and the second again.
    third: u32,
    fourth: u32,
    /// All ones if there is any cell to take a mean of, else 0.
    any: u32,
}

impl Place {
    #[inline(always)]
    fn choose(mask: u32, a: Self, b: Self) -> Self {
        Self { cell: choose(mask, a.cell, b.cell), exists: choose(mask, a.exists, b.exists) }
    }
}

/// Chooses the cells of a mean. `cells` are two pairs that face each other; `inside` has all ones for those that may be
/// used: all four; else two that face each other; else the two there are; else the one there is.
#[inline(always)]
fn chosen(cells: [u32; 4], inside: [u32; 4]) -> Chosen {
    let ([a, b, c, d], [in_a, in_b, in_c, in_d]) = (cells, inside);
    let (a_and_b, c_and_d) = (in_a & in_b, in_c & in_d);
    let (a_or_b, c_or_d) = (in_a | in_b, in_c | in_d);
    let (p, q) = (choose(in_a, a, b), choose(in_c, c, d));
    let first = choose(a_and_b, a, choose(c_and_d, c, choose(a_or_b, p, q)));
    let second = choose(a_and_b, b, choose(c_and_d, d, choose(c_or_d, q, p)));
    let four = a_and_b & c_and_d;
    Chosen { first, second, third: choose(four, c, first), fourth: choose(four, d, second), any: a_or_b | c_or_d }
}

impl<A: Around, F: Format> Surroundings<'_, '_, A, F> {
    /// Returns the mean of the neighbours inside a surface, and all ones if there are any; else unspecified words and
    /// 0.
    #[inline(always)]
    pub fn mean(&self, x: i32, y: i32, cell: u32) -> (Words, u32) {
        let grid = self.back.grid();
        // All ones if there is a column to the left and to the right.
        let (left, right) = (not_zero(x as u32), not_zero(x as u32 ^ (grid.width() - 1)));
        // Above the first and below the last row, the row itself.
        let row = |y: i32| grid.row(y).map_or((cell.wrapping_sub(x as u32), 0), |row| (row, u32::MAX));
        let rows = [row(y - 1), row(y), row(y + 1)];
        let place = |dx: i32, column: u32, (row, exists): (u32, u32)| Place {
            cell: row.wrapping_add((x + (dx & column as i32)) as u32),
            exists: exists & column,
        };
        let here = u32::MAX;
        let sides =
            [place(-1, left, rows[1]), place(1, right, rows[1]), place(0, here, rows[0]), place(0, here, rows[2])];
        let corners =
            [place(-1, left, rows[0]), place(1, right, rows[2]), place(1, right, rows[0]), place(-1, left, rows[2])];
        // Where all neighbours that share a side are vacant, those that share a corner are used instead.
        let crossing = sides.iter().fold(u32::MAX, |all, &side| all & self.vacant(side));
        let mut cells = [0; 4];
        let mut inside = [0; 4];
        for ((to, inside), (&corner, &side)) in cells.iter_mut().zip(&mut inside).zip(corners.iter().zip(&sides)) {
            let place = Place::choose(crossing, corner, side);
            (*to, *inside) = (place.cell, self.inside(place));
        }
        let chosen = chosen(cells, inside);
        let words = |cell: u32| self.back.words_at(cell).unwrap_or_default();
        let (first, second) = (words(chosen.first), words(chosen.second));
        let (third, fourth) = (words(chosen.third), words(chosen.fourth));
        let mut mean = mean4(self.back.record(), [&first, &second, &third, &fourth]);
        // It loses against any galpixel.
        self.back.record().class().set(&mut mean, Class::Debris as u32);
        (mean, chosen.any)
    }

    /// Returns the winner of the cell at a place; [`NO_WINNER`] beyond the border.
    #[inline(always)]
    fn winner(&self, place: Place) -> u32 {
        let winner = self.winners.get(place.cell as usize).copied().unwrap_or(NO_WINNER);
        winner | !place.exists
    }

    /// Returns all ones for the winner of a cell that was filled in an earlier round, else 0.
    #[inline(always)]
    fn filled_before(&self, winner: u32) -> u32 {
        const { assert!(FILLED == 1 << 31) }
        negative(winner as i32) & below(winner & !FILLED, self.round)
    }

    /// Returns all ones if a place was a hole when this round began, else 0.
    #[inline(always)]
    fn vacant(&self, place: Place) -> u32 {
        let winner = self.winner(place);
        let foreign = self.around.foreign(place.cell) & place.exists;
        negative(winner as i32) & !self.filled_before(winner) & !foreign
    }

    /// Returns all ones if what a place holds came from inside a surface or is a bullet fill of an earlier round, else
    /// 0.
    #[inline(always)]
    fn inside(&self, place: Place) -> u32 {
        let winner = self.winner(place);
        let filled = opaque(negative(winner as i32));
        let on_edge = (on_edge(self.edges, winner & !filled) as u32).wrapping_neg();
        !self.around.foreign(place.cell) & choose(filled, self.filled_before(winner), !on_edge)
    }
}
