//! Rows that are written as they come.

use std::path::Path;

use polhode_files::error::Error;

use super::{Cell, Format, Table, write_json_row, write_row};
use crate::output::Output;

/// More rows than this nobody reads, and their common width is known only with the last.
const READABLE: usize = 10_000;

/// A table on its way out: CSV and JSON need no memory for it, however long the run.
pub struct RowWriter {
    /// Its columns, and for [`Format::Table`] its rows.
    table: Table,
    format: Format,
    /// For [`Format::Json`] the names of its columns.
    keys: Vec<String>,
    output: Output,
    /// The row that is being written.
    line: String,
    is_empty: bool,
}

impl RowWriter {
    /// Opens the file of `--out`, or standard output, for the rows of `table`, which are `count` if all goes well, where
    /// that is known.
    ///
    /// # Errors
    /// A place that cannot be written, and more rows than are read by eye.
    pub fn new(
        table: Table,
        asked: Option<Format>,
        out: Option<&Path>,
        count: impl Into<Option<usize>>,
    ) -> Result<Self, Error> {
        let format = Format::of(asked, out)?;
        let output = Output::new(out)?;
        let keys = table.json_keys();
        let rows = Self { table, format, keys, output, line: String::new(), is_empty: true };
        rows.check_readable(count.into().unwrap_or(0))?;
        Ok(rows)
    }

    fn check_readable(&self, count: usize) -> Result<(), Error> {
        if self.format != Format::Table || count <= READABLE {
            return Ok(());
        }
        let rule = format!("{count} rows, and a table has at most {READABLE}");
        Err(Error::input("--format", "table", &rule, "give --format csv, or ask for fewer rows"))
    }

    /// Adds a row; a short one ends in empty cells.
    pub fn push(&mut self, row: impl IntoIterator<Item = Cell>) -> Result<(), Error> {
        match self.format {
            Format::Table => {
                self.table.push(row);
                self.check_readable(self.table.rows().len())?;
            }
            // the header comes with the first row, so that a refusal before it prints nothing
            Format::Csv => {
                self.line.clear();
                if self.is_empty {
                    self.line += &self.table.csv_head();
                }
                write_row(row, self.table.columns.len(), &mut self.line);
                self.output.write(&self.line)?;
            }
            Format::Json => {
                self.line.clear();
                self.line += if self.is_empty { "[\n" } else { ",\n" };
                write_json_row(row, &self.keys, &mut self.line);
                self.output.write(&self.line)?;
            }
        }
        self.is_empty = false;
        Ok(())
    }

    /// Ends the text, and puts the file in its place.
    pub fn finish(self) -> Result<(), Error> {
        let end = match self.format {
            Format::Table => &self.table.terminal(),
            Format::Csv if self.is_empty => &self.table.csv_head(),
            Format::Csv => "",
            Format::Json if self.is_empty => "[]\n",
            Format::Json => "\n]\n",
        };
        self.output.write_whole(end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::scratch::Scratch;
    use crate::table::tests::example;

    #[test]
    fn rows_one_by_one_are_the_whole_table() {
        let scratch = Scratch::new("rows");
        let path = scratch.path().join("rows");
        let empty = example().view("none", "", &[], ("method", "none"));
        for part in [empty.clone(), example()] {
            for format in [Format::Csv, Format::Json, Format::Table] {
                let count = part.rows().len();
                let mut rows = RowWriter::new(empty.clone(), Some(format), Some(&path), count).unwrap();
                part.rows().iter().for_each(|row| rows.push(row.clone()).unwrap());
                rows.finish().unwrap();
                assert_eq!(std::fs::read_to_string(&path).unwrap(), format.write(&part), "{format:?}");
            }
        }
    }
}
