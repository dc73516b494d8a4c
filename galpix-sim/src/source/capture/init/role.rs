//! What a file may be, from its bytes first and from its name where they leave it open.

use super::super::exr_planes::Planes;
use super::super::folder::Folder;
use super::super::poses::text::numbers;
use super::super::source::{Bands, Format, Size, Source};
use super::super::{dpt, flo, npy, pfm, png_raster};
use super::series::Series;

/// What a file, or all files of a series, may be.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Role {
    /// A picture in colour, with the channel of an EXR.
    Colour(Option<String>),
    /// A picture with transparent pixels.
    Overlay,
    Depth(Depth),
    /// Vectors of this kind, with the channel of an EXR or the array of an `.npz`.
    Vectors(&'static str, Option<String>),
    /// Poses of this format.
    Poses(&'static str),
    Intrinsics([f64; 4]),
}

/// One number for each pixel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Depth {
    pub channel: Option<String>,
    /// Whole numbers, of a PNG or an integer array: their unit is not metres.
    pub whole: bool,
    /// Whether there are zeros, which hold nothing.
    pub zeros: bool,
    /// Whether the largest number of 16 bits occurs.
    pub full: bool,
    /// Whether there are numbers of 1e9 and more, or infinite ones.
    pub far: bool,
    /// Whether all are below zero.
    pub negative: bool,
    /// Whether all lie between 0 and 1, as in a depth buffer.
    pub unit: bool,
}

/// Words in the names of pictures that are no colours.
const NO_COLOUR: [&str; 15] = [
    "mask", "valid", "occ", "depth", "disp", "flow", "motion", "normal", "seg", "label", "conf", "error", "albedo",
    "preview", "plot",
];

/// Returns what a series may be, by its first member; nothing if it is nothing that an importer reads.
pub(super) fn roles(series: &Series, folder: Folder<'_>) -> Vec<Role> {
    let Ok(source) = folder.open(&series.members[0].name) else { return Vec::new() };
    match source.format() {
        Ok(Format::Png) => of_png(series, &source),
        Ok(Format::Jpeg) if series.says(&NO_COLOUR) => Vec::new(),
        Ok(Format::Jpeg) => vec![Role::Colour(None)],
        Ok(Format::Exr) => of_exr(&source),
        Ok(Format::Pieh) if flo::read(&source).is_ok() => vec![Role::Vectors("flow", None)],
        Ok(Format::Pieh) => of_bands(series, dpt::read(&source).ok(), None),
        // Of another size than any picture, so that its own shape decides.
        Ok(Format::Npy) => of_bands(series, npy::read(&source, Size { width: 1, height: 1 }).ok(), None),
        Ok(Format::Npz) => of_archive(series, &source),
        Ok(Format::Pfm) => of_bands(series, pfm::read(&source).ok(), None),
        Err(_) => of_text(series, &source),
    }
}

fn of_png(series: &Series, source: &Source) -> Vec<Role> {
    let Ok(raster) = png_raster::read(source, None) else { return Vec::new() };
    let is_depth = series.says(&["depth", "disp", "dist", "zbuf"]);
    match (raster.channels, raster.stored_bits) {
        (3, 16) if series.says(&["flow", "motion"]) => vec![Role::Vectors("flow", None)],
        (1 | 2, 16) => of_bands(series, png_raster::grey(source).ok(), None),
        // Some writers repeat the number in each channel.
        (_, 8 | 16) if is_depth => of_bands(series, png_raster::grey(source).ok(), None),
        (4, _) if series.says(&["hud", "overlay", "gui"]) => vec![Role::Overlay],
        _ if series.says(&NO_COLOUR) || raster.stored_bits < 8 => Vec::new(),
        _ => vec![Role::Colour(None)],
    }
}

fn of_exr(source: &Source) -> Vec<Role> {
    let Ok(planes) = Planes::read(source) else { return Vec::new() };
    let names: Vec<&str> = planes.names().collect();
    // Before the last point, and what is after it.
    let prefixes = |last: &str| -> Vec<String> {
        let prefix = |name: &&str| match name.rsplit_once('.') {
            Some((prefix, end)) if end == last => Some(prefix.to_owned()),
            None if *name == last => Some(String::new()),
            _ => None,
        };
        names.iter().filter_map(prefix).collect()
    };
    let has = |prefix: &str, last: &str| {
        names.iter().any(|name| if prefix.is_empty() { *name == last } else { *name == format!("{prefix}.{last}") })
    };
    let given = |prefix: String| (!prefix.is_empty()).then_some(prefix);
    let mut roles = Vec::new();
    for prefix in prefixes("R").into_iter().filter(|prefix| has(prefix, "G") && has(prefix, "B")) {
        roles.push(Role::Colour(given(prefix)));
    }
    for prefix in prefixes("VX").into_iter().filter(|prefix| has(prefix, "VY")) {
        roles.push(Role::Vectors("planes", given(prefix)));
    }
    for prefix in prefixes("W").into_iter().filter(|prefix| ["X", "Y", "Z"].iter().all(|last| has(prefix, last))) {
        roles.push(Role::Vectors("blender-vector", Some(prefix)));
    }
    for pair in [["u", "v"], ["U", "V"]] {
        for prefix in prefixes(pair[0]).into_iter().filter(|prefix| has(prefix, pair[1])) {
            roles.push(Role::Vectors("flow", given(prefix)));
        }
    }
    let is_vector = |name: &str| ["X", "Y", "W"].iter().any(|last| has(name, last));
    let depth = names.iter().find(|name| {
        let (prefix, last) = name.rsplit_once('.').unwrap_or(("", name));
        let says = prefix.to_lowercase().contains("depth");
        !is_vector(prefix)
            && (last == "Z" || last.eq_ignore_ascii_case("depth") || (says && (last == "V" || last == "Y")))
    });
    if let Some(name) = depth
        && let Some(values) = planes.values(name)
    {
        roles.push(Role::Depth(Depth::of(Some((*name).to_owned()), &values, false)));
    }
    roles
}

fn of_archive(series: &Series, source: &Source) -> Vec<Role> {
    let size = Size { width: 1, height: 1 };
    let names = npy::names(source).unwrap_or_default();
    let of = |name: &String| of_bands(series, npy::read_archive(source, Some(name), size).ok(), Some(name.clone()));
    names.iter().flat_map(of).collect()
}

/// What numbers of a file are, by how many there are in a pixel.
fn of_bands(series: &Series, bands: Option<Bands>, channel: Option<String>) -> Vec<Role> {
    let Some(Bands { bands, size, .. }) = bands else { return Vec::new() };
    // Lists of poses are no maps.
    if size.width < 4 || size.height < 2 {
        return Vec::new();
    }
    match &bands[..] {
        [_, _] => vec![Role::Vectors("flow", channel)],
        [_, _, third] if third.iter().all(|&value| value == 0.0) => vec![Role::Vectors("flow", channel)],
        [_, _, _] if series.says(&["flow", "motion", "vector"]) => vec![Role::Vectors("flow", channel)],
        [first, rest @ ..] if rest.iter().all(|band| band == first) => {
            let whole = first.iter().all(|value| value.fract() == 0.0);
            vec![Role::Depth(Depth::of(channel, first, whole))]
        }
        _ => Vec::new(),
    }
}

impl Depth {
    fn of(channel: Option<String>, values: &[f64], whole: bool) -> Self {
        let usual = || values.iter().copied().filter(|value| value.is_finite() && value.abs() < 1e9);
        Self {
            channel,
            whole,
            zeros: values.contains(&0.0),
            full: whole && values.contains(&65_535.0),
            far: values.iter().any(|&value| value >= 1e9),
            negative: usual().all(|value| value <= 0.0),
            unit: !whole && usual().all(|value| (0.0..=1.0).contains(&value)),
        }
    }
}

fn of_text(series: &Series, source: &Source) -> Vec<Role> {
    let Ok(text) = source.text() else { return Vec::new() };
    if text.trim_start().starts_with('{') {
        let is_transforms = text.contains("\"transform_matrix\"");
        return if is_transforms { vec![Role::Poses("transforms")] } else { Vec::new() };
    }
    let name = source.path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    if name == "images.txt" {
        return vec![Role::Poses("colmap")];
    }
    let lines = || text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    let Ok(rows) = lines().take(5).map(numbers).collect::<Result<Vec<Vec<f64>>, _>>() else { return Vec::new() };
    let widths: Vec<usize> = rows.iter().map(Vec::len).collect();
    let is_calibration = series.says(&["intrin", "calib", "camera", "k.txt"]);
    match (&widths[..], lines().count()) {
        ([4], 1) if is_calibration => vec![Role::Intrinsics([rows[0][0], rows[0][1], rows[0][2], rows[0][3]])],
        ([9], 1) if is_calibration => vec![Role::Intrinsics([rows[0][0], rows[0][4], rows[0][2], rows[0][5]])],
        ([3 | 4, 3 | 4, 3 | 4, ..], 3 | 4) if is_calibration => {
            vec![Role::Intrinsics([rows[0][0], rows[1][1], rows[0][2], rows[1][2]])]
        }
        ([4, 4, 4] | [4, 4, 4, 4], 3 | 4) => vec![Role::Poses("matrix-files")],
        ([16], 1) | ([12], 1) if series.members.len() > 1 => vec![Role::Poses("matrix-files")],
        ([3, 4, 4, 4, 4], _) => vec![Role::Poses("log")],
        ([7, 7, ..], _) => vec![Role::Poses("tartanair")],
        ([8, 8, ..], _) if text.contains(',') => vec![Role::Poses("euroc")],
        ([8, 8, ..], _) => vec![Role::Poses("tum")],
        ([12, 12, ..], _) => vec![Role::Poses("kitti")],
        (&[first, ..], _) if first > 8 && text.contains(',') => vec![Role::Poses("euroc")],
        _ => Vec::new(),
    }
}
