//! What programs take of flash and RAM, from their sections.

use std::fmt::Write as _;

use object::{Object, ObjectSection, SectionFlags, SectionKind, elf};

use crate::Findings;

/// A program of fewer bytes was linked without its linker script.
const LEAST: u64 = 1024;

/// Prints a line for each program.
pub fn run(files: &[&str]) -> Result<Findings, String> {
    let mut findings = Findings::default();
    let _ = writeln!(findings.report, "| program | flash, bytes | static RAM, bytes |");
    let _ = writeln!(findings.report, "| --- | --- | --- |");
    for file in files {
        let bytes = std::fs::read(file).map_err(|error| format!("{file} cannot be read ({error}): build it first"))?;
        let program = object::File::parse(&*bytes).map_err(|error| format!("{file} is no program: {error}"))?;
        let (mut flash, mut ram) = (0, 0);
        for section in program.sections() {
            let SectionFlags::Elf { sh_flags } = section.flags() else { continue };
            if sh_flags & u64::from(elf::SHF_ALLOC) == 0 {
                continue;
            }
            let zero = section.kind() == SectionKind::UninitializedData;
            let writable = sh_flags & u64::from(elf::SHF_WRITE) != 0;
            flash += if zero { 0 } else { section.size() };
            ram += if zero || writable { section.size() } else { 0 };
        }
        let name = std::path::Path::new(file).file_name().unwrap_or_default().to_string_lossy();
        let _ = writeln!(findings.report, "| {name} | {flash} | {ram} |");
        if flash < LEAST {
            findings.faults.push(format!("{file}: {flash} bytes of flash: was it linked without its linker script?"));
        }
    }
    Ok(findings)
}
