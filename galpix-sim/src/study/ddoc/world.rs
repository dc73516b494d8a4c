//! Worlds: triangles from a built-in scene, a made-up world, or a file.

use super::view::{Corner, View};
use crate::source::ddoc::sheet::{self, Lattice, Node};
use crate::source::scene::Scene;

/// A world of triangles before the reference eye.
#[derive(Clone, Debug)]
pub struct World {
    /// What it is called.
    pub name: String,
    /// One line: what it shows.
    pub about: String,
    /// Corners.
    pub corners: Vec<Corner>,
    /// Triangles, by their corners.
    pub triangles: Vec<[u32; 3]>,
    /// Distance of depth 0: nothing of the world that the reference view sees is nearer.
    pub near: f64,
    /// Half the side of the cube on which desired views are.
    pub half_side: f64,
}

/// Pixels of a built-in scene's display from its middle to the border of the reference view: the focal length of the
/// lens that most of them have.
const HALF_FIELD: f64 = 170.0;

/// How much wider than the reference view the meshes of a scene reach: views from other places see some more.
const WIDER: f64 = 1.12;

/// Pixels of the display between nodes.
const STEP: f64 = 0.85;

/// No world starts nearer than this part of its reach.
const NEAREST: f64 = 0.002;

impl World {
    /// Creates an empty world.
    #[must_use]
    pub fn new(name: &str, about: &str, half_side: f64) -> Self {
        let (name, about) = (name.to_owned(), about.to_owned());
        Self { name, about, corners: Vec::new(), triangles: Vec::new(), near: 1.0, half_side }
    }

    /// One more triangle.
    pub fn add(&mut self, triangle: [Corner; 3]) {
        let first = self.corners.len() as u32;
        self.corners.extend(triangle);
        self.triangles.push([first, first + 1, first + 2]);
    }

    /// The corners of a triangle.
    #[must_use]
    pub fn triangle(&self, of: [u32; 3]) -> [Corner; 3] {
        of.map(|corner| self.corners[corner as usize])
    }

    /// Sets [`Self::near`] a little before the nearest corner in the reference view.
    #[must_use]
    pub fn with_near(mut self) -> Self {
        let seen =
            self.corners.iter().map(|corner| corner.place).filter(|&[x, y, z]| z > 0.0 && x.abs() <= z && y.abs() <= z);
        let (nearest, farthest) =
            seen.fold((f64::MAX, 0.0), |(near, far): (f64, f64), [_, _, z]| (near.min(z), far.max(z)));
        self.near = (0.98 * nearest).max(NEAREST * farthest).min(f64::MAX);
        self
    }

    /// Creates a built-in scene at its update, as its own eye sees it: each surface as a mesh with its hidden parts and
    /// its back.
    #[must_use]
    pub fn of_scene(scene: &dyn Scene) -> Self {
        let mut world = Self::new(scene.name(), scene.about(), 0.0);
        let middle = [scene.width(), scene.height()].map(|cells| 0.5 * (cells as f64 - 1.0));
        let reach = HALF_FIELD * WIDER;
        let nodes = (2.0 * reach / STEP) as usize;
        let lattice = Lattice { first: middle.map(|at| at - reach), step: STEP, size: [nodes; 2] };
        // The eye's unit of length is the scene's near distance.
        let view = View { eye: [0.0; 3], focal: HALF_FIELD, width: 1, height: 1 };
        for surface in scene.surfaces() {
            sheet::triangles(*surface, &lattice, 0.0, |nodes| {
                let corner = |node: &Node| {
                    let at = [0, 1].map(|axis: usize| node.at[axis] - middle[axis]);
                    // What is infinitely far is far enough.
                    let z = 1.0 / (1.0 - node.hit.depth).max(1e-4);
                    let colour = surface.colour(node.hit.point).map(|channel| channel as f32);
                    Corner { place: view.unproject(at, z), colour }
                };
                world.add(nodes.map(corner));
            });
        }
        world.half_side = 0.07;
        world.with_near()
    }
}
