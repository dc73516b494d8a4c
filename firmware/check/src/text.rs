//! Bytes of code that a frame takes by layout, beside the committed table.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use crate::Findings;
use crate::machine_code::reached;

/// The columns.
const HEAD: &str = "target,layout,program,bytes";
/// A row may differ from the table by a twentieth.
const MOST: u64 = 20;

type Table = BTreeMap<[String; 3], u64>;

/// Measures programs that were built for one target each, whose name is in the file's path; compares with the table, or
/// writes it.
pub fn run(files: &[&str], write: bool) -> Result<Findings, String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../text.csv");
    let mut measured = Table::new();
    for file in files {
        let target = Path::new(file).ancestors().nth(2).and_then(Path::file_name).unwrap_or_default();
        for (name, bytes) in reached(file)? {
            measured.insert(row(&target.to_string_lossy(), &name)?, bytes);
        }
    }
    let mut findings = Findings::default();
    let mut text = format!("{HEAD}\n");
    for ([target, layout, program], bytes) in &measured {
        let _ = writeln!(text, "{target},{layout},{program},{bytes}");
    }
    if write {
        std::fs::write(&path, &text).map_err(|error| format!("{}: {error}", path.display()))?;
        findings.report = format!("{text}firmware/text.csv is written\n");
        return Ok(findings);
    }
    let kept = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let kept = parse(&kept)?;
    findings.faults = differences(&kept, &measured);
    findings.report = format!("{text}{} rows, {} faults\n", measured.len(), findings.faults.len());
    Ok(findings)
}

/// The row of a function `…::LAYOUT::text_PROGRAM`.
fn row(target: &str, name: &str) -> Result<[String; 3], String> {
    let mut parts = name.rsplit("::");
    let program = parts.find_map(|part| part.strip_prefix("text_"));
    match (program, parts.next()) {
        (Some(program), Some(layout)) => Ok([target.to_owned(), layout.to_owned(), program.replace('_', "-")]),
        _ => Err(format!("{name} is no LAYOUT::text_PROGRAM")),
    }
}

fn parse(text: &str) -> Result<Table, String> {
    let rows = text.lines().filter(|line| !line.is_empty() && *line != HEAD);
    rows.map(|line| match line.split(',').collect::<Vec<_>>()[..] {
        [target, layout, program, bytes] => {
            let bytes = bytes.parse().map_err(|_| format!("\"{line}\" has no number"))?;
            Ok(([target, layout, program].map(str::to_owned), bytes))
        }
        _ => Err(format!("\"{line}\" is no row: {HEAD} is expected")),
    })
    .collect()
}

fn differences(kept: &Table, measured: &Table) -> Vec<String> {
    let mut faults = Vec::new();
    for (row, &bytes) in measured {
        match kept.get(row) {
            Some(&kept) if bytes.abs_diff(kept) * MOST <= kept => {}
            Some(kept) => faults.push(format!("{}: {bytes} bytes, and {kept} in text.csv", row.join(","))),
            None => faults.push(format!("{}: not in text.csv", row.join(","))),
        }
    }
    let gone = kept.keys().filter(|row| !measured.contains_key(*row));
    faults.extend(gone.map(|row| format!("{}: in text.csv, and not measured", row.join(","))));
    faults
}

#[cfg(test)]
mod tests {
    use super::{differences, parse, row};

    #[test]
    fn a_twentieth_is_allowed_and_no_more() {
        let table = |bytes: u64| parse(&format!("target,layout,program,bytes\nm0,Full,rolling,{bytes}\n")).unwrap();
        assert!(differences(&table(1000), &table(1050)).is_empty());
        assert_eq!(differences(&table(1000), &table(1051)).len(), 1);
        assert_eq!(differences(&table(1000), &parse("").unwrap()).len(), 1);
        assert_eq!(differences(&parse("").unwrap(), &table(1000)).len(), 1);
        assert!(parse("m0,Full,rolling,many").is_err());
    }

    #[test]
    fn a_row_is_named_by_its_function() {
        assert_eq!(row("m0", "galpix_text::Full::text_two_maps").unwrap(), ["m0", "Full", "two-maps"]);
        assert!(row("m0", "galpix_text::main").is_err());
    }
}
