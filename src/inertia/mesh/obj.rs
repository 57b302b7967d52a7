//! OBJ files: vertices and faces.

use std::io::{BufRead, Read};

use super::MeshError;
use super::closed::Welded;
use super::stl::beginning;
use crate::rotation::Vec3;

/// A line is no longer than this many bytes, or a file without line ends would fill the memory.
pub(super) const LONGEST_LINE: u64 = 1 << 20;

pub(super) fn read(reader: impl BufRead) -> Result<Welded, MeshError> {
    let mut mesh = Welded::default();
    let mut vertices: Vec<Vec3<f64>> = Vec::new();
    let mut face = Vec::new();
    let mut lines = Lines::new(reader);
    while let Some((line, text)) = lines.next()? {
        let mut words = text.split_ascii_whitespace();
        let syntax = |expected| MeshError::Syntax { line, found: beginning(text), expected };
        match words.next() {
            Some("v") => {
                let at = numbers(words.take(3)).ok_or_else(|| syntax("'v x y z' with three numbers"))?;
                vertices.push(Vec3(at));
            }
            Some("f") => {
                face.clear();
                for word in words {
                    let index = word.split('/').next().and_then(|index| index.parse::<i64>().ok());
                    let index = index.ok_or_else(|| syntax("'f' with the numbers of vertices"))?;
                    face.push(corner(&vertices, index, line)?);
                }
                let [first, second, rest @ ..] = face.as_slice() else {
                    return Err(syntax("a face of at least three vertices"));
                };
                if rest.is_empty() {
                    return Err(syntax("a face of at least three vertices"));
                }
                let mut before = *second;
                for &next in rest {
                    mesh.add([*first, before, next])?;
                    before = next;
                }
            }
            _ => {} // normals, texture, groups, materials, comments
        }
    }
    Ok(mesh)
}

/// Indices count from 1, negative ones back from the last vertex.
fn corner(vertices: &[Vec3<f64>], index: i64, line: u64) -> Result<Vec3<f64>, MeshError> {
    let place = if index < 0 { index + vertices.len() as i64 } else { index - 1 };
    let found = usize::try_from(place).ok().and_then(|place| vertices.get(place));
    found.copied().ok_or(MeshError::Index { line, index, vertices: vertices.len() })
}

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

    /// The next line and its number, from 1.
    pub(super) fn next(&mut self) -> Result<Option<(u64, &str)>, MeshError> {
        self.buffer.clear();
        let read = self.reader.by_ref().take(LONGEST_LINE + 1).read_until(b'\n', &mut self.buffer)? as u64;
        if read == 0 {
            return Ok(None);
        }
        self.bytes += read;
        self.line += 1;
        if read > LONGEST_LINE {
            return Err(MeshError::LongLine { line: self.line });
        }
        self.text.clear();
        self.text.push_str(&String::from_utf8_lossy(&self.buffer));
        Ok(Some((self.line, &self.text)))
    }
}
