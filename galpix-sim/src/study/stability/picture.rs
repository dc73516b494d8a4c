//! Whole pictures through all stages of the real controller: what goes in comes out again or is counted.

use std::hash::{DefaultHasher, Hash, Hasher};

use galpix_core::stages::{self, FILLED, NO_WINNER};
use galpix_core::{
    Class, Controller, Dynamic, FillMode, Galpixel, Galpixmap, Grid, Layout, Margin, Rounding, Scratch, Settings, Tally,
};
use schemars::JsonSchema;
use serde::Serialize;

use super::exact::Px;
use super::setting::{Law, Setting};
use crate::engine::EngineError;

/// What floating point may add to a bound.
const FLOAT_PX: f64 = 1e-9;

/// A picture and how long it is moved on.
pub struct Picture {
    /// What distinguishes it from the others of its case.
    pub name: String,
    /// Columns and rows of the display.
    pub size: [u32; 2],
    /// What the map has beyond it.
    pub margin: Margin,
    /// What cell (x, y) of the map holds; margin included.
    pub galpixel: Box<dyn Fn(u32, u32) -> Galpixel + Send + Sync>,
    /// What a galpixel carries.
    pub layout: Layout,
    /// Frames.
    pub frames: u32,
    /// The frame counter at the start.
    pub counter: u32,
    /// The name of another picture that must give the same bits.
    pub same_as: Option<String>,
}

/// What a frame counted, and what it counted before.
#[derive(Clone, Copy, Debug, Default)]
pub struct Census {
    /// Cells of the map.
    pub cells: u32,
    /// Cells that were not empty before the frame.
    pub held: u32,
    /// Cells that an arrival settled in.
    pub settled: u32,
    /// Of these, how many came from a cell that another one came from, too, or from an empty or impossible one.
    pub strange: u32,
    /// Cells that are empty after the frame.
    pub empty: u32,
    /// What the engine counted.
    pub tally: Tally,
}

impl Census {
    /// Returns what does not add up, in words.
    #[must_use]
    pub fn findings(&self) -> Vec<String> {
        let Tally { moved, lost, collided, holes, bullets, debris, galdebris, empty, edges, .. } = self.tally;
        let all = [
            (moved == self.held, format!("moved {moved} of {} galpixels", self.held)),
            (
                moved == self.settled + lost + collided,
                format!("moved {moved}, but settled {} + lost {lost} + collided {collided}", self.settled),
            ),
            (
                holes + self.settled == self.cells,
                format!("{holes} holes + {} settled of {} cells", self.settled, self.cells),
            ),
            (
                bullets + debris + galdebris + empty == holes,
                format!("{bullets} + {debris} + {galdebris} + {empty} are not {holes} holes"),
            ),
            (empty == self.empty, format!("{} cells are empty, {empty} were counted", self.empty)),
            (self.strange == 0, format!("{} galpixels came from nowhere or twice", self.strange)),
            (edges <= self.cells, format!("{edges} edges in {} cells", self.cells)),
        ];
        all.into_iter().filter(|(kept, _)| !kept).map(|(_, finding)| finding).collect()
    }
}

/// What a picture gave with one fill mode.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct Outcome {
    /// The picture's name.
    pub picture: String,
    /// The fill mode.
    #[serde(rename = "rung")]
    pub fill_mode: &'static str,
    /// Cells of the map, margin included.
    pub cells: u32,
    /// Frames made.
    pub frames: u32,
    /// Galpixels and debris propagated, all frames together.
    pub moved: u64,
    /// Of these, settled in a cell.
    pub settled: u64,
    /// Of these, left the map.
    pub lost: u64,
    /// Of these, met another and lost.
    pub collided: u64,
    /// Cells that nothing reached.
    pub holes: u64,
    /// Fields that were clamped, when stored and since.
    pub clamped: u64,
    /// Galpixels of the update that were compared with their exact path.
    pub followed: u64,
    /// The largest error of these, in pixels.
    pub worst_px: f64,
    /// The bound of the last frame, in pixels.
    pub bound_px: f64,
    /// Frame by frame: settled, lost, collided, holes.
    pub tallies: Vec<[u32; 4]>,
    /// A number that stands for every bit of every frame.
    pub bits: u64,
    /// What does not add up.
    pub findings: Vec<String>,
}

/// Moves a picture on with a fill mode.
///
/// *Errors:* a picture that cannot be laid out.
pub fn run(
    picture: &Picture,
    setting: &Setting,
    laws: [&Law; 2],
    rounding: Rounding,
    fill_mode: FillMode,
) -> Result<Outcome, EngineError> {
    let format = Dynamic::new(setting.bits, picture.layout)?;
    let [width, height] = picture.size;
    let mut starts = vec![0; Grid::rows(height, picture.margin)];
    let grid = Grid::new(width, height, picture.margin, &mut starts)?;
    let words = Galpixmap::words(&grid, format);
    let (mut front, mut back) = (vec![0; words], vec![0; words]);
    let (mut winners, mut edges) = (vec![0; grid.cells() as usize], vec![0; stages::words(&grid)]);
    let mut controller = Controller::new(
        Galpixmap::new(grid, format, &mut front)?,
        Galpixmap::new(grid, format, &mut back)?,
        Scratch { winners: &mut winners, edges: &mut edges },
    )?;
    controller.set_frame(picture.counter);
    let settings = Settings { rounding, fill_mode, ..Settings::for_depth(setting.record.depth().bits.into()) };
    let mut outcome = Outcome {
        picture: picture.name.clone(),
        fill_mode: fill_mode.name(),
        cells: grid.cells(),
        frames: picture.frames,
        bound_px: laws[0].bound_px(picture.frames, picture.counter == 0),
        ..Outcome::default()
    };
    let mut tracks = Vec::with_capacity(grid.cells() as usize);
    for y in 0..grid.height() {
        for x in 0..grid.width() {
            let galpixel = (picture.galpixel)(x, y);
            let clamped = controller.front_mut().store(x as i32, y as i32, &galpixel).unwrap_or(0);
            outcome.clamped += u64::from(clamped);
            let alive = galpixel.class == Class::Galpixel && clamped == 0;
            tracks.push(alive.then(|| Track::of([x, y], &galpixel, setting)));
        }
    }
    let mut origins: Vec<u32> = (0..grid.cells()).collect();
    let mut bits = DefaultHasher::new();
    for number in 1..=picture.frames {
        let held: Vec<bool> = (0..grid.cells()).map(|cell| controller.front().class(cell) != Class::Empty).collect();
        let tally = controller.step(&settings);
        let census = census(&controller, &held, tally);
        outcome.count(&census, number);
        origins = controller
            .winners()
            .iter()
            .map(|&winner| origins.get(winner as usize).copied().unwrap_or(NO_WINNER))
            .collect();
        (0..).map_while(|plane| controller.front().plane(plane)).for_each(|plane| plane.hash(&mut bits));
        for (cell, &origin) in (0u32..).zip(&origins) {
            let Some(Some(track)) = tracks.get(origin as usize) else { continue };
            if number > track.covered || controller.front().class(cell) != Class::Galpixel {
                continue;
            }
            let (x, y) = ((cell % grid.width()) as i32, (cell / grid.width()) as i32);
            let Some(galpixel) = controller.front().load(x, y) else { continue };
            let bounds = laws.map(|law| law.bound_px(number, picture.counter == 0));
            let cell = [x, y].map(|cell| Px::of(cell.into(), 0));
            let place = [0, 1].map(|axis| cell[axis] + Px::given(galpixel.offset[axis], 0));
            outcome.compare(track, place, number, bounds);
        }
    }
    outcome.bits = bits.finish();
    Ok(outcome)
}

/// The exact path of a galpixel in the plane.
struct Track {
    motion: [[Px; 3]; 2],
    /// Frames in which its velocity does not leave its field.
    covered: u32,
}

impl Track {
    fn of(cell: [u32; 2], galpixel: &Galpixel, setting: &Setting) -> Self {
        let motion = [0, 1].map(|axis| {
            let place = Px::of(i64::from(cell[axis]), 0) + Px::given(galpixel.offset[axis], 0);
            [place, Px::given(galpixel.velocity[axis], 0), Px::given(galpixel.acceleration[axis], 0)]
        });
        let within = |frames: u32| {
            (0..2).all(|axis| {
                let ranges = setting.ranges(axis);
                let frac = ranges.scale.velocity_frac;
                let v = Px::of(motion[axis][1].nearest(frac), frac)
                    + Px::of(motion[axis][2].nearest(ranges.scale.acceleration_frac), ranges.scale.acceleration_frac)
                        .times(frames);
                (-1 - ranges.velocity_top..=ranges.velocity_top).contains(&v.nearest(frac))
            })
        };
        let covered = (0..=setting.demand.prop).take_while(|&frames| within(frames)).last().unwrap_or(0);
        Self { motion, covered }
    }
}

fn census(controller: &Controller<'_, Dynamic>, held: &[bool], tally: Tally) -> Census {
    let mut taken = vec![false; held.len()];
    let mut census = Census { cells: held.len() as u32, tally, ..Census::default() };
    census.held = held.iter().filter(|&&held| held).count() as u32;
    for (cell, &winner) in (0u32..).zip(controller.winners()) {
        census.empty += u32::from(controller.front().class(cell) == Class::Empty);
        if winner >= FILLED {
            continue;
        }
        census.settled += 1;
        let source = winner as usize;
        let fresh = held.get(source) == Some(&true) && !taken[source];
        census.strange += u32::from(!fresh);
        if fresh {
            taken[source] = true;
        }
    }
    census
}

impl Outcome {
    fn count(&mut self, census: &Census, frame: u32) {
        let Tally { moved, lost, collided, holes, saturated, .. } = census.tally;
        self.moved += u64::from(moved);
        self.settled += u64::from(census.settled);
        self.lost += u64::from(lost);
        self.collided += u64::from(collided);
        self.holes += u64::from(holes);
        self.clamped += u64::from(saturated);
        self.tallies.push([census.settled, lost, collided, holes]);
        if self.findings.is_empty() {
            self.findings.extend(census.findings().into_iter().map(|finding| format!("{finding} (frame {frame})")));
        }
    }

    fn compare(&mut self, track: &Track, place: [Px; 2], frame: u32, bounds: [f64; 2]) {
        self.followed += 1;
        for axis in 0..2 {
            let [r, v, a] = track.motion[axis];
            let off = (r + v.times(frame) + a.accelerated(frame) - place[axis]).abs().to_f64();
            self.worst_px = self.worst_px.max(off);
            if off > bounds[axis] + FLOAT_PX && self.findings.is_empty() {
                self.findings.push(format!("a galpixel is {off:.4} px off, over {:.4} (frame {frame})", bounds[axis]));
            }
        }
    }
}
