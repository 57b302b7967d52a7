//! Lines of a text and their cells, one line in memory at a time.

use std::fs::File;
use std::io::{BufRead, BufReader, Read, stdin};
use std::path::Path;

use crate::error::Error;
use crate::text::visible;

/// A line is no longer than this many bytes.
const LONGEST_LINE: u64 = 1 << 24;
const REMEDY: &str = "name a text file of rows, or - for standard input";

/// What parts the cells of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Delimiter {
    Byte(u8),
    Blanks,
}

impl Delimiter {
    /// Of a line: the first of comma, semicolon and tab that it holds, else blanks.
    pub(super) fn of(line: &str) -> Self {
        let found = [b',', b';', b'\t'].into_iter().find(|c| line.as_bytes().contains(c));
        found.map_or(Self::Blanks, Self::Byte)
    }

    /// The names of a header, of which some may stand in quotes.
    pub(super) fn names(self, line: &str) -> Vec<String> {
        match self {
            Self::Blanks => line.split_whitespace().map(String::from).collect(),
            Self::Byte(byte) => {
                let mut names = vec![String::new()];
                let mut quoted = false;
                for c in line.chars() {
                    match c {
                        '"' => quoted = !quoted,
                        c if c == char::from(byte) && !quoted => names.push(String::new()),
                        c => {
                            if let Some(name) = names.last_mut() {
                                name.push(c);
                            }
                        }
                    }
                }
                names.iter().map(|name| name.trim().to_string()).collect()
            }
        }
    }
}

/// A text, line by line.
pub(super) struct Lines {
    reader: Box<dyn BufRead>,
    /// As messages name it.
    pub(super) name: String,
    text: Vec<u8>,
    /// Of the line that stands in `text`, from 1.
    pub(super) number: u64,
    /// Where the cells of the line stand.
    cells: Vec<(usize, usize)>,
}

impl Lines {
    pub(super) fn open(path: &Path) -> Result<Self, Error> {
        let standard = path.as_os_str() == "-";
        let name = if standard {
            "standard input".into()
        } else {
            visible(&path.display().to_string()).into_owned()
        };
        let reader: Box<dyn BufRead> = if standard {
            Box::new(BufReader::with_capacity(1 << 18, stdin()))
        } else {
            let file = File::open(path)
                .map_err(|reason| Error::Input(format!("{name}: cannot be read: {reason}; {REMEDY}")))?;
            Box::new(BufReader::with_capacity(1 << 18, file))
        };
        Ok(Self { reader, name, text: Vec::new(), number: 0, cells: Vec::new() })
    }

    /// The next line, without blanks at its ends; `None` behind the last.
    pub(super) fn next(&mut self) -> Result<Option<&str>, Error> {
        self.text.clear();
        let read = self.reader.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut self.text);
        let length = read
            .map_err(|reason| Error::Input(format!("{}: cannot be read: {reason}; {REMEDY}", self.name)))?;
        if length == 0 {
            return Ok(None);
        }
        self.number += 1;
        if length as u64 == LONGEST_LINE {
            return Err(self.refused("", &format!("longer than {LONGEST_LINE} bytes"), REMEDY));
        }
        let start = if self.text.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        let place = self.place();
        match std::str::from_utf8(&self.text[start..]) {
            Ok(line) => Ok(Some(line.trim())),
            Err(_) => Err(Error::input(&place, "", "not UTF-8", REMEDY)),
        }
    }

    /// The cells of the present line.
    pub(super) fn split(&mut self, delimiter: Delimiter) -> usize {
        self.cells.clear();
        let end = self.text.len() - self.text.iter().rev().take_while(|c| c.is_ascii_whitespace()).count();
        let mut start = 0;
        match delimiter {
            Delimiter::Byte(byte) => {
                for (place, c) in self.text[..end].iter().enumerate() {
                    if *c == byte {
                        self.cells.push((start, place));
                        start = place + 1;
                    }
                }
                self.cells.push((start, end));
            }
            Delimiter::Blanks => {
                let mut inside = false;
                for (place, c) in self.text[..end].iter().enumerate() {
                    let blank = c.is_ascii_whitespace();
                    if inside && blank {
                        self.cells.push((start, place));
                    } else if !inside && !blank {
                        start = place;
                    }
                    inside = !blank;
                }
                if inside {
                    self.cells.push((start, end));
                }
            }
        }
        self.cells.len()
    }

    /// The text of a cell.
    pub(super) fn cell(&self, place: usize) -> &str {
        let Some(&(start, end)) = self.cells.get(place) else { return "" };
        let text = std::str::from_utf8(&self.text[start..end]).unwrap_or("");
        text.trim_matches(|c: char| c.is_whitespace() || c == '"' || c == '\u{feff}')
    }

    /// The number in a cell; `name` is that of its column.
    pub(super) fn number_at(&self, place: usize, names: &[String]) -> Result<f64, Error> {
        let text = self.cell(place);
        if let Ok(value) = text.parse::<f64>()
            && value.is_finite()
        {
            return Ok(value);
        }
        let name = names.get(place).map_or("", |name| name.as_str());
        let at = format!("{}, line {}, column {} ({})", self.name, self.number, place + 1, visible(name));
        Err(match (self.cells.get(place), text) {
            (None, _) => {
                let rule = format!("missing: the line has {} of {} columns", self.cells.len(), names.len());
                Error::input(&at, "", &rule, "leave the row out, or complete it")
            }
            (_, "") => Error::input(&at, "", "a number is missing", "leave the row out, or complete it"),
            (_, text) if text.parse::<f64>().is_ok() => Error::input(
                &at,
                text,
                "is not a finite number",
                "a verdict needs finite rows; leave out those from where the run diverged",
            ),
            (_, text) => Error::input(&at, text, "is not a number", "write it like 0.5 or 1e-3"),
        })
    }

    pub(super) fn place(&self) -> String {
        format!("{}, line {}", self.name, self.number)
    }

    pub(super) fn refused(&self, value: &str, rule: &str, remedy: &str) -> Error {
        Error::input(&self.place(), value, rule, remedy)
    }
}

/// Significant digits of a number as it is written, without leading zeros.
pub(super) fn digits(text: &str) -> u32 {
    let mut count = 0;
    for c in text.bytes() {
        match c {
            b'0' if count == 0 => {}
            b'0'..=b'9' => count += 1,
            b'e' | b'E' => break,
            _ => {}
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_counted_from_the_first_that_is_not_zero() {
        for (text, count) in [("0", 0), ("-0.00120", 3), ("1.50e-300", 3), ("12.5", 3), ("0.1234567", 7)] {
            assert_eq!(digits(text), count, "{text}");
        }
    }

    #[test]
    fn names_in_quotes_keep_their_delimiter() {
        let line = "t,\"w, x\" ,wy";
        assert_eq!(Delimiter::of(line).names(line), ["t", "w, x", "wy"]);
        assert_eq!(Delimiter::of("t  w x").names("t  w x"), ["t", "w", "x"]);
    }
}
