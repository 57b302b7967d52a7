//! Jacobi's functions from the complementary parameter.

use super::r_f;
use crate::num::{Dd, Precise, Several};

/// Products with integers of this size are still doubles.
const FAR: f64 = 1e300;
/// 2¹⁰⁶ to this power is beyond it.
const PASSES: usize = 10;

/// Steps of the arithmetic-geometric mean that the smallest subnormal m1 needs in `Dd`.
const STEPS: usize = 20;

/// A modulus, given by m1 = k'², with its arithmetic-geometric mean: computed once, then used for any argument.
///
/// ```
/// use polhode::num::elliptic::Modulus;
/// let circle = Modulus::new(1.0); // m = 0: sine, cosine and 1
/// let (sn, cn, dn) = circle.sn_cn_dn(0.5);
/// assert!((sn - libm::sin(0.5)).abs() < 1e-15 && (cn - libm::cos(0.5)).abs() < 1e-15 && dn == 1.0);
/// assert_eq!(circle.quarter_period(), core::f64::consts::FRAC_PI_2);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Modulus<S> {
    complement: S,
    /// The pairs (arithmetic, geometric) on the way to the mean.
    ladder: [(S, S); STEPS],
    steps: usize,
    mean: S,
}

impl<S: Precise> Modulus<S> {
    /// The modulus of the complementary parameter m1 in [0, 1], or not far above, where m is negative. A negative or
    /// undefined m1 makes all readings NaN.
    pub fn new(m1: S) -> Self {
        Self::of(m1)
    }

    /// k' = √m1.
    #[inline]
    pub(crate) fn complementary_modulus(&self) -> S {
        self.ladder[0].1
    }

    /// K, a quarter of the real period; infinite for m1 = 0.
    pub fn quarter_period(&self) -> S {
        S::from_dd(Dd::FRAC_PI_2) / self.mean
    }

    /// (sn u, cn u, dn u) for |u| ≤ K; for larger arguments see [`jacobi`].
    ///
    /// R. Bulirsch, Numer. Math. 7 (1965) 78–90: all additions are of positive numbers. What error remains
    /// is that of u times the condition of the function, about |u| for cn and dn when m1 is small, and
    /// K/|K − |u|| for cn close to its zero.
    pub fn sn_cn_dn(&self, u: S) -> (S, S, S) {
        let one = S::of(1.0);
        if u.magnitude() < S::ROUNDOFF.sqrt() {
            return (u, one, one);
        }
        if self.complement == S::of(0.0) {
            return hyperbolic(u);
        }
        let (s, c) = (u * self.mean).sin_cos();
        let mut cotangent = c / s;
        let mut scaled = self.mean * cotangent;
        let mut dn = one;
        for &(arithmetic, geometric) in self.ladder[..self.steps].iter().rev() {
            let square = cotangent * scaled;
            scaled = scaled * dn;
            dn = (geometric + square) / (arithmetic + square);
            cotangent = scaled / arithmetic;
        }
        let sn = one / (one + cotangent * cotangent).sqrt();
        let sn = if u < S::of(0.0) { -sn } else { sn };
        (sn, cotangent * sn, dn)
    }

    /// Takes sin² z to sn²(2 K z/π) for each of `squares`, by Gauss's transformation (NIST DLMF 22.7(i)): the arguments do not
    /// wait for each other.
    #[inline(always)]
    pub(crate) fn sn_squared(&self, squares: &mut [S]) {
        let one = S::of(1.0);
        for &(arithmetic, geometric) in self.ladder[..self.steps].iter().rev() {
            let k = (arithmetic - geometric) / (arithmetic + geometric);
            let grown = (one + k) * (one + k);
            for square in &mut *squares {
                let shrunk = one + k * *square;
                *square = grown * *square / (shrunk * shrunk);
            }
        }
    }
}

impl<S: Copy> Modulus<S> {
    /// The same of one number or of several.
    #[inline(always)]
    fn of(m1: S) -> Self
    where
        S: Several,
    {
        let mut ladder = [(S::of(1.0), m1.sqrt()); STEPS];
        let mut steps = 1;
        while steps < STEPS {
            let (a, b) = ladder[steps - 1];
            let gap = a - b;
            let mut apart = false;
            for n in 0..S::COUNT {
                apart |= is_apart::<S>(gap.get(n), a.get(n));
            }
            if !apart {
                break;
            }
            let (mut mean, mut root) = ((a + b).times_power_of_two(0.5), (a * b).sqrt());
            for n in 0..S::COUNT {
                let moves = is_apart::<S>(gap.get(n), a.get(n));
                mean.set(n, if moves { mean.get(n) } else { a.get(n) });
                root.set(n, if moves { root.get(n) } else { b.get(n) });
            }
            ladder[steps] = (mean, root);
            steps += 1;
        }
        let (a, b) = ladder[steps - 1];
        let mut mean = (a + b).times_power_of_two(0.5);
        for n in 0..S::COUNT {
            mean.set(n, if b.get(n) == Dd::ZERO { b.get(n) } else { mean.get(n) });
        }
        Modulus { complement: m1, ladder, steps, mean }
    }
}

/// Whether a step has to be taken between the arithmetic mean `a` and the geometric one.
#[inline(always)]
fn is_apart<S: Several>(gap: Dd, a: Dd) -> bool {
    let is_near = gap.hi().abs() <= S::ROUNDOFF.sqrt() * a.hi().abs();
    !is_near
}

/// K of each complementary parameter, as [`Modulus`] has it.
#[inline(always)]
pub(crate) fn quarter_period<S: Several>(m1: S) -> S {
    S::from_dd(Dd::FRAC_PI_2) / Modulus::of(m1).mean
}

/// (tanh u, sech u, sech u), the functions at m1 = 0.
fn hyperbolic<S: Precise>(u: S) -> (S, S, S) {
    let two = S::of(2.0);
    let fall = (-(u.abs() * two)).exp_m1();
    let tanh = -fall / (two + fall);
    let sech = two * (-u.abs()).exp() / (two + fall);
    (if u < S::of(0.0) { -tanh } else { tanh }, sech, sech)
}

/// (sn u, cn u, dn u) of any real argument, for a complementary parameter as in [`Modulus::new`].
///
/// Everything is done in double-double, so in `f64` the results are right to the last place for |u| up to about 10¹², next to
/// the zeros of cn too; they stay on the curve sn² + cn² = 1 at any u. Where one m1 serves many arguments, [`Modulus`] is many
/// times faster.
///
/// ```
/// use polhode::num::elliptic::jacobi;
/// let (sn, cn, dn) = jacobi(1e6, 0.5);
/// assert!((sn * sn + cn * cn - 1.0).abs() < 1e-15);
/// assert!((dn * dn + 0.5 * sn * sn - 1.0).abs() < 1e-15);
/// ```
pub fn jacobi<S: Precise>(u: S, m1: S) -> (S, S, S) {
    let modulus = Modulus::new(m1.to_dd());
    let (mut rest, mut sign) = (u.to_dd(), 1.0);
    let half_period = modulus.quarter_period() * 2.0;
    if rest.hi().abs() >= FAR && rest.hi().is_finite() {
        // no digit of the place in the period is left
        rest = Dd::from(FAR.copysign(rest.hi()));
    }
    // each pass takes off the leading 106 bits of the quotient, which mostly are all
    for _ in 0..PASSES {
        if m1 == S::of(0.0) {
            break;
        }
        let halves = (rest / half_period).round();
        rest = rest - half_period * halves;
        sign *= 1.0 - 2.0 * halves.rem_euclid(2.0);
        if rest.hi().abs() <= half_period.hi() {
            break;
        }
    }
    let (sn, cn, dn) = modulus.sn_cn_dn(rest);
    (S::from_dd(sn * sign), S::from_dd(cn * sign), S::from_dd(dn))
}

/// F, the argument u in [−K, K] whose functions are `sn` and `cn` ≥ 0, for the parameters m and m1 = 1 − m.
///
/// Taken from the pair and not from an angle, it keeps all digits at both ends: u = sn R_F(cn², m1 + m cn², 1).
/// Infinite at sn = ±1 for m1 = 0.
///
/// ```
/// use polhode::num::elliptic::incomplete;
/// let angle = incomplete(0.6, 0.8, 0.0, 1.0); // m = 0: the angle itself
/// assert!((angle - libm::asin(0.6)).abs() < 1e-15);
/// ```
pub fn incomplete<S: Precise>(sn: S, cn: S, m: S, m1: S) -> S {
    sn * r_f(cn * cn, m1 + m * cn * cn, S::of(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gausss_transformation_gives_the_squares_of_sn() {
        for n in 0..=60 {
            let modulus = Modulus::new(libm::exp2(-f64::from(n)));
            for k in 0..48 {
                let z = core::f64::consts::FRAC_PI_2 * (f64::from(k) + 0.5) / 48.0;
                let mut square = [libm::sin(z) * libm::sin(z)];
                modulus.sn_squared(&mut square);
                let (sn, ..) = modulus.sn_cn_dn(modulus.quarter_period() * (f64::from(k) + 0.5) / 48.0);
                approx::assert_relative_eq!(square[0], sn * sn, max_relative = 3e-15);
            }
        }
    }
}
