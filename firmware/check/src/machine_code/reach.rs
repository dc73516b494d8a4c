//! What a function reaches that it must not reach.

use std::collections::{HashSet, VecDeque};
use std::fmt;

use super::image::{Function, Image, Mention};
use super::instructions::{Deed, Machine};

/// A fault, and the calls that lead to it.
#[derive(Debug)]
pub struct Finding {
    /// What is wrong.
    pub what: String,
    /// From the entry to the function at fault.
    pub path: Vec<String>,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n      by {}", self.what, self.path.join("\n      -> "))
    }
}

/// What was read of an entry.
#[derive(Debug, Default)]
pub struct Verdict {
    /// Functions that it reaches, itself included.
    pub functions: usize,
    /// Their instructions.
    pub instructions: usize,
    /// The faults.
    pub findings: Vec<Finding>,
}

/// What a function of the compiler's own is for.
enum Helper {
    /// To copy, fill, compare, or to shift 64 bits. Judged by that: filling memory multiplies its byte by 0x0101_0101,
    /// once a call.
    Harmless,
    /// Arithmetic.
    Arithmetic,
}

fn helper(name: &str) -> Option<Helper> {
    const MEMORY: [&str; 5] = ["memcpy", "memmove", "memset", "memclr", "memcmp"];
    const SHIFTS: [&str; 6] = ["__aeabi_llsl", "__aeabi_llsr", "__aeabi_lasr", "__ashldi3", "__lshrdi3", "__ashrdi3"];
    let short = name.strip_prefix("__aeabi_").unwrap_or(name).trim_end_matches(['4', '8']);
    if MEMORY.contains(&short) || SHIFTS.contains(&name) || name.starts_with("compiler_builtins::mem::") {
        Some(Helper::Harmless)
    } else if name.starts_with("__") || name.starts_with("compiler_builtins::") {
        Some(Helper::Arithmetic)
    } else {
        None
    }
}

/// Reads everything that the function at `entry` reaches. A deed that is `allowed` is no fault; a helper that does it
/// is.
pub fn judge(image: &Image, entry: usize, allowed: Option<Deed>) -> Result<Verdict, String> {
    let mut verdict = Verdict::default();
    let start = Mention::Function(entry);
    let (mut seen, mut queue) = (HashSet::from([start]), VecDeque::from([(start, Vec::new())]));
    while let Some((place, path)) = queue.pop_front() {
        let (name, mentions) = match place {
            Mention::Function(index) => (&image.functions[index].name, &image.functions[index].mentions),
            Mention::Data(index) => (&image.data[index].name, &image.data[index].mentions),
            Mention::Unknown(address) => {
                verdict.findings.push(Finding { what: format!("something unknown at {address:#x}"), path });
                continue;
            }
        };
        let path: Vec<String> = path.into_iter().chain([name.clone()]).collect();
        if let Mention::Function(index) = place {
            look_into(image.machine, &image.functions[index], &path, allowed, &mut verdict)?;
        }
        for &mention in mentions {
            if seen.insert(mention) {
                queue.push_back((mention, path.clone()));
            }
        }
    }
    Ok(verdict)
}

/// Returns the bytes of all code and constants that the function at `entry` reaches, itself included.
pub fn bytes_of(image: &Image, entry: usize) -> u64 {
    let start = Mention::Function(entry);
    let (mut seen, mut queue, mut bytes) = (HashSet::from([start]), VecDeque::from([start]), 0);
    while let Some(place) = queue.pop_front() {
        let (size, mentions) = match place {
            Mention::Function(index) => (image.functions[index].code.len() as u64, &image.functions[index].mentions),
            Mention::Data(index) => (image.data[index].size, &image.data[index].mentions),
            Mention::Unknown(_) => continue,
        };
        bytes += size;
        queue.extend(mentions.iter().filter(|&&mention| seen.insert(mention)));
    }
    bytes
}

/// Reads one function, literals left out.
fn look_into(
    machine: Machine,
    function: &Function,
    path: &[String],
    allowed: Option<Deed>,
    verdict: &mut Verdict,
) -> Result<(), String> {
    let find = |what: String| Finding { what, path: path.to_vec() };
    let helper = helper(&function.name);
    if let Some(Helper::Arithmetic) = helper {
        verdict.findings.push(find(format!("the helper {}", function.name)));
    }
    verdict.functions += 1;
    let (mut at, mut literal, mut marks) = (0, false, function.literals.iter().peekable());
    while at < function.code.len() {
        while let Some(&(_, begins)) = marks.next_if(|&&(from, _)| from <= at as u64) {
            literal = begins;
        }
        if literal {
            at = marks.peek().map_or(function.code.len(), |&&(from, _)| from as usize);
            continue;
        }
        let halfword = |at: usize| function.code.get(at..at + 2).map(|pair| u16::from_le_bytes([pair[0], pair[1]]));
        let first = halfword(at).ok_or_else(|| format!("{}: half an instruction at its end", function.name))?;
        let (bytes, deed) = machine.read(first, halfword(at + 2).unwrap_or(0));
        if let (Some(deed), None) = (deed.filter(|&deed| Some(deed) != allowed), &helper) {
            verdict.findings.push(find(format!("{deed:?} at {:#x}", function.address + at as u64)));
        }
        verdict.instructions += 1;
        at += bytes;
    }
    Ok(())
}
