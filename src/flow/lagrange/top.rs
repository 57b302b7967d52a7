//! Lagrange's top: a symmetric heavy body, its motion at any time.

use std::sync::OnceLock;

use nalgebra::{UnitQuaternion, Vector3};
use thiserror::Error;

use super::derivative::Derivative;
use super::nutation::Nutation;
use super::theta::Theta;
use crate::body::{Body, Exit, Point, State, StateError};
use crate::flow::free::reduce;
use crate::flow::reach::{MOST_RADIANS, TimeError};
use crate::num::{Dd, Precise, Real, Shown};
use crate::rotation::{Quat, Vec3};

/// What may be rounding in equal moments (of their sum) and in the direction of the weight moment.
const ROUNDING: f64 = 1e-12;

/// Weight moment over moment of inertia and squared angular velocity, below which cubes leave the range of a double.
const WEAKEST: f64 = 1e-80;

/// Deviation from rest on the vertical, below which its fourth powers have no digits.
const UPRIGHT: f64 = 1e-70;

/// Why a body is not a Lagrange top, or its motion is out of range.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum LagrangeError {
    /// There is no weight moment.
    #[error("the body has no weight moment; use the exact motion of a free body")]
    Free,
    /// No two principal moments agree.
    #[error(
        "principal moments {}, {}, {}: a Lagrange top has two equal ones; here the closest differ by {:.3e} of their sum (at \
         most {ROUNDING:e} is allowed)",
        Shown(moments[0]), Shown(moments[1]), Shown(moments[2]), relative
    )]
    NotSymmetric {
        /// The principal moments, in the order of the principal axes of the solver frame.
        moments: [f64; 3],
        /// Smallest difference over the sum.
        relative: f64,
    },
    /// The weight moment is not on the symmetry axis.
    #[error(
        "the weight moment is {angle:.3e} rad away from the symmetry axis (at most {ROUNDING:e} is allowed); that of a Lagrange top lies on the axis"
    )]
    OffAxis {
        /// Angle between weight moment and symmetry axis, rad.
        angle: f64,
    },
    /// The weight is negligible beside the spin: terms of the solution leave the range of a double.
    #[error(
        "the weight moment is {ratio:.1e} of moment of inertia times squared angular velocity (at least {WEAKEST:e} is needed): \
         too small for the closed form; leave it out"
    )]
    Weak {
        /// |c|/(A ω²), ω the fastest part of m/A.
        ratio: f64,
    },
    /// The axis is all but at rest on the vertical.
    #[error(
        "the axis starts {tilt:.1e} away from rest on the vertical, too close for the closed form; give 0 or at least \
         {UPRIGHT:e}"
    )]
    Upright {
        /// Largest of the quaternion's components that would be zero and of angular velocity over the fastest rate.
        tilt: f64,
    },
    /// Something else acts besides gravity.
    #[error("{force} acts on the body besides uniform gravity; on a Lagrange top only its weight acts")]
    Forced {
        /// Name of the force.
        force: String,
    },
    /// The start is not usable.
    #[error(transparent)]
    State(#[from] StateError),
}

/// The motion of one symmetric heavy top from one start: constants worked out once, then any time in O(1).
///
/// The sleeping top, starts and passages through the vertical, turning points and the separatrix of the sleeping top
/// are ordinary starts. The weight may be on either side of the fixed point, and a body of spherical inertia may have
/// its weight moment in any direction.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::Body;
/// use polhode::inertia::Inertia;
/// use polhode::flow::LagrangeTop;
///
/// let body = Body::heavy(Inertia::from_moments([1.25, 1.25, 0.75])?, Vector3::new(0.0, 0.0, 2.0))?;
/// let tilted = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.5);
/// let top = LagrangeTop::from_omega(&body, tilted, Vector3::new(0.0, 0.0, 20.0))?;
/// let later = top.at(1e6)?;
/// assert!((later.momentum().z - 15.0).abs() < 1e-12); // the spin about the axis stays
/// let [upper, lower] = top.turning_points();
/// assert!((upper - 0.5).abs() < 1e-12 && lower > upper); // it falls from the cusp
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct LagrangeTop {
    pub(super) body: Body,
    /// Takes coordinates with e₃ along the weight moment to the solver frame.
    pub(super) frame: Quat<Dd>,
    pub(super) transverse: Dd, // A
    pub(super) axial: Dd,      // C
    pub(super) weight: Dd,     // |c|
    /// With e₃ along the weight moment.
    pub(super) start: Point<Dd>,
    pub(super) motion: Motion,
    reach: f64,
    pub(super) derivative: OnceLock<Box<Derivative>>,
}

#[derive(Clone, Debug)]
pub(super) enum Motion {
    /// The axis rests on the vertical: upright, asleep or about to fall, or hanging.
    Vertical,
    /// In units of time of 2^`unit` s, in which the fastest rate is near 1; the quick form but on the separatrix of the
    /// sleeping top.
    Nutating { nutation: Box<Nutation>, unit: i32, quick: Option<Box<Theta>> },
}

impl LagrangeTop {
    /// From the attitude and the angular velocity (rad/s, body axes) at t = 0; the product I ω is formed exactly.
    ///
    /// # Errors
    /// A body that is not a Lagrange top, with the condition that fails and by how much; components that are not
    /// finite, or an energy outside the range of a double; a weight that is too weak beside the spin, or a start too
    /// near to rest on the vertical.
    pub fn from_omega(
        body: &Body,
        attitude: UnitQuaternion<f64>,
        omega_body: Vector3<f64>,
    ) -> Result<Self, LagrangeError> {
        Self::from_point(body, body.enter_omega(attitude.into(), omega_body.into())?)
    }

    /// From a state at t = 0, body axes.
    ///
    /// # Errors
    /// As [`from_omega`](Self::from_omega).
    pub fn from_state(body: &Body, start: &State) -> Result<Self, LagrangeError> {
        Self::from_point(body, body.enter(start)?)
    }

    /// From a point of the solver frame at t = 0.
    ///
    /// # Errors
    /// A body that is not a Lagrange top, a weight that is too weak or a start too near to rest on the vertical.
    pub fn from_point(body: &Body, start: Point<Dd>) -> Result<Self, LagrangeError> {
        if let Some(force) = body.remainder().next() {
            return Err(LagrangeError::Forced { force: force.name().into() });
        }
        if !body.wheels().is_empty() {
            return Err(LagrangeError::Forced { force: "the momentum of wheels".into() });
        }
        let weight_moment = body.linear_potential::<Dd>().ok_or(LagrangeError::Free)?.moment;
        let (axis, transverse, axial) = symmetry_axis(body, weight_moment)?;
        let frame = turn_to(axis);
        let weight = weight_moment.norm_of_any_size();
        let attitude = start.attitude.normalized() * frame;
        let momentum_body = frame.rotate_back(start.momentum_body);
        let start = Point::new(attitude, momentum_body);

        let ([m1, m2, _], Quat { w, v }) = (momentum_body.0, attitude);
        let upright = v[0].magnitude().max(v[1].magnitude());
        let hanging = w.magnitude().max(v[2].magnitude());
        let across = m1.magnitude().max(m2.magnitude());
        let motion = if upright.min(hanging) == 0.0 && across == 0.0 {
            Motion::Vertical
        } else {
            let b = weight * Dd::of(2.0) / transverse;
            let omega = momentum_body * (Dd::ONE / transverse);
            let falling = (weight / transverse).sqrt().hi();
            let fastest = falling.max(omega.magnitude());
            let slowness = falling / omega.magnitude();
            if slowness * slowness < WEAKEST {
                return Err(LagrangeError::Weak { ratio: slowness * slowness });
            }
            let tilt = upright.min(hanging).max(omega[0].magnitude().max(omega[1].magnitude()) / fastest);
            if tilt < UPRIGHT {
                return Err(LagrangeError::Upright { tilt });
            }
            let unit = -libm::ilogb(fastest);
            let omega = omega.map(|rate| rate.scaled(unit));
            let nutation = Box::new(Nutation::new(b.scaled(2 * unit), attitude, omega));
            let spin = momentum_body[2] / axial - momentum_body[2] / transverse;
            let quick = Theta::new(&nutation, transverse, spin, unit).map(Box::new);
            Motion::Nutating { nutation, unit, quick }
        };
        let smaller = if axial < transverse { axial } else { transverse };
        let omega = Vec3([m1 / transverse, m2 / transverse, momentum_body[2] / smaller]);
        let fastest = omega.norm_of_any_size().hi() + (weight / transverse).sqrt().hi();
        let reach = MOST_RADIANS / fastest;
        let derivative = OnceLock::new();
        Ok(LagrangeTop {
            body: body.clone(),
            frame,
            transverse,
            axial,
            weight,
            start,
            motion,
            reach,
            derivative,
        })
    }

    /// The body that moves.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The state at time `t` (s, of either sign), body axes.
    ///
    /// # Errors
    /// A time that is not finite, or beyond [`reach`](Self::reach).
    pub fn at(&self, t: f64) -> Result<State, TimeError> {
        TimeError::check(t, self.reach())?;
        Ok(self.body.leave(&self.point_at(t)))
    }

    /// The largest |t| at which the phases still have digits, s: some 2⁹⁶ rad.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// The states at many `times`, body axes.
    ///
    /// # Errors
    /// As [`at`](Self::at), of the first time that has no state.
    pub fn at_many(&self, times: &[f64]) -> Result<Vec<State>, TimeError> {
        times.iter().map(|&t| self.at(t)).collect()
    }

    /// Gives `each` the states at many `times` with their angular velocities, rad/s, body axes, in order: the bits of
    /// [`at`](Self::at).
    ///
    /// # Errors
    /// As [`at_many`](Self::at_many); `each` is not called then.
    pub fn each_at(&self, times: &[f64], mut each: impl FnMut(State, Vector3<f64>)) -> Result<(), TimeError> {
        times.iter().try_for_each(|&t| TimeError::check(t, self.reach()))?;
        let (exit, inverse_moments) = (Exit::of(&self.body), self.body.rotor().inverse_moments());
        for &t in times {
            let x = self.point_at(t);
            each(exit.state(x.phase()), exit.omega(inverse_moments, x.momentum_body));
        }
        Ok(())
    }

    /// The point of the solver frame at time `t` (s), finite and within [`reach`](Self::reach).
    ///
    /// By theta functions, with phases reduced in double-double; on the separatrix of the sleeping top and after 2⁴³ turns by
    /// Carlson's integrals. The quaternion is the continuous lift from the start.
    #[inline]
    pub fn point_at(&self, t: f64) -> Point<f64> {
        self.placed(self.along_axis(t))
    }

    /// Attitude and momentum of [`point_at`](Self::point_at) in coordinates with e₃ along the weight moment.
    #[inline]
    pub(super) fn along_axis(&self, t: f64) -> (Quat<f64>, Vec3<f64>) {
        let quick = match &self.motion {
            Motion::Nutating { quick: Some(quick), .. } => quick.at(t),
            _ => None,
        };
        match quick {
            Some((attitude, [m1, m2])) => (attitude, Vec3([m1, m2, self.start.momentum_body[2].hi()])),
            None => self.evaluate(Dd::from(t)),
        }
    }

    /// The same at a time in double-double.
    pub(crate) fn point_after(&self, t: Dd) -> Point<f64> {
        if t.lo() == 0.0 { self.point_at(t.hi()) } else { self.placed(self.evaluate(t)) }
    }

    /// The same in double-double, by Carlson's integrals.
    pub fn point_at_dd(&self, t: Dd) -> Point<Dd> {
        self.placed(self.evaluate(t))
    }

    #[inline]
    pub(super) fn placed<S: Precise>(&self, (attitude, momentum): (Quat<S>, Vec3<S>)) -> Point<S> {
        let frame = self.frame.map(S::from_dd);
        Point::new(attitude * frame.conjugate(), frame.rotate(momentum))
    }

    fn evaluate<S: Precise>(&self, t: Dd) -> (Quat<S>, Vec3<S>) {
        let m3 = self.start.momentum_body[2];
        let turn = |rate: Dd| {
            let (sin, cos) = S::from_dd(reduce(rate * t, Dd::TAU * 2.0) * Dd::of(0.5)).sin_cos();
            Quat::new(cos, Vec3::unit(2) * sin)
        };
        match &self.motion {
            Motion::Vertical => {
                let q = self.start.attitude.map(S::from_dd);
                (q * turn(m3 / self.axial), self.start.momentum_body.map(S::from_dd))
            }
            Motion::Nutating { nutation, unit, .. } => {
                let spin = turn(m3 / self.axial - m3 / self.transverse);
                let (q, q_rate) = nutation.at::<S>(t.scaled(-unit));
                let mut m = (q.conjugate() * q_rate).v * S::from_dd((self.transverse * 2.0).scaled(-unit));
                m[2] = S::from_dd(m3);
                (q * spin, spin.rotate_back(m))
            }
        }
    }

    /// Smallest and largest tilt of the weight moment from the vertical, rad.
    #[must_use]
    pub fn turning_points(&self) -> [f64; 2] {
        let tilt = |(x, y): (Dd, Dd)| (positive_root(y).atan2(positive_root(x)) * 2.0).hi();
        match &self.motion {
            Motion::Vertical => {
                let up = self.start.attitude.w.hi() != 0.0 || self.start.attitude.v[2].hi() != 0.0;
                [if up { 0.0 } else { core::f64::consts::PI }; 2]
            }
            Motion::Nutating { nutation, .. } => {
                let [lowest, highest] = nutation.turning_points();
                [tilt(highest), tilt(lowest)]
            }
        }
    }

    /// Time from one largest tilt to the next, s; `None` where the axis does not come back: on the vertical and on
    /// the separatrix of the sleeping top.
    #[must_use]
    pub fn nutation_period(&self) -> Option<f64> {
        match &self.motion {
            Motion::Vertical => None,
            Motion::Nutating { nutation, unit, .. } => {
                nutation.period().map(|period| period.scaled(*unit).hi())
            }
        }
    }

    /// Advance of the azimuth φ over one [nutation](Self::nutation_period), rad. Where the axis passes through the
    /// vertical, φ jumps there by π, by convention forwards.
    pub fn precession_per_nutation(&self) -> Option<f64> {
        match &self.motion {
            Motion::Vertical => None,
            Motion::Nutating { nutation, .. } => nutation.precession().map(Dd::hi),
        }
    }

    /// Potential energy, J, of the motion in the tilt θ (rad) alone: with ½ A θ'² it sums to the energy.
    ///
    /// `(p_φ − p_ψ cos θ)²/(2 A sin²θ) + p_ψ²/(2 C) + |c| cos θ`; infinite at the poles that cannot be reached.
    #[must_use]
    pub fn effective_potential(&self, tilt: f64) -> f64 {
        let m = self.start.momentum_body;
        let up = self.start.attitude.rotate_back(Vec3::unit(2));
        let (vertical, along) = (m.dot(up), m[2]);
        let (sin, cos) = Dd::of(tilt).sin_cos();
        let off = vertical - along * cos;
        let turning =
            if off.hi() == 0.0 { Dd::ZERO } else { off * off / (self.transverse * sin * sin * 2.0) };
        let energy = turning + along * along / (self.axial * 2.0) + self.weight * cos;
        energy.hi() * self.body.scale()
    }
}

/// Unit vector along the weight moment, transverse and axial moment.
fn symmetry_axis(body: &Body, weight_moment: Vec3<Dd>) -> Result<(Vec3<Dd>, Dd, Dd), LagrangeError> {
    let i = body.rotor().moments::<Dd>();
    let direction = weight_moment * (Dd::ONE / weight_moment.norm_of_any_size());
    let trace = i[0] + i[1] + i[2];
    let apart = |axis: usize| ((i[(axis + 1) % 3] - i[(axis + 2) % 3]) / trace).magnitude();
    let mean = |axis: usize| (i[(axis + 1) % 3] + i[(axis + 2) % 3]) * 0.5;
    if (0..3).all(|axis| apart(axis) <= ROUNDING) {
        let moment = trace / 3.0;
        return Ok((direction, moment, moment));
    }
    let mut axis = 0;
    for other in 1..3 {
        if apart(other) < apart(axis) {
            axis = other;
        }
    }
    if apart(axis) > ROUNDING {
        let moments = i.0.map(|moment| moment.hi() * body.scale());
        return Err(LagrangeError::NotSymmetric { moments, relative: apart(axis) });
    }
    let across = direction.cross(Vec3::unit(axis)).norm();
    if across.hi() > ROUNDING {
        return Err(LagrangeError::OffAxis { angle: across.atan2(direction[axis].abs()).hi() });
    }
    let sign = if direction[axis] < Dd::ZERO { -Dd::ONE } else { Dd::ONE };
    Ok((Vec3::unit(axis) * sign, mean(axis), i[axis]))
}

/// A turn that takes e₃ to the unit vector `direction`: in the upper half the shortest. In the lower half, where the
/// shortest has no digits near −e₃, a half turn about e₁ follows the shortest turn to the mirrored direction.
fn turn_to(direction: Vec3<Dd>) -> Quat<Dd> {
    let [x, y, z] = direction.0;
    if z < Dd::ZERO {
        return Quat::new(Dd::ZERO, Vec3::unit(0)) * turn_to(Vec3([x, -y, -z]));
    }
    Quat::new(z + 1.0, Vec3::unit(2).cross(direction)).normalized()
}

fn positive_root(x: Dd) -> Dd {
    if x > Dd::ZERO { x.sqrt() } else { Dd::ZERO }
}
