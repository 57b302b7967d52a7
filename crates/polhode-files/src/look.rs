//! What the parts of a body look like.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::inertia::{Solid, Surface};

/// A part of a body: turned, then moved.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the type says what they are")]
pub struct Piece {
    pub look: Look,
    pub turn: UnitQuaternion<f64>,
    /// m.
    pub at: Vector3<f64>,
}

/// What a part looks like.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Look {
    /// A solid in its own axes.
    Solid(Solid),
    /// Triangles, m.
    Surface(Surface),
    /// A mass, kg, and a tensor about its centre, kg m²: no more is known.
    Tensor(f64, Matrix3<f64>),
    /// A point.
    Point,
}
