//! A scene as objects that are rendered apart.

use crate::source::scene::{self, Scene, surface::Point};
use crate::update::Sample;

/// A scene and the sizes of its objects' renderings at its beginning.
pub(super) struct World {
    pub scene: &'static dyn Scene,
    /// Columns and rows of the map, margin included.
    pub size: [u32; 2],
    cells: Vec<u32>,
}

/// One object rendered alone at one time.
pub(super) struct Rendering {
    pub place: [u32; 2],
    pub size: [u32; 2],
    /// Row by row; nothing where the object is not.
    pub cells: Vec<Option<(Sample, Point)>>,
}

impl World {
    pub fn of(scene: &'static dyn Scene) -> Self {
        let margin = scene.margin();
        let size = [margin.left + scene.width() + margin.right, margin.top + scene.height() + margin.bottom];
        let mut world = Self { scene, size: size.map(|side| side as u32), cells: Vec::new() };
        world.cells = (0..scene.surfaces().len()).map(|object| world.rendering(object, 0).cells.len() as u32).collect();
        world
    }

    /// Returns the cells of each object's rendering.
    pub fn cells(&self) -> &[u32] {
        &self.cells
    }

    /// Returns the cells of the whole map.
    pub const fn all_cells(&self) -> u32 {
        self.size[0] * self.size[1]
    }

    /// Returns what is seen of an object alone at column `x`, row `y` of the map.
    fn seen(&self, object: usize, x: u32, y: u32, t: f64) -> Option<(Sample, Point)> {
        let (margin, surface) = (self.scene.margin(), self.scene.surfaces()[object]);
        let hit = surface.hit(f64::from(x) - margin.left as f64, f64::from(y) - margin.top as f64, t)?;
        Some((scene::seen(surface, object, &hit, t), hit.point))
    }

    /// Returns an object alone at frame `frame`: the smallest rectangle that holds it.
    pub fn rendering(&self, object: usize, frame: u32) -> Rendering {
        let t = f64::from(frame);
        let [width, height] = self.size;
        let all: Vec<_> = (0..width * height).map(|at| self.seen(object, at % width, at / width, t)).collect();
        let held = |at: &u32| all[*at as usize].is_some();
        let columns: Vec<u32> = (0..width * height).filter(held).map(|at| at % width).collect();
        let rows: Vec<u32> = (0..width * height).filter(held).map(|at| at / width).collect();
        let span = |places: &[u32]| match (places.iter().min(), places.iter().max()) {
            (Some(&least), Some(&most)) => (least, most - least + 1),
            _ => (0, 0),
        };
        let ((left, columns), (top, rows)) = (span(&columns), span(&rows));
        let inside = (top..top + rows).flat_map(|y| (left..left + columns).map(move |x| (y * width + x) as usize));
        let cells = inside.map(|at| all[at]).collect();
        Rendering { place: [left, top], size: [columns, rows], cells }
    }

    /// Returns the whole view at frame `frame`, as a renderer delivers it to one map: what is foremost in each cell.
    pub fn view(&self, frame: u32) -> Rendering {
        let t = f64::from(frame);
        let [width, height] = self.size;
        let nearest = |at: u32| {
            let seen =
                (0..self.scene.surfaces().len()).filter_map(|object| self.seen(object, at % width, at / width, t));
            seen.min_by(|(a, _), (b, _)| a.depth.total_cmp(&b.depth))
        };
        Rendering { place: [0, 0], size: self.size, cells: (0..width * height).map(nearest).collect() }
    }
}
