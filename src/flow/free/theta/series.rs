//! Theta series as polynomials: what the two forms share.

use crate::flow::free::phase::{Pair, Phase};
use crate::flow::free::polhode::Polhode;
use crate::num::{Dd, Doubled, Real};

/// Terms of Z and W: the first left out are below 3e-20 of the sums.
pub(super) const TERMS: usize = 4;

/// Terms of the theta quotient along the smallest moment: below 7e-18.
pub(in crate::flow) const LEAST_TERMS: usize = 5;

/// Terms where sums are taken in double-double.
pub(super) const DD_TERMS: usize = 6;

/// How the sums are evaluated.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// Trigonometric sums in x.
    Direct,
    /// Hyperbolic sums in β, which is `width` times the reduced half periods; each half period adds `jump` turns to Ψ.
    Dual { width: f64, jump: Pair },
    /// The dual form for q' so small that only the first terms count.
    Limit { width: f64, jump: Pair },
    /// The same without a period.
    Separatrix,
}

/// Z, W and the theta quotient of one polhode in one form.
#[derive(Clone, Debug)]
pub(super) struct Series {
    pub(super) form: Form,
    /// Turns of x; half periods of u; β on the separatrix.
    pub(super) phase: Phase,
    /// Ψ', rad/s.
    pub(super) twist_rate: Dd,
    /// Even and odd part of Z, and of W.
    pub(super) z: [[f64; TERMS]; 2],
    pub(super) w: [[f64; TERMS]; 2],
    /// The component of m along the smallest moment, times n₂; both forms have n₂ = κ θ with the theta function of the
    /// denominator.
    pub(super) least: [f64; LEAST_TERMS],
    /// Re Z and Im Z at the start, up to a common factor.
    pub(super) start: (Dd, Dd),
}

/// ψ' at u = 0; the form without differences, which would cancel for rods.
pub(super) fn rate_at_zero(polhode: &Polhode<Dd>) -> Dd {
    let [a, ..] = polhode.amplitude;
    (polhode.twice_energy + polhode.norm * a / polhode.moments[0]) / (polhode.norm + a)
}

/// Half a period of u changes the sign of W and of cn.
pub(super) fn flip(polhode: &Polhode<Dd>) -> Dd {
    if polhode.half_turned { -Dd::ONE } else { Dd::ONE }
}

/// First two members F₀ = c, F₁ = a + bX of a family with F_{n+1} = 2X F_n − F_{n−1}, as [c, a, b].
pub(in crate::flow) type Family = [f64; 3];
/// cos 2nx of X = cos 2x.
pub(in crate::flow) const T: Family = [1.0, 0.0, 1.0];
/// sin 2nx / sin 2x.
pub(in crate::flow) const U: Family = [0.0, 1.0, 0.0];
/// sin (2n+1)x / sin x.
pub(in crate::flow) const V_PLUS: Family = [1.0, 1.0, 2.0];
/// cos (2n+1)x / cos x.
pub(in crate::flow) const V_MINUS: Family = [1.0, -1.0, 2.0];

/// Coefficients of powers of X in Σ v_n F_n(X), rounded once.
pub(in crate::flow) fn polynomial<const N: usize>(v: [Dd; N], family: Family) -> [f64; N] {
    coefficients(v, family).map(Dd::hi)
}

/// The same before they are rounded.
#[inline(always)]
pub(super) fn coefficients<S: Doubled, const N: usize>(v: [S; N], [c, a, b]: Family) -> [S; N] {
    let mut sum = [S::of(0.0); N];
    let (mut before, mut now) = ([0.0; N], [0.0; N]);
    before[0] = c;
    now[0] = a;
    now[1] = b;
    for v in v {
        for k in 0..N {
            // every other one is zero
            if before[k] != 0.0 {
                sum[k] = sum[k] + v * before[k];
            }
        }
        let mut next = [0.0; N];
        for k in 0..N {
            next[k] = if k > 0 { 2.0 * now[k - 1] } else { 0.0 } - before[k];
        }
        (before, now) = (now, next);
    }
    sum
}

/// The cubic at `x`.
#[inline]
pub(super) fn value(p: &[f64; TERMS], x: f64) -> f64 {
    (p[0] + p[1] * x) + x * x * (p[2] + p[3] * x)
}

/// The quartic at `x`.
#[inline]
pub(in crate::flow) fn least_value(p: &[f64; LEAST_TERMS], x: f64) -> f64 {
    let x2 = x * x;
    (p[0] + p[1] * x) + x2 * ((p[2] + p[3] * x) + x2 * p[4])
}

pub(super) fn first<S: Copy>(v: &[S; DD_TERMS]) -> [S; TERMS] {
    [v[0], v[1], v[2], v[3]]
}

#[inline(always)]
pub(super) fn total<S: Real>(v: &[S; DD_TERMS]) -> S {
    let mut sum = S::of(0.0);
    for x in v.iter().rev() {
        sum = sum + *x;
    }
    sum
}

/// Powers of one number below the 32nd, from its squares.
#[derive(Clone, Copy, Debug)]
pub(in crate::flow) struct Powers<S> {
    /// x, x², x⁴ and so on.
    squares: [S; 5],
}

impl<S: Real> Powers<S> {
    #[inline(always)]
    pub(in crate::flow) fn of(x: S) -> Self {
        let mut squares = [x; 5];
        for n in 1..squares.len() {
            squares[n] = squares[n - 1] * squares[n - 1];
        }
        Powers { squares }
    }

    #[inline(always)]
    pub(in crate::flow) fn power(&self, n: u32) -> S {
        let (mut product, mut is_first) = (S::of(1.0), true);
        for (k, square) in self.squares.iter().enumerate() {
            if n >> k & 1 == 1 {
                product = if is_first { *square } else { product * *square };
                is_first = false;
            }
        }
        product
    }
}
