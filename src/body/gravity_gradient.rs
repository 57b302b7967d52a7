//! The gravity gradient on a body that orbits a point mass.

use nalgebra::Matrix3;

use super::orbit::{Orbit, Place};
use super::{Body, Conserved, Force, ForceError, Potential, Problem, Time};
use crate::num::{Dd, Real};
use crate::rotation::{Quat, Vec3};

const NAME: &str = "gravity gradient";

/// Torque and potential of the gravity gradient to first order in the size of the body over the distance.
///
/// With the direction r̂ and the distance r of the body from the point mass, `U = 3/2 GM/r³ r̂·I r̂` and
/// `τ = 3 GM/r³ r̂ × I r̂`; on an ellipse GM = n² a³ with the mean motion n and the semi-major axis a (Hughes, Spacecraft
/// Attitude Dynamics, §8.1; the part of the potential that does not depend on the attitude is left out).
#[derive(Clone, Debug)]
pub(super) struct GravityGradient {
    pub(super) tensor: Matrix3<f64>,
    pub(super) orbit: Orbit,
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
        Ok(Force::gravity_gradient_on(Orbit::ellipse(mean_motion, eccentricity)?))
    }

    /// The gravity gradient on any [orbit](Orbit), also a parabola or a hyperbola, in any plane. On a circle in the x–y plane of
    /// space Jacobi's constant is conserved, on others nothing is.
    pub fn gravity_gradient_on(orbit: Orbit) -> Self {
        // until it acts on a body there is no mass to act on
        Force::gradient_on(Matrix3::zeros(), orbit)
    }

    /// The same on a body with the tensor `tensor`, kg m², body axes.
    pub(super) fn gradient_on(tensor: Matrix3<f64>, orbit: Orbit) -> Self {
        Force::potential(NAME, GravityGradient { tensor, orbit: orbit.clone() }).on_orbit(orbit)
    }
}

/// The gravity gradient on a circle in the x–y plane of space, in the solver frame: `U = r̂·W r̂` with one W at all times.
#[derive(Clone, Debug)]
pub(crate) struct CircularGradient {
    orbit: Orbit,
    /// W = 3/2 n² I over the [scale](Body::scale): its diagonal, then the entries 23, 31, 12.
    pub(crate) weights: [Dd; 6],
}

impl CircularGradient {
    /// x and y of r̂ in space.
    pub(crate) fn direction(&self, at: Time) -> [Dd; 2] {
        let Vec3([x, y, _]) = self.orbit.at::<Dd>(at).direction;
        [x, y]
    }
}

impl Body {
    /// The gravity gradient on a circle, where nothing else acts.
    pub(crate) fn circular_gradient(&self) -> Option<CircularGradient> {
        let [force] = self.forces() else { return None };
        let orbit = force.orbit.clone().filter(|orbit| orbit.steady_rate().is_some())?;
        if self.problem() != Problem::Potential || !self.wheels().is_empty() {
            return None;
        }
        let gradient = GravityGradient { tensor: self.inertia().tensor(), orbit };
        let strength = gradient.orbit.at::<Dd>(Time::from_seconds(0.0)).strength;
        let share = strength * 0.5 * (1.0 / self.scale());
        let frame = self.inertia().frame();
        let columns = [0, 1, 2].map(|axis| {
            let along: Vec3<Dd> = frame.rotate(Vec3::unit(axis));
            frame.rotate_back(times(&gradient.tensor, along)) * share
        });
        let weights = [(0, 0), (1, 1), (2, 2), (1, 2), (2, 0), (0, 1)].map(|(j, k)| columns[k][j]);
        Some(CircularGradient { orbit: gradient.orbit, weights })
    }
}

#[inline(always)]
fn times<S: Real>(tensor: &Matrix3<f64>, v: Vec3<S>) -> Vec3<S> {
    let row = |k: usize| {
        let entry = |j: usize| S::of(tensor[(k, j)]);
        entry(0) * v[0] + entry(1) * v[1] + entry(2) * v[2]
    };
    Vec3([row(0), row(1), row(2)])
}

/// The torque at `place`, on a body with the tensor `tensor`, kg m², body axes.
#[inline(always)]
pub(crate) fn gradient_torque<S: Real>(
    tensor: &Matrix3<f64>,
    place: &Place<S>,
    attitude: Quat<S>,
) -> Vec3<S> {
    let r = attitude.rotate_back(place.direction);
    r.cross(times(tensor, r)) * place.strength
}

impl<S: Real> Potential<S> for GravityGradient {
    fn energy(&self, at: Time, attitude: Quat<S>) -> S {
        let Place { strength, direction } = self.orbit.at::<S>(at);
        let r = attitude.rotate_back(direction);
        strength * S::of(0.5) * r.dot(times(&self.tensor, r))
    }

    fn torque(&self, at: Time, attitude: Quat<S>) -> Vec3<S> {
        gradient_torque(&self.tensor, &self.orbit.at(at), attitude)
    }

    fn conserved(&self) -> Vec<Conserved> {
        self.orbit.steady_rate().map(|rate| Conserved::Jacobi { rate }).into_iter().collect()
    }
}
