//! The three quadratic equations of an implicit step, `u = α m + g(u)`.

use crate::body::Gyroscopic;
use crate::num::Real;
use crate::rotation::Vec3;

/// Of |m|², of which a part is squared once more: below, that may leave the range of a double.
const LEAST: f64 = 1e-150;

/// More iterations than any step takes that has a solution.
const ITERATIONS: u32 = 50;

/// The equation `u = α m + g(u)`, `g_i(u) = D_i u_j u_k`, with `α = 1 + |half u|²` if `ALPHA`, componentwise, and else 1.
#[derive(Clone, Copy, Debug)]
pub(in crate::method) struct Quadratic<'a, S, const ALPHA: bool> {
    pub(in crate::method) m: Vec3<S>,
    pub(in crate::method) half: Vec3<S>,
    pub(in crate::method) gyroscopic: &'a Gyroscopic<S>,
}

impl<S: Real, const ALPHA: bool> Quadratic<'_, S, ALPHA> {
    /// The solution next to m, and whether its error is below rounding.
    ///
    /// Sweeps of `u ← α m + g(u)`, each of which takes the error times the turn of a step, and a correction by Newton's matrix.
    /// That is of the last sweep but two, so that it need not be waited for. What it leaves is below the correction times what
    /// those two sweeps have changed, relative to m.
    #[inline(always)]
    pub(in crate::method) fn near(&self) -> (Vec3<S>, bool) {
        let m = self.m;
        let u1 = self.swept(m, m);
        let u2 = self.swept(u1, m);
        let u3 = self.swept(u2, u1);
        let u4 = self.swept(u3, u2);
        let u5 = self.swept(u4, u3);
        let correction = self.corrected(u3, self.lacking(u5));
        let squared = |v: Vec3<S>| v.norm_squared().magnitude();
        let size = squared(m);
        let left = (squared(correction) / size) * (squared(u5 - u3) / size);
        (u5 + correction, size >= LEAST && left <= settled::<S>() * settled::<S>())
    }

    /// The solution next to m, and its residual relative to |m|.
    #[inline]
    pub(in crate::method) fn solution(&self) -> (Vec3<S>, f64) {
        let (u, settled) = self.near();
        if settled { (u, 0.0) } else { self.iterated(u) }
    }

    /// The solution by Newton's iteration from `u`, unless that is far off, and its residual relative to |m|.
    ///
    /// It ends when the next correction would be below rounding: a fixed tolerance would leave a systematic error that drifts
    /// (Hairer, McLachlan and Razakarivony, BIT 48 (2008) 231).
    pub(in crate::method) fn iterated(&self, u: Vec3<S>) -> (Vec3<S>, f64) {
        let size = self.m.magnitude();
        // sweeps of a step that is too long lead away
        let mut u = if (u - self.m).magnitude() <= size { u } else { self.m };
        let mut moved = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let correction = self.corrected(u, self.lacking(u));
            u = u + correction;
            moved = correction.magnitude() / size;
            if moved * moved <= settled::<S>() {
                return (u, moved * moved);
            }
        }
        // a body at rest moves nowhere
        (u, if size == 0.0 { 0.0 } else { moved })
    }

    /// `α m + g(u)`. As α − 1 is of the second order in the step, it may be that of the sweep before, `earlier`.
    #[inline(always)]
    fn swept(&self, u: Vec3<S>, earlier: Vec3<S>) -> Vec3<S> {
        self.m + self.small(u, earlier)
    }

    /// `α m + g(u) − u`.
    #[inline(always)]
    fn lacking(&self, u: Vec3<S>) -> Vec3<S> {
        // small terms first: then the sum is rounded as they are, not as m is
        (self.m - u) + self.small(u, u)
    }

    #[inline(always)]
    fn small(&self, u: Vec3<S>, of_alpha: Vec3<S>) -> Vec3<S> {
        let g = self.gyroscopic.at(u);
        if ALPHA { self.m * of_alpha.times(self.half).norm_squared() + g } else { g }
    }

    /// Newton's correction of what is `lacking`, by the matrix at u.
    #[inline(always)]
    fn corrected(&self, u: Vec3<S>, lacking: Vec3<S>) -> Vec3<S> {
        let (g, m, one) = (self.gyroscopic, self.m, S::of(1.0));
        // rows of 1 − ∂(α m + g)/∂u
        let gradient = u.times(self.half).times(self.half) * S::of(2.0);
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
        let inverse = one / a.dot(bc);
        (bc * lacking[0] + ca * lacking[1] + ab * lacking[2]) * inverse
    }
}

/// The error of a solution, relative, that is lost in its rounding.
#[inline(always)]
fn settled<S: Real>() -> f64 {
    S::ROUNDOFF / 1024.0
}
