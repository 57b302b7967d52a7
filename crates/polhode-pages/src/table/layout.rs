//! What has to be known beside a CSV to print its rows rounded again.

use serde::{Deserialize, Serialize};

use super::{Cell, Column, DIGITS, Table};

/// A column of the rounded rows; those that are kept out of them have none.
#[derive(Debug, Deserialize, Serialize)]
pub struct ShownColumn {
    name: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    unit: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    heading: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    latex: Option<String>,
    /// Significant digits of numbers; none where the cells are texts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    digits: Option<usize>,
}

/// A selection: the rows of another table that hold `value` in `column`.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Selection {
    /// Name of that table.
    pub table: String,
    column: String,
    value: String,
    hidden: Vec<String>,
}

impl Selection {
    pub(super) fn new(table: &str, column: &str, value: &str, hidden: &[&str]) -> Self {
        let hidden = hidden.iter().map(ToString::to_string).collect();
        Self { table: table.into(), column: column.into(), value: value.into(), hidden }
    }

    /// This part of `whole`.
    pub fn of(&self, whole: &Table) -> Table {
        let hidden: Vec<&str> = self.hidden.iter().map(String::as_str).collect();
        whole.view(&whole.name, &whole.caption, &hidden, (&self.column, &self.value))
    }
}

impl Table {
    /// The columns of the rounded rows.
    pub fn layout(&self) -> Vec<ShownColumn> {
        let layout = |(k, column): (usize, &Column)| ShownColumn {
            name: column.name.to_string(),
            unit: column.unit.to_string(),
            heading: (column.heading != column.name).then(|| column.heading.to_string()),
            latex: column.latex.as_ref().map(ToString::to_string),
            digits: self.is_numeric(k).then_some(column.digits),
        };
        self.shown().into_iter().map(layout).collect()
    }

    /// The table of which `csv` holds the rows and `layout` the columns that are shown.
    ///
    /// # Errors
    /// Rows that are no CSV, a column that is missing, and a cell that should be a number: line, column and value.
    pub fn from_csv(name: &str, csv: &str, layout: &[ShownColumn]) -> Result<Self, String> {
        let mut reader = csv::Reader::from_reader(csv.as_bytes());
        let header = reader.headers().map_err(|error| error.to_string())?.clone();
        if let Some(missing) = layout.iter().find(|shown| header.iter().all(|name| name != shown.name)) {
            return Err(format!("has no column '{}', which run.toml names", missing.name));
        }
        let described = |name: &str| layout.iter().find(|shown| shown.name == name);
        let columns = header.iter().map(|name| column(name, described(name))).collect();
        let mut table = Table::new(name, "", columns);
        for (k, record) in reader.records().enumerate() {
            let record = record.map_err(|error| error.to_string())?;
            let cells = header.iter().zip(&record).map(|(name, text)| {
                let numeric = described(name).is_some_and(|shown| shown.digits.is_some());
                let found = if numeric { number(text) } else { Some(Cell::from(text)) };
                found.ok_or_else(|| format!("row {}, column {name}: '{text}' is not a number", k + 1))
            });
            table.push(cells.collect::<Result<Vec<_>, _>>()?);
        }
        Ok(table)
    }
}

fn column(name: &str, shown: Option<&ShownColumn>) -> Column {
    let unnamed = Column { name: name.to_string().into(), ..Column::new("", "", "") };
    let Some(shown) = shown else { return unnamed.hidden() };
    Column {
        unit: shown.unit.clone().into(),
        heading: shown.heading.clone().unwrap_or_else(|| name.to_string()).into(),
        latex: shown.latex.clone().map(Into::into),
        digits: shown.digits.unwrap_or(DIGITS),
        ..unnamed
    }
}

/// A cell of a numeric column; counts are written without a point.
fn number(text: &str) -> Option<Cell> {
    if text.is_empty() {
        return Some(Cell::Empty);
    }
    let count = text.parse().ok().map(Cell::Integer);
    count.or_else(|| text.parse().ok().filter(|x: &f64| x.is_finite()).map(Cell::Number))
}

#[cfg(test)]
mod tests {
    use super::super::{row, tests::example};
    use super::*;

    #[test]
    fn the_rounded_rows_are_those_of_the_table_that_wrote_the_csv() {
        let mut whole = example();
        whole.push(row!["2.50", f64::NAN, 4_u64, -1e-300]);
        let described =
            toml::to_string(&std::collections::BTreeMap::from([("shown", whole.layout())])).unwrap();
        let described: std::collections::BTreeMap<String, Vec<ShownColumn>> =
            toml::from_str(&described).unwrap();
        let read = Table::from_csv("drift", &whole.csv(), &described["shown"]).unwrap();
        assert_eq!(read.markdown(), whole.markdown());
        assert_eq!(read.latex(), whole.latex());
        let view = whole.view("rk4", "", &["step"], ("method", "rk4"));
        assert_eq!(view.rows().len(), 1);
        assert_eq!(view.part.as_ref().unwrap().of(&read).latex(), view.latex());
    }

    #[test]
    fn rows_that_do_not_fit_are_refused() {
        let refused = |csv: &str| Table::from_csv("drift", csv, &example().layout()).unwrap_err();
        assert_eq!(refused("method,step\nrk4,1.0\n"), "has no column 'energy_error', which run.toml names");
        let words = "method,step,energy_error\nrk4,1.0,0.5\nrk4,x,0.5\n";
        assert_eq!(refused(words), "row 2, column step: 'x' is not a number");
        assert!(refused("method,step,energy_error\nrk4,1.0\n").contains("2 fields"));
        assert!(refused("method,step,energy_error\nrk4,nan,1.0\n").contains("'nan' is not a number"));
    }
}
