//! Manifests that a folder's files may mean, and what each leaves open.

use std::fmt::Write;
use std::path::Path;

use super::super::error::CaptureError;
use super::role::{Depth, Role};
use super::series::{Member, Series};
use super::{Best, InitOptions};

/// A later picture and the display frame that it shows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Later {
    pub frame: u32,
    colour: String,
}

/// An inline table: keys and values, as they are written.
type Table = Vec<(&'static str, String)>;

/// A manifest.
#[derive(Clone, Debug)]
pub(super) struct Draft {
    colour: String,
    depth: Table,
    motion: Table,
    acceleration: Table,
    overlay: Option<String>,
    frames: u32,
    /// The file of the vectors that follow, if there is one.
    next: Option<String>,
    /// The update's place among its pictures, and its number.
    place: (usize, Option<f64>),
    depth_role: Option<Depth>,
    /// The later picture that decides what is open.
    pub judge: Option<Later>,
}

/// A key of a table, and what it becomes; nothing: it goes.
#[derive(Clone, Debug)]
pub(super) struct Set {
    table: &'static str,
    key: &'static str,
    value: Option<String>,
}

impl Set {
    /// Returns it as a reader knows it.
    pub fn text(&self) -> String {
        let Self { table, key, value } = self;
        value.as_ref().map_or_else(|| format!("{table} without {key}"), |value| format!("{table}.{key} = {value}"))
    }
}

/// Something that is open, and the ways to settle it, the most usual first.
pub(super) struct Axis {
    pub what: &'static str,
    pub options: Vec<Vec<Set>>,
}

/// The pictures: the update's place among them, and those that follow.
pub(super) struct Pictures<'s> {
    series: &'s Series,
    channel: Option<String>,
    pub later: Vec<Later>,
    update: usize,
    overlay: Option<&'s str>,
    depth: Option<(&'s Series, Depth)>,
}

impl Pictures<'_> {
    /// Returns the files of the pictures that are used.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        let last = self.update + self.later.len();
        self.series.members[self.update..=last].iter().map(|member| member.name.as_str()).chain(self.overlay)
    }

    fn now(&self) -> &Member {
        &self.series.members[self.update]
    }

    /// Returns a picture's entry in a manifest.
    fn entry(&self, member: &Member) -> String {
        match &self.channel {
            Some(channel) => format!("{{ file = {}, channel = {} }}", quoted(&member.name), quoted(channel)),
            None => quoted(&member.name),
        }
    }
}

/// Returns a string as TOML has it.
fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// Returns whether there are vectors or poses of a number.
fn moves(found: &[(&Series, Vec<Role>)], number: Option<f64>) -> bool {
    found.iter().any(|(series, roles)| {
        roles.iter().any(|role| match role {
            Role::Vectors(..) => series.at(number).is_some(),
            Role::Poses("matrix-files") => series.members.iter().any(|member| member.number == number),
            Role::Poses(_) => true,
            _ => false,
        })
    })
}

/// Returns whether there are vectors at all.
fn vectors(found: &[(&Series, Vec<Role>)]) -> bool {
    found.iter().flat_map(|(_, roles)| roles).any(|role| matches!(role, Role::Vectors(..)))
}

/// Returns the pictures: of several series the one whose name says so, else the longest.
pub(super) fn picture<'s>(
    found: &[(&'s Series, Vec<Role>)],
    step: u32,
    folder: &Path,
) -> Result<Pictures<'s>, CaptureError> {
    let colours = found.iter().flat_map(|(series, roles)| {
        roles.iter().filter_map(move |role| match role {
            Role::Colour(channel) => Some((*series, channel.clone())),
            _ => None,
        })
    });
    let rank = |(series, channel): &(&Series, Option<String>)| {
        let says = series.says(&["color", "colour", "rgb", "image", "frame", "left", "beauty", "render"]);
        let combined = channel.as_deref().is_none_or(|channel| channel.is_empty() || channel.ends_with("Combined"));
        let other = series.says(&["right", "albedo", "diffuse"]);
        (combined && !other, says, series.members.len())
    };
    let Some((series, channel)) = colours.max_by_key(rank) else {
        let what = "holds no picture in colour that could be the update's (PNG, JPEG, or EXR with R, G and B)";
        return Err(CaptureError::new(folder, what, "add the picture that a renderer or a camera delivered"));
    };
    let depth = found.iter().find_map(|(series, roles)| {
        roles.iter().find_map(|role| match role {
            Role::Depth(depth) => Some((*series, depth.clone())),
            _ => None,
        })
    });
    let number = |at: &usize| series.members[*at].number;
    let known = |at: &usize| depth.as_ref().is_none_or(|(series, _)| series.at(number(at)).is_some());
    let places = || 0..series.members.len();
    // A camera's path is known best between two poses.
    let first = usize::from(series.members.len() > 2 && !vectors(found));
    let update = places().skip(first).find(|at| known(at) && moves(found, number(at)));
    let update = update.or_else(|| places().find(known)).unwrap_or(0);
    let overlay = found.iter().find(|(_, roles)| roles.contains(&Role::Overlay));
    let overlay = overlay.map(|(series, _)| series.members[0].name.as_str());
    Ok(Pictures { series, channel, later: Vec::new(), update, overlay, depth }.with_later(step))
}

impl Pictures<'_> {
    /// Adds the pictures that follow, `step` display frames for each number.
    fn with_later(mut self, step: u32) -> Self {
        let now = self.now().number;
        let frame = |at: usize, member: &Member| match now.zip(member.number) {
            // Time stamps count as places.
            Some((now, then)) if now.fract() == 0.0 && then.fract() == 0.0 && then - now < 65_535.0 => {
                (then - now) as u32
            }
            _ => (at - self.update) as u32,
        };
        let after = self.series.members.iter().enumerate().skip(self.update + 1);
        self.later = after
            .map(|(at, member)| Later { frame: frame(at, member).saturating_mul(step), colour: self.entry(member) })
            .collect();
        self
    }
}

/// Returns a draft for each file that may be the motion's.
pub(super) fn drafts(
    found: &[(&Series, Vec<Role>)],
    pictures: &Pictures<'_>,
    options: &InitOptions,
    folder: &Path,
) -> Result<Vec<Draft>, CaptureError> {
    let number = pictures.now().number;
    let (depth, depth_role) = match &pictures.depth {
        Some((series, depth)) => match series.at(number) {
            Some(member) => (of_depth(series, member, depth), Some(depth.clone())),
            None => (vec![("kind", quoted("speed"))], None),
        },
        None => (vec![("kind", quoted("speed"))], None),
    };
    let frames = pictures.later.last().map_or(16, |later| later.frame);
    let base = Draft {
        colour: pictures.entry(pictures.now()),
        depth,
        motion: Vec::new(),
        acceleration: Vec::new(),
        overlay: pictures.overlay.map(quoted),
        frames: frames.clamp(1, 65_535),
        next: None,
        place: (pictures.update, number),
        depth_role,
        judge: pictures.later.first().cloned(),
    };
    let given = found.iter().flat_map(|(_, roles)| roles).find_map(|role| match role {
        Role::Intrinsics(intrinsics) => Some(*intrinsics),
        _ => None,
    });
    let intrinsics = options.intrinsics.or(given);
    let (mut drafts, mut lacks_intrinsics) = (Vec::new(), false);
    for (series, role) in found.iter().flat_map(|(series, roles)| roles.iter().map(move |role| (*series, role))) {
        match role {
            Role::Vectors(kind, channel) => {
                let Some(member) = series.at(number) else { continue };
                let mut motion = vec![("kind", quoted(kind)), ("file", quoted(&member.name))];
                motion.extend(channel.as_ref().map(|channel| ("channel", quoted(channel))));
                motion.push(("frames", options.step.to_string()));
                let after = series.members.iter().find(|other| other.number > number && series.members.len() > 1);
                let next = after.filter(|_| *kind == "flow").map(|member| member.name.clone());
                drafts.push(Draft { motion, next, ..base.clone() });
            }
            Role::Poses(format) => {
                let poses = if *format == "matrix-files" { series.pattern() } else { series.members[0].name.clone() };
                let mut motion =
                    vec![("kind", quoted("camera")), ("poses", quoted(&poses)), ("format", quoted(format))];
                match intrinsics {
                    Some(given) => motion.push(("intrinsics", format!("{given:?}"))),
                    None if matches!(*format, "transforms" | "colmap") => {}
                    None => {
                        lacks_intrinsics = true;
                        continue;
                    }
                }
                motion.push(("frames", options.step.to_string()));
                drafts.push(Draft { motion, ..base.clone() });
            }
            _ => {}
        }
    }
    if drafts.is_empty()
        && let Some((series, depth)) = &pictures.depth
        && depth.whole
        && series.says(&["disp"])
        && !pictures.later.is_empty()
    {
        // A pair of views side by side: the second is what the first shows when every pixel has moved by its disparity.
        let mut motion: Table = base.depth.iter().filter(|(key, _)| *key != "kind").cloned().collect();
        motion.insert(0, ("kind", quoted("disparity")));
        motion.extend([("sign", "-1".to_owned()), ("frames", base.frames.to_string())]);
        drafts.push(Draft { motion, ..base });
    }
    if drafts.is_empty() {
        let (what, hint) = if lacks_intrinsics {
            ("holds poses, but nothing gives the camera's intrinsics", "give them with --intrinsics FX,FY,CX,CY")
        } else {
            let what = "holds a picture and no motion for it (vectors: .flo, KITTI PNG, .npy, PFM or EXR; or a depth map \
                        with poses)";
            (what, "add one with the number of a picture")
        };
        return Err(CaptureError::new(folder, what, hint));
    }
    Ok(drafts)
}

fn of_depth(series: &Series, member: &Member, depth: &Depth) -> Table {
    let is_disparity = series.says(&["disp"]);
    let kind = if is_disparity { "disparity" } else { "z" };
    let mut table = vec![("kind", quoted(kind)), ("file", quoted(&member.name))];
    table.extend(depth.channel.as_ref().map(|channel| ("channel", quoted(channel))));
    if depth.whole {
        let unknown = [(depth.zeros, "0"), (depth.full, "65535")];
        let unknown: Vec<&str> = unknown.iter().filter(|(there, _)| *there).map(|(_, value)| *value).collect();
        if !unknown.is_empty() {
            table.push(("invalid", format!("[{}]", unknown.join(", "))));
        }
        if !is_disparity {
            table.push(("scale", "0.001".to_owned()));
        }
    }
    if depth.negative && !is_disparity {
        table.push(("sign", "-1".to_owned()));
    }
    if depth.far {
        table.push(("far", "1e9".to_owned()));
    }
    table
}

impl Draft {
    /// Returns the files that it names, but for the pictures.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        let tables = [&self.depth, &self.motion, &self.acceleration].into_iter().flatten();
        tables.filter(|(key, _)| matches!(*key, "file" | "poses")).map(|(_, value)| value.trim_matches('"'))
    }

    /// Changes a key.
    pub fn set(&mut self, set: &Set) {
        let table = match set.table {
            "depth" => &mut self.depth,
            "motion" => &mut self.motion,
            _ => &mut self.acceleration,
        };
        table.retain(|(key, _)| *key != set.key);
        table.extend(set.value.clone().map(|value| (set.key, value)));
    }

    /// Returns what is open, one after the other; first of all how it stands.
    pub fn open(&self) -> Vec<Axis> {
        let set = |table, key, value: &str| Set { table, key, value: Some(value.to_owned()) };
        let kind = |table: &Table| table[0].1.trim_matches('"').to_owned();
        let mut open = Vec::new();
        if kind(&self.motion) == "camera" {
            open.push(Axis { what: "the update among the poses", options: self.places() });
            let conventions = [("transform", "camera-to-world"), ("transform", "world-to-camera")];
            let axes = [("axes", "opencv"), ("axes", "opengl"), ("axes", "ned")];
            for (what, options) in [("what the poses map to what", &conventions[..]), ("axes", &axes[..])] {
                let options = options.iter().map(|(key, value)| vec![set("motion", key, &quoted(value))]);
                open.push(Axis { what, options: [Vec::new()].into_iter().chain(options).collect() });
            }
        } else {
            open.push(Axis { what: "", options: vec![Vec::new()] });
        }
        if kind(&self.motion) == "flow" {
            let signs = [vec![], vec![("sign", "-1")], vec![("y", "\"up\"")], vec![("sign", "-1"), ("y", "\"up\"")]];
            let units = [vec![], vec![("units", "\"picture\"")], vec![("units", "\"ndc\"")]];
            let options = units.iter().flat_map(|unit| {
                signs.iter().map(move |sign| {
                    unit.iter().chain(sign).map(|(key, value)| set("motion", key, value)).collect::<Vec<Set>>()
                })
            });
            open.push(Axis { what: "where the vectors point and their unit", options: options.collect() });
        }
        if kind(&self.motion) == "disparity" {
            let options = [1.0, 0.5, 0.25, 0.125, 0.0625, 1.0 / 256.0].iter().flat_map(|scale| {
                let scale = scale.to_string();
                ["-1", "1"].map(|sign| {
                    vec![set("motion", "scale", &scale), set("depth", "scale", &scale), set("motion", "sign", sign)]
                })
            });
            open.push(Axis { what: "pixels of a disparity", options: options.collect() });
        } else if let Some(depth) = &self.depth_role
            && depth.whole
            && kind(&self.depth) == "z"
        {
            let scales = ["0.001", "0.0002", "0.00390625", "0.01", "1"];
            let options = scales.iter().map(|scale| vec![set("depth", "scale", scale)]).collect();
            open.push(Axis { what: "unit of the depth", options });
        }
        if let Some(depth) = &self.depth_role
            && kind(&self.depth) == "z"
            && kind(&self.motion) == "camera"
        {
            let mut options = vec![Vec::new(), vec![set("depth", "kind", "\"ray\"")]];
            if depth.unit {
                options.push(vec![set("depth", "kind", "\"disparity\"")]);
            }
            open.push(Axis { what: "along what the depth is", options });
        }
        if let Some(next) = &self.next {
            let frames = self.motion.iter().find(|(key, _)| *key == "frames").map_or("1", |(_, value)| value);
            let mut taken =
                vec![set("acceleration", "kind", "\"next-flow\""), set("acceleration", "file", &quoted(next))];
            taken.push(set("acceleration", "frames", frames));
            let keys = ["channel", "sign", "y", "units"];
            taken.extend(keys.iter().filter_map(|key| {
                let (key, value) = self.motion.iter().find(|(own, _)| own == key)?;
                Some(set("acceleration", key, value))
            }));
            open.push(Axis { what: "acceleration from the vectors that follow", options: vec![Vec::new(), taken] });
        }
        open
    }

    /// Returns where the update may be among poses: at the time or number of its picture, at its place, or near the
    /// beginning.
    fn places(&self) -> Vec<Vec<Set>> {
        /// Poses from the first on that are tried.
        const TRIED: usize = 12;
        let (place, number) = self.place;
        let set = |key, value: String| vec![Set { table: "motion", key, value: Some(value) }];
        let mut options = Vec::new();
        if let Some(number) = number {
            if number.fract() == 0.0 && (0.0..1e9).contains(&number) {
                options.push(set("pose", format!("{number}")));
            }
            options.push(set("time", format!("{number:?}")));
        }
        // Without a picture that decides, what the files say is all there is.
        let tried = if self.judge.is_some() { TRIED } else { 0 };
        options.extend([place].into_iter().chain(0..tried).map(|place| set("pose", place.to_string())));
        options
    }

    /// Returns the manifest with these later pictures.
    pub fn text(&self, later: &[Later]) -> String {
        let inline = |table: &Table| {
            let entries: Vec<String> = table.iter().map(|(key, value)| format!("{key} = {value}")).collect();
            format!("{{ {} }}", entries.join(", "))
        };
        let (depth, motion) = (inline(&self.depth), inline(&self.motion));
        let mut text = format!(
            "frames = {}\n\n[update]\ncolor = {}\ndepth = {depth}\nmotion = {motion}\n",
            self.frames, self.colour
        );
        if !self.acceleration.is_empty() {
            let _ = writeln!(text, "acceleration = {}", inline(&self.acceleration));
        }
        if let Some(overlay) = &self.overlay {
            let _ = writeln!(text, "overlay = {{ file = {overlay} }}");
        }
        for Later { frame, colour } in later {
            let _ = write!(text, "\n[[truth]]\nframe = {frame}\ncolor = {colour}\n");
        }
        text
    }
}

/// Returns a manifest with what its lines mean, how they were chosen, and what is not used.
pub(super) fn commented(text: &str, best: &Best, against: Option<(f64, f64)>, unused: &[String]) -> String {
    /// Files that are named as unused.
    const NAMED: usize = 12;
    let mut lines = vec![
        "# Written by `galpix init` from what the files are. `galpix check` says what is read; every key is in"
            .to_owned(),
        "# docs/captures.md.".to_owned(),
    ];
    match against {
        Some((moved, still)) => lines.push(format!(
            "# Against the first later picture: the update moved to it {moved:.2} dB, unchanged {still:.2} dB."
        )),
        None => lines.push("# No later picture: nothing of this could be compared with what really came.".to_owned()),
    }
    if !best.chosen.is_empty() {
        lines.push("# Chosen by that picture, where the files leave it open:".to_owned());
        lines.extend(best.chosen.iter().map(|chosen| format!("#   {chosen}")));
    }
    let about = [
        ("frames = ", "display frames from the update to the last picture that it is compared with"),
        ("color = ", "the picture that the renderer delivered"),
        ("depth = { kind = \"speed\"", "no depth is known: the faster of two pixels is taken for the nearer one"),
        ("depth = ", "distance = sign * scale * raw + offset"),
        ("motion = { kind = \"camera\"", "from depth and the camera's path; pose: the update's, counted from 0"),
        ("motion = ", "frames: the display frames that a vector spans"),
        ("acceleration = ", "what the vectors from the next picture on add; leave it out if they are not exact"),
        ("overlay = ", "pinned over the picture"),
        ("[[truth]]", "what was really seen later; only compared with, never shown"),
    ];
    let mut said: Vec<&str> = Vec::new();
    lines.push(String::new());
    for line in text.lines() {
        if let Some((start, about)) = about.iter().find(|(start, _)| line.starts_with(start))
            && !(said.contains(start) || line.starts_with("color") && said.contains(&"[[truth]]"))
        {
            said.push(start);
            lines.push(format!("# {about}"));
        }
        lines.push(line.to_owned());
    }
    if !unused.is_empty() {
        let names: Vec<String> = unused.iter().take(NAMED).map(|name| name.escape_default().to_string()).collect();
        let more = unused.len().saturating_sub(NAMED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        lines.push(format!("\n# Not used: {}{more}", names.join(", ")));
    }
    lines.join("\n") + "\n"
}
