//! The run as tables for readers.

use std::fmt::Write;

use super::compare::{count, spread};
use super::table::{Key, Table};

/// A table: its head and its rows, numbers to the right.
fn table(head: &[&str], labels: usize, rows: impl Iterator<Item = Vec<String>>) -> String {
    let ruler = (0..head.len()).map(|column| if column < labels { "---" } else { "---:" });
    let mut text = format!("| {} |\n| {} |\n", head.join(" | "), ruler.collect::<Vec<_>>().join(" | "));
    for row in rows {
        text += &format!("| {} |\n", row.join(" | "));
    }
    text
}

/// The processor's name, which a target does not have.
fn processor(target: &str) -> String {
    let core = target.split('-').next().unwrap_or(target);
    let name = match core {
        "thumbv6m" => "Cortex-M0",
        "thumbv7m" => "Cortex-M3",
        "thumbv7em" => "Cortex-M4",
        _ => return core.to_owned(),
    };
    format!("{name} (`{core}`)")
}

/// The count of the row that is like this one.
fn cell(run: &Table, key: &Key) -> String {
    run.get(key).map_or("–".to_owned(), count)
}

/// Layouts down, pictures to the right, for one stage of one target.
fn by_picture(run: &Table, target: &str, stage: &str, rung: &str) -> String {
    let key = |layout: &str, picture: &str| {
        let mode = if layout.starts_with("plain") { "-" } else { "skipping" };
        let [target, layout, picture, mode, stage, rung] =
            [target, layout, picture, mode, stage, rung].map(str::to_owned);
        Key { target, layout, picture, mode, stage, rung }
    };
    let layouts = run.values(|key| &key.layout);
    let mut pictures = run.values(|key| &key.picture);
    pictures.retain(|picture| layouts.iter().any(|layout| run.get(&key(layout, picture)).is_some()));
    let head: Vec<_> = ["layout"].into_iter().chain(pictures.iter().copied()).collect();
    let with_any = layouts
        .iter()
        .copied()
        .filter(|layout| pictures.iter().any(|picture| run.get(&key(layout, picture)).is_some()));
    let row = |layout: &str| {
        let cells = pictures.iter().map(|picture| cell(run, &key(layout, picture)));
        [layout.to_owned()].into_iter().chain(cells).collect()
    };
    table(&head, 1, with_any.map(row))
}

/// Returns all tables.
pub fn tables(run: &Table) -> String {
    let targets = run.values(|key| &key.target);
    let columns: Vec<_> = targets.iter().map(|target| processor(target)).collect();
    let columns: Vec<_> = columns.iter().map(String::as_str).collect();
    let mut text = String::new();
    for remark in run.remarks() {
        let _ = writeln!(text, "- {remark}");
    }
    for (title, stage, rung) in [
        ("Propagate and resolve", "sweep-alone", "-"),
        ("A whole frame with the rung extend", "frame", "extend"),
        ("Push-pull after it, sparse, without quads", "push-pull", "-"),
        ("Push-pull for each hole", "push-pull-a-hole", "-"),
    ] {
        for target in &targets {
            let _ = write!(text, "\n## {title}: {}\n\n{}", processor(target), by_picture(run, target, stage, rung));
        }
    }
    let head: Vec<_> = ["layout", "rung"].into_iter().chain(columns.iter().copied()).collect();
    let spreads = spread(run);
    let mut groups: Vec<[&str; 2]> = Vec::new();
    for [_, layout, rung] in spreads.iter().map(|spread| spread.what) {
        if !groups.contains(&[layout, rung]) {
            groups.push([layout, rung]);
        }
    }
    let row = |[layout, rung]: [&str; 2]| {
        let one = |target: &&str| {
            let spread = spreads.iter().find(|spread| spread.what == [*target, layout, rung]);
            spread.map_or("–".to_owned(), |spread| format!("{} ({:.2} %)", count(spread.most), spread.per_cent()))
        };
        [layout.to_owned(), rung.to_owned()].into_iter().chain(targets.iter().map(one)).collect()
    };
    let constant = table(&head, 2, groups.into_iter().map(row));
    let _ = write!(text, "\n## A whole frame with constant work: most over pictures, and spread\n\n{constant}");
    let staged = |picture: &str| run.rows().iter().any(|(key, _)| key.picture == picture && key.mode != "constant");
    for picture in run.values(|key| &key.picture).into_iter().filter(|picture| staged(picture)) {
        let title = if picture == "any" { "any: what no picture changes" } else { picture };
        let _ = write!(text, "\n## Picture {title}\n\n{}", of_picture(run, picture, &targets, &columns));
    }
    text
}

/// Layout and stage down, targets to the right, for one picture.
fn of_picture(run: &Table, picture: &str, targets: &[&str], columns: &[&str]) -> String {
    let head: Vec<_> = ["layout", "stage", "rung"].into_iter().chain(columns.iter().copied()).collect();
    let first = targets.first().copied().unwrap_or_default();
    let rows = run.rows().iter().map(|(key, _)| key);
    let rows = rows.filter(|key| key.target == first && key.picture == picture && key.mode != "constant");
    let row = |key: &Key| {
        let cells = targets.iter().map(|target| cell(run, &Key { target: (*target).to_owned(), ..key.clone() }));
        [key.layout.clone(), key.stage.clone(), key.rung.clone()].into_iter().chain(cells).collect()
    };
    table(&head, 3, rows.map(row))
}

#[cfg(test)]
mod tests {
    use super::super::table::Table;
    use super::tables;

    #[test]
    fn every_row_is_shown_and_a_target_that_lacks_it_has_a_dash() {
        let run = Table::parse(
            "thumbv6m-none-eabi,Full,pan,skipping,edge,-,5629\n\
             thumbv6m-none-eabi,Full,pan,skipping,sweep-alone,-,11826\n\
             thumbv7m-none-eabi,Full,pan,skipping,sweep-alone,-,6919\n\
             thumbv6m-none-eabi,Full,pan,constant,frame,extend,182861\n\
             thumbv6m-none-eabi,Full,any,-,copy,-,1625\n",
        );
        let text = tables(&run.unwrap());
        for line in [
            "| Full | edge | - | 56.29 | – |",
            "| Full | sweep-alone | - | 118.26 | 69.19 |",
            "| Full | 118.26 |",
            "| Full | extend | 1828.61 (0.00 %) | – |",
            "| Full | copy | - | 16.25 | – |",
        ] {
            assert!(text.contains(line), "{line} is not in\n{text}");
        }
    }
}
