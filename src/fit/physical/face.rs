//! Newton's method on the face that holds the answer, and the certificate.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::certificate::{CERTIFIED, Certificate, STATIONARY};
use super::constraint::{ActiveConstraint, Constraint};
use super::coordinates::{Coordinates, Form, coordinates, eigen};
use super::failure::SolverFailure;
use super::law::LARGEST_SHARE;
use super::limits::{Limit, side};
use super::program::Program;

/// The answer of the program.
pub(crate) struct Nearest {
    pub(crate) x: Coordinates,
    pub(crate) active: Vec<ActiveConstraint>,
    /// Gradients of the active constraints in whitened increments.
    pub(crate) face: Vec<Coordinates>,
    pub(crate) certificate: Certificate,
}

impl Program {
    /// Newton's method on the face that the solver's answer lies on, and the certificate.
    pub(super) fn polish(
        &self,
        start: Coordinates,
        rounds: usize,
        limits: &[Limit],
    ) -> Result<Nearest, SolverFailure> {
        let near = 1e-4 * (1.0 + start.norm());
        let (moments, axes) = eigen(self.tensor(&start));
        let distance = |k: usize| {
            let v = axes.column(k).into_owned();
            (LARGEST_SHARE - moments[k]) / self.reading(&v, &v).g.norm()
        };
        let mut face = (0..3).filter(|&k| distance(k) <= near).count().min(2);
        let mut held: Vec<usize> = (0..self.rows.len())
            .filter(|&k| {
                let row = &self.rows[k].0;
                -(row.base + row.g.dot(&start)) <= near * row.g.norm()
            })
            .collect();
        // a constraint that is near but does not push is let go, the one that pulls most first
        loop {
            let newton = match self.newton(start, face, &held) {
                // of constraints that depend on each other, as the sides of a narrow limit, the furthest is not reached
                Err(_) if !held.is_empty() => {
                    let reach = |k: usize| {
                        let row = &self.rows[k].0;
                        -(row.base + row.g.dot(&start)) / row.g.norm()
                    };
                    let furthest = (0..held.len()).max_by(|&a, &b| reach(held[a]).total_cmp(&reach(held[b])));
                    held.remove(furthest.unwrap_or(0));
                    continue;
                }
                solved => solved?,
            };
            let (z, _) = eigen(newton.z);
            let slack_of_face = z[0].min(0.0);
            let weakest = newton.held.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1));
            let tolerance = CERTIFIED * (1.0 + newton.largest());
            match weakest {
                Some((k, &m)) if m < -tolerance && m <= slack_of_face => {
                    held.remove(k);
                }
                _ if slack_of_face < -tolerance => face -= 1,
                _ => return self.certify(newton, face, &held, rounds, limits),
            }
        }
    }

    /// Principal axes and moments at `y`, descending.
    fn frame(&self, y: &Coordinates) -> ([Vector3<f64>; 3], [f64; 3]) {
        let (moments, axes) = eigen(self.tensor(y));
        (core::array::from_fn(|k| axes.column(2 - k).into_owned()), [moments[2], moments[1], moments[0]])
    }

    /// Gradients of the entries of J on the face, then of the limits that are held.
    fn gradients(&self, v: &[Vector3<f64>; 3], face: usize, held: &[usize]) -> Vec<Coordinates> {
        let pairs = (0..face).flat_map(|a| (0..=a).map(move |b| (a, b)));
        pairs
            .map(|(a, b)| self.reading(&v[a], &v[b]).g)
            .chain(held.iter().map(|&k| self.rows[k].0.g))
            .collect()
    }

    /// The multipliers that make |y + Σ multiplier · gradient| least.
    fn least_multipliers(&self, y: &Coordinates, face: usize, held: &[usize]) -> Vec<f64> {
        let gradients = self.gradients(&self.frame(y).0, face, held);
        let sizes: Vec<f64> = gradients.iter().map(|g| g.norm()).collect();
        let units = DMatrix::from_fn(5, gradients.len(), |k, e| gradients[e][k] / sizes[e]);
        let right = DVector::from_column_slice((-y).as_slice());
        let solved = (units.transpose() * &units).full_piv_lu().solve(&(units.transpose() * right));
        solved.map_or(vec![0.0; sizes.len()], |m| m.iter().zip(&sizes).map(|(m, s)| m / s).collect())
    }

    fn newton(&self, start: Coordinates, face: usize, held: &[usize]) -> Result<Newton, SolverFailure> {
        let equations = face * (face + 1) / 2 + held.len();
        let none =
            Newton { y: Coordinates::zeros(), z: Matrix3::zeros(), held: Vec::new(), gradients: Vec::new() };
        if equations == 0 {
            return Ok(none);
        }
        let mut y = start;
        // Z is kept in sensor axes: where two moments agree, their axes differ from step to step
        let mut z = multiplier(&self.frame(&start).0, face, &self.least_multipliers(&start, face, held));
        let mut newton = none;
        for _ in 0..12 {
            let (v, moments) = self.frame(&y);
            let gradients = self.gradients(&v, face, held);
            let mut values = Vec::with_capacity(equations);
            for (a, moment) in moments.iter().take(face).enumerate() {
                values.extend((0..=a).map(|b| if a == b { moment - LARGEST_SHARE } else { 0.0 }));
            }
            values.extend(held.iter().map(|&k| self.rows[k].0.base + self.rows[k].0.g.dot(&y)));
            // curvature of the eigenvalues: they repel those off the face
            let mut hessian = Form::identity();
            let frame = Matrix3::from_columns(&v);
            let inner = frame.transpose() * z * frame;
            for (a, b, j) in
                (0..face).flat_map(|a| (0..face).flat_map(move |b| (face..3).map(move |j| (a, b, j))))
            {
                let (ga, gb) = (self.reading(&v[a], &v[j]).g, self.reading(&v[b], &v[j]).g);
                hessian += (ga * gb.transpose() + gb * ga.transpose())
                    * (inner[(a, b)] / (LARGEST_SHARE - moments[j]));
            }
            let n = 5 + equations;
            let mut matrix = DMatrix::zeros(n, n);
            matrix.view_mut((0, 0), (5, 5)).copy_from(&hessian);
            let mut right = DVector::zeros(n);
            right.rows_mut(0, 5).copy_from(&-y);
            // rows of unit size: gradients span many decades
            let sizes: Vec<f64> = gradients.iter().map(|g| g.norm()).collect();
            for (e, g) in gradients.iter().enumerate() {
                for k in 0..5 {
                    matrix[(5 + e, k)] = g[k] / sizes[e];
                    matrix[(k, 5 + e)] = g[k] / sizes[e];
                }
                right[5 + e] = -values[e] / sizes[e];
            }
            let step = matrix.full_piv_lu().solve(&right).ok_or(SolverFailure::Dependent)?;
            let move_ = Coordinates::from_column_slice(&step.as_slice()[..5]);
            y += move_;
            let multipliers: Vec<f64> = (0..equations).map(|e| step[5 + e] / sizes[e]).collect();
            z = multiplier(&v, face, &multipliers);
            newton = Newton { y, z, held: multipliers[face * (face + 1) / 2..].to_vec(), gradients };
            if move_.norm() <= 1e-15 * (1.0 + y.norm()) {
                break;
            }
        }
        Ok(newton)
    }

    fn certify(
        &self,
        newton: Newton,
        face: usize,
        held: &[usize],
        rounds: usize,
        limits: &[Limit],
    ) -> Result<Nearest, SolverFailure> {
        let y = newton.y;
        let (_, moments) = self.frame(&y);
        let mut gradient = y + self.gradient(&coordinates(&newton.z));
        let mut violation = (moments[0] - LARGEST_SHARE).max(0.0);
        for (k, (row, ..)) in self.rows.iter().enumerate() {
            violation = violation.max(row.base + row.g.dot(&y));
            if let Some(at) = held.iter().position(|&h| h == k) {
                gradient += row.g * newton.held[at];
            }
        }
        let (z, _) = eigen(newton.z);
        violation = violation.max(
            (newton.z * (Matrix3::identity() * LARGEST_SHARE - self.tensor(&y))).norm()
                / (1.0 + newton.largest()),
        );
        let lowest = newton.held.iter().copied().fold(z[0].min(0.0), f64::min);
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
        if face > 0 {
            let constraint = if face == 1 { Constraint::Triangle } else { Constraint::Rod };
            active.push(ActiveConstraint { constraint, multiplier: newton.z.trace() });
        }
        for (&k, &multiplier) in held.iter().zip(&newton.held) {
            let (_, limit, upper) = self.rows[k];
            active.push(ActiveConstraint { constraint: side(limit, &limits[limit], upper), multiplier });
        }
        let mut x = self.centre + self.root.solve_upper_triangular(&y).unwrap_or(Coordinates::zeros());
        if face > 0 {
            // the last rounding goes towards the sphere: the tensor handed out is physical, not nearly so
            x *= ((LARGEST_SHARE - 1.0 / 3.0) / (moments[0] - 1.0 / 3.0)).min(1.0) * (1.0 - 1e-14);
        }
        Ok(Nearest { x, active, face: newton.gradients, certificate })
    }
}

/// Z in sensor axes from the multipliers of its lower triangle along the axes `v`.
fn multiplier(v: &[Vector3<f64>; 3], face: usize, multipliers: &[f64]) -> Matrix3<f64> {
    let pairs = (0..face).flat_map(|a| (0..=a).map(move |b| (a, b)));
    pairs.zip(multipliers).fold(Matrix3::zeros(), |z, ((a, b), &m)| {
        z + (v[a] * v[b].transpose() + v[b] * v[a].transpose()) * (0.5 * m)
    })
}

struct Newton {
    y: Coordinates,
    /// Multiplier of the physical law, in sensor axes.
    z: Matrix3<f64>,
    /// Multipliers of the limits that are held.
    held: Vec<f64>,
    gradients: Vec<Coordinates>,
}

impl Newton {
    fn largest(&self) -> f64 {
        self.held.iter().copied().fold(self.z.amax(), |m, h| m.max(h.abs()))
    }
}
