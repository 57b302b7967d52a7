//! The inertia tensor, up to its scale, that makes a record a free motion.

use nalgebra::Matrix3;

use crate::body::Body;
use crate::inertia::{Inertia, from_entries};
use crate::num::eigen::eigen;
use crate::rotation::{Quat, Vec3};

/// By which parts of a ball a tensor is made rounder that lies beyond the law.
const ROUNDER: [f64; 5] = [0.0, 1e-9, 1e-6, 1e-4, 1e-2];

/// One state of a record.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    pub(super) time: f64,
    /// Body → space.
    pub(super) attitude: Option<Quat<f64>>,
    /// Body axes, rad/s.
    pub(super) omega: Vec3<f64>,
}

/// `I ω` as a matrix times the entries xx, yy, zz, xy, xz, yz of I.
fn columns(w: Vec3<f64>) -> [[f64; 6]; 3] {
    [[w[0], 0.0, 0.0, w[1], w[2], 0.0], [0.0, w[1], 0.0, w[0], 0.0, w[2]], [0.0, 0.0, w[2], 0.0, w[0], w[1]]]
}

/// The free body that moves as `looks` do: least squares of what is to vanish, linear in the entries of I.
///
/// With attitudes it is the scatter of L = R I ω; without, the change of I ω over each step of time less the integral of
/// Iω × ω. Where the motion leaves entries open, those nearest to a ball are taken. `None` if no body has the tensor.
pub(super) fn fit(runs: &[Vec<Look>], by_attitude: bool) -> Option<Body> {
    let mut gram = [[0.0; 6]; 6];
    let mut add = |rows: [[f64; 6]; 3]| {
        for row in rows {
            for i in 0..6 {
                for j in 0..6 {
                    gram[i][j] += row[i] * row[j];
                }
            }
        }
    };
    if by_attitude {
        let looks: Vec<&Look> = runs.iter().flatten().collect();
        let in_space = |look: &Look| {
            let body = columns(look.omega);
            let mut space = [[0.0; 6]; 3];
            for n in 0..6 {
                let turned = look.attitude?.rotate(Vec3([body[0][n], body[1][n], body[2][n]]));
                for (k, row) in space.iter_mut().enumerate() {
                    row[n] = turned[k];
                }
            }
            Some(space)
        };
        let all: Vec<_> = looks.into_iter().map(in_space).collect::<Option<_>>()?;
        let mut mean = [[0.0; 6]; 3];
        for rows in &all {
            for k in 0..3 {
                for n in 0..6 {
                    mean[k][n] += rows[k][n] / all.len() as f64;
                }
            }
        }
        for rows in &all {
            add(core::array::from_fn(|k| core::array::from_fn(|n| rows[k][n] - mean[k][n])));
        }
    } else {
        for run in runs {
            let (first, last) = (run.first()?, run.last()?);
            let (a, b) = (columns(first.omega), columns(last.omega));
            let mut rows: [[f64; 6]; 3] =
                core::array::from_fn(|k| core::array::from_fn(|n| b[k][n] - a[k][n]));
            for pair in run.windows(2) {
                let dt = pair[1].time - pair[0].time;
                for look in pair {
                    let (w, m) = (look.omega, columns(look.omega));
                    for n in 0..6 {
                        let term = w.cross(Vec3([m[0][n], m[1][n], m[2][n]]));
                        for (k, row) in rows.iter_mut().enumerate() {
                            row[n] += 0.5 * dt * term[k];
                        }
                    }
                }
            }
            add(rows);
        }
    }
    body_of(gram)
}

fn body_of(gram: [[f64; 6]; 6]) -> Option<Body> {
    let (values, vectors) = eigen(gram);
    if !(values[5] > 0.0 && values[5].is_finite()) {
        return None;
    }
    // (G + ε)⁻¹ applied to the entries of a ball, ε between what vanishes and what does not
    let epsilon = (values[0].max(0.0) * 30.0).max(values[5] * 1e-15);
    let mut entries = [0.0; 6];
    for (value, vector) in values.iter().zip(&vectors) {
        let along = (vector[0] + vector[1] + vector[2]) * epsilon / (value.max(0.0) + epsilon);
        for (entry, component) in entries.iter_mut().zip(vector) {
            *entry += along * component;
        }
    }
    let trace = entries[0] + entries[1] + entries[2];
    let tensor = from_entries(entries.map(|entry| entry / trace));
    // what a lamina leaves to rounding may lie beyond what a body can be: the nearest to it that is nearer to a ball
    let rounder = |part: f64| tensor * (1.0 - part) + Matrix3::from_diagonal_element(part / 3.0);
    let inertia = ROUNDER.into_iter().find_map(|part| Inertia::from_tensor(rounder(part)).ok())?;
    Some(Body::free(inertia))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding may leave the largest moment of a lamina above the sum of the others: a part of 1e-4 of a ball of the same trace
    /// makes it a body again.
    #[test]
    fn a_tensor_just_beyond_the_law_is_made_rounder_at_the_same_trace() {
        let beyond = [1.0, 2.0, 3.000_03].map(|moment| moment / 6.000_03);
        let length = beyond.iter().map(|x| x * x).sum::<f64>().sqrt();
        let entries = [beyond[0] / length, beyond[1] / length, beyond[2] / length, 0.0, 0.0, 0.0];
        // what no entries but these make vanish
        let gram: [[f64; 6]; 6] = core::array::from_fn(|i| {
            core::array::from_fn(|j| if i == j { 1.0 } else { 0.0 } - entries[i] * entries[j])
        });
        let tensor = body_of(gram).unwrap().inertia().tensor();
        for (axis, moment) in beyond.into_iter().enumerate() {
            let expected = moment * (1.0 - 1e-4) + 1e-4 / 3.0;
            assert!((tensor[(axis, axis)] - expected).abs() < 1e-12, "{tensor}, {expected}");
        }
    }
}
