//! A table: named columns, rows, and one writer for each reader.

mod layout;
mod markup;
mod print;
mod rounded;
mod row_writer;

use std::borrow::{Borrow, Cow};
use std::fmt::Write as _;
use std::path::Path;

use polhode_files::error::Error;
use polhode_files::text::{visible_json, visible_lines};
use serde_json::Value;

pub use layout::{Selection, ShownColumn};
pub use rounded::to_digits;
pub use row_writer::RowWriter;

/// One value of a row.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A finite quantity.
    Number(f64),
    /// A count.
    Integer(i64),
    /// A name or a verdict.
    Text(String),
    /// The quantity has no meaning here.
    Empty,
}

impl From<f64> for Cell {
    /// A number that is not finite says that the quantity has no value: the cell is empty.
    fn from(x: f64) -> Self {
        if x.is_finite() { Self::Number(x) } else { Self::Empty }
    }
}

impl From<u64> for Cell {
    fn from(n: u64) -> Self {
        i64::try_from(n).map_or(Self::Number(n as f64), Self::Integer)
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_string())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Empty, Into::into)
    }
}

impl Cell {
    /// Every digit that is needed to read the same double back.
    pub fn exact(&self) -> String {
        match self {
            Self::Number(x) => format!("{x:?}"),
            Self::Integer(n) => n.to_string(),
            Self::Text(text) => text.clone(),
            Self::Empty => String::new(),
        }
    }

    /// Adds the field of a CSV that holds it.
    fn write_field(&self, line: &mut String) {
        match self {
            Self::Number(x) if is_plain(*x) => line.push_str(ryu::Buffer::new().format_finite(*x)),
            Self::Number(x) => {
                let _ = write!(line, "{x:?}");
            }
            Self::Integer(n) => {
                let _ = write!(line, "{n}");
            }
            Self::Text(text) => line.push_str(&quoted(&visible_lines(text))),
            Self::Empty => {}
        }
    }

    /// Adds the JSON value that it is.
    fn write_json(&self, line: &mut String) {
        let _ = match self {
            Self::Number(x) => write!(line, "{}", Value::from(*x)),
            Self::Integer(n) => write!(line, "{n}"),
            Self::Text(text) => line.write_str(&json_text(text)),
            Self::Empty => line.write_str("null"),
        };
    }
}

/// Significant digits where a column asks for no other number.
const DIGITS: usize = 3;

/// One quantity of a table.
#[derive(Clone, Debug)]
pub struct Column {
    /// Name in CSV and JSON.
    pub name: Cow<'static, str>,
    /// Unit, "" for a pure number or a text.
    pub unit: Cow<'static, str>,
    /// What the quantity is, for `run.toml`.
    pub meaning: &'static str,
    heading: Cow<'static, str>,
    latex: Option<Cow<'static, str>>,
    digits: usize,
    shown: bool,
}

impl Column {
    /// A quantity by its name in CSV, its unit and its meaning.
    pub fn new(name: &'static str, unit: &'static str, meaning: &'static str) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            meaning,
            heading: name.into(),
            latex: None,
            digits: DIGITS,
            shown: true,
        }
    }

    /// Heading in Markdown and on the terminal, and in LaTeX when it has none of its own.
    pub fn heading(self, heading: &'static str) -> Self {
        Self { heading: heading.into(), ..self }
    }

    /// Heading in LaTeX, verbatim.
    pub fn latex(self, heading: &'static str) -> Self {
        Self { latex: Some(heading.into()), ..self }
    }

    /// Significant digits where the table is rounded.
    pub fn digits(self, digits: usize) -> Self {
        Self { digits, ..self }
    }

    /// Kept out of the rounded tables; CSV and JSON have it.
    pub fn hidden(self) -> Self {
        Self { shown: false, ..self }
    }
}

/// Rows of named quantities.
#[derive(Clone, Debug)]
pub struct Table {
    /// File name without ending.
    pub name: String,
    /// What the rows say, one sentence.
    pub caption: String,
    /// The quantities.
    pub columns: Vec<Column>,
    rows: Vec<Vec<Cell>>,
    /// Of a view: which part of which table it is.
    pub part: Option<Selection>,
}

/// One row from values of any kind: `row!["rk4", 0.01, 1000_u64, None::<f64>]`.
#[macro_export]
macro_rules! row {
    ($($value:expr),* $(,)?) => { [$($crate::table::Cell::from($value)),*] };
}
pub use crate::row;

impl Table {
    /// A table without rows.
    pub fn new(name: impl Into<String>, caption: impl Into<String>, columns: Vec<Column>) -> Self {
        Self { name: name.into(), caption: caption.into(), columns, rows: Vec::new(), part: None }
    }

    /// The rows that hold `value` in `column`, for readers of documents; the columns named in `hide` are left out there.
    pub fn view(
        &self,
        name: impl Into<String>,
        caption: impl Into<String>,
        hide: &[&str],
        (column, value): (&str, &str),
    ) -> Self {
        let shown = |column: &Column| Column {
            shown: column.shown && !hide.contains(&&*column.name),
            ..column.clone()
        };
        let place = self.place(column);
        let keep = |row: &&Vec<Cell>| place.is_some_and(|place| row[place].exact() == value);
        Self {
            name: name.into(),
            caption: caption.into(),
            columns: self.columns.iter().map(shown).collect(),
            rows: self.rows.iter().filter(keep).cloned().collect(),
            part: Some(Selection::new(&self.name, column, value, hide)),
        }
    }

    /// Adds a row; a short one ends in empty cells.
    pub fn push(&mut self, row: impl IntoIterator<Item = Cell>) {
        self.rows.push(self.whole(row));
    }

    /// A row with a cell for every column.
    fn whole(&self, row: impl IntoIterator<Item = Cell>) -> Vec<Cell> {
        let mut row: Vec<Cell> = row.into_iter().collect();
        debug_assert_eq!(row.len(), self.columns.len(), "cells of a row of {}", self.name);
        row.resize(self.columns.len(), Cell::Empty);
        row
    }

    /// Place of the column called `name`.
    pub fn place(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// Its rows, with a cell for each column.
    pub fn rows(&self) -> &[Vec<Cell>] {
        &self.rows
    }

    /// Header row, then every row in full precision.
    pub fn csv(&self) -> String {
        let mut text = self.csv_head();
        self.rows.iter().for_each(|row| write_row(row, self.columns.len(), &mut text));
        text
    }

    fn csv_head(&self) -> String {
        self.columns.iter().map(|column| quoted(&column.name)).collect::<Vec<_>>().join(",") + "\n"
    }

    /// An array of objects, a row a line; an empty cell is null.
    pub fn json(&self) -> String {
        if self.rows.is_empty() {
            return "[]\n".into();
        }
        let (mut text, keys) = (String::from("[\n"), self.json_keys());
        for (k, row) in self.rows.iter().enumerate() {
            text += if k > 0 { ",\n" } else { "" };
            write_json_row(row, &keys, &mut text);
        }
        text + "\n]\n"
    }

    /// The names of the columns as JSON.
    fn json_keys(&self) -> Vec<String> {
        self.columns.iter().map(|column| json_text(&column.name)).collect()
    }

    /// The columns of the rounded tables, with their place in a row.
    fn shown(&self) -> Vec<(usize, &Column)> {
        self.columns.iter().enumerate().filter(|(_, column)| column.shown).collect()
    }

    /// Whether the column holds numbers, which stand at the right.
    fn is_numeric(&self, k: usize) -> bool {
        let mut filled = self.rows.iter().filter(|row| row[k] != Cell::Empty).peekable();
        filled.peek().is_some() && filled.all(|row| !matches!(row[k], Cell::Text(_)))
    }
}

/// Whether ryu, which takes a fifth of the time, writes the number as `{:?}` does: that has an exponent below 1e-4 already, and
/// rounds half up where a number lies halfway between two that are as short, which takes one with at most 26 binary places.
fn is_plain(x: f64) -> bool {
    const PLACES: f64 = 67_108_864.0; // 2^26
    !(1e-5..1e-4).contains(&x.abs()) && (x * PLACES).fract() != 0.0
}

/// Adds a line of CSV with `count` fields, the last of them empty where `row` is short.
fn write_row<C: Borrow<Cell>>(row: impl IntoIterator<Item = C>, count: usize, line: &mut String) {
    let mut row = row.into_iter();
    for k in 0..count {
        if k > 0 {
            line.push(',');
        }
        if let Some(cell) = row.next() {
            cell.borrow().write_field(line);
        }
    }
    line.push('\n');
}

/// Adds an object of JSON with these `keys`, the last of them null where `row` is short.
fn write_json_row<C: Borrow<Cell>>(row: impl IntoIterator<Item = C>, keys: &[String], text: &mut String) {
    let mut row = row.into_iter();
    *text += "  {";
    for (k, key) in keys.iter().enumerate() {
        *text += if k > 0 { "," } else { "" };
        *text += key;
        text.push(':');
        match row.next() {
            Some(cell) => cell.borrow().write_json(text),
            None => text.push_str("null"),
        }
    }
    text.push('}');
}

/// A text as JSON that shows what a terminal would obey.
fn json_text(text: &str) -> String {
    visible_json(&Value::from(text).to_string()).into_owned()
}

/// A field by RFC 4180.
fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_string()
    }
}

/// How rows are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// Rounded, for reading; the default on a terminal
    Table,
    /// All digits, for programs; the default elsewhere
    Csv,
    /// An array of objects
    Json,
}

impl Format {
    /// The format that is asked for, or that the ending of the file of `--out` names, or that suits standard output.
    ///
    /// # Errors
    /// An ending that names no format or another one than is asked for.
    pub fn of(asked: Option<Self>, out: Option<&Path>) -> Result<Self, Error> {
        use std::io::IsTerminal;
        let Some(path) = out else {
            let terminal = std::io::stdout().is_terminal();
            return Ok(asked.unwrap_or(if terminal { Self::Table } else { Self::Csv }));
        };
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let told = match ending.as_deref() {
            Some("csv") => Some(Self::Csv),
            Some("json") => Some(Self::Json),
            Some("txt") => Some(Self::Table),
            _ => None,
        };
        let refused =
            |rule: &str, remedy: &str| Err(Error::input("--out", &path.display().to_string(), rule, remedy));
        match (asked, told) {
            (Some(asked), Some(told)) if asked != told => refused(
                "the ending and --format name different formats",
                "drop --format, or change the ending",
            ),
            (Some(format), _) | (None, Some(format)) => Ok(format),
            (None, None) if ending.is_some() => refused(
                "no format is written with this ending",
                "name a file .csv, .json or .txt, or give --format too",
            ),
            (None, None) => Ok(Self::Csv),
        }
    }

    /// The text of `table`.
    pub fn write(self, table: &Table) -> String {
        match self {
            Self::Table => table.terminal(),
            Self::Csv => table.csv(),
            Self::Json => table.json(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn example() -> Table {
        let columns = vec![
            Column::new("method", "", "integrator"),
            Column::new("step", "s", "step size"),
            Column::new("steps", "", "number of steps").hidden(),
            Column::new("energy_error", "", "max |ΔE/E|")
                .heading("max |ΔE/E|")
                .latex(r"$|\Delta E/E|$")
                .digits(2),
        ];
        let mut table = Table::new("drift", "Drift.", columns);
        table.push(row!["rk4", 0.01, 1_000_000_u64, 4.3123e-10]);
        table.push(row!["two, \"turns\" & 50 %", 0.1 + 0.2, 3_u64, f64::NAN]);
        table
    }

    #[test]
    fn csv_has_every_digit_and_no_nan() {
        let expected = "method,step,steps,energy_error\nrk4,0.01,1000000,4.3123e-10\n\
                        \"two, \"\"turns\"\" & 50 %\",0.30000000000000004,3,\n";
        assert_eq!(example().csv(), expected);
    }

    #[test]
    fn csv_reads_back_bit_for_bit() {
        let mut table = Table::new("extremes", "", vec![Column::new("x", "", "")]);
        let values =
            [f64::MIN_POSITIVE / 3.0, f64::MAX, -1.0 / 3.0, 5e-324, 1e22, 123456789012345680.0, -0.0];
        values.iter().for_each(|x| table.push(row![*x]));
        let csv = table.csv();
        let mut reader = csv::Reader::from_reader(csv.as_bytes());
        let read: Vec<f64> = reader.deserialize().map(Result::unwrap).collect();
        assert_eq!(read.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), values.map(f64::to_bits));
    }

    #[test]
    fn numbers_are_those_of_debug() {
        let mut random = polhode::num::Random::new(5);
        let spread = (0..20_000).map(|_| {
            let bits = (random.uniform() * 9_218_868_437_227_405_312.0) as u64;
            f64::from_bits(bits | u64::from(bits.is_multiple_of(7)) << 63)
        });
        let edges =
            [0.0, -0.0, 1e-4, 1e-5, 9.999e-6, 9.999e-5, -2.5e-5, 1e15, 1e16, 9.999e15, 5e-324, f64::MAX];
        // halfway between two numbers of 17 digits
        let halfway = [
            188_171_879_707.281_25 / 2.0,
            206_945_645_137_269.0 / 16.0,
            2.0_f64.recip(),
            33_554_432_f64.recip(),
        ];
        let few_places = (0..20_000).map(|k| f64::from(k * 7919 + 1) / f64::from(1 << (k % 28)));
        for x in spread.filter(|x| x.is_finite()).chain(edges).chain(halfway).chain(few_places) {
            let mut field = String::new();
            Cell::Number(x).write_field(&mut field);
            assert_eq!(field, format!("{x:?}"));
        }
    }

    #[test]
    fn json_is_an_array_of_objects() {
        let read: Value = serde_json::from_str(&example().json()).unwrap();
        assert_eq!(read[0]["energy_error"], 4.3123e-10);
        assert_eq!(read[0]["steps"], 1_000_000);
        assert_eq!(read[1]["step"].as_f64().map(f64::to_bits), Some(0.30000000000000004_f64.to_bits()));
        assert!(read[1]["energy_error"].is_null());
        assert_eq!(Table::new("none", "", vec![]).json(), "[]\n");
    }
}
