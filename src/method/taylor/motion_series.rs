//! The Taylor series of a motion about one of its points.

use core::array::from_fn;

use crate::body::{Field, Gyroscopic, Phase, Point, Rotor, Time, vertical};
use crate::method::solve::length::length;
use crate::num::{Dd, Real, Series, Tape};
use crate::rotation::{Quat, Vec3};

/// Coefficients of attitude and momentum up to an order K, the time counted in a unit.
///
/// With `m = Σ m_n`, `q = Σ q_n` and the unit u: `(n + 1) m_{n+1} = u (Σ m_k × I⁻¹m_{n−k} + τ_n)` and
/// `2 (n + 1) q_{n+1} = u Σ q_k ∘ I⁻¹m_{n−k}`, k ≤ n. The first sum is taken as `D_i Σ (m_k)_j (m_{n−k})_l`,
/// `D_i = 1/I_l − 1/I_j`, as its products cancel along the axis of a rod. Of a linear potential τ_n is `Γ_n × c`, with
/// `(n + 1) Γ_{n+1} = u Σ Γ_k × I⁻¹m_{n−k}`; of all other forces it is the coefficient n of their laws, which are recorded once
/// for all n. The unit is a power of two, so that it costs no rounding.
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
    /// The torque of all but the linear part by attitude and ω; `None` where that is all that acts.
    others: Option<Tape<S>>,
}

/// A vector by its next components and those after them: `a × b` is `a.next · b.after − a.after · b.next`.
#[derive(Clone, Copy, Debug)]
struct Turned<S> {
    next: [S; 4],
    after: [S; 4],
}

impl<S: Real> Turned<S> {
    fn new(Vec3([x, y, z]): Vec3<S>) -> Self {
        let zero = S::of(0.0);
        Turned { next: [y, z, x, zero], after: [z, x, y, zero] }
    }

    #[inline]
    fn components(&self) -> [S; 3] {
        let [y, z, x, _] = self.next;
        [x, y, z]
    }
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
            others: F::HAS_REMAINDER.then(|| Tape::new(order)),
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

    /// Records the torque of all but the linear part about `x`.
    pub(super) fn record(&mut self, at: Time, x: &Point<S>) {
        let Some(tape) = &mut self.others else { return };
        let field = &self.field;
        tape.record(
            &arguments(x.attitude.components(), x.momentum_body.times(self.inverse_moments)),
            |given| {
                let &[w, x, y, z, a, b, c] = given else { return [Series::of(f64::NAN); 3] };
                let torque = field.remainder_series(at, Quat::new(w, Vec3([x, y, z])), Vec3([a, b, c]));
                torque.map_or([Series::of(f64::NAN); 3], |torque| torque.0)
            },
        );
    }

    /// The coefficient n of the torque of all but the linear part.
    pub(super) fn torque(&self, at: Time, n: usize) -> Vec3<S> {
        let Some(tape) = &self.others else { return Vec3::zero() };
        let torque = Vec3([0, 1, 2].map(|axis| tape.result(axis, n)));
        if !torque.magnitude().is_finite()
            && let Some(part) = tape.culprit(n)
        {
            self.field.not_finite(at, part);
        }
        torque
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
            let cross = |lane: usize| up.next[lane] * omega.after[lane] - up.after[lane] * omega.next[lane];
            sum = from_fn(|lane| sum[lane] + cross(lane));
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
        let mut reach = if is_next_to_rest { 1.0 } else { f64::INFINITY };
        for n in [self.order - 1, self.order] {
            let of_attitude = (tolerance / length(self.attitude[n].components), n);
            let last = momentum(n);
            let bounds = moving < n && last != 0.0;
            let terms = [of_attitude, if bounds { (allowed / last, n - moving) } else { of_attitude }];
            if moving == 0 {
                // one root of the smaller of the two
                reach = least(reach, root(least(terms[0].0, terms[1].0), n));
            } else {
                reach = terms.into_iter().fold(reach, |reach, (ratio, n)| least(reach, root(ratio, n)));
            }
        }
        if !(reach.is_finite() && reach > 0.0) {
            return reach;
        }
        let bits = 10 - libm::ilogb(reach);
        libm::scalbn(libm::floor(libm::scalbn(reach, bits)), -bits)
    }
}

/// `x^(1/n)`; infinite for the quotient of a number and 0.
fn root(x: f64, n: usize) -> f64 {
    libm::exp(libm::log(x) / n as f64)
}

/// The smaller of the two; NaN if one is NaN.
fn least(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.min(b) }
}

/// What a torque is a function of.
fn arguments<S>([w, x, y, z]: [S; 4], Vec3([a, b, c]): Vec3<S>) -> [S; 7] {
    [w, x, y, z, a, b, c]
}
