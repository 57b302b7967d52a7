//! Euler's angles as in Orekit: two from the momentum, the third by quadrature over one period.
//!
//! There the quadrature is a Dormand–Prince integration with the tolerance 1e-13; here it is Gauss's rule with eight points on a
//! hundred panels of the period, which adds no error to those of the formulas. These are the program's: k² and the amplitudes from
//! differences of 2E I and L², the inclination by an arc cosine. The momentum of the start has the axis 3 for a, with 1 and 2 for c and −b.

use polhode::num::elliptic::{Modulus, incomplete};
use polhode::num::trig::sin_cos;
use polhode::rotation::{Quat, Vec3};

use super::{Curve, Motion};
use crate::experiments::evaluator::grid::Start;

/// Nodes in (0, 1) and weights of Gauss's rule with eight points, of one half.
const GAUSS: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_48],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_26],
];

const PANELS: usize = 100;

pub(super) fn motion(start: &Start) -> Motion {
    let curve = Curve::new(start);
    let [i3, i2, i1] = curve.moments;
    let [m3, m2, m1] = [curve.start[0], -curve.start[1], curve.start[2]];
    let [o1, o2, o3] = [m1 / i1, m2 / i2, m3 / i3];
    let twice_energy = i1 * o1 * o1 + i2 * o2 * o2 + i3 * o3 * o3;
    let square = m1 * m1 + m2 * m2 + m3 * m3;
    let (i32, i31, i21) = (i3 - i2, i3 - i1, i2 - i1);
    let (from_1, from_3) = (square - twice_energy * i1, twice_energy * i3 - square);
    let rate = (i32 * from_1 / (i1 * i2 * i3)).sqrt();
    let rate = if i3 < i1 { -rate } else { rate };
    let scales = [(from_3 / (i1 * i31)).sqrt(), (from_3 / (i2 * i32)).sqrt(), (from_1 / (i3 * i31)).sqrt()];
    let k2 = i21 * from_3 / (i32 * from_1);
    let modulus = Modulus::new(1.0 - k2);
    let quarter = modulus.quarter_period();
    let period = 4.0 * quarter / rate;
    let jacobi = move |u: f64| {
        let halves = (u / (2.0 * quarter)).round();
        let (sn, cn, dn) = modulus.sn_cn_dn(u - halves * 2.0 * quarter);
        let sign = if halves.rem_euclid(2.0) == 0.0 { 1.0 } else { -1.0 };
        [sn * sign, cn * sign, dn]
    };
    // the time at which sn is zero and cn one
    let near = |sn: f64, cn: f64| incomplete(sn, cn, k2, 1.0 - k2);
    let (x, y) = (o2 / scales[1], o1 / scales[0]);
    let from_pair = near(x, (1.0 - x * x).max(0.0).sqrt());
    let phase = match (o1.abs() >= o2.abs(), o1 >= 0.0, o2 >= 0.0) {
        (true, true, _) => from_pair,
        (true, false, _) => 2.0 * quarter - from_pair,
        (false, _, forward) => {
            // arccn, from 0 to 2K
            let half = near((1.0 - y * y).max(0.0).sqrt(), y.abs());
            let whole = if y < 0.0 { 2.0 * quarter - half } else { half };
            if forward { whole } else { -whole }
        }
    };
    let slope = square.sqrt() / i3;
    let (b, c, d) = (slope * i32 * i31, i1 * i32, i3 * i21);
    let integral = move |to: f64| {
        let width = period / PANELS as f64;
        let mut sum = 0.0;
        let mut from = 0.0;
        while (to - from) * rate.signum() > 0.0 {
            let until = if ((to - from) / width) > 1.0 { from + width } else { to };
            let (middle, half) = (0.5 * (from + until), 0.5 * (until - from));
            for [node, weight] in GAUSS {
                for node in [node, -node] {
                    let [sn, ..] = jacobi((middle + half * node) * rate + phase);
                    sum += weight * half * b / (c + d * sn * sn);
                }
            }
            if until == to {
                break;
            }
            from = until;
        }
        sum
    };
    let over_period = integral(period);
    let angles = move |[m1, m2, cosine]: [f64; 3]| (libm::acos(cosine), libm::atan2(m1, m2));
    let turn = |phi: f64, theta: f64, psi: f64| about::<2>(phi) * about::<0>(theta) * about::<2>(psi);
    let (theta, psi) = angles([m1, m2, m3 / square.sqrt()]);
    let back = turn(0.0, theta, psi).conjugate();
    Box::new(move |t| {
        let [sn, cn, dn] = jacobi(rate * t + phase);
        let (theta, psi) = angles([i1 * scales[0] * cn, i2 * scales[1] * sn, scales[2] * dn / slope]);
        let periods = (t / period).floor();
        let phi = slope * t + (periods * over_period + integral(t - periods * period));
        let q = back * turn(phi, theta, psi);
        curve.turn(Quat::new(q.w, Vec3([q.v[2], -q.v[1], q.v[0]])))
    })
}

/// A turn about the axis number `AXIS`.
fn about<const AXIS: usize>(angle: f64) -> Quat<f64> {
    let (sin, cos) = sin_cos(0.5 * angle);
    Quat::new(cos, Vec3::unit(AXIS) * sin)
}
