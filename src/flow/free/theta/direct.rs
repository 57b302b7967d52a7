//! The direct form: trigonometric sums with the nome q.

use multiversion::multiversion;

use super::series::{
    DD_TERMS, Form, LEAST_TERMS, Powers, Series, T, TERMS, U, V_MINUS, V_PLUS, coefficients, first, flip,
    rate_at_zero, total,
};
use crate::flow::free::phase::Phase;
use crate::flow::free::polhode::Polhode;
use crate::num::elliptic::{each_r_f, quarter_period};
use crate::num::{Dd, DdLanes, Doubled, Several};

/// Motions whose series are made side by side: a double-double operation is a chain in which each part waits for the one before.
const TOGETHER: usize = 16;

/// A number of each of them.
type Lanes = DdLanes<TOGETHER>;

/// What the series of a polhode are made of.
const GIVEN: usize = 13;

fn given(polhode: &Polhode<Dd>) -> [Dd; GIVEN] {
    let ([amp_a, amp_b, amp_c], (sn, cn)) = (polhode.amplitude, polhode.start);
    let (norm, delta, sigma, flip) = (polhode.norm, polhode.delta, polhode.sigma, flip(polhode));
    let (complement, parameter, rate) = (polhode.complement, polhode.parameter, polhode.rate);
    let at_zero = rate_at_zero(polhode);
    [amp_a, amp_b, amp_c, sn, cn, norm, delta, sigma, flip, complement, parameter, rate, at_zero]
}

/// The numbers of one [`Series`], or of several, in double-double.
struct Made<S> {
    /// Rate and start, in turns.
    phase: [S; 2],
    twist_rate: S,
    /// Even and odd part of Z, and of W.
    sums: [[S; TERMS]; 4],
    least: [S; LEAST_TERMS],
    start: (S, S),
}

impl<S: Several> Made<S> {
    /// The series of motion `n`.
    fn series(&self, n: usize) -> Series {
        let [rate, start] = self.phase;
        let [z_even, z_odd, w_even, w_odd] =
            self.sums.each_ref().map(|sum| sum.each_ref().map(|x| x.get(n).hi()));
        Series {
            form: Form::Direct,
            phase: Phase::new(rate.get(n), start.get(n)),
            twist_rate: self.twist_rate.get(n),
            z: [z_even, z_odd],
            w: [w_even, w_odd],
            least: self.least.each_ref().map(|x| x.get(n).hi()),
            start: (self.start.0.get(n), self.start.1.get(n)),
        }
    }
}

pub(super) fn series(polhode: &Polhode<Dd>) -> Series {
    made(&given(polhode), &[polhode.about_smallest]).series(0)
}

/// The series of each of `polhodes`, with the bits that it has alone.
pub(super) fn series_of_each(polhodes: &[&Polhode<Dd>]) -> Vec<Series> {
    let mut all = Vec::with_capacity(polhodes.len());
    for group in polhodes.chunks(TOGETHER) {
        let [first, _, ..] = group else {
            all.extend(group.iter().map(|polhode| series(polhode)));
            continue;
        };
        // lanes without a motion are those of the first
        let mut numbers = given(first).map(Lanes::all);
        let mut about_smallest = [first.about_smallest; TOGETHER];
        for (n, polhode) in group.iter().enumerate().skip(1) {
            numbers.iter_mut().zip(given(polhode)).for_each(|(lanes, x)| lanes.set(n, x));
            about_smallest[n] = polhode.about_smallest;
        }
        let made = side_by_side(&numbers, &about_smallest);
        all.extend((0..group.len()).map(|n| made.series(n)));
    }
    all
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn side_by_side(numbers: &[Lanes; GIVEN], about_smallest: &[bool; TOGETHER]) -> Made<Lanes> {
    made(numbers, about_smallest)
}

#[inline(always)]
fn made<S: Doubled>(numbers: &[S; GIVEN], about_smallest: &[bool]) -> Made<S> {
    let [amp_a, amp_b, amp_c, sn, cn, norm, delta, sigma, flip, complement, parameter, rate, at_zero] =
        *numbers;
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
    Made { phase: [x_rate / tau, x0 / tau], twist_rate, sums, least, start: (re, im) }
}
