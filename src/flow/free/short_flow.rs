//! The free body over a short time, by the Taylor series of its motion summed to rounding.

use crate::body::{Gyroscopic, Point, Rotor};
use crate::num::{Dd, Precise};
use crate::rotation::{Quat, Vec3};

/// Terms before the series is given up.
const TERMS: usize = 20;

/// Terms that suffice for `f64` over the short steps of most runs: a loop of a length that is known is three times as quick.
const FEW: usize = 12;

/// The largest angle of a turn, rad, that is worth a try.
const SHORT: f64 = 0.125;

/// The largest for which few terms are.
const VERY_SHORT: f64 = 0.03125;

/// Where the momentum moves by less than this many roundings of it, the attitude takes a turn in place of the series. The series multiplies
/// it by the angular velocity itself: where that is a power of two less its last digit, products round to one side at every step, and L
/// turns by 1e-18 each time.
const STEADY: f64 = 1.0 / 128.0;

/// The exact flow of the free body as increments of m and q, so that what rounding takes can be carried.
///
/// With `m = Σ m_n`, `q = Σ q_n` in powers of the time t: `(n + 1) m_{n+1} = t Σ m_k × I⁻¹m_{n−k}` and
/// `2 (n + 1) q_{n+1} = t Σ q_k ∘ I⁻¹m_{n−k}`. The first sum is taken as `D_i Σ (m_k)_j (m_{n−k})_l`,
/// `D_i = 1/I_l − 1/I_j`: of a rod the products `m × ω` cancel along the axis, where the rounding they leave is divided
/// by the smallest moment. An increment is good to its own rounding: over a short time that is far
/// less than the rounding of the state, which a flow by elliptic functions suffers at each call.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShortFlow<S> {
    inverse_moments: Vec3<S>,
    gyroscopic: Gyroscopic<S>,
    /// 1/n.
    reciprocals: [S; TERMS],
}

impl<S: Precise> ShortFlow<S> {
    pub(super) fn new(rotor: &Rotor) -> Self {
        ShortFlow {
            inverse_moments: rotor.inverse_moments(),
            gyroscopic: Gyroscopic::new(rotor, Dd::ONE),
            reciprocals: core::array::from_fn(|n| S::from_dd(Dd::ONE / Dd::from(n.max(1) as u64))),
        }
    }

    /// Moves `x` by the time `t`; false, and `x` untouched, if the turn is not short.
    #[inline]
    pub(super) fn try_flow(&self, t: S, x: &mut Point<S>) -> bool {
        let angle = x.momentum_body.times(self.inverse_moments).magnitude() * t.magnitude();
        (angle < VERY_SHORT && self.try_terms::<FEW>(t, x))
            || (angle < SHORT && self.try_terms::<TERMS>(t, x))
    }

    /// The same with at most `N` terms.
    fn try_terms<const N: usize>(&self, t: S, x: &mut Point<S>) -> bool {
        let zero = S::of(0.0);
        let mut m = [Vec3([zero; 3]); N];
        let mut w = [Vec3([zero; 3]); N];
        let mut q = [Quat::zero(); N];
        (m[0], w[0], q[0]) = (x.momentum_body, x.momentum_body.times(self.inverse_moments), x.attitude);
        let mut last = 0;
        for n in 0..N - 1 {
            let (mut products, mut attitude) = (Vec3::zero(), Quat::zero());
            for k in 0..=n {
                let (u, v) = (m[k], m[n - k]);
                products = products + Vec3([u[1] * v[2], u[2] * v[0], u[0] * v[1]]);
                attitude = attitude + q[k].rate(w[n - k]);
            }
            let factor = t * self.reciprocals[n + 1];
            last = n + 1;
            m[last] = self.gyroscopic.times(products) * factor;
            w[last] = m[last].times(self.inverse_moments);
            q[last] = attitude * factor;
            let small = |term: f64, first: f64| term <= 0.25 * S::ROUNDOFF * first;
            if small(m[last].magnitude(), m[1].magnitude()) && small(q[last].magnitude(), q[1].magnitude()) {
                break;
            }
        }
        if last == N - 1 {
            return false;
        }
        let (mut momentum, mut attitude) = (m[last], q[last]);
        for n in (1..last).rev() {
            momentum = momentum + m[n];
            attitude = attitude + q[n];
        }
        if momentum.magnitude() <= STEADY * S::ROUNDOFF * m[0].magnitude() {
            attitude = turned(q[0], w[0] * (t * S::of(0.5)));
        }
        x.add_momentum(momentum);
        x.add_attitude(attitude);
        true
    }
}

/// What the turn by the vector `2 u` adds to the attitude.
fn turned<S: Precise>(attitude: Quat<S>, u: Vec3<S>) -> Quat<S> {
    let (sinc, cos) = u.norm_squared().sinc_cos_of_root();
    let v = u * sinc;
    // 1 − cos without cancellation
    let less = v.norm_squared() / (S::of(1.0) + cos);
    attitude * Quat::new(-less, v)
}
