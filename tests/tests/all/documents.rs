//! What the documents name exists.

use std::fs;
use std::path::{Path, PathBuf};

use galpix_core::Rounding;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The words between backticks.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// Finds the module that a path begins with, and in it the rest.
fn in_a_module(path: &str) {
    let parts: Vec<&str> = path.split("::").collect();
    let file = |count: usize| root().join("galpix-core/src").join(parts[..count].join("/")).with_extension("rs");
    let count = (1..parts.len()).rev().find(|&count| file(count).exists());
    let count = count.unwrap_or_else(|| panic!("there is no module of {path}"));
    let source = fs::read_to_string(file(count)).unwrap();
    for name in &parts[count..] {
        let defined = source
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"))
            .any(|line| line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|part| part == *name));
        assert!(defined, "{path} is not in {}", file(count).display());
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
