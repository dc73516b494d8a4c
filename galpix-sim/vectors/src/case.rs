//! The content of a case, as written to JSON.

use galpix_core::record::{Component, Field};
use galpix_core::{Bits, Layout, Record, Tally};
use schemars::JsonSchema;
use serde::Serialize;

use crate::disocclusion::Disocclusion;
use crate::layered::Layers;
use crate::objects::Objects;
use crate::rtl;
use crate::source::StationarySources;
use crate::sub_cell::SubCell;

/// Everything that was written, with the hash of every file.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Manifest {
    /// The format's name and version.
    pub format: String,
    /// What the random maps were drawn with.
    pub seed: u64,
    /// The cases, in the order in which they were made.
    pub cases: Vec<Entry>,
}

/// One case of the manifest.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Entry {
    /// The case's name and folder.
    pub name: String,
    /// step, propagate, resolve, edge, fill, frame, inpaint, layers, objects, disocclusion, subcell or source.
    pub kind: String,
    /// Its files.
    pub files: Vec<FileHash>,
    /// The hash of each frame; empty for the other kinds.
    pub frames: Vec<String>,
    /// The CRC-32 of each frame, of the same bytes.
    pub crc32: Vec<u32>,
}

/// A file and its SHA-256.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct FileHash {
    /// Relative to the manifest.
    pub path: String,
    /// In hexadecimal digits.
    pub sha256: String,
}

/// One case.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Case {
    /// Its name.
    pub name: String,
    /// What it shows.
    pub about: String,
    /// Inputs and outputs.
    #[serde(flatten)]
    pub content: Content,
}

/// Inputs and outputs by kind.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Content {
    /// The step kernel of one component.
    Step(Step),
    /// The step of whole galpixels.
    Propagate(Propagate),
    /// Arrivals resolved into an empty map.
    Resolve(Resolve),
    /// The edge map.
    Edge(Edge),
    /// Holes.
    Fill(Fill),
    /// Whole frames.
    Frame(Frames),
    /// What is painted after a frame.
    Inpaint(Inpaint),
    /// Whole frames of several layers.
    Layers(Layers),
    /// Objects that enter a map.
    Objects(Objects),
    /// What a map may uncover.
    Disocclusion(Disocclusion),
    /// What a display shows of a map.
    SubCell(SubCell),
    /// Samples that stay where they are, and what a display shows of them.
    Source(StationarySources),
}

impl Content {
    /// Returns the kind's name.
    #[must_use]
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Step(_) => "step",
            Self::Propagate(_) => "propagate",
            Self::Resolve(_) => "resolve",
            Self::Edge(_) => "edge",
            Self::Fill(_) => "fill",
            Self::Frame(_) => "frame",
            Self::Inpaint(_) => "inpaint",
            Self::Layers(_) => "layers",
            Self::Objects(_) => "objects",
            Self::Disocclusion(_) => "disocclusion",
            Self::SubCell(_) => "subcell",
            Self::Source(_) => "source",
        }
    }
}

/// Steps of one component.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Step {
    /// The widths.
    pub component: ComponentWidths,
    /// The rounding's name.
    pub rounding: String,
    /// Frame counter, position, velocity, acceleration.
    pub steps: Vec<(u32, i32, i32, i32)>,
    /// Position, cells moved, offset, velocity, saturated (1 or 0).
    pub results: Vec<(i32, i32, i32, i32, u32)>,
}

/// Steps of whole galpixels.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Propagate {
    /// Widths, fields, places. Its grid has one cell.
    #[serde(flatten)]
    pub setting: Setting,
    /// The rounding's name.
    pub rounding: String,
    /// Frame counters and galpixels before the step.
    pub galpixels: Vec<Stamped>,
    /// The same after it.
    pub results: Vec<Moved>,
}

/// A galpixel before its step.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Stamped {
    /// The frame counter.
    pub frame: u32,
    /// Its words.
    pub words: Vec<u32>,
}

/// A galpixel after its step.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Moved {
    /// Its words.
    pub words: Vec<u32>,
    /// The cells that it moves to the right and down.
    pub cells: [i32; 2],
    /// Its fields that were clamped.
    pub saturated: u32,
}

/// How whole frames are made.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Making {
    /// The rounding's name.
    pub rounding: String,
    /// The fill mode.
    #[serde(rename = "rung")]
    pub fill_mode: String,
    /// Rounds of bullet filling.
    pub reach: u32,
    /// Of the edge map, in units of the depth's last bit.
    pub threshold: u32,
    /// The frame counter at first.
    pub frame: u32,
}

/// What all cases over a map have.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Setting {
    /// Widths.
    pub budget: Budget,
    /// Fields.
    pub layout: LayoutFields,
    /// Where the fields are.
    pub record: RecordPlaces,
    /// The size.
    pub grid: GridSize,
    /// The parameters of the reference design for this record.
    #[serde(skip)]
    pub parameters: Vec<String>,
}

/// Arrivals and the map that they resolve into.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Resolve {
    /// Widths, fields, places, size.
    #[serde(flatten)]
    pub setting: Setting,
    /// In no particular order.
    pub arrivals: Vec<ArrivalWords>,
    /// The resolved map.
    pub map: Vec<u32>,
    /// Who won each cell.
    pub winners: Vec<u32>,
    /// What was counted.
    pub counts: Counts,
}

/// A map and its edges.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Edge {
    /// Widths, fields, places, size.
    #[serde(flatten)]
    pub setting: Setting,
    /// In units of the depth's last bit.
    pub threshold: u32,
    /// The map.
    pub front: Vec<u32>,
    /// The bit map.
    pub edges: Vec<u32>,
    /// What was counted.
    pub counts: Counts,
}

/// A resolved map and what its holes become.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Fill {
    /// Widths, fields, places, size.
    #[serde(flatten)]
    pub setting: Setting,
    /// The fill mode.
    #[serde(rename = "rung")]
    pub fill_mode: String,
    /// Rounds of bullet filling.
    pub reach: u32,
    /// The edge map of `front`.
    pub edges: Vec<u32>,
    /// The map before.
    pub front: Vec<u32>,
    /// The map after resolution.
    pub resolved: Vec<u32>,
    /// Who won each cell.
    pub winners: Vec<u32>,
    /// The map after filling.
    pub map: Vec<u32>,
    /// The winner map after filling.
    pub winners_after: Vec<u32>,
    /// What was counted.
    pub counts: Counts,
}

/// A map and some frames after it.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Frames {
    /// Widths, fields, places, size.
    #[serde(flatten)]
    pub setting: Setting,
    /// How they are made.
    #[serde(flatten)]
    pub making: Making,
    /// The first map.
    pub front: Vec<u32>,
    /// The frames after it.
    pub frames: Vec<FrameAfter>,
}

/// One frame.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct FrameAfter {
    /// Of the words of `map`.
    pub sha256: String,
    /// What was counted.
    pub counts: Counts,
    /// The map.
    pub map: Vec<u32>,
    /// What came before it.
    #[serde(skip)]
    pub stages: Stages,
}

/// What the stages of a frame gave. It is no part of the case, for it follows from the map before.
#[derive(Clone, Debug, Default)]
pub struct Stages {
    /// The edge map of the map before, whatever the fill mode.
    pub edges: Vec<u32>,
    /// The source of each arrival, in raster order.
    pub sources: Vec<u32>,
    /// The cell of each; `u32::MAX` where it left the map.
    pub cells: Vec<u32>,
    /// The words of one arrival after the other.
    pub arrivals: Vec<u32>,
    /// Who won each cell.
    pub winners: Vec<u32>,
    /// The map after resolution.
    pub resolved: Vec<u32>,
}

/// A map, the frame of fill mode extend after it, and what that becomes by push-pull.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Inpaint {
    /// Widths, fields, places, size.
    #[serde(flatten)]
    pub setting: Setting,
    /// The rounding's name.
    pub rounding: String,
    /// Rounds of bullet filling.
    pub reach: u32,
    /// Of the edge map, in units of the depth's last bit.
    pub threshold: u32,
    /// The frame counter of `front`.
    pub frame: u32,
    /// The power of the validity: 0, 1/2 or 1.
    pub gamma: String,
    /// Between foreground and background, in units of the depths of push-pull.
    pub inpaint_threshold: u32,
    /// Whether holes take the motion and not the colour alone.
    pub motion: bool,
    /// Whether holes get the depth of the background first.
    pub background: bool,
    /// A bit for each cell; empty for all of them.
    pub mask: Vec<u32>,
    /// The map before the frame.
    pub front: Vec<u32>,
    /// The edge map of `front`; empty where the frame was made without one.
    pub edges: Vec<u32>,
    /// The map after the frame.
    pub after: Vec<u32>,
    /// The map after inpainting.
    pub map: Vec<u32>,
}

/// One arrival.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct ArrivalWords {
    /// The cell that it comes from.
    pub source: u32,
    /// The cell that it wants; null where it left the map.
    pub cell: Option<u32>,
    /// The galpixel after its step.
    pub words: Vec<u32>,
}

/// Widths of a component.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct ComponentWidths {
    position_frac: u32,
    velocity_int: u32,
    velocity_frac: u32,
    acceleration_int: u32,
    acceleration_frac: u32,
}

/// Widths of a budget.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Budget {
    /// x, y, depth.
    components: [ComponentWidths; 3],
    depth_int: u32,
    luminosity_int: u32,
    luminosity_frac: u32,
}

/// Fields of a layout.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct LayoutFields {
    depth_bits: u32,
    velocity: bool,
    acceleration: bool,
    depth_motion: bool,
    luminosity: bool,
    tag_bits: u32,
    colour: String,
}

/// Where the fields of a record are.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RecordPlaces {
    words: usize,
    fields: Vec<FieldPlace>,
}

/// Where one field is.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct FieldPlace {
    name: String,
    bits: u8,
    word: u8,
    shift: u8,
    spill: u8,
}

/// Display and overscan margin.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct GridSize {
    /// Columns of the display.
    pub width: u32,
    /// Rows of the display.
    pub height: u32,
    /// Columns beyond it.
    pub left: u32,
    /// Columns beyond it.
    pub right: u32,
    /// Rows beyond it.
    pub top: u32,
    /// Rows beyond it.
    pub bottom: u32,
}

/// What a frame counted; a part of it for the single stages.
#[derive(Clone, Copy, Debug, Default, Serialize, JsonSchema)]
pub struct Counts {
    moved: u32,
    lost: u32,
    collided: u32,
    saturated: u32,
    edges: u32,
    holes: u32,
    bullets: u32,
    debris: u32,
    galdebris: u32,
    empty: u32,
}

impl From<Component> for ComponentWidths {
    fn from(component: Component) -> Self {
        let Component { position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac } = component;
        Self { position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac }
    }
}

impl From<Tally> for Counts {
    fn from(tally: Tally) -> Self {
        let Tally { moved, lost, collided, saturated, edges, holes, bullets, debris, galdebris, empty } = tally;
        Self { moved, lost, collided, saturated, edges, holes, bullets, debris, galdebris, empty }
    }
}

impl Counts {
    /// Returns them in the order of section 11.
    pub const fn words(&self) -> [u32; 10] {
        let &Self { moved, lost, collided, saturated, edges, holes, bullets, debris, galdebris, empty } = self;
        [moved, lost, collided, saturated, edges, holes, bullets, debris, galdebris, empty]
    }
}

impl ComponentWidths {
    /// Returns the widths with the names that the reference design has for them.
    pub const fn named(&self) -> [(&'static str, u32); 5] {
        let &Self { position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac } = self;
        [
            ("P", position_frac),
            ("VI", velocity_int),
            ("VF", velocity_frac),
            ("AI", acceleration_int),
            ("AF", acceleration_frac),
        ]
    }
}

impl Setting {
    /// Returns the words of a record.
    pub const fn words(&self) -> usize {
        self.record.words
    }

    /// Describes a record that was planned under a budget, and a grid.
    pub fn of(bits: Bits, record: &Record, grid: GridSize) -> Self {
        let &Layout { colour, depth_bits, velocity, acceleration, depth_motion, luminosity, tag_bits } =
            record.layout();
        let colour = match colour.bits() {
            24 => "rgb888",
            16 => "rgb565",
            8 => "gray8",
            _ => "gray4",
        };
        let fields = fields(record).map(|(name, Field { bits, word, shift, spill })| FieldPlace {
            name: name.to_owned(),
            bits,
            word,
            shift,
            spill,
        });
        Self {
            budget: Budget {
                components: [bits.x, bits.y, bits.z].map(ComponentWidths::from),
                depth_int: bits.depth_int,
                luminosity_int: bits.luminosity_int,
                luminosity_frac: bits.luminosity_frac,
            },
            layout: LayoutFields {
                depth_bits,
                velocity,
                acceleration,
                depth_motion,
                luminosity,
                tag_bits,
                colour: colour.to_owned(),
            },
            record: RecordPlaces { words: record.words(), fields: fields.into() },
            grid,
            parameters: rtl::parameters(bits, record),
        }
    }
}

/// Returns all fields of a record by their names, in canonical order.
pub fn fields(record: &Record) -> [(&'static str, Field); 14] {
    [
        ("class", record.class()),
        ("depth", record.depth()),
        ("offset_x", record.offset_x()),
        ("offset_y", record.offset_y()),
        ("velocity_x", record.velocity(0)),
        ("acceleration_x", record.acceleration(0)),
        ("velocity_y", record.velocity(1)),
        ("acceleration_y", record.acceleration(1)),
        ("velocity_depth", record.velocity(2)),
        ("acceleration_depth", record.acceleration(2)),
        ("colour", record.colour()),
        ("tag", record.tag()),
        ("luminosity_rate", record.luminosity_rate()),
        ("luminosity", record.luminosity()),
    ]
}

/// Returns the JSON schema of manifest and cases, derived from the types that are written.
#[must_use]
pub fn schema() -> serde_json::Value {
    #[derive(JsonSchema)]
    #[serde(untagged)]
    #[allow(dead_code)]
    enum File {
        Manifest(Manifest),
        Case(Box<Case>),
    }
    let settings = schemars::generate::SchemaSettings::draft2020_12().for_serialize();
    settings.into_generator().into_root_schema_for::<File>().into()
}
