//! Maximum likelihood under white noise: output error by multiple shooting.
//!
//! The unknowns are the tensor x, the drag where there is one, and the rate at nodes a few radians apart. Each round linearises the
//! motion from every node, takes the jumps between them out as linear constraints, which leaves tensor, drag and the first rate, and
//! solves for these by least squares (Gauss–Newton).
//!
//! Source: H. G. Bock, Numerical treatment of inverse problems in chemical reaction kinetics, Springer (1981).

use nalgebra::{Matrix6, SMatrix, SVector, Vector3, Vector5, Vector6};

use super::Answer;
use super::euler::{Euler, Sensitivity, at_start};
use super::record::Stretch;
use super::strong::local_cubic;

/// Radians between nodes.
const BETWEEN_NODES: f64 = 3.0;
/// Radians on either side of a node from which its first rate is taken.
const WINDOW: f64 = 0.5;
const ROUNDS: usize = 40;
/// Longest step of a round, in shares of the trace.
const LONGEST: f64 = 0.1;
/// Step, in standard deviations, that ends the rounds.
const STILL: f64 = 1e-4;

/// How jumps of the nodes follow from drag, x and the first rate.
struct Affine {
    matrix: Sensitivity<9>,
    constant: Vector3<f64>,
}

/// From the coordinates `x`, and with a drag −d J ω, from zero on, where the motion `slows`. `None` where the rounds do not come to
/// rest.
pub(super) fn answer(stretches: &[Stretch], mut x: Vector5<f64>, slows: bool, sigma: f64) -> Option<Answer> {
    let mut nodes: Vec<Vec<(usize, Vector3<f64>)>> = stretches.iter().map(nodes).collect::<Option<_>>()?;
    let mut drag = 0.0;
    for _ in 0..ROUNDS {
        let mut information = Matrix6::zeros();
        let mut right = Vector6::zeros();
        let mut eliminated = Vec::new();
        let euler = Euler::new(&x)?.with_drag(drag);
        for (s, nodes) in stretches.iter().zip(&nodes) {
            let (normal, gradient, jumps) = shoot(&euler, s, nodes);
            let start = normal.fixed_view::<3, 3>(6, 6).into_owned().cholesky()?;
            let mixed = normal.fixed_view::<3, 6>(6, 0).into_owned();
            let own = gradient.fixed_rows::<3>(6).into_owned();
            information += normal.fixed_view::<6, 6>(0, 0) - mixed.transpose() * start.solve(&mixed);
            right += gradient.fixed_rows::<6>(0) - mixed.transpose() * start.solve(&own);
            eliminated.push((start, mixed, own, jumps));
        }
        if !slows {
            information.row_mut(0).fill(0.0);
            information.column_mut(0).fill(0.0);
            (information[(0, 0)], right[0]) = (1.0, 0.0);
        }
        let step = information.cholesky()?.solve(&right);
        if !step.iter().all(|v| v.is_finite()) {
            return None;
        }
        let share = (LONGEST / step.norm()).min(1.0);
        drag += step[0] * share;
        x += step.fixed_rows::<5>(1) * share;
        let mut largest = 0.0_f64;
        for ((start, mixed, own, jumps), nodes) in eliminated.iter().zip(&mut nodes) {
            let first = start.solve(&(own - mixed * step));
            let all = SVector::<f64, 9>::from_fn(|k, _| if k < 6 { step[k] } else { first[k - 6] });
            for (jump, (_, rate)) in jumps.iter().zip(nodes) {
                let moved = jump.matrix * all + jump.constant;
                largest = largest.max(moved.norm());
                *rate += moved * share;
            }
        }
        let distance = step.dot(&(information * step)).sqrt() / sigma;
        if share == 1.0 && distance < STILL && largest < 0.01 * sigma.max(1e-6) {
            let mixed = information.fixed_view::<5, 1>(1, 0).into_owned();
            let own = information.fixed_view::<5, 5>(1, 1) - mixed * mixed.transpose() / information[(0, 0)];
            return Answer::constrained(x, own / (sigma * sigma));
        }
    }
    None
}

/// Places and first rates of the nodes.
fn nodes(s: &Stretch) -> Option<Vec<(usize, Vector3<f64>)>> {
    let duration = s.times.last()? - s.times[0];
    let count = (duration / BETWEEN_NODES).ceil().max(1.0) as usize;
    (0..count)
        .map(|k| {
            let at = s.times.partition_point(|t| *t < s.times[0] + duration * k as f64 / count as f64);
            let time = s.times[at];
            let low = s.times.partition_point(|t| *t < time - WINDOW);
            let high = s.times.partition_point(|t| *t <= time + WINDOW).max((low + 4).min(s.times.len()));
            Some((at, local_cubic(s, low..high, time)?.0))
        })
        .collect()
}

/// Normal equations of drag, x and the first rate, and the jumps of the nodes.
fn shoot(
    euler: &Euler,
    s: &Stretch,
    nodes: &[(usize, Vector3<f64>)],
) -> (SMatrix<f64, 9, 9>, SVector<f64, 9>, Vec<Affine>) {
    let (mut normal, mut gradient) = (SMatrix::zeros(), SVector::zeros());
    let mut jumps = vec![Affine { matrix: at_start(), constant: Vector3::zeros() }];
    for (k, &(first, rate)) in nodes.iter().enumerate() {
        let end = nodes.get(k + 1).map_or(s.times.len(), |next| next.0);
        let (mut w, mut sensitivity) = (rate, at_start());
        // the change of ω is that of drag and x and that of the node, which is affine in drag, x and the first rate
        let chained = |sensitivity: &Sensitivity<9>, jump: &Affine| {
            let by_node = sensitivity.fixed_view::<3, 3>(0, 6);
            let mut matrix = by_node * jump.matrix;
            let by_law = matrix.fixed_view::<3, 6>(0, 0) + sensitivity.fixed_view::<3, 6>(0, 0);
            matrix.fixed_view_mut::<3, 6>(0, 0).copy_from(&by_law);
            Affine { matrix, constant: by_node * jump.constant }
        };
        for i in first..end {
            if i > first {
                euler.advance(&mut w, &mut sensitivity, s.times[i] - s.times[i - 1]);
            }
            let change = chained(&sensitivity, &jumps[k]);
            let residual = s.rates[i] - w - change.constant;
            normal += change.matrix.transpose() * change.matrix;
            gradient += change.matrix.transpose() * residual;
        }
        if let Some(next) = nodes.get(k + 1) {
            euler.advance(&mut w, &mut sensitivity, s.times[end] - s.times[end - 1]);
            let mut change = chained(&sensitivity, &jumps[k]);
            change.constant += w - next.1;
            jumps.push(change);
        }
    }
    (normal, gradient, jumps)
}
