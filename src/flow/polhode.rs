//! The curve of the momentum in the body: which axis it encloses, how wide, how fast, and where the start lies on it.
//!
//! # Notation
//! | letter | meaning |
//! |---|---|
//! | I, m, G, H | moments, momentum in the body, \|m\|, energy |
//! | l, μ, h | axes of the smallest, middle, largest moment |
//! | a, b, c | axis about which m circulates (l or h), middle axis, the third |
//! | Δ_k | `G² − 2H I_k`: zero on the separatrix for k = μ |
//! | A, B, C | amplitudes: `m = (σA dn, B sn, C cn)` along (a, b, c) |
//! | σ, δ | sign of m_a; σ if (a, b, c) is an even permutation, else −σ |
//! | k², k'² | parameter and complementary parameter of the elliptic functions |
//! | u, ν, K | phase, its rate, quarter period |
//!
//! Source: Landau and Lifshitz, Mechanics, §37, without relabelled vectors and without differences that cancel.

use crate::num::elliptic::incomplete;
use crate::num::{Dd, Expansion, Precise};
use crate::rotation::{Quat, Vec3};

/// Constants of one polhode and of the start on it.
#[derive(Clone, Debug)]
pub(super) struct Polhode<S> {
    /// a, b, c.
    pub(super) axes: [usize; 3],
    /// Whether a is the axis of the smallest moment: long-axis mode.
    pub(super) about_smallest: bool,
    pub(super) sigma: S,
    pub(super) delta: S,
    /// A, B, C.
    pub(super) amplitude: [S; 3],
    /// I_a, I_b, I_c.
    pub(super) moments: [S; 3],
    pub(super) norm: S,
    pub(super) twice_energy: S,
    pub(super) parameter: S,
    pub(super) complement: S,
    pub(super) rate: S,
    /// sn and cn ≥ 0 of the start; where cn was negative both are turned round, by half a period.
    pub(super) start: (S, S),
    pub(super) half_turned: bool,
    /// Δ_μ.
    pub(super) separation: S,
}

impl<S: Precise> Polhode<S> {
    /// For moments `i` and momentum `m` of size `norm` > 0; `scaled_separation` is I_l I_h Δ_μ, whose error decides
    /// the accuracy near the separatrix. `None` where the momentum stays fixed in the body.
    pub(super) fn of(i: Vec3<S>, m: Vec3<S>, norm: S, scaled_separation: S) -> Option<Self> {
        let zero = S::of(0.0);
        let [l, mu, h] = ascending(i);
        let square = |k: usize| m[k] * m[k];
        // sums of terms of one sign: nothing cancels
        let delta_l = square(mu) * (i[mu] - i[l]) / i[mu] + square(h) * (i[h] - i[l]) / i[h];
        let delta_h = -(square(l) * (i[h] - i[l]) / i[l] + square(mu) * (i[h] - i[mu]) / i[mu]);
        let separation = scaled_separation / (i[l] * i[h]);
        let about_smallest = separation <= zero;
        let (a, b, c) = if about_smallest { (l, mu, h) } else { (h, mu, l) };
        let (delta_a, delta_c) = if about_smallest { (delta_l, delta_h) } else { (delta_h, delta_l) };
        if delta_a == zero || delta_c == zero || (m[a] == zero && m[c] == zero) {
            return None;
        }

        let one = S::of(1.0);
        let sigma = if m[a] < zero { -one } else { one };
        let delta = if (b + 3 - a) % 3 == 1 { sigma } else { -sigma };
        let (ca, ba, cb) = (i[c] - i[a], i[b] - i[a], i[c] - i[b]);
        let amp_a = (-(i[a] * delta_c) / ca).sqrt();
        let amp_b = (i[b] * delta_a / ba).sqrt();
        let amp_c = (i[c] * delta_a / ca).sqrt();
        let denominator = if about_smallest { delta_h * (i[mu] - i[l]) } else { delta_l * (i[h] - i[mu]) };
        let (x, y) = (m[b] / amp_b, m[c] / amp_c);
        let half_turned = y < zero;
        let length = (x * x + y * y).sqrt();
        let length = if half_turned { -length } else { length };
        Some(Polhode {
            axes: [a, b, c],
            about_smallest,
            sigma,
            delta,
            amplitude: [amp_a, amp_b, amp_c],
            moments: [i[a], i[b], i[c]],
            norm,
            twice_energy: square(0) / i[0] + square(1) / i[1] + square(2) / i[2],
            parameter: -(delta_a * cb) / (delta_c * ba),
            complement: separation * (i[h] - i[l]) / denominator,
            rate: delta * ca / (i[a] * i[c]) * amp_a * amp_c / amp_b,
            start: (x / length, y / length),
            half_turned,
            separation,
        })
    }

    /// The phase of the start in [−K, K], from the pair (sn, cn): an angle would lose digits near the separatrix.
    pub(super) fn phase(&self) -> S {
        let (sn, cn) = self.start;
        incomplete(sn, cn, self.parameter, self.complement)
    }

    /// Whether the motion is the separatrix itself, which has no period.
    pub(super) fn is_separatrix(&self) -> bool {
        self.complement == S::of(0.0)
    }

    /// The shortest turn that takes m/G to σe_a.
    pub(super) fn swing(&self, m: Vec3<S>) -> Quat<S> {
        let along = Vec3::unit(self.axes[0]) * self.sigma;
        Quat::new(self.norm + m.dot(along), m.cross(along)).normalized()
    }
}

/// The axes of the smallest, middle and largest moment.
pub(super) fn ascending<S: Precise>(i: Vec3<S>) -> [usize; 3] {
    let mut order = [0, 1, 2];
    order.sort_by(|&j, &k| i[j].partial_cmp(&i[k]).unwrap_or(core::cmp::Ordering::Equal));
    order
}

/// `I_l I_h Δ_μ = m_h² I_l (I_h − I_μ) − m_l² I_h (I_μ − I_l)`, exactly, then rounded once.
///
/// Its relative error is twice that of the period near the separatrix, where the two terms agree in all digits:
/// nothing less than the exact value will do.
pub(super) fn exact_separation(i: Vec3<Dd>, m: Vec3<Dd>) -> Dd {
    let [l, mu, h] = ascending(i);
    let term = |j: usize, other: usize, higher: usize, lower: usize| {
        let m = Expansion::from(m[j]);
        let difference = &Expansion::from(i[higher]) - &Expansion::from(i[lower]);
        &(&(&m * &m) * &Expansion::from(i[other])) * &difference
    };
    (&term(h, l, h, mu) - &term(l, h, mu, l)).to_dd()
}

/// The same in the scalar's own arithmetic.
pub(super) fn rounded_separation<S: Precise>(i: Vec3<S>, m: Vec3<S>) -> S {
    let [l, mu, h] = ascending(i);
    m[h] * m[h] * i[l] * (i[h] - i[mu]) - m[l] * m[l] * i[h] * (i[mu] - i[l])
}
