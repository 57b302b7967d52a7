//! A torque against the gradient of its potential.

use super::{Limits, time};
use crate::body::{Body, Point, Time};
use crate::laws::finding::Finding;
use crate::laws::subject::largest;
use crate::laws::words::{Law, Quantity};
use crate::num::{Dd, Precise, Real};
use crate::rotation::{Quat, Vec3};

/// τ·e = −dU/dε of a turn by ε about e, relative to the largest torque.
pub(super) fn measure(body: &Body, points: &[Point<Dd>], limits: &Limits) -> Finding {
    let torque = |n: usize, x: &Point<Dd>| body.torque_of(time(n), x);
    let size = largest(points.iter().enumerate().map(|(n, x)| torque(n, x).magnitude()));
    let off = |n: usize, x: &Point<Dd>| {
        let found = minus_gradient(body, time(n), x, limits.turn);
        (found - torque(n, x)).magnitude() / size
    };
    let worst = largest(points.iter().enumerate().map(|(n, x)| off(n, x)));
    let finding = Finding::new(body.problem(), Law::Gradient, Quantity::Torque, "-dU/dθ");
    finding.judged(true, worst, limits.gradient, limits.gradient)
}

/// −∂U/∂θ of a turn θ about the principal axes, in the solver frame, by central differences of order 6 of turns by `d` rad.
fn minus_gradient(body: &Body, at: Time, x: &Point<Dd>, d: f64) -> Vec3<Dd> {
    Vec3(core::array::from_fn(|axis| {
        let energy = |k: f64| {
            let turn = Quat::cayley(Vec3::unit(axis) * (Dd::of(0.5 * k * d)));
            // tan of half the angle: the angle of `turn` is 2 atan(kd/2)
            let angle = Dd::of(0.5 * k * d).atan2(Dd::ONE) * 2.0;
            (angle, body.energy_of(at, &Point::new(x.attitude * turn, x.momentum_body)))
        };
        let slope = |k: f64| {
            let ((a, above), (b, below)) = (energy(k), energy(-k));
            (above - below) / (a - b)
        };
        // by the angle, whose error is of even order: Richardson's extrapolation
        let twice = |k: f64| (slope(k) * 4.0 - slope(2.0 * k)) / Dd::of(3.0);
        let fourth = (twice(1.0) * 16.0 - twice(2.0)) / Dd::of(15.0);
        -fourth / Dd::from(body.scale())
    }))
}
