//! The heavy ball on its symmetry axis: what is left of Lagrange's top when its spin about the axis is split off.
//!
//! A symmetric top (A, A, C) moves as the ball (A, A, A) of the same m, turned on the right about e₃ at the rate
//! m₃ (1/C − 1/A). The Cayley–Klein parameters α = w + iz, β = x + iy of the ball obey Lamé's equation each, so they
//! are analytic in time: there is no singularity where the axis is vertical, and none is put in here.
//!
//! # Notation
//! | letter | meaning |
//! |---|---|
//! | u, x, y | cosine of the tilt, 1 + u = 2\|α\|², 1 − u = 2\|β\|² |
//! | b | 2 c/A, c the weight moment |
//! | a, e, d | m₃/A, (m·Γ + m₃)/A, (m·Γ − m₃)/A |
//! | u₁ ≤ u₂ ≤ 1 ≤ u₃ | zeros of `u'² = b (u − u₁)(u − u₂)(u − u₃)`; x_k = 1 + u_k, y_k = 1 − u_k, w₃ = u₃ − 1 |
//! | Ω, k | ½ √(b (u₃ − u₁)), k² = (u₂ − u₁)/(u₃ − u₁) |
//! | τ, σ | elliptic arguments from the lowest point, u = u₁ + (u₂ − u₁) sn²τ, and from the highest |
//!
//! The phases are third-kind integrals, `(arg α)' = e/(2x)`, `(arg β)' = d/(2y)`. Where x or y can become small the
//! part that jumps there is taken out of the integral (DLMF 19.7.9): its arc tangent multiplies with |α| to something
//! linear in sn, cn and dn, and what remains in the integral is smooth.

use core::any::Any;

use super::cubic::Start;
use crate::flow::free::reduce;
use crate::num::complex::Complex;
use crate::num::elliptic::{Modulus, incomplete, r_j};
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// Radians of arg α from which `f64` is too short for them.
const LONG: f64 = 8.0;

/// The nutation of one heavy ball.
#[derive(Clone, Debug)]
pub(super) struct Nutation {
    pub(super) rate: Dd,       // Ω
    pub(super) parameter: Dd,  // k²
    pub(super) complement: Dd, // k'²
    modulus: Modulus<Dd>,
    pub(super) half: Option<Dd>, // K, unless infinite
    pub(super) phase: Dd,        // τ at t = 0
    pub(super) span: Dd,         // u₂ − u₁
    pub(super) x: [Dd; 3],
    pub(super) y: [Dd; 2],
    pub(super) w3: Dd,
    pub(super) e: Dd,
    pub(super) d: Dd,
    /// 1 + u and 1 − u where the transverse angular velocity would vanish.
    pub(super) apex: [Dd; 2],
    alpha_advance: Dd, // of the smooth phase over 2K
    beta_advance: Dd,
    alpha_start: Complex<Dd>, // what the phases at t = 0 lack
    beta_start: Complex<Dd>,
}

/// sn, cn, dn.
#[derive(Clone, Copy)]
struct Jacobi<T> {
    u: Dd,
    sn: T,
    cn: T,
    dn: T,
}

/// A Cayley–Klein parameter and its derivative in t.
#[derive(Clone, Copy)]
struct Moving<T> {
    value: Complex<T>,
    rate: Complex<T>,
}

/// `phase · value / √(2m)`, the form of a parameter that may come close to 0; derivatives in the elliptic argument.
struct Quotient<T> {
    /// e^{iJ} of the smooth phase J.
    phase: Complex<T>,
    /// J'.
    phase_rate: T,
    value: Complex<T>,
    derivative: Complex<T>,
    m: T,
    /// Of m' = 2 n sn cn dn.
    n: T,
}

impl Nutation {
    /// Of a ball with b = 2c/A > 0 whose axis is not at rest on the vertical.
    pub(super) fn new(b: Dd, q: Quat<Dd>, omega: Vec3<Dd>) -> Self {
        let start = Start::of(b, q, omega);
        let ([x1, x2, x3], [y1, y2], w3) = start.zeros();
        let span = if x1 < Dd::ONE { x2 - x1 } else { y1 - y2 };
        let between = x3 - x1;
        let rate = (b * between).sqrt() * Dd::of(0.5);
        let (parameter, complement) = (span / between, (w3 + y2) / between);
        let modulus = Modulus::new(complement);
        let half = (complement.hi() > 0.0).then(|| modulus.quarter_period());

        let mut nutation = Nutation {
            rate,
            parameter,
            complement,
            modulus,
            half,
            phase: Dd::ZERO,
            span,
            x: [x1, x2, x3],
            y: [y1, y2],
            w3,
            e: start.e,
            d: start.d,
            apex: [start.x + start.transverse / b, start.y - start.transverse / b],
            alpha_advance: Dd::ZERO,
            beta_advance: Dd::ZERO,
            alpha_start: Complex::new(Dd::ONE, Dd::ZERO),
            beta_start: Complex::new(Dd::ONE, Dd::ZERO),
        };
        nutation.phase = nutation.phase_of(&start);
        if let Some(k) = half {
            let end = Jacobi { u: k, sn: Dd::ONE, cn: Dd::ZERO, dn: complement.sqrt() };
            nutation.alpha_advance = nutation.alpha_phase(end) * Dd::of(2.0);
            nutation.beta_advance = nutation.beta_phase(end) * Dd::of(2.0);
        }
        let (alpha, beta) = nutation.parameters(Dd::ZERO);
        // value and derivative together: one of them is clear of zero
        let weight = Dd::ONE / (rate * rate);
        let lack = |found: Moving<Dd>, value: Complex<Dd>, rate: Complex<Dd>| {
            let z = value * found.value.conjugate() + (rate * found.rate.conjugate()).scaled(weight);
            let size = z.norm_squared().sqrt();
            if size.hi() == 0.0 { Complex::new(Dd::ONE, Dd::ZERO) } else { z.scaled(Dd::ONE / size) }
        };
        let split = |q: Quat<Dd>| (Complex::new(q.w, q.v[2]), Complex::new(q.v[0], q.v[1]));
        let ((alpha_value, beta_value), (alpha_rate, beta_rate)) = (split(q), split(q.rate(omega)));
        nutation.alpha_start = lack(alpha, alpha_value, alpha_rate);
        nutation.beta_start = lack(beta, beta_value, beta_rate);
        nutation
    }

    /// Cosines of the tilt at the turning points, the lower one first, as (1 + u, 1 − u).
    pub(super) fn turning_points(&self) -> [(Dd, Dd); 2] {
        [(self.x[0], self.y[0]), (self.x[1], self.y[1])]
    }

    /// From one lowest point to the next; `None` if there is no next.
    pub(super) fn period(&self) -> Option<Dd> {
        self.half.map(|k| k * Dd::of(2.0) / self.rate)
    }

    /// Advance of the azimuth over one period.
    pub(super) fn precession(&self) -> Option<Dd> {
        let [alpha, beta] = self.advances();
        self.half.map(|_| alpha + beta)
    }

    /// Of arg α and arg β over one period.
    pub(super) fn advances(&self) -> [Dd; 2] {
        let jump = |jumps: bool| if jumps { Dd::PI } else { Dd::ZERO };
        [
            (self.alpha_advance + jump(self.alpha_jumps())) * sign_of(self.e),
            (self.beta_advance + jump(self.beta_jumps())) * sign_of(self.d),
        ]
    }

    /// m·Γ/A − a u_ζ, u_ζ the value of u where the transverse angular velocity would vanish.
    pub(super) fn apex_product(&self) -> Dd {
        let [x, y] = self.apex;
        (self.e * y + self.d * x) * 0.5
    }

    /// u_ζ − u₂ and u₃ − u_ζ: of the two only the larger is a difference.
    pub(super) fn apex_apart(&self) -> [Dd; 2] {
        let ([x1, x2, x3], y2, [x, y]) = (self.x, self.y[1], self.apex);
        let off = self.apex_product();
        let product = off * off * (x3 - x1) / (self.rate * self.rate * 4.0 * (x - x1));
        let above = if x < Dd::ONE { x3 - x } else { self.w3 + y };
        let below = if x < Dd::ONE { x - x2 } else { y2 - y };
        if above > below { [product / above, above] } else { [below, product / below] }
    }

    /// q and q' at time `t`.
    pub(super) fn at<T: Precise>(&self, t: Dd) -> (Quat<T>, Quat<T>) {
        let (alpha, beta) = self.parameters::<T>(t);
        let lacking = |z: Complex<Dd>| Complex::new(T::from_dd(z.re), T::from_dd(z.im));
        let (alpha_start, beta_start) = (lacking(self.alpha_start), lacking(self.beta_start));
        let join = |alpha: Complex<T>, beta: Complex<T>| {
            let (alpha, beta) = (alpha * alpha_start, beta * beta_start);
            Quat::new(alpha.re, Vec3([beta.re, beta.im, alpha.im]))
        };
        (join(alpha.value, beta.value), join(alpha.rate, beta.rate))
    }

    /// τ at the start, in [−K, K]. At a turning point u − u_k has lost half its digits; there u' has them.
    fn phase_of(&self, start: &Start) -> Dd {
        let near_top = start.y < start.x;
        let above = if near_top { self.y[0] - start.y } else { start.x - self.x[0] };
        let below = if near_top { start.y - self.y[1] } else { self.x[1] - start.x };
        let root = |x: Dd| if x > Dd::ZERO { (x / self.span).sqrt() } else { Dd::ZERO };
        if self.span.hi() <= 0.0 {
            return Dd::ZERO;
        }
        let (mut sn, mut cn) = (root(above), root(below));
        let dn = (self.complement + self.parameter * cn * cn).sqrt();
        // u' = 2 Ω (u₂ − u₁) sn cn dn
        let product = start.u_rate / (Dd::of(2.0) * self.rate * self.span);
        if above > below {
            let signed = if start.u_rate < Dd::ZERO { -sn } else { sn };
            if dn.hi() > 0.0 {
                cn = (product / (sn * dn)).abs();
            }
            sn = signed;
        } else {
            sn = product / (cn * dn);
        }
        let size = (sn * sn + cn * cn).sqrt();
        (sn, cn) = (sn / size, cn / size);
        incomplete(sn, cn, self.parameter, self.complement)
    }

    /// The modulus of k'², with the digits of `T`.
    fn modulus<T: Precise>(&self) -> Modulus<T> {
        let kept = (&self.modulus as &dyn Any).downcast_ref();
        kept.copied().unwrap_or_else(|| Modulus::new(T::from_dd(self.complement)))
    }

    /// α and β without the phases of the start.
    fn parameters<T: Precise>(&self, t: Dd) -> (Moving<T>, Moving<T>) {
        let tau = self.phase + self.rate * t;
        let modulus = self.modulus::<T>();
        let evaluate = |u: Dd| {
            let (sn, cn, dn) = modulus.sn_cn_dn(T::from_dd(u));
            Jacobi { u, sn, cn, dn }
        };
        let Some(half) = self.half else {
            let from_lowest = evaluate(tau);
            return (self.alpha(from_lowest), self.homoclinic_beta(from_lowest));
        };
        let periods = (tau / (half * Dd::of(2.0))).round();
        let tau = tau - periods * half * Dd::of(2.0);
        let side = if tau < Dd::ZERO { -Dd::ONE } else { Dd::ONE };
        let sigma = tau - side * half;
        let beta_periods = if tau < Dd::ZERO { periods - Dd::ONE } else { periods };
        // a quarter period on or back: sn → ±cd, cn → ∓k' sd, dn → k' nd
        let k = modulus.complementary_modulus();
        let quarter = |f: Jacobi<T>, u: Dd, side: Dd| {
            let side = T::from_dd(side);
            Jacobi { u, sn: side * f.cn / f.dn, cn: -(side * k * f.sn / f.dn), dn: k / f.dn }
        };
        let (from_lowest, from_highest) = if tau.abs() < sigma.abs() {
            let f = evaluate(tau);
            (f, quarter(f, sigma, -side))
        } else {
            let f = evaluate(sigma);
            (quarter(f, tau, side), f)
        };
        let advanced = |f: Moving<T>, sign: Dd, advance: Dd, periods: Dd, jumps: bool| {
            let odd = jumps && periods.rem_euclid(2.0) != 0.0;
            let angle = reduce(sign_of(sign) * advance * periods, Dd::TAU);
            let turn = Complex::phase(T::from_dd(angle)).scaled(T::of(if odd { -1.0 } else { 1.0 }));
            Moving { value: f.value * turn, rate: f.rate * turn }
        };
        (
            advanced(self.alpha(from_lowest), self.e, self.alpha_advance, periods, self.alpha_jumps()),
            advanced(self.beta(from_highest), self.d, self.beta_advance, beta_periods, self.beta_jumps()),
        )
    }

    /// Whether x may come close to 0, so that the jump of arg α is taken out of the integral.
    fn alpha_jumps(&self) -> bool {
        self.x[0] * Dd::of(2.0) <= self.x[2]
    }

    /// Whether y may come close to 0 at the highest point faster than u₃ − 1.
    fn beta_jumps(&self) -> bool {
        self.y[1] <= self.w3
    }

    /// The smooth part of |arg α|, an odd function of τ.
    fn alpha_phase<T: Precise>(&self, f: Jacobi<T>) -> T {
        let [x1, x2, x3] = self.x;
        let rate = self.e.abs() / (self.rate * Dd::of(2.0));
        if self.alpha_jumps() {
            T::from_dd(rate / (x3 - x1)) * self.third_kind(f, x1 / (x3 - x1))
        } else {
            let n = (x2 - x1) / x1;
            T::from_dd(rate / x1) * (T::from_dd(f.u) - T::from_dd(n) * self.third_kind(f, n))
        }
    }

    /// [`alpha_phase`](Self::alpha_phase) but for whole turns. Next to the separatrix of the sleeping top the axis nods
    /// slowly and arg α makes many turns meanwhile: there all of it is evaluated in double-double.
    fn alpha_angle<T: Precise>(&self, f: Jacobi<T>) -> T {
        let turning = self.e.abs() / (self.rate * Dd::of(2.0) * self.x[0]);
        if self.alpha_jumps() || (turning * f.u).magnitude() < LONG {
            return self.alpha_phase(f);
        }
        let (sn, cn, dn) = self.modulus.sn_cn_dn(f.u);
        T::from_dd(reduce(self.alpha_phase(Jacobi { u: f.u, sn, cn, dn }), Dd::TAU))
    }

    /// The smooth part of |arg β|, an odd function of σ.
    fn beta_phase<T: Precise>(&self, f: Jacobi<T>) -> T {
        let ([_, y2], w3) = (self.y, self.w3);
        let rate = self.d.abs() / (self.rate * Dd::of(2.0));
        if rate.hi() == 0.0 {
            return T::of(0.0);
        }
        if self.beta_jumps() {
            let r = y2 / w3;
            T::from_dd(-(rate / w3)) * (T::from_dd(f.u) - T::from_dd(Dd::ONE + r) * self.third_kind(f, r))
        } else {
            let n = self.parameter * w3 / y2;
            T::from_dd(rate / y2) * (T::from_dd(f.u) - T::from_dd(self.parameter + n) * self.third_kind(f, n))
        }
    }

    /// ∫ sn²/(1 + n sn²) from 0, n ≥ 0.
    fn third_kind<T: Precise>(&self, f: Jacobi<T>, n: Dd) -> T {
        let (one, n) = (T::of(1.0), T::from_dd(n));
        if self.half.is_none() {
            // sn = tanh
            let root = n.sqrt();
            let arc = if root.magnitude() == 0.0 { f.sn } else { (root * f.sn).atan2(one) / root };
            return (T::from_dd(f.u) - arc) / (one + n);
        }
        let s2 = f.sn * f.sn;
        f.sn * s2 * r_j(f.cn * f.cn, f.dn * f.dn, one, one + n * s2) / T::of(3.0)
    }

    fn alpha<T: Precise>(&self, f: Jacobi<T>) -> Moving<T> {
        let sign = T::from_dd(sign_of(self.e));
        let phase = Complex::phase(sign * self.alpha_angle(f));
        let [x1, x2, x3] = self.x;
        let Jacobi { sn, cn, dn, .. } = f;
        if !self.alpha_jumps() {
            let x = T::from_dd(x1) + T::from_dd(self.span) * sn * sn;
            return self.bounded(phase.scaled((x * T::of(0.5)).sqrt()), self.u_rate(f), self.e);
        }
        // α = e^{iJ} (√(x₁(x₃ − x₁)) cn dn ± i √(x₂x₃) sn) / √(2M), M = x₃ − x₁ + x₁ sn²
        let (p, q) = (T::from_dd((x1 * (x3 - x1)).sqrt()), sign * T::from_dd((x2 * x3).sqrt()));
        let x1 = T::from_dd(x1);
        let m = T::from_dd(x3 - self.x[0]) + x1 * sn * sn;
        let value = Complex::new(p * cn * dn, q * sn);
        let k2 = T::from_dd(self.parameter);
        let derivative = Complex::new(-(p * sn * (dn * dn + k2 * cn * cn)), q * cn * dn);
        let phase_rate = sign * T::from_dd(self.e.abs() / (self.rate * Dd::of(2.0))) * sn * sn / m;
        self.quotient(Quotient { phase, phase_rate, value, derivative, m, n: x1 }, f)
    }

    fn beta<T: Precise>(&self, f: Jacobi<T>) -> Moving<T> {
        let sign = T::from_dd(sign_of(self.d));
        let phase = Complex::phase(sign * self.beta_phase(f));
        let ([y1, y2], w3) = (self.y, self.w3);
        let Jacobi { sn, cn, dn, .. } = f;
        if !self.beta_jumps() {
            let y = (T::from_dd(y2) + T::from_dd(self.parameter * w3) * sn * sn) * T::of(0.5);
            return self.bounded(phase.scaled(y.sqrt() / dn), self.u_rate_from_highest(f), self.d);
        }
        // β = e^{iJ} (√y₂ cn ± i √(y₁w₃/(u₃ − u₁)) (1 + r) sd) / √(2M), M = 1 + r sn², r = y₂/w₃
        let between = y1 + w3;
        let r = y2 / w3;
        let p = T::from_dd(y2.sqrt());
        let q = sign * T::from_dd((y1 * w3 / between).sqrt() * (Dd::ONE + r));
        let m = T::of(1.0) + T::from_dd(r) * sn * sn;
        let value = Complex::new(p * cn, q * sn / dn);
        let derivative = Complex::new(-(p * sn * dn), q * cn / (dn * dn));
        let coefficient = self.d.abs() / (self.rate * Dd::of(2.0) * w3);
        let phase_rate = -(sign * T::from_dd(coefficient) * cn * cn / m);
        self.quotient(Quotient { phase, phase_rate, value, derivative, m, n: T::from_dd(r) }, f)
    }

    /// β where u₂ and u₃ are both 1: √(y₁/2) sech τ.
    fn homoclinic_beta<T: Precise>(&self, f: Jacobi<T>) -> Moving<T> {
        let size = T::from_dd((self.y[0] * Dd::of(0.5)).sqrt());
        let rate = -(size * T::from_dd(self.rate) * f.sn * f.cn);
        let real = |x: T| Complex::new(x, T::of(0.0));
        Moving { value: real(size * f.cn), rate: real(rate) }
    }

    /// The parameter that `quotient` stands for, and its derivative in t.
    fn quotient<T: Precise>(&self, quotient: Quotient<T>, f: Jacobi<T>) -> Moving<T> {
        let Quotient { phase, phase_rate, value, derivative, m, n } = quotient;
        let factor = phase.scaled(T::of(1.0) / (T::of(2.0) * m).sqrt());
        let logarithmic = Complex::new(-(n * f.sn * f.cn * f.dn / m), phase_rate);
        let rate = factor * (derivative + value * logarithmic);
        Moving { value: factor * value, rate: rate.scaled(T::from_dd(self.rate)) }
    }

    /// A parameter that stays clear of 0, with (|α|²)' = ½ `size_rate` and |α|² (arg α)' = ¼ `momentum`.
    fn bounded<T: Precise>(&self, value: Complex<T>, size_rate: T, momentum: Dd) -> Moving<T> {
        let quarter = T::of(0.25);
        let product = Complex::new(size_rate * quarter, T::from_dd(momentum) * quarter);
        Moving { value, rate: product * value.inverse_conjugate() }
    }

    /// (1 + u)' from functions of τ.
    fn u_rate<T: Precise>(&self, f: Jacobi<T>) -> T {
        T::from_dd(Dd::of(2.0) * self.rate * self.span) * f.sn * f.cn * f.dn
    }

    /// (1 − u)' from functions of σ: sn cn dn of τ is −k'² sn cn/dn³ of σ.
    fn u_rate_from_highest<T: Precise>(&self, f: Jacobi<T>) -> T {
        let size = Dd::of(2.0) * self.rate * self.span * self.complement;
        T::from_dd(size) * f.sn * f.cn / (f.dn * f.dn * f.dn)
    }
}

pub(super) fn sign_of(x: Dd) -> Dd {
    if x < Dd::ZERO { -Dd::ONE } else { Dd::ONE }
}
