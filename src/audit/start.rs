//! The start, and where it is not given the body, with which the exact motion comes nearest to a record.

use super::bodies::Told;
use super::motion::motion;
use super::states::Row;
use crate::body::{Body, Problem};
use crate::inertia::{Inertia, from_entries};
use crate::num::eigen::eigen;
use crate::rotation::{Quat, Vec3};

/// Three turns of the start, three components of its angular velocity, six entries of the tensor.
const UNKNOWNS: usize = 12;

/// Most iterations on one horizon: next to the separatrix the first are far from where the problem is linear.
const ITERATIONS: usize = 12;

/// Relative change by which derivatives are taken, about the square root of the rounding of a double: over a long record next to
/// the separatrix it grows a million times, and must stay small.
const CHANGE: f64 = 1e-8;

/// A row this far from the motion, rad or relative, is lost.
const LOST: f64 = 0.5;

/// Halvings of a step that no body takes.
const HALVINGS: i32 = 10;

/// Directions that the record bounds less than this, beside the best bounded, are left alone.
const UNBOUNDED: f64 = 1e-13;

/// What the distance is weighed by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    /// rad.
    pub(super) attitude: f64,
    /// Relative to the size of ω.
    pub(super) rates: f64,
    /// rad/s.
    pub(super) size: f64,
}

/// A start and a body.
#[derive(Clone, Debug)]
pub(super) struct Start {
    pub(super) row: Row,
    pub(super) body: Body,
}

/// The distances of `rows` from the motion from `start`: a rotation vector in space, rad, and a difference of ω.
pub(super) fn distances(start: &Start, rows: &[Row], precise: bool) -> Option<Vec<(Vec3<f64>, Vec3<f64>)>> {
    let exact = motion(&start.body, &start.row, rows.iter().map(|row| row.time), precise)?;
    let pairs = rows.iter().zip(exact);
    Some(
        pairs
            .map(|(row, (q, omega))| {
                let turn = row
                    .attitude
                    .map_or(Vec3::zero(), |measured| q.rotate((q.conjugate() * measured).logarithm()));
                (turn, row.omega - omega)
            })
            .collect(),
    )
}

/// The start that fits `rows` best, by Gauss's and Newton's iteration over a horizon that grows: on a short one the start of the
/// record is near enough, and a fit over it is near enough on the next. With `rates`, ω is compared too; with `shape`, the tensor
/// is fitted as well. The wheels that are `told` have the momenta that each start gives them.
pub(super) fn fitted(
    first: &Start,
    told: Option<&Told>,
    rows: &[Row],
    weights: Weights,
    rates: bool,
    shape: bool,
) -> Option<Start> {
    let mut best = first.clone();
    let growth = weights.rates.max(weights.attitude) * weights.size;
    let mut reach = (0.1 / growth).max(3.0 / weights.size);
    loop {
        let within = rows.iter().take_while(|row| row.time - first.row.time <= reach).count().max(8);
        let within = &rows[..within.min(rows.len())];
        for _ in 0..ITERATIONS {
            let (next, moved) = improved(&best, told, within, weights, rates, shape)?;
            best = next;
            if moved < 1e-4 {
                break;
            }
        }
        // what is lost on a short horizon is on a longer one, whose runs are dear
        if within.len() == rows.len()
            || best.body.problem() != Problem::Free && is_lost(&best, within, weights)?
        {
            return Some(best);
        }
        reach *= 4.0;
    }
}

/// Whether most of `rows` are far from the motion.
fn is_lost(start: &Start, rows: &[Row], weights: Weights) -> Option<bool> {
    let all = distances(start, rows, false)?;
    let far = all.iter().filter(|(turn, omega)| turn.norm().max(omega.norm() / weights.size) > LOST);
    Some(2 * far.count() > all.len())
}

/// One iteration, and how far it moved the start, in units of its uncertainty.
fn improved(
    start: &Start,
    told: Option<&Told>,
    rows: &[Row],
    weights: Weights,
    rates: bool,
    shape: bool,
) -> Option<(Start, f64)> {
    let residual = |start: &Start| -> Option<Vec<f64>> {
        let all = distances(start, rows, false)?;
        Some(
            all.into_iter()
                .flat_map(|(turn, omega)| {
                    let of_rates = if rates { 1.0 / (weights.rates * weights.size) } else { 0.0 };
                    let (turn, omega) = (turn * (1.0 / weights.attitude), omega * of_rates);
                    [turn[0], turn[1], turn[2], omega[0], omega[1], omega[2]]
                })
                .collect(),
        )
    };
    let here = residual(start)?;
    let unknowns = if shape { UNKNOWNS } else { 6 };
    let mut slopes = Vec::new();
    for n in 0..unknowns {
        // at the bounds of what a body can be there is one side only
        let (there, by) = [CHANGE, -CHANGE].into_iter().find_map(|by| {
            let mut change = [0.0; UNKNOWNS];
            change[n] = by;
            Some((residual(&changed(start, told, change, weights.size)?)?, by))
        })?;
        slopes.push(there.iter().zip(&here).map(|(a, b)| (a - b) / by).collect::<Vec<f64>>());
    }
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (mut normal, mut right) = ([[0.0; UNKNOWNS]; UNKNOWNS], [0.0; UNKNOWNS]);
    for (i, a) in slopes.iter().enumerate() {
        right[i] = -dot(a, &here);
        for (j, b) in slopes.iter().enumerate() {
            normal[i][j] = dot(a, b);
        }
    }
    let (values, vectors) = eigen(normal);
    let mut step = [0.0; UNKNOWNS];
    let mut moved = 0.0;
    for (value, vector) in
        values.iter().zip(&vectors).filter(|(value, _)| **value > UNBOUNDED * values[UNKNOWNS - 1])
    {
        let along = dot(vector, &right) / value;
        moved += along * along * value;
        for (entry, component) in step.iter_mut().zip(vector) {
            *entry += along * component;
        }
    }
    // a long way is no linear problem, and one that leaves what a body can be is too long
    let longest = step.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let part = if longest > 0.2 { 0.2 / longest } else { 1.0 };
    let next = (0..HALVINGS)
        .find_map(|k| changed(start, told, step.map(|x| x * libm::scalbn(part, -k)), weights.size))?;
    Some((next, moved.sqrt()))
}

/// The start with a turn, rad, and an angular velocity, in units of `size`, added in body axes, and entries of the tensor in units
/// of its trace.
fn changed(start: &Start, told: Option<&Told>, change: [f64; UNKNOWNS], size: f64) -> Option<Start> {
    let [a, b, c, x, y, z, tensor @ ..] = change;
    let mut row = start.row;
    row.attitude = row.attitude.map(|q| q * Quat::exponential(Vec3([a, b, c])));
    row.omega = row.omega + Vec3([x, y, z]) * size;
    if tensor == [0.0; 6] {
        let body = match told {
            Some(told) => told.at(row.time, row.omega)?,
            None => start.body.clone(),
        };
        return Some(Start { row, body });
    }
    let old = start.body.inertia().tensor();
    let new = old + from_entries(tensor.map(|entry| entry * old.trace()));
    let inertia = Inertia::from_tensor(new / new.trace()).ok()?;
    Some(Start { row, body: Body::free(inertia) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_is_lost_that_more_than_half_of_the_rows_are_far_from() {
        let body = Body::free(Inertia::from_moments([1.0, 2.0, 2.5]).unwrap());
        let row =
            |k: usize, attitude, omega| Row { row: k, time: 0.1 * k as f64, attitude: Some(attitude), omega };
        let first = row(0, Quat::identity(), Vec3([0.4, 1.0, -0.3]));
        let exact = motion(&body, &first, (0..10).map(|k| 0.1 * f64::from(k)), true).unwrap();
        let start = Start { row: first, body };
        let weights = Weights { attitude: 1.0, rates: 1.0, size: 1.1 };
        let is_lost = |far: usize| {
            let off = |k: usize| Quat::exponential(Vec3([if k < far { 0.6 } else { 0.4 }, 0.0, 0.0]));
            let rows = exact.iter().enumerate().map(|(k, (q, omega))| row(k, *q * off(k), *omega));
            is_lost(&start, &rows.collect::<Vec<_>>(), weights).unwrap()
        };
        assert_eq!([0, 1, 5, 6, 10].map(is_lost), [false, false, false, true, true]);
    }
}
