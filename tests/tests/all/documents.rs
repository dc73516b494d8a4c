//! What the documents name exists.

use std::fs;
use std::path::{Path, PathBuf};

use galpix_core::Rounding;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Returns the words between backticks.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

fn core() -> PathBuf {
    root().join("galpix-core/src")
}

/// Returns the file of a module of the core.
fn file_of(module: &[&str]) -> Option<PathBuf> {
    let path = core().join(module.join("/"));
    [path.with_extension("rs"), path.join("mod.rs")].into_iter().find(|file| file.exists())
}

/// Returns where the core's root has a name from: public module (or none), name, and the module that defines it.
fn exports() -> Vec<(String, String, String)> {
    let (mut exports, mut module) = (Vec::new(), String::new());
    for line in fs::read_to_string(core().join("lib.rs")).unwrap().lines() {
        if let Some(name) = line.strip_prefix("pub mod ").and_then(|rest| rest.strip_suffix(" {")) {
            module = name.to_owned();
        } else if line == "}" {
            module.clear();
        } else if let Some(path) = line.trim_start().strip_prefix("pub use ").and_then(|rest| rest.strip_suffix(';')) {
            let (from, names) = path.rsplit_once("::").unwrap_or(("", path));
            let (from, names) = path.split_once("::{").unwrap_or((from, names));
            for name in names.trim_end_matches('}').split(", ") {
                exports.push((module.clone(), name.to_owned(), from.trim_start_matches("crate::").to_owned()));
            }
        }
    }
    exports
}

/// Finds the module that a path begins with, or that a public name of it is defined in, and in it the rest.
fn in_a_module(path: &str) {
    let parts: Vec<&str> = path.split("::").collect();
    let of_module = (1..parts.len()).rev().find_map(|count| Some((file_of(&parts[..count])?, &parts[count..])));
    let exported = || {
        let (module, rest) = match file_of(&parts[..1]) {
            None if exports().iter().any(|(module, ..)| module == parts[0]) => (parts[0], &parts[1..]),
            _ => ("", &parts[..]),
        };
        let from = exports().into_iter().find(|(of, name, _)| of == module && name == rest[0]);
        from.and_then(|(_, _, from)| Some((file_of(&from.split("::").collect::<Vec<_>>())?, rest)))
    };
    let (file, names) = of_module.or_else(exported).unwrap_or_else(|| panic!("there is no module of {path}"));
    let source = fs::read_to_string(&file).unwrap();
    for name in names {
        let defined = source
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"))
            .any(|line| line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|part| part == *name));
        assert!(defined, "{path} is not in {}", file.display());
    }
}

#[test]
fn public_names_are_found_where_they_are_defined() {
    for path in ["stages::snap", "record::Component::derive", "Bits::derive", "Controller::step", "layers::Layers"] {
        in_a_module(path);
    }
    for path in ["stages::nothing", "propagate::snap", "Bits::nothing", "frame::step::nothing"] {
        assert!(std::panic::catch_unwind(|| in_a_module(path)).is_err(), "{path} is found");
    }
}

#[test]
fn the_paper_map_names_functions_and_tests_that_exist() {
    let map = fs::read_to_string(root().join("docs/paper-map.md")).unwrap();
    let (mut functions, mut tests) = (0, 0);
    for line in map.lines() {
        let mut of_file = String::new();
        for word in quoted(line) {
            if word.ends_with(".rs") || word.ends_with('/') {
                let file = root().join("tests/tests/all").join(word);
                assert!(file.exists(), "there is no test {word}");
                of_file = fs::read_to_string(file).unwrap_or_default();
                tests += 1;
            } else if word.contains("::") {
                in_a_module(word);
                functions += 1;
            } else if word.chars().all(|c| c.is_ascii_lowercase() || c == '_') && !of_file.is_empty() {
                assert!(of_file.contains(&format!("fn {word}(")), "there is no test {word} in the file before it");
                tests += 1;
            }
        }
    }
    assert!(functions >= 15 && tests >= 15, "{functions} functions and {tests} tests are named");
}

#[test]
fn the_readme_names_files_that_exist_and_two_commands() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    for target in readme.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
        assert!(root().join(target).exists(), "README links to {target}, which is not there");
    }
    assert_eq!(readme.matches("```sh").count(), 2, "exactly two commands");
}

#[test]
fn the_specification_has_the_engines_threshold_tables() {
    let spec = fs::read_to_string(root().join("docs/spec.md")).unwrap();
    let rows = spec.split("The tables:").nth(1).unwrap().split("\n\n").nth(1).unwrap().lines().skip(2);
    let mut tables = 0;
    for (down, row) in (1..).zip(rows) {
        let numbers: Vec<i32> =
            row.split('|').nth(2).unwrap().split(',').map(|entry| entry.trim().parse().unwrap()).collect();
        let engine: Vec<i32> = (0..1 << down).map(|frame| Rounding::Searched.threshold(frame, down)).collect();
        assert_eq!(numbers, engine, "{down}");
        tables += 1;
    }
    assert_eq!(tables, Rounding::MOST_SEARCHED);
}

/// Returns the first Rust program of a text, whose lines begin with `prefix`.
fn program(text: &str, prefix: &str) -> String {
    let lines =
        text.lines().map(|line| line.strip_prefix(prefix).or(line.strip_prefix(prefix.trim_end())).unwrap_or(line));
    let body = lines.skip_while(|line| !line.starts_with("```rust") && (prefix.is_empty() || *line != "```"));
    body.skip(1).take_while(|line| *line != "```").map(|line| line.to_owned() + "\n").collect()
}

#[test]
fn the_readmes_program_is_the_crates_example() {
    let read = |path: &str| fs::read_to_string(root().join(path)).unwrap();
    let example = program(&read("galpix-core/src/lib.rs"), "//! ");
    assert!(example.contains("fn main()"), "{example}");
    for readme in ["README.md", "galpix-core/README.md"] {
        assert_eq!(program(&read(readme), ""), example, "{readme}");
    }
}
