//! Times from a column of a text, one line after the other.

use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind, Read, stdin};
use std::path::PathBuf;

use polhode::units::Date;

use crate::error::Error;
use crate::moment::{is_moment, seconds};
use crate::text::visible;

/// A line of times is no longer than this many bytes.
const LONGEST_LINE: u64 = 1 << 20;
/// Where the times stand if nothing else is said.
const NAMES: [&str; 4] = ["t", "time", "jd", "epoch"];

#[derive(Clone, Debug)]
pub enum Source {
    File(PathBuf),
    Standard,
}

impl Source {
    fn name(&self) -> String {
        match self {
            Self::File(path) => path.display().to_string(),
            Self::Standard => "standard input".into(),
        }
    }
}

/// A column of times.
#[derive(Clone, Debug)]
pub struct Column {
    pub source: Source,
    /// Its name or its number, from 1.
    pub wanted: Option<String>,
    pub epoch: Option<Date>,
    pub asked: Asked,
}

/// By which flags or keys a file and its column are named.
#[derive(Clone, Debug)]
pub struct Asked {
    pub file: String,
    pub column: &'static str,
}

impl Column {
    /// Whether the text can be read a second time; a pipe cannot.
    pub fn is_read_again(&self) -> bool {
        match &self.source {
            Source::File(path) => path.is_file(),
            Source::Standard => false,
        }
    }

    pub fn read(&self) -> Result<Lines<'_>, Error> {
        let reader: Box<dyn BufRead> = match &self.source {
            Source::File(path) => {
                let file = File::open(path).map_err(|reason| self.unread(&reason))?;
                Box::new(BufReader::with_capacity(1 << 16, file))
            }
            Source::Standard => Box::new(BufReader::with_capacity(1 << 16, stdin())),
        };
        Ok(Lines { column: self, reader, text: String::new(), line: 0, place: None, is_empty: true })
    }

    fn unread(&self, reason: &dyn std::fmt::Display) -> Error {
        let rule = format!("cannot be read: {reason}");
        Error::input(&self.asked.file, &self.source.name(), &rule, "name a text file of times")
    }
}

/// The times of a column, as they are read.
pub struct Lines<'c> {
    column: &'c Column,
    reader: Box<dyn BufRead>,
    text: String,
    line: u64,
    /// Known with the first line.
    place: Option<Place>,
    is_empty: bool,
}

/// Where the times stand in a line.
struct Place {
    /// From 0.
    column: usize,
    name: String,
    /// Nothing else stands there, so that a date may hold a blank.
    alone: bool,
}

impl Iterator for Lines<'_> {
    type Item = Result<f64, Error>;
    fn next(&mut self) -> Option<Result<f64, Error>> {
        loop {
            self.text.clear();
            self.line += 1;
            match self.reader.by_ref().take(LONGEST_LINE).read_line(&mut self.text) {
                Ok(0) if self.is_empty => {
                    self.is_empty = false;
                    return Some(Err(self.refused("", "no time in it", "write one time a line")));
                }
                Ok(0) => return None,
                Ok(length) if length as u64 == LONGEST_LINE => {
                    let rule = format!("longer than {LONGEST_LINE} bytes");
                    return Some(Err(self.refused("", &rule, "write one time a line")));
                }
                Ok(_) => {}
                Err(reason) if reason.kind() == ErrorKind::InvalidData => {
                    return Some(Err(self.refused("", "not UTF-8", "name a text file of times")));
                }
                Err(reason) => return Some(Err(self.column.unread(&reason))),
            }
            let text = self.text.trim_start_matches('\u{feff}').trim();
            if text.is_empty() || text.starts_with('#') {
                continue;
            }
            if self.place.is_none() {
                match place(text, self.column.wanted.as_deref(), self.column.asked.column) {
                    Ok((place, is_header)) => {
                        self.place = Some(place);
                        if is_header {
                            continue;
                        }
                    }
                    Err((rule, remedy)) => return Some(Err(self.refused("", &rule, &remedy))),
                }
            }
            let Some(place) = &self.place else { continue };
            self.is_empty = false;
            let cell = if place.alone { Some(text) } else { cells(text).nth(place.column) };
            let Some(cell) = cell else {
                return Some(Err(self.refused("", "has no such column", "give every line a time")));
            };
            let found = seconds(cell, self.column.epoch.as_ref());
            return Some(found.map_err(|error| {
                let (file, line) = (self.column.source.name(), self.line);
                let (number, name) = (place.column + 1, visible(&place.name));
                Error::Input(format!("{file}, line {line}, column {number} ({name}): {}", visible(&error)))
            }));
        }
    }
}

impl Lines<'_> {
    fn refused(&self, value: &str, rule: &str, remedy: &str) -> Error {
        Error::input(&format!("{}, line {}", self.column.source.name(), self.line), value, rule, remedy)
    }
}

/// The cells of a line, apart by comma, semicolon, tab or blanks.
fn cells(line: &str) -> Box<dyn Iterator<Item = &str> + '_> {
    match [',', ';', '\t'].into_iter().find(|&c| line.contains(c)) {
        Some(delimiter) => Box::new(line.split(delimiter).map(|cell| cell.trim().trim_matches('"'))),
        None => Box::new(line.split_whitespace()),
    }
}

/// From the first line: where the times stand, and whether the line is a header. Else a rule and a remedy.
fn place(line: &str, wanted: Option<&str>, flag: &str) -> Result<(Place, bool), (String, String)> {
    if wanted.is_none() && is_moment(line).is_ok() {
        return Ok((Place { column: 0, name: "t".into(), alone: true }, false));
    }
    let names: Vec<&str> = cells(line).collect();
    let is_header = names.iter().all(|cell| is_moment(cell).is_err());
    let listed = || {
        let shown: Vec<String> = names.iter().map(|name| format!("'{}'", visible(name))).collect();
        shown.join(", ")
    };
    let by_number = |text: &str| {
        let number = text.parse::<usize>().ok()?;
        (1..=names.len()).contains(&number).then(|| number - 1)
    };
    let (found, remedy) = match wanted {
        Some(text) => {
            let named = names.iter().position(|name| is_header && *name == text);
            (named.or_else(|| by_number(text)), format!("name one of them by {flag}"))
        }
        None if names.len() == 1 => (Some(0), String::new()),
        None => {
            let named = |known: &&str| names.iter().position(|name| name.eq_ignore_ascii_case(known));
            (
                NAMES.iter().find_map(named).filter(|_| is_header),
                format!("name the column of times by {flag}"),
            )
        }
    };
    match found {
        Some(column) => {
            let name = if is_header { names[column].into() } else { "t".into() };
            Ok((Place { column, name, alone: names.len() == 1 }, is_header))
        }
        None => {
            let rule = match wanted {
                Some(text) => format!("no column '{text}'; the line has {}", listed()),
                None if is_header => format!("no column 't'; the line has {}", listed()),
                None => format!("{} columns without a header: {}", names.len(), listed()),
            };
            Err((rule, remedy))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, wanted: Option<&str>, epoch: Option<&str>) -> Result<Vec<f64>, String> {
        let scratch = tempfile::tempdir().unwrap();
        let path = scratch.path().join("epochs.txt");
        std::fs::write(&path, text).unwrap();
        let column = Column {
            source: Source::File(path),
            wanted: wanted.map(String::from),
            epoch: epoch.map(|date| date.parse().unwrap()),
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
    }

    #[test]
    fn what_is_no_time_is_refused_with_its_place() {
        for (text, wanted, says) in [
            ("1\nx\n", None, ", line 2, column 1 (t): 'x' is not a number; write it like 0.5 or 1e-3"),
            ("t,a\n1,2\n,3\n", None, ", line 3, column 1 (t): a number is missing"),
            ("1,2\n", None, ", line 1: 2 columns without a header: '1', '2'; name the column of times"),
            ("a,b\n1,2\n", None, ", line 1: no column 't'; the line has 'a', 'b'; name the column of times"),
            (
                "a,b\n1,2\n3,4\n",
                Some("c"),
                ", line 1: no column 'c'; the line has 'a', 'b'; name one of them",
            ),
            ("# nothing\n\n", None, ", line 3: no time in it"),
            ("t,b\n1,2\n2025-01-01,5\n", None, ", line 3, column 1 (t): '2025-01-01' is a date; give"),
        ] {
            let error = read(text, wanted, None).unwrap_err();
            assert!(error.starts_with(says), "{text:?}: {error}");
        }
        assert!(read("b\n1\n", Some("b"), None).is_ok());
        assert!(read("a b\n1 2\n3\n", Some("b"), None).unwrap_err().contains("line 3: has no such column"));
    }
}
