//! Lines and numbers of text files.

use std::io::{BufRead, Read};

use super::MeshFileError;

/// A line is no longer than this many bytes, or a file without line ends would fill the memory.
pub(super) const LONGEST_LINE: u64 = 1 << 20;

/// Exactly three numbers.
pub(super) fn numbers<'a>(words: impl Iterator<Item = &'a str>) -> Option<[f64; 3]> {
    let mut at = [0.0; 3];
    let mut count = 0;
    for word in words {
        *at.get_mut(count)? = word.parse().ok()?;
        count += 1;
    }
    (count == 3).then_some(at)
}

/// The lines of a text in any encoding that keeps ASCII.
pub(super) struct Lines<R> {
    reader: R,
    buffer: Vec<u8>,
    text: String,
    /// Lines so far.
    pub(super) line: u64,
    /// Bytes so far.
    pub(super) bytes: u64,
}

impl<R: BufRead> Lines<R> {
    pub(super) fn new(reader: R) -> Self {
        Lines { reader, buffer: Vec::new(), text: String::new(), line: 0, bytes: 0 }
    }

    /// What follows the lines that were read.
    pub(super) fn reader(&mut self) -> &mut R {
        &mut self.reader
    }

    /// The next line and its number, from 1.
    pub(super) fn next(&mut self) -> Result<Option<(u64, &str)>, MeshFileError> {
        self.buffer.clear();
        let read = self.reader.by_ref().take(LONGEST_LINE + 1).read_until(b'\n', &mut self.buffer)? as u64;
        if read == 0 {
            return Ok(None);
        }
        self.bytes += read;
        self.line += 1;
        if read > LONGEST_LINE {
            return Err(MeshFileError::LongLine { line: self.line });
        }
        self.text.clear();
        // a mark of the byte order would hide the first word, such as the first vertex of an OBJ
        self.text.push_str(String::from_utf8_lossy(&self.buffer).trim_start_matches('\u{feff}'));
        Ok(Some((self.line, &self.text)))
    }
}

/// The first words of a line, for a message.
pub(super) fn beginning(text: &str) -> String {
    let text = text.trim();
    match text.char_indices().nth(40) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.into(),
    }
}
