//! Why a file is no mesh.

use std::io;

use polhode::inertia::MeshError;
use thiserror::Error;

use super::{ply, text};

/// Why a file is no mesh. Lines and triangles are counted from 1, the byte of an end of file is its size.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MeshFileError {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] io::Error),
    /// The file is too short to be an STL.
    #[error("STL ends at byte {length}, within its header of 84 bytes, and does not begin with 'solid'")]
    Header {
        /// Size of the file.
        length: u64,
    },
    /// A binary STL ends early.
    #[error(
        "STL is truncated: its header announces {triangles} triangles, {announced} bytes, but it ends at byte {length}, \
         in triangle {triangle}"
    )]
    Truncated {
        /// The number in the header.
        triangles: u32,
        /// The size that goes with it.
        announced: u64,
        /// Size of the file.
        length: u64,
        /// The triangle that is not complete.
        triangle: u64,
    },
    /// A binary STL goes on after the last triangle.
    #[error(
        "STL announces {triangles} triangles, which end at byte {announced}, but more bytes follow; its count is wrong"
    )]
    Surplus {
        /// The number in the header.
        triangles: u32,
        /// The size that goes with it.
        announced: u64,
    },
    /// An ASCII STL ends early.
    #[error(
        "STL is truncated: it ends at byte {length}, line {line}, in triangle {triangle}, without 'endsolid'"
    )]
    TruncatedText {
        /// Size of the file.
        length: u64,
        /// Number of its lines.
        line: u64,
        /// The triangle that is not complete.
        triangle: u64,
    },
    /// A line of text that does not belong there.
    #[error("line {line}: '{found}' where {expected} is expected")]
    Syntax {
        /// Number of the line.
        line: u64,
        /// Its beginning.
        found: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// A line of text that does not end.
    #[error("line {line} is longer than {} bytes; is this the right file?", text::LONGEST_LINE)]
    LongLine {
        /// Number of the line.
        line: u64,
    },
    /// A face names a vertex that is not there.
    #[error("line {line}: face names vertex {index}, but only {vertices} vertices are above it")]
    Index {
        /// Number of the line.
        line: u64,
        /// The offending index.
        index: i64,
        /// Vertices so far.
        vertices: usize,
    },
    /// A binary PLY ends early.
    #[error("PLY is truncated: it ends in {element} {number} of {announced}")]
    TruncatedElements {
        /// Name of the element.
        element: String,
        /// The one that is not complete, from 1.
        number: u64,
        /// How many the header announces.
        announced: u64,
    },
    /// A PLY goes on after the last element.
    #[error(
        "PLY announces {announced} of element {element} as its last, but more follows; a count is wrong, or another file follows"
    )]
    SurplusElements {
        /// Name of the element.
        element: String,
        /// How many the header announces.
        announced: u64,
    },
    /// An element of a PLY has no properties, and its count can be any.
    #[error(
        "PLY announces {announced} of element {element}, which has no properties; is its header complete?"
    )]
    NoProperties {
        /// Name of the element.
        element: String,
        /// How many the header announces.
        announced: u64,
    },
    /// The elements of a PLY are more than its bytes can hold.
    #[error(
        "PLY announces {announced} of element {element}, which with those before it take {needed} bytes or more, and {left} follow the header"
    )]
    TooManyElements {
        /// Name of the element.
        element: String,
        /// How many the header announces.
        announced: u64,
        /// The least number of bytes.
        needed: u64,
        /// Bytes behind the header.
        left: u64,
    },
    /// A face of a PLY names a vertex that is not there.
    #[error("face {face} names vertex {index}, counted from 0, but there are {vertices}")]
    Corner {
        /// Number of the face, from 1.
        face: u64,
        /// The offending index.
        index: f64,
        /// Vertices of the file.
        vertices: usize,
    },
    /// The length of a list of a PLY is none.
    #[error("{element} {number} has a list of {length} numbers; a length is a whole number, zero or above")]
    ListLength {
        /// Name of the element.
        element: String,
        /// Its number, from 1.
        number: u64,
        /// What stands for the length.
        length: f64,
    },
    /// A list of a PLY is absurdly long.
    #[error(
        "{element} {number} has a list of {length} numbers, and at most {} are read; is this the right file?",
        ply::LONGEST_LIST
    )]
    LongList {
        /// Name of the element.
        element: String,
        /// Its number, from 1.
        number: u64,
        /// Length of the list.
        length: u64,
    },
    /// Its triangles are no surface.
    #[error(transparent)]
    Triangles(#[from] MeshError),
}
