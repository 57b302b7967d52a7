//! The free body over a short time, by the Taylor series of its motion summed to rounding.

use core::array::from_fn;

use crate::body::{Gyroscopic, Point, Rotor};
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// Terms before the series is given up.
pub(super) const TERMS: usize = 20;

/// Terms that suffice for `f64` over the short steps of most runs: a loop of a length that is known is three times as quick.
const FEW: usize = 12;

/// The largest angle of a turn, rad, that is worth a try.
pub(super) const SHORT: f64 = 0.125;

/// The largest for which few terms are.
const VERY_SHORT: f64 = 0.03125;

/// Where the momentum moves by less than this many roundings of it, the attitude takes a turn in place of the series. The series multiplies
/// it by the angular velocity itself: where that is a power of two less its last digit, products round to one side at every step, and L
/// turns by 1e-18 each time.
pub(super) const STEADY: f64 = 1.0 / 128.0;

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

/// What the series is made from.
pub(super) struct Constants<S> {
    pub(super) inverse_moments: Vec3<S>,
    pub(super) gyroscopic: Vec3<S>,
    pub(super) reciprocals: [S; TERMS],
}

impl<S: Precise> ShortFlow<S> {
    /// For a series of many bodies side by side.
    pub(super) fn constants(&self) -> Constants<S> {
        let ShortFlow { inverse_moments, gyroscopic, reciprocals } = *self;
        Constants { inverse_moments, gyroscopic: gyroscopic.factors(), reciprocals }
    }

    pub(super) fn new(rotor: &Rotor) -> Self {
        ShortFlow {
            inverse_moments: rotor.inverse_moments(),
            gyroscopic: Gyroscopic::new(rotor, Dd::ONE),
            reciprocals: from_fn(|n| S::from_dd(Dd::ONE / Dd::from(n.max(1) as u64))),
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
    ///
    /// Products of the components of two terms stand in lanes of four, which the compiler takes two at a time.
    fn try_terms<const N: usize>(&self, t: S, x: &mut Point<S>) -> bool {
        let (half, zero) = (S::of(0.5), S::of(0.0));
        let (mut m, mut q, mut turn) = ([[zero; 5]; N], [[zero; 4]; N], [[zero; 3]; N]);
        let two_rounds = |[x, y, z]: [S; 3]| [x, y, z, x, y];
        let spin = |m: Vec3<S>| (m.times(self.inverse_moments) * half).0;
        m[0] = two_rounds(x.momentum_body.0);
        q[0] = x.attitude.components();
        turn[0] = spin(x.momentum_body);
        // beside the arrays: what has just been written there is waited for when it is read in other pairs
        let mut newest = (m[0], q[0], turn[0]);
        let mut least = [0.0; 2];
        let mut last = 0;
        for n in 0..N - 1 {
            let (mut products, mut attitude) = ([zero; 3], [zero; 4]);
            let mut add = |u: [S; 5], q: [S; 4], v: [S; 5], turn: [S; 3]| {
                products = from_fn(|i| products[i] + u[i + 1] * v[i + 2]);
                let half = half_turn(q, turn);
                attitude = from_fn(|i| attitude[i] + half[i]);
            };
            let (newest_m, newest_q, newest_turn) = newest;
            add(m[0], q[0], newest_m, newest_turn);
            for k in 1..n {
                add(m[k], q[k], m[n - k], turn[n - k]);
            }
            if n > 0 {
                add(newest_m, newest_q, m[0], turn[0]);
            }
            let factor = t * self.reciprocals[n + 1];
            last = n + 1;
            let momentum = self.gyroscopic.times(Vec3(products)) * factor;
            newest = (two_rounds(momentum.0), attitude.map(|c| c * factor), spin(momentum));
            (m[last], q[last], turn[last]) = newest;
            if last == 1 {
                let sizes = [momentum.magnitude(), Quat::from_components(q[last]).magnitude()];
                least = sizes.map(|size| 0.25 * S::ROUNDOFF * size);
            }
            let small = |components: &[S], least: f64| components.iter().all(|c| c.magnitude() <= least);
            if small(&momentum.0, least[0]) && small(&q[last], least[1]) {
                break;
            }
        }
        if last == N - 1 {
            return false;
        }
        let of = |n: usize| (Vec3([m[n][0], m[n][1], m[n][2]]), Quat::from_components(q[n]));
        let (mut momentum, mut attitude) = of(last);
        for n in (1..last).rev() {
            let (m, q) = of(n);
            momentum = momentum + m;
            attitude = attitude + q;
        }
        if momentum.magnitude() <= STEADY * S::ROUNDOFF * x.momentum_body.magnitude() {
            attitude = turned(x.attitude, Vec3(turn[0]) * t);
        }
        x.add_momentum(momentum);
        x.add_attitude(attitude);
        true
    }
}

/// q ∘ (0, ½ ω) of q and ½ ω, term by term.
#[inline(always)]
pub(super) fn half_turn<S: Real>([w, x, y, z]: [S; 4], [a, b, c]: [S; 3]) -> [S; 4] {
    let first = [-z * c, w * a, w * b, w * c];
    let second = [-x * a, y * c, z * a, x * b];
    let third = [-y * b, -z * b, -x * c, -y * a];
    [
        first[0] + (second[0] + third[0]),
        first[1] + (second[1] + third[1]),
        first[2] + (second[2] + third[2]),
        first[3] + (second[3] + third[3]),
    ]
}

/// What the turn by the vector `2 u` adds to the attitude.
fn turned<S: Precise>(attitude: Quat<S>, u: Vec3<S>) -> Quat<S> {
    let (sinc, cos) = u.norm_squared().sinc_cos_of_root();
    let v = u * sinc;
    // 1 − cos without cancellation
    let less = v.norm_squared() / (S::of(1.0) + cos);
    attitude * Quat::new(-less, v)
}
