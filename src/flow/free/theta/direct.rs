//! The direct form: trigonometric sums with the nome q.

use multiversion::multiversion;

use super::series::{
    DD_TERMS, GIVEN, LEAST_TERMS, Made, Powers, Series, T, U, V_MINUS, V_PLUS, coefficients, first, given,
    of_each, rate_at_zero, total,
};
use crate::flow::free::polhode::{Lanes, Polhode, TOGETHER};
use crate::num::elliptic::{each_r_f, quarter_period};
use crate::num::{Dd, Doubled};

pub(super) fn series(polhode: &Polhode<Dd>) -> Series {
    made(&given(polhode), &[polhode.about_smallest]).series(0)
}

/// The series of each of `polhodes`, with the bits that it has alone.
pub(super) fn series_of_each(polhodes: &[&Polhode<Dd>]) -> Vec<Series> {
    of_each(polhodes, series, side_by_side)
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn side_by_side(numbers: &[Lanes; GIVEN], about_smallest: &[bool; TOGETHER]) -> Made<Lanes> {
    made(numbers, about_smallest)
}

#[inline(always)]
fn made<S: Doubled>(numbers: &[S; GIVEN], about_smallest: &[bool]) -> Made<S> {
    let [amp_a, amp_b, amp_c, i_a, _, _, sn, cn, norm, twice_energy, delta, sigma, flip, ..] = *numbers;
    let [.., complement, parameter, rate] = *numbers;
    let (zero, one, pi) = (S::of(0.0), S::of(1.0), S::from_dd(Dd::PI));
    // K' − η, finite also for k = 0, and the phase of the start, for which no limit is taken here
    let of_eta = [amp_c * amp_c / (norm * norm), amp_b * amp_b / (norm * norm), one];
    let of_phase = [cn * cn, complement + parameter * cn * cn, one];
    let [of_eta, of_phase] = each_r_f([of_eta, of_phase]);
    let (eta, start) = (amp_a / norm * of_eta, sn * of_phase);
    let mut is_circle = true;
    for n in 0..S::COUNT {
        is_circle &= parameter.get(n) == Dd::ZERO;
    }
    // K' of circles is infinite, and q zero
    let mut quarters = [complement, parameter];
    for (quarter, is_asked) in quarters.iter_mut().zip([true, !is_circle]) {
        if is_asked {
            *quarter = quarter_period(*quarter);
        }
    }
    let [quarter, dual_quarter] = quarters;
    let per_phase = S::from_dd(Dd::FRAC_PI_2) / quarter; // x/u
    let x0 = start * per_phase;
    let mut nomes = [dual_quarter, eta];
    for (nome, is_asked) in nomes.iter_mut().zip([!is_circle, true]) {
        *nome = if is_asked { (-(pi * *nome / quarter)).exponential() } else { zero };
    }
    let [mut q, h] = nomes;
    for n in 0..S::COUNT {
        q.set(n, if parameter.get(n) == Dd::ZERO { Dd::ZERO } else { q.get(n) });
    }
    let (s2, c2) = (x0 * 2.0).sin_cos();
    let powers = Powers::of(q);
    let g = q / h;

    // Z = 1 + Σ (−1)ⁿ [(q^{2n²−n} hⁿ + q^{2n²} gⁿ) cos 2nx − iδ (… − …) sin 2nx],
    // W = √h Σ (−1)ⁿ [(q^{2n²+n} hⁿ + q^{2n²+2n} gⁿ⁺¹) sin (2n+1)x + iδ (… − …) cos (2n+1)x]
    let (mut z_even, mut z_odd) = ([zero; DD_TERMS], [zero; DD_TERMS]);
    let (mut w_even, mut w_odd) = ([zero; DD_TERMS], [zero; DD_TERMS]);
    z_even[0] = one;
    let root = h.sqrt();
    let (mut zh, mut zg, mut wh, mut wg) = (one, one, root, root * g);
    let q4 = (q * q) * (q * q);
    let mut q4n = one; // q^{4n}
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
            z_even[n] = (zh + zg) * sign;
            z_odd[n] = (zh - zg) * sign;
        }
        w_even[n] = (wh + wg) * sign;
        w_odd[n] = (wh - wg) * sign;
    }
    let z0 = total(&z_even);
    let mut slope = zero;
    for (n, odd) in z_odd.iter().enumerate().skip(1) {
        slope = slope + *odd * (2.0 * n as f64);
    }
    let x_rate = rate * per_phase;
    let at_zero = rate_at_zero(twice_energy, norm, amp_a, i_a);
    let twist_rate = at_zero * 0.5 + delta * x_rate * slope / z0;

    // θ constants of nome q
    let (mut t2, mut t3, mut t4) = (S::of(2.0), one, one);
    let mut square = one; // q^{n²}
    for n in 1..=7_u32 {
        square = square * powers.power(2 * n - 1);
        t3 = t3 + square * 2.0;
        t4 = t4 + square * if n % 2 == 0 { 2.0 } else { -2.0 };
        t2 = t2 + square * powers.power(n) * 2.0;
    }
    let kappa = norm * z0 * z0 * 2.0 / ((norm + amp_a) * t4);
    let mut sums = [first(&z_even), first(&z_odd), first(&w_even), first(&w_odd)];
    let [_, odd_of_z, even_of_w, odd_of_w] = &mut sums;
    for term in odd_of_z {
        *term = -(*term * delta);
    }
    for term in even_of_w {
        *term = *term * flip;
    }
    for term in odd_of_w {
        *term = *term * (flip * delta);
    }
    for (sum, family) in sums.iter_mut().zip([T, U, V_PLUS, V_MINUS]) {
        *sum = coefficients(*sum, family);
    }
    let mut least = [zero; LEAST_TERMS];
    for mode in [true, false] {
        if !about_smallest.contains(&mode) {
            continue;
        }
        let scale = if mode { sigma * amp_a * t4 / t3 * kappa } else { flip * amp_c * t4 / t2 * kappa * 2.0 };
        let mut terms = [zero; LEAST_TERMS];
        for (n, term) in (0..).zip(&mut terms) {
            *term = powers.power(n * n + if mode { 0 } else { n }) * scale;
            if mode && n > 0 {
                *term = *term * 2.0;
            }
        }
        let terms = coefficients(terms, if mode { T } else { V_MINUS });
        for (n, about_smallest) in about_smallest.iter().enumerate() {
            for (least, term) in least.iter_mut().zip(&terms) {
                least.set(n, if *about_smallest == mode { term.get(n) } else { least.get(n) });
            }
        }
    }

    let (mut s, mut c) = (zero, one);
    let (mut re, mut im) = (zero, zero);
    for n in 0..DD_TERMS {
        re = re + z_even[n] * c;
        im = im - delta * z_odd[n] * s;
        (s, c) = (s * c2 + c * s2, c * c2 - s * s2);
    }
    let tau = S::from_dd(Dd::TAU);
    let phase = [x_rate / tau, x0 / tau]; // in turns
    Made { phase, twist_rate, sums, least, start: (re, im), half_period: None }
}
