//! Motion along a polhode by Jacobi's functions and Carlson's integrals, in any scalar.
//!
//! The attitude is a swing, which takes the momentum to the axis that it circulates about, and a twist ψ about that
//! axis: no frame that becomes singular, no inverse sine, no branch that closes on the separatrix:
//! the remedy that Leroy's note on the free body in the sources of Principia proposes, here without coordinates.
//! Notation as in [`polhode`](super::polhode).
//!
//! # Where printed formulas do not serve
//! - *On the separatrix* (k' = 0) the twist contains R_J(0, 0, 1, p), which diverges. There sn u = tanh u, and with
//!   p = −n and s = tanh u the integral of the third kind is elementary:
//!   `∫ n s²/(1 − n s²) du = −p/(1 + p) [u − atan(√p s)/√p]`, because du = ds/(1 − s²) splits the integrand into
//!   1/(1 − s²) and 1/(1 + p s²). The part linear in u joins the rate of the twist.
//! - *Rate of the twist at u = 0.* `ψ' = G/I_a + (2H − G²/I_a)/(G + A)` cancels for rods; the same over one
//!   denominator, `(2H + GA/I_a)/(G + A)`, is a sum of positive terms.
//! - *Celledoni, Fassò, Säfström and Zanna* (SIAM J. Sci. Comput. 30 (2008) 2084): their preprint has wrong signs and a
//!   separatrix case that covers only half of it, as Leroy's note in the sources of Principia found; nothing here is
//!   taken from it, and the printed article was not compared.
//! - *TOMS algorithm 903* prints for its example 4 a quaternion that is off in the tenth digit: compare
//!   `tests/data/free_body/reference.csv`, scenario E4.

use super::phase::reduce;
use super::polhode::{Polhode, scaled};
use crate::num::elliptic::{Modulus, r_j};
use crate::num::{Dd, Precise};
use crate::rotation::{Quat, Vec3};

/// A polhode with its twist: ψ(t) = rate t − δ (per_half_turn ΔN + periodic(t) − periodic(0)).
#[derive(Clone, Debug)]
pub(super) struct Circulation<S> {
    polhode: Polhode<S>,
    modulus: Modulus<S>,
    phase: S,
    swing_back: Quat<S>,
    /// A, B, C and G over one power of two near G: products of three of them are formed.
    relative: [S; 4],
    twist_rate: S, // G/I_c or G/I_a
    about_c: bool,
    characteristic: S, // n or n̂
    factor: S,
    twist_at_start: S,
    period: Option<Period<S>>,
}

/// What the reduction to one half period needs.
#[derive(Clone, Copy, Debug)]
struct Period<S> {
    half: S, // 2K
    twist: S,
}

impl<S: Precise> Circulation<S> {
    /// For the momentum `m` at the start.
    pub(super) fn of(polhode: Polhode<S>, m: Vec3<S>) -> Self {
        let one = S::of(1.0);
        let [amp_a, amp_b, amp_c] = polhode.amplitude;
        let mut relative = [amp_a, amp_b, amp_c, polhode.norm];
        if polhode.unit != 0 {
            relative = relative.map(|x| scaled(x, -polhode.unit));
        }
        let [amp_a, amp_b, amp_c, norm] = relative;
        let [i_a, i_b, i_c] = polhode.moments;
        let n = -(i_a * (i_c - i_b)) / (i_c * (i_b - i_a));
        // of the two complementary characteristics (n n̂ = k²) the smaller: the other loses digits
        let about_c = n * n <= polhode.parameter;
        let third = one / S::of(3.0);
        let (characteristic, factor, secular) = if about_c {
            (n, norm * amp_b / (amp_a * amp_c) * n * third, polhode.norm / i_c)
        } else {
            let n_hat = -(amp_c * amp_c) / (amp_a * amp_a);
            (n_hat, norm * amp_b * amp_c / (amp_a * amp_a * amp_a) * third, polhode.norm / i_a)
        };
        // near the separatrix the integral of the third kind is elementary: its part linear in u joins the rate
        let twist_rate = if polhode.asymptotic.is_some() {
            secular - polhode.delta * S::of(3.0) * factor / (one - characteristic) * polhode.rate
        } else {
            secular
        };
        let mut circulation = Circulation {
            modulus: Modulus::new(polhode.complement),
            phase: polhode.phase(),
            swing_back: polhode.swing(m).conjugate(),
            relative,
            twist_rate,
            about_c,
            characteristic,
            factor,
            twist_at_start: S::of(0.0),
            period: None,
            polhode,
        };
        let (sn, cn) = circulation.polhode.start;
        circulation.twist_at_start = circulation.periodic_twist(sn, cn);
        circulation
    }

    /// Works out the period, so that any time can be reached; without it |u| stays below a quarter period.
    pub(super) fn with_period(mut self) -> Self {
        if !self.polhode.is_separatrix() {
            let (zero, one) = (S::of(0.0), S::of(1.0));
            let complete = if self.polhode.asymptotic.is_some() {
                self.elementary_twist(one)
            } else {
                self.factor * r_j(zero, self.polhode.complement, one, one - self.characteristic)
            };
            let pi = if self.about_c { S::from_dd(Dd::PI) } else { zero };
            let half = S::of(2.0) * self.quarter_period();
            self.period = Some(Period { half, twist: S::of(2.0) * complete - pi });
        }
        self
    }

    /// Whether the phase at `t` lies within a quarter period of zero, as that of the start does.
    pub(super) fn is_near(&self, t: S) -> bool {
        (self.phase + self.polhode.rate * t).abs() <= self.quarter_period()
    }

    fn quarter_period(&self) -> S {
        let quarter = self.polhode.asymptotic.and_then(|limits| limits.quarter);
        quarter.unwrap_or_else(|| self.modulus.quarter_period())
    }

    /// 2K, a half period of the phase; `None` on the separatrix.
    pub(super) fn half_period(&self) -> Option<S> {
        self.period.map(|period| period.half)
    }

    /// Mean rate of the twist ψ, rad/s.
    pub(super) fn mean_twist_rate(&self) -> S {
        match self.period {
            Some(Period { half, twist }) => {
                self.twist_rate - self.polhode.delta * twist * self.polhode.rate / half
            }
            None => self.twist_rate,
        }
    }

    /// How often m_b changes sign between the start and `t`.
    pub(super) fn flips(&self, t: S) -> u64 {
        let (start, end) = (self.phase, self.phase + self.polhode.rate * t);
        match self.period {
            // sn is zero at the multiples of 2K
            Some(Period { half, .. }) => {
                let floor = |x: S| {
                    let nearest = (x / half).round();
                    if nearest * half > x { nearest - S::of(1.0) } else { nearest }
                };
                (floor(end) - floor(start)).magnitude() as u64
            }
            None => u64::from((start < S::of(0.0)) != (end < S::of(0.0))),
        }
    }

    /// The turn since the start and the momentum at time `t`.
    pub(super) fn at(&self, t: S) -> (Quat<S>, Vec3<S>) {
        let polhode = &self.polhode;
        let u = self.phase + polhode.rate * t;
        let secular = self.twist_rate * t;
        let (reduced, odd, secular) = match self.period {
            None => (u, false, secular),
            Some(Period { half, twist }) => {
                let half_turns = (u / half).round();
                (u - half_turns * half, is_odd(half_turns), secular - polhode.delta * twist * half_turns)
            }
        };
        let (sn, cn, dn) = match &polhode.asymptotic {
            Some(limits) => limits.sn_cn_dn(reduced),
            None => self.modulus.sn_cn_dn(reduced),
        };
        let [a, b, c] = polhode.axes;
        let [amp_a, amp_b, amp_c] = polhode.amplitude;
        let parity = S::of(if odd == polhode.half_turned { 1.0 } else { -1.0 });
        let mut m = Vec3::zero();
        m[a] = amp_a * dn * polhode.sigma;
        m[b] = amp_b * sn * parity;
        m[c] = amp_c * cn * parity;

        // the secular parts grow with t and partly cancel; they are reduced mod 4π, for the double cover
        let secular = reduce(secular, S::from_dd(Dd::TAU * 2.0));
        let psi = secular - polhode.delta * (self.periodic_twist(sn, cn) - self.twist_at_start);
        (self.turn(psi, m), m)
    }

    /// The turn since the start where the twist is `psi` and the momentum `m`.
    pub(super) fn turn(&self, psi: S, m: Vec3<S>) -> Quat<S> {
        let (sin, cos) = (psi * S::of(0.5)).sin_cos();
        let along = Vec3::unit(self.polhode.axes[0]) * (sin * self.polhode.sigma);
        self.swing_back * Quat::new(cos, along) * self.polhode.swing(m)
    }

    /// The twist after the time `t`, which is `half_turns` half periods less the phases of the start and of the pair (sn, cn ≥ 0), and
    /// what it grows by in the time `period` of two half periods; none on the separatrix.
    pub(super) fn twists(&self, t: S, half_turns: S, (sn, cn): (S, S), period: S) -> Option<[S; 2]> {
        let (delta, half) = (self.polhode.delta, self.period?.twist);
        let periodic = self.periodic_twist(sn, cn) - self.twist_at_start;
        let twist = self.twist_rate * t - delta * (half * half_turns + periodic);
        Some([twist, self.twist_rate * period - delta * half * S::of(2.0)])
    }

    /// The part of the twist that depends on the place on the polhode alone, at sn = x, cn = y ≥ 0.
    fn periodic_twist(&self, x: S, y: S) -> S {
        let polhode = &self.polhode;
        let [amp_a, amp_b, amp_c, norm] = self.relative;
        let (one, n) = (S::of(1.0), self.characteristic);
        let d2 = polhode.complement + polhode.parameter * y * y;
        let third_kind = if polhode.asymptotic.is_some() {
            self.elementary_twist(x)
        } else {
            self.factor * x * x * x * r_j(y * y, d2, one, one - n * x * x)
        };
        let (bx, cy) = (amp_b * x, amp_c * y);
        if self.about_c {
            third_kind - bx.atan2(cy)
        } else {
            let along = amp_a * d2.sqrt();
            let g = (bx * bx + cy * cy) / (norm + along);
            third_kind + (bx * cy * g).atan2(along * cy * cy + norm * bx * bx)
        }
    }

    /// The integral of the third kind for k' = 0 at sn = x, without its part linear in u.
    fn elementary_twist(&self, x: S) -> S {
        let (one, n) = (S::of(1.0), self.characteristic);
        let root = (-n).sqrt();
        -(S::of(3.0) * self.factor / ((one - n) * root) * (root * x).atan2(one))
    }
}

/// Whether the integer `n` is odd, for either sign.
fn is_odd<S: Precise>(n: S) -> bool {
    let half = n * S::of(0.5);
    half.round() != half
}
