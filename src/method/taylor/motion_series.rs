//! The Taylor series of a motion about one of its points.

use core::array::from_fn;

use super::gradient_series::GradientSeries;
use super::turned::Turned;
use crate::body::{Field, Gyroscopic, Phase, Point, Rotor, Time, vertical};
use crate::method::solve::length::length;
use crate::num::{Dd, Real, Series, Tape};
use crate::rotation::{Quat, Vec3};

/// Coefficients of attitude and momentum up to an order K, the time counted in a unit.
///
/// With `m = Σ m_n`, `q = Σ q_n` and the unit u: `(n + 1) m_{n+1} = u (Σ m_k × I⁻¹m_{n−k} + τ_n)` and
/// `2 (n + 1) q_{n+1} = u Σ q_k ∘ I⁻¹m_{n−k}`, k ≤ n. The first sum is taken as `D_i Σ (m_k)_j (m_{n−k})_l`,
/// `D_i = 1/I_l − 1/I_j`, as its products cancel along the axis of a rod. Of a linear potential τ_n is `Γ_n × c`, with
/// `(n + 1) Γ_{n+1} = u Σ Γ_k × I⁻¹m_{n−k}`; a gravity gradient on a conic has [recurrences of its own](GradientSeries); of all other
/// forces it is the coefficient n of their laws, which are recorded once for all n. The unit is a power of two, so that it costs no rounding.
#[derive(Clone, Debug)]
pub(super) struct MotionSeries<S, F> {
    order: usize,
    field: F,
    inverse_moments: Vec3<S>,
    gyroscopic: Gyroscopic<S>,
    /// 1/(n + 1).
    shares: Vec<S>,
    momentum: Vec<Turned<S>>,
    attitude: Vec<Spun<S>>,
    /// ω and Γ; empty without a linear potential.
    fall: Vec<[Turned<S>; 2]>,
    /// The torque of a gravity gradient.
    gradient: Option<GradientSeries<S>>,
    /// The torque of all the rest by attitude and ω; `None` where nothing else acts.
    others: Option<Tape<S>>,
}

/// A quaternion q, and the three `½ q ∘ e_a/I_a` that ω turns it by.
#[derive(Clone, Copy, Debug)]
struct Spun<S> {
    components: [S; 4],
    by: [[S; 4]; 3],
}

impl<S: Real> Spun<S> {
    fn new(components: [S; 4], inverse_moments: Vec3<S>) -> Self {
        let [w, x, y, z] = components;
        let half = inverse_moments * S::of(0.5);
        let by = [[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]];
        Spun { components, by: [0, 1, 2].map(|axis| by[axis].map(|c| c * half[axis])) }
    }
}

impl<S: Real, F: Field<S>> MotionSeries<S, F> {
    /// The order K.
    pub(super) fn order(&self) -> usize {
        self.order
    }

    pub(super) fn new(order: u32, rotor: &Rotor, field: &F) -> Self {
        let order = order as usize;
        MotionSeries {
            order,
            field: field.clone(),
            inverse_moments: rotor.inverse_moments(),
            gyroscopic: Gyroscopic::new(rotor, Dd::ONE),
            shares: (1..=order).map(|n| S::from_dd(Dd::ONE / Dd::of(n as f64))).collect(),
            momentum: Vec::with_capacity(order + 1),
            attitude: Vec::with_capacity(order + 1),
            fall: Vec::with_capacity(if field.linear_part().is_some() { order + 1 } else { 0 }),
            gradient: field.gradient().map(|(force, orbit)| GradientSeries::new(order, rotor, force, orbit)),
            others: field.has_series().then(|| Tape::new(order)),
        }
    }

    /// The rate, 1/s, at which the motion through `x` changes: of its spin, of a fall, and of what the torque `others` makes
    /// of a body at rest.
    pub(super) fn rate(&self, x: &Point<S>, others: Vec3<S>) -> f64 {
        let inverse = self.inverse_moments;
        let mut acceleration = others.times(inverse).magnitude();
        if let Some(linear) = self.field.linear_part() {
            let (c, inverse) = (linear.moment.map(S::magnitude), inverse.map(S::magnitude));
            for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
                acceleration = acceleration.max(c[j].max(c[k]) * inverse[i]);
            }
        }
        x.momentum_body.times(inverse).magnitude().max(acceleration.sqrt())
    }

    /// The rate, 1/s, at which the torque `others` changes the spin through `x`, relative to it.
    pub(super) fn damping(&self, x: &Point<S>, others: Vec3<S>) -> f64 {
        others.magnitude() / x.momentum_body.magnitude()
    }

    /// Takes what acts beside the linear part about `x`.
    pub(super) fn record(&mut self, at: Time, x: &Point<S>) {
        let (field, omega) = (&self.field, x.momentum_body.times(self.inverse_moments));
        if let Some(gradient) = &mut self.gradient {
            gradient.begin(at, x.attitude, omega);
        }
        let Some(tape) = &mut self.others else { return };
        tape.record(&arguments(x.attitude.components(), omega), |given| {
            let &[w, x, y, z, a, b, c] = given else { return [Series::of(f64::NAN); 3] };
            let torque = field.remainder_series(at, Quat::new(w, Vec3([x, y, z])), Vec3([a, b, c]));
            torque.map_or([Series::of(f64::NAN); 3], |torque| torque.0)
        });
    }

    /// The coefficient n of the torque of all but the linear part.
    pub(super) fn torque(&mut self, at: Time, n: usize) -> Vec3<S> {
        let mut torque = Vec3::zero();
        if let Some(gradient) = &mut self.gradient {
            torque = gradient.torque(n);
            if !torque.magnitude().is_finite() && self.momentum.last().is_none_or(Turned::is_finite) {
                self.field.not_finite(at, gradient.force());
            }
        }
        let Some(tape) = &self.others else { return torque };
        let others = Vec3([0, 1, 2].map(|axis| tape.result(axis, n)));
        if !others.magnitude().is_finite()
            && let Some(part) = tape.culprit(n)
        {
            self.field.not_finite(at, part);
        }
        torque + others
    }

    /// Works out the series about `x`, which count `unit` seconds; what acts beside the linear part has been recorded there.
    pub(super) fn expand(&mut self, at: Time, unit: f64, x: &Point<S>) {
        let (m, q, inverse) = (x.momentum_body, x.attitude, self.inverse_moments);
        let linear = self.field.linear_part().copied();
        self.momentum.clear();
        self.attitude.clear();
        self.fall.clear();
        self.momentum.push(Turned::new(m));
        self.attitude.push(Spun::new(q.components(), inverse));
        if linear.is_some() {
            self.fall.push([Turned::new(m.times(inverse)), Turned::new(vertical(q))]);
        }
        if let Some(tape) = &mut self.others {
            tape.count_in(unit);
        }
        for n in 0..self.order {
            let (mut rate, spin) = self.gyroscopic_term_and_spin();
            if let Some(linear) = &linear {
                let up = Vec3(self.fall[n][1].components());
                rate = rate + up.cross(linear.moment);
            }
            if F::HAS_REMAINDER {
                rate = rate + self.torque(at, n);
            }
            let share = self.shares[n] * S::of(unit);
            let q = spin.map(|c| c * share);
            let up = linear.map(|_| self.fall_term() * share);
            let m = rate * share;
            self.momentum.push(Turned::new(m));
            self.attitude.push(Spun::new(q, inverse));
            if let Some(up) = up {
                self.fall.push([Turned::new(m.times(inverse)), Turned::new(up)]);
            }
            if let Some(gradient) = &mut self.gradient
                && n + 1 < self.order
            {
                gradient.push(share, m.times(inverse));
            }
            if let Some(tape) = &mut self.others {
                tape.push(&arguments(q, m.times(inverse)));
            }
        }
    }

    /// `Σ m_k × I⁻¹m_{n−k}` and `½ Σ q_k ∘ I⁻¹m_{n−k}` of the coefficients so far.
    #[inline]
    fn gyroscopic_term_and_spin(&self) -> (Vec3<S>, [S; 4]) {
        let (mut products, mut spin) = ([S::of(0.0); 4], [S::of(0.0); 4]);
        let pairs = self.momentum.iter().zip(&self.attitude).zip(self.momentum.iter().rev());
        for ((a, q), b) in pairs {
            let [x, y, z] = b.components();
            products = from_fn(|lane| products[lane] + a.next[lane] * b.after[lane]);
            spin = from_fn(|lane| spin[lane] + (q.by[0][lane] * x + q.by[1][lane] * y + q.by[2][lane] * z));
        }
        let [x, y, z, _] = products;
        (self.gyroscopic.times(Vec3([x, y, z])), spin)
    }

    /// `Σ Γ_k × I⁻¹m_{n−k}` of the coefficients so far.
    #[inline]
    fn fall_term(&self) -> Vec3<S> {
        let mut sum = [S::of(0.0); 4];
        for ([_, up], [omega, _]) in self.fall.iter().zip(self.fall.iter().rev()) {
            sum = up.add_cross(omega, sum);
        }
        let [x, y, z, _] = sum;
        Vec3([x, y, z])
    }

    /// The changes of attitude and momentum when `s` units have gone by, summed from the highest order down.
    #[inline]
    pub(super) fn change(&self, s: S) -> Phase<S> {
        let (mut m, mut q) = ([S::of(0.0); 3], [S::of(0.0); 4]);
        for (momentum, attitude) in self.momentum.iter().zip(&self.attitude).skip(1).rev() {
            let (momentum, attitude) = (momentum.components(), attitude.components);
            m = from_fn(|axis| (m[axis] + momentum[axis]) * s);
            q = from_fn(|k| (q[k] + attitude[k]) * s);
        }
        Phase { attitude: Quat::from_components(q), momentum_body: Vec3(m) }
    }

    /// For how many units the terms of the two highest orders stay below `tolerance`, those of the attitude as they are, those of
    /// the momentum relative to |m|, from rest to its first change. Rounded down to eleven bits, so that rounding, which
    /// depends on the axes of space, does not change it.
    pub(super) fn reach(&self, tolerance: f64) -> f64 {
        let momentum = |n: usize| length(self.momentum[n].components());
        let moving = (0..self.order).find(|&n| momentum(n) != 0.0).unwrap_or(0);
        let allowed = tolerance * momentum(moving);
        let is_next_to_rest = momentum(moving) != 0.0 && allowed < f64::MIN_POSITIVE;
        let allowed = if is_next_to_rest { f64::MIN_POSITIVE } else { allowed };
        // there the terms of high orders are no normal doubles, and say nothing
        let mut reach = if is_next_to_rest { 0.0 } else { f64::INFINITY };
        for n in [self.order - 1, self.order] {
            let of_attitude = (tolerance / length(self.attitude[n].components), n);
            let last = momentum(n);
            let bounds = moving < n && last != 0.0;
            let terms = [of_attitude, if bounds { (allowed / last, n - moving) } else { of_attitude }];
            if moving == 0 {
                // one root of the smaller of the two
                reach = least(reach, log2(least(terms[0].0, terms[1].0)) / n as f64);
            } else {
                reach =
                    terms.into_iter().fold(reach, |reach, (ratio, n)| least(reach, log2(ratio) / n as f64));
            }
        }
        let reach = exp2(reach);
        if !(reach.is_finite() && reach > 0.0) {
            return reach;
        }
        let bits = 10 - libm::ilogb(reach);
        libm::scalbn(libm::floor(libm::scalbn(reach, bits)), -bits)
    }
}

/// The logarithm to base 2 within 2e-9; that of a quotient by 0 is infinite.
fn log2(x: f64) -> f64 {
    if !x.is_normal() || x < 0.0 {
        return libm::log2(x);
    }
    // x = 2^e m, √½ ≤ m < √2, by ln m = 2 artanh((m − 1)/(m + 1))
    let above = x.to_bits() + (0x3ff0_0000_0000_0000 - core::f64::consts::FRAC_1_SQRT_2.to_bits());
    let e = (above >> 52).cast_signed() - 1023;
    let m = f64::from_bits(x.to_bits().wrapping_sub((e << 52).cast_unsigned()));
    let t = (m - 1.0) / (m + 1.0);
    let s = t * t;
    let series = 1.0 + s * (1.0 / 3.0 + s * (1.0 / 5.0 + s * (1.0 / 7.0 + s * (1.0 / 9.0))));
    e as f64 + 2.0 * core::f64::consts::LOG2_E * t * series
}

/// 2^x within 1e-8 of itself.
fn exp2(x: f64) -> f64 {
    if x.is_nan() || x.abs() >= 1022.0 {
        return libm::exp2(x);
    }
    let whole = libm::rint(x);
    let r = (x - whole) * core::f64::consts::LN_2;
    let power = [5040.0, 720.0, 120.0, 24.0, 6.0, 2.0, 1.0].into_iter().fold(0.0, |sum, f| sum * r + 1.0 / f);
    let power = power * r + 1.0;
    power * f64::from_bits((((whole as i64) + 1023) << 52).cast_unsigned())
}

/// The smaller of the two; NaN if one is NaN.
fn least(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.min(b) }
}

/// What a torque is a function of.
fn arguments<S>([w, x, y, z]: [S; 4], Vec3([a, b, c]): Vec3<S>) -> [S; 7] {
    [w, x, y, z, a, b, c]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_and_their_logarithms_have_eight_digits() {
        for k in -4000..4000 {
            let x = f64::from(k) * 0.2531;
            let power = libm::exp2(x);
            assert!((exp2(x) / power - 1.0).abs() < 1e-8, "{x}");
            assert!((log2(power) - x).abs() < 2e-9 + 1e-15 * x.abs(), "{x}");
        }
        let special = [f64::INFINITY, 0.0, f64::MIN_POSITIVE / 8.0].map(log2);
        assert_eq!(special, [f64::INFINITY, f64::NEG_INFINITY, -1025.0]);
        assert!(log2(f64::NAN).is_nan() && exp2(f64::NAN).is_nan());
        assert_eq!([f64::INFINITY, f64::NEG_INFINITY, -3.0].map(exp2), [f64::INFINITY, 0.0, 0.125]);
        // at both ends of the range of m
        let around = core::f64::consts::FRAC_1_SQRT_2;
        assert!([around, around.next_down()].iter().all(|x| (log2(*x) + 0.5).abs() < 2e-9));
    }
}
