//! All forces on a body, in the solver frame, in the form that integrators call.

use std::sync::{Arc, OnceLock};

use nalgebra::Matrix3;

use super::gravity_gradient::{GravityGradient, gradient_torque};
use super::law::Evaluated;
use super::{Force, LinearPotential, Orbit, Place, Time};
use crate::num::{Dd, Real, Series, Tape};
use crate::rotation::{Quat, Vec3};

/// The torque of everything that acts on a body, along its principal axes, in N m divided by
/// [`Body::scale`](super::Body::scale). The attitude is principal axes → space, the angular velocity in rad/s along principal
/// axes. Maps are compiled for each kind.
pub trait Field<S: Real>: Clone + Send + Sync + 'static {
    /// Whether anything acts at all.
    const ACTS: bool = true;

    /// Whether anything acts besides the linear part.
    const HAS_REMAINDER: bool = true;

    /// The linear part: the sum of the potentials that are linear in the vertical.
    fn linear_part(&self) -> Option<&LinearPotential<S>>;

    /// The torque of all the rest.
    fn remainder(&self, at: Time, attitude: Quat<S>, omega_body: Vec3<S>) -> Vec3<S>;

    /// Of a gravity gradient of the rest, on a body with the moments of the rotor: its orbit, a conic, and which force it is, counted from 0.
    #[inline]
    fn gradient(&self) -> Option<(usize, &Orbit)> {
        None
    }

    /// Whether the rest is more than the [`gradient`](Self::gradient).
    #[inline]
    fn has_series(&self) -> bool {
        Self::HAS_REMAINDER
    }

    /// The torque of the rest but for the [`gradient`](Self::gradient) on power series, each force a part of the
    /// [tape](crate::num::Tape); `None` where a force cannot be evaluated on them.
    #[inline]
    fn remainder_series(&self, _: Time, _: Quat<Series<S>>, _: Vec3<Series<S>>) -> Option<Vec3<Series<S>>> {
        None
    }

    /// Takes note that the series of one of the forces of the rest, counted from 0, is not finite about the time `at`.
    fn not_finite(&self, _: Time, _force: usize) {}

    /// The whole torque, divided by the scale.
    #[inline]
    fn torque(&self, at: Time, attitude: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        let rest = self.remainder(at, attitude, omega_body);
        self.linear_part().map_or(rest, |linear| linear.torque(attitude) + rest)
    }

    /// The time `at`, with what the torque takes from it alone: stages of a step that share a time share this, and it does not wait
    /// for their attitudes.
    #[doc(hidden)]
    #[inline(always)]
    fn instant(&self, at: Time) -> Instant<S> {
        Instant { at, place: None }
    }

    /// As [`torque`](Self::torque), at an [`instant`](Self::instant).
    #[doc(hidden)]
    #[inline(always)]
    fn torque_at(&self, instant: &Instant<S>, attitude: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        self.torque(instant.at, attitude, omega_body)
    }
}

/// A time, and where a gravity gradient has the body then.
#[derive(Clone, Copy, Debug)]
pub struct Instant<S> {
    at: Time,
    place: Option<Place<S>>,
}

/// Nothing acts: free motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Free;

impl<S: Real> Field<S> for Free {
    const ACTS: bool = false;
    const HAS_REMAINDER: bool = false;
    #[inline]
    fn linear_part(&self) -> Option<&LinearPotential<S>> {
        None
    }
    #[inline]
    fn remainder(&self, _: Time, _: Quat<S>, _: Vec3<S>) -> Vec3<S> {
        Vec3::zero()
    }
}

impl<S: Real> Field<S> for LinearPotential<S> {
    const HAS_REMAINDER: bool = false;
    #[inline]
    fn linear_part(&self) -> Option<&LinearPotential<S>> {
        Some(self)
    }
    #[inline]
    fn remainder(&self, _: Time, _: Quat<S>, _: Vec3<S>) -> Vec3<S> {
        Vec3::zero()
    }
    #[inline]
    fn torque(&self, _: Time, attitude: Quat<S>, _: Vec3<S>) -> Vec3<S> {
        LinearPotential::torque(self, attitude)
    }
}

/// The linear part in the solver frame, and all other forces, each evaluated in SI units and body axes.
#[derive(Clone, Debug)]
pub(crate) struct Forces<S> {
    linear: Option<LinearPotential<S>>,
    others: Arc<[Force]>,
    /// Which of them is a gravity gradient on a conic.
    gradient: Option<usize>,
    /// The gravity gradient, where it is the only one of them and acts always. Its torque is worked out in the step itself: handed on
    /// through memory, attitude and torque are waited for longer than it takes.
    alone: Option<Arc<GravityGradient>>,
    /// Takes coordinates along principal axes to body coordinates; `None` where they are the same.
    frame: Option<Quat<S>>,
    /// What divides the torque.
    scale: f64,
    witness: Option<Witness>,
}

/// Attitudes and angular velocities beyond this are those of a run that diverges: products of several of them overflow, and no
/// force is to blame.
const OUT_OF_RANGE: f64 = 1e60;

/// The first evaluation of a force that was not finite.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Failure {
    /// Name of the force.
    pub(crate) force: String,
    /// When, s.
    pub(crate) time: f64,
}

/// Takes note of the first force that is not finite at a state of a body.
pub(crate) type Witness = Arc<OnceLock<Failure>>;

impl<S: Evaluated> Forces<S> {
    /// `tensor`, kg m², body axes, is that of the rotor where there is no other inertia, of wheels which turn freely.
    pub(super) fn new(
        linear: Option<LinearPotential<S>>,
        others: impl Iterator<Item = Force>,
        frame: Option<Quat<Dd>>,
        scale: f64,
        tensor: Option<Matrix3<f64>>,
        witness: Option<Witness>,
    ) -> Self {
        let frame = frame.map(|frame| frame.map(S::from_dd));
        let others: Arc<[Force]> = others.collect();
        let gradient = others.iter().position(|force| tensor.is_some() && force.conic().is_some());
        let alone = match (&*others, tensor, &witness) {
            ([force], Some(tensor), None) if force.switched.is_none() => {
                force.orbit.clone().map(|orbit| Arc::new(GravityGradient { tensor, orbit }))
            }
            _ => None,
        };
        Forces { linear, others, gradient, alone, frame, scale, witness }
    }

    /// Potential energy, divided by the scale.
    pub(crate) fn energy(&self, at: Time, attitude: Quat<S>) -> S {
        let linear = self.linear.map_or(S::of(0.0), |linear| linear.energy(attitude));
        if self.others.is_empty() { linear } else { linear + self.remainder_energy(at, attitude) }
    }

    /// Potential energy of all but the linear part, divided by the scale.
    pub(super) fn remainder_energy(&self, at: Time, attitude: Quat<S>) -> S {
        let attitude = self.frame.map_or(attitude, |frame| attitude * frame.conjugate());
        let mut energy = S::of(0.0);
        for force in self.others.iter() {
            energy = energy + S::energy(&force.law, at, attitude);
        }
        energy * S::of(1.0 / self.scale)
    }

    /// The sum of what `evaluate` gives of each force, in SI units and body axes.
    #[inline]
    fn sum<T: Real>(
        &self,
        at: Time,
        frame: Option<Quat<T>>,
        attitude: Quat<T>,
        omega_body: Vec3<T>,
        evaluate: impl Fn(&Force, Quat<T>, Vec3<T>) -> Option<Vec3<T>>,
    ) -> Option<Vec3<T>> {
        let (attitude, omega_body) = match frame {
            Some(frame) => (attitude * frame.conjugate(), frame.rotate(omega_body)),
            None => (attitude, omega_body),
        };
        let mut torque = Vec3::zero();
        for force in self.others.iter() {
            let one = evaluate(force, attitude, omega_body)?;
            if self.witness.is_some()
                && !one.magnitude().is_finite()
                && attitude.magnitude() <= OUT_OF_RANGE
                && omega_body.magnitude() <= OUT_OF_RANGE
            {
                self.note(at, force);
            }
            torque = torque + one;
        }
        let torque = frame.map_or(torque, |frame| frame.rotate_back(torque));
        Some(torque * T::of(1.0 / self.scale))
    }

    fn note(&self, at: Time, force: &Force) {
        if let Some(witness) = &self.witness {
            witness.get_or_init(|| Failure { force: force.name().into(), time: at.seconds() });
        }
    }
}

impl<S: Evaluated> Field<S> for Forces<S> {
    #[inline]
    fn linear_part(&self) -> Option<&LinearPotential<S>> {
        self.linear.as_ref()
    }

    #[inline(always)]
    fn torque(&self, at: Time, attitude: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        self.torque_at(&self.instant(at), attitude, omega_body)
    }

    #[inline(always)]
    fn instant(&self, at: Time) -> Instant<S> {
        // in double-double the code would be long, and the arithmetic is what is waited for
        let alone = if const { S::ROUNDOFF < f64::ROUNDOFF } { None } else { self.alone.as_ref() };
        Instant { at, place: alone.map(|gradient| gradient.orbit.at(at)) }
    }

    #[inline(always)]
    fn torque_at(&self, instant: &Instant<S>, attitude: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        let rest = match (&self.alone, &instant.place) {
            (Some(gradient), Some(place)) => {
                // operation by operation as in the sum over all
                let attitude = self.frame.map_or(attitude, |frame| attitude * frame.conjugate());
                let torque = Vec3::zero() + gradient_torque(&gradient.tensor, place, attitude);
                self.frame.map_or(torque, |frame| frame.rotate_back(torque)) * S::of(1.0 / self.scale)
            }
            _ => self.remainder(instant.at, attitude, omega_body),
        };
        self.linear.map_or(rest, |linear| linear.torque(attitude) + rest)
    }

    #[inline(never)]
    fn remainder(&self, at: Time, attitude: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        let evaluate = |force: &Force, attitude, omega| Some(S::torque(&force.law, at, attitude, omega));
        self.sum(at, self.frame, attitude, omega_body, evaluate).unwrap_or(Vec3::zero())
    }

    fn gradient(&self) -> Option<(usize, &Orbit)> {
        let force = self.gradient?;
        Some((force, self.others.get(force)?.conic()?))
    }

    fn has_series(&self) -> bool {
        self.others.len() > usize::from(self.gradient.is_some())
    }

    fn remainder_series(
        &self,
        at: Time,
        attitude: Quat<Series<S>>,
        omega_body: Vec3<Series<S>>,
    ) -> Option<Vec3<Series<S>>> {
        let frame = self.frame.map(|frame| frame.map(Series::number));
        let gradient = self.gradient.and_then(|k| self.others.get(k));
        let evaluate = |force: &Force, attitude, omega| {
            let is_gradient = gradient.is_some_and(|gradient| core::ptr::eq(gradient, force));
            let law = force.series.as_ref();
            let torque = match is_gradient {
                true => Some(Vec3::zero()),
                false => law.map(|law| S::series(law, at, attitude, omega)),
            };
            Tape::<S>::end_part();
            torque
        };
        self.sum(at, frame, attitude, omega_body, evaluate)
    }

    fn not_finite(&self, at: Time, force: usize) {
        if let Some(force) = self.others.get(force) {
            self.note(at, force);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Body, Clock};
    use crate::inertia::Inertia;

    /// A gravity gradient alone has the bits that it has in the sum over all forces, on every kind of orbit, along principal axes and
    /// not, with a weight beside it and without.
    #[test]
    fn a_gradient_alone_is_that_of_the_sum() {
        let tensor = Matrix3::new(1.0, 0.2, -0.1, 0.2, 2.3, 0.05, -0.1, 0.05, 2.9);
        let inertias = [Inertia::from_moments([1.0, 2.3, 2.9]), Inertia::from_tensor(tensor)];
        let bodies = inertias.map(Result::unwrap).map(|inertia| {
            [Body::free(inertia.clone()), Body::heavy(inertia, [0.3, -0.2, 0.7].into()).unwrap()]
        });
        let tilted = Orbit::conic(0.7, 2.0, 1.4).unwrap().in_plane([0.3, 0.8, 1.1]).unwrap();
        let orbits = [Orbit::ellipse(0.31, 0.0).unwrap(), Orbit::ellipse(0.2, 0.7).unwrap(), tilted];
        for body in bodies.as_flattened() {
            for orbit in &orbits {
                let body = body.clone().with(Force::gravity_gradient_on(orbit.clone()));
                let alone = body.field::<f64>();
                let summed = body.witnessed(Witness::default()).field::<f64>();
                assert!(alone.alone.is_some() && summed.alone.is_none());
                for n in 0..100 {
                    let at = Clock::new(0.3).at(n / 2).later(Dd::of(0.15));
                    let q = Quat::exponential(Vec3([0.3, -0.1 * n as f64, 0.7]));
                    let [one, other] =
                        [&alone, &summed].map(|field| field.torque(at, q, Vec3::zero()).0.map(f64::to_bits));
                    assert_eq!(one, other, "{orbit:?} at {n}");
                }
            }
        }
    }
}
