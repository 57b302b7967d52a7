//! The direct form: trigonometric sums with the nome q.

use super::series::{
    DD_TERMS, Form, Powers, Series, T, U, V_MINUS, V_PLUS, first, flip, polynomial, rate_at_zero, total,
};
use crate::flow::free::phase::Phase;
use crate::flow::free::polhode::Polhode;
use crate::num::elliptic::{Modulus, each_r_f};
use crate::num::{Dd, Precise, Real};

/// Sums in double-double from which the coefficients are made.
struct Sums {
    z_even: [Dd; DD_TERMS],
    z_odd: [Dd; DD_TERMS],
    w_even: [Dd; DD_TERMS],
    w_odd: [Dd; DD_TERMS],
}

pub(super) fn series(polhode: &Polhode<Dd>) -> Series {
    let [amp_a, amp_b, amp_c] = polhode.amplitude;
    let (norm, delta) = (polhode.norm, polhode.delta);
    // K' − η, finite also for k = 0, and the phase of the start, for which no limit is taken here
    let (sn, cn) = polhode.start;
    let of_eta = [amp_c * amp_c / (norm * norm), amp_b * amp_b / (norm * norm), Dd::ONE];
    let of_phase = [cn * cn, polhode.complement + polhode.parameter * cn * cn, Dd::ONE];
    let [of_eta, of_phase] = each_r_f([of_eta, of_phase]);
    let (eta, start) = (amp_a / norm * of_eta, sn * of_phase);
    let quarter = Modulus::new(polhode.complement).quarter_period();
    let per_phase = Dd::FRAC_PI_2 / quarter; // x/u
    let x0 = start * per_phase;
    let q = if polhode.parameter == Dd::ZERO {
        Dd::ZERO
    } else {
        (-(Dd::PI * Modulus::new(polhode.parameter).quarter_period() / quarter)).exp()
    };
    let h = (-(Dd::PI * eta / quarter)).exp();
    let (s2, c2) = (x0 * 2.0).sin_cos();
    let powers = Powers::of(q);
    let g = q / h;

    // Z = 1 + Σ (−1)ⁿ [(q^{2n²−n} hⁿ + q^{2n²} gⁿ) cos 2nx − iδ (… − …) sin 2nx],
    // W = √h Σ (−1)ⁿ [(q^{2n²+n} hⁿ + q^{2n²+2n} gⁿ⁺¹) sin (2n+1)x + iδ (… − …) cos (2n+1)x]
    let mut sums = Sums {
        z_even: [Dd::ZERO; DD_TERMS],
        z_odd: [Dd::ZERO; DD_TERMS],
        w_even: [Dd::ZERO; DD_TERMS],
        w_odd: [Dd::ZERO; DD_TERMS],
    };
    sums.z_even[0] = Dd::ONE;
    let root = h.sqrt();
    let (mut zh, mut zg, mut wh, mut wg) = (Dd::ONE, Dd::ONE, root, root * g);
    let q4 = (q * q) * (q * q);
    let mut q4n = Dd::ONE; // q^{4n}
    for n in 0..DD_TERMS {
        let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
        if n > 0 {
            q4n = q4n * q4;
            // q^{4n−3} = q^{4(n−1)} q and so on; no division by q, which may be zero
            let before = powers.power(4 * n as u32 - 3);
            zh = zh * before * h;
            zg = zg * before * q * g;
            wh = wh * before * q * q * h;
            wg = wg * q4n * g;
            sums.z_even[n] = (zh + zg) * sign;
            sums.z_odd[n] = (zh - zg) * sign;
        }
        sums.w_even[n] = (wh + wg) * sign;
        sums.w_odd[n] = (wh - wg) * sign;
    }
    let z0 = total(&sums.z_even);
    let slope = (1..DD_TERMS).fold(Dd::ZERO, |sum, n| sum + sums.z_odd[n] * (2.0 * n as f64));
    let x_rate = polhode.rate * per_phase;
    let twist_rate = rate_at_zero(polhode) * 0.5 + delta * x_rate * slope / z0;

    // θ constants of nome q
    let (mut t2, mut t3, mut t4) = (Dd::of(2.0), Dd::ONE, Dd::ONE);
    let mut square = Dd::ONE; // q^{n²}
    for n in 1..=7_u32 {
        square = square * powers.power(2 * n - 1);
        t3 = t3 + square * 2.0;
        t4 = t4 + square * if n % 2 == 0 { 2.0 } else { -2.0 };
        t2 = t2 + square * powers.power(n) * 2.0;
    }
    let kappa = norm * z0 * z0 * 2.0 / ((norm + amp_a) * t4);
    let flip = flip(polhode);
    let z = [polynomial(first(&sums.z_even), T), polynomial(first(&sums.z_odd).map(|v| -(v * delta)), U)];
    let w = [
        polynomial(first(&sums.w_even).map(|v| v * flip), V_PLUS),
        polynomial(first(&sums.w_odd).map(|v| v * (flip * delta)), V_MINUS),
    ];
    let least = if polhode.about_smallest {
        let scale = polhode.sigma * amp_a * t4 / t3 * kappa;
        let term = |n: u32| powers.power(n * n) * scale * if n == 0 { 1.0 } else { 2.0 };
        polynomial([0, 1, 2, 3, 4].map(term), T)
    } else {
        let scale = flip * amp_c * t4 / t2 * kappa * 2.0;
        polynomial([0, 1, 2, 3, 4].map(|n: u32| powers.power(n * n + n) * scale), V_MINUS)
    };

    let (mut s, mut c) = (Dd::ZERO, Dd::ONE);
    let (mut re, mut im) = (Dd::ZERO, Dd::ZERO);
    for n in 0..DD_TERMS {
        re = re + sums.z_even[n] * c;
        im = im - delta * sums.z_odd[n] * s;
        (s, c) = (s * c2 + c * s2, c * c2 - s * s2);
    }
    let phase = Phase::new(x_rate / Dd::TAU, x0 / Dd::TAU);
    Series { form: Form::Direct, phase, twist_rate, z, w, least, start: (re, im) }
}
