//! All forces on a body, in the solver frame, in the form that integrators call.

use std::sync::{Arc, OnceLock};

use super::law::Evaluated;
use super::{Force, LinearPotential, Time};
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

    /// The same on power series, each force a part of the [tape](crate::num::Tape); `None` where a force cannot be evaluated on them.
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
    pub(super) fn new(
        linear: Option<LinearPotential<S>>,
        others: impl Iterator<Item = Force>,
        frame: Option<Quat<Dd>>,
        scale: f64,
        witness: Option<Witness>,
    ) -> Self {
        let frame = frame.map(|frame| frame.map(S::from_dd));
        Forces { linear, others: others.collect(), frame, scale, witness }
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

    #[inline(never)]
    fn remainder(&self, at: Time, attitude: Quat<S>, omega_body: Vec3<S>) -> Vec3<S> {
        let evaluate = |force: &Force, attitude, omega| Some(S::torque(&force.law, at, attitude, omega));
        self.sum(at, self.frame, attitude, omega_body, evaluate).unwrap_or(Vec3::zero())
    }

    fn remainder_series(
        &self,
        at: Time,
        attitude: Quat<Series<S>>,
        omega_body: Vec3<Series<S>>,
    ) -> Option<Vec3<Series<S>>> {
        let frame = self.frame.map(|frame| frame.map(Series::number));
        let evaluate = |force: &Force, attitude, omega| {
            let torque = force.series.as_ref().map(|law| S::series(law, at, attitude, omega));
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
