//! What a force conserves, along an accurate motion.

use super::{Limits, time};
use crate::body::{Body, Clock, Conserved, Point, Time};
use crate::laws::LawsError;
use crate::laws::finding::Finding;
use crate::laws::subject::largest;
use crate::laws::words::{Law, Quantity};
use crate::method::{AnyMethod, Rk8, Taylor};
use crate::num::Dd;
use crate::observe::secular_drift;

/// Steps of the motion.
const STEPS: u64 = 64;

/// What the force says that the motion conserves, and what it does not say.
pub(super) fn measure(
    body: &Body,
    start: &Point<Dd>,
    has_series: bool,
    limits: &Limits,
) -> Result<Vec<Finding>, LawsError> {
    let method: &dyn AnyMethod = if has_series { &Taylor::of_order(40)? } else { &Rk8 };
    let omega = start.momentum_body.times(body.rotor().inverse_moments()).norm().hi();
    // some radians
    let clock = Clock::new(4.0 / (omega * STEPS as f64));
    let mut x = *start;
    let mut step = method.prepare_dd(clock, body)?;
    step.open(&mut x);
    let next = |n| {
        step.advance(&mut x, 1);
        (clock.at(n + 1), step.reading(&x))
    };
    let motion: Vec<(Time, Point<Dd>)> = (0..STEPS).map(next).collect();
    let times: Vec<f64> = (1..=STEPS).map(|n| n as f64 * clock.step).collect();

    let claimed = body.conserved();
    let jacobi = claimed.iter().find(|quantity| matches!(quantity, Conserved::Jacobi { .. }));
    let of_all = [Conserved::Energy, Conserved::MomentumZ];
    let finding = |quantity: &Conserved| {
        let (what, size) = match quantity {
            Conserved::MomentumZ => (Quantity::MomentumZ, start.momentum_body.norm()),
            Conserved::Jacobi { .. } => (Quantity::Jacobi, size_of_energy(body, start)),
            _ => (Quantity::Energy, size_of_energy(body, start)),
        };
        let reading = |at: Time, x: &Point<Dd>| match quantity {
            Conserved::MomentumZ => x.momentum_space()[2],
            Conserved::Jacobi { rate } => body.scaled_energy(at, x) - x.momentum_space()[2] * *rate,
            _ => body.scaled_energy(at, x),
        };
        let before = reading(clock.at(0), start);
        let errors: Vec<f64> =
            motion.iter().map(|(at, x)| ((reading(*at, x) - before) / size).hi()).collect();
        let is_claimed = claimed.contains(quantity);
        let worst = largest(errors.iter().map(|error| error.abs()));
        let claim = if is_claimed { "kept" } else { "no" };
        let finding = Finding::new(body.problem(), Law::Conserved, what, claim);
        let finding = finding.judged(is_claimed, worst, limits.kept, limits.lost);
        Finding { drift: secular_drift(&times, &errors), ..finding }
    };
    Ok(of_all.iter().chain(jacobi).map(finding).collect())
}

/// Kinetic energy and torque, of which energies of any zero are judged.
fn size_of_energy(body: &Body, x: &Point<Dd>) -> Dd {
    body.rotor().kinetic_energy(x.momentum_body) + body.torque_of(time(0), x).norm()
}
