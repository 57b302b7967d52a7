//! The gravity gradient on a circle at the steps of a run.

use super::lanes::Lane;
use super::monitor::BLOCK;
use crate::body::{CircularGradient, Clock};
use crate::num::{Dd, Real};

/// The gradient, with what takes its direction from step to step.
///
/// At a step that is a multiple of [`BLOCK`] the direction is worked out by the time, and turned on from there to the steps between.
/// So it has the same bits whatever steps are looked at together.
#[derive(Clone, Debug)]
pub(super) struct Circle {
    gradient: CircularGradient,
    clock: Clock,
    /// The rate n of Jacobi's constant, rad/s.
    pub(super) rate: f64,
    /// The coefficients of 2U, leading and trailing parts.
    pub(super) weights: [[f64; 2]; 6],
    /// Cosines and sines of the angles of 0, 1, … steps.
    turns: [[Dd; 2]; BLOCK],
    /// The multiple that was looked at last, and the direction there.
    last: (u64, [Dd; 2]),
}

/// Cosine and sine of an angle for each point of a block, leading and trailing parts.
pub(super) type Angles = [[Lane; 2]; 2];

impl Circle {
    /// `None` of a gradient so weak or strong that its products are near the smallest or the largest numbers.
    pub(super) fn new(gradient: CircularGradient, rate: f64, clock: Clock) -> Option<Self> {
        let largest = gradient.weights.iter().fold(0.0_f64, |largest, w| largest.max(w.magnitude()));
        if !(1e-100..1e100).contains(&largest) {
            return None;
        }
        let [start, end] = [0, 1].map(|n| gradient.direction(clock.at(n)));
        let step = turned(end, [start[0], -start[1]]);
        let mut turns = [[Dd::ONE, Dd::ZERO]; BLOCK];
        for n in 1..BLOCK {
            turns[n] = turned(turns[n - 1], step);
        }
        // off the diagonal each entry comes twice
        let mut weights = gradient.weights.map(|w| w * 2.0);
        weights[3..].iter_mut().for_each(|w| *w = *w * 2.0);
        let weights = weights.map(|w| [w.hi(), w.lo()]);
        Some(Circle { gradient, clock, rate, weights, turns, last: (0, start) })
    }

    /// Of each of `steps`, at most [`BLOCK`], the direction at the multiple before it, and the turn from there.
    pub(super) fn directions(&mut self, steps: impl Iterator<Item = u64>) -> [Angles; 2] {
        let mut angles = [[[[0.0; BLOCK]; 2]; 2]; 2];
        for (n, step) in steps.enumerate() {
            let rest = step % BLOCK as u64;
            if step - rest != self.last.0 {
                self.last = (step - rest, self.gradient.direction(self.clock.at(step - rest)));
            }
            for (lanes, angle) in angles.iter_mut().zip([self.last.1, self.turns[rest as usize]]) {
                for (lanes, component) in lanes.iter_mut().zip(angle) {
                    (lanes[0][n], lanes[1][n]) = (component.hi(), component.lo());
                }
            }
        }
        angles
    }
}

/// Cosine and sine of the sum of two angles.
fn turned([a, b]: [Dd; 2], [c, d]: [Dd; 2]) -> [Dd; 2] {
    [a * c - b * d, a * d + b * c]
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix3;

    use super::*;
    use crate::body::{Body, Force, Orbit, Point};
    use crate::inertia::Inertia;
    use crate::observe::Monitor;
    use crate::rotation::{Quat, Vec3};

    /// Against double-double, point by point, at steps in any order and in blocks of any length, with the gravitational parameter and without.
    #[test]
    fn the_errors_are_those_of_double_double() {
        let tensor = Matrix3::new(1.0, 0.2, -0.1, 0.2, 2.3, 0.05, -0.1, 0.05, 2.9);
        let inertias = [Inertia::from_moments([1.0, 2.3, 2.9]), Inertia::from_tensor(tensor)];
        let orbits = [Orbit::ellipse(0.31, 0.0), Orbit::conic(0.7, 2.0, 0.0).unwrap().passing_at(0.3)];
        // multiples of the golden section modulo 1
        let mut n = 0.0;
        let mut number = || {
            n += 1.0;
            2.0 * (n * 0.618_033_988_749_894_8_f64).fract() - 1.0
        };
        for (inertia, orbit) in inertias.iter().zip(orbits) {
            let gradient = Force::gravity_gradient_on(orbit.unwrap());
            let body = Body::free(inertia.clone().unwrap()).with(gradient);
            let clock = Clock { start: 0.7, step: 0.1 };
            let mut steps = 0;
            let mut point = || {
                let q = Quat::from_components([number(), number(), number(), number()]).normalized();
                let mut x = Point::new(q, Vec3([number(), number(), number()]));
                (0..steps).for_each(|_| x.count_steps(1));
                steps += 7;
                x
            };
            let start = point();
            let points: Vec<_> = (0..100).map(|_| point()).collect();
            let fresh = Monitor::new(&body, clock, &start);
            let (mut together, mut worst) = (fresh.clone(), 0.0_f64);
            for x in &points {
                let (mut alone, exact) = (fresh.clone(), fresh.errors(x).jacobi.unwrap());
                assert_eq!(alone.observe(&[*x]), 1);
                let error = alone.worst().jacobi.unwrap() - exact;
                assert!(error.abs() <= f64::EPSILON * exact, "{error:e} of {exact:e}");
                worst = worst.max(alone.worst().jacobi.unwrap());
            }
            assert_eq!(together.observe(&points), 100);
            assert_eq!(together.worst().jacobi, Some(worst));
            // of the start itself nothing is left but what double-double rounds
            let mut alone = Circle::new(body.circular_gradient().unwrap(), 0.31, clock).unwrap();
            let reference = &fresh.reference;
            let [left] = reference.circular(&mut alone, &[start]);
            assert!(left[0] < 1e-28, "{:e}", left[0]);
        }
    }
}
