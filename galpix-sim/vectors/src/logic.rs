//! What a test bench in logic needs besides the arrays of a case: its parameters, counts and checksums, records that
//! are one number each, and what the stages of a frame gave.

use crate::case::{Case, Content, Setting};
use crate::hash::crc32;
use crate::rtl;
use crate::write::Choice;

/// An array by its name, with the words that make a number.
type Array = (String, Vec<u32>, usize);

/// Returns the further arrays of a case.
pub fn arrays(content: &Content, choice: &Choice) -> Vec<Array> {
    let mut arrays = Vec::new();
    let mut put = |name: &str, words: Vec<u32>, a_line: usize| arrays.push((name.to_owned(), words, a_line));
    match content {
        Content::Frame(frames) => {
            let words = frames.setting.words();
            put("counts", frames.frames.iter().flat_map(|frame| frame.counts.words()).collect(), 1);
            put("crc32", frames.frames.iter().map(|frame| crc32(&frame.map)).collect(), 1);
            if choice.records {
                put("front_records", records(&frames.front, words), words);
            }
            for (n, frame) in (1..).zip(&frames.frames) {
                if choice.records {
                    put(&format!("map_{n}_records"), records(&frame.map, words), words);
                }
                if choice.stages {
                    let stages = &frame.stages;
                    put(&format!("edges_{n}"), stages.edges.clone(), 1);
                    put(&format!("source_{n}"), stages.sources.clone(), 1);
                    put(&format!("cell_{n}"), stages.cells.clone(), 1);
                    put(&format!("arrivals_{n}"), stages.arrivals.clone(), 1);
                    put(&format!("winners_{n}"), stages.winners.clone(), 1);
                    put(&format!("resolved_{n}"), stages.resolved.clone(), 1);
                }
            }
        }
        Content::Resolve(resolve) => put("counts", resolve.counts.words().into(), 1),
        Content::Edge(edge) => put("counts", edge.counts.words().into(), 1),
        Content::Fill(fill) => put("counts", fill.counts.words().into(), 1),
        _ => {}
    }
    arrays
}

/// Returns the words of a map that is stored plane by plane cell by cell.
fn records(map: &[u32], words: usize) -> Vec<u32> {
    let cells = map.len() / words;
    (0..cells).flat_map(|cell| (0..words).map(move |word| map[word * cells + cell])).collect()
}

/// Returns the parameters of a case as SystemVerilog: of its record first, then, after an empty line, its own. None for
/// kinds that the reference design has no bench for.
pub fn parameters(case: &Case) -> Option<String> {
    let number = |name: &str, value: usize| rtl::declared(name, value as u32);
    let of = |setting: &Setting, own: Vec<String>| {
        [setting.parameters.clone(), vec![String::new()], rtl::grid(&setting.grid), own].concat()
    };
    let lines = match &case.content {
        Content::Step(step) => {
            let widths = step.component.named().map(|(name, bits)| format!("localparam int {name} = {bits};"));
            let own = [number("ROUNDING", rtl::rounding_number(&step.rounding)), number("STEPS", step.steps.len())];
            [widths.to_vec(), vec![String::new()], own.into()].concat()
        }
        Content::Propagate(propagate) => {
            let own = vec![
                number("ROUNDING", rtl::rounding_number(&propagate.rounding)),
                number("GALPIXELS", propagate.galpixels.len()),
            ];
            of(&propagate.setting, own)
        }
        Content::Resolve(resolve) => of(&resolve.setting, vec![number("ARRIVALS", resolve.arrivals.len())]),
        Content::Edge(edge) => of(&edge.setting, vec![rtl::declared("THRESHOLD", edge.threshold)]),
        Content::Fill(fill) => {
            let own = vec![number("FILL_MODE", rtl::fill_number(&fill.fill_mode)), rtl::declared("REACH", fill.reach)];
            of(&fill.setting, own)
        }
        Content::Frame(frames) => {
            let making = &frames.making;
            let own = vec![
                number("ROUNDING", rtl::rounding_number(&making.rounding)),
                number("FILL_MODE", rtl::fill_number(&making.fill_mode)),
                rtl::declared("REACH", making.reach),
                rtl::declared("THRESHOLD", making.threshold),
                rtl::declared("FRAME", making.frame),
                number("FRAMES", frames.frames.len()),
            ];
            of(&frames.setting, own)
        }
        _ => return None,
    };
    Some(lines.join("\n") + "\n")
}
