//! Internal dissipation: a body that loses energy and keeps its angular momentum.

use super::Flow;
use crate::body::{Point, Rotor, Time};
use crate::num::{Dd, Precise};
use crate::rotation::{Quat, Vec3};

/// Gauss's nodes and weights on [0, 1], five points: order 10.
///
/// Source: M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions, table 25.4.
const NODES: [f64; 3] = [0.046_910_077_030_668_004, 0.230_765_344_947_158_45, 0.5];
const WEIGHTS: [f64; 3] = [0.118_463_442_528_094_54, 0.239_314_335_249_683_23, 0.284_444_444_444_444_44];

/// The part of the motion in which a body loses energy by inner friction: beside I⁻¹m it turns at the rate δ (m/|m|) × I⁻¹m, where δ
/// is the loss, a number much smaller than 1.
///
/// L in space stays, and the energy falls at the rate δ |m × I⁻¹m|²/|m|, to zero in a steady spin: about the axis of the largest
/// moment, which is stable. In this part alone m/|m| follows the gradient of the energy on the sphere, u_i ∝ u_i(0) exp(−δ |m| t/I_i), and
/// the attitude turns with it by the shortest way and by the area between the way and the great circle. The area is an integral by five points of
/// Gauss: its error is of the eleventh power of δ |m| t/I, below rounding where that is at most 0.01.
///
/// t in seconds, moments and m in the units of the [solver frame](crate::body::Rotor). [`Dissipating`](crate::method::Dissipating) alternates it with
/// the free motion.
///
/// ```
/// use polhode::body::{Point, Rotor, Time};
/// use polhode::flow::{Dissipation, Flow};
/// use polhode::rotation::{Quat, Vec3};
/// let rotor = Rotor::new([1.0, 2.0, 3.0])?;
/// let mut x = Point::new(Quat::identity(), Vec3([0.4, 2.0, -0.9]));
/// let before = x.momentum_space();
/// Dissipation::new(&rotor, 0.01).flow(Time::from_seconds(0.0), 1.0, &mut x);
/// assert!((x.momentum_space() - before).magnitude() < 1e-15);
/// assert!(x.momentum_body[2].abs() > 0.9); // nearer to the axis of the largest moment
/// # Ok::<(), polhode::Error>(())
/// ```
///
/// Source of the law: the gradient of the energy on the sphere of momenta as in R. Brockett, Linear Algebra Appl. 146 (1991) 79, and A.
/// M. Bloch, P. S. Krishnaprasad, J. E. Marsden and T. S. Ratiu, Commun. Math. Phys. 175 (1996) 1 (double bracket dissipation).
#[derive(Clone, Copy, Debug)]
#[must_use]
pub struct Dissipation<S> {
    /// δ (1/I_i − 1/I_max), none below zero.
    rates: Vec3<S>,
    nodes: [S; 5],
    weights: [S; 5],
}

/// 2^-300, the share of the component along the axis of the largest moment below which one that falls becomes zero: as a subnormal
/// number it would make each step several times as slow; its share of the energy is 1e-181. Next to the other axes a
/// component as small may grow, and stays.
const SPENT: f64 = 4.909_093_465_297_727e-91;

impl<S: Precise> Dissipation<S> {
    /// Of a body with the constants `rotor` and the loss δ; of a negative one it gains energy.
    pub fn new(rotor: &Rotor, loss: f64) -> Self {
        let inverse: Vec3<Dd> = rotor.inverse_moments();
        let least = inverse.0.into_iter().fold(inverse[0], |least, x| if x < least { x } else { least });
        let rates = inverse.map(|x| S::from_dd((x - least) * loss));
        let [a, b, c] = NODES.map(S::of);
        let [u, v, w] = WEIGHTS.map(S::of);
        let one = S::of(1.0);
        Dissipation { rates, nodes: [a, b, c, one - b, one - a], weights: [u, v, w, v, u] }
    }
}

impl<S: Precise> Flow<S> for Dissipation<S> {
    #[inline]
    fn flow(&self, _: Time, t: S, x: &mut Point<S>) {
        let m = x.momentum_body;
        let norm = m.norm();
        if norm.magnitude() == 0.0 {
            return;
        }
        let steady = (0..3)
            .filter(|&k| self.rates[k].magnitude() == 0.0)
            .map(|k| m[k].magnitude())
            .fold(0.0, f64::max);
        for k in 0..3 {
            let size = m[k].magnitude();
            if size != 0.0 && size < SPENT * steady && (self.rates[k] * t).to_dd() > Dd::ZERO {
                x.add_component(k, -m[k]);
            }
        }
        let m = x.momentum_body;
        let one = S::of(1.0);
        let start = m * (one / norm);
        let decay = self.rates * (norm * t);
        // of the vector that is not normalised: its change from the start, without cancellation
        let change = |share: S| Vec3([0, 1, 2].map(|k| start[k] * (-(decay[k] * share)).exp_m1()));
        let end = change(one);
        let length = (one + (end.dot(start) * S::of(2.0) + end.norm_squared())).sqrt();
        // the area between the way on the sphere and the great circle from its start to its end
        let mut area = S::of(0.0);
        for (node, weight) in self.nodes.into_iter().zip(self.weights) {
            let change = change(node);
            let there = start + change;
            let rate = there.times(decay);
            let size = there.norm();
            let flux = start.dot(change.cross(rate));
            area = area + weight * flux / (size * (size + there.dot(start)));
        }
        // from the end to the start by the shortest way, half the angle
        let cosine = (one + end.dot(start)) / length;
        let back = end.cross(start) * (one / (length * ((one + cosine) * S::of(2.0)).sqrt()));
        let half = (one - back.norm_squared()).sqrt();
        let (sin, cos) = (area * S::of(0.5)).sin_cos();
        let twist = (start + end) * (sin / length);
        let turn = Quat::new(half, back) * Quat::new(cos, twist);
        turn_by(x, turn.v);
    }
}

/// Turns the body by a quaternion with the vector part `v` and keeps L: m and q by the same numbers, so that what rounding does to L is
/// of random sign.
fn turn_by<S: Precise>(x: &mut Point<S>, v: Vec3<S>) {
    let one = S::of(1.0);
    let squared = v.norm_squared();
    let w = (one - squared).sqrt();
    let m = x.momentum_body;
    let once = v.cross(m);
    let two = S::of(2.0);
    x.add_momentum(v.cross(once) * two - once * (w * two));
    // 1 − w without cancellation
    let less = squared / (one + w);
    let q = x.attitude;
    let moved = q * Quat::new(-less, v);
    x.add_attitude(moved);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Real;

    fn point<S: Precise>() -> Point<S> {
        Point::new(Quat::of(Quat::from_components([0.5, 0.5, -0.5, 0.5])), Vec3::of(Vec3([0.7, 2.0, -0.9])))
    }

    /// Both equations of the part by classical Runge–Kutta steps, whose error is then given by their number.
    fn integrated(rotor: &Rotor, loss: f64, t: f64, steps: u32) -> Point<Dd> {
        let inverse: Vec3<Dd> = rotor.inverse_moments();
        let rate = |q: Quat<Dd>, m: Vec3<Dd>| {
            let omega = m.cross(m.times(inverse)) * (Dd::of(loss) / m.norm());
            (q.rate(omega), m.cross(omega))
        };
        let h = Dd::of(t) / Dd::of(f64::from(steps));
        let mut x = point::<Dd>();
        for _ in 0..steps {
            let (q, m) = (x.attitude, x.momentum_body);
            let a = rate(q, m);
            let b = rate(q + a.0 * (h * 0.5), m + a.1 * (h * 0.5));
            let c = rate(q + b.0 * (h * 0.5), m + b.1 * (h * 0.5));
            let d = rate(q + c.0 * h, m + c.1 * h);
            let sixth = h / Dd::of(6.0);
            x.attitude = q + (a.0 + (b.0 + c.0) * Dd::of(2.0) + d.0) * sixth;
            x.momentum_body = m + (a.1 + (b.1 + c.1) * Dd::of(2.0) + d.1) * sixth;
        }
        x
    }

    #[test]
    fn it_solves_its_equations() {
        let rotor = Rotor::new([1.0, 2.0, 3.0]).unwrap();
        for (loss, t) in [(0.01, 3.0), (-0.01, 3.0), (0.05, 1.0)] {
            let mut found = point::<Dd>();
            Dissipation::new(&rotor, loss).flow(Time::from_seconds(0.0), Dd::of(t), &mut found);
            let expected = integrated(&rotor, loss, t, 4000);
            let far = (found.attitude + expected.attitude * Dd::of(-1.0)).magnitude();
            assert!(far < 1e-17, "attitude {far:e}");
            let far = (found.momentum_body - expected.momentum_body).magnitude();
            assert!(far < 1e-16, "momentum {far:e}");
        }
    }

    #[test]
    fn it_is_a_flow_that_keeps_l_and_loses_energy() {
        let rotor = Rotor::new([1.0, 2.0, 3.0]).unwrap();
        let (flow, now) = (Dissipation::<f64>::new(&rotor, 1e-3), Time::from_seconds(0.0));
        let (mut once, mut twice) = (point::<f64>(), point::<f64>());
        let l = once.momentum_space();
        flow.flow(now, 3.0, &mut once);
        flow.flow(now, 1.0, &mut twice);
        flow.flow(now, 2.0, &mut twice);
        assert!((once.momentum_body - twice.momentum_body).magnitude() < 1e-15);
        assert!((once.attitude + twice.attitude * -1.0).magnitude() < 1e-15);
        assert!((once.momentum_space() - l).magnitude() < 1e-15);
        let energy = |x: &Point<f64>| x.momentum_body.dot(x.momentum_body.times(rotor.inverse_moments()));
        assert!(energy(&once) < energy(&point()));
        flow.flow(now, -3.0, &mut once);
        assert!((once.momentum_body - point::<f64>().momentum_body).magnitude() < 1e-15);
        // what has died out is zero, no subnormal number
        let mut late = point::<f64>();
        for _ in 0..2000 {
            flow.flow(now, 1e3, &mut late);
        }
        assert_eq!(late.momentum_body.0[..2], [0.0; 2]);
        assert!((late.momentum_space() - l).magnitude() < 1e-13);
        // what may still grow stays: next to another axis, and where energy is gained
        let tiny = 1e-100;
        let gains = Dissipation::<f64>::new(&rotor, -1e-3);
        for (flow, m, k) in [(&flow, [0.0, 2.0, tiny], 2), (&gains, [tiny, 0.0, 2.0], 0)] {
            let mut x = Point::new(Quat::identity(), Vec3(m));
            flow.flow(now, 5.0, &mut x);
            assert!(x.momentum_body[k] > 0.9 * tiny, "{:?}", x.momentum_body);
        }
        // at rest, and in a steady spin, nothing happens
        for m in [[0.0; 3], [0.0, 2.0, 0.0]] {
            let mut x = Point::new(Quat::identity(), Vec3(m));
            flow.flow(now, 5.0, &mut x);
            assert_eq!((x.momentum_body, x.attitude), (Vec3(m), Quat::identity()));
        }
    }
}
