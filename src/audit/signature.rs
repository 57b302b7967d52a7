//! Which integrator leaves the errors of a record: those of the catalogue and some others are run from its start.

use super::columns::angle_between;
use super::motion::motion;
use super::states::{Quantities, Row, states};
use super::{Reading, Signature, Trajectory};
use crate::body::{Body, Clock, Conserved, Problem};
use crate::inertia::Symmetry;
use crate::method::{
    AnyMethod, AxisOrder, AxisSplit, Claimed as _, Kicks, LiePoisson, method, without_projections,
};
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

/// A hypothesis is named if the record is nearer to it than this part of its distance from the exact motion: of some five
/// hundred that are tried, chance brings one as near as a tenth.
const NAMED: f64 = 0.02;

/// And nearer by this factor than to any other, and to the exact motion by a clock that is off.
const ALONE: f64 = 10.0;

/// The same where the angular velocities are explained all but [`CERTAIN`]: programs turn their attitudes by them in other ways.
const BY_RATES: [f64; 2] = [0.1, 3.0];

/// Hypotheses that are this part of their errors apart are the same.
const SAME: f64 = 1e-3;

/// No other is looked for where one explains all but this part.
const CERTAIN: f64 = 1e-4;

/// Relative change of the clock by which the errors of a wrong one are told.
const CLOCK: f64 = 1e-6;

/// An error below this, rad or relative, tells of no integrator in double precision.
const RESOLVED: f64 = 1e-12;

/// The method and the step whose errors are those of `record`; `None` if none comes near, if another or a clock that is off comes
/// nearly as near, if the errors do not stand out of `noise`, rad and relative, or of attitudes alone: the angular velocity
/// of the start that is read off them hides the errors of the first rows.
pub(super) fn signature(
    record: &Trajectory,
    reading: &Reading,
    body: &Body,
    noise: f64,
) -> Option<Signature> {
    if record.rates.is_none() && record.momentum.is_none() {
        return None;
    }
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
        let turn = row.attitude.map_or(0.0, |measured| angle_between(q, measured));
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
    let whole = looks.iter().map(|&row| errors[row].1 * errors[row].1).sum::<f64>().sqrt();
    let mismatch_of = |found: &[State]| {
        let off = looks.iter().zip(found).map(|(&row, there)| apart(&rows[row], there.0, there.1).1);
        off.map(|off| off * off).sum::<f64>().sqrt() / whole
    };
    let rates_off = |omega: &dyn Fn(usize, usize) -> Vec3<f64>| {
        let off = looks.iter().enumerate().map(|(k, &row)| (rows[row].omega - omega(k, row)).norm_squared());
        off.sum::<f64>().sqrt() / size
    };
    let rates_whole = rates_off(&|_, row| exact[row].1);
    let named = |method: Box<dyn AnyMethod>| (method.name(), method);
    let others = OTHERS.iter().filter_map(|name| method(name).ok());
    let mirrored =
        mirrored(body, &first).map(|(chosen, other)| (chosen, Box::new(other) as Box<dyn AnyMethod>));
    let catalogue = without_projections().into_iter().map(named);
    let methods: Vec<(String, Box<dyn AnyMethod>)> =
        catalogue.chain(mirrored).chain(others.map(named)).collect();
    let mut tried: Vec<Tried<'_>> = Vec::new();
    for steps in STEPS {
        for (name, method) in &methods {
            for &steps in steps {
                let Some(found) = hypothesis(body, method, &first, interval, steps, &looks) else { continue };
                let mismatch = mismatch_of(&found);
                if mismatch < BY_RATES[0] * BY_RATES[1] {
                    tried.push(Tried { name, method, steps, found, mismatch });
                }
            }
        }
        if tried.iter().any(|tried| tried.mismatch < CERTAIN) {
            break;
        }
    }
    let nearest = tried.iter().min_by(|a, b| a.mismatch.total_cmp(&b.mismatch))?;
    let is_same = |other: &Tried<'_>| other.distance(nearest, size) <= SAME * whole;
    // of those that do the same the first stays
    let best = tried.iter().find(|other| is_same(other))?;
    let by_rates = rates_whole > RESOLVED.max(8.0 * noise)
        && rates_off(&|k, _| nearest.found[k].1) < CERTAIN * rates_whole;
    let [most, alone] = if by_rates { BY_RATES } else { [NAMED, ALONE] };
    let limit = alone * nearest.mismatch;
    let pairs: Vec<(&Row, State)> = looks.iter().map(|&row| (&rows[row], exact[row])).collect();
    if nearest.mismatch > most
        || tried.iter().any(|other| other.mismatch <= limit && !is_same(other))
        || clock(body, &first, &pairs)? <= limit
    {
        return None;
    }
    let quantities = Quantities::new(body);
    let scale = quantities.kinetic(&first).abs().max(f64::MIN_POSITIVE);
    let energy = |row: &Row| (quantities.energy(row) - quantities.energy(&first)) / scale;
    let keeps_energy = body.conserved().contains(&Conserved::Energy);
    let (last, (q, omega)) = (looks[looks.len() - 1], best.found[looks.len() - 1]);
    let row = &rows[last];
    let predicted = Row { attitude: row.attitude.map(|_| q), omega, ..*row };
    Some(Signature {
        method: best.name.to_owned(),
        step: interval / best.steps as f64,
        steps_per_row: best.steps,
        order: best.method.claims(body.problem()).and_then(|claims| claims.order),
        predicted_attitude_error: angle_between(exact[last].0, q),
        measured_attitude_error: errors[last].0,
        predicted_energy_change: keeps_energy.then(|| energy(&predicted)),
        measured_energy_change: keeps_energy.then(|| energy(row)),
        at: row.time,
        mismatch: best.mismatch,
    })
}

/// Attitude, body → space, and ω, body axes.
type State = (Quat<f64>, Vec3<f64>);

/// A method that was run with some steps between rows, and its distance from the record over that of the exact motion.
struct Tried<'a> {
    name: &'a str,
    method: &'a dyn AnyMethod,
    steps: u64,
    found: Vec<State>,
    mismatch: f64,
}

impl Tried<'_> {
    /// From what `other` does; also in attitudes that the record has not. `size`: of ω, rad/s.
    fn distance(&self, other: &Self, size: f64) -> f64 {
        let square = |(a, b): (&State, &State)| {
            let turn = (a.0.conjugate() * b.0).logarithm().norm_squared();
            turn + (a.1 - b.1).norm_squared() / (size * size)
        };
        self.found.iter().zip(&other.found).map(square).sum::<f64>().sqrt()
    }
}

/// The splitting that chooses its axes by the start, by its name, with those that it may have chosen as well: of a body two of
/// whose moments agree, an order is as good as the one in which their axes change places, and the last digit of the start decides.
fn mirrored(body: &Body, first: &Row) -> Option<(String, LiePoisson)> {
    let has_pair = matches!(body.inertia().symmetry(), Symmetry::Prolate | Symmetry::Oblate);
    if body.problem() != Problem::Free || !has_pair {
        return None;
    }
    let start = body.enter_omega(first.attitude.unwrap_or(Quat::identity()), first.omega).ok()?.to_f64();
    let moments: Vec3<f64> = body.rotor().moments();
    let apart = |pair: &[usize; 2]| (moments[pair[0]] - moments[pair[1]]).abs();
    let [i, j] = [[0, 1], [0, 2], [1, 2]].into_iter().min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
    let chosen = AxisOrder::best_for_orbit(start.momentum_body, moments).axes();
    let other = chosen.map(|axis| {
        if axis == i {
            j
        } else if axis == j {
            i
        } else {
            axis
        }
    });
    let axes = AxisOrder::ALL.into_iter().find(|order| order.axes() == other);
    let by_itself = LiePoisson::strang(AxisSplit { axes: None }, Kicks);
    Some((by_itself.name(), LiePoisson::strang(AxisSplit { axes }, Kicks)))
}

/// The part of the errors of rows beside the exact motion that a clock leaves which is too fast or too slow.
fn clock(body: &Body, first: &Row, rows: &[(&Row, State)]) -> Option<f64> {
    let size = first.omega.norm();
    let times = rows.iter().map(|(row, _)| first.time + (row.time - first.time) * (1.0 + CLOCK));
    let later = motion(body, first, times, true)?;
    let (mut squares, mut along, mut by_clock) = (0.0, 0.0, 0.0);
    for ((row, exact), later) in rows.iter().zip(&later) {
        let from_exact = |attitude: Option<Quat<f64>>, omega: Vec3<f64>| {
            let turn = attitude.map_or(Vec3::zero(), |q| (exact.0.conjugate() * q).logarithm());
            (turn, (omega - exact.1) * (1.0 / size))
        };
        let error = from_exact(row.attitude, row.omega);
        let shift = from_exact(row.attitude.map(|_| later.0), later.1);
        squares += error.0.norm_squared() + error.1.norm_squared();
        along += error.0.dot(shift.0) + error.1.dot(shift.1);
        by_clock += shift.0.norm_squared() + shift.1.norm_squared();
    }
    let explained = if by_clock > 0.0 { along * along / (by_clock * squares) } else { 0.0 };
    Some((1.0 - explained).max(0.0).sqrt())
}

/// Attitude and ω of `method` with `n` steps between rows, at the rows `looks`.
fn hypothesis(
    body: &Body,
    method: &dyn AnyMethod,
    first: &Row,
    interval: f64,
    n: u64,
    looks: &[usize],
) -> Option<Vec<State>> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inertia::Inertia;

    /// A free body, and its state at the start, body axes, `speed` times as fast as usual.
    fn tumbling(speed: f64) -> (Body, Row) {
        let body = Body::free(Inertia::from_moments([1.0, 2.0, 2.5]).unwrap());
        let omega = Vec3([0.4, 1.0, -0.3]) * speed;
        (body, Row { row: 0, time: 0.0, attitude: Some(Quat::identity()), omega })
    }

    /// A part of the turn from `a` to `b`.
    fn between(a: Quat<f64>, b: Quat<f64>, part: f64) -> Quat<f64> {
        a * Quat::exponential((a.conjugate() * b).logarithm() * part)
    }

    /// Of errors of which parts are those of a clock, what is across them: by the projection in attitude and relative ω.
    #[test]
    fn a_clock_explains_what_it_leaves_and_no_more_in_any_unit_of_time() {
        for speed in [1.0, 0.01, 100.0] {
            let (body, first) = tumbling(speed);
            let times = || (1..=12).map(|k| 0.5 * f64::from(k) / speed);
            let exact = motion(&body, &first, times(), true).unwrap();
            let fast = motion(&body, &first, times().map(|t| t * (1.0 + 3e-6)), true).unwrap();
            let across = |of_turns: f64, of_rates: f64| {
                let rows: Vec<Row> = (times().zip(&exact).zip(&fast))
                    .map(|((time, a), b)| {
                        let attitude = Some(between(a.0, b.0, of_turns));
                        Row { row: 0, time, attitude, omega: a.1 + (b.1 - a.1) * of_rates }
                    })
                    .collect();
                clock(&body, &first, &rows.iter().zip(exact.iter().copied()).collect::<Vec<_>>()).unwrap()
            };
            let (mut turns, mut rates) = (0.0, 0.0);
            for (a, b) in exact.iter().zip(&fast) {
                turns += (a.0.conjugate() * b.0).logarithm().norm_squared();
                rates += (b.1 - a.1).norm_squared() / first.omega.norm_squared();
            }
            assert!(across(1.0, 1.0) < 1e-3, "{}", across(1.0, 1.0));
            for (p, q) in [(1.0, 0.0), (0.0, 1.0), (1.0, -1.0), (2.0, 3.0)] {
                let along = p * turns + q * rates;
                let squares = (turns + rates) * (p * p * turns + q * q * rates);
                let expected = (1.0 - along * along / squares).sqrt();
                assert!((across(p, q) - expected).abs() < 1e-4, "{p} {q}: {} {expected}", across(p, q));
            }
        }
    }
}
