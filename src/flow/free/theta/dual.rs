//! The dual form: hyperbolic sums with the complementary nome q'.

use multiversion::multiversion;

use super::series::{
    DD_TERMS, Form, GIVEN, LEAST_TERMS, Made, Powers, Series, T, V_MINUS, V_PLUS, coefficients, first, given,
    of_each, rate_at_zero, total,
};
use crate::flow::free::polhode::{Lanes, Polhode, TOGETHER};
use crate::num::elliptic::{each_r_f, quarter_period};
use crate::num::{Dd, Doubled};

/// From this |β| on cosh (2n+1)β overflows, and the terms beyond the first are below e^{−2β} of it.
const FAR: f64 = 60.0;

/// K and the phase of the start, as limits for k' → 0; there is no K on the separatrix.
type Limit<S> = (Option<S>, S);

pub(super) fn series(polhode: &Polhode<Dd>) -> Series {
    let limit = polhode.asymptotic.map(|limits| (limits.quarter, polhode.phase()));
    let series = made(&given(polhode), &[polhode.about_smallest], limit).series(0);
    let form = match (series.form, limit) {
        (_, Some((None, _))) => Form::Separatrix,
        (Form::Dual { width, jump }, Some(_)) => Form::Limit { width, jump },
        (form, _) => form,
    };
    Series { form, ..series }
}

/// The series of each of `polhodes`, of which none is a limit, with the bits that it has alone.
pub(super) fn series_of_each(polhodes: &[&Polhode<Dd>]) -> Vec<Series> {
    of_each(polhodes, series, side_by_side)
}

#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn side_by_side(numbers: &[Lanes; GIVEN], about_smallest: &[bool; TOGETHER]) -> Made<Lanes> {
    made(numbers, about_smallest, None)
}

#[inline(always)]
fn made<S: Doubled>(numbers: &[S; GIVEN], about_smallest: &[bool], limit: Option<Limit<S>>) -> Made<S> {
    let [amp_a, amp_b, amp_c, i_a, i_b, i_c, sn, cn, norm, twice_energy, delta, sigma, flip, ..] = *numbers;
    let [.., complement, parameter, rate] = *numbers;
    let (zero, one) = (S::of(0.0), S::of(1.0));
    let ratio = amp_c / amp_b; // sn(η | k')
    let cosine = i_a * (i_c - i_b) / (i_b * (i_c - i_a)); // 1 − (C/B)², without cancellation
    let of_eta = [cosine, one - complement * ratio * ratio, one];
    let (of_eta, quarter, start) = if let Some((quarter, start)) = limit {
        let [of_eta] = each_r_f([of_eta]);
        (of_eta, quarter, start)
    } else {
        let [of_eta, of_phase] = each_r_f([of_eta, [cn * cn, complement + parameter * cn * cn, one]]);
        (of_eta, Some(quarter_period(complement)), sn * of_phase)
    };
    let eta = ratio * of_eta;
    let dual_quarter = quarter_period(parameter); // K'; π/2 for k = 1
    let q = match quarter {
        Some(quarter) if limit.is_none() => (-(S::from_dd(Dd::PI) * quarter / dual_quarter)).exponential(),
        _ => zero,
    };
    let powers = Powers::of(q);
    let per_phase = S::from_dd(Dd::FRAC_PI_4) / dual_quarter; // β/u
    let alpha = eta * per_phase;

    // Z = Σ q'^{(n²+n)/2} [cos (2n+1)α cosh (2n+1)β + iδ sin (2n+1)α sinh (2n+1)β], W with (−1)ⁿ and cosh ↔ sinh
    let (sin, cos) = alpha.sin_cos();
    let (s2, c2) = (sin * cos * 2.0, (cos - sin) * (cos + sin));
    let (mut s, mut c, mut weight) = (sin, cos, one);
    let (mut even, mut odd) = ([zero; DD_TERMS], [zero; DD_TERMS]);
    for n in 0..DD_TERMS {
        if n > 0 {
            weight = weight * powers.power(n as u32);
            (s, c) = (s * c2 + c * s2, c * c2 - s * s2);
        }
        even[n] = weight * c;
        odd[n] = weight * s;
    }
    let z0 = total(&even);
    let mut slope = zero;
    for (n, odd) in odd.iter().enumerate() {
        slope = slope + *odd * (2.0 * n as f64 + 1.0);
    }
    let beta_rate = rate * per_phase;
    let at_zero = rate_at_zero(twice_energy, norm, amp_a, i_a);
    let twist_rate = at_zero * 0.5 - delta * beta_rate * slope / z0;
    let beta = start * per_phase;
    let (phase, half_period) = match quarter {
        Some(quarter) => {
            let half = quarter * 2.0;
            let jump = delta * alpha * 2.0 / S::from_dd(Dd::TAU);
            ([rate / half, start / half], Some([per_phase * half, jump]))
        }
        None => ([beta_rate, beta], None),
    };

    // θ constants of nome q'
    let (mut t2, mut t3, mut t4) = (one, one, one);
    for n in 1..DD_TERMS as u32 {
        let square = powers.power(n * n);
        t2 = t2 + square * powers.power(n);
        t3 = t3 + square * 2.0;
        t4 = t4 + square * if n % 2 == 0 { 2.0 } else { -2.0 };
    }
    let kappa = norm * z0 * z0 * 2.0 / ((norm + amp_a) * t2);
    for odd in &mut odd {
        *odd = *odd * delta;
    }
    let mut sums = [first(&even), first(&odd), first(&even), first(&odd)];
    for sum in &mut sums[2..] {
        for (n, term) in sum.iter_mut().enumerate() {
            *term = if n % 2 == 0 { *term } else { -*term } * flip;
        }
    }
    for (sum, family) in sums.iter_mut().zip([V_MINUS, V_PLUS, V_PLUS, V_MINUS]) {
        *sum = coefficients(*sum, family);
    }
    let mut least = [zero; LEAST_TERMS];
    for mode in [true, false] {
        if !about_smallest.contains(&mode) {
            continue;
        }
        let scale = if mode { sigma * amp_a * t2 / t3 * kappa } else { flip * amp_c * t2 / t4 * kappa };
        let mut terms = [zero; LEAST_TERMS];
        for (n, term) in (0_u32..).zip(&mut terms) {
            let sign = if mode || n.is_multiple_of(2) { 1.0 } else { -1.0 };
            *term = powers.power(n * n) * scale * if n == 0 { 1.0 } else { 2.0 * sign };
        }
        let terms = coefficients(terms, T);
        for (n, about_smallest) in about_smallest.iter().enumerate() {
            for (least, term) in least.iter_mut().zip(&terms) {
                least.set(n, if *about_smallest == mode { term.get(n) } else { least.get(n) });
            }
        }
    }
    Made { phase, twist_rate, sums, least, start: at_start(&even, &odd, beta), half_period }
}

/// Re Z and Im Z at `beta`, up to a common factor.
#[inline(always)]
fn at_start<S: Doubled>(even: &[S; DD_TERMS], odd: &[S; DD_TERMS], beta: S) -> (S, S) {
    let (grown, shrunk) = (beta.exponential(), (-beta).exponential());
    let (mut sh, mut ch) = ((grown - shrunk) * 0.5, (grown + shrunk) * 0.5);
    let (sh2, ch2) = (sh * ch * 2.0, ch * ch + sh * sh);
    let (mut re, mut im) = (S::of(0.0), S::of(0.0));
    for n in 0..DD_TERMS {
        re = re + even[n] * ch;
        im = im + odd[n] * sh;
        (sh, ch) = (sh * ch2 + ch * sh2, ch * ch2 + sh * sh2);
    }
    for n in 0..S::COUNT {
        let beta = beta.get(n).hi();
        if beta.abs() > FAR {
            let first = odd[0].get(n);
            re.set(n, even[0].get(n));
            im.set(n, if beta < 0.0 { -first } else { first });
        }
    }
    (re, im)
}
