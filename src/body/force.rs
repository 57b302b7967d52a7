//! Forces as values: potentials and torques, those built in and a user's own.
//!
//! All quantities are in SI units, or any consistent ones, and in the body axes that the inertia was given in; what a
//! kernel reads in the solver frame is made of them by [`Body`](super::Body).

use core::fmt;
use std::sync::Arc;

use nalgebra::{UnitQuaternion, Vector3};

use super::drag::Drag;
use super::law::{Conserved, Law, Potential, SeriesLaw, Torque};
use super::orbit::Orbit;
use super::switched::Switched;
use super::{ForceError, Time};
use crate::inertia::Inertia;
use crate::num::{Dd, Precise, Series};
use crate::rotation::{Quat, Vec3};

/// A potential or a torque with its name, which acts on a [`Body`](super::Body).
#[derive(Clone)]
#[must_use]
pub struct Force {
    pub(super) name: String,
    pub(crate) law: Law,
    /// The same law on power series; none of a closure.
    pub(crate) series: Option<SeriesLaw>,
    /// Of a gravity gradient, which takes the tensor of the body that it acts on.
    pub(super) orbit: Option<Orbit>,
    /// Of drag.
    pub(super) drag: Option<Drag>,
    /// Of a force that does not act always.
    pub(super) switched: Option<Switched>,
}

impl Force {
    /// The potential `potential`, called `name` in messages.
    pub fn potential<P>(name: impl Into<String>, potential: P) -> Self
    where
        P: Potential<f64> + Potential<Dd> + Potential<Series<f64>> + Potential<Series<Dd>> + 'static,
    {
        let law = Arc::new(potential);
        let series = Some(SeriesLaw::Potential(law.clone()));
        Force { name: name.into(), law: Law::Potential(law), series, orbit: None, drag: None, switched: None }
    }

    /// The torque `torque`, called `name` in messages.
    pub fn torque<T>(name: impl Into<String>, torque: T) -> Self
    where
        T: Torque<f64> + Torque<Dd> + Torque<Series<f64>> + Torque<Series<Dd>> + 'static,
    {
        let law = Arc::new(torque);
        let series = Some(SeriesLaw::Torque(law.clone()));
        Force { name: name.into(), law: Law::Torque(law), series, orbit: None, drag: None, switched: None }
    }

    /// A potential by two closures of the attitude, body → space: energy in J, and torque in N m, body axes.
    ///
    /// The energy must not depend on the time, and equal attitudes must give equal values. If the energy error of a run does not
    /// shrink with the step, the torque does not belong to the energy. Both closures are computed in `f64`, also in runs in double-double.
    pub fn potential_fn<U, T>(name: impl Into<String>, energy: U, torque: T) -> Self
    where
        U: Fn(UnitQuaternion<f64>) -> f64 + Send + Sync + 'static,
        T: Fn(UnitQuaternion<f64>) -> Vector3<f64> + Send + Sync + 'static,
    {
        let law = Law::Potential(Arc::new(PotentialFn { energy, torque }));
        Force { name: name.into(), law, series: None, orbit: None, drag: None, switched: None }
    }

    /// A torque, N m, body axes, by a closure of the time (s), the attitude (body → space) and the angular velocity
    /// (rad/s, body axes), in `f64`. Equal arguments must give equal values.
    ///
    /// ```
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// use polhode::body::{Body, Force};
    /// use polhode::inertia::Inertia;
    /// use polhode::method::method;
    /// use polhode::run::Run;
    ///
    /// let thruster = Force::torque_fn("thruster", |t, _, _| Vector3::new(0.0, 0.0, if t < 1.0 { 0.5 } else { 0.0 }));
    /// let body = Body::free(Inertia::from_moments([1.0, 1.0, 2.0])?).with(thruster);
    /// let start = body.state(UnitQuaternion::identity(), Vector3::zeros())?;
    /// let end = Run::new(&method("rk4")?, &body, &start, 0.125)?.advance_to(8)?;
    /// assert!((end.omega_body.z - 0.25).abs() < 0.01); // the last stage, at t = 1 s, feels no push
    /// # Ok::<(), polhode::Error>(())
    /// ```
    pub fn torque_fn<T>(name: impl Into<String>, torque: T) -> Self
    where
        T: Fn(f64, UnitQuaternion<f64>, Vector3<f64>) -> Vector3<f64> + Send + Sync + 'static,
    {
        let law = Law::Torque(Arc::new(TorqueFn(torque)));
        Force { name: name.into(), law, series: None, orbit: None, drag: None, switched: None }
    }

    /// The same force, a gravity gradient on the orbit `orbit`.
    pub(super) fn on_orbit(self, orbit: Orbit) -> Self {
        Force { orbit: Some(orbit), ..self }
    }

    /// Of a gravity gradient on a conic that acts always, the conic.
    pub(super) fn conic(&self) -> Option<&Orbit> {
        self.orbit.as_ref().filter(|orbit| orbit.is_conic() && self.switched.is_none())
    }

    /// The same force as it acts on a body with the inertia `inertia`.
    pub(super) fn on(self, inertia: &Inertia) -> Self {
        match self.orbit.clone() {
            Some(orbit) => self.switch(Force::gradient_on(inertia.tensor(), orbit)),
            None => self,
        }
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What it conserves, acting alone; nothing for a torque that has no potential.
    #[must_use]
    pub fn conserved(&self) -> Vec<Conserved> {
        match &self.law {
            Law::Potential(potential) => Potential::<f64>::conserved(&**potential),
            Law::Torque(_) => Vec::new(),
        }
    }

    /// The moment of a potential that is linear in the vertical, N m, body axes.
    pub(super) fn linear_moment(&self) -> Option<Vec3<f64>> {
        match &self.law {
            Law::Potential(potential) => Potential::<f64>::linear_moment(&**potential),
            Law::Torque(_) => None,
        }
    }

    /// Whether it has a potential.
    #[must_use]
    pub(crate) fn has_potential(&self) -> bool {
        matches!(self.law, Law::Potential(_))
    }
}

impl fmt::Debug for Force {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let law = if self.has_potential() { "potential" } else { "torque" };
        write!(f, "Force({law} {:?})", self.name)
    }
}

/// `value` if it is a finite number.
pub(super) fn finite(force: &'static str, quantity: &'static str, value: f64) -> Result<f64, ForceError> {
    if value.is_finite() { Ok(value) } else { Err(ForceError::NotFinite { force, quantity, value }) }
}

struct PotentialFn<U, T> {
    energy: U,
    torque: T,
}

impl<S: Precise, U, T> Potential<S> for PotentialFn<U, T>
where
    U: Fn(UnitQuaternion<f64>) -> f64 + Send + Sync,
    T: Fn(UnitQuaternion<f64>) -> Vector3<f64> + Send + Sync,
{
    fn energy(&self, _: Time, attitude: Quat<S>) -> S {
        S::of((self.energy)(attitude.map(S::to_f64).into()))
    }
    fn torque(&self, _: Time, attitude: Quat<S>) -> Vec3<S> {
        Vec3::of((self.torque)(attitude.map(S::to_f64).into()).into())
    }
}

struct TorqueFn<T>(T);

impl<S: Precise, T> Torque<S> for TorqueFn<T>
where
    T: Fn(f64, UnitQuaternion<f64>, Vector3<f64>) -> Vector3<f64> + Send + Sync,
{
    fn torque(&self, at: Time, attitude: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        Vec3::of(
            (self.0)(at.seconds(), attitude.map(S::to_f64).into(), omega_body.map(S::to_f64).into()).into(),
        )
    }
}
