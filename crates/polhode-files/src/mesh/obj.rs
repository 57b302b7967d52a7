//! OBJ files: vertices, faces and groups.

use std::io::BufRead;

use nalgebra::Vector3;
use polhode::inertia::{Surface, SurfaceBuilder};

use super::MeshFileError;
use super::text::{Lines, beginning, numbers};

/// The surface in a file of the kind Wavefront OBJ.
///
/// A triangle belongs to the object that `o` named last and to every group that the last `g` names.
///
/// # Errors
/// A file of another kind, or one that ends too early, by its line or byte.
pub fn read(reader: impl BufRead) -> Result<Surface, MeshFileError> {
    let mut mesh = SurfaceBuilder::default();
    let mut vertices: Vec<Vector3<f64>> = Vec::new();
    let mut face = Vec::new();
    let (mut object, mut groups) = (Vec::<String>::new(), Vec::<String>::new());
    let mut lines = Lines::new(reader);
    while let Some((line, text)) = lines.next()? {
        let mut words = text.split_ascii_whitespace();
        let syntax = |expected| MeshFileError::Syntax { line, found: beginning(text), expected };
        match words.next() {
            Some("v") => {
                let at = numbers(words.take(3)).ok_or_else(|| syntax("'v x y z' with three numbers"))?;
                vertices.push(Vector3::from(at));
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
            Some("o") => {
                // one name, which some programs write with blanks
                object = vec![words.collect::<Vec<_>>().join(" ")];
                mesh.begin_groups([object.as_slice(), &groups].concat());
            }
            Some("g") => {
                groups = words.map(String::from).collect();
                mesh.begin_groups([object.as_slice(), &groups].concat());
            }
            _ => {} // normals, texture, materials, comments
        }
    }
    Ok(mesh.finish()?)
}

/// Indices count from 1, negative ones back from the last vertex.
fn corner(vertices: &[Vector3<f64>], index: i64, line: u64) -> Result<Vector3<f64>, MeshFileError> {
    let place = if index < 0 { index + vertices.len() as i64 } else { index - 1 };
    let found = usize::try_from(place).ok().and_then(|place| vertices.get(place));
    found.copied().ok_or(MeshFileError::Index { line, index, vertices: vertices.len() })
}
