//! What the other forms share: the curve of the momentum by Jacobi's functions, all in doubles.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use polhode::num::elliptic::{Modulus, incomplete, r_f, r_j};
use polhode::num::trig::sin_cos;
use polhode::rotation::{Quat, Vec3};

use crate::experiments::evaluator::grid::Start;

/// The curve of the momentum, `m = (A dn, B sn, C cn)(νt + u₀)` along right-handed axes a, b, c, of which a is the one that the momentum
/// circulates about and b that of the middle moment.
///
/// A and B are positive and so is C; ν has either sign. Differences that would cancel are sums of terms of one sign; only the distance from the
/// separatrix, which decides about k'², has to be a difference.
pub(super) struct Curve {
    axes: [usize; 3],
    signs: [f64; 3],
    /// I_a, I_b, I_c.
    pub(super) moments: [f64; 3],
    /// The momentum at the start.
    pub(super) start: [f64; 3],
    pub(super) norm: f64,
    pub(super) twice_energy: f64,
    /// A, B, C.
    pub(super) amplitudes: [f64; 3],
    pub(super) rate: f64,
    pub(super) k2: f64,
    pub(super) modulus: Modulus<f64>,
    pub(super) quarter: f64,
    pub(super) phase: f64,
    pub(super) complement: f64,
    /// G² − 2H I_b.
    pub(super) separation: f64,
}

/// The characteristic n of an integral of the third kind, with 1 − n, which for n near 1 is no difference.
#[derive(Clone, Copy)]
pub(super) struct Characteristic {
    pub(super) n: f64,
    pub(super) complement: f64,
}

impl Characteristic {
    /// Of n < 0.
    pub(super) fn negative(n: f64) -> Self {
        Characteristic { n, complement: 1.0 - n }
    }

    /// 1 − n sn².
    fn at(self, [sn, cn]: [f64; 2]) -> f64 {
        if self.n > 0.0 { self.complement + self.n * cn * cn } else { 1.0 - self.n * sn * sn }
    }
}

/// Where the curve is at one time.
pub(super) struct Place {
    /// Along a, b, c.
    pub(super) momentum: [f64; 3],
    pub(super) u: f64,
    /// Half periods since u = 0.
    pub(super) halves: f64,
    /// sn and cn of what is left.
    pub(super) rest: [f64; 2],
}

impl Curve {
    pub(super) fn new(start: &Start) -> Self {
        let i = start.moments;
        let m = [0, 1, 2].map(|k| i[k] * start.omega[k]);
        let mut order = [0, 1, 2];
        order.sort_by(|&j, &k| i[j].total_cmp(&i[k]));
        let [l, mu, h] = order;
        let separation = m[h] * m[h] * (i[h] - i[mu]) / i[h] - m[l] * m[l] * (i[mu] - i[l]) / i[l];
        let axes @ [a, b, c] = if separation <= 0.0 { [l, mu, h] } else { [h, mu, l] };
        let first = if m[a] < 0.0 { -1.0 } else { 1.0 };
        let signs = [first, 1.0, if (b + 3 - a) % 3 == 1 { first } else { -first }];
        let start = [0, 1, 2].map(|k| m[axes[k]] * signs[k]);
        let [ma, mb, mc] = start;
        let [ia, ib, ic] = [i[a], i[b], i[c]];
        let from_a = mb * mb * (ib - ia) / ib + mc * mc * (ic - ia) / ic;
        let from_c = ma * ma * (ic - ia) / ia + mb * mb * (ic - ib) / ib;
        let amplitudes @ [amp_a, amp_b, amp_c] =
            [ia * from_c / (ic - ia), ib * from_a / (ib - ia), ic * from_a / (ic - ia)].map(f64::sqrt);
        let k2 = (ic - ib) * from_a / ((ib - ia) * from_c);
        let complement = -separation * (ic - ia) / ((ib - ia) * from_c);
        let modulus = Modulus::new(complement);
        let quarter = modulus.quarter_period();
        let (sn, cn) = (mb / amp_b, mc / amp_c);
        let size = (sn * sn + cn * cn).sqrt();
        let near = incomplete(sn / size, (cn / size).abs(), k2, complement);
        Curve {
            axes,
            signs,
            moments: [ia, ib, ic],
            start,
            norm: Vec3(m).norm(),
            twice_energy: ma * ma / ia + mb * mb / ib + mc * mc / ic,
            amplitudes,
            rate: (ic - ia) / (ia * ic) * amp_a * amp_c / amp_b,
            k2,
            modulus,
            quarter,
            phase: if cn < 0.0 { 2.0 * quarter - near } else { near },
            complement,
            separation,
        }
    }

    pub(super) fn at(&self, t: f64) -> Place {
        let u = self.rate * t + self.phase;
        let halves = (u / (2.0 * self.quarter)).round();
        let (sn, cn, dn) = self.modulus.sn_cn_dn(u - halves * 2.0 * self.quarter);
        let sign = if halves.rem_euclid(2.0) == 0.0 { 1.0 } else { -1.0 };
        let [a, b, c] = self.amplitudes;
        Place { momentum: [a * dn, b * sn * sign, c * cn * sign], u, halves, rest: [sn, cn] }
    }

    /// A turn of the body that is given along a, b, c.
    pub(super) fn turn(&self, q: Quat<f64>) -> Quat<f64> {
        let mut v = Vec3::zero();
        for k in 0..3 {
            v[self.axes[k]] = q.v[k] * self.signs[k];
        }
        Quat::new(q.w, v)
    }

    /// The shortest turn that takes the momentum to the axis a.
    pub(super) fn swing(&self, [a, b, c]: [f64; 3]) -> Quat<f64> {
        Quat::new(self.norm + a, Vec3([0.0, c, -b])).normalized()
    }

    /// The integral of the third kind less that of the first, over n/3, from the zero of sn to the pair (sn, cn ≥ 0).
    pub(super) fn third_kind(&self, rest: [f64; 2], n: Characteristic) -> f64 {
        let [sn, cn] = rest;
        let dn2 = self.complement + self.k2 * cn * cn;
        sn * sn * sn * r_j(cn * cn, dn2, 1.0, n.at(rest))
    }

    /// The same over a quarter period.
    pub(super) fn complete_third_kind(&self, n: Characteristic) -> f64 {
        r_j(0.0, self.complement, 1.0, n.complement)
    }

    /// Π(am u, n) at a place.
    pub(super) fn pi(&self, place: &Place, n: Characteristic) -> f64 {
        let periods = 2.0 * place.halves * self.complete_third_kind(n);
        place.u + n.n / 3.0 * (periods + self.third_kind(place.rest, n))
    }

    /// Π(φ, n) of a rounded amplitude φ, less whole half turns.
    pub(super) fn pi_of_amplitude(&self, amplitude: f64, n: Characteristic) -> f64 {
        let half_turns = (amplitude / std::f64::consts::PI).round();
        let (sin, cos) = sin_cos(amplitude - half_turns * std::f64::consts::PI);
        let first = sin * r_f(cos * cos, self.complement + self.k2 * cos * cos, 1.0);
        let complete = self.quarter + n.n / 3.0 * self.complete_third_kind(n);
        2.0 * half_turns * complete + first + n.n / 3.0 * self.third_kind([sin, cos], n)
    }
}

/// A turn about the axis a by `angle`.
pub(super) fn twist(angle: f64) -> Quat<f64> {
    let (sin, cos) = sin_cos(0.5 * angle);
    Quat::new(cos, Vec3([sin, 0.0, 0.0]))
}

/// am of a place, from its half periods.
pub(super) fn amplitude(place: &Place) -> f64 {
    let [sn, cn] = place.rest;
    place.halves * std::f64::consts::PI + libm::atan2(sn, cn)
}

/// The matrix of a turn about the third axis.
pub(super) fn about_third(angle: f64) -> Matrix3<f64> {
    let (sin, cos) = sin_cos(angle);
    Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0)
}

/// The quaternion of a matrix that is a rotation to rounding.
pub(super) fn quaternion(matrix: Matrix3<f64>) -> Quat<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix)).into()
}
