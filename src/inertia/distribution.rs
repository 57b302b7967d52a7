//! Continuous mass distributions, by Gauss–Legendre quadrature.
//!
//! A body is a map from the unit cube to space with the mass that each element carries: `I_jk = ∫ (δ_jk s² − s_j s_k) dm`.

use core::f64::consts::PI;

use nalgebra::Vector3;
use thiserror::Error;

use super::mass::{length, positive};
use super::symmetric::from_second_moments;
use super::{MassError, MassProperties};
use crate::num::trig::sin_cos;
use crate::num::{Compensated, Real, Shown};

/// Why a distribution has no mass properties.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MassDistributionError {
    /// The density is negative or not a number somewhere.
    #[error(
        "density is {} at ({}, {}, {}); it must be finite and not negative",
        Shown(*density), Shown(at.x), Shown(at.y), Shown(at.z)
    )]
    Density {
        /// The offending value.
        density: f64,
        /// Where.
        at: Vector3<f64>,
    },
    /// More nodes still change the result.
    #[error(
        "with {nodes} nodes an axis the result still changes by {change:.1e}, more than {tolerance:.1e}; \
         split the body where its density jumps"
    )]
    NotConverged {
        /// Nodes along each axis at the last attempt.
        nodes: usize,
        /// Largest relative change from half as many.
        change: f64,
        /// The change asked for.
        tolerance: f64,
    },
    /// The region has no size, or there is no mass in it.
    #[error(transparent)]
    Mass(#[from] MassError),
}

/// Where a density is given, centred at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Region {
    /// A box with these edges, m.
    Box([f64; 3]),
    /// An ellipsoid with these semi-axes, m.
    Ellipsoid([f64; 3]),
    /// What lies between two spheres; the inner radius may be zero.
    Layer {
        /// Inner radius, m.
        inner: f64,
        /// Outer radius, m.
        outer: f64,
    },
    /// A cylinder about z.
    Cylinder {
        /// Radius, m.
        radius: f64,
        /// Height, m.
        height: f64,
    },
}

impl Region {
    /// Mass properties of this region filled with `density` (kg/m³ as a function of the position in m).
    ///
    /// Nodes are doubled until mass, centre and tensor change by less than `tolerance`, relative to the mass, the
    /// root of tr(I)/M, and the trace. A density that jumps inside the region converges slowly: give each part its region and
    /// [sum](MassProperties::sum) them.
    ///
    /// # Errors
    /// A region without size, a density that is negative or not finite, or no convergence at 128 nodes an axis.
    ///
    /// ```
    /// use polhode::inertia::{Region, Symmetry, Class};
    /// // a planet whose density falls linearly from the centre to a third at the surface
    /// let planet = Region::Layer { inner: 0.0, outer: 2.0 };
    /// let body = planet.filled(|at| 3.0 - at.norm(), 1e-13)?;
    /// assert_eq!(body.class(), Class::Solid(Symmetry::Spherical));
    /// let factor = body.principal_moments()[0] / (body.mass() * 4.0);
    /// assert!((factor - 16.0 / 45.0).abs() < 1e-12); // 0.4 if it were homogeneous
    /// # Ok::<(), polhode::inertia::MassDistributionError>(())
    /// ```
    pub fn filled(
        &self,
        density: impl Fn(Vector3<f64>) -> f64,
        tolerance: f64,
    ) -> Result<MassProperties, MassDistributionError> {
        self.check()?;
        integrate_mass(
            |u| {
                let (at, volume) = self.element(u);
                let rho = density(at);
                if rho >= 0.0 && rho.is_finite() {
                    Ok((at, rho * volume))
                } else {
                    Err(MassDistributionError::Density { density: rho, at })
                }
            },
            tolerance,
        )
    }

    fn check(&self) -> Result<(), MassError> {
        match *self {
            Region::Box(sizes) | Region::Ellipsoid(sizes) => {
                for size in sizes {
                    length("extent of the region", size)?;
                }
            }
            Region::Layer { inner, outer } => {
                length("outer radius", outer)?;
                if inner.is_nan() || inner < 0.0 {
                    return Err(MassError::Negative { quantity: "inner radius", value: inner });
                }
                if inner >= outer {
                    return Err(MassError::Sizes {
                        shape: "layer",
                        small_name: "inner radius",
                        small: inner,
                        large_name: "outer radius",
                        large: outer,
                    });
                }
            }
            Region::Cylinder { radius, height } => {
                length("radius", radius)?;
                length("height", height)?;
            }
        }
        Ok(())
    }

    /// The point of the region at `u` in the unit cube, and the volume per volume of the cube there.
    fn element(&self, u: [f64; 3]) -> (Vector3<f64>, f64) {
        match *self {
            Region::Box([x, y, z]) => {
                (Vector3::new(x * (u[0] - 0.5), y * (u[1] - 0.5), z * (u[2] - 0.5)), x * y * z)
            }
            Region::Ellipsoid([a, b, c]) => {
                let (at, volume) = spherical(u[0], u);
                (Vector3::new(a * at.x, b * at.y, c * at.z), a * b * c * volume)
            }
            Region::Layer { inner, outer } => {
                let (at, volume) = spherical(inner + (outer - inner) * u[0], u);
                (at, volume * (outer - inner))
            }
            Region::Cylinder { radius, height } => {
                let (r, (sin, cos)) = (radius * u[0], sin_cos(2.0 * PI * u[1]));
                (Vector3::new(r * cos, r * sin, height * (u[2] - 0.5)), 2.0 * PI * r * radius * height)
            }
        }
    }
}

/// The point at radius `r` whose height and longitude are `u[1]` and `u[2]`; volume per unit of r, u₁ and u₂.
fn spherical(r: f64, u: [f64; 3]) -> (Vector3<f64>, f64) {
    let z = 2.0 * u[1] - 1.0;
    let rho = Real::sqrt(4.0 * u[1] * (1.0 - u[1]));
    let (sin, cos) = sin_cos(2.0 * PI * u[2]);
    (Vector3::new(rho * cos, rho * sin, z) * r, 4.0 * PI * r * r)
}

/// Mass properties of the body that `element` maps from the unit cube: position and mass per volume of the cube.
///
/// Surfaces and lines are maps that ignore one or two of the coordinates.
///
/// # Errors
/// Those of `element`; no mass; no convergence at 128 nodes an axis.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode::inertia::integrate_mass;
/// use polhode::num::trig::sin_cos;
/// // half a hoop of 1 kg and radius 1
/// let half_hoop = integrate_mass(
///     |[u, _, _]| {
///         let (sin, cos) = sin_cos(core::f64::consts::PI * u);
///         Ok((Vector3::new(cos, sin, 0.0), 1.0))
///     },
///     1e-13,
/// )?;
/// assert!((half_hoop.center_of_mass().y - 2.0 / core::f64::consts::PI).abs() < 1e-14);
/// # Ok::<(), polhode::inertia::MassDistributionError>(())
/// ```
pub fn integrate_mass(
    element: impl Fn([f64; 3]) -> Result<(Vector3<f64>, f64), MassDistributionError>,
    tolerance: f64,
) -> Result<MassProperties, MassDistributionError> {
    let mut nodes = 8;
    let mut before = with_nodes(&element, nodes)?;
    loop {
        nodes *= 2;
        let now = with_nodes(&element, nodes)?;
        let change = relative_change(&before, &now);
        if change <= tolerance {
            return Ok(now);
        }
        if nodes == 128 {
            return Err(MassDistributionError::NotConverged { nodes, change, tolerance });
        }
        before = now;
    }
}

fn relative_change(a: &MassProperties, b: &MassProperties) -> f64 {
    let trace = b.tensor().trace();
    let mass = (a.mass() - b.mass()).abs() / b.mass();
    if trace == 0.0 {
        return mass;
    }
    let center = (a.center_of_mass() - b.center_of_mass()).norm() / (trace / b.mass()).sqrt();
    mass.max(center).max((a.tensor() - b.tensor()).amax() / trace)
}

fn with_nodes(
    element: impl Fn([f64; 3]) -> Result<(Vector3<f64>, f64), MassDistributionError>,
    nodes: usize,
) -> Result<MassProperties, MassDistributionError> {
    let rule = gauss_legendre(nodes);
    let mut sums = [Compensated::new(0.0); 10]; // mass, first and second moments
    for &(x, wx) in &rule {
        for &(y, wy) in &rule {
            for &(z, wz) in &rule {
                let (s, density) = element([x, y, z])?;
                let dm = density * (wx * wy * wz);
                let (sx, sy, sz) = (dm * s.x, dm * s.y, dm * s.z);
                let terms = [dm, sx, sy, sz, sx * s.x, sy * s.y, sz * s.z, sx * s.y, sx * s.z, sy * s.z];
                for (sum, term) in sums.iter_mut().zip(terms) {
                    sum.add(term);
                }
            }
        }
    }
    let [mass, x, y, z, second @ ..] = sums.map(|sum| sum.value());
    positive("mass of the distribution", mass)?;
    let tensor = from_second_moments(second);
    Ok(MassProperties::from_tensor_about(Vector3::zeros(), mass, Vector3::new(x, y, z) / mass, tensor)?)
}

/// Nodes in (0, 1) and weights of sum 1: the zeros of the Legendre polynomial P_n by Newton's iteration.
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let degree = n as f64;
    let node = |k: usize| {
        let mut x = sin_cos(PI * (k as f64 + 0.75) / (degree + 0.5)).1;
        let mut slope = 1.0;
        // quadratic from a start that is right to 1/n²
        for _ in 0..6 {
            let (mut p, mut before) = (x, 1.0); // P_1 and P_0
            for j in 2..=n {
                let j = j as f64;
                (p, before) = (((2.0 * j - 1.0) * x * p - (j - 1.0) * before) / j, p);
            }
            slope = degree * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        ((1.0 + x) / 2.0, 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauss_legendre_integrates_powers_up_to_its_degree() {
        for n in [8, 16, 32, 64, 128] {
            let rule = gauss_legendre(n);
            let mut powers = vec![1.0; n];
            for degree in 0..2 * n {
                let integral: f64 = rule.iter().zip(&powers).map(|((_, w), p)| w * p).sum();
                let expected = 1.0 / (degree as f64 + 1.0);
                assert!((integral - expected).abs() < 1e-13, "{n} nodes, degree {degree}: {integral}");
                for (p, (x, _)) in powers.iter_mut().zip(&rule) {
                    *p *= x;
                }
            }
        }
    }
}
