//! Triangles as files hold them: open or closed, in any unit.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Matrix3, Vector3};

use super::boxes::Bounds;
use super::closed::{directed, join, root};
use super::welded::Welded;
use super::{Closing, Mesh, MeshError, Repair, hull, mend};
use crate::inertia::symmetric::from_second_moments;
use crate::inertia::{Amount, MassError, MassProperties};
use crate::num::Compensated;

/// The rim of a hole, or of a sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Boundary {
    /// Number of its edges.
    pub edges: usize,
    /// Its length, in the unit of the vertices.
    pub length: f64,
    /// Its middle.
    pub center: Vector3<f64>,
}

/// Triangles, corners counterclockwise as seen from outside, which need not close.
///
/// A [`Mesh`] is what a closed surface encloses. Files are read as they are; a unit of length and repairs are asked for.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::inertia::{Amount, Closing, FLOAT_WELD, Repair, Surface};
///
/// let [o, x, y, z] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector3::from);
/// let open = Surface::new([[o, y, x], [o, x, z], [o, z, y]])?; // the slanted face is missing
/// assert_eq!(open.boundaries().len(), 1);
/// assert!(open.mended(FLOAT_WELD).is_err());
///
/// let (mesh, repairs) = open.closed(FLOAT_WELD, Closing::Fan)?;
/// assert!((mesh.volume() - 1.0 / 6.0).abs() < 1e-15);
/// assert!(matches!(repairs[..], [Repair::Closed { holes: 1, .. }]));
///
/// let millimetres = open.scaled(1e-3)?; // now in metres
/// assert_eq!(millimetres.extents(), [1e-3; 3]);
/// # Ok::<(), polhode::inertia::MeshError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Surface {
    pub(super) welded: Welded,
}

/// Collects the triangles of a file, and the groups that it names.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::inertia::SurfaceBuilder;
/// let mut builder = SurfaceBuilder::default();
/// builder.begin_group("lid");
/// builder.add([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Vector3::from))?;
/// assert_eq!(builder.finish()?.groups().collect::<Vec<_>>(), ["lid"]);
/// # Ok::<(), polhode::inertia::MeshError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct SurfaceBuilder {
    welded: Welded,
}

impl SurfaceBuilder {
    /// Adds a triangle, corners counterclockwise as seen from outside; one whose corners coincide is left out.
    ///
    /// # Errors
    /// Coordinates that are not finite.
    pub fn add(&mut self, corners: [Vector3<f64>; 3]) -> Result<(), MeshError> {
        self.welded.add(corners.map(Into::into))
    }

    /// What is added from here on belongs to the group `name`.
    pub fn begin_group(&mut self, name: &str) {
        self.begin_groups(vec![name.into()]);
    }

    /// What is added from here on belongs to each of the groups called `names`, and to no other.
    pub fn begin_groups(&mut self, names: Vec<String>) {
        self.welded.begin_groups(names);
    }

    /// The surface.
    ///
    /// # Errors
    /// No triangle with three distinct corners.
    pub fn finish(self) -> Result<Surface, MeshError> {
        Surface::of(self.welded)
    }
}

impl Surface {
    /// From triangles.
    ///
    /// # Errors
    /// Coordinates that are not finite; no triangle with three distinct corners.
    pub fn new(triangles: impl IntoIterator<Item = [Vector3<f64>; 3]>) -> Result<Self, MeshError> {
        let mut builder = SurfaceBuilder::default();
        for corners in triangles {
            builder.add(corners)?;
        }
        builder.finish()
    }

    /// The convex hull of points.
    ///
    /// # Errors
    /// Coordinates that are not finite; points that extend over less than 1e-57 or more than 1e57; points in one plane.
    pub fn hull_of(points: &[Vector3<f64>]) -> Result<Self, MeshError> {
        if let Some(&value) = points.iter().flat_map(Vector3::iter).find(|value| !value.is_finite()) {
            return Err(MeshError::NotFinite { triangle: 1, value });
        }
        let points: Vec<[f64; 3]> = points.iter().map(|&at| at.into()).collect();
        let facets = hull::hull(&points)?;
        Self::new(facets.into_iter().map(|facet| facet.map(|k| points[k as usize].into())))
    }

    pub(super) fn of(welded: Welded) -> Result<Self, MeshError> {
        if welded.triangles.is_empty() { Err(MeshError::Empty) } else { Ok(Surface { welded }) }
    }

    /// The triangles.
    pub fn triangles(&self) -> impl Iterator<Item = [Vector3<f64>; 3]> + '_ {
        self.welded.triangles.iter().map(|triangle| self.welded.corners(*triangle).map(Into::into))
    }

    /// Facets of the input whose corners coincide; they are left out.
    #[must_use]
    pub fn degenerate(&self) -> usize {
        self.welded.skipped.len()
    }

    /// Edges of the box around it along the axes.
    #[must_use]
    pub fn extents(&self) -> [f64; 3] {
        let bounds = Bounds::around(&self.welded.vertices);
        [0, 1, 2].map(|k| bounds.edge(k))
    }

    /// Names of groups, each once: `g` and `o` of an OBJ file, `solid` of an ASCII STL.
    pub fn groups(&self) -> impl Iterator<Item = &str> {
        let mut seen = BTreeSet::new();
        let names = self.welded.groups.iter().flat_map(|(names, _)| names).map(String::as_str);
        names.filter(move |name| seen.insert(*name))
    }

    /// The triangles of the groups called `name`, if there are any.
    #[must_use]
    pub fn group(&self, name: &str) -> Option<Self> {
        let groups = &self.welded.groups;
        let ends = groups.iter().skip(1).map(|(_, start)| *start).chain([self.welded.triangles.len()]);
        let chosen =
            groups.iter().zip(ends).filter(|((names, _), _)| names.iter().any(|found| found == name));
        let triangles = chosen.flat_map(|((_, start), end)| &self.welded.triangles[*start..end]);
        Self::new(triangles.map(|triangle| self.welded.corners(*triangle).map(Into::into))).ok()
    }

    /// Every vertex where `map` takes it.
    ///
    /// # Errors
    /// Coordinates that are not finite.
    pub fn mapped(&self, map: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Result<Self, MeshError> {
        Self::new(self.triangles().map(|corners| corners.map(&map)))
    }

    /// With vertices multiplied by `unit`, the metres of the unit that the file is in.
    ///
    /// # Errors
    /// A unit that is not a positive finite number; coordinates that leave the range of a double.
    pub fn scaled(&self, unit: f64) -> Result<Self, MeshError> {
        let unit = positive("unit of length", unit)?;
        // a thousandth is no double, a thousand is one
        let inverse = 1.0 / unit;
        if inverse.fract() == 0.0 { self.mapped(|at| at / inverse) } else { self.mapped(|at| at * unit) }
    }

    /// Seen from the other side.
    pub fn reversed(mut self) -> Self {
        self.welded.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        self
    }

    /// The convex hull of its vertices.
    ///
    /// # Errors
    /// Vertices that extend over less than 1e-57 or more than 1e57; vertices in one plane.
    pub fn hull(&self) -> Result<Self, MeshError> {
        let facets = hull::hull(&self.welded.vertices)?;
        Self::new(facets.into_iter().map(|facet| self.welded.corners(facet).map(Into::into)))
    }

    /// What it encloses, as it is.
    ///
    /// # Errors
    /// As [`Mesh::new`].
    pub fn mesh(&self) -> Result<Mesh, MeshError> {
        Mesh::of_welded(&self.welded)
    }

    /// What it encloses once the traces of export are removed, and what was changed, nothing if it is closed as it is.
    ///
    /// Vertices closer than `weld` times the largest edge of the bounding box are made one; facets given twice are removed;
    /// triangles are turned the way of their neighbours, and parts outwards.
    ///
    /// # Errors
    /// As [`Mesh::new`], of what remains; a `weld` that is not positive.
    pub fn mended(&self, weld: f64) -> Result<(Mesh, Vec<Repair>), MeshError> {
        mend::mended(self, positive("distance of welding", weld)?)
    }

    /// What it encloses once its holes are closed, and what was changed.
    ///
    /// # Errors
    /// As [`Mesh::new`], of what remains; a `weld` that is not positive.
    pub fn closed(&self, weld: f64, how: Closing) -> Result<(Mesh, Vec<Repair>), MeshError> {
        mend::closed(self, positive("distance of welding", weld)?, how)
    }

    /// The rims where it is open, the longest first: edges through which not as many triangles run one way as the other.
    #[must_use]
    pub fn boundaries(&self) -> Vec<Boundary> {
        let rim = self.welded.rim();
        let mut found: Vec<Boundary> = rim
            .iter()
            .map(|edges| {
                let (center, length) = self.welded.middle_of(edges);
                Boundary { edges: edges.len(), length, center: center.into() }
            })
            .collect();
        found.sort_by(|a, b| b.length.total_cmp(&a.length));
        found
    }

    /// Mass properties of the surface itself: a mass spread over it, or a density in kg/m², for walls much thinner than the body.
    ///
    /// # Errors
    /// A mass or density that is not positive; no area; moments outside the range of a double.
    pub fn sheet(&self, amount: Amount) -> Result<MassProperties, MassError> {
        let origin: Vector3<f64> = self.welded.middle().into();
        let mut sums = [Compensated::new(0.0); 10];
        for corners in self.triangles() {
            let [a, b, c] = corners.map(|at| at - origin);
            let area = 0.5 * (b - a).cross(&(c - a)).norm();
            let s = a + b + c;
            // ∫ x xᵀ dA = A (a aᵀ + b bᵀ + c cᵀ + s sᵀ)/12
            let second =
                |j: usize, k: usize| area * (a[j] * a[k] + b[j] * b[k] + c[j] * c[k] + s[j] * s[k]) / 12.0;
            let first = s * (area / 3.0);
            let terms = [
                area,
                first.x,
                first.y,
                first.z,
                second(0, 0),
                second(1, 1),
                second(2, 2),
                second(0, 1),
                second(0, 2),
                second(1, 2),
            ];
            sums.iter_mut().zip(terms).for_each(|(sum, term)| sum.add(term));
        }
        let [area, x, y, z, second @ ..] = sums.map(|sum| sum.value());
        let mass = amount.mass(area)?;
        let per_area = mass / area;
        let center = Vector3::new(x, y, z) / area;
        let tensor: Matrix3<f64> = from_second_moments(second) * per_area;
        MassProperties::from_tensor_about(Vector3::zeros(), mass, center, tensor)?.moved(origin)
    }
}

pub(super) fn positive(quantity: &'static str, value: f64) -> Result<f64, MeshError> {
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(MeshError::NotPositive { quantity, value }) }
}

/// A directed edge, as often as it is missing its opposite.
pub(super) type Rim = Vec<(u32, u32)>;

impl Welded {
    /// The edges without an opposite, connected ones together.
    pub(super) fn rim(&self) -> Vec<Rim> {
        let mut net: BTreeMap<(u32, u32), i64> = BTreeMap::new();
        for &triangle in &self.triangles {
            for (from, to) in directed(triangle) {
                *net.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
            }
        }
        net.retain(|_, count| *count != 0);
        let mut roots: Vec<u32> = (0..self.vertices.len() as u32).collect();
        for &(a, b) in net.keys() {
            join(&mut roots, a, b);
        }
        let mut parts: BTreeMap<u32, Rim> = BTreeMap::new();
        for ((low, high), count) in net {
            let edge = if count > 0 { (low, high) } else { (high, low) };
            let part = parts.entry(root(&mut roots, low)).or_default();
            part.extend(core::iter::repeat_n(edge, count.unsigned_abs() as usize));
        }
        parts.into_values().collect()
    }

    /// The middle of a line of edges and its length.
    pub(super) fn middle_of(&self, edges: &Rim) -> ([f64; 3], f64) {
        let at = |k: u32| Vector3::from(self.vertices[k as usize]);
        let (mut middle, mut length) = (Vector3::zeros(), 0.0);
        for &(from, to) in edges {
            let size = (at(to) - at(from)).norm();
            middle += (at(from) + at(to)) * (0.5 * size);
            length += size;
        }
        ((middle / length).into(), length)
    }
}
