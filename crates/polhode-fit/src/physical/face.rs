//! Newton's method on the face that holds the answer, and the certificate.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use crate::physical::certificate::Certificate;
use crate::physical::constraint::{ActiveConstraint, Constraint};
use crate::physical::coordinates::{Coordinates, eigen};
use crate::physical::failure::SolverFailure;
use crate::physical::law::LARGEST_SHARE;
use crate::physical::program::{Program, Wall};
use crate::thresholds::program::{CERTIFIED, INWARDS, NEAR, NEWTON, ROUNDED, STATIONARY};

/// The answer of the program.
pub(crate) struct Nearest {
    /// The last five unknowns: the coordinates of the tensor, where there is one.
    pub(crate) x: Coordinates,
    /// The unknowns before them.
    pub(crate) others: Vec<f64>,
    pub(crate) active: Vec<ActiveConstraint>,
    /// Distance from the unconstrained answer, standard deviations.
    pub(crate) pull: f64,
    pub(crate) certificate: Certificate,
}

/// Axes and eigenvalues of a matrix, descending.
type Frame = ([Vector3<f64>; 3], [f64; 3]);

impl Program {
    /// Newton's method on the face that the solver's answer lies on, and the certificate.
    pub(super) fn polish(&self, start: DVector<f64>, rounds: usize) -> Result<Nearest, SolverFailure> {
        let near = NEAR * (1.0 + start.norm());
        let mut faces: Vec<usize> = self
            .walls
            .iter()
            .map(|wall| {
                let (values, axes) = eigen(self.matrix(wall, &start));
                let distance = |k: usize| {
                    let v = axes.column(k).into_owned();
                    (wall.most - values[k]) / self.reading(wall, &v, &v).g.norm()
                };
                // no body has three such moments
                (0..3).filter(|&k| distance(k) <= near).count().min(2)
            })
            .collect();
        let mut held: Vec<usize> = (0..self.rows.len())
            .filter(|&k| {
                let row = &self.rows[k].0;
                -row.at(&start) <= near * row.g.norm()
            })
            .collect();
        // a constraint that is near but does not push is let go, the one that pulls most first
        loop {
            let newton = match self.newton(&start, &faces, &held) {
                // of constraints that depend on each other, as the sides of a narrow limit, the furthest is not reached
                Err(_) if !held.is_empty() => {
                    let reach = |k: usize| {
                        let row = &self.rows[k].0;
                        -row.at(&start) / row.g.norm()
                    };
                    let furthest = (0..held.len()).max_by(|&a, &b| reach(held[a]).total_cmp(&reach(held[b])));
                    held.remove(furthest.unwrap_or(0));
                    continue;
                }
                solved => solved?,
            };
            let lowest = newton.zs.iter().map(|z| eigen(*z).0[0].min(0.0)).enumerate();
            let (loose, slack_of_face) = lowest.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0));
            let weakest = newton.held.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1));
            let tolerance = CERTIFIED * (1.0 + newton.largest());
            match weakest {
                Some((k, &m)) if m < -tolerance && m <= slack_of_face => {
                    held.remove(k);
                }
                _ if slack_of_face < -tolerance => faces[loose] -= 1,
                _ => return self.certify(newton, &faces, &held, rounds),
            }
        }
    }

    /// Axes and eigenvalues of a wall at `y`.
    fn frame(&self, wall: &Wall, y: &DVector<f64>) -> Frame {
        let (values, axes) = eigen(self.matrix(wall, y));
        (core::array::from_fn(|k| axes.column(2 - k).into_owned()), [values[2], values[1], values[0]])
    }

    fn frames(&self, y: &DVector<f64>) -> Vec<Frame> {
        self.walls.iter().map(|wall| self.frame(wall, y)).collect()
    }

    /// Gradients of the entries of each matrix on its face, then of the limits that are held.
    fn gradients(&self, frames: &[Frame], faces: &[usize], held: &[usize]) -> Vec<DVector<f64>> {
        let mut gradients = Vec::new();
        for ((wall, (v, _)), &face) in self.walls.iter().zip(frames).zip(faces) {
            let pairs = (0..face).flat_map(|a| (0..=a).map(move |b| (a, b)));
            gradients.extend(pairs.map(|(a, b)| self.reading(wall, &v[a], &v[b]).g));
        }
        gradients.extend(held.iter().map(|&k| self.rows[k].0.g.clone()));
        gradients
    }

    /// The multipliers that make |y + Σ multiplier · gradient| least.
    fn least_multipliers(&self, y: &DVector<f64>, faces: &[usize], held: &[usize]) -> Vec<f64> {
        let gradients = self.gradients(&self.frames(y), faces, held);
        let sizes: Vec<f64> = gradients.iter().map(|g| g.norm()).collect();
        let units = DMatrix::from_fn(y.len(), gradients.len(), |k, e| gradients[e][k] / sizes[e]);
        let solved = (units.transpose() * &units).full_piv_lu().solve(&(units.transpose() * -y));
        solved.map_or(vec![0.0; sizes.len()], |m| m.iter().zip(&sizes).map(|(m, s)| m / s).collect())
    }

    fn newton(&self, start: &DVector<f64>, faces: &[usize], held: &[usize]) -> Result<Newton, SolverFailure> {
        let size = start.len();
        let equations = faces.iter().map(|face| face * (face + 1) / 2).sum::<usize>() + held.len();
        let none = Newton {
            y: DVector::zeros(size),
            zs: vec![Matrix3::zeros(); self.walls.len()],
            held: Vec::new(),
        };
        if equations == 0 {
            return Ok(none);
        }
        let mut y = start.clone();
        // each Z is kept in sensor axes: where two moments agree, their axes differ from step to step
        let mut zs = multipliers(&self.frames(start), faces, &self.least_multipliers(start, faces, held));
        let mut newton = none;
        for _ in 0..NEWTON {
            let frames = self.frames(&y);
            let gradients = self.gradients(&frames, faces, held);
            let mut values = Vec::with_capacity(equations);
            // curvature of the eigenvalues: they repel those off the face
            let mut hessian = DMatrix::identity(size, size);
            for (((wall, (v, moments)), &face), z) in self.walls.iter().zip(&frames).zip(faces).zip(&zs) {
                for (a, moment) in moments.iter().take(face).enumerate() {
                    values.extend((0..=a).map(|b| if a == b { moment - wall.most } else { 0.0 }));
                }
                let frame = Matrix3::from_columns(v);
                let inner = frame.transpose() * z * frame;
                for (a, b, j) in
                    (0..face).flat_map(|a| (0..face).flat_map(move |b| (face..3).map(move |j| (a, b, j))))
                {
                    let ga = self.reading(wall, &v[a], &v[j]).g;
                    let gb = self.reading(wall, &v[b], &v[j]).g;
                    hessian += (&ga * gb.transpose() + &gb * ga.transpose())
                        * (inner[(a, b)] / (wall.most - moments[j]));
                }
            }
            values.extend(held.iter().map(|&k| self.rows[k].0.at(&y)));
            let n = size + equations;
            let mut matrix = DMatrix::zeros(n, n);
            matrix.view_mut((0, 0), (size, size)).copy_from(&hessian);
            let mut right = DVector::zeros(n);
            right.rows_mut(0, size).copy_from(&-&y);
            // rows of unit size: gradients span many decades
            let sizes: Vec<f64> = gradients.iter().map(|g| g.norm()).collect();
            for (e, g) in gradients.iter().enumerate() {
                for k in 0..size {
                    matrix[(size + e, k)] = g[k] / sizes[e];
                    matrix[(k, size + e)] = g[k] / sizes[e];
                }
                right[size + e] = -values[e] / sizes[e];
            }
            let step = matrix.full_piv_lu().solve(&right).ok_or(SolverFailure::Dependent)?;
            let move_ = step.rows(0, size).into_owned();
            y += &move_;
            let found: Vec<f64> = (0..equations).map(|e| step[size + e] / sizes[e]).collect();
            zs = multipliers(&frames, faces, &found);
            newton = Newton { held: found[equations - held.len()..].to_vec(), zs: zs.clone(), y: y.clone() };
            if move_.norm() <= ROUNDED * (1.0 + y.norm()) {
                break;
            }
        }
        Ok(newton)
    }

    fn certify(
        &self,
        newton: Newton,
        faces: &[usize],
        held: &[usize],
        rounds: usize,
    ) -> Result<Nearest, SolverFailure> {
        let y = &newton.y;
        let mut gradient = y.clone();
        let (mut violation, mut lowest) = (0.0_f64, newton.held.iter().copied().fold(0.0, f64::min));
        let mut largest_moment = 0.0;
        for (k, (wall, z)) in self.walls.iter().zip(&newton.zs).enumerate() {
            let matrix = self.matrix(wall, y);
            let moment = eigen(matrix).0[2];
            if k == 0 {
                largest_moment = moment;
            }
            gradient += self.push(wall, z);
            let apart = (z * (Matrix3::identity() * wall.most - matrix)).norm() / (1.0 + newton.largest());
            violation = violation.max(moment - wall.most).max(apart);
            lowest = lowest.min(eigen(*z).0[0]);
        }
        for (k, (row, ..)) in self.rows.iter().enumerate() {
            violation = violation.max(row.at(y));
            if let Some(at) = held.iter().position(|&h| h == k) {
                gradient += &row.g * newton.held[at];
            }
        }
        let certificate = Certificate {
            stationarity: gradient.norm() / (1.0 + y.norm()),
            violation,
            dual_violation: -lowest / (1.0 + newton.largest()),
            rounds,
        };
        let passed = certificate.stationarity <= STATIONARY
            && certificate.violation <= CERTIFIED
            && certificate.dual_violation <= CERTIFIED;
        if !passed {
            return Err(SolverFailure::NotOptimal(certificate));
        }
        let mut active = Vec::new();
        for (&face, z) in faces.iter().zip(&newton.zs).filter(|(face, _)| **face > 0) {
            let constraint = if face == 1 { Constraint::Triangle } else { Constraint::Rod };
            active.push(ActiveConstraint { constraint, multiplier: z.trace() });
        }
        for (&k, &multiplier) in held.iter().zip(&newton.held) {
            let (_, constraint, unit) = self.rows[k];
            active.push(ActiveConstraint { constraint, multiplier: multiplier / unit });
        }
        let unknowns = self.unknowns(y);
        let first = unknowns.len() - 5;
        let mut x = Coordinates::from_column_slice(&unknowns.as_slice()[first..]);
        if self.has_shape && faces.first().is_some_and(|face| *face > 0) {
            // the last rounding goes towards the sphere: the tensor handed out is physical, not nearly so
            x *= ((LARGEST_SHARE - 1.0 / 3.0) / (largest_moment - 1.0 / 3.0)).min(1.0) * (1.0 - INWARDS);
        }
        let others = unknowns.as_slice()[..first].to_vec();
        Ok(Nearest { x, others, active, pull: y.norm(), certificate })
    }
}

/// Z of each wall in sensor axes from the multipliers of their lower triangles along the axes of `frames`.
fn multipliers(frames: &[Frame], faces: &[usize], multipliers: &[f64]) -> Vec<Matrix3<f64>> {
    let mut left = multipliers.iter();
    let each = frames.iter().zip(faces);
    each.map(|((v, _), &face)| {
        let pairs = (0..face).flat_map(|a| (0..=a).map(move |b| (a, b)));
        pairs.zip(&mut left).fold(Matrix3::zeros(), |z, ((a, b), &m)| {
            z + (v[a] * v[b].transpose() + v[b] * v[a].transpose()) * (0.5 * m)
        })
    })
    .collect()
}

struct Newton {
    y: DVector<f64>,
    /// Multiplier of each wall, in sensor axes.
    zs: Vec<Matrix3<f64>>,
    /// Multipliers of the limits that are held.
    held: Vec<f64>,
}

impl Newton {
    fn largest(&self) -> f64 {
        let of_walls = self.zs.iter().map(Matrix3::amax);
        of_walls.chain(self.held.iter().map(|h| h.abs())).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::coordinates::coordinates;
    use crate::physical::program::Row;

    /// Multipliers of the lower triangle of a face stand once on the diagonal, and half on each side of it; each wall takes its own.
    #[test]
    fn multipliers_fill_a_symmetric_matrix() {
        let own = ([Vector3::x(), Vector3::y(), Vector3::z()], [0.5, 0.3, 0.2]);
        let other = ([Vector3::z(), Vector3::x(), Vector3::y()], [0.5, 0.3, 0.2]);
        let found = multipliers(&[own, other, own], &[2, 1, 0], &[3.0, 4.0, 5.0, 7.0]);
        let two = Matrix3::new(3.0, 2.0, 0.0, 2.0, 5.0, 0.0, 0.0, 0.0, 0.0);
        let one = Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, 7.0));
        assert_eq!(found, [two, one, Matrix3::zeros()]);
    }

    /// Inside of the law, with an information of 1e6.
    fn program() -> Program {
        let inside = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45)));
        let centre = DVector::from_column_slice(inside.as_slice());
        Program::new(centre, DMatrix::identity(5, 5) * 1e3, &[])
    }

    /// What was checked of an answer that is none.
    fn refused(program: &Program, newton: Newton, faces: &[usize], held: &[usize]) -> Certificate {
        match program.certify(newton, faces, held, 5) {
            Err(SolverFailure::NotOptimal(certificate)) => certificate,
            _ => panic!("certified"),
        }
    }

    /// An answer that is moved without a reason is not stationary; a multiplier off the wall or below zero, and a row that is broken, are told as
    /// shares of the largest.
    #[test]
    fn what_is_no_answer_is_not_certified() {
        let mut program = program();
        let none = || Newton { y: DVector::zeros(5), zs: vec![Matrix3::zeros()], held: Vec::new() };
        let right = program.certify(none(), &[0], &[], 7).unwrap_or_else(|error| panic!("{error}"));
        assert!(right.active.is_empty() && right.pull == 0.0 && right.certificate.rounds == 7);

        let y = DVector::from_vec(vec![3.0, 0.0, -4.0, 0.0, 0.0]);
        let moved = refused(&program, Newton { y, ..none() }, &[0], &[]);
        assert!((moved.stationarity - 5.0 / 6.0).abs() < 1e-14 && moved.rounds == 5, "{moved:?}");
        assert_eq!((moved.violation, moved.dual_violation), (0.0, 0.0));

        // 0.05 of the trace off the wall; the gradient of a moment has the square 2/3
        for (multiplier, dual) in [(-2.0, 2.0 / 3.0), (2.0, 0.0)] {
            let zs = vec![Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, multiplier))];
            let pushed = refused(&program, Newton { zs, ..none() }, &[1], &[]);
            assert!((pushed.dual_violation - dual).abs() < 1e-14, "{pushed:?}");
            assert!((pushed.violation - 2.0 * 0.05 / 3.0).abs() < 1e-12, "{pushed:?}");
            let gradient = 2e-3 * (2.0_f64 / 3.0).sqrt();
            assert!((pushed.stationarity / gradient - 1.0).abs() < 1e-12, "{pushed:?}");
        }

        let row = Row { base: 0.125, g: DVector::from_vec(vec![0.0, 2.0, 0.0, 0.0, 0.0]) };
        program.rows.push((row, Constraint::Drag { name: "drag" }, 1.0));
        let broken = refused(&program, none(), &[0], &[]);
        assert_eq!((broken.stationarity, broken.violation, broken.dual_violation), (0.0, 0.125, 0.0));
        let held = refused(&program, Newton { held: vec![-0.5], ..none() }, &[0], &[0]);
        assert_eq!((held.stationarity, held.violation), (1.0, 0.125));
        assert!((held.dual_violation - 0.5 / 1.5).abs() < 1e-15, "{held:?}");
    }
}
