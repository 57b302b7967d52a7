//! Text files, read whole.

use std::fs::File;
use std::io::{self, BufRead, BufReader, ErrorKind, Read};
use std::path::Path;

use crate::error::Error;

/// A line of a text file is no longer than this many bytes; whole models stand in one.
const LONGEST_LINE: usize = 1 << 24;

/// Reads a text file; the message of a failure ends in `remedy`.
pub fn read(path: &Path, remedy: &str) -> Result<String, Error> {
    let refused = |reason: &dyn std::fmt::Display| {
        Error::Input(format!("{}: cannot be read: {reason}; {remedy}", path.display()))
    };
    let lines = || {
        let file = File::open(path)?;
        let mut bytes = Vec::new();
        let size = file.metadata().map_or(0, |found| found.len());
        let _ = bytes.try_reserve_exact(usize::try_from(size).unwrap_or(0));
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
    String::from_utf8(bytes).map_err(|_| refused(&"stream did not contain valid UTF-8"))
}
