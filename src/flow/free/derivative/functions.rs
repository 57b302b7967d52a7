//! The functions of time that the motion of the momentum and its derivatives consist of.

use crate::num::elliptic::{Modulus, r_d};
use crate::num::{Dd, Precise, Real};

/// Constants of the functions at one pair (p, q).
#[derive(Clone, Debug)]
pub(super) struct Clock {
    /// p = ν², rad².
    pub(super) p: f64,
    pub(super) q: f64,
    /// k'² = 1 − q/p.
    pub(super) complement: f64,
    rate: f64, // ν
    modulus: Modulus<f64>,
    period: Option<Period>,
}

/// What the reduction to one half period needs; there is none where nothing moves, and on the separatrix.
#[derive(Clone, Debug)]
struct Period {
    /// Half periods in one unit of time, ν/2K.
    frequency: Dd,
    half: Dd, // 2K
    /// What T and V grow by in a half period.
    second_kind: [f64; 2],
}

/// The values at one time τ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Values {
    pub(super) time: f64,
    /// sn(ντ)/ν, cn(ντ), dn(ντ).
    pub(super) s: f64,
    pub(super) c: f64,
    pub(super) d: f64,
    /// ∫s² dτ, ∫(s/d)² dτ.
    pub(super) t: f64,
    pub(super) v: f64,
    /// ∫(s/c)² dτ, where |ντ| < 1.
    pub(super) near: Option<f64>,
}

impl Values {
    /// The values at −τ.
    pub(super) fn reversed(self) -> Self {
        let Values { time, s, c, d, t, v, near } = self;
        Values { time: -time, s: -s, c, d, t: -t, v: -v, near: near.map(|near| -near) }
    }
}

impl Clock {
    /// For p ≥ q ≥ 0 and the complementary parameter 1 − q/p, which may be given with more digits.
    pub(super) fn new(p: Dd, q: Dd, complement: Dd) -> Self {
        let rate = p.sqrt();
        let moves = rate.hi() > 0.0 && complement.hi() > 0.0;
        let period = moves.then(|| {
            let half = Modulus::new(complement).quarter_period() * 2.0;
            let m1 = complement.hi();
            let cube = rate.hi() * rate.hi() * rate.hi();
            let grown = |integral: f64| 2.0 * integral / (3.0 * cube);
            let second_kind = [grown(r_d(0.0, m1, 1.0)), grown(r_d(0.0, 1.0, m1))];
            Period { frequency: rate / half, half, second_kind }
        });
        Clock {
            p: p.hi(),
            q: q.hi(),
            complement: complement.hi(),
            rate: rate.hi(),
            modulus: Modulus::new(complement.hi()),
            period,
        }
    }

    /// The values at the time `time`.
    pub(super) fn at(&self, time: Dd) -> Values {
        let tau = time.hi();
        let phase = self.rate * tau;
        if phase == 0.0 {
            let cubic = tau * tau * tau / 3.0;
            return Values { time: tau, s: tau, c: 1.0, d: 1.0, t: cubic, v: cubic, near: Some(cubic) };
        }
        let (mut rest, mut odd, mut grown) = (phase, false, [0.0; 2]);
        if let Some(Period { frequency, half, second_kind }) = &self.period
            && phase.abs() > 1.0
        {
            let turns = *frequency * time;
            let whole = turns.round();
            rest = ((turns - whole) * *half).hi();
            odd = whole.rem_euclid(2.0) == 1.0;
            grown = second_kind.map(|by| by * whole.hi());
        }
        let (sn, cn, dn) = self.modulus.sn_cn_dn(rest);
        let s = sn / self.rate;
        let (cube, c2, d2) = (s * s * s / 3.0, cn * cn, dn * dn);
        let sign = if odd { -1.0 } else { 1.0 };
        Values {
            time: tau,
            s: sign * s,
            c: sign * cn,
            d: dn,
            t: cube * r_d(c2, d2, 1.0) + grown[0],
            v: cube * r_d(c2, 1.0, d2) + grown[1],
            near: (phase.abs() < 1.0).then(|| cube * r_d(1.0, d2, c2)),
        }
    }
}
