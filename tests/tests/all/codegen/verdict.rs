//! What an entry reaches that the core must not reach.

use std::fmt;

use super::instructions::{Deed, Machine, read};
use super::library::Library;

/// The symbol that the panic handler of `tests/codegen` mentions and nothing defines.
const CAN_PANIC: &str = "galpix_core_can_panic";

/// A kind of fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A panic can be reached.
    Panic,
    /// An instruction, see [`Deed`].
    Instruction(Deed),
    /// A compiler's helper other than those that copy, fill, compare or shift.
    Helper,
    /// Code that is not in the library, and so was not seen.
    Unknown,
}

/// A fault, and the calls that lead to it.
pub struct Finding {
    /// What is wrong.
    pub fault: Fault,
    /// The instruction or the symbol.
    pub what: String,
    /// From the entry to the function at fault.
    pub path: Vec<String>,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}: {}\n      by {}", self.fault, self.what, self.path.join("\n      -> "))
    }
}

/// What was read of an entry.
pub struct Verdict {
    /// Instructions in all that the entry reaches.
    pub instructions: usize,
    /// The faults.
    pub findings: Vec<Finding>,
}

/// Returns whether a symbol is a helper that the compiler may call for what is no arithmetic: to copy, fill, compare,
/// or to shift 64 bits.
fn harmless_helper(symbol: &str) -> bool {
    const MEMORY: [&str; 5] = ["memcpy", "memmove", "memset", "memclr", "memcmp"];
    const SHIFTS: [&str; 6] = ["__aeabi_llsl", "__aeabi_llsr", "__aeabi_lasr", "__ashldi3", "__lshrdi3", "__ashrdi3"];
    let memory = symbol.strip_prefix("__aeabi_").unwrap_or(symbol).trim_end_matches(['4', '8']);
    MEMORY.contains(&memory) || SHIFTS.contains(&symbol)
}

/// Reads everything that `entry` reaches. A deed that is `allowed` is no fault; a helper that does it is.
pub fn judge(machine: Machine, library: &Library, entry: &str, allowed: Option<Deed>) -> Result<Verdict, String> {
    let reach = library.reach(entry).ok_or_else(|| format!("the library does not define {entry}"))?;
    let mut verdict = Verdict { instructions: 0, findings: Vec::new() };
    for (symbol, path) in reach.undefined {
        let fault = if symbol == CAN_PANIC { Fault::Panic } else { Fault::Unknown };
        verdict.findings.push(Finding { fault, what: symbol, path });
    }
    for (place, path) in reach.sections {
        let section = &library.sections[place];
        if section.code.is_empty() {
            continue;
        }
        // Helpers are judged by what they are for: filling memory multiplies its byte by 0x0101_0101, once a call.
        let helper = section.member.contains("compiler_builtins");
        if helper && section.symbol == section.name && !harmless_helper(&section.symbol) {
            verdict.findings.push(Finding { fault: Fault::Helper, what: section.symbol.clone(), path: path.clone() });
        }
        let reading = read(machine, section)?;
        verdict.instructions += reading.count;
        for (deed, what) in reading.deeds.into_iter().filter(|&(deed, _)| !helper && Some(deed) != allowed) {
            verdict.findings.push(Finding { fault: Fault::Instruction(deed), what, path: path.clone() });
        }
    }
    Ok(verdict)
}
