//! What differs between a run and the table, and between pictures where nothing may.

use super::table::Table;

/// The most by which a count may differ from the table's, in per cent of it.
pub const MOST: u64 = 10;

/// The most by which a picture may take more instructions than another with constant work, in per cent of the fewest.
const MOST_SPREAD: u64 = 1;

/// What to do about a difference that is meant.
const REMEDY: &str = "if it is meant, firmware/test.sh --write-cost and commit the file";

/// Rows that differ by more than [`MOST`], that are missing, or that are new: a line for each.
pub fn differences(committed: &Table, run: &Table) -> Vec<String> {
    let mut faults = Vec::new();
    for (key, before) in committed.rows() {
        match run.get(key) {
            None => faults.push(format!("{key}: in firmware/cost.csv and not in this run: {REMEDY}")),
            Some(now) if now.abs_diff(*before) * 100 > before * MOST => {
                let (more, part) = (now as f64 - *before as f64, 100.0 / *before as f64);
                let change =
                    format!("{} instead of {} instructions, {:+.1} %", count(now), count(*before), more * part);
                faults.push(format!("{key}: {change}, more than {MOST} %: {REMEDY}"));
            }
            Some(_) => {}
        }
    }
    let new = run.rows().iter().filter(|(key, _)| committed.get(key).is_none());
    faults.extend(new.map(|(key, _)| format!("{key}: in this run and not in firmware/cost.csv: {REMEDY}")));
    if !faults.is_empty() && committed.remarks().first() != run.remarks().first() {
        let compiler = |table: &Table| table.remarks().first().cloned().unwrap_or_default();
        faults.push(format!("the table is by {}, this run by {}", compiler(committed), compiler(run)));
    }
    faults
}

/// Fewest and most instructions over all pictures of a row with constant work.
pub struct Spread<'t> {
    /// What it was compiled for, the layout and the rung.
    pub what: [&'t str; 3],
    /// Hundredths of an instruction.
    pub least: u64,
    /// The same.
    pub most: u64,
}

impl Spread<'_> {
    /// In per cent of the fewest.
    pub fn per_cent(&self) -> f64 {
        100.0 * (self.most - self.least) as f64 / self.least as f64
    }
}

/// The spread of each target, layout and rung with constant work.
pub fn spread(run: &Table) -> Vec<Spread<'_>> {
    let mut spreads: Vec<Spread<'_>> = Vec::new();
    for (key, count) in run.rows().iter().filter(|(key, _)| key.mode == "constant") {
        let what = [&*key.target, &*key.layout, &*key.rung];
        match spreads.iter_mut().find(|spread| spread.what == what) {
            Some(spread) => (spread.least, spread.most) = (spread.least.min(*count), spread.most.max(*count)),
            None => spreads.push(Spread { what, least: *count, most: *count }),
        }
    }
    spreads
}

/// Where the instructions of constant work depend on the picture: a line for each.
pub fn spreads(run: &Table) -> Vec<String> {
    let too_far = |spread: &Spread<'_>| (spread.most - spread.least) * 100 > spread.least * MOST_SPREAD;
    let line = |spread: Spread<'_>| {
        let ([target, layout, rung], per_cent) = (spread.what, spread.per_cent());
        let far = format!("{per_cent:.2} % over pictures, more than {MOST_SPREAD} %");
        format!("{target},{layout},{rung}: constant work spreads by {far}")
    };
    spread(run).into_iter().filter(too_far).map(line).collect()
}

/// Hundredths as a number.
pub fn count(hundredths: u64) -> String {
    format!("{}.{:02}", hundredths / 100, hundredths % 100)
}

#[cfg(test)]
mod tests {
    use super::super::table::Table;
    use super::{count, differences, spreads};

    fn table(rows: &[(&str, u64)]) -> Table {
        let rows = rows.iter().map(|(what, count)| format!("thumbv7m-none-eabi,{what},{count}\n"));
        Table::parse(&rows.collect::<String>()).unwrap()
    }

    const PAN: &str = "Full,pan,skipping,sweep,-";
    const ZOOM: &str = "Full,zoom,skipping,sweep,-";

    #[test]
    fn a_row_11_per_cent_off_fails_and_one_9_per_cent_off_passes() {
        let committed = table(&[(PAN, 1000), (ZOOM, 3)]);
        for (pan, faults) in
            [(890, 1), (891, 1), (900, 0), (910, 0), (1000, 0), (1090, 0), (1100, 0), (1101, 1), (1110, 1)]
        {
            assert_eq!(differences(&committed, &table(&[(PAN, pan), (ZOOM, 3)])).len(), faults, "{pan}");
        }
        let fault = differences(&committed, &table(&[(PAN, 1110), (ZOOM, 3)])).remove(0);
        assert!(fault.contains("11.10 instead of 10.00 instructions, +11.0 %"), "{fault}");
    }

    #[test]
    fn missing_and_new_rows_fail_and_name_the_remedy() {
        let (one, both) = (table(&[(PAN, 1000)]), table(&[(PAN, 1000), (ZOOM, 1000)]));
        for (committed, run, said) in [(&both, &one, "not in this run"), (&one, &both, "not in firmware/cost.csv")] {
            let faults = differences(committed, run);
            assert_eq!(faults.len(), 1);
            assert!(faults[0].contains("Full,zoom") && faults[0].contains(said) && faults[0].contains("--write-cost"));
        }
    }

    #[test]
    fn constant_work_may_spread_by_1_per_cent_and_skipping_by_more() {
        let rows = |most| {
            table(&[
                ("Full,still,constant,frame,extend", 10_000),
                ("Full,chaos,constant,frame,extend", most),
                ("Full,chaos,constant,frame,bullet", 20_000),
                ("Full,chaos,skipping,frame,extend", 90_000),
            ])
        };
        assert_eq!(spreads(&rows(10_100)), [""; 0]);
        let faults = spreads(&rows(10_101));
        assert_eq!(faults.len(), 1);
        assert!(faults[0].starts_with("thumbv7m-none-eabi,Full,extend: constant work spreads by 1.01 %"), "{faults:?}");
    }

    #[test]
    fn hundredths_are_printed_as_a_number() {
        assert_eq!(count(1205), "12.05");
        assert_eq!(count(7), "0.07");
    }
}
