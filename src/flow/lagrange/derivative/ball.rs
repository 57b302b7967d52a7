//! The heavy ball at one time, as three functions that obey equations of one form.

use crate::num::complex::Complex;
use crate::rotation::{Quat, Vec3};

/// α, β and ζ = ω₁ + iω₂.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    pub(super) alpha: Complex<f64>,
    pub(super) beta: Complex<f64>,
    pub(super) zeta: Complex<f64>,
}

/// A function f of [`Functions`] and f', or changes of both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving {
    pub(super) value: Complex<f64>,
    pub(super) rate: Complex<f64>,
}

/// α, β and ζ e^{iat/2}, each at the time of that phase factor 1: `f'' = (g u − λ) f`, λ constant.
pub(super) type Functions = [Moving; 3];

impl Ball {
    /// From the attitude and ω₁, ω₂.
    pub(super) fn new(q: Quat<f64>, [o1, o2]: [f64; 2]) -> Self {
        let Quat { w, v: Vec3([x, y, z]) } = q;
        Ball { alpha: Complex::new(w, z), beta: Complex::new(x, y), zeta: Complex::new(o1, o2) }
    }

    /// Γ₁ + iΓ₂.
    pub(super) fn up(&self) -> Complex<f64> {
        times_i((self.alpha.conjugate() * self.beta).scaled(2.0))
    }

    /// 1 + u and 1 − u.
    pub(super) fn tilt(&self) -> [f64; 2] {
        [2.0 * self.alpha.norm_squared(), 2.0 * self.beta.norm_squared()]
    }

    /// The three functions, for ω₃ = `a` and for `g`.
    pub(super) fn functions(&self, a: f64, g: f64) -> Functions {
        let Ball { alpha, beta, zeta } = *self;
        let half = |z: Complex<f64>| z.scaled(0.5);
        [
            Moving { value: alpha, rate: half(times_i(alpha.scaled(a)) - beta * zeta.conjugate()) },
            Moving { value: beta, rate: half(alpha * zeta - times_i(beta.scaled(a))) },
            Moving { value: zeta, rate: times_i(zeta.scaled(0.5 * a) - self.up().scaled(g)) },
        ]
    }
}

/// i z.
pub(super) fn times_i(z: Complex<f64>) -> Complex<f64> {
    Complex::new(-z.im, z.re)
}
