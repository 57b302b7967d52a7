//! The three quadratic equations of an implicit step, `u = α m + g(u)`.

use crate::body::Gyroscopic;
use crate::num::Real;
use crate::rotation::Vec3;

/// More iterations than any step takes that has a solution.
const ITERATIONS: u32 = 50;

/// A correction smaller than this many roots of the roundoff leaves an error below rounding: the next one is about its square.
const SETTLED: f64 = 1.0 / 32.0;

/// The equation `u = α m + g(u)`, `g_i(u) = D_i u_j u_k`, with `α = 1 + |half u|²` if `ALPHA`, componentwise, and else 1.
#[derive(Clone, Copy, Debug)]
pub(in crate::method) struct Quadratic<'a, S, const ALPHA: bool> {
    pub(in crate::method) m: Vec3<S>,
    pub(in crate::method) half: Vec3<S>,
    pub(in crate::method) gyroscopic: &'a Gyroscopic<S>,
}

impl<S: Real, const ALPHA: bool> Quadratic<'_, S, ALPHA> {
    /// The solution next to m, and its residual relative to |m|.
    ///
    /// Newton's iteration from the power series to the fifth order of the step. It ends when the next correction would be
    /// below rounding: a fixed tolerance would leave a systematic error that drifts (Hairer, McLachlan and Razakarivony, BIT
    /// 48 (2008) 231).
    #[inline]
    pub(in crate::method) fn solution(&self) -> (Vec3<S>, f64) {
        let size = self.m.magnitude();
        let settled = SETTLED * SETTLED * S::ROUNDOFF;
        let mut u = self.series();
        let mut moved = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let correction = self.correction(u);
            u = u + correction;
            moved = correction.magnitude() / size;
            if moved * moved <= settled {
                return (u, moved * moved);
            }
        }
        // a body at rest moves nowhere
        (u, if size == 0.0 { 0.0 } else { moved })
    }

    /// `Σ u_n`, n ≤ 5, with `u_1 = m` and u_n the terms of the order n − 1 in the step.
    #[inline]
    fn series(&self) -> Vec3<S> {
        let (g, m) = (self.gyroscopic, self.m);
        let mixed = |a: Vec3<S>, b: Vec3<S>| g.of(a, b) + g.of(b, a);
        let with = |u: Vec3<S>, less_one: S| if ALPHA { u + m * less_one } else { u };
        let c1 = m.times(self.half);
        let u2 = g.at(m);
        let c2 = u2.times(self.half);
        let u3 = with(mixed(m, u2), c1.norm_squared());
        let c3 = u3.times(self.half);
        let u4 = with(mixed(m, u3) + g.at(u2), c1.dot(c2) * S::of(2.0));
        let u5 = with(mixed(m, u4) + mixed(u2, u3), c1.dot(c3) * S::of(2.0) + c2.norm_squared());
        m + (u2 + (u3 + (u4 + u5)))
    }

    /// Newton's correction at u.
    #[inline]
    fn correction(&self, u: Vec3<S>) -> Vec3<S> {
        let (g, m) = (self.gyroscopic, self.m);
        let c = u.times(self.half);
        let one = S::of(1.0);
        // small terms first: then the sum is rounded as they are, not as m is
        let small = if ALPHA { m * c.norm_squared() + g.at(u) } else { g.at(u) };
        let lacking = (m - u) + small;
        // rows of 1 − ∂(α m + g)/∂u
        let gradient = c.times(self.half) * S::of(2.0);
        let row = |i: usize| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let mut row = if ALPHA { gradient * -m[i] } else { Vec3::zero() };
            row[i] = row[i] + one;
            row[j] = row[j] - g.component(i, one, u[k]);
            row[k] = row[k] - g.component(i, u[j], one);
            row
        };
        let [a, b, c] = [row(0), row(1), row(2)];
        // Cramer's rule
        let (bc, ca, ab) = (b.cross(c), c.cross(a), a.cross(b));
        (bc * lacking[0] + ca * lacking[1] + ab * lacking[2]) * (one / a.dot(bc))
    }
}
