//! The cases, each with one line on what it stresses.

mod ends;
mod long;
mod motion;
mod pictures;

use super::path::Path;
use super::picture::Picture;
use super::setting::Setting;

/// One case: paths of single galpixels, whole pictures, or both.
pub struct Case {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it stresses.
    pub stress: &'static str,
    /// Components of galpixels that are followed.
    pub paths: fn(&Setting) -> Vec<Path>,
    /// Pictures that go through all stages with every fill mode.
    pub pictures: fn(&Setting) -> Vec<Picture>,
}

const fn paths(name: &'static str, stress: &'static str, paths: fn(&Setting) -> Vec<Path>) -> Case {
    Case { name, stress, paths, pictures: |_| Vec::new() }
}

const fn pictures(name: &'static str, stress: &'static str, pictures: fn(&Setting) -> Vec<Picture>) -> Case {
    Case { name, stress, paths: |_| Vec::new(), pictures }
}

/// All of them, in order.
pub const ALL: [Case; 22] = [
    paths(
        "turn-round",
        "across the whole display and back within tau_recog: the fastest that can be seen",
        motion::turn_round,
    ),
    paths("rotation", "a full turn in 1 to 2 tau_recog: jerk that second order cannot know", motion::rotation),
    paths("oscillators", "stiff springs, one period from 4 tau_prop down to 3 frames", motion::oscillators),
    paths("near-plane", "towards the near plane: 1/z, in the picture and in depth", motion::near_plane),
    paths("bounce", "a velocity that jumps between two updates", motion::bounce),
    paths("sub-lsb", "512 frames without an update, slower than a last bit of position or velocity", long::sub_lsb),
    paths("in-step", "512 frames without an update, an acceleration that keeps step with the rounding", long::in_step),
    paths(
        "re-anchored",
        "an update every tau_prop frames, without end: no error may grow from one to the next",
        long::re_anchored,
    ),
    paths(
        "extremes-plane",
        "position, velocity and acceleration at both ends of their fields and at 0, all combinations",
        ends::plane,
    ),
    paths("extremes-depth", "the same in depth, whose position ends too", ends::depth),
    paths(
        "edge-of-overflow",
        "the largest velocity against the largest opposite acceleration, and one step around both",
        ends::opposite,
    ),
    paths("saturating", "a velocity that leaves its field in the middle of a path", ends::saturating),
    paths("depth-ends", "into the nearest and the farthest depth, and out again", ends::depth_ends),
    Case {
        name: "counter-wrap",
        stress: "a frame counter that goes from 2^32 - 1 to 0",
        paths: long::counter_wrap,
        pictures: pictures::counter_wrap,
    },
    pictures(
        "every-field",
        "all fields of a galpixel at their ends at once, shading inertia and tag included",
        pictures::every_field,
    ),
    pictures(
        "checkerboard",
        "neighbours move in opposite directions, along rows, columns and both",
        pictures::checkerboard,
    ),
    pictures("one-cell", "all galpixels want one cell", pictures::one_cell),
    pictures("off-screen", "all galpixels leave in one frame", pictures::off_screen),
    pictures("empty", "a map without a galpixel", pictures::empty),
    pictures("sizes", "one cell, one row, one column, odd sides, one more and one less than a chunk", pictures::sizes),
    pictures("wings", "overscan margins of 0, of different widths, and larger than the display", pictures::margins),
    pictures("old-debris", "debris four times as old as tau_prop among galpixels", pictures::old_debris),
];
