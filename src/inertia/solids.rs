//! Homogeneous shapes in closed form.

use core::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};

use super::mass::length;
use super::{Amount, MassError, MassProperties};

/// A homogeneous shape. Its symmetry axis, if it has one, is z; a rod lies along z, disks, plates and hoops in
/// the plane z = 0. The origin is the centre, except of the cone, whose base is centred at the origin and whose
/// tip is at z = `height`.
///
/// The moments are the integrals of `I_jk = ∫ (δ_jk s² − s_j s_k) dm` in closed form, each within a few roundings.
///
/// ```
/// use polhode::inertia::{Amount, Solid};
/// let cube = Solid::Box([1.0, 1.0, 1.0]).with(Amount::Mass(6.0))?;
/// assert_eq!(cube.principal_moments(), [1.0, 1.0, 1.0]);
/// assert_eq!(cube.class().name(), "spherical"); // not only a sphere is a spherical top
/// # Ok::<(), polhode::inertia::MassError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solid {
    /// A box with these edges, m.
    Box([f64; 3]),
    /// An ellipsoid with these semi-axes, m.
    Ellipsoid([f64; 3]),
    /// A ball.
    Sphere {
        /// Radius, m.
        radius: f64,
    },
    /// A thin hollow sphere.
    Shell {
        /// Radius, m.
        radius: f64,
    },
    /// A solid cylinder.
    Cylinder {
        /// Radius, m.
        radius: f64,
        /// Height, m.
        height: f64,
    },
    /// A hollow cylinder without lids.
    Tube {
        /// Inner radius, m.
        inner: f64,
        /// Outer radius, m.
        outer: f64,
        /// Height, m.
        height: f64,
    },
    /// A solid circular cone.
    Cone {
        /// Radius of the base, m.
        radius: f64,
        /// Height, m.
        height: f64,
    },
    /// A solid ring.
    Torus {
        /// From the centre of the ring to the centre of its tube, m.
        ring: f64,
        /// Radius of the tube, m.
        tube: f64,
    },
    /// A thin straight rod.
    Rod {
        /// Length, m.
        length: f64,
    },
    /// A thin circular disk.
    Disk {
        /// Radius, m.
        radius: f64,
    },
    /// A thin rectangular plate with these edges, m.
    Plate([f64; 2]),
    /// A thin circular ring.
    Hoop {
        /// Radius, m.
        radius: f64,
    },
    /// A solid cylinder with half a ball on either end.
    Capsule {
        /// Radius, m.
        radius: f64,
        /// Height of the cylinder, without the caps, m.
        height: f64,
    },
}

/// Name and sizes of each shape.
const SHAPES: [(&str, &[&str]); 13] = [
    ("box", &["length x", "length y", "length z"]),
    ("ellipsoid", &["semi-axis x", "semi-axis y", "semi-axis z"]),
    ("sphere", &["radius"]),
    ("shell", &["radius"]),
    ("cylinder", &["radius", "height"]),
    ("tube", &["inner radius", "outer radius", "height"]),
    ("cone", &["radius", "height"]),
    ("torus", &["ring radius", "tube radius"]),
    ("rod", &["length"]),
    ("disk", &["radius"]),
    ("plate", &["length x", "length y"]),
    ("hoop", &["radius"]),
    ("capsule", &["radius", "height"]),
];

impl Solid {
    /// The names that [`named`](Self::named) knows.
    pub fn names() -> impl Iterator<Item = &'static str> + Clone {
        SHAPES.iter().map(|(name, _)| *name)
    }

    /// A shape by its name in lowercase and its sizes, in the order of the fields.
    ///
    /// # Errors
    /// An unknown name, or the wrong number of sizes.
    pub fn named(name: &str, sizes: &[f64]) -> Result<Self, MassError> {
        let Some((shape, names)) = SHAPES.iter().find(|(known, _)| *known == name) else {
            let known = Self::names().collect::<Vec<_>>().join(", ");
            return Err(MassError::UnknownShape { name: name.into(), known });
        };
        Ok(match (*shape, sizes) {
            ("box", &[x, y, z]) => Solid::Box([x, y, z]),
            ("ellipsoid", &[x, y, z]) => Solid::Ellipsoid([x, y, z]),
            ("sphere", &[radius]) => Solid::Sphere { radius },
            ("shell", &[radius]) => Solid::Shell { radius },
            ("cylinder", &[radius, height]) => Solid::Cylinder { radius, height },
            ("tube", &[inner, outer, height]) => Solid::Tube { inner, outer, height },
            ("cone", &[radius, height]) => Solid::Cone { radius, height },
            ("torus", &[ring, tube]) => Solid::Torus { ring, tube },
            ("rod", &[length]) => Solid::Rod { length },
            ("disk", &[radius]) => Solid::Disk { radius },
            ("plate", &[x, y]) => Solid::Plate([x, y]),
            ("hoop", &[radius]) => Solid::Hoop { radius },
            ("capsule", &[radius, height]) => Solid::Capsule { radius, height },
            _ => {
                return Err(MassError::SizeCount {
                    shape,
                    needed: names.len(),
                    names: names.join(", "),
                    given: sizes.len(),
                });
            }
        })
    }

    /// Its name, as [`named`](Self::named) takes it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        SHAPES[self.place()].0
    }

    /// Its sizes, as [`named`](Self::named) takes them.
    #[must_use]
    pub fn sizes(&self) -> Vec<f64> {
        match *self {
            Solid::Box(sizes) | Solid::Ellipsoid(sizes) => sizes.into(),
            Solid::Plate(sizes) => sizes.into(),
            Solid::Sphere { radius }
            | Solid::Shell { radius }
            | Solid::Disk { radius }
            | Solid::Hoop { radius } => vec![radius],
            Solid::Rod { length } => vec![length],
            Solid::Cylinder { radius, height }
            | Solid::Cone { radius, height }
            | Solid::Capsule { radius, height } => vec![radius, height],
            Solid::Tube { inner, outer, height } => vec![inner, outer, height],
            Solid::Torus { ring, tube } => vec![ring, tube],
        }
    }

    fn place(&self) -> usize {
        match self {
            Solid::Box(_) => 0,
            Solid::Ellipsoid(_) => 1,
            Solid::Sphere { .. } => 2,
            Solid::Shell { .. } => 3,
            Solid::Cylinder { .. } => 4,
            Solid::Tube { .. } => 5,
            Solid::Cone { .. } => 6,
            Solid::Torus { .. } => 7,
            Solid::Rod { .. } => 8,
            Solid::Disk { .. } => 9,
            Solid::Plate(_) => 10,
            Solid::Hoop { .. } => 11,
            Solid::Capsule { .. } => 12,
        }
    }

    /// Volume (m³) of a solid, area (m²) of a surface, length (m) of a line.
    #[must_use]
    pub fn measure(&self) -> f64 {
        match *self {
            Solid::Box([x, y, z]) => x * y * z,
            Solid::Ellipsoid([a, b, c]) => 4.0 / 3.0 * PI * (a * b * c),
            Solid::Sphere { radius: r } => 4.0 / 3.0 * PI * (r * r * r),
            Solid::Shell { radius: r } => 4.0 * PI * (r * r),
            Solid::Cylinder { radius: r, height: h } => PI * (r * r * h),
            Solid::Tube { inner, outer, height } => PI * ((outer - inner) * (outer + inner) * height),
            Solid::Cone { radius: r, height: h } => PI * (r * r * h) / 3.0,
            Solid::Torus { ring, tube } => 2.0 * PI * PI * (ring * tube * tube),
            Solid::Rod { length } => length,
            Solid::Disk { radius: r } => PI * (r * r),
            Solid::Plate([x, y]) => x * y,
            Solid::Hoop { radius } => 2.0 * PI * radius,
            Solid::Capsule { radius: r, height: h } => PI * (r * r * (h + 4.0 / 3.0 * r)),
        }
    }

    /// Mass properties with so much matter in it.
    ///
    /// # Errors
    /// Sizes, a mass or a density that are not finite or not above zero; a tube whose radii are not ascending, a
    /// torus whose tube is wider than its ring; sizes and masses whose moments are outside the range of a double.
    pub fn with(&self, amount: Amount) -> Result<MassProperties, MassError> {
        for (&name, size) in SHAPES[self.place()].1.iter().zip(self.sizes()) {
            length(name, size)?;
        }
        self.check_order()?;
        let m = amount.mass(self.measure())?;
        let diagonal = |x: f64, y: f64, z: f64| Matrix3::from_diagonal(&Vector3::new(m * x, m * y, m * z));
        // a flat body has exactly I_z = I_x + I_y
        let flat = |x: f64, y: f64| {
            let (x, y) = (m * x, m * y);
            Matrix3::from_diagonal(&Vector3::new(x, y, x + y))
        };
        let tensor = match *self {
            Solid::Box([x, y, z]) => {
                let (x, y, z) = (x * x, y * y, z * z);
                diagonal((y + z) / 12.0, (x + z) / 12.0, (x + y) / 12.0)
            }
            Solid::Ellipsoid([a, b, c]) => {
                let (a, b, c) = (a * a, b * b, c * c);
                diagonal((b + c) / 5.0, (a + c) / 5.0, (a + b) / 5.0)
            }
            Solid::Sphere { radius: r } => {
                let i = 2.0 * (r * r) / 5.0;
                diagonal(i, i, i)
            }
            Solid::Shell { radius: r } => {
                let i = 2.0 * (r * r) / 3.0;
                diagonal(i, i, i)
            }
            Solid::Cylinder { radius: r, height: h } => {
                let side = (3.0 * (r * r) + h * h) / 12.0;
                diagonal(side, side, r * r / 2.0)
            }
            Solid::Tube { inner, outer, height: h } => {
                let r2 = inner * inner + outer * outer;
                let side = (3.0 * r2 + h * h) / 12.0;
                diagonal(side, side, r2 / 2.0)
            }
            Solid::Cone { radius: r, height: h } => {
                let side = 3.0 * (4.0 * (r * r) + h * h) / 80.0;
                diagonal(side, side, 3.0 * (r * r) / 10.0)
            }
            Solid::Torus { ring, tube } => {
                let (ring, tube) = (ring * ring, tube * tube);
                let side = (4.0 * ring + 5.0 * tube) / 8.0;
                diagonal(side, side, (4.0 * ring + 3.0 * tube) / 4.0)
            }
            Solid::Rod { length } => {
                let i = length * length / 12.0;
                diagonal(i, i, 0.0)
            }
            Solid::Disk { radius: r } => flat(r * r / 4.0, r * r / 4.0),
            Solid::Plate([x, y]) => flat(y * y / 12.0, x * x / 12.0),
            Solid::Hoop { radius: r } => flat(r * r / 2.0, r * r / 2.0),
            Solid::Capsule { radius: r, height: h } => {
                // shares of the mass: the cylinder, and the two caps, whose centres are 3/8 r beyond its ends
                let caps = 4.0 * r / (3.0 * h + 4.0 * r);
                let cylinder = 3.0 * h / (3.0 * h + 4.0 * r);
                let across = cylinder * (3.0 * (r * r) + h * h) / 12.0
                    + caps * (2.0 * (r * r) / 5.0 + h * h / 4.0 + 3.0 * (h * r) / 8.0);
                diagonal(across, across, cylinder * (r * r) / 2.0 + caps * (2.0 * (r * r)) / 5.0)
            }
        };
        let center = match *self {
            Solid::Cone { height, .. } => Vector3::new(0.0, 0.0, height / 4.0),
            _ => Vector3::zeros(),
        };
        if tensor.trace() == 0.0 {
            return Err(MassError::OutOfRange);
        }
        MassProperties::checked(m, center, tensor)
    }

    fn check_order(&self) -> Result<(), MassError> {
        let (small_name, small, large_name, large) = match *self {
            Solid::Tube { inner, outer, .. } => ("inner radius", inner, "outer radius", outer),
            Solid::Torus { ring, tube } => ("tube radius", tube, "ring radius", ring),
            _ => return Ok(()),
        };
        if small < large {
            return Ok(());
        }
        Err(MassError::Sizes { shape: self.name(), small_name, small, large_name, large })
    }
}
