//! Why a mesh bounds no body.

use nalgebra::Vector3;
use thiserror::Error;

use super::{hull, welded};
use crate::num::Shown;

/// Why a mesh bounds no body. Triangles are counted from 1.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MeshError {
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
