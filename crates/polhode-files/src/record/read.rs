//! Rows of numbers from a text.

use polhode::record::{RecordError, Rows};
use polhode::units::{RateUnit, TimeUnit};

use super::clock::{Clock, Preamble};
use super::columns::{cells, find_header, may_part_thousands, uncommented};
use super::echo;
use super::names::{Found, find_columns, rate_unit, time_unit};

/// How a text is read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Unit of time where the header names none; without it that of the layout, or s.
    pub time_unit: Option<TimeUnit>,
    /// Unit of the rates where the header names none; without it that of the layout, or rad/s.
    pub rate_unit: Option<RateUnit>,
    /// Columns of the time and of the rates about x, y and z, by their names in the header or their numbers from 1.
    pub columns: Option<[String; 4]>,
    /// Share of the rows that may be left out because they cannot be read, 0.02 without it.
    pub most_skipped: Option<f64>,
}

/// Share of bad rows that is passed over.
const MOST_SKIPPED: f64 = 0.02;

/// What a text says about its columns.
struct Layout {
    names: Vec<String>,
    found: Found,
    /// Number of the first line after the header.
    first: usize,
}

/// The rows of `text`; `file` names it in messages.
pub(super) fn rows(text: &str, file: &str, reading: &Reading) -> Result<Rows, RecordError> {
    let text = text.trim_start_matches('\u{feff}');
    let is_whole = text.ends_with(['\n', '\r']);
    let echoed = echo::table(text);
    let text = echoed.as_deref().unwrap_or(text);
    // a carriage return alone ends a line too; a tab in front is an empty cell
    let lines = text.split('\n').flat_map(|l| l.strip_suffix('\r').unwrap_or(l).split('\r'));
    let lines = lines.map(|l| l.trim_end().trim_start_matches(|c: char| c.is_whitespace() && c != '\t'));
    let lines: Vec<(usize, &str)> =
        lines.enumerate().map(|(k, l)| (k + 1, l)).filter(|(_, l)| !l.is_empty()).collect();
    let layout = layout(&lines, file, reading)?;
    let (names, columns) = (&layout.names, layout.found.columns);
    let preamble = Preamble::of(&lines[..layout.first]);
    let mut content = lines[layout.first..].iter().filter(|(_, l)| uncommented(l).is_none()).peekable();

    let mut time = time_unit(&names[columns[0]], file, reading.time_unit)?;
    let mut rates = [None; 3];
    for (axis, unit) in rates.iter_mut().enumerate() {
        *unit = rate_unit(&names[columns[axis + 1]], file, reading.rate_unit)?;
    }
    // a row of units below the names
    if let Some((_, line)) = content.peek() {
        let row = cells(line);
        let cell = |k: usize| row.get(columns[k]).map_or("", String::as_str);
        let units = [1, 2, 3].map(|k| RateUnit::named(cell(k)));
        if let ([Some(_), Some(_), Some(_)], Some(seconds)) = (units, TimeUnit::named(cell(0))) {
            time = reading.time_unit.or(Some(seconds));
            rates = units.map(|unit| reading.rate_unit.or(unit));
            content.next();
        }
    }
    let time = time.or(layout.found.time_unit).or_else(|| preamble.time_unit(&names[columns[0]]));
    let rate_unit = rates[0].or(layout.found.rate_unit).or(preamble.rate_unit());
    let rates =
        rates.map(|unit| unit.or(layout.found.rate_unit).or(preamble.rate_unit()).unwrap_or_default());
    let scale = preamble.scale(&names[columns[1]]);
    let mut clock = Clock::new(time);

    let (mut rows, mut skipped): (Vec<(usize, [f64; 4])>, Vec<RecordError>) = (Vec::new(), Vec::new());
    let mut count = 0;
    while let Some(&(line, text)) = content.next() {
        count += 1;
        let before = rows.last().map(|(_, row)| row[0]);
        let torn = !is_whole && content.peek().is_none() && before.is_some();
        let row = Row { file, line, layout: &layout };
        match row.values(text, &mut clock, rates, scale, before) {
            Ok(values) => rows.push((line, values)),
            // the logger was switched off in the middle of it
            Err(RecordError::Cells { cells, columns, .. }) if torn && cells < columns => {
                let file = file.into();
                skipped.push(RecordError::Torn { file, line });
                count -= 1;
            }
            // a first row that is text is no row of numbers
            Err(error) if rows.is_empty() && error.is_text() => return Err(error),
            Err(error) => skipped.push(error),
        }
    }
    let most = (reading.most_skipped.unwrap_or(MOST_SKIPPED) * count as f64).floor();
    let is_bad = |error: &&RecordError| !matches!(error, RecordError::Torn { .. });
    if skipped.iter().filter(is_bad).count() as f64 > most
        && let Some(first) = skipped.iter().find(is_bad)
    {
        return Err(first.clone());
    }
    let is_read = |place: usize| columns.contains(&place) || layout.found.nanoseconds == Some(place);
    let others = names.iter().enumerate().filter(|(place, _)| !is_read(*place));
    let called = |(place, name): (usize, &String)| match name.as_str() {
        "" => format!("column {}", place + 1),
        name => name.to_string(),
    };
    Ok(Rows {
        rows,
        names: columns.map(|c| names[c].clone()),
        columns: columns.map(|c| c + 1),
        rate_unit,
        unused: others.map(called).collect(),
        skipped,
    })
}

/// Names and places of the columns: as they are asked for, by a header, or by themselves.
fn layout(lines: &[(usize, &str)], file: &str, reading: &Reading) -> Result<Layout, RecordError> {
    let refused = |missing: &str, found: Vec<String>| RecordError::Column {
        file: file.into(),
        missing: missing.into(),
        found,
    };
    if let Some(wanted) = &reading.columns {
        return named(lines, wanted).map_err(|(missing, found)| refused(&missing, found));
    }
    let (first, names) = find_header(lines);
    match find_columns(&names) {
        Ok(found) => Ok(Layout { names, found, first }),
        Err(missing) => headless(lines).ok_or_else(|| refused(missing, names)),
    }
}

/// The columns that a user names.
fn named(lines: &[(usize, &str)], wanted: &[String; 4]) -> Result<Layout, (String, Vec<String>)> {
    // a number is that of a column, also where a cell of numbers holds the same
    let place = |names: &[String], text: &str| match text.parse::<usize>() {
        Ok(number) => (1..=names.len()).contains(&number).then(|| number - 1),
        Err(_) => {
            let named = names.iter().position(|name| name == text);
            named.or_else(|| names.iter().position(|name| name.eq_ignore_ascii_case(text)))
        }
    };
    let found = |names: &[String]| -> Result<[usize; 4], String> {
        let mut columns = [0; 4];
        for (column, text) in columns.iter_mut().zip(wanted) {
            *column = place(names, text).ok_or_else(|| format!("'{text}'"))?;
        }
        Ok(columns)
    };
    let is_number = |cell: &str| cell.parse::<f64>().is_ok();
    let found_as = |columns| Found { columns, nanoseconds: None, time_unit: None, rate_unit: None };
    for (k, (_, line)) in lines.iter().enumerate() {
        let row = cells(uncommented(line).unwrap_or(line));
        let Ok(columns) = found(&row) else { continue };
        // a row of numbers has no header above it that fits
        let is_row = columns[1..].iter().all(|&c| is_number(&row[c]));
        let (names, first) =
            if is_row { ((1..=row.len()).map(|n| n.to_string()).collect(), k) } else { (row, k + 1) };
        return Ok(Layout { names, found: found_as(columns), first });
    }
    let names = find_header(lines).1;
    let missing = found(&names).err().unwrap_or_default();
    Err((missing, names))
}

/// Columns of a message of the type sensor_msgs/Imu that ROS 2 prints as CSV: seconds, nanoseconds, frame, orientation with
/// covariance, then the angular velocity.
const ROS_2_COLUMNS: usize = 40;

/// A text of numbers without a header: time and three rates, or messages of ROS 2.
fn headless(lines: &[(usize, &str)]) -> Option<Layout> {
    let mut content = lines.iter().enumerate().filter(|(_, (_, l))| uncommented(l).is_none());
    let (first, (_, line)) = content.next()?;
    let row = cells(line);
    let numbers = |row: &[String]| row.iter().filter(|cell| cell.parse::<f64>().is_ok()).count();
    let rows = || content.clone().map(|(_, (_, line))| cells(line));
    let alike = rows().count() > 0 && rows().all(|other| numbers(&other) + 1 >= numbers(&row));
    let (columns, nanoseconds) = match row.len() {
        4 if numbers(&row) == 4 && alike => ([0, 1, 2, 3], None),
        ROS_2_COLUMNS if numbers(&row) == ROS_2_COLUMNS - 1 && alike => ([0, 16, 17, 18], Some(1)),
        _ => return None,
    };
    let names = (1..=row.len()).map(|n| n.to_string()).collect();
    Some(Layout { names, found: Found { columns, nanoseconds, time_unit: None, rate_unit: None }, first })
}

/// A line that holds a row.
struct Row<'t> {
    file: &'t str,
    line: usize,
    layout: &'t Layout,
}

impl Row<'_> {
    /// Time and rates, in s and rad/s.
    fn values(
        &self,
        text: &str,
        clock: &mut Clock,
        rates: [RateUnit; 3],
        scale: f64,
        before: Option<f64>,
    ) -> Result<[f64; 4], RecordError> {
        let Layout { names, found, .. } = self.layout;
        let mut row = cells(text);
        // a separator at the end of every row makes one empty cell more
        if row.len() == names.len() + 1 && row.last().is_some_and(String::is_empty) {
            row.pop();
        }
        if row.len() > names.len() || found.columns.iter().any(|&c| c >= row.len()) {
            let (file, line) = (self.file.into(), self.line);
            return Err(RecordError::Cells { file, line, cells: row.len(), columns: names.len() });
        }
        let mut values = [0.0; 4];
        let nanoseconds = found.nanoseconds.map(|c| row.get(c).map_or("", String::as_str));
        values[0] = clock
            .seconds(&row[found.columns[0]], nanoseconds)
            .ok_or_else(|| self.refused(found.columns[0], &row))?;
        for axis in 0..3 {
            let column = found.columns[axis + 1];
            let value = row[column].parse::<f64>().ok().filter(|v| v.is_finite());
            let value = value.ok_or_else(|| self.refused(column, &row))?;
            values[axis + 1] = rates[axis].radians_per_second(value * scale);
        }
        match before {
            Some(before) if values[0] < before => {
                Err(RecordError::Order { file: self.file.into(), line: self.line, time: values[0], before })
            }
            _ => Ok(values),
        }
    }

    fn refused(&self, column: usize, row: &[String]) -> RecordError {
        let (file, line) = (self.file.into(), self.line);
        let (name, value) = (self.layout.names[column].clone(), row[column].clone());
        let column = column + 1;
        if may_part_thousands(&value) {
            RecordError::Comma { file, line, column, name, value }
        } else {
            RecordError::Value { file, line, column, name, value }
        }
    }
}
