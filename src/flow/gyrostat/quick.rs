//! Attitude and momentum in `f64`, with phases in double-double.

use super::dual::Dual;
use super::least::Least;
use super::level::Level;
use super::spinor::Spinor;
use crate::body::Point;
use crate::flow::free::{Pair, Phase, TOO_FAR};
use crate::num::Dd;
use crate::num::complex::Complex;
use crate::num::trig::{nearest, sin_cos_turns};
use crate::rotation::{Quat, Vec3};

/// Terms of this share of the largest are left out.
const NEGLIGIBLE: f64 = 1e-19;

/// The quick form of one motion.
#[derive(Clone, Debug)]
pub(super) struct Quick {
    twist: Phase, // turns of e^{iρτ}
    form: Form,
    /// q0 and q0 ∘ (0, e) of the three axes.
    attitudes: [Quat<f64>; 4],
    /// G e of the three axes.
    frame: [Vec3<f64>; 3],
}

#[derive(Clone, Debug)]
enum Form {
    /// Trigonometric sums.
    Direct(Direct),
    /// Sums of real powers, next to a separatrix.
    Dual(Box<Dual>),
}

#[derive(Clone, Debug)]
struct Direct {
    phase: Phase, // turns of X
    constant: [Complex<f64>; 2],
    /// Coefficients of Xⁿ and X⁻ⁿ in Z, and in W, from n = N down.
    terms: Vec<[Complex<f64>; 4]>,
    /// Where a moment is small.
    least: Option<Least>,
}

impl Quick {
    /// From the attitude of `start`, where m has the size `norm`.
    pub(super) fn new(
        level: &Level,
        spinor: &Spinor,
        [moments, wheel]: [Vec3<Dd>; 2],
        start: &Point<Dd>,
        norm: Dd,
    ) -> Self {
        let dual = spinor.basis.as_ref().and_then(|basis| Dual::new(basis, level.rate));
        let form = match dual {
            Some(dual) => Form::Dual(Box::new(dual)),
            None => Form::Direct(Direct::new(level, spinor, Least::new(level, spinor, moments, wheel, norm))),
        };
        let q0 = start.attitude;
        let along = |e: Vec3<Dd>| (q0 * Quat::new(Dd::ZERO, e)).map(Dd::hi);
        let [e1, e2, e3] = level.frame;
        Quick {
            twist: Phase::new(spinor.twist * level.rate / Dd::TAU, Dd::ZERO),
            form,
            attitudes: [q0.map(Dd::hi), along(e1), along(e2), along(e3)],
            frame: level.frame.map(|e| (e * norm).map(Dd::hi)),
        }
    }

    /// Whether it is the form next to a separatrix.
    #[cfg(test)]
    pub(super) fn is_dual(&self) -> bool {
        matches!(self.form, Form::Dual(_))
    }

    /// Attitude and momentum at `t`; `None` after too many turns for `f64` pairs.
    #[inline]
    pub(super) fn at(&self, t: Pair) -> Option<(Quat<f64>, Vec3<f64>)> {
        let (twist, twist_low) = self.twist.at(t);
        if twist.is_nan() || twist.abs() >= TOO_FAR {
            return None;
        }
        let ([z, w], tilt, least) = match &self.form {
            Form::Direct(direct) => {
                let (functions, x) = direct.at(t)?;
                (functions, 0.0, direct.least.as_ref().map(|least| (least, x)))
            }
            Form::Dual(dual) => {
                let (functions, tilt) = dual.at(t)?;
                (functions, tilt, None)
            }
        };
        let (zz, ww) = (z.norm_squared(), w.norm_squared());
        let r = 1.0 / (zz + ww).sqrt();
        let turns = (twist - nearest(twist)) + tilt;
        let (sin, cos) = sin_cos_turns(turns - nearest(turns), twist_low);
        let phase = Complex::new(cos * r, sin * r);
        let (a, b) = (z * phase, w * phase);
        let [q0, q1, q2, q3] = self.attitudes;
        let attitude = q0 * a.re + q1 * b.im - q2 * b.re + q3 * a.im;
        let across = (w * z.conjugate()).scaled(2.0 * r * r);
        let [e1, e2, e3] = self.frame;
        let mut momentum = e1 * across.re + e2 * across.im + e3 * ((zz - ww) * (r * r));
        if let Some((least, x)) = least {
            least.replace(&mut momentum, x, r * r);
        }
        Some((attitude, momentum))
    }
}

impl Direct {
    fn new(level: &Level, spinor: &Spinor, least: Option<Least>) -> Self {
        let round = |c: Complex<Dd>| Complex::new(c.re.hi(), c.im.hi());
        let half = spinor.terms.len() / 2;
        let each = |n: usize| {
            let [up, down] = [spinor.terms[half + n], spinor.terms[half - n]];
            [up[0], down[0], up[1], down[1]].map(round)
        };
        let size = |terms: &[Complex<f64>; 4]| terms.iter().map(|c| c.norm_squared()).fold(0.0, f64::max);
        let largest = (0..=half).map(|n| size(&each(n))).fold(0.0, f64::max);
        let lowest = largest * NEGLIGIBLE * NEGLIGIBLE;
        let terms = (1..=half).rev().map(each).skip_while(|terms| size(terms) < lowest).collect();
        Direct {
            phase: Phase::new(spinor.rate * level.rate / Dd::TAU, Dd::ZERO),
            constant: spinor.terms[half].map(round),
            terms,
            least,
        }
    }

    #[inline]
    fn at(&self, t: Pair) -> Option<([Complex<f64>; 2], Complex<f64>)> {
        let (phase, low) = self.phase.at(t);
        if phase.is_nan() || phase.abs() >= TOO_FAR {
            return None;
        }
        let (sin, cos) = sin_cos_turns(phase - nearest(phase), low);
        let (up, down) = (Complex::new(cos, sin), Complex::new(cos, -sin));
        let mut sums = [Complex::new(0.0, 0.0); 4];
        for terms in &self.terms {
            sums[0] = (sums[0] + terms[0]) * up;
            sums[1] = (sums[1] + terms[1]) * down;
            sums[2] = (sums[2] + terms[2]) * up;
            sums[3] = (sums[3] + terms[3]) * down;
        }
        let functions = [self.constant[0] + (sums[0] + sums[1]), self.constant[1] + (sums[2] + sums[3])];
        Some((functions, up))
    }
}
