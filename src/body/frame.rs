//! A body as kernels see it: along principal axes, divided by one power of two.

use nalgebra::{UnitQuaternion, Vector3};
use thiserror::Error;

use super::{Gravity, Inertia, State};
use crate::num::{Dd, Precise, Real, Shown};
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
    /// The quaternion of the attitude is zero.
    #[error("the attitude is the zero quaternion, which has no direction; any other norm is fine")]
    NoAttitude,
    /// The spin is too large or too small for its energy to be a double.
    #[error(
        "{quantity} {} {unit} with this inertia puts the energy outside the range of a double; change the units", Shown(*value)
    )]
    OutOfRange {
        /// Angular velocity or momentum, which was given.
        quantity: &'static str,
        /// Its largest component.
        value: f64,
        /// In which unit.
        unit: &'static str,
    },
    /// The weight moment is too large or too small beside the inertia.
    #[error(
        "weight moment {} N m beside moments of inertia of {}: the rate of falling is outside the range \
         of a double; change the units",
        Shown(*weight_moment), Shown(*moment)
    )]
    WeightOutOfRange {
        /// Size of the weight moment, N m.
        weight_moment: f64,
        /// Largest moment of inertia, to a power of two.
        moment: f64,
    },
}

/// A rigid body and what acts on it: nothing, or uniform gravity about a fixed point.
///
/// A user's state refers to the body axes that the inertia was given in; kernels work along principal axes with
/// moments and momenta divided by a power of two, so that fourth powers neither over- nor underflow and a change
/// of the unit of mass by a power of two changes no bit. [`enter`](Body::enter) and [`leave`](Body::leave) are
/// the two doors.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    inertia: Inertia,
    /// Along a kernel's axes and in its scale.
    gravity: Option<Gravity<Dd>>,
}

impl Body {
    /// A body on which no torque acts.
    pub fn free(inertia: Inertia) -> Self {
        Body { inertia, gravity: None }
    }

    /// A body with a fixed point, the origin, under uniform gravity along −Z of space.
    ///
    /// `inertia` is about the fixed point; `weight_moment` is the weight M g times the centre of mass, N m, in body
    /// axes. The potential is U = c·Γ and the torque Γ × c, Γ = Qᵀ e_z. Without weight moment the body is free.
    ///
    /// # Errors
    /// Components that are not finite, or a size that no double has beside the inertia.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::body::{Body, Inertia};
    /// let top = Body::heavy(Inertia::from_moments([1.0, 1.0, 0.25])?, Vector3::new(0.0, 0.0, 2.0))?;
    /// let start = top.state(UnitQuaternion::identity(), Vector3::new(0.0, 0.0, 4.0))?;
    /// assert_eq!(top.energy(&top.enter(&start)?), 4.0); // 2 J of spin, 2 J of height
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn heavy(inertia: Inertia, weight_moment: Vector3<f64>) -> Result<Self, StateError> {
        let given = Vec3::from(weight_moment);
        check("weight moment", &given.0)?;
        if given == Vec3::zero() {
            return Ok(Body::free(inertia));
        }
        let scaled = Vec3(given.0.map(|c| c / inertia.scale()));
        if !clear(scaled.magnitude()) {
            let (weight_moment, moment) = (given.magnitude(), inertia.scale());
            return Err(StateError::WeightOutOfRange { weight_moment, moment });
        }
        let weight_moment = inertia.frame().rotate_back(Vec3::of(scaled));
        Ok(Body { inertia, gravity: Some(Gravity { weight_moment }) })
    }

    /// Its inertia.
    pub fn inertia(&self) -> &Inertia {
        &self.inertia
    }

    /// Gravity along a kernel's axes and in its scale; `None` for a free body.
    pub fn gravity<S: Real>(&self) -> Option<Gravity<S>> {
        self.gravity.map(|g| Gravity { weight_moment: Vec3(g.weight_moment.0.map(of_dd)) })
    }

    /// Kinetic and potential energy, J, of a kernel's state.
    pub fn energy<S: Precise>(&self, x: &State<S>) -> f64 {
        let x = State {
            attitude: Quat::from_components(x.attitude.components().map(S::to_dd)),
            momentum_body: Vec3(x.momentum_body.0.map(S::to_dd)),
        };
        self.scaled_energy(&x).hi() * self.scale()
    }

    /// ½ m·I⁻¹m + U in a kernel's scale.
    pub(crate) fn scaled_energy(&self, x: &State<Dd>) -> Dd {
        let m = x.momentum_body;
        let kinetic = m.times(self.inverse_moments()).dot(m) * Dd::of(0.5);
        match self.gravity {
            Some(gravity) => kinetic + gravity.potential(x.attitude),
            None => kinetic,
        }
    }

    /// The state with angular velocity `omega_body` (rad/s, body axes): m = I ω.
    ///
    /// # Errors
    /// Components that are not finite, a quaternion of zeros, or a spin whose energy is no finite double.
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

    /// The exact state with angular velocity `omega_body` as kernels see it; the attitude may have any norm but zero.
    ///
    /// # Errors
    /// As [`state`](Self::state).
    pub fn enter_omega(&self, attitude: Quat<f64>, omega_body: Vec3<f64>) -> Result<State<Dd>, StateError> {
        let largest = check_attitude(attitude)?;
        check("angular velocity", &omega_body.0)?;
        // the power of two keeps the squares in range
        let near_one = attitude.components().map(|x| libm::scalbn(x, -libm::ilogb(largest)));
        let inside = State {
            attitude: Quat::of(Quat::from_components(near_one)).normalized() * self.inertia.frame(),
            momentum_body: self.inertia.scaled_momentum(omega_body),
        };
        let value = omega_body.magnitude();
        let error = StateError::OutOfRange { quantity: "angular velocity", value, unit: "rad/s" };
        if self.is_in_range(&inside) { Ok(inside) } else { Err(error) }
    }

    /// The state `x` (body axes) as kernels see it: principal axes, divided by the power of two.
    ///
    /// # Errors
    /// As [`state`](Self::state).
    pub fn enter(&self, x: &State<f64>) -> Result<State<Dd>, StateError> {
        check_attitude(x.attitude)?;
        check("momentum", &x.momentum_body.0)?;
        let (frame, scale) = (self.inertia.frame(), self.inertia.scale());
        let momentum = Vec3(x.momentum_body.0.map(|m| Dd::of(m / scale)));
        let inside =
            State { attitude: Quat::of(x.attitude) * frame, momentum_body: frame.rotate_back(momentum) };
        let value = x.momentum_body.magnitude();
        let error = StateError::OutOfRange { quantity: "momentum", value, unit: "kg m^2/s" };
        if self.is_in_range(&inside) { Ok(inside) } else { Err(error) }
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

    /// Whether the energy is a double, with room for the errors of its products.
    fn is_in_range(&self, inside: &State<Dd>) -> bool {
        let omega = inside.momentum_body.times(self.inverse_moments());
        let twice_energy = inside.momentum_body.dot(omega).hi();
        let energy = twice_energy * self.inertia.scale();
        let clear = |x: f64| x == 0.0 || clear(x);
        let at_rest = omega.0.iter().all(|w| w.hi() == 0.0);
        clear(twice_energy) && clear(energy) && (at_rest || energy != 0.0)
    }
}

/// Dekker products of squares need the exponent to stay clear of both ends.
fn clear(x: f64) -> bool {
    (1e-240..1e240).contains(&x.abs())
}

/// A double-double in any scalar, rounded once where it has fewer digits.
pub(crate) fn of_dd<S: Real>(x: Dd) -> S {
    S::of(x.hi()) + S::of(x.lo())
}

/// The largest component.
fn check_attitude(attitude: Quat<f64>) -> Result<f64, StateError> {
    check("attitude", &attitude.components())?;
    let largest = attitude.magnitude();
    if largest > 0.0 { Ok(largest) } else { Err(StateError::NoAttitude) }
}

fn check(quantity: &'static str, components: &[f64]) -> Result<(), StateError> {
    match components.iter().find(|value| !value.is_finite()) {
        Some(&value) => Err(StateError::NotFinite { quantity, value }),
        None => Ok(()),
    }
}
