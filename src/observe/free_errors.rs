//! Errors of free motion over blocks of steps, fast enough to be evaluated at every step.

use super::Invariants;
use crate::body::{Point, kinetic_energy};
use crate::num::error_free::two_prod;
use crate::num::{Compensated, Dd, Real};
use crate::rotation::Vec3;

/// Bounds on the rounding error of the plain evaluations of E, |m|² and |L|, in units of roundoff: three, three and
/// some fourteen operations deep, the rounded start included.
const DEPTH: [f64; 3] = [6.0, 5.0, 24.0];

/// E − E₀, |m|² − |m₀|² and |L − L₀| of one state.
pub(super) type Differences = [f64; 3];

/// The invariants of the start, leading and trailing parts side by side.
pub(super) struct Reference {
    inverse_moments: [Vec3<f64>; 2],
    energy: [f64; 2],
    momentum_squared: [f64; 2],
    momentum_space: [Vec3<f64>; 2],
}

impl Reference {
    pub(super) fn new(inverse_moments: Vec3<Dd>, start: &Invariants) -> Self {
        let parts = |x: Dd| [x.hi(), x.lo()];
        let vector = |v: Vec3<Dd>| [v.map(Dd::hi), v.map(Dd::lo)];
        Reference {
            inverse_moments: vector(inverse_moments),
            energy: parts(start.energy),
            momentum_squared: parts(start.momentum_squared),
            momentum_space: vector(start.momentum_space),
        }
    }

    #[inline]
    pub(super) fn plain(&self, x: &Point<f64>) -> Differences {
        let m = x.momentum_body;
        let l = x.momentum_space() - self.momentum_space[0];
        [
            (kinetic_energy(self.inverse_moments[0], m) - self.energy[0]).abs(),
            (m.norm_squared() - self.momentum_squared[0]).abs(),
            l.norm(),
        ]
    }

    pub(super) fn slack(&self) -> Differences {
        let size = [self.energy[0], self.momentum_squared[0], self.momentum_squared[0].sqrt()];
        [0, 1, 2].map(|k| DEPTH[k] * f64::ROUNDOFF * size[k])
    }

    #[inline]
    pub(super) fn compensated(&self, x: &Point<f64>) -> Differences {
        let m = x.momentum_body;
        let [high, low] = self.inverse_moments;
        let mut twice_energy = Compensated::minus([2.0 * self.energy[0], 2.0 * self.energy[1]]);
        let mut squared = Compensated::minus(self.momentum_squared);
        for k in 0..3 {
            let (p, e) = two_prod(m[k], m[k]);
            squared.add_parts(p, e);
            let (s, f) = two_prod(p, high[k]);
            twice_energy.add_parts(s, f + (e * high[k] + p * low[k]));
        }

        // L = (w² − |v|²) m + 2 (v·m) v + 2 w (v × m), not divided by |q|²
        let (w, v) = (x.attitude.w, x.attitude.v);
        let mut diagonal = Compensated::new(0.0);
        diagonal.add_product(w, w);
        let mut along = Compensated::new(0.0);
        for k in 0..3 {
            diagonal.add_product(-v[k], v[k]);
            along.add_product(v[k], m[k]);
        }
        let mut difference = [0.0; 3];
        for (k, difference) in difference.iter_mut().enumerate() {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let mut cross = Compensated::new(0.0);
            cross.add_product(v[i], m[j]);
            cross.add_product(-v[j], m[i]);
            let mut l = Compensated::minus([self.momentum_space[0][k], self.momentum_space[1][k]]);
            l.add_scaled(diagonal, m[k]);
            l.add_scaled(along, 2.0 * v[k]);
            l.add_scaled(cross, 2.0 * w);
            *difference = l.value();
        }
        [0.5 * twice_energy.value().abs(), squared.value().abs(), Vec3(difference).norm()]
    }
}

/// The largest of each difference over the states; NaN where one is NaN.
#[inline]
pub(super) fn largest(
    points: &[Point<f64>],
    differences: impl Fn(&Point<f64>) -> Differences,
) -> Differences {
    let mut worst = [0.0; 3];
    for x in points {
        let now = differences(x);
        for k in 0..3 {
            worst[k] = if now[k] <= worst[k] { worst[k] } else { now[k] };
        }
    }
    worst
}
