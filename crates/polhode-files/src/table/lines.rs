//! Lines of a text, one in memory at a time.

use std::io::{BufRead, BufReader};
use std::path::Path;

use super::array::{ArrayText, MAGIC};
use super::cells::uncommented;
use crate::error::{Rule, TableError};
use crate::inputs;
use crate::text::{foreign, visible};

/// A line is no longer than this many bytes.
const LONGEST_LINE: usize = 1 << 24;

/// A line of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Line {
    /// In its file, from 1.
    pub(crate) number: u64,
    /// Without blanks at its ends; a tab in front is an empty cell.
    pub(crate) text: String,
    /// Whether a mark ends it.
    pub(crate) is_ended: bool,
}

/// A text, line by line. A line feed, a carriage return, or both end a line.
pub(crate) struct Lines<'t> {
    reader: Box<dyn BufRead + 't>,
    /// As messages name it.
    pub(crate) name: String,
    /// The present line, without the mark of byte order.
    pub(crate) text: String,
    /// Its number, from 1.
    pub(crate) number: u64,
    /// Whether a mark ends it; the last line may lack one.
    pub(crate) is_ended: bool,
    bytes: Vec<u8>,
    /// Whether a line feed that comes next belongs to the line before.
    after_return: bool,
}

impl<'t> Lines<'t> {
    /// Goes to the next line that is neither empty nor a comment; `false` behind the last.
    pub(crate) fn advance_to_row(&mut self) -> Result<bool, TableError> {
        while self.advance()? {
            if !self.text.trim().is_empty() && uncommented(self.text.trim()).is_none() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Of the file at `path`, or of standard input where that is `-`.
    pub(crate) fn open(path: &Path) -> Result<Lines<'static>, TableError> {
        let (name, mut reader): (String, Box<dyn BufRead>) = if path.as_os_str() == "-" {
            ("standard input".into(), Box::new(BufReader::with_capacity(1 << 18, inputs::standard())))
        } else {
            let name = visible(&path.display().to_string()).into_owned();
            let file = inputs::open(path)
                .map_err(|reason| TableError::of(&name, Rule::Readable(reason.to_string())))?;
            (name, Box::new(BufReader::with_capacity(1 << 18, file)))
        };
        let unread = |reason: std::io::Error| TableError::of(&name, Rule::Readable(reason.to_string()));
        if reader.fill_buf().map_err(unread)?.starts_with(MAGIC) {
            reader = Box::new(ArrayText::new(reader).map_err(unread)?);
        }
        Ok(Lines::new(reader, name))
    }

    /// Of a text in memory, which messages call `name`.
    pub(crate) fn of_text(text: &'t str, name: &str) -> Self {
        Lines::new(Box::new(text.as_bytes()), name.into())
    }

    fn new(reader: Box<dyn BufRead + 't>, name: String) -> Self {
        let (text, bytes) = (String::new(), Vec::new());
        Self { reader, name, text, number: 0, is_ended: true, bytes, after_return: false }
    }

    /// Reads the next line; `false` behind the last.
    pub(crate) fn advance(&mut self) -> Result<bool, TableError> {
        self.bytes.clear();
        self.is_ended = false;
        while !self.is_ended {
            let unread =
                |reason: std::io::Error| TableError::of(&self.name, Rule::Readable(reason.to_string()));
            let mut buffer = self.reader.fill_buf().map_err(unread)?;
            if buffer.is_empty() {
                if self.bytes.is_empty() {
                    return Ok(false);
                }
                break;
            }
            let mut used = 0;
            if self.after_return && buffer[0] == b'\n' {
                (buffer, used) = (&buffer[1..], 1);
            }
            self.after_return = false;
            let end = buffer.iter().position(|c| matches!(c, b'\n' | b'\r'));
            self.bytes.extend_from_slice(&buffer[..end.unwrap_or(buffer.len())]);
            used += end.map_or(buffer.len(), |end| end + 1);
            if let Some(end) = end {
                self.is_ended = true;
                self.after_return = buffer[end] == b'\r';
            }
            self.reader.consume(used);
            if self.bytes.len() > LONGEST_LINE {
                self.number += 1;
                return Err(self.refused(Rule::Length(LONGEST_LINE)));
            }
        }
        self.number += 1;
        if let Some((says, remedy)) = foreign(&self.bytes).filter(|_| self.number == 1) {
            return Err(self.refused(Rule::Other(says.into())).with_remedy(remedy));
        }
        let start = if self.bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        self.text.clear();
        match std::str::from_utf8(&self.bytes[start..]) {
            Ok(line) => self.text.push_str(line),
            Err(_) => return Err(self.refused(Rule::Utf8)),
        }
        Ok(true)
    }

    /// A rule that the present line breaks.
    pub(crate) fn refused(&self, rule: Rule) -> TableError {
        TableError::of(&self.name, rule).at(self.number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_mark_ends_a_line_and_the_last_may_lack_one() {
        let mut lines = Lines::of_text("\u{feff}a\rb\r\n\r\r\nc", "x");
        let mut found = Vec::new();
        while lines.advance().unwrap() {
            found.push((lines.number, lines.text.clone(), lines.is_ended));
        }
        let expected = [(1, "a", true), (2, "b", true), (3, "", true), (4, "", true), (5, "c", false)];
        assert_eq!(found, expected.map(|(n, text, ended)| (n, text.to_string(), ended)));
    }

    #[test]
    fn a_text_in_another_coding_is_refused_by_name() {
        for (mark, says) in [
            (&b"\xff\xfe"[..], "UTF-16"),
            (&b"\xfe\xff"[..], "UTF-16"),
            (&b"\x1f\x8b"[..], "gzip"),
            (&b"PK\x03\x04"[..], "zip archive"),
            (&b"\xffa"[..], "not UTF-8"),
        ] {
            let bytes: Vec<u8> = mark.iter().chain(b"t\0\n\0").copied().collect();
            let mut lines = Lines::new(Box::new(&bytes[..]), "x".into());
            assert!(lines.advance().unwrap_err().to_string().contains(says), "{mark:?}");
        }
    }
}
