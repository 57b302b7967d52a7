//! The gravity gradient on a body that orbits a point mass.

use core::cmp::Ordering;

use nalgebra::Matrix3;

use super::force::finite;
use super::{Conserved, Force, ForceError, Potential, Time};
use crate::num::Real;
use crate::rotation::{Quat, Vec3};

const NAME: &str = "gravity gradient";

/// Newton's iteration takes away a third of E or more, even as e nears 1, until it doubles the digits: it is done before.
const MOST_DESCENTS: u32 = 2048;

/// Torque and potential of the gravity gradient to first order in the size of the body over the distance.
///
/// The orbit lies in the x–y plane of space, counter-clockwise about +z, perigee on +x at t = 0; the body is at the
/// direction r̂ = (cos ν, sin ν, 0). With the mean motion n, the semi-major axis a and the distance r,
/// `U = 3/2 n² (a/r)³ r̂·I r̂` and `τ = 3 n² (a/r)³ r̂ × I r̂` (Hughes, Spacecraft Attitude Dynamics, §8.1;
/// the part of the potential that does not depend on the attitude is left out).
#[derive(Clone, Debug)]
struct GravityGradient {
    tensor: Matrix3<f64>,
    mean_motion: f64,
    eccentricity: f64,
}

impl Force {
    /// The gravity gradient on an orbit with the mean motion `mean_motion` (rad/s) and the eccentricity `eccentricity`, 0 for a
    /// circle. The inertia is that of the [body](super::Body::with) on which it acts, about its centre of mass.
    ///
    /// The orbit lies in the x–y plane of space, counter-clockwise about +z, with the perigee on +x at t = 0. On a circular
    /// orbit [Jacobi's constant](Conserved::Jacobi) E − n L_z is conserved, on an elliptic one nothing is.
    ///
    /// # Errors
    /// Values that are not finite, an eccentricity outside [0, 1).
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::body::{Body, Force};
    /// use polhode::inertia::Inertia;
    /// let gradient = Force::gravity_gradient(0.001, 0.0)?;
    /// let body = Body::free(Inertia::from_moments([1.0, 2.0, 2.5])?).with(gradient);
    /// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.0, 0.0, 0.001))?;
    /// assert!((body.energy(&start) - (1.25e-6 + 1.5e-6)).abs() < 1e-20); // the axis of 1 kg m² along r
    /// # Ok::<(), polhode::Error>(())
    /// ```
    pub fn gravity_gradient(mean_motion: f64, eccentricity: f64) -> Result<Self, ForceError> {
        let mean_motion = finite(NAME, "the mean motion", mean_motion)?;
        if !(0.0..1.0).contains(&eccentricity) {
            return Err(ForceError::Eccentricity { eccentricity });
        }
        // until it acts on a body there is no mass to act on
        Ok(Force::gradient_on(Matrix3::zeros(), [mean_motion, eccentricity]))
    }

    /// The same on a body with the tensor `tensor`, kg m², body axes.
    pub(super) fn gradient_on(tensor: Matrix3<f64>, orbit: [f64; 2]) -> Self {
        let [mean_motion, eccentricity] = orbit;
        let law = GravityGradient { tensor, mean_motion, eccentricity };
        Force::potential(NAME, law).on_orbit(orbit)
    }
}

impl GravityGradient {
    /// 3 n² (a/r)³ and r̂ in body axes.
    fn position<S: Real>(&self, at: Time, attitude: Quat<S>) -> (S, Vec3<S>) {
        let one = S::of(1.0);
        let (cos, sin, near) = if self.eccentricity == 0.0 {
            let (sin, cos) = at.angle::<S>(self.mean_motion).sin_cos();
            (cos, sin, one)
        } else {
            let e = S::of(self.eccentricity);
            let (sin, cos) = self.eccentric_anomaly::<S>(at).sin_cos();
            let near = one / (one - e * cos); // a/r
            ((cos - e) * near, (one - e * e).sqrt() * sin * near, near)
        };
        let n = S::of(self.mean_motion);
        let strength = S::of(3.0) * n * n * (near * near * near);
        (strength, attitude.rotate_back(Vec3([cos, sin, S::of(0.0)])))
    }

    /// The solution of Kepler's equation `E − e sin E = M`, M in [−π, π].
    fn eccentric_anomaly<S: Real>(&self, at: Time) -> S {
        let mean: f64 = at.angle(self.mean_motion);
        let (e, m) = (self.eccentricity, mean.abs());
        // M + e and π are upper bounds, and from above Newton's iteration descends to the root, as E − e sin E is convex
        // up to π
        let mut x = (m + e).min(core::f64::consts::PI);
        for _ in 0..MOST_DESCENTS {
            let (sin, cos) = Real::sin_cos(x);
            let next = x - (x - e * sin - m) / (1.0 - e * cos);
            if next.partial_cmp(&x) != Some(Ordering::Less) {
                break;
            }
            x = next;
        }
        let (e, m) = (S::of(e), at.angle::<S>(self.mean_motion));
        let mut x = S::of(if mean < 0.0 { -x } else { x });
        // each step doubles the digits: one polishes doubles, two give double-double
        for _ in 0..S::NEWTON_STEPS {
            let (sin, cos) = x.sin_cos();
            x = x - (x - e * sin - m) / (S::of(1.0) - e * cos);
        }
        x
    }

    fn times<S: Real>(&self, v: Vec3<S>) -> Vec3<S> {
        let row = |k: usize| {
            let entry = |j: usize| S::of(self.tensor[(k, j)]);
            entry(0) * v[0] + entry(1) * v[1] + entry(2) * v[2]
        };
        Vec3([row(0), row(1), row(2)])
    }
}

impl<S: Real> Potential<S> for GravityGradient {
    fn energy(&self, at: Time, attitude: Quat<S>) -> S {
        let (strength, r) = self.position(at, attitude);
        strength * S::of(0.5) * r.dot(self.times(r))
    }

    fn torque(&self, at: Time, attitude: Quat<S>) -> Vec3<S> {
        let (strength, r) = self.position(at, attitude);
        r.cross(self.times(r)) * strength
    }

    fn conserved(&self) -> Vec<Conserved> {
        if self.eccentricity == 0.0 { vec![Conserved::Jacobi { rate: self.mean_motion }] } else { Vec::new() }
    }
}
