//! Objects from Wavefront OBJ files: put on a stage, with a floor and a wall behind.
//!
//! An object is turned upright (OBJ has y up, this world y down), scaled so that its largest side is [`SIDE`] and set
//! down on the floor at distance [`DISTANCE`]. Colours are those of its corners, or of its materials, or grey; a light
//! from the left above shades its faces, for files have no texture here.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use super::view::{Colour, Corner, Place};
use super::world::World;
use super::worlds::{STAGE_FLOOR, stage};

/// The largest side of an object on the stage.
pub const SIDE: f64 = 1.5;

/// Distance of an object's middle.
pub const DISTANCE: f64 = 2.6;

/// Triangles that an object may have.
pub const MOST_TRIANGLES: usize = 1 << 21;

/// Bytes that a file may have.
pub const MOST_BYTES: u64 = 1 << 29;

/// Why an object cannot be used. One sentence: what, where, how to correct it.
#[derive(Debug, thiserror::Error)]
#[error("{}: {what}; {hint}", printable(file))]
pub struct ImportError {
    file: PathBuf,
    what: String,
    hint: &'static str,
}

/// Returns a file's name without the characters that command a terminal.
fn printable(file: &Path) -> String {
    file.display().to_string().chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

/// Returns whether a name looks like that of an object's file.
#[must_use]
pub fn is_object(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj"))
}

/// Returns the object in an OBJ file, on the stage. Its material files are looked for in its own folder only; without
/// them it is grey.
///
/// *Errors:* a file that cannot be read or parsed, that has no triangle with an area, more than [`MOST_TRIANGLES`], a
/// corner that is no finite number, or a face with a corner that is not there.
pub fn obj(file: &Path) -> Result<World, ImportError> {
    let error = |what: String, hint: &'static str| ImportError { file: file.to_path_buf(), what, hint };
    let opened =
        File::open(file).map_err(|io| error(format!("it cannot be opened ({io})"), "give the path of an OBJ file"))?;
    let about =
        opened.metadata().map_err(|io| error(format!("it cannot be read ({io})"), "give the path of an OBJ file"))?;
    if !about.is_file() {
        return Err(error("it is no file".to_owned(), "give the path of an OBJ file"));
    }
    if about.len() > MOST_BYTES {
        return Err(error(
            format!("it has {} bytes, and {MOST_BYTES} are possible", about.len()),
            "give a simpler object",
        ));
    }
    on_stage(file, &triangles(file, &mut BufReader::new(opened))?).ok_or_else(|| {
        error("it has no triangle with an area".to_owned(), "give an object with faces, not only points or lines")
    })
}

/// Three corners with their colours.
type Triangle = [(Place, Colour); 3];

/// Returns the triangles of the object that a reader gives, as they stand there; `file` is its name in messages, and
/// the place of its materials.
///
/// *Errors:* as of [`obj`], but for triangles without an area.
pub fn triangles(file: &Path, text: &mut impl BufRead) -> Result<Vec<Triangle>, ImportError> {
    let error = |what: String, hint: &'static str| ImportError { file: file.to_path_buf(), what, hint };
    let folder = file.parent().unwrap_or(Path::new(""));
    let options = tobj::LoadOptions { triangulate: true, single_index: true, ..tobj::LoadOptions::default() };
    let material = |path: &Path| match path.file_name() {
        Some(name) => tobj::load_mtl(folder.join(name)),
        None => Err(tobj::LoadError::OpenFileFailed),
    };
    let (models, materials) = tobj::load_obj_buf(text, &options, material)
        .map_err(|reason| error(format!("it is no OBJ file that can be read ({reason})"), "export the object anew"))?;
    let materials = materials.unwrap_or_default();
    let count = models.iter().map(|model| model.mesh.indices.len() / 3).sum::<usize>();
    if count > MOST_TRIANGLES {
        return Err(error(
            format!("it has {count} triangles, and {MOST_TRIANGLES} are possible"),
            "give a simpler object",
        ));
    }
    let mut triangles: Vec<Triangle> = Vec::with_capacity(count);
    for mesh in models.iter().map(|model| &model.mesh) {
        let of_material = mesh.material_id.and_then(|id| materials.get(id)?.diffuse);
        let base = of_material.unwrap_or([0.75; 3]).map(|channel| if channel.is_finite() { channel } else { 0.75 });
        let corner = |index: u32| {
            let at = index as usize * 3;
            let place = mesh.positions.get(at..at + 3)?;
            let colour =
                mesh.vertex_color.get(at..at + 3).filter(|colour| colour.iter().all(|channel| channel.is_finite()));
            let colour = colour.map_or(base, |colour| [colour[0], colour[1], colour[2]]);
            Some(([place[0], place[1], place[2]].map(f64::from), colour.map(|channel| 255.0 * channel.clamp(0.0, 1.0))))
        };
        for face in mesh.indices.chunks_exact(3) {
            let (Some(a), Some(b), Some(c)) = (corner(face[0]), corner(face[1]), corner(face[2])) else {
                return Err(error("a face has a corner that is not there".to_owned(), "export the object anew"));
            };
            if [a, b, c].iter().flat_map(|(place, _)| place).any(|coordinate| !coordinate.is_finite()) {
                return Err(error("a corner is not at a finite place".to_owned(), "export the object anew"));
            }
            triangles.push([a, b, c]);
        }
    }
    Ok(triangles)
}

/// The triangles, upright, scaled, shaded and set down; nothing if none has an area.
fn on_stage(file: &Path, triangles: &[Triangle]) -> Option<World> {
    let places = || triangles.iter().flatten().map(|(place, _)| place);
    let bound = |better: fn(f64, f64) -> f64, start: f64| {
        [0, 1, 2].map(|axis: usize| places().fold(start, |bound, place| better(bound, place[axis])))
    };
    let (low, high) = (bound(f64::min, f64::MAX), bound(f64::max, f64::MIN));
    let side = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    if side <= 0.0 {
        return None;
    }
    let scale = SIDE / side;
    let on_stage = |place: Place| -> Place {
        let from_middle = [0, 1, 2].map(|axis| (place[axis] - 0.5 * (low[axis] + high[axis])) * scale);
        let above_floor = (place[1] - low[1]) * scale;
        // Turned half about x: y down, and what faced the viewer (z towards the viewer) still does.
        [from_middle[0], STAGE_FLOOR - above_floor, DISTANCE - from_middle[2]]
    };
    let name = printable(Path::new(file.file_stem().unwrap_or_default()));
    let mut world = World::new(&name, "an object from a file, on a floor before a wall", 0.07);
    stage(&mut world);
    let mut any = false;
    for triangle in triangles {
        let [a, b, c] = triangle.map(|(place, _)| on_stage(place));
        let (ab, ac) = ([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i]));
        let normal = [ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2], ab[0] * ac[1] - ab[1] * ac[0]];
        let length = normal.iter().map(|component| component * component).sum::<f64>().sqrt();
        if length == 0.0 {
            continue;
        }
        any = true;
        // Files do not agree on which side of a face is its front: the one that the reference eye sees is lit.
        let facing = if normal[0] * a[0] + normal[1] * a[1] + normal[2] * a[2] > 0.0 { -1.0 } else { 1.0 } / length;
        let light = 0.45 + 0.6 * (facing * (-0.5 * normal[0] - 0.6 * normal[1] - 0.62 * normal[2])).max(0.0);
        let shaded = |colour: Colour| colour.map(|channel| (channel * light as f32).min(255.0));
        world.add(
            [(a, triangle[0].1), (b, triangle[1].1), (c, triangle[2].1)]
                .map(|(place, colour)| Corner { place, colour: shaded(colour) }),
        );
    }
    any.then(|| world.with_near())
}
