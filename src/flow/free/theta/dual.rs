//! The dual form: hyperbolic sums with the complementary nome q'.

use super::series::{
    DD_TERMS, Form, Powers, Series, T, TERMS, V_MINUS, V_PLUS, first, flip, polynomial, rate_at_zero, total,
};
use crate::flow::free::phase::{Phase, pair};
use crate::flow::free::polhode::Polhode;
use crate::num::elliptic::{Modulus, r_f};
use crate::num::{Dd, Precise, Real};

pub(super) fn series(polhode: &Polhode<Dd>) -> Series {
    let [amp_a, amp_b, amp_c] = polhode.amplitude;
    let [i_a, i_b, i_c] = polhode.moments;
    let (norm, delta) = (polhode.norm, polhode.delta);
    let quarter = polhode.quarter_period();
    let dual_quarter = Modulus::new(polhode.parameter).quarter_period(); // K'; π/2 for k = 1
    let is_limit = polhode.asymptotic.is_some();
    let q = if is_limit { Dd::ZERO } else { (-(Dd::PI * quarter / dual_quarter)).exp() };
    let ratio = amp_c / amp_b; // sn(η | k')
    let powers = Powers::of(q);
    let cosine = i_a * (i_c - i_b) / (i_b * (i_c - i_a)); // 1 − (C/B)², without cancellation
    let eta = ratio * r_f(cosine, Dd::ONE - polhode.complement * ratio * ratio, Dd::ONE);
    let per_phase = Dd::FRAC_PI_4 / dual_quarter; // β/u
    let alpha = eta * per_phase;

    // Z = Σ q'^{(n²+n)/2} [cos (2n+1)α cosh (2n+1)β + iδ sin (2n+1)α sinh (2n+1)β], W with (−1)ⁿ and cosh ↔ sinh
    let (sin, cos) = alpha.sin_cos();
    let (s2, c2) = (sin * cos * 2.0, (cos - sin) * (cos + sin));
    let (mut s, mut c, mut weight) = (sin, cos, Dd::ONE);
    let mut even = [Dd::ZERO; DD_TERMS];
    let mut odd = [Dd::ZERO; DD_TERMS];
    for n in 0..DD_TERMS {
        if n > 0 {
            weight = weight * powers.power(n as u32);
            (s, c) = (s * c2 + c * s2, c * c2 - s * s2);
        }
        even[n] = weight * c;
        odd[n] = weight * s;
    }
    let z0 = total(&even);
    let slope = (0..DD_TERMS).fold(Dd::ZERO, |sum, n| sum + odd[n] * (2.0 * n as f64 + 1.0));
    let beta_rate = polhode.rate * per_phase;
    let twist_rate = rate_at_zero(polhode) * 0.5 - delta * beta_rate * slope / z0;
    let start = polhode.phase();
    let beta = start * per_phase;
    let (form, phase) = if polhode.is_separatrix() {
        (Form::Separatrix, Phase::new(beta_rate, beta))
    } else {
        let half = quarter * 2.0;
        let (width, jump) = ((per_phase * half).hi(), pair(delta * alpha * 2.0 / Dd::TAU));
        let form = if is_limit { Form::Limit { width, jump } } else { Form::Dual { width, jump } };
        (form, Phase::new(polhode.rate / half, start / half))
    };

    // θ constants of nome q'
    let (mut t2, mut t3, mut t4) = (Dd::ONE, Dd::ONE, Dd::ONE);
    for n in 1..DD_TERMS as u32 {
        let square = powers.power(n * n);
        t2 = t2 + square * powers.power(n);
        t3 = t3 + square * 2.0;
        t4 = t4 + square * if n % 2 == 0 { 2.0 } else { -2.0 };
    }
    let kappa = norm * z0 * z0 * 2.0 / ((norm + amp_a) * t2);
    let flip = flip(polhode);
    let alternating = |v: [Dd; TERMS]| [v[0], -v[1], v[2], -v[3]];
    let (even4, odd4) = (first(&even), first(&odd).map(|v| v * delta));
    let z = [polynomial(even4, V_MINUS), polynomial(odd4, V_PLUS)];
    let w = [
        polynomial(alternating(even4).map(|v| v * flip), V_PLUS),
        polynomial(alternating(odd4).map(|v| v * flip), V_MINUS),
    ];
    let scale = if polhode.about_smallest {
        polhode.sigma * amp_a * t2 / t3 * kappa
    } else {
        flip * amp_c * t2 / t4 * kappa
    };
    let term = |n: u32| {
        let sign = if polhode.about_smallest || n.is_multiple_of(2) { 1.0 } else { -1.0 };
        powers.power(n * n) * scale * if n == 0 { 1.0 } else { 2.0 * sign }
    };
    let least = polynomial([0, 1, 2, 3, 4].map(term), T);
    let start = at_start(even, odd.map(|v| v * delta), beta);
    Series { form, phase, twist_rate, z, w, least, start }
}

/// Re Z and Im Z at `beta`, up to a common factor.
fn at_start(even: [Dd; DD_TERMS], odd: [Dd; DD_TERMS], beta: Dd) -> (Dd, Dd) {
    // from here on cosh (2n+1)β overflows, and the terms beyond the first are below e^{−2β} of it
    if beta.hi().abs() > 60.0 {
        return (even[0], if beta.hi() < 0.0 { -odd[0] } else { odd[0] });
    }
    let (grown, shrunk) = (beta.exp(), (-beta).exp());
    let (mut sh, mut ch) = ((grown - shrunk) * 0.5, (grown + shrunk) * 0.5);
    let (sh2, ch2) = (sh * ch * 2.0, ch * ch + sh * sh);
    let (mut re, mut im) = (Dd::ZERO, Dd::ZERO);
    for n in 0..DD_TERMS {
        re = re + even[n] * ch;
        im = im + odd[n] * sh;
        (sh, ch) = (sh * ch2 + ch * sh2, ch * ch2 + sh * sh2);
    }
    (re, im)
}
