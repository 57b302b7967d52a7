//! Theta series as polynomials: what the two forms share.

use crate::flow::free::phase::{Pair, Phase, pair};
use crate::flow::free::polhode::{FEW, Lanes, Polhode, TOGETHER};
use crate::num::{Dd, Doubled, Real, Several};

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

/// What the series of a polhode are made of: A, B, C, I_a, I_b, I_c, sn and cn of the start, G, 2H, δ, σ, ±1 for half a period of u,
/// k'², k², ν.
pub(super) const GIVEN: usize = 16;

pub(super) fn given(polhode: &Polhode<Dd>) -> [Dd; GIVEN] {
    let ([amp_a, amp_b, amp_c], [i_a, i_b, i_c]) = (polhode.amplitude, polhode.moments);
    let (norm, twice_energy, (sn, cn)) = (polhode.norm, polhode.twice_energy, polhode.start);
    let (delta, sigma) = (polhode.delta, polhode.sigma);
    // half a period of u changes the sign of W and of cn
    let flip = if polhode.half_turned { -Dd::ONE } else { Dd::ONE };
    let (complement, parameter, rate) = (polhode.complement, polhode.parameter, polhode.rate);
    [
        amp_a,
        amp_b,
        amp_c,
        i_a,
        i_b,
        i_c,
        sn,
        cn,
        norm,
        twice_energy,
        delta,
        sigma,
        flip,
        complement,
        parameter,
        rate,
    ]
}

/// The numbers of one [`Series`], or of several, in double-double.
pub(super) struct Made<S> {
    /// Rate and start, as in [`Series`].
    pub(super) phase: [S; 2],
    pub(super) twist_rate: S,
    /// Even and odd part of Z, and of W.
    pub(super) sums: [[S; TERMS]; 4],
    pub(super) least: [S; LEAST_TERMS],
    pub(super) start: (S, S),
    /// Of the dual form, width and jump.
    pub(super) half_period: Option<[S; 2]>,
}

impl<S: Several> Made<S> {
    /// The series of motion `n`.
    pub(super) fn series(&self, n: usize) -> Series {
        let [rate, start] = self.phase;
        let [z_even, z_odd, w_even, w_odd] =
            self.sums.each_ref().map(|sum| sum.each_ref().map(|x| x.get(n).hi()));
        Series {
            form: match &self.half_period {
                Some([width, jump]) => Form::Dual { width: width.get(n).hi(), jump: pair(jump.get(n)) },
                None => Form::Direct,
            },
            phase: Phase::new(rate.get(n), start.get(n)),
            twist_rate: self.twist_rate.get(n),
            z: [z_even, z_odd],
            w: [w_even, w_odd],
            least: self.least.each_ref().map(|x| x.get(n).hi()),
            start: (self.start.0.get(n), self.start.1.get(n)),
        }
    }
}

/// The series of each of `polhodes`: as many as there are lanes by `side_by_side`, which gives the bits that `alone` gives.
pub(super) fn of_each(
    polhodes: &[&Polhode<Dd>],
    alone: fn(&Polhode<Dd>) -> Series,
    side_by_side: fn(&[Lanes; GIVEN], &[bool; TOGETHER]) -> Made<Lanes>,
) -> Vec<Series> {
    let mut all = Vec::with_capacity(polhodes.len());
    for group in polhodes.chunks(TOGETHER) {
        if group.len() < FEW {
            all.extend(group.iter().map(|polhode| alone(polhode)));
            continue;
        }
        let numbers = Lanes::gathered(group.iter().map(|polhode| given(polhode)));
        let mut about_smallest = [group[0].about_smallest; TOGETHER];
        about_smallest.iter_mut().zip(group).for_each(|(lane, polhode)| *lane = polhode.about_smallest);
        let made = side_by_side(&numbers, &about_smallest);
        all.extend((0..group.len()).map(|n| made.series(n)));
    }
    all
}

/// ψ' at u = 0; the form without differences, which would cancel for rods.
#[inline(always)]
pub(super) fn rate_at_zero<S: Real>(twice_energy: S, norm: S, amp_a: S, i_a: S) -> S {
    (twice_energy + norm * amp_a / i_a) / (norm + amp_a)
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
