//! What the cost bench counts, beside the committed table.
//!
//! A count repeats exactly with one compiler; another one moves it by some per cent. So a row may differ by
//! [`compare::MOST`] before it is said to; a change of the engine that is meant is written into the table, where the
//! next review sees it.

mod compare;
mod report;
mod table;

use std::io::Read;
use std::path::Path;

use crate::Findings;
use table::Table;

/// Reads a run, compares it with the table and prints it; or writes it into the table.
pub fn run(files: &[&str], write: bool) -> Result<Findings, String> {
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cost.csv");
    let run = Table::parse(&read_run(files)?)?;
    if run.is_empty() {
        return Err("the run has no rows".to_owned());
    }
    let mut findings = Findings { report: format!("{}\n", report::tables(&run)), faults: compare::spreads(&run) };
    if write {
        std::fs::write(&table, run.to_string()).map_err(|error| format!("{}: {error}", table.display()))?;
        findings.report += "firmware/cost.csv is written\n";
        return Ok(findings);
    }
    let committed = std::fs::read_to_string(&table).map_err(|error| format!("{}: {error}", table.display()))?;
    let committed = Table::parse(&committed)?;
    findings.faults.extend(compare::differences(&committed, &run));
    findings.report += &format!("{} rows, {} faults\n", run.rows().len(), findings.faults.len());
    Ok(findings)
}

/// What the files say, one after the other; or standard input.
fn read_run(files: &[&str]) -> Result<String, String> {
    let mut text = String::new();
    if files.is_empty() {
        std::io::stdin().read_to_string(&mut text).map_err(|error| format!("standard input: {error}"))?;
    }
    for file in files {
        text += &std::fs::read_to_string(file).map_err(|error| format!("{file}: {error}"))?;
    }
    Ok(text)
}
