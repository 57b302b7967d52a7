//! The angle about L by a theta series and one arc tangent.
//!
//! With axes 1, 2, 3 = c, −b, a: `ψ = A₁ + A₂ t − arg(r + is)`,
//! `r + is = Σ (−1)ⁿ q^{n(n+1)} [(ξ^{n+½} + ξ^{−n−½}) sin (2n+1)x − i (ξ^{n+½} − ξ^{−n−½}) cos (2n+1)x]`, x = πu/2K.

use nalgebra::Matrix3;
use polhode::num::elliptic::{Modulus, r_f};
use polhode::num::trig::sin_cos;
use polhode::rotation::{Quat, Vec3};

use super::plain::{about_third, quaternion};
use super::{Curve, Motion};
use crate::experiments::evaluator::grid::Start;

/// Terms from which on nothing is left.
const NEGLIGIBLE: f64 = 1e-18;

pub(super) fn motion(start: &Start) -> Motion {
    let curve = Curve::new(start);
    let norm = curve.norm;
    let dual_quarter = Modulus::new(curve.k2).quarter_period();
    let q = libm::exp(-std::f64::consts::PI * dual_quarter / curve.quarter);
    let per_u = std::f64::consts::FRAC_PI_2 / curve.quarter;
    // ½ ln ξ, with K' − F(A/G) = F(C/B) in place of the difference
    let [ia, ib, ic] = curve.moments;
    let [_, amp_b, amp_c] = curve.amplitudes;
    let cosine = ia * (ic - ib) / (ib * (ic - ia));
    let y = per_u * amp_c / amp_b * r_f(cosine, curve.k2 * norm * norm / (amp_b * amp_b), 1.0);
    let mut series = 0.0;
    for n in 1..4000 {
        let n = f64::from(n);
        let power = libm::pow(q, 2.0 * n);
        let term = 2.0 * power * libm::sinh(2.0 * n * y) / (1.0 - power);
        series += term;
        if term <= NEGLIGIBLE * series {
            break;
        }
    }
    // (ξ + 1)/(ξ − 1) = coth ½ ln ξ
    let a2 = norm / ic + per_u * curve.rate * (1.0 / libm::tanh(y) - 2.0 * series);
    let mut terms = Vec::new();
    for n in 0..64 {
        let (n, sign) = (f64::from(n), if n % 2 == 0 { 1.0 } else { -1.0 });
        let weight = 2.0 * sign * libm::pow(q, n * (n + 1.0));
        let odd = (2.0 * n + 1.0) * y;
        terms.push([weight * libm::cosh(odd), weight * libm::sinh(odd)]);
        if terms[terms.len() - 1][0].abs() <= NEGLIGIBLE * terms[0][0] {
            break;
        }
    }
    let argument = move |curve: &Curve, t: f64| {
        let (s, c) = sin_cos(per_u * (curve.rate * t + curve.phase));
        let (s2, c2) = (2.0 * s * c, (c - s) * (c + s));
        let (mut sin, mut cos, mut re, mut im) = (s, c, 0.0, 0.0);
        for [sum, difference] in &terms {
            re += sum * sin;
            im -= difference * cos;
            (sin, cos) = (sin * c2 + cos * s2, cos * c2 - sin * s2);
        }
        libm::atan2(im, re)
    };
    let a1 = argument(&curve, 0.0);
    let first = frame(&curve, curve.start);
    Box::new(move |t| {
        let psi = a1 + a2 * t - argument(&curve, t);
        let turn = first * about_third(psi) * frame(&curve, curve.at(t).momentum).transpose();
        let q = quaternion(turn);
        // from 1, 2, 3 to a, b, c
        curve.turn(Quat::new(q.w, Vec3([q.v[2], -q.v[1], q.v[0]])))
    })
}

/// T₁, whose last column is the direction of the momentum along 1, 2, 3.
fn frame(curve: &Curve, [a, b, c]: [f64; 3]) -> Matrix3<f64> {
    let [m1, m2, m3] = [c, -b, a].map(|m| m / curve.norm);
    let f = libm::hypot(m1, m2);
    Matrix3::new(m1 * m3 / f, -m2 / f, m1, m2 * m3 / f, m1 / f, m2, -f, 0.0, m3)
}
