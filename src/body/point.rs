//! The phase point that kernels move: attitude and momentum in the solver frame, with what rounding took from them.

use core::ops::{Add, Mul};

use crate::num::sum::{Compensated, add_carried, add_parts_carried};
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// A phase point in the solver frame: along principal axes, momenta divided by a power of two.
///
/// [`State`](super::State) is what users hold, in SI units and their own body axes; [`Body::enter`](super::Body::enter)
/// and [`Body::leave`](super::Body::leave) convert between the two. The momentum, not the angular velocity, is
/// the variable: |m| is the Casimir of the Lie–Poisson bracket, kicks add to it, and `L = q m q*` is one product.
///
/// What rounding takes from an increment is carried to the next one (Kahan's compensated sum, component by
/// component): the rounding of `m += δ` is then one unit of δ instead of one of m, a random walk that starts
/// thousands of times lower. The number of steps is part of the point too, so that a run can be stored at any step
/// and resumed.
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::Body;
/// use polhode::inertia::Inertia;
/// let body = Body::free(Inertia::from_moments([10.0, 20.0, 30.0])?);
/// let start = body.state(UnitQuaternion::identity(), Vector3::new(0.5, 1.0, -0.25))?;
/// let point = body.enter(&start)?;
/// assert_eq!(point.momentum_body[1].hi() * body.scale(), start.momentum()[1]);
/// assert_eq!(body.leave(&point), start);
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Point<S> {
    /// Unit quaternion, scalar first, active, principal axes → space.
    pub attitude: Quat<S>,
    /// Angular momentum along the principal axes, divided by [`Body::scale`](super::Body::scale).
    pub momentum_body: Vec3<S>,
    carried: Phase<S>,
    steps: u64,
}

/// Attitude and momentum as seven numbers, or a change of them, in the solver frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Phase<S> {
    /// Quaternion, or a change of it.
    pub attitude: Quat<S>,
    /// Momentum, or a change of it.
    pub momentum_body: Vec3<S>,
}

/// Steps between renormalisations: meanwhile |q| walks by a few units of rounding.
pub(crate) const RENORMALIZE_EVERY: u64 = 8;

impl<S: Real> Point<S> {
    /// A point at which no step has been taken.
    #[inline]
    pub fn new(attitude: Quat<S>, momentum_body: Vec3<S>) -> Self {
        Point { attitude, momentum_body, carried: Phase::zero(), steps: 0 }
    }

    /// Angular momentum in space, `L = q m q*`, divided by the scale.
    #[inline]
    pub fn momentum_space(&self) -> Vec3<S> {
        self.attitude.rotate(self.momentum_body)
    }

    /// The largest |component| as `f64`; NaN if one is NaN.
    #[inline]
    pub fn magnitude(&self) -> f64 {
        let (q, m) = (self.attitude.magnitude(), self.momentum_body.magnitude());
        if q.is_nan() || m.is_nan() { f64::NAN } else { q.max(m) }
    }

    /// Whether every component is a finite number.
    #[inline]
    pub fn is_finite(&self) -> bool {
        self.magnitude().is_finite()
    }

    /// Steps taken so far.
    #[inline]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Counts `n` steps.
    #[inline]
    pub(crate) fn count_steps(&mut self, n: u64) {
        self.steps += n;
    }

    /// `m += delta`.
    #[inline(always)]
    pub fn add_momentum(&mut self, delta: Vec3<S>) {
        for k in 0..3 {
            self.add_component(k, delta[k]);
        }
    }

    /// `m[axis] += delta`.
    #[inline(always)]
    pub(crate) fn add_component(&mut self, axis: usize, delta: S) {
        add_carried(&mut self.momentum_body[axis], &mut self.carried.momentum_body[axis], delta);
    }

    /// `q += Σ attitude`, `m += Σ momentum`, each in two parts, the second of the size of a rounding error of the first.
    pub(crate) fn add_in_parts(&mut self, attitude: [Quat<S>; 2], momentum: [Vec3<S>; 2]) {
        let [high, low] = momentum;
        for k in 0..3 {
            let carried = &mut self.carried.momentum_body[k];
            add_parts_carried(&mut self.momentum_body[k], carried, high[k], low[k]);
        }
        let [high, low] = attitude;
        add_parts_carried(&mut self.attitude.w, &mut self.carried.attitude.w, high.w, low.w);
        for k in 0..3 {
            let carried = &mut self.carried.attitude.v[k];
            add_parts_carried(&mut self.attitude.v[k], carried, high.v[k], low.v[k]);
        }
    }

    /// The same point, nothing carried.
    pub(crate) fn without_carried(&self) -> Self {
        Point { carried: Phase::zero(), ..*self }
    }

    /// Moves as `moved` has moved from this point [without what is carried](Self::without_carried): that of both is kept.
    pub(crate) fn follow(&mut self, moved: &Point<S>) {
        let change = |to: S, carried: S, from: S| {
            let (high, low) = to.two_sum(-from);
            [high, low + carried]
        };
        let (q, m) = (self.attitude, self.momentum_body);
        let (to, left) = (moved.attitude, moved.carried.attitude);
        let w = change(to.w, left.w, q.w);
        let v = [0, 1, 2].map(|k| change(to.v[k], left.v[k], q.v[k]));
        let n = [0, 1, 2].map(|k| change(moved.momentum_body[k], moved.carried.momentum_body[k], m[k]));
        let part = |p: usize| (Quat::new(w[p], Vec3(v.map(|v| v[p]))), Vec3(n.map(|n| n[p])));
        let ((q_high, m_high), (q_low, m_low)) = (part(0), part(1));
        self.add_in_parts([q_high, q_low], [m_high, m_low]);
    }

    /// `q += delta`.
    #[inline(always)]
    pub fn add_attitude(&mut self, delta: Quat<S>) {
        add_carried(&mut self.attitude.w, &mut self.carried.attitude.w, delta.w);
        // no loop, as in `renormalize`
        add_carried(&mut self.attitude.v[0], &mut self.carried.attitude.v[0], delta.v[0]);
        add_carried(&mut self.attitude.v[1], &mut self.carried.attitude.v[1], delta.v[1]);
        add_carried(&mut self.attitude.v[2], &mut self.carried.attitude.v[2], delta.v[2]);
    }

    /// Attitude and momentum alone.
    #[inline]
    pub fn phase(&self) -> Phase<S> {
        Phase { attitude: self.attitude, momentum_body: self.momentum_body }
    }

    /// Sets attitude and momentum; what rounding carries stays.
    #[inline]
    pub fn set_phase(&mut self, phase: Phase<S>) {
        (self.attitude, self.momentum_body) = (phase.attitude, phase.momentum_body);
    }

    /// Brings |q| back to 1 in every eighth step.
    #[inline]
    pub fn renormalize_at_times(&mut self) {
        self.renormalize_every(RENORMALIZE_EVERY);
    }

    /// The same in the last of every `count` steps.
    #[inline]
    pub(crate) fn renormalize_every(&mut self, count: u64) {
        if self.steps % count == count - 1 {
            self.renormalize();
        }
    }

    /// Brings |q| back to 1 to first order, `q += ½ (1 − |q|²) q`.
    ///
    /// |q|² includes what is carried, to twice the digits: a defect of the rounded q alone is noise that the carry
    /// already holds, and feeding it back turns L steadily, by 1e-20 of it a step.
    #[inline]
    pub fn renormalize(&mut self) {
        let (q, low) = (self.attitude, self.carried.attitude);
        let mut excess = Compensated::new(S::of(-1.0));
        let mut add = |q: S, low: S| {
            let (square, rest) = q.two_prod(q);
            excess.add(square);
            excess.add(rest + (q + q) * low);
        };
        // no loop: of several bodies side by side the loop over the bodies is the innermost
        add(q.w, low.w);
        add(q.v[0], low.v[0]);
        add(q.v[1], low.v[1]);
        add(q.v[2], low.v[2]);
        self.add_attitude(q * (excess.value() * S::of(-0.5)));
    }
}

impl<S: Precise> Point<S> {
    /// The same attitude and momentum in double-double, exactly; nothing carried, no step counted.
    pub fn to_dd(&self) -> Point<Dd> {
        Point::new(self.attitude.map(S::to_dd), self.momentum_body.map(S::to_dd))
    }

    /// Attitude and momentum rounded to doubles; nothing carried, no step counted.
    pub fn to_f64(&self) -> Point<f64> {
        Point::new(self.attitude.map(S::to_f64), self.momentum_body.map(S::to_f64))
    }
}

/// The parts of a `Point<f64>`, for checkpoints and for lanes.
impl Point<f64> {
    /// Attitude, momentum, and what is carried of each, fourteen doubles.
    #[inline(always)]
    pub(crate) fn parts(&self) -> [f64; 14] {
        let (q, m) = (self.attitude, self.momentum_body);
        let Phase { attitude: r, momentum_body: n } = self.carried;
        [q.w, q.v[0], q.v[1], q.v[2], m[0], m[1], m[2], r.w, r.v[0], r.v[1], r.v[2], n[0], n[1], n[2]]
    }

    #[inline(always)]
    pub(crate) fn from_parts(p: [f64; 14], steps: u64) -> Self {
        let phase = |k: usize| Phase {
            attitude: Quat::from_components([p[k], p[k + 1], p[k + 2], p[k + 3]]),
            momentum_body: Vec3([p[k + 4], p[k + 5], p[k + 6]]),
        };
        let Phase { attitude, momentum_body } = phase(0);
        Point { attitude, momentum_body, carried: phase(7), steps }
    }
}

impl<S: Real> Phase<S> {
    /// Seven zeros.
    #[inline]
    pub fn zero() -> Self {
        Phase { attitude: Quat::zero(), momentum_body: Vec3::zero() }
    }
}

impl<S: Real> Add for Phase<S> {
    type Output = Self;
    #[inline]
    fn add(self, b: Self) -> Self {
        Phase { attitude: self.attitude + b.attitude, momentum_body: self.momentum_body + b.momentum_body }
    }
}
impl<S: Real> Mul<S> for Phase<S> {
    type Output = Self;
    #[inline]
    fn mul(self, k: S) -> Self {
        Phase { attitude: self.attitude * k, momentum_body: self.momentum_body * k }
    }
}
