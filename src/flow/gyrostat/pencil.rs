//! The curve y² = P(μ) of a level: its mean root, invariants and the roots of its cubic, with as many digits as they take.
//!
//! With `P = a₀μ⁴ + q₁μ³ + q₂μ² + q₃μ + a₄` and
//!
//! `I = 12 a₀a₄ − 3 q₁q₃ + q₂²`, `J = 72 a₀q₂a₄ + 9 q₁q₂q₃ − 2 q₂³ − 27 a₀q₃² − 27 q₁²a₄`
//!
//! the roots of 4x³ − g₂x − g₃ are e = w/12, `w³ − 3Iw − J = 0`. Next to a separatrix, and where three of the roots of P are
//! close beside the fourth, I and J cancel, so that the period would lose digits; they are then worked out with twice the
//! digits of a double-double, from moments and momenta without a quotient: with D = I₁I₂I₃, D_k = D/I_k, x = Dμ
//!
//! `D⁴G² P = −Σ_k (N_k − x m_k)² Π_{j≠k} (B_j − x)`, `B_k = D_k − D_μ`, `N_k = B_k m_k − D_k h_k`.

use core::ops::{Add, Mul, Sub};

use crate::num::{Dd, Expansion, Real};
use crate::rotation::Vec3;

/// Below this share of digits left the wide form is taken.
const LOST: f64 = 1e-5;

/// Square of a difference of roots, of the terms, where it is next to lost beside the larger ones.
const EQUAL: f64 = 1e-15;

/// Of equal roots, the square of their difference in the terms that it is a sum of: rounding of both forms.
const ROUNDING: f64 = 1e-30;
const WIDE_ROUNDING: f64 = 1e-58;

/// The curve in units in which a₀ = −1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pencil {
    /// The mean of the roots of P, μ̄.
    pub(super) centre: Dd,
    /// `P(μ̄ + x) = −x⁴ + 6 A₂x² + 4 A₃x + A₄`: A₂ and A₃.
    pub(super) second: Dd,
    pub(super) third: Dd,
    /// The root e that is farther from the other two than these are apart, and the square of the difference of these.
    pub(super) single: Dd,
    pub(super) split: Dd,
    /// What the difference of the points at infinity, −A₂, has more than `single`.
    pub(super) above: Dd,
    /// The size of the terms of g₂.
    pub(super) terms: f64,
    /// 1, or the share (e₁ − e₂)² of the terms where the lower root is the single one: it is zero on a separatrix.
    pub(super) apart: f64,
}

/// Numbers that the coefficients are formed of.
trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    fn whole(n: i32) -> Self;
    fn rounded(self) -> Dd;
}

impl Number for Dd {
    fn whole(n: i32) -> Dd {
        Dd::of(f64::from(n))
    }
    fn rounded(self) -> Dd {
        self
    }
}

/// Some 212 bits.
#[derive(Clone, Copy)]
struct Wide([Dd; 2]);

impl Wide {
    fn of(x: Dd) -> Self {
        Wide([x, Dd::ZERO])
    }

    fn exact(self) -> Expansion {
        &Expansion::from(self.0[0]) + &Expansion::from(self.0[1])
    }

    fn nearest(x: &Expansion) -> Self {
        let high = x.to_dd();
        Wide([high, (x - &Expansion::from(high)).to_dd()])
    }
}

impl Number for Wide {
    fn whole(n: i32) -> Self {
        Wide::of(Dd::of(f64::from(n)))
    }
    fn rounded(self) -> Dd {
        self.0[0]
    }
}

impl Add for Wide {
    type Output = Wide;
    fn add(self, b: Wide) -> Wide {
        Wide::nearest(&(&self.exact() + &b.exact()))
    }
}

impl Sub for Wide {
    type Output = Wide;
    fn sub(self, b: Wide) -> Wide {
        Wide::nearest(&(&self.exact() - &b.exact()))
    }
}

impl Mul for Wide {
    type Output = Wide;
    fn mul(self, b: Wide) -> Wide {
        Wide::nearest(&(&self.exact() * &b.exact()))
    }
}

/// Coefficients of −P, from that of μ⁰ up.
fn coefficients<T: Number>(b: [T; 3], n: [T; 3], nu: [T; 3]) -> [T; 5] {
    let mut sums = [T::whole(0); 5];
    for k in 0..3 {
        let (j, l) = ((k + 1) % 3, (k + 2) % 3);
        let cross = nu[k] * n[k];
        let square = [nu[k] * nu[k], T::whole(0) - (cross + cross), n[k] * n[k]];
        let others = [b[j] * b[l], T::whole(0) - (b[j] + b[l]), T::whole(1)];
        for (x, first) in square.into_iter().enumerate() {
            for (y, second) in others.into_iter().enumerate() {
                sums[x + y] = sums[x + y] + first * second;
            }
        }
    }
    sums
}

/// I, J, and 48 a₀ and 32 times what A₂ and A₃ are without the powers of a₀.
struct Invariants<T> {
    i: T,
    j: T,
    second: T,
    third: T,
    leading: T,
    cubic: T,
}

impl<T: Number> Invariants<T> {
    fn of(minus: [T; 5]) -> Self {
        let times = |n: i32, x: T| T::whole(n) * x;
        let [a4, q3, q2, q1, a0] = minus.map(|c| T::whole(0) - c);
        let (ends, middle, squares) = (a0 * a4, q1 * q3, q2 * q2);
        let i = times(12, ends) - times(3, middle) + squares;
        let even = times(72, ends) + times(9, middle) - times(2, squares);
        let j = q2 * even - times(27, a0 * (q3 * q3) + (q1 * q1) * a4);
        let second = times(3, q1 * q1) - times(8, a0 * q2);
        let third = q1 * (q1 * q1 - times(4, a0 * q2)) + times(8, (a0 * a0) * q3);
        Invariants { i, j, second, third, leading: a0, cubic: q1 }
    }

    /// With the root w next to `root`, and x = `unit` μ.
    fn pencil(&self, mut root: T, lift: impl Fn(Dd) -> T, unit: Dd) -> Pencil {
        let times = |n: i32, x: T| T::whole(n) * x;
        for _ in 0..3 {
            let square = root * root;
            let off = root * (square - times(3, self.i)) - self.j;
            root = root - lift(off.rounded() / (times(3, square - self.i)).rounded());
        }
        let a0 = self.leading.rounded();
        // e and X of x over those of μ: G² D² S²
        let scale = -(a0 * unit * unit);
        let split = (times(4, self.i) - root * root).rounded() / 48.0;
        let above = (self.second - times(4, self.leading * root)).rounded() / (a0 * 48.0);
        let cube = -(a0 * a0 * a0 * unit * unit * unit);
        Pencil {
            centre: -(self.cubic.rounded() / (a0 * 4.0)) / unit,
            second: -(self.second.rounded() / (a0 * 48.0)) / scale,
            third: self.third.rounded() / 32.0 / cube,
            single: root.rounded() / 12.0 / scale,
            split: split / (scale * scale),
            above: above / scale,
            terms: 0.0,
            apart: 1.0,
        }
    }
}

impl Pencil {
    /// In units of S, from n, b and ν; `exact` is asked where they have too few digits.
    pub(super) fn of(
        b: Vec3<Dd>,
        n: Vec3<Dd>,
        nu: Vec3<Dd>,
        exact: impl FnOnce() -> Option<WideCurve>,
    ) -> Self {
        let minus = coefficients(b.0, n.0, nu.0);
        let invariants = Invariants::of(minus);
        let root = isolated(invariants.i, invariants.j);
        let mut pencil = invariants.pencil(root, |x| x, Dd::ONE);
        pencil.terms = terms(b, n, nu, pencil.centre.magnitude());
        let (single, second) = (pencil.single.magnitude(), pencil.second.magnitude());
        let kept = single * single * single / (pencil.terms * (second + single));
        let apart = |pencil: &Pencil| {
            let is_low = pencil.single < Dd::ZERO;
            if is_low { (pencil.split.magnitude() / pencil.terms).min(1.0) } else { 1.0 }
        };
        let mut rounding = ROUNDING;
        // of roots that are all but equal the difference is told by the wide form
        let left = kept.min(apart(&pencil)).min(pencil.split.magnitude() / pencil.terms / EQUAL);
        let exact = if left < LOST || left.is_nan() { exact() } else { None };
        if let Some(exact) = exact {
            let scale = exact.invariants.leading.rounded() * exact.unit * exact.unit;
            let start = -(scale * pencil.single * 12.0);
            let terms = pencil.terms;
            pencil = exact.invariants.pencil(Wide::of(start), Wide::of, exact.unit);
            pencil.terms = terms;
            rounding = WIDE_ROUNDING;
        }
        pencil.apart = apart(&pencil);
        if pencil.split.magnitude() < pencil.terms * rounding {
            pencil.split = Dd::ZERO;
        }
        pencil
    }
}

/// The curve in x = D μ.
pub(super) struct WideCurve {
    invariants: Invariants<Wide>,
    unit: Dd,
}

impl WideCurve {
    /// Of moments, h and m, which are multiplied by powers of two that bring them near one, for μ in units of 2^`unit` of their
    /// 1/I.
    pub(super) fn new(moments: Vec3<Dd>, wheel: Vec3<Dd>, m: Vec3<Dd>, unit: i32) -> Self {
        let i = moments.0.map(Wide::of);
        let [_, middle, _] = moments.ascending();
        let product = |k: usize| i[(k + 1) % 3] * i[(k + 2) % 3];
        let zero = Wide::whole(0);
        let (mut b, mut nu) = ([zero; 3], [zero; 3]);
        for k in 0..3 {
            b[k] = product(k) - product(middle);
            nu[k] = b[k] * Wide::of(m[k]) - product(k) * Wide::of(wheel[k]);
        }
        let whole = (product(0) * i[0]).rounded();
        let invariants = Invariants::of(coefficients(b, m.0.map(Wide::of), nu));
        WideCurve { invariants, unit: whole.scaled(unit) }
    }
}

/// The size of the terms of g₂ around the mean root `centre`.
fn terms(b: Vec3<Dd>, n: Vec3<Dd>, nu: Vec3<Dd>, centre: f64) -> f64 {
    let [b, n, nu] = [b, n, nu].map(|v| v.0.map(Dd::magnitude));
    (0..3)
        .map(|k| {
            let root = nu[k] + n[k] * centre;
            root * root * (b[(k + 1) % 3] + centre) * (b[(k + 2) % 3] + centre)
        })
        .sum()
}

/// The root of w³ − 3Iw − J that is farther from the other two than these from each other, by Newton's method from outside.
fn isolated(i: Dd, j: Dd) -> Dd {
    let (i, size) = (i.hi(), j.hi().abs());
    let mut w = (6.0 * i.max(0.0)).sqrt().max(libm::cbrt(2.0 * size));
    for _ in 0..200 {
        let next = w - ((w * w - 3.0 * i) * w - size) / (3.0 * (w * w - i));
        if next.is_nan() || next >= w {
            break;
        }
        w = next;
    }
    Dd::of(if j < Dd::ZERO { -w } else { w })
}
