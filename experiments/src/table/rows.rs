//! Rows that are written as they come.

use std::path::Path;

use super::{Cell, Format, Table};
use crate::error::Error;
use crate::files::Output;

/// More rows than this nobody reads, and their common width is known only with the last.
const READABLE: usize = 10_000;

/// A table on its way out: CSV and JSON need no memory for it, however long the run.
pub(crate) struct Rows {
    /// Its columns, and for [`Format::Table`] its rows.
    table: Table,
    format: Format,
    output: Output,
    is_empty: bool,
}

impl Rows {
    /// Opens the file of `--out`, or standard output, for the rows of `table`, which are `count` if all goes well.
    ///
    /// # Errors
    /// A place that cannot be written, and more rows than are read by eye.
    pub(crate) fn new(
        table: Table,
        asked: Option<Format>,
        out: Option<&Path>,
        count: usize,
    ) -> Result<Self, Error> {
        let format = Format::or_default(asked, out.is_some());
        if format == Format::Table && count > READABLE {
            return Err(Error::input(
                "--format",
                "table",
                &format!("{count} rows, and a table has at most {READABLE}"),
                "give --format csv, or ask for fewer rows",
            ));
        }
        Ok(Self { table, format, output: Output::new(out)?, is_empty: true })
    }

    /// Adds a row; a short one ends in empty cells.
    pub(crate) fn push(&mut self, row: impl IntoIterator<Item = Cell>) -> Result<(), Error> {
        match self.format {
            Format::Table => self.table.push(row),
            // the header comes with the first row, so that a refusal before it prints nothing
            Format::Csv => {
                let head = if self.is_empty { self.table.csv_head() } else { String::new() };
                self.output.write(&(head + &self.table.csv_row(&self.table.whole(row))))?;
            }
            Format::Json => {
                let before = if self.is_empty { "[\n" } else { ",\n" };
                self.output.write(&(before.to_string() + &self.table.json_row(&self.table.whole(row))))?;
            }
        }
        self.is_empty = false;
        Ok(())
    }

    /// Ends the text, and puts the file in its place.
    pub(crate) fn finish(self) -> Result<(), Error> {
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
    use crate::files::scratch::Scratch;
    use crate::table::tests::example;

    #[test]
    fn rows_one_by_one_are_the_whole_table() {
        let scratch = Scratch::new("rows");
        let path = scratch.path().join("rows");
        let empty = example().view("none", "", &[], ("method", "none"));
        for part in [empty.clone(), example()] {
            for format in [Format::Csv, Format::Json, Format::Table] {
                let count = part.rows().len();
                let mut rows = Rows::new(empty.clone(), Some(format), Some(&path), count).unwrap();
                part.rows().iter().for_each(|row| rows.push(row.clone()).unwrap());
                rows.finish().unwrap();
                assert_eq!(std::fs::read_to_string(&path).unwrap(), format.write(&part), "{format:?}");
            }
        }
    }
}
