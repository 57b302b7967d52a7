//! The free body over a short time, by the Taylor series of its motion summed to rounding.

use crate::body::{Gyroscopic, Point, Rotor};
use crate::num::{Dd, Precise};
use crate::rotation::{Quat, Vec3};

/// Terms before the series is given up.
const TERMS: usize = 20;

/// The largest angle of a turn, rad, that is worth a try.
const SHORT: f64 = 0.125;

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
}

impl<S: Precise> ShortFlow<S> {
    pub(super) fn new(rotor: &Rotor) -> Self {
        ShortFlow { inverse_moments: rotor.inverse_moments(), gyroscopic: Gyroscopic::new(rotor, Dd::ONE) }
    }

    /// Moves `x` by the time `t`; false, and `x` untouched, if the turn is not short.
    pub(super) fn try_flow(&self, t: S, x: &mut Point<S>) -> bool {
        let omega = x.momentum_body.times(self.inverse_moments);
        let short = omega.magnitude() * t.magnitude() < SHORT;
        if !short {
            return false;
        }
        let mut m = [x.momentum_body; TERMS];
        let mut w = [omega; TERMS];
        let mut q = [x.attitude; TERMS];
        let mut last = 0;
        for n in 0..TERMS - 1 {
            let mut momentum = Vec3::zero();
            let mut attitude = Quat::zero();
            for k in 0..=n {
                momentum = momentum + self.gyroscopic.of(m[k], m[n - k]);
                attitude = attitude + q[k].rate(w[n - k]);
            }
            let factor = t / S::of((n + 1) as f64);
            last = n + 1;
            m[last] = momentum * factor;
            w[last] = m[last].times(self.inverse_moments);
            q[last] = attitude * factor;
            let small = |term: f64, first: f64| term <= 0.25 * S::ROUNDOFF * first;
            if small(m[last].magnitude(), m[1].magnitude()) && small(q[last].magnitude(), q[1].magnitude()) {
                break;
            }
        }
        if last == TERMS - 1 {
            return false;
        }
        let (mut momentum, mut attitude) = (m[last], q[last]);
        for n in (1..last).rev() {
            momentum = momentum + m[n];
            attitude = attitude + q[n];
        }
        x.add_momentum(momentum);
        x.add_attitude(attitude);
        true
    }
}
