//! Text files, read whole.

use std::fs::File;
use std::io::{self, BufRead, BufReader, ErrorKind, Read};
use std::path::Path;

use crate::error::Error;
use crate::inputs;
use crate::text::foreign;

/// A line of a text file is no longer than this many bytes; whole models stand in one.
const LONGEST_LINE: usize = 1 << 24;

/// Reads a text file, which no output of this process replaces then; the message of a failure ends in `remedy`.
pub fn read(path: &Path, remedy: &str) -> Result<String, Error> {
    text(path, inputs::open, remedy)
}

/// The same for a file of the program's own, which it writes again: a record of results, a page with generated blocks.
pub fn read_own(path: &Path, remedy: &str) -> Result<String, Error> {
    text(path, inputs::open_own, remedy)
}

fn text(path: &Path, open: fn(&Path) -> io::Result<File>, remedy: &str) -> Result<String, Error> {
    let refused = |reason: &dyn std::fmt::Display| {
        Error::Input(format!("{}: cannot be read: {reason}; {remedy}", path.display()))
    };
    let lines = || {
        let file = open(path)?;
        let mut bytes = Vec::new();
        let size = file.metadata().map_or(0, |found| found.len());
        bytes.try_reserve_exact(usize::try_from(size).unwrap_or(usize::MAX)).map_err(|_| {
            io::Error::new(ErrorKind::OutOfMemory, format!("{size} bytes do not fit into memory"))
        })?;
        let mut reader = BufReader::new(file);
        let mut count = 0_u64;
        loop {
            count += 1;
            match reader.by_ref().take(LONGEST_LINE as u64 + 1).read_until(b'\n', &mut bytes)? {
                0 => return Ok(bytes),
                length if length > LONGEST_LINE => {
                    let long = format!("line {count} is longer than {LONGEST_LINE} bytes");
                    return Err(io::Error::new(ErrorKind::InvalidData, long));
                }
                _ => {}
            }
        }
    };
    let bytes = lines().map_err(|reason: io::Error| refused(&reason))?;
    String::from_utf8(bytes).map_err(|error| match foreign(error.as_bytes()) {
        Some((says, how)) => Error::Input(format!("{}: {says}; {how}", path.display())),
        None => refused(&"stream did not contain valid UTF-8"),
    })
}
