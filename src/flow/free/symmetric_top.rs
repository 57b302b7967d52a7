//! The free symmetric top: two turns.

use crate::body::{Point, Rotor, Time};
use crate::flow::{Casimir, Flow};
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// The exact flow of the free symmetric body, `T = |m|²/(2A) + ½ (1/C − 1/A) m_k²`.
///
/// Φ_t: a turn about the symmetry axis k at the rate `(1/C − 1/A) m_k`, which moves m on its cone in the body, then
/// one about m at the rate |m|/A, the precession in space. The two commute. t in seconds, moments and m in the units of the
/// [solver frame](crate::body::Rotor).
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::{Body, Time};
/// use polhode::flow::{Flow, SymmetricTop};
/// use polhode::inertia::Inertia;
/// let plate = Body::free(Inertia::from_moments([1.0, 1.0, 2.0])?);
/// let start = plate.state(UnitQuaternion::identity(), Vector3::new(0.5, 0.0, 1.0))?;
/// let mut x = plate.enter(&start)?.to_f64();
/// let top = SymmetricTop::new(&plate.rotor()).ok_or("no two moments are equal")?;
/// top.flow(Time::from_seconds(0.0), core::f64::consts::TAU, &mut x); // (1/C - 1/A) m_z = -1 rad/s
/// assert!((plate.leave(&x).momentum() - start.momentum()).norm() < 1e-15);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SymmetricTop<S> {
    axis: usize,
    half_spin: S,
    precession: Casimir<S>,
}

impl<S: Real> SymmetricTop<S> {
    /// The free flow of a body with the constants `rotor`; `None` unless two of its principal moments are equal, exactly.
    ///
    /// ```
    /// use polhode::body::Body;
    /// use polhode::inertia::Inertia;
    /// use polhode::flow::SymmetricTop;
    /// let plate = Body::free(Inertia::from_moments([1.0, 1.0, 2.0])?);
    /// assert!(SymmetricTop::<f64>::new(&plate.rotor()).is_some());
    /// # Ok::<(), polhode::inertia::InertiaError>(())
    /// ```
    #[must_use]
    pub fn new(rotor: &Rotor) -> Option<Self> {
        let moments = rotor.moments::<Dd>();
        let axis = (0..3).find(|axis| moments[(axis + 1) % 3] == moments[(axis + 2) % 3])?;
        Some(Self::with_moments(axis, moments[axis], moments[(axis + 1) % 3]))
    }

    /// The flow with the symmetry axis `AXIS` (0, 1 or 2), the moment `along` about it and `across` about all axes across,
    /// whether a body has these two or not.
    ///
    /// So it is a part of a body whose moments differ: with A one of the two across, a [turn](crate::flow::Turn) about the
    /// axis of the other is left, `T = T_top + ½ (1/B − 1/A) m_B²`.
    #[must_use]
    pub fn about<const AXIS: usize>(along: Dd, across: Dd) -> Self {
        const { assert!(AXIS < 3, "the axes are 0, 1 and 2") }
        Self::with_moments(AXIS, along, across)
    }

    fn with_moments(axis: usize, along: Dd, across: Dd) -> Self {
        let (along, across) = (Dd::ONE / along, Dd::ONE / across);
        let half_spin = S::from_dd((along - across) * 0.5);
        SymmetricTop { axis, half_spin, precession: Casimir::new(S::from_dd(across)) }
    }
}

impl<S: Real> Flow<S> for SymmetricTop<S> {
    #[inline]
    fn flow(&self, _: Time, t: S, x: &mut Point<S>) {
        let spin = Spun::by(self.half_angle(t, x));
        self.take(&spin, t, x);
    }
}

impl<S: Precise> SymmetricTop<S> {
    /// The same with the spin of the time before where its angle is the same, as it is in every step of a top.
    #[inline(always)]
    pub(super) fn flow_again(&self, t: S, last: &mut Option<Spun<S>>, x: &mut Point<S>) {
        let half = self.half_angle(t, x);
        let spin = match last {
            // a zero has a sign, which no comparison tells
            Some(spin) if spin.half == half && half != S::of(0.0) => spin,
            last => last.insert(Spun::by(half)),
        };
        self.take(spin, t, x);
    }
}

impl<S: Real> SymmetricTop<S> {
    /// Half the angle of the spin.
    #[inline(always)]
    fn half_angle(&self, t: S, x: &Point<S>) -> S {
        // no index: of an array that is indexed, nothing stays in registers
        let Vec3([first, second, third]) = x.momentum_body;
        let along = match self.axis {
            0 => first,
            1 => second,
            _ => third,
        };
        along * (t * self.half_spin)
    }

    #[inline(always)]
    fn take(&self, spin: &Spun<S>, t: S, x: &mut Point<S>) {
        let spun = match self.axis {
            0 => spin.turn::<0>(x),
            1 => spin.turn::<1>(x),
            _ => spin.turn::<2>(x),
        };
        // the two turns as one, (1 + a) ∘ (1 + b) − 1
        let precession = self.precession.turn(t, x.momentum_body);
        x.add_attitude(x.attitude * (spun + (precession + spun * precession)));
    }
}

/// A turn of the body about its axis.
///
/// Nothing but a torque about it changes the momentum along the axis, and of a top no torque does: its spin turns by the
/// same angle in every step. What rounding that angle's sine and cosine adds to |m| is then the same in every step too, and
/// the energy and L_z follow it. So sin² + cos² = 1, and the products, hold to twice the digits here.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spun<S> {
    half: S,
    /// Sine of half the angle, and its cosine less one.
    quaternion: [S; 2],
    /// 1 − cos and sin of the whole angle, each in two parts.
    versine: [S; 2],
    sine: [S; 2],
}

impl<S: Real> Spun<S> {
    /// By twice the angle `half`.
    #[inline(always)]
    fn by(half: S) -> Self {
        let (one, two) = (S::of(1.0), S::of(2.0));
        let (s, c) = half.sin_cos();
        let ((ss, ss_low), (sc, sc_low), (cc, cc_low)) = (s.two_prod(s), s.two_prod(c), c.two_prod(c));
        let (rest, rest_low) = one.two_sum(-ss);
        let lacking = (rest - cc) + (rest_low - (ss_low + cc_low)); // 1 − s² − c²
        Spun {
            half,
            quaternion: [s, c - one],
            versine: [two * ss, two * (ss_low + ss * lacking)],
            sine: [two * sc, two * (sc_low + sc * lacking)],
        }
    }

    /// Turns the momentum of `x` about `AXIS`, rounding errors carried, and gives the quaternion of that turn of the body, less one.
    #[inline(always)]
    fn turn<const AXIS: usize>(&self, x: &mut Point<S>) -> Quat<S> {
        let (j, k) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
        let ([v, v_low], [w, w_low], m) = (self.versine, self.sine, x.momentum_body);
        x.add_component(j, w * m[k] - (v * m[j] - (w_low * m[k] - v_low * m[j])));
        x.add_component(k, -(w * m[j]) - (v * m[k] + (w_low * m[j] + v_low * m[k])));
        let mut turn = Quat::new(self.quaternion[1], Vec3::zero());
        turn.v[AXIS] = self.quaternion[0];
        turn
    }
}
