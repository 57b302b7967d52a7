//! Which integrator leaves the errors of a record: those of the catalogue are run from its start.

use super::Signature;
use super::columns::rotation_vector;
use super::motion::motion;
use super::states::{Quantities, Row, states};
use super::{Reading, Trajectory};
use crate::body::{Body, Clock, Conserved};
use crate::method::{AnyMethod, Claimed, method, without_projections};
use crate::rotation::{Quat, Vec3};
use crate::run::{Run, Watch};

/// Methods outside the catalogue that programs in use are built on.
const OTHERS: [&str; 3] = ["no-squish", "gauss:6", "linearly-implicit-euler"];

/// Steps between rows that are tried first, and those after them.
const STEPS: [&[u64]; 2] = [&[1, 2, 5, 10], &[3, 4, 8, 20, 50, 100]];

/// Rows that are compared.
const LOOKS: usize = 12;

/// Most rows that a hypothesis is run over.
const MOST_ROWS: usize = 240;

/// A hypothesis is named if the record is nearer to it than this part of its distance from the exact motion.
const NAMED: f64 = 0.2;

/// An error below this, rad or relative, tells of no integrator in double precision.
const RESOLVED: f64 = 1e-12;

/// The method and the step whose errors are those of `record`; `None` if none comes near, or if the errors do not stand out of
/// `noise`, rad and relative.
pub(super) fn signature(
    record: &Trajectory,
    reading: &Reading,
    body: &Body,
    noise: f64,
) -> Option<Signature> {
    let interval = record.times[1] - record.times[0];
    let rows: Vec<usize> = (0..record.times.len().min(MOST_ROWS + 1))
        .take_while(|&row| {
            let expected = record.times[0] + interval * row as f64;
            row == 0 || (record.times[row] - expected).abs() <= 1e-3 * interval
        })
        .collect();
    let rows = states(record, reading, body, &rows);
    let first = *rows.first()?;
    let size = first.omega.norm();
    if rows.len() < 4 || size.partial_cmp(&0.0) != Some(core::cmp::Ordering::Greater) {
        return None;
    }
    let apart = |row: &Row, q: Quat<f64>, omega: Vec3<f64>| {
        let turn = row.attitude.map_or(0.0, |measured| rotation_vector(q.conjugate() * measured).norm());
        let rates = (row.omega - omega).norm() / size;
        (turn, (turn * turn + rates * rates).sqrt())
    };
    let exact = motion(body, &first, rows.iter().map(|row| row.time), true)?;
    let errors: Vec<(f64, f64)> =
        rows.iter().zip(&exact).map(|(row, (q, omega))| apart(row, *q, *omega)).collect();
    // until the errors are as large as the motion
    let count = errors.iter().take_while(|error| error.1 < 0.5).count();
    let measured = errors[..count].iter().fold(0.0_f64, |most, error| most.max(error.1));
    if count < 4 || measured < RESOLVED.max(8.0 * noise) {
        return None;
    }
    let looks: Vec<usize> =
        (1..=LOOKS.min(count - 1)).map(|k| k * (count - 1) / LOOKS.min(count - 1)).collect();
    let quantities = Quantities::new(body);
    let scale = quantities.kinetic(&first).abs().max(f64::MIN_POSITIVE);
    let energy = |row: &Row| (quantities.energy(row) - quantities.energy(&first)) / scale;
    let keeps_energy = body.conserved().contains(&Conserved::Energy);
    let mut best: Option<Signature> = None;
    let named = OTHERS.iter().filter_map(|name| method(name).ok());
    let methods: Vec<Box<dyn AnyMethod>> = without_projections().into_iter().chain(named).collect();
    for steps in STEPS {
        for method in &methods {
            for &n in steps {
                let Some(found) = hypothesis(body, method, &first, interval, n, &looks) else { continue };
                let squares = |k: usize, row: usize| {
                    let (_, by) = apart(&rows[row], found[k].0, found[k].1);
                    (by * by, errors[row].1 * errors[row].1)
                };
                let sums = looks.iter().enumerate().map(|(k, &row)| squares(k, row));
                let (off, whole) = sums.fold((0.0, 0.0), |sum, next| (sum.0 + next.0, sum.1 + next.1));
                let mismatch = (off / whole).sqrt();
                // the first that is as near as rounding allows stays
                let better =
                    best.as_ref().is_none_or(|best| mismatch < 0.9 * best.mismatch && best.mismatch > 1e-7);
                if !(mismatch < NAMED && better) {
                    continue;
                }
                let (last, (q, omega)) = (looks[looks.len() - 1], found[looks.len() - 1]);
                let (row, truth) = (&rows[last], &exact[last]);
                let predicted = Row { attitude: row.attitude.map(|_| q), omega, ..*row };
                best = Some(Signature {
                    method: method.name(),
                    step: interval / n as f64,
                    steps_per_row: n,
                    order: method.claims(body.problem()).and_then(|claims| claims.order),
                    predicted_attitude_error: rotation_vector(truth.0.conjugate() * q).norm(),
                    measured_attitude_error: errors[last].0,
                    predicted_energy_change: keeps_energy.then(|| energy(&predicted)),
                    measured_energy_change: keeps_energy.then(|| energy(row)),
                    at: row.time,
                    mismatch,
                });
            }
        }
        if best.is_some() {
            break;
        }
    }
    best
}

/// Attitude and ω of `method` with `n` steps between rows, at the rows `looks`.
fn hypothesis(
    body: &Body,
    method: &dyn AnyMethod,
    first: &Row,
    interval: f64,
    n: u64,
    looks: &[usize],
) -> Option<Vec<(Quat<f64>, Vec3<f64>)>> {
    let start = body.enter_omega(first.attitude.unwrap_or(Quat::identity()), first.omega).ok()?.to_f64();
    let clock = Clock { start: first.time, step: interval / n as f64 };
    let mut run = Run::from_point(method, body, start, clock).ok()?.watching(Watch::Never);
    let mut found = Vec::with_capacity(looks.len());
    for &row in looks {
        let sample = run.advance_to(row as u64 * n).ok()?;
        found.push((sample.state.attitude, Vec3::from(sample.omega_body)));
    }
    // attitudes that drift off the sphere are compared as rotations
    Some(found.into_iter().map(|(q, omega)| (q.normalized(), omega)).collect())
}

/// Counts changes of sign of the momentum along the axis of the middle moment; those within a threshold of ω do not count.
pub(super) struct Flips {
    axis: Vec3<f64>,
    threshold: f64,
    positive: Option<bool>,
    pub(super) count: u64,
}

impl Flips {
    /// Of `body`; `threshold` in rad/s.
    pub(super) fn new(body: &Body, threshold: f64) -> Self {
        let axis = Vec3::unit(body.rotor().middle_axis());
        let axis = body.inertia().frame().map(|x| x.hi()).rotate(axis);
        Flips { axis, threshold, positive: None, count: 0 }
    }

    pub(super) fn see(&mut self, omega: Vec3<f64>) {
        let along = omega.dot(self.axis);
        if along.abs() <= self.threshold {
            return;
        }
        self.count += u64::from(self.positive.is_some_and(|before| before != (along > 0.0)));
        self.positive = Some(along > 0.0);
    }
}
