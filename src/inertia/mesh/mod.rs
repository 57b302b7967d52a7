//! Bodies bounded by triangles: mass, centre of mass and inertia of what a closed mesh encloses.

mod boxes;
mod closed;
mod doubled;
mod error;
mod hull;
mod mend;
mod surface;
mod welded;

use nalgebra::{Matrix3, Vector3};

use super::symmetric::{Tensor, from_second_moments};
use super::{Amount, MassError, MassProperties};
use crate::num::{Compensated, Dd};
use crate::rotation::Vec3;
pub use error::{Edge, MeshError};
pub use mend::{Closing, FLOAT_WELD, Repair};
pub use surface::{Boundary, Surface, SurfaceBuilder};
use welded::Welded;

/// What a closed, oriented triangle mesh encloses.
///
/// Vertices are the same where their bits are; [`Surface`] welds those that are nearly the same, and mends and closes. Through
/// every edge as many triangles run one way as the other, so that the surface is a cycle and the volume integral exact. Cavities are parts that face inwards and lie within another part;
/// parts that overlap count twice, of which [`doubled`](Mesh::doubled) tells. Volume, centre and tensor come from one pass over the triangles, as sums over
/// the signed tetrahedra that each spans with the middle of the bounding box (so that a mesh far from the origin
/// loses no digits), compensated.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::inertia::{Amount, Mesh};
///
/// let [o, x, y, z] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector3::from);
/// let faces = [[o, y, x], [o, x, z], [o, z, y], [x, y, z]];
/// let corner = Mesh::new(faces)?.with(Amount::Density(6.0))?;
/// assert_eq!((corner.mass(), corner.center_of_mass()), (1.0, Vector3::new(0.25, 0.25, 0.25)));
///
/// let open = Mesh::new(faces[..3].to_vec()).unwrap_err();
/// assert_eq!(
///     open.to_string(),
///     "the mesh is open; edges with one triangle only: 3, the first is edge (0, 1, 0)-(1, 0, 0) of triangle 1"
/// );
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Mesh {
    triangles: usize,
    vertices: usize,
    unit: Enclosed,
    doubled: f64,
}

impl Mesh {
    /// From triangles, corners counterclockwise as seen from outside.
    ///
    /// # Errors
    /// Coordinates that are not finite, meshes below 1e-57 or above 1e57 in extent, and meshes that are open, not
    /// manifold, not consistently oriented, inside out or flat; the message names an edge.
    /// To read files in another unit of length, see [`Surface::scaled`].
    pub fn new(triangles: impl IntoIterator<Item = [Vector3<f64>; 3]>) -> Result<Self, MeshError> {
        let mut welded = Welded::default();
        for corners in triangles {
            welded.add(corners.map(Into::into))?;
        }
        Self::of_welded(&welded)
    }

    fn of_welded(mesh: &Welded) -> Result<Self, MeshError> {
        if mesh.triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        mesh.check_extent()?;
        mesh.check_edges()?;
        mesh.check_parts()?;
        let unit = Enclosed::by(mesh)?;
        let doubled = doubled::doubled(mesh, unit.volume);
        Ok(Mesh { triangles: mesh.triangles.len(), vertices: mesh.vertices.len(), unit, doubled })
    }

    /// Number of triangles, without those whose corners coincide.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.triangles
    }

    /// Number of distinct vertices.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.vertices
    }

    /// Enclosed volume, m³.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.unit.volume
    }

    /// Volume that counts more than once, or as a hole where nothing is, over the enclosed volume: 0 where no parts overlap and the
    /// surface does not pass through itself.
    ///
    /// Seen along 128 × 128 lines across the bounding box: an overlap that is narrower than their distance can be missed.
    #[must_use]
    pub fn doubled(&self) -> f64 {
        self.doubled
    }

    /// Mass properties with so much matter in it, in the frame of the vertices.
    ///
    /// # Errors
    /// A mass or density that is not finite or not above zero, or moments outside the range of a double.
    pub fn with(&self, amount: Amount) -> Result<MassProperties, MassError> {
        let mass = amount.mass(self.unit.volume)?;
        let density = match amount {
            Amount::Mass(_) => mass / self.unit.volume,
            Amount::Density(density) => density,
        };
        MassProperties::checked(mass, self.unit.center, self.unit.tensor * density)
    }
}

/// Products of three lengths of an admissible mesh underflow by less than this.
const LEAST: f64 = 1e-240;

/// Volume, centre and tensor about it for density 1.
#[derive(Clone, Debug, PartialEq)]
struct Enclosed {
    volume: f64,
    center: Vector3<f64>,
    tensor: Matrix3<f64>,
}

impl Enclosed {
    /// Of the tetrahedron (0, a, b, c) with s = a + b + c: 6V = a·(b × c), ∫ x = V s/4,
    /// ∫ x xᵀ = V (a aᵀ + b bᵀ + c cᵀ + s sᵀ)/20; summed with sign over all triangles.
    fn by(mesh: &Welded) -> Result<Self, MeshError> {
        let origin = mesh.middle();
        let mut sums = [Compensated::new(0.0); 10];
        let (mut absolute, mut largest) = (0.0, 0.0_f64);
        for &triangle in &mesh.triangles {
            let [a, b, c] = mesh.corners(triangle).map(|v| v + -origin);
            let v6 = a.dot(b.cross(c));
            let s = a + b + c;
            let second = |j: usize, k: usize| v6 * (a[j] * a[k] + b[j] * b[k] + c[j] * c[k] + s[j] * s[k]);
            let terms = [
                v6,
                v6 * s[0],
                v6 * s[1],
                v6 * s[2],
                second(0, 0),
                second(1, 1),
                second(2, 2),
                second(0, 1),
                second(0, 2),
                second(1, 2),
            ];
            for (sum, term) in sums.iter_mut().zip(terms) {
                sum.add(term);
            }
            absolute += v6.abs();
            largest = largest.max(largest_triple(a, b, c));
        }
        let [v6, x, y, z, second @ ..] = sums.map(|sum| sum.value());
        // the v6 of triangles in one plane with the origin is mere rounding of its terms
        let rounding = (mesh.triangles.len() as f64).sqrt() * largest;
        if v6.is_nan() || v6 < LEAST || v6 <= 16.0 * f64::EPSILON * (absolute + rounding) {
            return Err(MeshError::Flat);
        }
        let offset = Vec3([x, y, z]) * (1.0 / (4.0 * v6));
        let about_origin = from_second_moments(second) / 120.0;
        let volume = v6 / 6.0;
        let term = Tensor::of_point(Dd::sum(volume, 0.0), Vec3::of(offset));
        let tensor = (Tensor::symmetric_part(&about_origin) - term).rounded();
        Ok(Enclosed { volume, center: (origin + offset).into(), tensor })
    }
}

/// a·(b × c) if all its terms had one sign.
fn largest_triple(a: Vec3<f64>, b: Vec3<f64>, c: Vec3<f64>) -> f64 {
    let [a, b, c] = [a, b, c].map(|v| v.0.map(f64::abs));
    (0..3).map(|k| a[k] * (b[(k + 1) % 3] * c[(k + 2) % 3] + b[(k + 2) % 3] * c[(k + 1) % 3])).sum()
}
