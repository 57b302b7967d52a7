//! Tables in memory: data frames, structured arrays and dicts of columns, read by the names of their columns as files are.

use std::fmt::Write;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use crate::arrays::{Numbers, integers};
use crate::error::refused;

/// What stands in a column.
enum Cells {
    Numbers(Vec<f64>),
    Integers(Vec<String>),
}

impl Cells {
    fn len(&self) -> usize {
        match self {
            Cells::Numbers(numbers) => numbers.len(),
            Cells::Integers(texts) => texts.len(),
        }
    }
}

/// The table as the text of a CSV, whose numbers have all their digits; `None` of what is no table.
pub(crate) fn text(value: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
    let py = value.py();
    // pandas and polars write their own
    if value.hasattr("to_csv")? {
        let options = PyDict::new(py);
        options.set_item("index", false)?;
        return value.call_method("to_csv", (), Some(&options))?.extract().map(Some);
    }
    if value.hasattr("write_csv")? {
        return value.call_method0("write_csv")?.extract().map(Some);
    }
    let names: Vec<String> = if let Ok(columns) = value.cast::<PyDict>() {
        columns.keys().extract().map_err(|_| refused("path: the names of columns are texts"))?
    } else if value.hasattr("dtype")? && !value.getattr("dtype")?.getattr("names")?.is_none() {
        value.getattr("dtype")?.getattr("names")?.extract()?
    } else {
        return Ok(None);
    };
    let columns = names.iter().map(|name| {
        let column = value.get_item(PyString::new(py, name))?;
        // a time in nanoseconds since 1970 has more digits than a double
        if let Some(texts) = integers(&column)? {
            return Ok(Cells::Integers(texts));
        }
        let column = Numbers::of("column", &column)?.list();
        column.map(Cells::Numbers).map_err(|error| refused(format!("{name}: {}", error.value(py))))
    });
    let columns = columns.collect::<PyResult<Vec<Cells>>>()?;
    let rows = columns.first().map_or(0, Cells::len);
    if let Some(place) = columns.iter().position(|column| column.len() != rows) {
        return Err(refused(format!(
            "{}: an array of shape ({},); it must be of shape ({rows},), as {}",
            names[place],
            columns[place].len(),
            names[0]
        )));
    }
    let quoted = |name: &String| format!("\"{}\"", name.replace('"', "\"\""));
    let mut text = names.iter().map(quoted).collect::<Vec<_>>().join(",");
    for row in 0..rows {
        text.push('\n');
        for (place, column) in columns.iter().enumerate() {
            let comma = if place > 0 { "," } else { "" };
            let _ = match column {
                Cells::Numbers(numbers) => write!(text, "{comma}{:?}", numbers[row]),
                Cells::Integers(texts) => write!(text, "{comma}{}", texts[row]),
            };
        }
    }
    text.push('\n');
    Ok(Some(text))
}
