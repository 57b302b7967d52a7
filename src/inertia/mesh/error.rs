//! Why a mesh bounds no body.

use std::io;

use nalgebra::Vector3;
use thiserror::Error;

use super::{hull, ply, text, welded};
use crate::num::Shown;

/// Why a mesh bounds no body. Triangles, lines and bytes are counted from 1, the byte of an end of file is its size.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MeshError {
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
    #[error("line {line}: face names vertex {index}, but {vertices} vertices stand above it")]
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
    /// A face of a PLY names a vertex that is not there.
    #[error("face {face} names vertex {index}, counted from 0, but there are {vertices}")]
    Corner {
        /// Number of the face, from 1.
        face: u64,
        /// The offending index.
        index: i64,
        /// Vertices of the file.
        vertices: usize,
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
    /// A coordinate is not a finite number.
    #[error("triangle {triangle} has the coordinate {value}; every coordinate must be a finite number")]
    NotFinite {
        /// Number of the triangle.
        triangle: u64,
        /// The offending value.
        value: f64,
    },
    /// There is no triangle.
    #[error("the mesh has no triangle with three distinct corners")]
    Empty,
    /// More vertices than can be numbered.
    #[error("the mesh has more than {} vertices", welded::LIMIT)]
    TooLarge,
    /// An edge bounds one triangle only.
    #[error("the mesh is open; edges with one triangle only: {edges}, the first is {edge}")]
    Open {
        /// How many.
        edges: usize,
        /// The first.
        edge: Edge,
    },
    /// More than two triangles meet in an edge, and not as many run through it one way as the other.
    #[error(
        "the mesh is not manifold; edges with more than two triangles that do not cancel: {edges}, the first is {edge}, with {uses}"
    )]
    NonManifold {
        /// How many.
        edges: usize,
        /// The first.
        edge: Edge,
        /// Number of triangles that meet there.
        uses: usize,
    },
    /// Two neighbours turn in opposite senses.
    #[error(
        "the triangles are not consistently oriented; edges run through twice in one direction: {edges}, \
         the first is {edge}; one of its two triangles is turned over"
    )]
    Orientation {
        /// How many.
        edges: usize,
        /// The first.
        edge: Edge,
    },
    /// All triangles of a part face inwards.
    #[error(
        "the mesh is inside out: the part with {edge} encloses the volume {}; \
         list the corners of its triangles counterclockwise as seen from outside",
        Shown(*volume)
    )]
    InsideOut {
        /// The first edge of the part.
        edge: Edge,
        /// Signed volume of the part.
        volume: f64,
    },
    /// Its size or place leaves the range of a double.
    #[error(
        "the mesh measures {} and reaches out to {}: its second moments are outside the range of a double; change the unit \
         of length",
        Shown(*extent),
        Shown(*reach)
    )]
    OutOfRange {
        /// The longest edge of its bounding box, at most the largest double.
        extent: f64,
        /// The largest coordinate, without sign.
        reach: f64,
    },
    /// The mesh is closed and flat, or its cavities leave nothing.
    #[error("the mesh encloses no volume")]
    Flat,
    /// A factor or distance is not positive.
    #[error("{quantity} is {}; it must be a finite number above zero", Shown(*value))]
    NotPositive {
        /// What was given.
        quantity: &'static str,
        /// The offending value.
        value: f64,
    },
    /// More points than the convex hull is computed of.
    #[error("the mesh has more than {} vertices, too many for a convex hull", hull::LIMIT)]
    TooLargeForHull,
}

/// An edge of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Edge {
    /// One end.
    pub from: Vector3<f64>,
    /// The other end.
    pub to: Vector3<f64>,
    /// The first triangle that it bounds, from 1.
    pub triangle: u64,
}

impl core::fmt::Display for Edge {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let (a, b) = (self.from, self.to);
        write!(
            f,
            "edge ({}, {}, {})-({}, {}, {}) of triangle {}",
            Shown(a.x),
            Shown(a.y),
            Shown(a.z),
            Shown(b.x),
            Shown(b.y),
            Shown(b.z),
            self.triangle
        )
    }
}
