//! Motion of the momentum along its polhode, and the twist that goes with it.
//!
//! Swing and twist about the axis around which the momentum circulates, with Carlson's integrals: no frame that
//! becomes singular, no inverse sine, no branch that closes on the separatrix (methods.md §6.2).
//!
//! # Notation
//! | letter | meaning |
//! |---|---|
//! | I, m, G, H | moments, momentum in the body, \|m\|, energy |
//! | l, μ, h | axes of the smallest, middle, largest moment |
//! | a, b, c | axis about which m circulates (l or h), middle axis, the third |
//! | Δ_k | `G² − 2H I_k`: zero on the separatrix for k = μ |
//! | A, B, C | amplitudes: `m = (σA dn, B sn, C cn)` along (a, b, c) |
//! | ε, σ | +1 if (a, b, c) is an even permutation, sign of m_a |
//! | k², k'² | parameter and complementary parameter of the elliptic functions |
//! | u, ν, K | phase, its rate, quarter period |
//! | ψ | twist about σe_a |

use crate::num::elliptic::{carlson_rf, carlson_rj, complete_k, jacobi};
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// Constants of one polhode and of the start on it.
#[derive(Clone, Debug)]
pub(super) struct Circulation<S> {
    axes: [usize; 3], // a, b, c
    sigma: S,
    sign: S,           // εσ
    amplitude: [S; 3], // A, B, C
    norm: S,           // G
    parameter: S,      // k²
    complement: S,     // k'²
    phase: S,          // of the start, reduced to [−K, K]
    flipped: bool,     // whether that took half a turn
    rate: S,           // ν
    swing_back: Quat<S>,
    // ψ(t) = twist_rate t − εσ (twist_per_half_turn ΔN + periodic(t) − periodic(0))
    twist_rate: S, // G/I_c or G/I_a
    about_c: bool,
    characteristic: S, // n or n̂
    factor: S,
    twist_at_start: S,
    period: Option<Period<S>>,
}

/// What the reduction to one quarter period needs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Period<S> {
    pub(super) half: S, // 2K
    pub(super) twist: S,
}

impl<S: Precise> Circulation<S> {
    /// For moments `i` and momentum `m` of size `norm`; `delta_mu` is I_l I_h Δ_μ, whose error decides the accuracy
    /// near the separatrix. `None` where the momentum stays fixed in the body.
    pub(super) fn of(i: Vec3<S>, m: Vec3<S>, norm: S, scaled_delta_mu: S) -> Option<Self> {
        let zero = S::of(0.0);
        let [l, mu, h] = ascending(i);
        let square = |k: usize| m[k] * m[k];
        let delta_l = square(mu) * (i[mu] - i[l]) / i[mu] + square(h) * (i[h] - i[l]) / i[h];
        let delta_h = -(square(l) * (i[h] - i[l]) / i[l] + square(mu) * (i[h] - i[mu]) / i[mu]);
        let delta_mu = scaled_delta_mu / (i[l] * i[h]);
        let about_smallest = delta_mu <= zero;
        let (a, b, c) = if about_smallest { (l, mu, h) } else { (h, mu, l) };
        let (delta_a, delta_c) = if about_smallest { (delta_l, delta_h) } else { (delta_h, delta_l) };
        if delta_a == zero || delta_c == zero || (m[a] == zero && m[c] == zero) {
            return None;
        }

        let one = S::of(1.0);
        let sigma = if m[a] < zero { -one } else { one };
        let sign = if (b + 3 - a) % 3 == 1 { sigma } else { -sigma };
        let (ca, ba, cb) = (i[c] - i[a], i[b] - i[a], i[c] - i[b]);
        let amp_a = (-(i[a] * delta_c) / ca).sqrt();
        let amp_b = (i[b] * delta_a / ba).sqrt();
        let amp_c = (i[c] * delta_a / ca).sqrt();
        let denominator = if about_smallest { delta_h * (i[mu] - i[l]) } else { delta_l * (i[h] - i[mu]) };
        let parameter = -(delta_a * cb) / (delta_c * ba);
        let complement = delta_mu * (i[h] - i[l]) / denominator;
        let rate = sign * ca / (i[a] * i[c]) * amp_a * amp_c / amp_b;

        // the phase from the pair (sn, cn): an angle would lose digits near the separatrix
        let (x, y) = (m[b] / amp_b, m[c] / amp_c);
        let flipped = y < zero;
        let length = if flipped { -(x * x + y * y).sqrt() } else { (x * x + y * y).sqrt() };
        let (x, y) = (x / length, y / length);
        let phase = x * carlson_rf(y * y, complement + parameter * y * y, one);

        let n = -(i[a] * cb) / (i[c] * ba);
        let about_c = n * n <= parameter;
        let third = one / S::of(3.0);
        let (characteristic, factor, secular) = if about_c {
            (n, norm * amp_b / (amp_a * amp_c) * n * third, norm / i[c])
        } else {
            let n_hat = -(amp_c * amp_c) / (amp_a * amp_a);
            (n_hat, norm * amp_b * amp_c / (amp_a * amp_a * amp_a) * third, norm / i[a])
        };
        // on the separatrix the integral of the third kind is elementary: its part linear in u joins the rate
        let twist_rate = if complement == zero {
            secular - sign * S::of(3.0) * factor / (one - characteristic) * rate
        } else {
            secular
        };
        let mut circulation = Circulation {
            axes: [a, b, c],
            sigma,
            sign,
            amplitude: [amp_a, amp_b, amp_c],
            norm,
            parameter,
            complement,
            phase,
            flipped,
            rate,
            swing_back: Quat::identity(),
            twist_rate,
            about_c,
            characteristic,
            factor,
            twist_at_start: zero,
            period: None,
        };
        circulation.twist_at_start = circulation.periodic_twist(x, y);
        circulation.swing_back = circulation.swing(m).conjugate();
        Some(circulation)
    }

    /// Works out the period, so that any time can be reached; without it |u| stays below a quarter period.
    pub(super) fn with_period(mut self) -> Self {
        if self.complement != S::of(0.0) {
            let (zero, one) = (S::of(0.0), S::of(1.0));
            let complete = carlson_rj(zero, self.complement, one, one - self.characteristic);
            let pi = if self.about_c { S::from_dd(Dd::PI) } else { zero };
            self.period = Some(Period {
                half: S::of(2.0) * complete_k(self.complement),
                twist: S::of(2.0) * self.factor * complete - pi,
            });
        }
        self
    }

    /// Whether the phase at `t` lies within π/2 ≤ K, where no period is needed.
    pub(super) fn is_near(&self, t: S) -> bool {
        (self.phase + self.rate * t).magnitude() < 1.5
    }

    /// How often m_b changes sign between the start and `t`.
    pub(super) fn flips(&self, t: S) -> u64 {
        let (start, end) = (self.phase, self.phase + self.rate * t);
        match self.period {
            // sn is zero at the multiples of 2K
            Some(Period { half, .. }) => {
                let floor = |x: S| {
                    let nearest = (x / half).round();
                    if nearest * half > x { nearest - S::of(1.0) } else { nearest }
                };
                (floor(end) - floor(start)).magnitude() as u64
            }
            None => u64::from((start < S::of(0.0)) != (end < S::of(0.0))),
        }
    }

    /// The turn since the start and the momentum at time `t`, evaluated in `T`; phases are reduced in `S`.
    pub(super) fn at<T: Precise>(&self, t: S) -> (Quat<T>, Vec3<T>) {
        let u = self.phase + self.rate * t;
        let secular = self.twist_rate * t;
        let (reduced, odd, secular) = match self.period {
            None => (u, false, secular),
            Some(Period { half, twist }) => {
                let half_turns = (u / half).round();
                (u - half_turns * half, is_odd(half_turns), secular - self.sign * twist * half_turns)
            }
        };
        let (sn, cn, dn) = jacobi(cast::<S, T>(reduced), cast(self.complement));
        let [a, b, c] = self.axes;
        let [amp_a, amp_b, amp_c] = self.amplitude.map(cast::<S, T>);
        let sigma = cast::<S, T>(self.sigma);
        let parity = T::of(if odd == self.flipped { 1.0 } else { -1.0 });
        let mut m = Vec3::zero();
        m[a] = amp_a * dn * sigma;
        m[b] = amp_b * sn * parity;
        m[c] = amp_c * cn * parity;

        // the secular parts grow with t and partly cancel; they are reduced mod 4π, for the double cover
        let double_turn = S::from_dd(Dd::TAU * Dd::of(2.0));
        let secular = cast::<S, T>(reduce(secular, double_turn));
        let periodic = self.periodic_twist(sn, cn) - cast(self.twist_at_start);
        let psi = secular - cast::<S, T>(self.sign) * periodic;
        let (sin, cos) = (psi * T::of(0.5)).sin_cos();
        let turn = Quat::new(cos, Vec3::unit(a) * (sin * sigma));
        let back = Quat::from_components(self.swing_back.components().map(cast::<S, T>));
        (back * turn * self.swing(m), m)
    }

    /// The part of the twist that depends on the place on the polhode alone, at sn = x, cn = y ≥ 0.
    fn periodic_twist<T: Precise>(&self, x: T, y: T) -> T {
        let [amp_a, amp_b, amp_c] = self.amplitude.map(cast::<S, T>);
        let (one, n, factor) = (T::of(1.0), cast::<S, T>(self.characteristic), cast::<S, T>(self.factor));
        let d2 = cast::<S, T>(self.complement) + cast::<S, T>(self.parameter) * y * y;
        let third_kind = if self.complement == S::of(0.0) {
            let root = (-n).sqrt();
            -(T::of(3.0) * factor / ((one - n) * root) * (root * x).atan2(one))
        } else {
            factor * x * x * x * carlson_rj(y * y, d2, one, one - n * x * x)
        };
        let (bx, cy) = (amp_b * x, amp_c * y);
        if self.about_c {
            third_kind - bx.atan2(cy)
        } else {
            let norm = cast::<S, T>(self.norm);
            let along = amp_a * d2.sqrt();
            let g = (bx * bx + cy * cy) / (norm + along);
            third_kind + (bx * cy * g).atan2(along * cy * cy + norm * bx * bx)
        }
    }

    /// The shortest turn that takes m/G to σe_a.
    fn swing<T: Precise>(&self, m: Vec3<T>) -> Quat<T> {
        let along = Vec3::unit(self.axes[0]) * cast::<S, T>(self.sigma);
        Quat::new(cast::<S, T>(self.norm) + m.dot(along), m.cross(along)).normalized()
    }
}

/// The axes of the smallest, middle and largest moment.
pub(super) fn ascending<S: Precise>(i: Vec3<S>) -> [usize; 3] {
    let mut order = [0, 1, 2];
    order.sort_by(|&j, &k| i[j].partial_cmp(&i[k]).unwrap_or(core::cmp::Ordering::Equal));
    order
}

/// `x` less the nearest multiple of `period`.
pub(super) fn reduce<S: Precise>(x: S, period: S) -> S {
    x - (x / period).round() * period
}

/// Whether the integer `n` is odd, for either sign.
fn is_odd<S: Precise>(n: S) -> bool {
    let half = n * S::of(0.5);
    half.round() != half
}

/// The same number in another scalar.
pub(super) fn cast<S: Precise, T: Precise>(x: S) -> T {
    T::from_dd(x.to_dd())
}
