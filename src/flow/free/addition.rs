//! The free motion over one fixed time as a map of the momentum, by the addition theorem of Jacobi's functions.
//!
//! With `m = (σA dn, B sn, C cn)(u)` along (a, b, c), the theorem (DLMF 22.8) for u + w, w = νh, reads in the momenta
//! themselves, with S, E, D = sn, cn, dn of w:
//!
//! `m_b' = (E D m_b + σ S B/(A C) m_c m_a) r`,
//! `m_c' = (E m_c − σ S D C/(A B) m_a m_b) r`,
//! `m_a' = (D m_a − σ k² S E A/(B C) m_b m_c) r`, `1/r = 1 − k² S² m_b²/B²`.
//!
//! The turn p over this time obeys the relation of the discrete Moser–Veselov map, `p_w p_i = (s/I_i + d)(m_i + m_i')`,
//! whose s and d, for a given h, are constants of the orbit: one evaluation of the motion gives them. A turn of less than
//! a right angle follows from these products by two square roots.
//!
//! Letters as in [`polhode`](super::polhode).

use super::polhode::Polhode;
use crate::body::{Phase, Point};
use crate::num::elliptic::jacobi;
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// The largest turn over one step, rad: towards a right angle, where p_w p_i has its maximum, it leaves p to rounding.
const LARGEST_TURN: f64 = 1.25;

/// Radii of the polhode between these keep clear of both ends of the range.
const CLEAR: core::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// k'² from which the place on the polhode is told by a rounded momentum: next to the axis b an error ε of m_a and m_c is one
/// of ε/k' in the phase.
const LEAST_COMPLEMENT: f64 = 1e-4;

/// A polhode by its invariants, in the axes a, b, c.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Curve<S> {
    axes: [usize; 3],
    /// 1/(2B²) and 1/(2C²): the first invariant is `m_b²/B² + m_c²/C² = 1`.
    ellipse: [S; 2],
    /// A²k'²/2 and A²k²/(2C²): the second is `m_a² = A²k'² + A²k² m_c²/C²`.
    along: [S; 2],
}

impl<S: Precise> Curve<S> {
    /// `None` where it is too small, too large or too close to the separatrix.
    pub(super) fn of(polhode: &Polhode<Dd>) -> Option<Self> {
        let [a, b, c] = polhode.amplitude;
        let clear = [a, b, c].iter().all(|radius| CLEAR.contains(&radius.hi()));
        let far = polhode.complement.hi() >= LEAST_COMPLEMENT;
        let half = Dd::of(0.5);
        (clear && far).then(|| Curve {
            axes: polhode.axes,
            ellipse: [half / (b * b), half / (c * c)].map(S::from_dd),
            along: [polhode.complement, polhode.parameter / (c * c)].map(|x| S::from_dd(half * a * a * x)),
        })
    }

    /// Gives `x`, which lies on the curve to rounding, the invariants of the curve.
    #[inline]
    pub(crate) fn restore(&self, x: &mut Point<S>) {
        let (mut m, [a, b, c]) = (x.momentum_body, self.axes);
        [m[a], m[b], m[c]] = self.nearest([m[a], m[b], m[c]], S::of(1.0) / m[a]);
        x.set_phase(Phase { attitude: x.attitude, momentum_body: m });
    }

    /// m_a, m_b, m_c on the curve, to first order, next to those given; `inverse` is 1/m_a.
    #[inline(always)]
    fn nearest(&self, [a, b, c]: [S; 3], inverse: S) -> [S; 3] {
        let (half, cc) = (S::of(0.5), c * c);
        let lack = half - (b * b * self.ellipse[0] + cc * self.ellipse[1]);
        let lack_along =
            (self.along[0] + self.along[1] * cc - half * a * a) + (self.along[1] * (cc + cc)) * lack;
        [a + lack_along * inverse, b + b * lack, c + c * lack]
    }
}

/// The map for one time and one orbit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Addition<S> {
    curve: Curve<S>,
    /// What multiplies m_a, m_b, m_c.
    linear: [S; 3],
    /// What multiplies m_b m_c, m_c m_a, m_a m_b.
    product: [S; 3],
    /// k² S²/B².
    denominator: S,
    /// s/I_i + d.
    turn: Vec3<S>,
}

impl<S: Precise> Addition<S> {
    /// For the time `h`, over which the momentum `m` goes to the one that `after` gives, with the turn; `None` also where
    /// that time is too long.
    pub(super) fn of(
        polhode: &Polhode<Dd>,
        moments: Vec3<Dd>,
        h: Dd,
        m: Vec3<Dd>,
        after: impl FnOnce() -> (Quat<Dd>, Vec3<Dd>),
    ) -> Option<Self> {
        let curve = Curve::of(polhode)?;
        let [a, b, c] = polhode.amplitude;
        let [i_a, i_b, i_c] = polhode.moments;
        let (k2, complement, sigma) = (polhode.parameter, polhode.complement, polhode.sigma);
        // |ω|² is linear in m_b²: its maximum is at an end
        let omega_a = a / i_a;
        let ends = [
            omega_a * omega_a + (c / i_c) * (c / i_c),
            omega_a * omega_a * complement + (b / i_b) * (b / i_b),
        ];
        let fastest = ends[0].hi().max(ends[1].hi()).sqrt();
        if fastest * h.magnitude() > LARGEST_TURN {
            return None;
        }
        let (sn, cn, dn) = jacobi(polhode.rate * h, complement);
        let (turn, later) = after();
        let round = S::from_dd;
        let product = [
            -(sigma * k2 * sn * cn * a / (b * c)),
            sigma * sn * b / (a * c),
            -(sigma * sn * dn * c / (a * b)),
        ];
        Some(Addition {
            curve,
            linear: [dn, cn * dn, cn].map(round),
            product: product.map(round),
            denominator: round(k2 * sn * sn / (b * b)),
            turn: turn_constants(moments, turn, m + later).map(round),
        })
    }

    /// Moves `x` by the time h.
    #[inline]
    pub(crate) fn advance(&self, x: &mut Point<S>) {
        match self.curve.axes {
            [0, 1, 2] => self.step::<0, 1, 2>(x),
            [0, ..] => self.step::<0, 2, 1>(x),
            [1, 0, _] => self.step::<1, 0, 2>(x),
            [1, ..] => self.step::<1, 2, 0>(x),
            [_, 0, _] => self.step::<2, 0, 1>(x),
            _ => self.step::<2, 1, 0>(x),
        }
    }

    /// The axes are constants so that the state stays in registers.
    #[inline(always)]
    fn step<const A: usize, const B: usize, const C: usize>(&self, x: &mut Point<S>) {
        let (q, m) = (x.attitude, x.momentum_body);
        let (one, half) = (S::of(1.0), S::of(0.5));
        let below = one - self.denominator * (m[B] * m[B]);
        let r = one / below;
        let above = self.linear[0] * m[A] + self.product[0] * (m[B] * m[C]);
        let across = [
            (self.linear[1] * m[B] + self.product[1] * (m[C] * m[A])) * r,
            (self.linear[2] * m[C] + self.product[2] * (m[A] * m[B])) * r,
        ];
        let mut next = m;
        [next[A], next[B], next[C]] = self.curve.nearest([above * r, across[0], across[1]], below / above);

        let beta = self.turn.times(m + next); // sin θ/2, half of it
        let cosine = (one - S::of(4.0) * beta.norm_squared()).sqrt();
        let w = (half + half * cosine).sqrt();
        let unit = S::of(1.5) - half * q.norm_squared();
        let attitude = q * Quat::new(w * unit, beta * (unit / w));
        x.set_phase(Phase { attitude, momentum_body: next });
    }
}

/// s/I_i + d from one step with the turn p, whose momenta before and after add up to `sum`: linear in 1/I, so two axes give
/// the third. Those two are taken that divide the rounding of p least.
fn turn_constants(moments: Vec3<Dd>, p: Quat<Dd>, sum: Vec3<Dd>) -> Vec3<Dd> {
    let i = moments;
    let weight = |[j, k, _]: &[usize; 3]| (sum[*j] * sum[*k] * (i[*j] - i[*k]) * i[3 - j - k]).magnitude();
    let [j, k, third] = [[0, 1, 2], [1, 2, 0], [2, 0, 1]]
        .into_iter()
        .max_by(|x, y| weight(x).total_cmp(&weight(y)))
        .unwrap_or([0, 1, 2]);
    let ratio = |axis: usize| p.w * p.v[axis] / sum[axis];
    let (at_j, at_k) = (ratio(j), ratio(k));
    let share = (i[j] - i[third]) * i[k] / ((i[j] - i[k]) * i[third]); // of 1/I between those of j and k
    let mut constants = Vec3::zero();
    constants[j] = at_j;
    constants[k] = at_k;
    constants[third] = at_j + (at_k - at_j) * share;
    constants
}
