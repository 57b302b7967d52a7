//! A body as kernels see it: along principal axes, divided by one power of two.

use nalgebra::{UnitQuaternion, Vector3};
use thiserror::Error;

use super::{Inertia, State};
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// Why a start is not usable.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum StateError {
    /// A component is not a finite number.
    #[error("{quantity} has the component {value}; every component must be a finite number")]
    NotFinite {
        /// Which quantity.
        quantity: &'static str,
        /// The offending value.
        value: f64,
    },
    /// The spin is too large or too small for its energy to be a double.
    #[error(
        "angular velocity {omega:?} rad/s with this inertia puts the energy outside the range of a double; change the units"
    )]
    OutOfRange {
        /// Largest component of the angular velocity, rad/s.
        omega: f64,
    },
}

/// A rigid body and what acts on it; here nothing does.
///
/// A user's state refers to the body axes that the inertia was given in; kernels work along principal axes with
/// moments and momenta divided by a power of two, so that fourth powers neither over- nor underflow and a change
/// of the unit of mass by a power of two changes no bit. [`enter`](Body::enter) and [`leave`](Body::leave) are
/// the two doors.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    inertia: Inertia,
}

impl Body {
    /// A body on which no torque acts.
    pub fn free(inertia: Inertia) -> Self {
        Body { inertia }
    }

    /// Its inertia.
    pub fn inertia(&self) -> &Inertia {
        &self.inertia
    }

    /// The state with angular velocity `omega_body` (rad/s, body axes): m = I ω.
    ///
    /// # Errors
    /// Components that are not finite, or a spin whose energy is no finite double.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::body::{Body, Inertia};
    /// let body = Body::free(Inertia::from_moments([1.0, 2.0, 3.0])?);
    /// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.5, 1.0, -0.25))?;
    /// assert_eq!(start.momentum(), Vector3::new(0.5, 2.0, -0.75));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn state(
        &self,
        attitude: UnitQuaternion<f64>,
        omega_body: Vector3<f64>,
    ) -> Result<State<f64>, StateError> {
        let inside = self.enter_omega(attitude.into(), omega_body.into())?;
        Ok(self.leave(&inside))
    }

    /// The exact state with angular velocity `omega_body` as kernels see it.
    ///
    /// # Errors
    /// As [`state`](Self::state).
    pub fn enter_omega(&self, attitude: Quat<f64>, omega_body: Vec3<f64>) -> Result<State<Dd>, StateError> {
        check("attitude", &attitude.components())?;
        check("angular velocity", &omega_body.0)?;
        let inside = State {
            attitude: Quat::of(attitude).normalized() * self.inertia.frame(),
            momentum_body: self.inertia.scaled_momentum(omega_body),
        };
        self.check_range(&inside)?;
        Ok(inside)
    }

    /// The state `x` (body axes) as kernels see it: principal axes, divided by the power of two.
    ///
    /// # Errors
    /// As [`state`](Self::state).
    pub fn enter(&self, x: &State<f64>) -> Result<State<Dd>, StateError> {
        check("attitude", &x.attitude.components())?;
        check("momentum", &x.momentum_body.0)?;
        let (frame, scale) = (self.inertia.frame(), self.inertia.scale());
        let momentum = Vec3(x.momentum_body.0.map(|m| Dd::of(m / scale)));
        let inside =
            State { attitude: Quat::of(x.attitude) * frame, momentum_body: frame.rotate_back(momentum) };
        self.check_range(&inside)?;
        Ok(inside)
    }

    /// The state `x` of a kernel in body axes.
    pub fn leave<S: Precise>(&self, x: &State<S>) -> State<f64> {
        let (mut attitude, mut momentum) = (x.attitude, x.momentum_body);
        if !self.inertia.is_along_principal_axes() {
            let frame = Quat::from_components(self.inertia.frame().components().map(S::from_dd));
            attitude = attitude * frame.conjugate();
            momentum = frame.rotate(momentum);
        }
        let scale = self.inertia.scale();
        State {
            attitude: Quat::from_components(attitude.components().map(S::to_f64)),
            momentum_body: Vec3(momentum.0.map(|m| m.to_f64() * scale)),
        }
    }

    /// Angular velocity ω = I⁻¹ m in body axes, rad/s, of a kernel's state.
    pub fn omega_body<S: Precise>(&self, x: &State<S>) -> Vector3<f64> {
        let mut omega = x.momentum_body.times(self.inverse_moments());
        if !self.inertia.is_along_principal_axes() {
            omega = Quat::from_components(self.inertia.frame().components().map(S::from_dd)).rotate(omega);
        }
        Vec3(omega.0.map(S::to_f64)).into()
    }

    /// The power of two that a kernel's moments, momenta and energies are to be multiplied with.
    pub fn scale(&self) -> f64 {
        self.inertia.scale()
    }

    /// Principal moments along a kernel's axes, divided by the power of two.
    pub fn moments<S: Real>(&self) -> Vec3<S> {
        Vec3(self.inertia.scaled_moments().map(of_dd))
    }

    /// Reciprocals of [`moments`](Self::moments), each rounded once.
    pub fn inverse_moments<S: Real>(&self) -> Vec3<S> {
        Vec3(self.inertia.scaled_moments().map(|i| of_dd(Dd::ONE / i)))
    }

    fn check_range(&self, inside: &State<Dd>) -> Result<(), StateError> {
        let omega = inside.momentum_body.times(self.inverse_moments());
        let twice_energy = inside.momentum_body.dot(omega).hi();
        let energy = twice_energy * self.inertia.scale();
        // Dekker products of squares need the exponent to stay clear of both ends
        let clear = |x: f64| x == 0.0 || (1e-240..1e240).contains(&x.abs());
        let at_rest = omega.0.iter().all(|w| w.hi() == 0.0);
        if clear(twice_energy) && clear(energy) && (at_rest || energy != 0.0) {
            Ok(())
        } else {
            Err(StateError::OutOfRange { omega: omega.magnitude() })
        }
    }
}

/// A double-double in any scalar, rounded once where it has fewer digits.
pub(crate) fn of_dd<S: Real>(x: Dd) -> S {
    S::of(x.hi()) + S::of(x.lo())
}

fn check(quantity: &'static str, components: &[f64]) -> Result<(), StateError> {
    match components.iter().find(|value| !value.is_finite()) {
        Some(&value) => Err(StateError::NotFinite { quantity, value }),
        None => Ok(()),
    }
}
