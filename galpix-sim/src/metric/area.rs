//! Areas of cells: those that are connected with the border of a picture, and the largest of the others. Cells are
//! connected where they share a side.

/// A rectangle of cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First column.
    pub left: usize,
    /// First row.
    pub top: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// Returns whether each cell is connected with the border of the picture by set cells.
#[must_use]
pub fn at_border(set: &[bool], width: usize, height: usize) -> Vec<bool> {
    let mut seen = vec![false; set.len()];
    let border = |cell: usize| {
        let (x, y) = (cell % width, cell / width);
        x == 0 || y == 0 || x + 1 == width || y + 1 == height
    };
    for cell in (0..set.len()).filter(|&cell| border(cell)) {
        flood(set, width, cell, &mut seen);
    }
    seen
}

/// Returns the connected area with the most cells.
#[must_use]
pub fn largest(set: &[bool], width: usize) -> Vec<usize> {
    let mut seen = vec![false; set.len()];
    let areas = (0..set.len()).map(|cell| flood(set, width, cell, &mut seen));
    areas.reduce(|best, area| if area.len() > best.len() { area } else { best }).unwrap_or_default()
}

/// Returns the cells of the area that `start` belongs to, if it was not seen yet; they are seen then.
fn flood(set: &[bool], width: usize, start: usize, seen: &mut [bool]) -> Vec<usize> {
    let mut area = Vec::new();
    let mut reach = |cell: usize, area: &mut Vec<usize>| {
        if set.get(cell) == Some(&true) && !std::mem::replace(&mut seen[cell], true) {
            area.push(cell);
        }
    };
    reach(start, &mut area);
    let mut next = 0;
    while let Some(&cell) = area.get(next) {
        next += 1;
        let x = cell % width;
        if x > 0 {
            reach(cell - 1, &mut area);
        }
        if x + 1 < width {
            reach(cell + 1, &mut area);
        }
        if cell >= width {
            reach(cell - width, &mut area);
        }
        reach(cell + width, &mut area);
    }
    area
}

impl Window {
    /// Creates the window around some cells with a margin of `margin` cells, as far as the picture goes; `None` around
    /// none.
    #[must_use]
    pub fn around(cells: impl IntoIterator<Item = usize>, margin: usize, width: usize, height: usize) -> Option<Self> {
        let (mut from, mut to) = ([usize::MAX; 2], [0; 2]);
        for cell in cells {
            for (i, at) in [cell % width, cell / width].into_iter().enumerate() {
                from[i] = from[i].min(at);
                to[i] = to[i].max(at);
            }
        }
        if from[0] > to[0] {
            return None;
        }
        let [left, top] = from.map(|from| from.saturating_sub(margin));
        let [right, bottom] = [(to[0] + 1 + margin).min(width), (to[1] + 1 + margin).min(height)];
        Some(Self { left, top, width: right - left, height: bottom - top })
    }

    /// A window of `width` x `height` cells, or as many as there are, whose middle is that of this one as far as it
    /// fits.
    #[must_use]
    pub fn resized(self, size: [usize; 2], within: [usize; 2]) -> Self {
        let place = |from: usize, length: usize, size: usize, within: usize| {
            let size = size.min(within);
            ((from + length / 2).saturating_sub(size / 2).min(within - size), size)
        };
        let (left, width) = place(self.left, self.width, size[0], within[0]);
        let (top, height) = place(self.top, self.height, size[1], within[1]);
        Self { left, top, width, height }
    }

    /// Returns what belongs to the cells of the window, of a picture of `width` columns.
    #[must_use]
    pub fn of<T: Copy>(&self, cells: &[T], width: usize) -> Vec<T> {
        let row = |y: usize| cells[y * width + self.left..][..self.width].iter().copied();
        (self.top..self.top + self.height).flat_map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(art: [&str; 5]) -> Vec<bool> {
        art.iter().flat_map(|row| row.chars().map(|c| c == '#')).collect()
    }

    #[test]
    fn only_what_touches_the_border_is_connected_with_it() {
        let set = set(["#..#.", "#.#..", "..#..", ".....", ".##.#"]);
        // The two cells in the middle touch no border cell by a side; everything else does.
        assert_eq!(at_border(&set, 5, 5).into_iter().filter(|&there| there).count(), 6);
    }

    #[test]
    fn the_largest_area_is_connected_by_sides() {
        let set = set(["##..#", "##.#.", "...#.", ".####", "....."]);
        let mut cells = largest(&set, 5);
        cells.sort_unstable();
        assert_eq!(cells, [8, 13, 16, 17, 18, 19]);
        assert!(largest(&[false; 4], 2).is_empty());
    }

    #[test]
    fn windows_stay_inside() {
        let window = Window::around([6, 13], 1, 5, 5).unwrap();
        assert_eq!(window, Window { left: 0, top: 0, width: 5, height: 4 });
        assert_eq!(Window::around([], 1, 5, 5), None);
        assert_eq!(window.resized([3, 9], [5, 5]), Window { left: 1, top: 0, width: 3, height: 5 });
        let cells: Vec<usize> = (0..25).collect();
        assert_eq!(Window { left: 3, top: 1, width: 2, height: 2 }.of(&cells, 5), [8, 9, 13, 14]);
    }
}
