//! Tables in memory: data frames, structured arrays and dicts of columns, read by the names of their columns as files are.

use std::fmt::Write;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use crate::arrays::Numbers;
use crate::error::{PolhodeError, refused};

/// What stands in a column.
enum Cells {
    Numbers(Vec<f64>),
    Texts(Vec<String>),
}

impl Cells {
    fn len(&self) -> usize {
        match self {
            Cells::Numbers(numbers) => numbers.len(),
            Cells::Texts(texts) => texts.len(),
        }
    }
}

/// The table as the text of a CSV, whose numbers have all their digits; `None` of what is no table.
pub(crate) fn text(value: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
    let py = value.py();
    // pandas and polars write their own
    if value.hasattr("to_csv")? {
        if value.hasattr("columns")? {
            let names = value.getattr("columns")?.try_iter()?;
            check_names(
                &names.map(|name| Ok::<_, PyErr>(name?.str()?.to_string())).collect::<PyResult<Vec<_>>>()?,
            )?;
        }
        let options = PyDict::new(py);
        options.set_item("index", false)?;
        return value.call_method("to_csv", (), Some(&options))?.extract().map(Some);
    }
    if value.hasattr("write_csv")? {
        return value.call_method0("write_csv")?.extract().map(Some);
    }
    let names: Vec<String> = if let Ok(columns) = value.cast::<PyDict>() {
        columns.keys().extract().map_err(|_| refused("path: the names of columns are texts"))?
    } else {
        // the types of other arrays than those of numpy have no names
        let names = value.getattr_opt("dtype")?.map(|kind| kind.getattr_opt("names")).transpose()?.flatten();
        let Some(names) = names.filter(|names| !names.is_none()) else { return Ok(None) };
        names.extract()?
    };
    check_names(&names)?;
    let columns = names.iter().map(|name| {
        let column = value.get_item(PyString::new(py, name))?;
        // a time in nanoseconds since 1970 has more digits than a double
        if let Some(texts) = texts(&column)? {
            return Ok(Cells::Texts(texts));
        }
        let column = Numbers::of("column", &column).and_then(Numbers::list);
        column.map(Cells::Numbers).map_err(|error| match error.is_instance_of::<PolhodeError>(py) {
            true => refused(format!("{name}: {}", error.value(py)).replacen(": column: ", ": ", 1)),
            false => error,
        })
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
    let mut text = names.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(",");
    for row in 0..rows {
        text.push('\n');
        for (place, column) in columns.iter().enumerate() {
            let comma = if place > 0 { "," } else { "" };
            let _ = match column {
                Cells::Numbers(numbers) => write!(text, "{comma}{:?}", numbers[row]),
                Cells::Texts(texts) => write!(text, "{comma}{}", texts[row]),
            };
        }
    }
    text.push('\n');
    Ok(Some(text))
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

/// Refuses names that would be a row of the table: a frame that was made without names counts its columns.
fn check_names(names: &[String]) -> PyResult<()> {
    if names.is_empty() || names.iter().any(|name| name.trim().parse::<f64>().is_err()) {
        return Ok(());
    }
    Err(refused(format!(
        "path: the columns are called {}, which may be a row of numbers; give them names, as t, wx, wy and wz",
        names.join(", ")
    )))
}

/// The cells of a list of integers, with all their digits, or of dates, texts or truth values, as a file has them; `None` of what else there is.
fn texts(column: &Bound<'_, PyAny>) -> PyResult<Option<Vec<String>>> {
    // masked values have no number, and those in units are refused where numbers are made of them
    if column.hasattr("filled")? || column.hasattr("units")? {
        return Ok(None);
    }
    // what is no array is told where numbers are made of it
    let Ok(array) = column.py().import("numpy")?.call_method1("asarray", (column,)) else { return Ok(None) };
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    let dimensions: usize = array.getattr("ndim")?.extract()?;
    if dimensions != 1 || !matches!(kind.as_str(), "i" | "u" | "M" | "U" | "b") {
        return Ok(None);
    }
    let texts: Vec<String> = array.call_method1("astype", ("str",))?.call_method0("tolist")?.extract()?;
    let is_free = kind == "U";
    Ok(Some(if is_free {
        texts.iter().map(|text| quoted(&text.replace(['\n', '\r'], " "))).collect()
    } else {
        texts
    }))
}
