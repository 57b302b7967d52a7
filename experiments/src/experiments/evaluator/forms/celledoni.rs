//! The angle about L by the integral of the third kind.

use nalgebra::{Matrix3, Vector3};

use super::plain::{Characteristic, about_third, amplitude, quaternion, twist};
use super::{Curve, Motion};
use crate::experiments::evaluator::grid::Start;

/// In the frame of dm/dt, m × dm/dt and m: `ψ = 2T/G t + Δ₂/(ν I₂ G) [Π(am) − Π(am₀)]`.
pub(super) fn moving_frame(start: &Start) -> Motion {
    let curve = Curve::new(start);
    let [ia, ib, ic] = curve.moments;
    let [ma, mb, _] = curve.start;
    let norm = curve.norm;
    // the square of the other radius along b, at which m_c would be largest
    let other = ib * (ma * ma * (ic - ia) / ia + mb * mb * (ic - ib) / ib) / (ic - ib);
    let n =
        Characteristic { n: norm * norm / other, complement: -ic * curve.separation / ((ic - ib) * other) };
    let factor = curve.separation / (curve.rate * ib * norm);
    let offset = curve.pi(&curve.at(0.0), n);
    let first = frame(&curve, curve.start);
    Box::new(move |t| {
        let place = curve.at(t);
        let psi = curve.twice_energy / norm * t + factor * (curve.pi(&place, n) - offset);
        let turn = first.transpose() * about_third(psi) * frame(&curve, place.momentum);
        curve.turn(quaternion(turn))
    })
}

/// The rotation that takes dm/dt, m × dm/dt and m to the axes x, y and z.
fn frame(curve: &Curve, momentum: [f64; 3]) -> Matrix3<f64> {
    let m = Vector3::from(momentum);
    let omega = m.component_div(&Vector3::from(curve.moments));
    let third = m.normalize();
    let first = m.cross(&omega).normalize();
    Matrix3::from_rows(&[first.transpose(), third.cross(&first).transpose(), third.transpose()])
}

/// By the shortest turn from m to the axis a: the third kind over what is left of a half period, and an arc tangent.
pub(super) fn swing(start: &Start) -> Motion {
    let curve = Curve::new(start);
    let [ia, ib, ic] = curve.moments;
    let [a, b, c] = curve.amplitudes;
    let n = Characteristic::negative(-(ia * (ic - ib)) / (ic * (ib - ia)));
    let factor = curve.norm * b / (a * c) * n.n / 3.0;
    let per_half = 2.0 * factor * curve.complete_third_kind(n) - std::f64::consts::PI;
    let periodic = move |curve: &Curve, [sn, cn]: [f64; 2]| {
        factor * curve.third_kind([sn, cn], n) - libm::atan2(b * sn, c * cn)
    };
    let at_start = curve.at(0.0);
    let (halves, offset) = (at_start.halves, periodic(&curve, at_start.rest));
    let back = curve.swing(curve.start).conjugate();
    Box::new(move |t| {
        let place = curve.at(t);
        let psi = curve.norm * t / ic
            - (per_half * (place.halves - halves) + periodic(&curve, place.rest) - offset);
        curve.turn(back * twist(psi) * curve.swing(place.momentum))
    })
}

/// The same as in Principia: the third kind of the whole amplitude, beside a rate G/I_a, and the arc tangent over a whole turn.
pub(super) fn principia(start: &Start) -> Motion {
    let curve = Curve::new(start);
    let [ia, ib, ic] = curve.moments;
    let n = Characteristic::negative(-(ia * (ic - ib)) / (ic * (ib - ia)));
    let (cn_factor, sn_factor) = ((ic * (ib - ia).abs()).sqrt(), (ib * (ic - ia).abs()).sqrt());
    let factor = curve.norm * (ia - ic) / (curve.rate * ia * ic);
    let angle = move |curve: &Curve, t: f64| {
        let place = curve.at(t);
        let sign = if place.halves.rem_euclid(2.0) == 0.0 { 1.0 } else { -1.0 };
        let [sn, cn] = place.rest.map(|x| x * sign);
        let psi = factor * curve.pi_of_amplitude(amplitude(&place), n)
            + libm::atan2(sn_factor * sn, cn_factor * cn);
        (psi, place)
    };
    let offset = angle(&curve, 0.0).0;
    let back = curve.swing(curve.start).conjugate();
    Box::new(move |t| {
        let (psi, place) = angle(&curve, t);
        let psi = curve.norm / ia * t + psi - offset;
        curve.turn(back * twist(psi) * curve.swing(place.momentum))
    })
}
