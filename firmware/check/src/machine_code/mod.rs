//! "Additions and shifts only" for a linked program: what its functions reach is read, instruction by instruction.
//!
//! The program must be linked with `--emit-relocs`, see [`image`]. Setting up a map may multiply; a frame must not. So
//! what is read are the functions named, and everything that they reach. Push-pull takes means by weights: those
//! functions may multiply, by instructions and not by helpers, and do nothing else.

mod image;
mod instructions;
mod reach;

use std::collections::HashSet;

use crate::Findings;
use image::Image;
use instructions::Deed;
use reach::{Finding, bytes_of, judge};

/// What functions of this name may do.
fn allowed(name: &str) -> Option<Deed> {
    ["proof_inpaint_", "planted_inpaint_"].iter().any(|inpaints| name.starts_with(inpaints)).then_some(Deed::Multiply)
}

/// Reads an ELF file: the functions with these names, or those that begin with `proof_`, must be clean, and in each
/// that begins with `planted_` a fault must be found.
pub fn run(file: &str, names: &[&str]) -> Result<Findings, String> {
    let bytes = std::fs::read(file).map_err(|error| format!("{file}: {error}"))?;
    let image = Image::read(&bytes).map_err(|error| format!("{file}: {error}"))?;
    look(&image, names).map_err(|error| format!("{file}: {error}"))
}

/// Returns the bytes that each function reaches whose name has a part that begins with `text_`: its name from that part
/// on, with the part before, and code and constants.
pub fn reached(file: &str) -> Result<Vec<(String, u64)>, String> {
    let bytes = std::fs::read(file).map_err(|error| format!("{file}: {error}"))?;
    let image = Image::read(&bytes).map_err(|error| format!("{file}: {error}"))?;
    let entries = image.functions.iter().enumerate().filter(|(_, function)| function.name.contains("::text_"));
    let entries: Vec<_> = entries.map(|(index, function)| (function.name.clone(), bytes_of(&image, index))).collect();
    if entries.is_empty() { Err(format!("{file}: no function is named text_...")) } else { Ok(entries) }
}

fn look(image: &Image, names: &[&str]) -> Result<Findings, String> {
    let mut findings = Findings::default();
    let named = |name: &str| if names.is_empty() { name.starts_with("proof_") } else { names.contains(&name) };
    let mut told = HashSet::new();
    let (mut entries, mut inpainting, mut functions, mut instructions) = (0, 0, 0, 0);
    for (index, function) in image.functions.iter().enumerate() {
        let planted = function.short_name().starts_with("planted_");
        if !planted && !named(function.short_name()) {
            continue;
        }
        let verdict = judge(image, index, allowed(function.short_name()))?;
        if planted {
            match verdict.findings.first() {
                Some(Finding { what, .. }) => findings.report += &format!("{}: found: {what}\n", function.name),
                None => findings.faults.push(format!("{}: the planted fault was not found", function.name)),
            }
            continue;
        }
        entries += 1;
        functions += verdict.functions;
        instructions += verdict.instructions;
        if allowed(function.short_name()).is_some() {
            inpainting += 1;
        }
        // Several entries reach the same function: one way there is enough.
        let new = verdict.findings.iter().filter(|finding| told.insert(finding.what.clone()));
        findings.faults.extend(new.map(Finding::to_string));
    }
    if entries == 0 {
        return Err("there is no such function; a program must be built with its symbols".to_owned());
    }
    findings.report += &format!(
        "{entries} entries, {inpainting} of which may multiply, reach {functions} functions of {instructions} instructions\n"
    );
    Ok(findings)
}
