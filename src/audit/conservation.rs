//! What the motion keeps, and how well the record does.

use super::columns::{Columns, Source};
use super::resolution::{noise, triples};
use super::states::{Quantities, Row, States, states};
use super::{Conservation, Reading, Traces, Trajectory};
use crate::body::{Body, Conserved, Problem};
use crate::observe::secular_drift;
use crate::rotation::Vec3;

/// A quantity, and its value in a row.
type Followed<'a> = (Conserved, &'a dyn Fn(&Row) -> f64);

/// Most groups of three rows that drifts and noise are read off.
const GROUPS: usize = 1365;

/// Most rows of a figure.
const DRAWN: usize = 2000;

/// How many times the noise the largest of many rows may be off.
const SPREAD: f64 = 6.0;

/// What is kept, by `reading`, and its errors at rows for figures; the largest errors are those of all rows where the record has
/// an angular velocity or momentum. Attitude and angular velocity of a row may be off by so much.
pub(super) fn conservation(
    record: &Trajectory,
    reading: &Reading,
    body: &Body,
    [attitude_off, omega_off]: [f64; 2],
) -> (Vec<Conservation>, Traces) {
    let free = body.problem() == Problem::Free;
    let count = record.times.len();
    let some = triples(count, GROUPS);
    let looked = states(record, reading, body, &some);
    let Some(first) = looked.first().copied() else { return (Vec::new(), Traces::default()) };
    let quantities = Quantities::new(body);
    let has_attitude = first.attitude.is_some();
    let space = |row: &Row| row.attitude.map_or(Vec3::zero(), |q| q.rotate(quantities.whole_momentum(row)));
    let start_momentum = quantities.whole_momentum(&first);
    let (l, norm) = (space(&first), start_momentum.norm());
    let energy = quantities.energy(&first);
    let kinetic = quantities.kinetic(&first);
    let energy_scale = kinetic.abs() + (energy - kinetic).abs();
    if !(norm > 0.0 && energy_scale > 0.0) {
        return (Vec::new(), Traces::default());
    }
    let energy_of = |row: &Row| (quantities.energy(row) - energy) / energy_scale;
    let norm_of = |row: &Row| (quantities.whole_momentum(row).norm() - norm) / norm;
    let vector_of = |row: &Row| (space(row) - l).norm() / norm;
    let z_of = |row: &Row| (space(row)[2] - l[2]) / norm;
    // the direction across which L leaves first tells the sign of its angle
    let side = looked
        .iter()
        .map(|row| (space(row) - l) * (1.0 / norm))
        .fold(Vec3::zero(), |most: Vec3<f64>, off| if off.norm() > most.norm() { off } else { most });
    let direction_of = |row: &Row| {
        let now = space(row);
        let angle = libm::atan2(now.cross(l).norm(), now.dot(l));
        if (now - l).dot(side) < 0.0 { -angle } else { angle }
    };
    let rows: Vec<usize> = looked.iter().map(|row| row.row).collect();
    let times: Vec<f64> = looked.iter().map(|row| row.time).collect();
    let kept = body.conserved();
    // what a row within its allowance may change at most, to first order: dE = m dω, dm = I dω, dL = dm + turn L, and what a
    // torque of the size of the potential does by a turn
    let size = (looked.iter().map(|row| row.omega.norm_squared()).sum::<f64>() / looked.len() as f64).sqrt();
    let most_momentum = looked.iter().map(|row| quantities.momentum(row).norm()).fold(norm, f64::max);
    let largest_moment = quantities.largest_moment();
    let by_omega = largest_moment * size * omega_off / norm;
    let potential = looked.iter().map(|row| (quantities.energy(row) - quantities.kinetic(row)).abs());
    let by_turn = 3.0 * potential.fold(0.0, f64::max) * attitude_off / energy_scale;
    let allowed_of = |quantity: Conserved| {
        let of_row = match quantity {
            Conserved::Energy => most_momentum * size * omega_off / energy_scale + by_turn,
            Conserved::MomentumNorm => by_omega,
            _ => by_omega + attitude_off * most_momentum / norm,
        };
        // the first row may be off as well, and what is large has terms of second order
        2.0 * of_row * (1.0 + omega_off + attitude_off)
    };
    let every = States::new(record, reading, body);
    let has_omega = Columns::new(record).source != Source::Attitude;
    let needs = |quantity: Conserved| matches!(quantity, Conserved::Momentum | Conserved::MomentumZ) || !free;
    let all: [Followed; 4] = [
        (Conserved::Energy, &energy_of),
        (Conserved::MomentumNorm, &norm_of),
        (Conserved::Momentum, &vector_of),
        (Conserved::MomentumZ, &z_of),
    ];
    let told = |quantity: Conserved| kept.contains(&quantity) && (has_attitude || !needs(quantity));
    let seen: Vec<Followed> = all.into_iter().filter(|(quantity, _)| told(*quantity)).collect();
    // a maximum that is not a number stays one: `f64::max` would pass over it
    let larger = |most: f64, value: f64| if value.abs() <= most { most } else { value.abs() };
    let mut largest = [0.0_f64; 4];
    let mut look = |row: &Row| {
        for (most, (_, of)) in largest.iter_mut().zip(&seen) {
            *most = larger(*most, of(row));
        }
    };
    looked.iter().for_each(&mut look);
    if has_omega && count > rows.len() {
        // one row at a time: a record may be as large as the memory allows
        (0..count).filter_map(|row| every.at(row)).for_each(|row| look(&row));
    }
    let of_quantity = |((quantity, of), error): (&Followed, f64)| {
        let series: Vec<f64> = looked.iter().map(of).collect();
        let resolution = (SPREAD * noise(&rows, &series)).max(allowed_of(*quantity));
        // numbers near the limits of a double overflow: such a change is infinite, and shows nothing
        let unknown = |value: f64| if value.is_nan() { f64::INFINITY } else { value };
        let (error, resolution) = (unknown(error), unknown(resolution));
        let drift = secular_drift(&times, &series)
            .filter(|drift| drift.slope.is_finite() && drift.half_width.is_finite());
        let conserved = error.is_finite() && error <= resolution;
        Conservation { quantity: *quantity, error, drift, resolution, conserved }
    };
    let found = seen.iter().zip(largest).map(of_quantity).collect();
    let step = looked.len().div_ceil(DRAWN);
    let drawn: Vec<_> = looked.iter().step_by(step).collect();
    let traces = Traces {
        times: drawn.iter().map(|row| row.time).collect(),
        energy: drawn.iter().map(|row| energy_of(row)).collect(),
        momentum_norm: drawn.iter().map(|row| norm_of(row)).collect(),
        momentum_direction: drawn.iter().filter(|_| has_attitude).map(|row| direction_of(row)).collect(),
        attitude: Vec::new(),
    };
    (found, traces)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inertia::Inertia;

    /// Down to rates whose energy is below the smallest double, and those whose momentum is as well.
    #[test]
    fn no_motion_is_too_slow_for_errors_that_are_numbers() {
        let body = Body::free(Inertia::from_moments([1.0, 2.0, 2.5]).unwrap());
        let times: Vec<f64> = (0..20).map(f64::from).collect();
        let mut seen = [false; 2];
        for axis in 0..3 {
            let slower = |rate: &f64| Some(0.95 * rate);
            for rate in core::iter::successors(Some(1e-160), slower).take_while(|rate| *rate > 1e-163) {
                let mut omega = [0.0; 3];
                omega[axis] = rate;
                let record = Trajectory::new(times.clone()).with_rates(vec![omega; 20]);
                let (found, _) = conservation(&record, &Reading::default(), &body, [1e-6; 2]);
                assert!(found.iter().all(|kept| kept.error == 0.0 && kept.conserved), "{rate:e}: {found:?}");
                seen[usize::from(found.is_empty())] = true;
            }
        }
        assert_eq!(seen, [true; 2]);
    }
}
