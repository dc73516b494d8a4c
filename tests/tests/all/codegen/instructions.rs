//! Machine code as instructions, and which of them multiply, divide or calculate with floats.

use capstone::prelude::*;

use super::library::Section;

/// A kind of processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Machine {
    /// Armv6-M: Cortex-M0.
    Thumb,
    /// RV32IMAC.
    RiscV32,
}

/// What an instruction does that the core must not do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Deed {
    /// A product.
    Multiply,
    /// A quotient or a remainder.
    Divide,
    /// Arithmetic with floats.
    Float,
    /// A trap, as after a path that "cannot happen".
    Trap,
}

impl Machine {
    fn disassembler(self) -> capstone::CsResult<Capstone> {
        match self {
            Self::Thumb => Capstone::new()
                .arm()
                .mode(arch::arm::ArchMode::Thumb)
                .extra_mode([arch::arm::ArchExtraMode::MClass].into_iter())
                .build(),
            Self::RiscV32 => Capstone::new()
                .riscv()
                .mode(arch::riscv::ArchMode::RiscV32)
                .extra_mode([arch::riscv::ArchExtraMode::RiscVC].into_iter())
                .build(),
        }
    }

    fn deed(self, mnemonic: &str) -> Option<Deed> {
        let begins = |prefixes: &[&str]| prefixes.iter().any(|prefix| mnemonic.starts_with(prefix));
        let (multiply, divide, float, trap): (&[&str], &[&str], &[&str], &[&str]) = match self {
            Self::Thumb => (
                &["mul", "mla", "mls", "umul", "umla", "umaa", "smul", "smla", "smls", "smml", "smmul", "smua", "smus"],
                &["udiv", "sdiv"],
                &["v"],
                &["udf", "bkpt"],
            ),
            Self::RiscV32 => {
                (&["mul", "c.mul"], &["div", "rem"], &["f", "c.f"], &["unimp", "c.unimp", "ebreak", "c.ebreak"])
            }
        };
        if mnemonic.starts_with("fence") {
            None
        } else if begins(multiply) {
            Some(Deed::Multiply)
        } else if begins(divide) {
            Some(Deed::Divide)
        } else if begins(float) {
            Some(Deed::Float)
        } else if begins(trap) {
            Some(Deed::Trap)
        } else {
            None
        }
    }
}

/// A section's instructions: how many there are, and what the suspicious ones do.
pub struct Reading {
    /// Instructions.
    pub count: usize,
    /// Those that do a deed, as text.
    pub deeds: Vec<(Deed, String)>,
}

/// Disassembles a section, literals left out.
///
/// *Errors:* bytes that are no instruction: nothing may stay unread.
pub fn read(machine: Machine, section: &Section) -> Result<Reading, String> {
    let disassembler = machine.disassembler().map_err(|error| error.to_string())?;
    let mut reading = Reading { count: 0, deeds: Vec::new() };
    let ends = section.literals.iter().copied().chain([(section.code.len(), true)]);
    let (mut start, mut literal) = (0, false);
    for (end, literal_next) in ends {
        if !literal {
            read_range(machine, &disassembler, section, start..end, &mut reading)?;
        }
        (start, literal) = (end, literal_next);
    }
    Ok(reading)
}

fn read_range(
    machine: Machine,
    disassembler: &Capstone,
    section: &Section,
    range: std::ops::Range<usize>,
    reading: &mut Reading,
) -> Result<(), String> {
    let mut at = range.start;
    while at < range.end {
        let rest = &section.code[at..range.end];
        // The all-zero halfword is the illegal instruction of RISC-V; the disassembler has no name for it.
        if machine == Machine::RiscV32 && rest.starts_with(&[0, 0]) {
            reading.deeds.push((Deed::Trap, format!("unimp at {at:#x}")));
            reading.count += 1;
            at += 2;
            continue;
        }
        let read = disassembler.disasm_count(rest, at as u64, 1).map_err(|error| error.to_string())?;
        let instruction = read.iter().next();
        let Some((instruction, mnemonic)) = instruction.and_then(|read| Some((read, read.mnemonic()?))) else {
            return Err(format!("{}: no instruction at {at:#x} ({:02x?})", section.name, &rest[..rest.len().min(4)]));
        };
        if let Some(deed) = machine.deed(mnemonic) {
            reading.deeds.push((deed, format!("{mnemonic} {} at {at:#x}", instruction.op_str().unwrap_or_default())));
        }
        reading.count += 1;
        at += instruction.bytes().len();
    }
    Ok(())
}
