//! The shape of a body as a page draws it: triangles in body axes, with a tint each.

use std::collections::HashMap;

use nalgebra::{UnitQuaternion, Vector3};
use polhode::inertia::Surface;
use serde::Serialize;

use super::packed;

/// Which of the page's colours a triangle has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tint {
    /// Of the body.
    Plain = 0,
    /// Of what shows how the body is turned: a face, every second sector.
    Mark = 1,
    /// Of parts that are only there to hold others.
    Quiet = 2,
}

/// Triangles in body axes, m.
#[derive(Clone, Debug, Default, PartialEq)]
#[must_use]
pub struct Shape {
    pub(super) vertices: Vec<Vector3<f64>>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) tints: Vec<u8>,
}

/// A page draws no more triangles than this.
pub const MOST_TRIANGLES: usize = 20_000;

impl Shape {
    /// Of the triangles of a surface.
    pub fn of_surface(surface: &Surface) -> Self {
        let mut shape = Self::default();
        let mut known: HashMap<[u64; 3], u32> = HashMap::new();
        for corners in surface.triangles() {
            let triangle = corners.map(|corner| {
                let bits = [corner.x, corner.y, corner.z].map(|x| (x + 0.0).to_bits());
                *known.entry(bits).or_insert_with(|| shape.vertex(corner))
            });
            shape.triangle(triangle, Tint::Plain);
        }
        shape
    }

    pub(super) fn vertex(&mut self, at: Vector3<f64>) -> u32 {
        self.vertices.push(at);
        (self.vertices.len() - 1) as u32
    }

    pub(super) fn triangle(&mut self, corners: [u32; 3], tint: Tint) {
        self.triangles.push(corners);
        self.tints.push(tint as u8);
    }

    /// Turned about the origin.
    pub fn turned(self, by: UnitQuaternion<f64>) -> Self {
        self.mapped(|at| by * at)
    }

    /// Moved, m.
    pub fn moved(self, by: Vector3<f64>) -> Self {
        self.mapped(|at| at + by)
    }

    /// Every vertex where `map` takes it.
    pub fn mapped(mut self, map: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Self {
        self.vertices.iter_mut().for_each(|at| *at = map(*at));
        self
    }

    /// In one tint.
    pub fn tinted(mut self, tint: Tint) -> Self {
        self.tints.iter_mut().for_each(|found| *found = tint as u8);
        self
    }

    /// Together with another.
    pub fn with(mut self, other: Self) -> Self {
        let first = self.vertices.len() as u32;
        self.vertices.extend(other.vertices);
        self.triangles.extend(other.triangles.into_iter().map(|corners| corners.map(|k| k + first)));
        self.tints.extend(other.tints);
        self
    }

    /// Number of triangles.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.triangles.len()
    }

    /// The largest distance of a vertex from the origin, m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.vertices.iter().map(Vector3::norm).fold(0.0, f64::max)
    }

    /// As the page reads it, with a radius of 1.
    pub(super) fn written(&self) -> Written {
        // squares of lengths may leave the range of a double
        let size = self.vertices.iter().map(Vector3::amax).fold(0.0, f64::max);
        let scaled = |at: &Vector3<f64>| if size > 0.0 { at / size } else { *at };
        let radius = self.vertices.iter().map(|at| scaled(at).norm()).fold(0.0, f64::max);
        let scale = if radius > 0.0 { radius } else { 1.0 };
        Written {
            vertices: packed::shares(
                self.vertices.iter().flat_map(|at| <[f64; 3]>::from(scaled(at) / scale)),
            ),
            triangles: packed::indices(self.triangles.iter().flatten().copied()),
            tints: packed::bytes(&self.tints),
        }
    }
}

#[derive(Serialize)]
pub(super) struct Written {
    vertices: String,
    triangles: String,
    tints: String,
}
