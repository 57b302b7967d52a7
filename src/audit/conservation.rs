//! What the motion keeps, and how well the record does.

use super::resolution::{noise, triples};
use super::states::{Quantities, Row, states};
use super::{Conservation, Reading, Traces, Trajectory};
use crate::body::{Body, Conserved, Problem};
use crate::observe::secular_drift;
use crate::rotation::Vec3;

/// Most groups of three rows that drifts and noise are read off.
const GROUPS: usize = 1365;

/// Most rows of a figure.
const DRAWN: usize = 2000;

/// How many times the noise the largest of many rows may be off.
const SPREAD: f64 = 6.0;

/// What is kept, by `reading`, and its errors at rows for figures. `rounding`: of the numbers, relative; `every`: all rows, where
/// the largest error is to be that of all.
pub(super) fn conservation(
    record: &Trajectory,
    reading: &Reading,
    body: &Body,
    tolerance: f64,
    rounding: f64,
    every: &[Row],
) -> (Vec<Conservation>, Traces) {
    let free = body.problem() == Problem::Free;
    let count = record.times.len();
    let some = triples(count, GROUPS);
    let looked = states(record, reading, body, &some);
    let Some(first) = looked.first().copied() else { return (Vec::new(), Traces::default()) };
    let quantities = Quantities::new(body);
    let has_attitude = first.attitude.is_some();
    let space = |row: &Row| row.attitude.map_or(Vec3::zero(), |q| q.rotate(quantities.momentum(row)));
    let start_momentum = quantities.momentum(&first);
    let (l, norm) = (space(&first), start_momentum.norm());
    let energy = quantities.energy(&first);
    let kinetic = quantities.kinetic(&first);
    let energy_scale = kinetic.abs() + (energy - kinetic).abs();
    if !(norm > 0.0 && energy_scale > 0.0) {
        return (Vec::new(), Traces::default());
    }
    let energy_of = |row: &Row| (quantities.energy(row) - energy) / energy_scale;
    let norm_of = |row: &Row| (quantities.momentum(row).norm() - norm) / norm;
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
    let mut found = Vec::new();
    let mut look = |quantity: Conserved, of: &dyn Fn(&Row) -> f64| {
        if !kept.contains(&quantity) {
            return;
        }
        let needs_attitude = matches!(quantity, Conserved::Momentum | Conserved::MomentumZ) || !free;
        if needs_attitude && !has_attitude {
            return;
        }
        let series: Vec<f64> = looked.iter().map(of).collect();
        let resolution = (SPREAD * noise(&rows, &series)).max(12.0 * rounding);
        let mut error = series.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        if count > rows.len() {
            error = every.iter().fold(error, |most, row| most.max(of(row).abs()));
        }
        let drift = secular_drift(&times, &series);
        let conserved = error <= tolerance.max(resolution);
        found.push(Conservation { quantity, error, drift, resolution, conserved });
    };
    look(Conserved::Energy, &energy_of);
    look(Conserved::MomentumNorm, &norm_of);
    look(Conserved::Momentum, &vector_of);
    look(Conserved::MomentumZ, &z_of);
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
