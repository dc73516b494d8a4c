//! The columns of a table, each defined once: its value for a row, and where and how it is shown.
//!
//! ```text
//! rows ─▶ columns ─┬─▶ csv (identifiers, full precision)
//!                  ├─▶ Table (the terminal: titles, digits, a dash for nothing)
//!                  └─▶ html (the page: the same, as markup)
//! ```

use maud::{Markup, PreEscaped, html};

use super::html::text::{Text, count, figure, signed};

/// What a cell holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Nothing was measured.
    Nothing,
    /// Words.
    Text(String),
    /// A whole number.
    Integer(u64),
    /// A measured number.
    Real(f64),
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<bool> for Value {
    fn from(is: bool) -> Self {
        Self::Text(is.to_string())
    }
}

impl From<u32> for Value {
    fn from(number: u32) -> Self {
        Self::Integer(number.into())
    }
}

impl From<u64> for Value {
    fn from(number: u64) -> Self {
        Self::Integer(number)
    }
}

impl From<usize> for Value {
    fn from(number: usize) -> Self {
        Self::Integer(number as u64)
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Real(number)
    }
}

impl<V: Into<Self>> From<Option<V>> for Value {
    fn from(value: Option<V>) -> Self {
        value.map_or(Self::Nothing, Into::into)
    }
}

/// How a column is headed, and with how many digits after the point its measured numbers are shown.
#[derive(Clone, Copy, Debug)]
struct Heading {
    title: &'static str,
    digits: usize,
}

/// How the cells of a column look.
#[derive(Clone, Copy, Debug, Default)]
struct Look {
    /// Words, which stand at the left.
    words: bool,
    /// Differences, which show their sign on the page.
    signed: bool,
    /// Counts, whose digits stand in threes on the page.
    grouped: bool,
    /// What follows a number on the terminal.
    unit: &'static str,
    /// Characters that a cell takes on the terminal at least.
    width: usize,
}

/// A column of rows `R`, shown only where that is requested: in the CSV, on the terminal, on the page.
pub struct Column<R> {
    get: fn(&R) -> Value,
    csv: Option<&'static str>,
    nothing: &'static str,
    terminal: Option<Heading>,
    page: Option<Heading>,
    look: Look,
    means: &'static str,
}

impl<R> Column<R> {
    /// Makes a column that is shown nowhere yet.
    #[must_use]
    pub fn new(get: fn(&R) -> Value) -> Self {
        Self { get, csv: None, nothing: "", terminal: None, page: None, look: Look::default(), means: "" }
    }

    /// Shows it in the CSV under this identifier.
    #[must_use]
    pub fn csv(self, id: &'static str) -> Self {
        Self { csv: Some(id), ..self }
    }

    /// Writes this into the CSV where there is nothing.
    #[must_use]
    pub fn csv_else(self, nothing: &'static str) -> Self {
        Self { nothing, ..self }
    }

    /// Shows it on the terminal.
    #[must_use]
    pub fn terminal(self, title: &'static str, digits: usize) -> Self {
        Self { terminal: Some(Heading { title, digits }), ..self }
    }

    /// Shows it on the page.
    #[must_use]
    pub fn page(self, title: &'static str, digits: usize) -> Self {
        Self { page: Some(Heading { title, digits }), ..self }
    }

    /// Shows it on the terminal and on the page alike.
    #[must_use]
    pub fn both(self, title: &'static str, digits: usize) -> Self {
        self.terminal(title, digits).page(title, digits)
    }

    /// Says what it holds, for legends.
    #[must_use]
    pub fn means(self, means: &'static str) -> Self {
        Self { means, ..self }
    }

    /// Sets its cells at the left.
    #[must_use]
    pub fn words(self) -> Self {
        Self { look: Look { words: true, ..self.look }, ..self }
    }

    /// Shows the signs of its numbers on the page.
    #[must_use]
    pub fn signed(self) -> Self {
        Self { look: Look { signed: true, ..self.look }, ..self }
    }

    /// Shows the digits of its numbers in threes on the page.
    #[must_use]
    pub fn grouped(self) -> Self {
        Self { look: Look { grouped: true, ..self.look }, ..self }
    }

    /// Puts this after its numbers on the terminal.
    #[must_use]
    pub fn unit(self, unit: &'static str) -> Self {
        Self { look: Look { unit, ..self.look }, ..self }
    }

    /// Makes it at least so many characters wide on the terminal.
    #[must_use]
    pub fn width(self, width: usize) -> Self {
        Self { look: Look { width, ..self.look }, ..self }
    }

    fn in_csv(&self, row: &R) -> String {
        match (self.get)(row) {
            Value::Nothing => self.nothing.to_owned(),
            Value::Text(text) => text,
            Value::Integer(number) => number.to_string(),
            Value::Real(number) => number.to_string(),
        }
    }

    fn on_terminal(&self, row: &R, digits: usize) -> String {
        let unit = self.look.unit;
        match (self.get)(row) {
            Value::Nothing => super::number(None, digits),
            Value::Text(text) => text,
            Value::Integer(number) => format!("{number}{unit}"),
            Value::Real(number) => format!("{number:.digits$}{unit}"),
        }
    }

    fn on_page(&self, row: &R, digits: usize) -> String {
        match (self.get)(row) {
            Value::Nothing => figure(None, digits),
            Value::Text(text) => Text(&text).to_string(),
            Value::Integer(number) if self.look.grouped => count(number),
            Value::Integer(number) => number.to_string(),
            Value::Real(number) if self.look.signed => signed(Some(number), digits),
            Value::Real(number) => figure(Some(number), digits),
        }
    }
}

/// Returns what the columns of the terminal hold, a line for each that says so.
#[must_use]
pub fn legend<R>(columns: &[Column<R>]) -> String {
    let titles = columns.iter().filter_map(|column| Some((column.terminal?.title, column.means)));
    let said: Vec<(&str, &str)> = titles.filter(|(_, means)| !means.is_empty()).collect();
    let width = said.iter().map(|(title, _)| title.chars().count()).max().unwrap_or(0);
    let lines = said.iter().map(|(title, means)| format!("  {title:<width$}  {means}"));
    std::iter::once("Columns:".to_owned()).chain(lines).collect::<Vec<_>>().join("\n")
}

/// Returns comma-separated values: a line of identifiers and a line per row, quoted where a cell needs it.
///
/// *Errors:* those of the writer; none are known.
pub fn csv<R>(columns: &[Column<R>], rows: impl IntoIterator<Item = R>) -> csv::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let shown: Vec<(&'static str, &Column<R>)> =
        columns.iter().filter_map(|column| Some((column.csv?, column))).collect();
    writer.write_record(shown.iter().map(|(id, _)| id))?;
    for row in rows {
        writer.write_record(shown.iter().map(|(_, column)| column.in_csv(&row)))?;
    }
    let bytes = writer.into_inner().map_err(|error| error.into_error())?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// A table on the terminal, each column as wide as its widest cell.
pub struct Table<'c, R> {
    columns: Vec<(&'c Column<R>, Heading, usize)>,
}

impl<'c, R> Table<'c, R> {
    /// Makes room for these rows.
    #[must_use]
    pub fn new(columns: &'c [Column<R>], rows: &[R]) -> Self {
        let wide = |column: &'c Column<R>| {
            let heading = column.terminal?;
            let cells = rows.iter().map(|row| column.on_terminal(row, heading.digits).chars().count());
            let width = cells.chain([heading.title.chars().count(), column.look.width]).max();
            Some((column, heading, width.unwrap_or(0)))
        };
        Self { columns: columns.iter().filter_map(wide).collect() }
    }

    /// Returns the titles.
    #[must_use]
    pub fn heading(&self) -> String {
        self.join(|_, heading| heading.title.to_owned())
    }

    /// Returns a row.
    #[must_use]
    pub fn line(&self, row: &R) -> String {
        self.join(|column, heading| column.on_terminal(row, heading.digits))
    }

    /// Returns the titles and these rows, a line each.
    pub fn lines(&self, rows: &[R]) -> impl Iterator<Item = String> {
        std::iter::once(self.heading()).chain(rows.iter().map(|row| self.line(row)))
    }

    fn join(&self, cell: impl Fn(&Column<R>, Heading) -> String) -> String {
        let cells = self.columns.iter().map(|&(column, heading, width)| {
            let cell = cell(column, heading);
            if column.look.words { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    }
}

/// Returns the title of each column of a page, and what it holds.
pub fn titles<R>(columns: &[Column<R>]) -> Vec<(&'static str, &'static str)> {
    columns.iter().filter_map(|column| Some((column.page?.title, column.means))).collect()
}

/// Returns the title and the content of each cell of a row of a page.
pub fn cells<R>(columns: &[Column<R>], row: &R) -> Vec<(&'static str, Markup)> {
    let shown = columns.iter().filter_map(|column| Some((column, column.page?)));
    shown.map(|(column, heading)| (heading.title, PreEscaped(column.on_page(row, heading.digits)))).collect()
}

/// Returns a table of a page, with a class for the style sheet.
pub fn html<R>(class: &str, columns: &[Column<R>], rows: &[R]) -> Markup {
    let shown: Vec<(&Column<R>, Heading)> = columns.iter().filter_map(|column| Some((column, column.page?))).collect();
    html! {
        div.wide {
            table class=(class) {
                thead { tr { @for (column, heading) in &shown {
                    th title=[(!column.means.is_empty()).then_some(column.means)] { (heading.title) }
                } } }
                tbody {
                    @for row in rows {
                        tr {
                            @for (column, heading) in &shown {
                                td class=[column.look.words.then_some("word")] {
                                    (PreEscaped(column.on_page(row, heading.digits)))
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Row = (&'static str, Option<f64>, u64);

    fn columns() -> Vec<Column<Row>> {
        vec![
            Column::new(|row: &Row| row.0.into()).csv("name").both("name", 0).words(),
            Column::new(|row: &Row| row.1.into()).csv("share").csv_else("0").terminal("share", 1).unit(" %"),
            Column::new(|row: &Row| row.1.into()).page("gain", 2).signed(),
            Column::new(|row: &Row| row.2.into()).csv("cells").page("cells", 0).grouped(),
        ]
    }

    const ROWS: [Row; 2] = [("a,\"b\" <c>", Some(0.25), 1000), ("plain", None, 7)];

    #[test]
    fn the_csv_is_exact_and_quoted_where_a_cell_needs_it() {
        let text = csv(&columns(), ROWS).unwrap();
        assert_eq!(text, "name,share,cells\n\"a,\"\"b\"\" <c>\",0.25,1000\nplain,0,7\n");
    }

    #[test]
    fn the_terminal_has_digits_dashes_and_no_spaces_at_the_end() {
        let columns = columns();
        let lines: Vec<String> = Table::new(&columns, &ROWS).lines(&ROWS).collect();
        assert_eq!(lines, ["name       share", "a,\"b\" <c>  0.2 %", "plain          -"]);
    }

    #[test]
    fn a_legend_has_a_line_for_each_column_of_the_terminal_that_says_what_it_holds() {
        let column = || Column::new(|row: &Row| row.2.into());
        let columns = [
            column().csv("id").means("nothing that a table shows"),
            column().terminal("cells", 0).means("how many"),
            column().terminal("share %", 0).means("of all"),
            column().terminal("silent", 0),
        ];
        assert_eq!(legend(&columns), "Columns:\n  cells    how many\n  share %  of all");
    }

    #[test]
    fn the_page_is_escaped() {
        let html = html("rows", &columns(), &ROWS).into_string();
        assert!(html.contains("<td class=\"word\">a,&quot;b&quot; &lt;c&gt;</td><td>+0.25</td><td>1\u{202F}000</td>"));
        assert!(html.contains("<td class=\"word\">plain</td><td>\u{2013}</td><td>7</td>"), "{html}");
    }
}
