//! Times from a column of a text, one line after the other.

use std::path::{Path, PathBuf};

use polhode::units::TimeUnit;

use crate::error::{Error, Rule, TableError};
use crate::instant::{Epoch, is_moment, is_other_integer, seconds};
use crate::table::{
    ColumnNames, Delimiter, Lines as Text, Name, ReadOptions, Source as Rows, Table, uncommented, width_rule,
};
use crate::text::visible;

/// Where times come from.
#[derive(Clone, Debug)]
pub enum Source {
    /// A file.
    File(PathBuf),
    /// Standard input.
    Standard,
}

/// A column of times.
#[derive(Clone, Debug)]
pub struct TimesColumn {
    /// The text that holds it.
    pub source: Source,
    /// Its name or its number, from 1.
    pub wanted: Option<String>,
    /// The date of t = 0.
    pub epoch: Option<Epoch>,
    /// The flags that name it, for messages.
    pub asked: Asked,
}

/// By which flags or keys a file and its column are named.
#[derive(Clone, Debug)]
pub struct Asked {
    /// The file.
    pub file: String,
    /// The column.
    pub column: &'static str,
}

impl TimesColumn {
    /// Whether the text can be read a second time; a pipe cannot.
    pub fn is_read_again(&self) -> bool {
        match &self.source {
            Source::File(path) => path.is_file(),
            Source::Standard => false,
        }
    }

    /// The times from the first line on.
    ///
    /// # Errors
    /// A file that cannot be opened.
    pub fn read(&self) -> Result<Times<'_>, Error> {
        let text = match &self.source {
            Source::File(path) => Text::open(path),
            Source::Standard => Text::open(Path::new("-")),
        };
        let text = text.map_err(|error| self.named(&error))?;
        let text = match Rows::new(text)? {
            Rows::Plain(mut lines, first) => {
                let is_ahead = first.is_some();
                lines.text = first.map(|line| line.text).unwrap_or_default();
                Layout::Lines { lines, is_ahead, header: None, unit_said: None, place: None }
            }
            rows => Layout::Blocks { table: Box::new(self.blocks(rows)?), last: None },
        };
        Ok(Times { column: self, text, is_empty: true, is_over: false })
    }

    /// Dumps and messages as a table, which must tell a time.
    fn blocks(&self, rows: Rows<'static>) -> Result<Table<'static>, TableError> {
        let columns = self.wanted.as_deref().and_then(|name| ColumnNames::parse(&format!("t={name}")).ok());
        let table = Table::new(rows, &ReadOptions::default().with_columns(columns.unwrap_or_default()))?;
        match table.header.time {
            Some(time) if table.counts_steps() => {
                let remedy = "have the times dumped too, by dump_modify time yes";
                Err(table.refused_column(time, Rule::Time).with_remedy(remedy))
            }
            _ => Ok(table),
        }
    }

    /// A refusal of the file as a whole, with the flag that names it.
    fn named(&self, error: &TableError) -> Error {
        Error::input(&self.asked.file, &error.file, &error.rule.to_string(), "name a text file of times")
    }
}

/// The times of a column, s, as they are read.
pub struct Times<'c> {
    column: &'c TimesColumn,
    text: Layout,
    is_empty: bool,
    is_over: bool,
}

/// How times stand in a text.
enum Layout {
    /// Plain lines.
    Lines {
        lines: Text<'static>,
        /// Whether the present line is still to be read.
        is_ahead: bool,
        /// The last comment above the rows, which may name the columns.
        header: Option<String>,
        /// The first unit of time that a comment above the rows names in full.
        unit_said: Option<String>,
        /// Known with the first line.
        place: Option<Box<Place>>,
    },
    /// Blocks that all have one time each: dumps of LAMMPS, messages of ROS.
    Blocks { table: Box<Table<'static>>, last: Option<f64> },
}

/// Where the times stand in a line.
struct Place {
    /// From 0.
    column: usize,
    name: String,
    /// The unit of times that name none.
    unit: Option<TimeUnit>,
    /// Whether numbers are Julian dates.
    is_julian: bool,
    /// Why they are none that are read, and what to do.
    refused: Option<(String, &'static str)>,
    delimiter: Delimiter,
    /// Columns of the first line; with one, a date may hold a blank.
    columns: usize,
}

impl Iterator for Times<'_> {
    type Item = Result<f64, Error>;
    fn next(&mut self) -> Option<Result<f64, Error>> {
        if self.is_over {
            return None;
        }
        let found = self.advance().transpose();
        self.is_over = !matches!(found, Some(Ok(_)));
        found.map(|time| time.map_err(Error::from))
    }
}

impl Times<'_> {
    /// The next time.
    fn advance(&mut self) -> Result<Option<f64>, TableError> {
        let none = |name: &str| TableError::of(name, Rule::Rows).with_remedy("write one time a line");
        let (lines, is_ahead, header, unit_said, found) = match &mut self.text {
            Layout::Lines { lines, is_ahead, header, unit_said, place } => {
                (lines, is_ahead, header, unit_said, place)
            }
            Layout::Blocks { table, last } => {
                while table.next()? {
                    table.check()?;
                    let time = table.time()?;
                    // each atom of a block has its time
                    if last.replace(time) != Some(time) {
                        self.is_empty = false;
                        return Ok(Some(time));
                    }
                }
                return if self.is_empty { Err(none(table.name())) } else { Ok(None) };
            }
        };
        loop {
            if !std::mem::take(is_ahead) && !lines.advance()? {
                return if self.is_empty { Err(none(&lines.name)) } else { Ok(None) };
            }
            let text = lines.text.trim();
            if let Some(comment) = uncommented(text) {
                if found.is_none() {
                    *unit_said = unit_said.take().or_else(|| unit_in(comment));
                }
                *header = Some(comment.into());
                continue;
            }
            if text.is_empty() {
                continue;
            }
            if found.is_none() {
                let asked = (self.column.wanted.as_deref(), self.column.asked.column);
                let own = place(text, asked.0, asked.1);
                let delimiter = Delimiter::of(text);
                let columns = delimiter.names(text).len();
                // of a row that tells its place itself a comment above it may still tell the unit
                let says_more = |named: &Place| match &own {
                    Err(_) => true,
                    Ok((_, is_header)) => {
                        !is_header && (named.unit.is_some() || named.is_julian || named.refused.is_some())
                    }
                };
                let named = header.as_deref().map(|header| place(header, asked.0, asked.1));
                let named = match named {
                    Some(Ok((place, true))) => {
                        Some(place).filter(|place| place.columns == columns && says_more(place))
                    }
                    _ => None,
                };
                let (place, is_header) = match named {
                    Some(place) => (Place { delimiter, ..place }, false),
                    None => own.map_err(|(rule, remedy)| lines.refused(rule).with_remedy(&remedy))?,
                };
                if let Some((rule, remedy)) = &place.refused {
                    return Err(lines.refused(Rule::Other(rule.clone())).with_remedy(remedy));
                }
                *found = Some(Box::new(place));
                if is_header {
                    continue;
                }
            }
            let Some(place) = found else { continue };
            if let (Some(unit), true) = (unit_said.take(), self.is_empty && place.takes_seconds(text)) {
                let rule = Rule::Other(format!(
                    "is a number of s, but a comment above speaks of {}",
                    visible(&unit)
                ));
                let refused = lines.refused(rule).in_column(place.column, &place.name).value(text);
                return Err(refused.with_remedy("name the unit in a header such as 't (s)'"));
            }
            self.is_empty = false;
            return place.time(lines, self.column.epoch).map(Some);
        }
    }
}

impl Place {
    /// Whether the time in a line is a number without any unit.
    fn takes_seconds(&self, line: &str) -> bool {
        let cells = if self.columns > 1 { self.delimiter.names(line) } else { vec![line.to_string()] };
        let number = cells.get(self.column).map(|cell| self.delimiter.number(cell).parse::<f64>());
        self.unit.is_none() && !self.is_julian && matches!(number, Some(Ok(_)))
    }

    /// The time in a line.
    fn time(&self, line: &Text, epoch: Option<Epoch>) -> Result<f64, TableError> {
        let text = line.text.trim();
        let mut cells = vec![text.to_string()];
        if self.columns > 1 {
            cells = self.delimiter.names(text);
            if cells.len() == self.columns + 1 && cells.last().is_some_and(String::is_empty) {
                cells.pop();
            }
            let (widths, ended) = ((cells.len(), self.columns), line.is_ended);
            if let Some(rule) = width_rule((text, ended), self.delimiter, widths, self.column, self.columns) {
                return Err(line.refused(rule));
            }
        }
        let cell = cells.get(self.column).map_or("", String::as_str);
        let refused = |rule: Rule| line.refused(rule).in_column(self.column, &self.name).value(cell);
        if cell.is_empty() {
            return Err(refused(Rule::Missing));
        }
        let number = self.delimiter.number(cell);
        if self.is_julian && epoch.is_none() {
            let rule = Rule::Other("is a Julian date".into());
            return Err(refused(rule).with_remedy("give the date of t = 0 by --epoch"));
        }
        match (self.unit, number.parse::<f64>()) {
            (Some(_), Ok(value)) if value.is_finite() && is_other_integer(&number, value) => {
                let rule = Rule::Other(format!("has too many digits for a double, the nearest is {value:e}"));
                Err(refused(rule).with_remedy("count from a later time"))
            }
            (Some(unit), Ok(value)) if value.is_finite() => match unit.seconds(value) {
                time if time.is_finite() => Ok(time),
                _ => {
                    let rule = Rule::Other("is too long a time for a double".into());
                    Err(refused(rule).with_remedy("leave the row out"))
                }
            },
            _ => seconds(&number, epoch).map_err(|error| match error.split_once("; ") {
                // why it is no date, or cannot count from that of t = 0
                Some((reason, remedy)) if epoch.is_some() => line
                    .refused(Rule::Other(reason.into()))
                    .in_column(self.column, &self.name)
                    .with_remedy(remedy),
                Some((_, remedy))
                    if number.parse::<f64>().is_err()
                        && !error.contains(" is a date")
                        && !error.contains("no unit") =>
                {
                    refused(Rule::Number).with_remedy(remedy)
                }
                _ => line
                    .refused(Rule::Other(error))
                    .in_column(self.column, &self.name)
                    .with_remedy("write one time a line"),
            }),
        }
    }
}

/// From the first line: where the times stand, and whether the line is a header. Else a rule and a remedy.
fn place(line: &str, wanted: Option<&str>, flag: &str) -> Result<(Place, bool), (Rule, String)> {
    let delimiter = Delimiter::of(line);
    if wanted.is_none() && is_time(line) {
        let column = Place {
            column: 0,
            name: "t".into(),
            unit: None,
            is_julian: false,
            refused: None,
            delimiter,
            columns: 1,
        };
        return Ok((column, false));
    }
    let cells = cells(line, delimiter);
    let is_header = !cells.iter().any(|cell| is_time(cell));
    let names: Vec<Name> = cells.iter().map(|cell| Name::of(cell)).collect();
    let by_number =
        |text: &str| text.parse::<usize>().ok().filter(|n| (1..=cells.len()).contains(n)).map(|n| n - 1);
    let ranked = || {
        let ranks = names.iter().enumerate().filter(|(_, name)| !name.is_counter());
        ranks.filter_map(|(k, name)| Some((name.time_rank()?, k))).min().map(|(_, k)| k)
    };
    let (found, remedy) = match wanted {
        Some(text) => {
            let named = cells.iter().position(|name| is_header && name == text);
            (named.or_else(|| by_number(text)), format!("name one of them by {flag}"))
        }
        None if cells.len() == 1 && (!is_header || unit_of(&names[0]).is_some() || is_julian(&names[0])) => {
            (Some(0), String::new())
        }
        None if cells.len() == 1 && less_an_offset(&names[0]).is_some() => (Some(0), String::new()),
        None => (ranked().filter(|_| is_header), format!("name the column of times by {flag}")),
    };
    let Some(column) = found else {
        let missing = wanted.map_or_else(|| "time".to_string(), |text| format!("'{text}'"));
        return Err((Rule::Column(missing, cells), remedy));
    };
    let same = cells.iter().skip(column + 1).position(|name| is_header && *name == cells[column]);
    if let (Some(second), None) = (same, wanted.and_then(by_number)) {
        return Err((
            Rule::Unique(column + 1, column + second + 2),
            format!("give the number of one by {flag}"),
        ));
    }
    let name = if is_header { cells[column].clone() } else { "t".into() };
    let refused = less_an_offset(&names[column]).filter(|_| is_header);
    let refused = refused.map(|(what, remedy)| (format!("column '{}' has {what}", visible(&name)), remedy));
    let is_julian = is_header && is_julian(&names[column]);
    let unit = match names[column].time_unit() {
        _ if is_julian => None,
        Some((text, None)) if is_header && refused.is_none() && names[column].time_rank().is_some() => {
            let rule = Rule::Other(format!("column '{}' is in '{}'", visible(&name), visible(text)));
            return Err((rule, "known units of time: s, ms, us, ns, min, h, d".into()));
        }
        Some((_, unit)) if is_header => unit,
        _ if is_header => unit_of(&names[column]),
        _ => None,
    };
    Ok((Place { column, name, unit, is_julian, refused, delimiter, columns: cells.len() }, is_header))
}

/// Whether a cell is a time; JD-2450000 is the name of a column.
fn is_time(cell: &str) -> bool {
    !cell.starts_with("JD-") && is_moment(cell).is_ok()
}

/// Whether a name is that of Julian dates: as they are, or of the barycentre or the Sun.
fn is_julian(name: &Name) -> bool {
    ["jd", "bjd", "hjd", "julian"].iter().any(|stem| name.letters.starts_with(stem))
}

/// What a column has whose name is that of Julian dates less an offset, as MJD, TJD and BJD-2457000, and what to do.
fn less_an_offset(name: &Name) -> Option<(&'static str, &'static str)> {
    let begins = |stems: &[&str]| stems.iter().any(|stem| name.letters.starts_with(stem));
    let long_number = || name.letters.split(|c: char| !c.is_ascii_digit()).any(|digits| digits.len() > 4);
    if begins(&["mjd", "bmjd", "hmjd"]) {
        Some(("modified Julian dates", "write Julian dates, which are 2400000.5 more"))
    } else if begins(&["rjd", "tjd", "btjd", "bkjd"]) || is_julian(name) && long_number() {
        Some(("Julian dates less an offset", "write whole Julian dates"))
    } else {
        None
    }
}

/// The unit of time that is the whole name of a column.
fn unit_of(name: &Name) -> Option<TimeUnit> {
    TimeUnit::named(&name.letters).filter(|_| name.unit.is_none())
}

/// The first unit of time but seconds that a comment names in full, other than behind a number, as in 'a record of 24 hours', or in
/// short, as in 't in min', 'unit: h' and 't/d'.
fn unit_in(comment: &str) -> Option<String> {
    const UNITS: [&str; 6] = ["minute", "hour", "day", "millisecond", "microsecond", "nanosecond"];
    let words: Vec<&str> =
        comment.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let is_unit = |word: &str| {
        let word = word.to_lowercase();
        UNITS.contains(&word.strip_suffix('s').unwrap_or(&word))
    };
    const SHORT: [&str; 9] = ["min", "mins", "h", "hr", "hrs", "d", "ms", "us", "ns"];
    let is_said = |before: &str| ["in", "unit", "units"].contains(&before.to_lowercase().as_str());
    let quotient = comment.split_whitespace().filter_map(|word| word.split_once('/'));
    let mut quotients = quotient.filter(|(of, by)| ["t", "time"].contains(of) && SHORT.contains(by));
    if let Some((_, unit)) = quotients.next() {
        return Some(unit.into());
    }
    let is_short = |k: usize| k > 0 && SHORT.contains(&words[k]) && is_said(words[k - 1]);
    let behind_number = |k: usize| k > 0 && words[k - 1].ends_with(|c: char| c.is_ascii_digit());
    (0..words.len()).find(|&k| is_unit(words[k]) && !behind_number(k) || is_short(k)).map(|k| words[k].into())
}

/// The cells of a line; between blanks a unit in brackets is that of the name before it.
fn cells(line: &str, delimiter: Delimiter) -> Vec<String> {
    let mut cells: Vec<String> = Vec::new();
    for cell in delimiter.names(line) {
        match cells.last_mut() {
            Some(name) if delimiter == Delimiter::Blanks && cell.starts_with(['(', '[']) => {
                name.push(' ');
                name.push_str(&cell);
            }
            _ => cells.push(cell),
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, wanted: Option<&str>, epoch: Option<&str>) -> Result<Vec<f64>, String> {
        let scratch = tempfile::tempdir().unwrap();
        let path = scratch.path().join("epochs.txt");
        std::fs::write(&path, text).unwrap();
        let column = TimesColumn {
            source: Source::File(path),
            wanted: wanted.map(String::from),
            epoch: epoch.map(|date| Epoch::new(date.parse().unwrap(), None)),
            asked: Asked { file: "--times".into(), column: "--times-column" },
        };
        let times: Result<Vec<f64>, Error> = column.read().unwrap().collect();
        times.map_err(|error| error.to_string().rsplit("epochs.txt").next().unwrap().to_string())
    }

    #[test]
    fn one_time_a_line_or_a_column() {
        assert_eq!(read("# s\n1\n\n-2e3\r\n5min\n", None, None), Ok(vec![1.0, -2e3, 300.0]));
        assert_eq!(read("t\n1\n2\n", None, None), Ok(vec![1.0, 2.0]));
        assert_eq!(read("i,T,mag\n0,1.5,9\n1,2.5,9\n", None, None), Ok(vec![1.5, 2.5]));
        assert_eq!(read("jd mag\n2451545.5 1\n", None, Some("2451545")), Ok(vec![43_200.0]));
        assert_eq!(read("a;b\n1;2\n3;4\n", Some("b"), None), Ok(vec![2.0, 4.0]));
        assert_eq!(read("1 2\n3 4\n", Some("2"), None), Ok(vec![2.0, 4.0]));
        assert_eq!(read("2000-01-01 12:00:01\n", None, Some("2000-01-01T12:00")), Ok(vec![1.0]));
        for header in ["t (min)", "t(min)", "t [min]", "# t (min)", "# min", "minutes"] {
            assert_eq!(read(&format!("{header}\n1\n2\n"), None, None), Ok(vec![60.0, 120.0]), "{header}");
        }
        assert_eq!(read("t (min) flux\n1 7\n2 7\n", None, None), Ok(vec![60.0, 120.0]));
        assert_eq!(read("# flux t (h)\n7 1\n", Some("2"), None), Ok(vec![3600.0]));
        assert_eq!(read("# of 2024\n1\n", None, None), Ok(vec![1.0]));
        for comment in [
            "# time in minutes",
            "# Hours since launch\n# of a pass",
            "# t in min",
            "# unit: h",
            "# t/d",
            "# time/h",
        ] {
            assert_eq!(read(&format!("{comment}\nt (s)\n1\n"), None, None), Ok(vec![1.0]), "{comment}");
            assert_eq!(read(&format!("{comment}\n1min\n"), None, None), Ok(vec![60.0]), "{comment}");
            assert!(read(&format!("{comment}\n1\n"), None, None).is_err(), "{comment}");
        }
        assert_eq!(read("# time/ms\n1\n", None, None), Ok(vec![1e-3]));
        assert_eq!(read("# a pass of 24 hours, or 1440 minutes\n1\n", None, None), Ok(vec![1.0]));
        assert_eq!(read("1\n# minutes from here on are no header\n2\n", None, None), Ok(vec![1.0, 2.0]));
    }

    #[test]
    fn what_is_no_time_is_refused_with_its_place() {
        for (text, wanted, says) in [
            ("1\nx\n", None, ", line 2, column 1 (t): 'x': is not a number; write it like 0.5 or 1e-3"),
            ("t,a\n1,2\n,3\n", None, ", line 3, column 1 (t): a number is missing"),
            (
                "1,2\n",
                None,
                ", line 1: no column for time; the header has '1', '2'; name the column of times",
            ),
            (
                "a,b\n1,2\n",
                None,
                ", line 1: no column for time; the header has 'a', 'b'; name the column of times",
            ),
            (
                "a,b\n1,2\n3,4\n",
                Some("c"),
                ", line 1: no column for 'c'; the header has 'a', 'b'; name one of them",
            ),
            ("# nothing\n\n", None, ": no rows; write one time a line"),
            (
                "time_min\n1\n",
                None,
                ", line 1: no column for time; the header has 'time_min'; name the column",
            ),
            ("t (d)\n1e308\n", None, ", line 2, column 1 (t (d)): '1e308': is too long a time for a double"),
            (
                "t (ns)\n0\n1700000000000000001\n",
                None,
                ", line 3, column 1 (t (ns)): '1700000000000000001': has too many digits for a double, the nearest is 1.7e18; count",
            ),
            ("t (ticks)\n1\n", None, ", line 1: column 't (ticks)' is in 'ticks'; known units of time"),
            (
                "jd\n2451545.5\n",
                None,
                ", line 2, column 1 (jd): '2451545.5': is a Julian date; give the date",
            ),
            (
                "# JD_UTC\n2451545.5\n",
                None,
                ", line 2, column 1 (JD_UTC): '2451545.5': is a Julian date; give",
            ),
            ("MJD,mag\n59000.5,9\n", Some("MJD"), ", line 1: column 'MJD' has modified Julian dates; write"),
            ("# MJD\n59000.5\n", None, ", line 2: column 'MJD' has modified Julian dates; write"),
            ("HMJD\n59000.5\n", None, ", line 1: column 'HMJD' has modified Julian dates; write"),
            ("HJD-2450000\n9000.5\n", None, ", line 1: column 'HJD-2450000' has Julian dates less an offset"),
            ("JD-2450000\n9000.5\n", None, ", line 1: column 'JD-2450000' has Julian dates less an offset"),
            ("BTJD (d),mag\n1325.3,9\n", Some("1"), ", line 1: column 'BTJD (d)' has Julian dates less an"),
            (
                "# time in minutes\n1\n",
                None,
                ", line 2, column 1 (t): '1': is a number of s, but a comment above speaks of minutes; name the unit",
            ),
            ("t,b\n1,2\n2025-01-01,5\n", None, ", line 3, column 1 (t): '2025-01-01' is a date; give"),
        ] {
            let error = read(text, wanted, None).unwrap_err();
            assert!(error.starts_with(says), "{text:?}: {error}");
        }
        for (text, says) in [
            (
                "time,mag\n2024-03-31T01:59:59,1\n",
                ", line 2, column 1 (time): '2024-03-31T01:59:59': one date is in UTC and the other has no time scale",
            ),
            ("t\n2024-03-32Z\n", ", line 2, column 1 (t): '2024-03-32Z' is not a date: "),
        ] {
            let error = read(text, None, Some("2024-03-31T00:00Z")).unwrap_err();
            assert!(error.starts_with(says), "{text:?}: {error}");
        }
        assert!(read("b\n1\n", Some("b"), None).is_ok());
        assert!(
            read("a b\n1 2\n3\n", Some("b"), None)
                .unwrap_err()
                .contains("line 3: the row has 1 of 2 columns")
        );
    }
}
