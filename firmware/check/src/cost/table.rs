//! Rows of counts, as CSV.

use std::fmt;

/// The columns.
const HEAD: &str = "target,layout,picture,mode,stage,rung,hundredths";

/// What a row counts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Key {
    /// What it was compiled for.
    pub target: String,
    /// The layout, or a kernel that is not the engine's.
    pub layout: String,
    /// The picture, or `any`.
    pub picture: String,
    /// The mode of work, or `-`.
    pub mode: String,
    /// The stage.
    pub stage: String,
    /// The rung, or `-`.
    pub rung: String,
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { target, layout, picture, mode, stage, rung } = self;
        write!(f, "{target},{layout},{picture},{mode},{stage},{rung}")
    }
}

/// Counts, in hundredths of an instruction a galpixel, in the order in which they were measured; and remarks.
#[derive(Clone, Debug, Default)]
pub struct Table {
    rows: Vec<(Key, u64)>,
    remarks: Vec<String>,
}

impl Table {
    /// Reads lines of CSV, of one run or several; lines that begin with `#` are remarks.
    ///
    /// *Errors:* a line that is no row, and a row that is there twice.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut table = Self::default();
        for line in text.lines().map(str::trim).filter(|line| !line.is_empty() && *line != HEAD) {
            if let Some(remark) = line.strip_prefix('#') {
                let remark = remark.trim().to_owned();
                if !table.remarks.contains(&remark) {
                    table.remarks.push(remark);
                }
                continue;
            }
            let fields: Vec<_> = line.split(',').collect();
            let row = match fields[..] {
                [target, layout, picture, mode, stage, rung, count] => {
                    let [target, layout, picture, mode, stage, rung] =
                        [target, layout, picture, mode, stage, rung].map(str::to_owned);
                    count.parse().ok().map(|count| (Key { target, layout, picture, mode, stage, rung }, count))
                }
                _ => None,
            };
            let (key, count) = row.ok_or_else(|| format!("\"{line}\" is no row: {HEAD} is expected"))?;
            if table.get(&key).is_some() {
                return Err(format!("{key} is there twice"));
            }
            table.rows.push((key, count));
        }
        Ok(table)
    }

    /// The rows in their order.
    pub fn rows(&self) -> &[(Key, u64)] {
        &self.rows
    }

    /// What was said beside the rows.
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The count of a row.
    pub fn get(&self, key: &Key) -> Option<u64> {
        self.rows.iter().find(|(other, _)| other == key).map(|&(_, count)| count)
    }

    /// The values of a column, each once, in their order.
    pub fn values(&self, column: impl Fn(&Key) -> &str) -> Vec<&str> {
        let mut values = Vec::new();
        for (key, _) in &self.rows {
            let value = column(key);
            if !values.contains(&value) {
                values.push(value);
            }
        }
        values
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for remark in &self.remarks {
            writeln!(f, "# {remark}")?;
        }
        writeln!(f, "{HEAD}")?;
        self.rows.iter().try_for_each(|(key, count)| writeln!(f, "{key},{count}"))
    }
}

#[cfg(test)]
mod tests {
    use super::Table;

    const ROW: &str = "thumbv7m-none-eabi,Full,pan,skipping,sweep,-,7259";

    #[test]
    fn a_table_is_read_as_it_is_written() {
        let table = Table::parse(&format!("# rustc 1.95.0\ntarget,layout,picture,mode,stage,rung,hundredths\n{ROW}\n"));
        let table = table.unwrap();
        assert_eq!(table.rows().len(), 1);
        assert_eq!(table.rows()[0].1, 7259);
        assert_eq!(table.remarks(), ["rustc 1.95.0"]);
        assert_eq!(Table::parse(&table.to_string()).unwrap().rows(), table.rows());
    }

    #[test]
    fn what_is_no_row_and_what_is_there_twice_is_an_error() {
        assert!(Table::parse("hard fault at 0x00000000").is_err());
        assert!(Table::parse("thumbv7m-none-eabi,Full,pan,skipping,sweep,-,many").is_err());
        assert!(Table::parse(&format!("{ROW}\n{ROW}")).unwrap_err().contains("twice"));
    }
}
