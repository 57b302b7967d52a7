//! The exact motion of a free rigid body, at any time, in every regime.
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
//! | Δ_k | `2H I_k − G²`, up to sign and a factor: zero on the separatrix for k = μ |
//! | A, B, C | amplitudes: `m = (σA dn, B sn, C cn)` along (a, b, c) |
//! | ε, σ | +1 if (a, b, c) is an even permutation, sign of m_a |
//! | k², k'² | parameter and complementary parameter of the elliptic functions |
//! | u, ν, K | phase, its rate, quarter period |
//! | ψ | twist about σe_a |

use nalgebra::{UnitQuaternion, Vector3};
use thiserror::Error;

use crate::body::{Body, Inertia, State, StateError};
use crate::num::elliptic::{carlson_rf, carlson_rj, complete_k, jacobi};
use crate::num::{Dd, Expansion, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// The motion of one free body from one start: constants worked out once, then any time in O(1).
///
/// ```
/// use nalgebra::{UnitQuaternion, Vector3};
/// use polhode::body::Inertia;
/// use polhode::flow::FreeMotion;
///
/// let racket = Inertia::from_moments([1.0, 2.0, 3.0])?;
/// let motion = FreeMotion::from_omega(&racket, UnitQuaternion::identity(), Vector3::new(0.4, 1.0, -0.3))?;
/// let (start, later) = (motion.at(0.0)?, motion.at(1e9)?);
/// let (before, after) = (start.rotation() * start.momentum(), later.rotation() * later.momentum());
/// assert!((before - after).norm() < 1e-14); // L is fixed in space
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct FreeMotion {
    body: Body,
    start: State<Dd>,
    kind: Kind,
}

/// The time asked for is not a number.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("time {t} s is not a finite number")]
pub struct TimeError {
    /// The time, s.
    pub t: f64,
}

#[derive(Clone, Debug)]
enum Kind {
    /// No momentum: the attitude stays.
    Rest,
    /// Momentum fixed in the body, which turns about it at the given rate: a sphere, a pure spin.
    Steady { axis: Vec3<Dd>, rate: Dd },
    /// The momentum moves along its polhode.
    Circulating(Box<Circulation>),
}

/// Constants of a polhode, in double-double.
#[derive(Clone, Debug)]
struct Circulation {
    axes: [usize; 3], // a, b, c
    sigma: f64,
    amplitude: [Dd; 3], // A, B, C
    norm: Dd,           // G
    parameter: Dd,      // k²
    complement: Dd,     // k'²
    half_period: Dd,    // 2K; infinite on the separatrix
    phase: Dd,          // of the start, reduced to [−K, K]
    flipped: bool,      // whether that took half a turn
    rate: Dd,           // ν
    swing_back: Quat<Dd>,
    twist: Twist,
}

/// ψ(t) = rate t − per_half_turn ΔN − εσ (periodic(t) − periodic(0)).
#[derive(Clone, Debug)]
struct Twist {
    rate: Dd,          // G/I_c or G/I_a
    per_half_turn: Dd, // times εσ
    sign: f64,         // εσ
    characteristic: Dd,
    factor: Dd,
    about_c: bool,
    at_start: Dd,
}

impl FreeMotion {
    /// From the attitude and the angular velocity (rad/s, body axes) at t = 0; the product I ω is formed exactly.
    ///
    /// # Errors
    /// Components that are not finite, or an energy outside the range of a double.
    pub fn from_omega(
        inertia: &Inertia,
        attitude: UnitQuaternion<f64>,
        omega_body: Vector3<f64>,
    ) -> Result<Self, StateError> {
        let body = Body::free(inertia.clone());
        let start = body.enter_omega(attitude.into(), omega_body.into())?;
        Ok(Self::new(&body, start))
    }

    /// From a state at t = 0, body axes.
    ///
    /// # Errors
    /// As [`from_omega`](Self::from_omega).
    pub fn from_state(inertia: &Inertia, start: &State<f64>) -> Result<Self, StateError> {
        let body = Body::free(inertia.clone());
        let start = body.enter(start)?;
        Ok(Self::new(&body, start))
    }

    /// From a state at t = 0 as kernels see it.
    pub fn new(body: &Body, start: State<Dd>) -> Self {
        FreeMotion { body: body.clone(), start, kind: Kind::of(body, start.momentum_body) }
    }

    /// The body that moves.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The state at time `t` (s, of either sign), body axes.
    ///
    /// # Errors
    /// A time that is not finite.
    pub fn at(&self, t: f64) -> Result<State<f64>, TimeError> {
        if !t.is_finite() {
            return Err(TimeError { t });
        }
        Ok(self.body.leave(&self.inside_at::<f64>(Dd::from(t))))
    }

    /// The state at time `t` as kernels see it, in `f64` or double-double; the phases are reduced in
    /// double-double in either case. The quaternion is the continuous lift from the start: it does not jump from
    /// `q` to `−q`.
    pub fn inside_at<S: Precise>(&self, t: Dd) -> State<S> {
        let q0 = in_scalar::<S>(self.start.attitude);
        match &self.kind {
            Kind::Rest => State { attitude: q0, momentum_body: Vec3::zero() },
            Kind::Steady { axis, rate } => {
                let (sin, cos) = S::from_dd(reduce(*rate * t, Dd::TAU * Dd::of(2.0)) * Dd::of(0.5)).sin_cos();
                let turn = Quat::new(cos, Vec3(axis.0.map(S::from_dd)) * sin);
                State { attitude: q0 * turn, momentum_body: Vec3(self.start.momentum_body.0.map(S::from_dd)) }
            }
            Kind::Circulating(polhode) => {
                let (turn, momentum_body) = polhode.at::<S>(t);
                State { attitude: q0 * turn, momentum_body }
            }
        }
    }
}

impl Kind {
    fn of(body: &Body, m: Vec3<Dd>) -> Self {
        let moments: Vec3<Dd> = body.moments();
        let squared = m.norm_squared();
        if squared.hi() == 0.0 {
            return Kind::Rest;
        }
        let norm = squared.sqrt();
        match Circulation::of(moments, m, norm) {
            Some(circulation) => Kind::Circulating(Box::new(circulation)),
            None => {
                let omega = m.times(body.inverse_moments());
                Kind::Steady { axis: m * (Dd::ONE / norm), rate: m.dot(omega) / norm }
            }
        }
    }
}

impl Circulation {
    /// `None` where the momentum stays fixed in the body.
    fn of(i: Vec3<Dd>, m: Vec3<Dd>, norm: Dd) -> Option<Self> {
        let mut order = [0, 1, 2];
        order.sort_by(|&j, &k| i[j].partial_cmp(&i[k]).unwrap_or(core::cmp::Ordering::Equal));
        let [l, mu, h] = order;
        let square = |k: usize| m[k] * m[k];
        let delta_l = square(mu) * (i[mu] - i[l]) / i[mu] + square(h) * (i[h] - i[l]) / i[h];
        let delta_h = -(square(l) * (i[h] - i[l]) / i[l] + square(mu) * (i[h] - i[mu]) / i[mu]);
        let delta_mu = separatrix_distance(i, m, [l, mu, h]) / (i[l] * i[h]);
        let about_smallest = delta_mu <= Dd::ZERO;
        let (a, b, c) = if about_smallest { (l, mu, h) } else { (h, mu, l) };
        let (delta_a, delta_c) = if about_smallest { (delta_l, delta_h) } else { (delta_h, delta_l) };
        if delta_a == Dd::ZERO || delta_c == Dd::ZERO || (m[a] == Dd::ZERO && m[c] == Dd::ZERO) {
            return None;
        }

        let even = (b + 3 - a) % 3 == 1;
        let sigma = if m[a] < Dd::ZERO { -1.0 } else { 1.0 };
        let sign = if even { sigma } else { -sigma }; // εσ
        let signed = |x: Dd| if sign < 0.0 { -x } else { x };
        let ca = i[c] - i[a];
        let ba = i[b] - i[a];
        let cb = i[c] - i[b];
        let amp_a = (-(i[a] * delta_c) / ca).sqrt();
        let amp_b = (i[b] * delta_a / ba).sqrt();
        let amp_c = (i[c] * delta_a / ca).sqrt();
        let parameter = -(delta_a * cb) / (delta_c * ba);
        let complement = if about_smallest {
            delta_mu * (i[h] - i[l]) / (delta_h * (i[mu] - i[l]))
        } else {
            delta_mu * (i[h] - i[l]) / (delta_l * (i[h] - i[mu]))
        };
        let rate = signed(ca / (i[a] * i[c]) * amp_a * amp_c / amp_b);

        // the phase from the pair (sn, cn): an angle would lose digits near the separatrix
        let (x, y) = (m[b] / amp_b, m[c] / amp_c);
        let length = (x * x + y * y).sqrt();
        let flip = y < Dd::ZERO;
        let (x0, y0) = if flip { (-(x / length), -(y / length)) } else { (x / length, y / length) };
        let phase = x0 * carlson_rf(y0 * y0, complement + parameter * y0 * y0, Dd::ONE);
        let half_period = Dd::of(2.0) * complete_k(complement);

        let n = -(i[a] * cb) / (i[c] * ba);
        let about_c = n * n <= parameter;
        let (characteristic, factor, secular) = if about_c {
            (n, norm * amp_b / (amp_a * amp_c) * n / Dd::of(3.0), norm / i[c])
        } else {
            let n_hat = -(amp_c * amp_c) / (amp_a * amp_a);
            (n_hat, norm * amp_b * amp_c / (Dd::of(3.0) * amp_a * amp_a * amp_a), norm / i[a])
        };
        let mut circulation = Circulation {
            axes: [a, b, c],
            sigma,
            amplitude: [amp_a, amp_b, amp_c],
            norm,
            parameter,
            complement,
            half_period,
            phase,
            flipped: flip,
            rate,
            swing_back: Quat::identity(),
            twist: Twist {
                rate: secular,
                per_half_turn: Dd::ZERO,
                sign,
                characteristic,
                factor,
                about_c,
                at_start: Dd::ZERO,
            },
        };
        if complement == Dd::ZERO {
            // the integral of the third kind is elementary there: its part linear in u joins the rate
            let linear = Dd::of(3.0) * factor / (Dd::ONE - characteristic);
            circulation.twist.rate = secular - signed(linear * rate);
        } else {
            let complete = carlson_rj(Dd::ZERO, complement, Dd::ONE, Dd::ONE - characteristic);
            let pi = if about_c { Dd::PI } else { Dd::ZERO };
            circulation.twist.per_half_turn = signed(Dd::of(2.0) * factor * complete - pi);
        }
        circulation.twist.at_start = circulation.periodic_twist(x0, y0);
        circulation.swing_back = circulation.swing(m).conjugate();
        Some(circulation)
    }

    /// The turn since the start and the momentum at time `t`.
    fn at<S: Precise>(&self, t: Dd) -> (Quat<S>, Vec3<S>) {
        let u = self.phase + self.rate * t;
        let half_turns = if self.complement == Dd::ZERO { Dd::ZERO } else { (u / self.half_period).round() };
        let reduced = if half_turns == Dd::ZERO { u } else { u - half_turns * self.half_period };
        let (sn, cn, dn) = jacobi(S::from_dd(reduced), S::from_dd(self.complement));

        let [a, b, c] = self.axes;
        let amplitude = self.amplitude.map(S::from_dd);
        let odd = is_odd(half_turns) != self.flipped;
        let sign = S::of(if odd { -1.0 } else { 1.0 });
        let mut m = Vec3::zero();
        m[a] = amplitude[0] * dn * S::of(self.sigma);
        m[b] = amplitude[1] * sn * sign;
        m[c] = amplitude[2] * cn * sign;

        let twist = &self.twist;
        // both terms grow with t and partly cancel: they meet in double-double, mod 4π for the double cover
        let secular = reduce(twist.rate * t - twist.per_half_turn * half_turns, Dd::TAU * Dd::of(2.0));
        let periodic = self.periodic_twist(sn, cn) - S::from_dd(twist.at_start);
        let psi = S::from_dd(secular) - periodic * S::of(twist.sign);
        let (sin, cos) = (psi * S::of(0.5)).sin_cos();
        let turn = Quat::new(cos, Vec3::unit(a) * (sin * S::of(self.sigma)));
        (in_scalar::<S>(self.swing_back) * turn * self.swing(m), m)
    }

    /// The part of the twist that depends on the place on the polhode alone, at sn = x, cn = y ≥ 0.
    fn periodic_twist<S: Precise>(&self, x: S, y: S) -> S {
        let [amp_a, amp_b, amp_c] = self.amplitude.map(S::from_dd);
        let twist = &self.twist;
        let d2 = S::from_dd(self.complement) + S::from_dd(self.parameter) * y * y;
        let (one, n, factor) = (S::of(1.0), S::from_dd(twist.characteristic), S::from_dd(twist.factor));
        let third_kind = if self.complement == Dd::ZERO {
            let root = (-n).sqrt();
            -(S::of(3.0) * factor / ((one - n) * root) * (root * x).atan2(one))
        } else {
            factor * x * x * x * carlson_rj(y * y, d2, one, one - n * x * x)
        };
        let (bx, cy) = (amp_b * x, amp_c * y);
        if twist.about_c {
            third_kind - bx.atan2(cy)
        } else {
            let norm = S::from_dd(self.norm);
            let along = amp_a * d2.sqrt();
            let g = (bx * bx + cy * cy) / (norm + along);
            third_kind + (bx * cy * g).atan2(along * cy * cy + norm * bx * bx)
        }
    }

    /// The shortest turn that takes m/G to σe_a.
    fn swing<S: Precise>(&self, m: Vec3<S>) -> Quat<S> {
        let along = Vec3::unit(self.axes[0]) * S::of(self.sigma);
        Quat::new(S::from_dd(self.norm) + m.dot(along), m.cross(along)).normalized()
    }
}

/// `x` less the nearest multiple of `period`.
fn reduce(x: Dd, period: Dd) -> Dd {
    x - (x / period).round() * period
}

/// Whether the integer `n` is odd, for either sign.
fn is_odd(n: Dd) -> bool {
    let half = n * Dd::of(0.5);
    half.round() != half
}

fn in_scalar<S: Precise>(q: Quat<Dd>) -> Quat<S> {
    Quat::from_components(q.components().map(S::from_dd))
}

/// `m_h² I_l (I_h − I_μ) − m_l² I_h (I_μ − I_l)`, exactly, then rounded once.
///
/// Its relative error is twice that of the period near the separatrix, where the two terms agree in all digits:
/// nothing less than the exact value will do.
fn separatrix_distance(i: Vec3<Dd>, m: Vec3<Dd>, [l, mu, h]: [usize; 3]) -> Dd {
    let term = |j: usize, other: usize, higher: usize, lower: usize| {
        let m = Expansion::from(m[j]);
        let difference = &Expansion::from(i[higher]) - &Expansion::from(i[lower]);
        &(&(&m * &m) * &Expansion::from(i[other])) * &difference
    };
    (&term(h, l, h, mu) - &term(l, h, mu, l)).to_dd()
}
