//! The momentum after a time as a rational function of the momentum before, and what it becomes by derivation.

use core::array::from_fn;

use super::functions::{Clock, Values};
use super::tangent::Tangent;

/// Momentum and coefficients of Euler's equations along the axes a, b, c.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    pub(super) m: [f64; 3],
    pub(super) kappa: [f64; 3],
}

/// A direction in which the start may change.
#[derive(Clone, Copy, Debug)]
pub(super) enum Direction {
    /// m along one of the axes.
    Momentum(usize),
    /// κ of one of the axes.
    Kappa(usize),
}

/// All variables of the closed form with their derivatives in `N` directions.
///
/// Away from t = 0 a direction is split into a change of scale and one that leaves p alone: the change of scale moves the
/// motion along itself, m(t; λm₀) = λ m(λt; m₀), and next to the separatrix it is all that there would be to cancel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Variables<const N: usize> {
    m: [Tangent<N>; 3],
    kappa: [Tangent<N>; 3],
    s: Tangent<N>,
    c: Tangent<N>,
    d: Tangent<N>,
    /// Change of scale of m, and of κ.
    stretch: [[f64; N]; 2],
    /// Derivative of |m|²/2.
    half_square: [f64; N],
    start: Start,
    at: Values,
}

impl<const N: usize> Variables<N> {
    pub(super) fn new(clock: &Clock, start: Start, at: Values, directions: [Direction; N]) -> Self {
        let Start { m, kappa } = start;
        let zero = Tangent::new(0.0, [0.0; N]);
        let mut x = Variables {
            m: m.map(|m| Tangent::new(m, [0.0; N])),
            kappa: kappa.map(|kappa| Tangent::new(kappa, [0.0; N])),
            s: Tangent { value: at.s, ..zero },
            c: Tangent { value: at.c, ..zero },
            d: Tangent { value: at.d, ..zero },
            stretch: [[0.0; N]; 2],
            half_square: [0.0; N],
            start,
            at,
        };
        for (n, direction) in directions.into_iter().enumerate() {
            x.vary(clock, n, direction);
        }
        x
    }

    /// Sets the derivatives of number `n`.
    #[inline(always)]
    fn vary(&mut self, clock: &Clock, n: usize, direction: Direction) {
        let Start { m: [m_a, m_b, m_c], kappa: kappa @ [k_a, k_b, k_c] } = self.start;
        let Values { s, c, d, v, near, .. } = self.at;
        let (p, q) = (clock.p, clock.q);
        let mut dm = [0.0; 3];
        let mut dk = [0.0; 3];
        match direction {
            Direction::Momentum(axis) => {
                dm[axis] = 1.0;
                self.half_square[n] = self.start.m[axis];
            }
            Direction::Kappa(axis) => dk[axis] = 1.0,
        }
        // p, q and p − q are sums of squares of m with these coefficients
        let product = |j: usize, k: usize| dk[j] * kappa[k] + kappa[j] * dk[k];
        let from_a = 2.0 * k_b * k_c * m_a * dm[0] + product(1, 2) * m_a * m_a;
        let from_b = 2.0 * k_a * k_c * m_b * dm[1] + product(0, 2) * m_b * m_b;
        let from_c = 2.0 * k_a * k_b * m_c * dm[2] + product(0, 1) * m_c * m_c;
        let (dp, dq) = (from_b - from_a, from_b - from_c);
        if let Some(near) = near {
            self.s.by[n] = -0.5 * c * d * (near * dp + v * dq);
            self.c.by[n] = 0.5 * ((p * s * d * near - s * s / c) * dp + p * s * d * v * dq);
            self.d.by[n] = 0.5 * (q * s * c * near * dp + (q * s * c * v - s * s / d) * dq);
        } else {
            let scale = dp / (2.0 * p);
            let e = (from_c - from_a) - clock.complement * dp; // p d(k'²)
            self.s.by[n] = 0.5 * c * d * v * e;
            self.c.by[n] = -0.5 * p * s * d * v * e;
            self.d.by[n] = 0.5 * (s * s / d - q * s * c * v) * e;
            match direction {
                Direction::Momentum(_) => {
                    self.stretch[0][n] = scale;
                    // m less its part along m: without a difference in the plane of a and b
                    let turn = (m_b * dm[0] - m_a * dm[1]) / p;
                    dm = [k_a * k_c * m_b * turn, k_b * k_c * m_a * turn, dm[2] - m_c * scale];
                }
                Direction::Kappa(_) => {
                    self.stretch[1][n] = scale;
                    dk = from_fn(|k| dk[k] - kappa[k] * scale);
                }
            }
        }
        for k in 0..3 {
            self.m[k].by[n] = dm[k];
            self.kappa[k].by[n] = dk[k];
        }
    }

    /// 1 − (sn u₀ sn ντ)² k² as a sum of positive terms.
    #[inline(always)]
    fn denominator(&self) -> Tangent<N> {
        let (m_a, [_, k_b, k_c]) = (self.m[0], self.kappa);
        self.c.square() - k_b * k_c * m_a.square() * self.s.square()
    }

    /// The momentum after the time, along a, b, c.
    pub(super) fn momentum(&self) -> [Tangent<N>; 3] {
        let Variables { m: [a, b, c], kappa: [k_a, k_b, k_c], s, c: cn, d: dn, .. } = *self;
        let inverse = Tangent::new(1.0, [0.0; N]) / self.denominator();
        let mut after = [
            (a * dn + k_a * s * cn * b * c) * inverse,
            (b * cn * dn + k_b * s * a * c) * inverse,
            (c * cn + k_c * s * dn * a * b) * inverse,
        ];
        let [y_a, y_b, y_c] = after.map(|y| y.value);
        let kappa = self.start.kappa;
        let rate = [kappa[0] * y_b * y_c, kappa[1] * y_a * y_c, kappa[2] * y_a * y_b];
        let [along_m, along_kappa] = self.stretch;
        for (y, rate) in after.iter_mut().zip(rate) {
            let shift = self.at.time * rate;
            for n in 0..N {
                y.by[n] += (y.value + shift) * along_m[n] + shift * along_kappa[n];
            }
        }
        self.keep_length(&mut after);
        after
    }

    /// The component along which m is largest from the others and |m|: next to the axis b its derivative is smaller than the
    /// terms that it is made of.
    #[inline(always)]
    fn keep_length(&self, after: &mut [Tangent<N>; 3]) {
        let [a, b, c] = after.map(|y| y.value.abs());
        let k = if a >= b.max(c) { 0 } else { 1 + usize::from(c > b) };
        if after[k].value == 0.0 {
            return;
        }
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let inverse = 1.0 / after[k].value;
        for n in 0..N {
            let others = after[i].value * after[i].by[n] + after[j].value * after[j].by[n];
            after[k].by[n] = (self.half_square[n] - others) * inverse;
        }
    }

    /// ∫ m_b m_c dτ = (m_a(τ) − m_a(0))/κ_a, without that quotient.
    pub(super) fn product_bc(&self, after: [f64; 3]) -> Tangent<N> {
        let Variables { m: [a, b, c], kappa: [_, k_b, k_c], s, c: cn, d: dn, .. } = *self;
        let r = self.denominator();
        let s2 = s.square();
        let rest = a * s2 * (k_c * b.square() * r + k_b * c.square()) / (dn + r);
        self.stretched((rest + s * cn * b * c) / r, after[1] * after[2])
    }

    /// ∫ m_a m_c dτ, while cn ντ > 0.
    pub(super) fn product_ac(&self, after: [f64; 3]) -> Tangent<N> {
        let Variables { m: [a, b, c], kappa: [k_a, k_b, k_c], s, c: cn, d: dn, .. } = *self;
        let r = self.denominator();
        let (s2, a2, c2) = (s.square(), a.square(), c.square());
        let rest = b * s2 * (r * (k_c * a2 + k_a * c2) + k_a * k_b * k_c * a2 * c2 * s2) / (cn * dn + r);
        self.stretched((rest + s * a * c) / r, after[0] * after[2])
    }

    /// ∫ m_a m_b dτ, while cn ντ > 0.
    pub(super) fn product_ab(&self, after: [f64; 3]) -> Tangent<N> {
        let Variables { m: [a, b, c], kappa: [k_a, k_b, _], s, c: cn, d: dn, .. } = *self;
        let r = self.denominator();
        let rest = c * s.square() * (k_a * b.square() * r + k_b * a.square()) / (cn + r);
        self.stretched((rest + s * dn * a * b) / r, after[0] * after[1])
    }

    /// Adds what the change of scale does to the integral of a product of two components, which is `product` at the end.
    #[inline(always)]
    fn stretched(&self, mut integral: Tangent<N>, product: f64) -> Tangent<N> {
        let (value, shift) = (integral.value, self.at.time * product);
        let [along_m, along_kappa] = self.stretch;
        for n in 0..N {
            integral.by[n] += (shift + value) * along_m[n] + (shift - value) * along_kappa[n];
        }
        integral
    }
}
