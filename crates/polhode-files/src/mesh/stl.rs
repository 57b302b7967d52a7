//! STL files, binary and ASCII.

use std::io::{self, BufRead, BufReader, Cursor, Read};

use nalgebra::Vector3;
use polhode::inertia::{Surface, SurfaceBuilder};

use super::MeshFileError;
use super::text::{Lines, beginning, numbers};

/// Bytes before the first triangle of a binary file.
const HEADER: usize = 84;
/// Bytes of a triangle: normal, three corners, attribute.
const TRIANGLE: usize = 50;

/// The surface in a file of the kind STL, text or binary.
///
/// # Errors
/// A file of another kind, or one that ends too early, by its line or byte.
pub fn read(mut reader: impl Read) -> Result<Surface, MeshFileError> {
    let mut head = [0; HEADER];
    let length = fill(&mut reader, &mut head)?;
    let head = &head[..length];
    // some binary files begin with 'solid' too, but no text holds a zero byte, and every count below 2²⁴ does
    if head.trim_ascii_start().to_ascii_lowercase().starts_with(b"solid") && !head.contains(&0) {
        return ascii(BufReader::new(Cursor::new(head).chain(reader)));
    }
    match head {
        [.., a, b, c, d] if length == HEADER => binary(reader, u32::from_le_bytes([*a, *b, *c, *d])),
        _ => Err(MeshFileError::Header { length: length as u64 }),
    }
}

fn binary(mut reader: impl Read, count: u32) -> Result<Surface, MeshFileError> {
    let announced = HEADER as u64 + u64::from(count) * TRIANGLE as u64;
    let mut mesh = SurfaceBuilder::default();
    let mut buffer = vec![0; 1024 * TRIANGLE];
    let mut done = 0_u64;
    while done < u64::from(count) {
        let wanted = (u64::from(count) - done).min(1024) as usize * TRIANGLE;
        let found = fill(&mut reader, &mut buffer[..wanted])?;
        let (triangles, rest) = buffer[..found].as_chunks::<TRIANGLE>();
        for bytes in triangles {
            mesh.add(corners(bytes))?;
        }
        done += triangles.len() as u64;
        if found < wanted {
            let length = HEADER as u64 + done * TRIANGLE as u64 + rest.len() as u64;
            return Err(MeshFileError::Truncated { triangles: count, announced, length, triangle: done + 1 });
        }
    }
    if fill(&mut reader, &mut [0])? > 0 {
        return Err(MeshFileError::Surplus { triangles: count, announced });
    }
    Ok(mesh.finish()?)
}

/// The three corners behind the normal.
fn corners(bytes: &[u8; TRIANGLE]) -> [Vector3<f64>; 3] {
    let (floats, _) = bytes.as_chunks::<4>();
    [3, 6, 9]
        .map(|corner| Vector3::from([0, 1, 2].map(|k| f64::from(f32::from_le_bytes(floats[corner + k])))))
}

fn ascii(reader: impl BufRead) -> Result<Surface, MeshFileError> {
    let mut mesh = SurfaceBuilder::default();
    let mut lines = Lines::new(reader);
    let (mut corners, mut facets, mut closed) = (Vec::new(), 0_u64, false);
    while let Some((line, text)) = lines.next()? {
        let mut words = text.split_ascii_whitespace();
        let syntax = |expected| MeshFileError::Syntax { line, found: beginning(text), expected };
        match words.next().map(str::to_ascii_lowercase).as_deref() {
            Some("facet" | "outer" | "vertex" | "endloop" | "endfacet") if closed => {
                return Err(syntax("'solid' or the end of the file"));
            }
            Some("vertex") => {
                let at = numbers(words).ok_or_else(|| syntax("'vertex x y z' with three numbers"))?;
                corners.push(Vector3::from(at));
            }
            Some("endfacet") => {
                let three = <[_; 3]>::try_from(std::mem::take(&mut corners));
                mesh.add(three.map_err(|_| syntax("the third vertex of a facet, and no fourth,"))?)?;
                facets += 1;
            }
            Some("solid" | "endsolid") if !corners.is_empty() => return Err(syntax("'endfacet'")),
            Some("endsolid") => closed = true,
            Some("solid") => {
                closed = false;
                // all that follows is the name, which programs write with blanks
                mesh.begin_group(&words.collect::<Vec<_>>().join(" "));
            }
            Some("facet" | "outer" | "endloop") | None => {}
            Some(_) => return Err(syntax("a line of an ASCII STL")),
        }
    }
    if closed {
        Ok(mesh.finish()?)
    } else {
        Err(MeshFileError::TruncatedText { length: lines.bytes, line: lines.line, triangle: facets + 1 })
    }
}

/// Reads until the buffer is full or the input ends.
fn fill(reader: &mut impl Read, buffer: &mut [u8]) -> io::Result<usize> {
    let mut length = 0;
    while length < buffer.len() {
        match reader.read(&mut buffer[length..]) {
            Ok(0) => break,
            Ok(read) => length += read,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(length)
}
