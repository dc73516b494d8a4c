//! "Additions and shifts only, no panic" as a test: the machine code of the core's passes is read.
//!
//! `tests/codegen` is built as a static library for two bare machines, optimised for speed and for size, with link-time
//! optimisation. From each of its `proof_*` symbols on, everything that can be reached is visited (see [`library`]) and
//! disassembled (see [`instructions`]).
//!
//! **Proved** for propagation and resolution, edge map, fill and a whole frame in either mode, for each layout there,
//! with a format fixed at compile time and the compiler that runs the test: no panic can be reached, no multiply,
//! divide, float or trap instruction, no helper but those that copy, fill, compare or shift 64 bits, and no code that
//! was not read. For layers, scan-out in all its forms, objects, push-pull and the disocclusion map the
//! same, but that they may multiply, by an instruction and not by a helper. For the distortion map only that no panic
//! can be reached. **Not proved:** the same for other layouts, for setting up a map, for formats chosen at run time, or
//! with overflow checks on.
//!
//! The `planted_*` symbols each do one of these things and must be found.

mod instructions;
mod library;
mod verdict;

use std::path::{Path, PathBuf};
use std::process::Command;

use instructions::{Deed, Machine};
use library::Library;
use verdict::{Fault, Verdict, judge};

const THUMB: (&str, Machine) = ("thumbv6m-none-eabi", Machine::Thumb);
const RISCV: (&str, Machine) = ("riscv32imac-unknown-none-elf", Machine::RiscV32);

/// Optimised for speed, and for size.
const PROFILES: [&str; 2] = ["release", "small"];

/// Returns whether the core library for a target is there, and so a program for it can be built.
fn installed(target: &str) -> bool {
    let output = Command::new(std::env::var_os("RUSTC").unwrap_or("rustc".into()))
        .args(["--print", "target-libdir", "--target", target])
        .output();
    let Ok(output) = output else { return false };
    let folder = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
    folder
        .read_dir()
        .is_ok_and(|files| files.flatten().any(|file| file.file_name().to_string_lossy().starts_with("libcore-")))
}

/// Builds `tests/codegen`; `None`, with a word to standard error, where the target is not installed.
fn build(target: &str, profile: &str) -> Option<Library> {
    if !installed(target) {
        eprintln!("skipped: {target} is not installed: rustup target add {target}");
        return None;
    }
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let built = project.join("../target/codegen");
    let status = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()))
        .args(["build", "--locked", "--quiet", "--target", target, "--profile", profile])
        .current_dir(project.join("codegen"))
        .env("CARGO_TARGET_DIR", &built)
        // Meant for the host.
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .env_remove("CARGO_BUILD_TARGET")
        .status()
        .expect("cargo can be started");
    assert!(status.success(), "tests/codegen does not build for {target}");
    let file = built.join(target).join(profile).join("libgalpix_codegen.a");
    let bytes = std::fs::read(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    Some(Library::read(&bytes).unwrap_or_else(|error| panic!("{}: {error}", file.display())))
}

/// Returns what an entry of this name may do. The paper promises additions and shifts for the state of galpixels: step,
/// resolve, edge and fill. Everything else may multiply, by an instruction and not by a helper.
fn allowed(entry: &str) -> Option<Deed> {
    let promised = ["sweep", "edge", "fill", "step", "constant"].map(|pass| format!("proof_{pass}_"));
    let planted = entry.starts_with("planted_") && !entry.starts_with("planted_inpaint_");
    let strict = planted || promised.iter().any(|pass| entry.starts_with(pass));
    (!strict).then_some(Deed::Multiply)
}

fn judged(machine: Machine, library: &Library, entry: &str) -> Verdict {
    judge(machine, library, entry, allowed(entry)).unwrap_or_else(|error| panic!("{entry}: {error}"))
}

fn passes_are_clean((target, machine): (&str, Machine)) {
    let mut faults = String::new();
    for profile in PROFILES {
        let Some(library) = build(target, profile) else { return };
        let entries = library.entries("proof_");
        assert_eq!(entries.len(), 84, "sixteen passes of five layouts, and two for objects of two: {entries:?}");
        let strict = entries.iter().filter(|entry| allowed(entry).is_none()).count();
        assert_eq!(strict, 25, "propagation and resolution, edge, fill, and a frame in either mode, of five layouts");
        for entry in entries {
            let verdict = judged(machine, &library, &entry);
            println!("{target} {profile}: {entry}: {} instructions", verdict.instructions);
            assert!(verdict.instructions > 10, "{entry} is a stub of {} instructions", verdict.instructions);
            for finding in verdict.findings {
                faults += &format!("\n  {target} {profile}: {finding}");
            }
        }
    }
    assert!(faults.is_empty(), "the core's machine code does what it must not:{faults}");
}

#[test]
fn codegen_is_clean_on_armv6m() {
    passes_are_clean(THUMB);
}

#[test]
fn codegen_is_clean_on_rv32imac() {
    passes_are_clean(RISCV);
}

#[test]
fn codegen_of_the_distortion_map_reaches_no_panic() {
    for (target, machine) in [THUMB, RISCV] {
        for profile in PROFILES {
            let Some(library) = build(target, profile) else { continue };
            let entries = library.entries("distorted_");
            assert_eq!(entries, ["distorted_map", "distorted_place"]);
            for entry in entries {
                let verdict = judged(machine, &library, &entry);
                assert!(verdict.instructions > 10, "{entry} is a stub of {} instructions", verdict.instructions);
                let panics = |finding: &&verdict::Finding| matches!(finding.fault, Fault::Panic | Fault::Unknown);
                let found: Vec<String> = verdict.findings.iter().filter(panics).map(ToString::to_string).collect();
                assert!(found.is_empty(), "{target} {profile}: {}", found.join("\n"));
            }
        }
    }
}

#[test]
fn codegen_finds_planted_faults() {
    let multiply = [Fault::Instruction(Deed::Multiply), Fault::Helper];
    let divide = [Fault::Instruction(Deed::Divide), Fault::Helper];
    let planted: [(&str, &[Fault]); 9] = [
        ("planted_divide", &divide),
        ("planted_float", &[Fault::Helper]),
        ("planted_inpaint_divide", &divide),
        ("planted_inpaint_panic", &[Fault::Panic]),
        ("planted_multiply", &[Fault::Instruction(Deed::Multiply)]),
        ("planted_panic", &[Fault::Panic]),
        ("planted_panic_in_table", &[Fault::Panic]),
        ("planted_remainder", &[Fault::Instruction(Deed::Multiply), Fault::Helper]),
        ("planted_wide_multiply", &multiply),
    ];
    for (target, machine) in [THUMB, RISCV] {
        for profile in PROFILES {
            let Some(library) = build(target, profile) else { continue };
            let entries = library.entries("planted_");
            assert_eq!(entries, planted.map(|(entry, _)| entry));
            for (entry, expected) in planted {
                let verdict = judged(machine, &library, entry);
                let found = verdict.findings.iter().any(|finding| expected.contains(&finding.fault));
                assert!(found, "{target} {profile}: nothing like {expected:?} was found in {entry}");
            }
        }
    }
}
