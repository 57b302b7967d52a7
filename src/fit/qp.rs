//! The nearest physical tensor, by a quadratic program in whitened increments.
//!
//! x = x̂ + R⁻¹ y with Rᵀ R the information, so that the objective is ½|y|² whatever the conditioning: in raw entries
//! a solver stops at its tolerance long before the badly determined directions have settled. With trace 1 the one
//! physical law is λ_max(J) ≤ ½; it enters as rows vᵀ J v ≤ ½ along principal axes that break it, of x̂ and of each answer,
//! and as second-order cones (2×2 minors of ½ − J in the eigenbasis of the last answer), added until the violation is
//! at most 1e-9.
//! Newton's method on the active face then takes the answer to rounding, and its optimality is certified here, not by
//! the solver's status.
//!
//! | here | meaning |
//! |---|---|
//! | y | increments in standard deviations |
//! | g | gradient of a linear reading of J with respect to y |
//! | Z | multiplier of ½ − J ⪰ 0 on its null space |

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::conic::Conditions;
use super::coordinates::{Coordinates, Form, coordinates, eigen, pair, tensor};
use super::error::FitError;
use super::limits::{Bound, check_bounds, describe, feasible};

/// The largest share of the trace that a moment can have: the other two together are not less.
pub(super) const LIMIT: f64 = 0.5;
/// Violation of the law that ends the cuts.
const VIOLATION: f64 = 1e-9;
/// Rounds of cuts; hard random problems took at most 13.
pub(super) const CUTS: usize = 40;
/// Largest violation, complementarity and negative multiplier of a certified answer.
const CERTIFIED: f64 = 1e-9;
/// Its largest residual of stationarity: a millionth of a standard deviation. Conditions of 1e10 reach no further.
const STATIONARY: f64 = 1e-6;

/// What the solver's answer was checked against: largest residuals of the optimality conditions, in whitened units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// |y + Σ multiplier · gradient| over 1 + |y|.
    pub stationarity: f64,
    /// Largest violation of a constraint, and |Z (½ − J)| over 1 + the largest multiplier, as shares of the trace.
    pub violation: f64,
    /// Most negative multiplier, over 1 + the largest.
    pub dual_violation: f64,
    /// Rounds of cuts until the physical law held.
    pub rounds: usize,
}

/// A constraint that holds the answer, with its multiplier: the decrease of χ²/2 per unit of its relaxation.
#[derive(Clone, Debug, PartialEq)]
pub struct ActiveConstraint {
    /// The constraint in words.
    pub name: String,
    /// Its multiplier, ≥ 0.
    pub multiplier: f64,
}

/// The answer of the program.
pub(super) struct Nearest {
    pub(super) x: Coordinates,
    pub(super) active: Vec<ActiveConstraint>,
    /// Gradients of the active constraints in whitened increments.
    pub(super) face: Vec<Coordinates>,
    pub(super) certificate: Certificate,
}

/// A reading base + g·y that must not be positive.
#[derive(Clone, Copy)]
struct Row {
    base: f64,
    g: Coordinates,
}

/// min ½|y|² over the physical tensors x̂ + R⁻¹ y that obey the bounds.
struct Program {
    centre: Coordinates,
    root: Form,
    rows: Vec<(Row, usize, bool)>,
}

/// The physical tensor within `bounds` that is nearest to `centre` in the metric of `root`ᵀ `root`.
pub(super) fn nearest(centre: Coordinates, root: Form, bounds: &[Bound]) -> Result<Nearest, FitError> {
    check_bounds(bounds)?;
    let mut program = Program { centre, root, rows: Vec::new() };
    for (k, bound) in bounds.iter().enumerate() {
        let n = bound.axis.normalize();
        let share = program.reading(&n, &n);
        // of bounds about one axis the tighter one, since two of them could not be told apart
        let twins =
            || bounds.iter().enumerate().filter(|(_, b)| b.axis.normalize().dot(&n).abs() > 1.0 - 1e-12);
        let tighter = |of: fn(&Bound) -> Option<f64>, sign: f64| {
            let value = of(bound)?;
            let outdoes = |(i, b): (usize, &Bound)| {
                of(b).is_some_and(|other| sign * other > sign * value || (other == value && i < k))
            };
            (!twins().any(outdoes)).then_some(value)
        };
        // what the law says anyway would only stand beside it
        if let Some(low) = tighter(|b| b.at_least, 1.0).filter(|low| *low > 0.0) {
            program.rows.push((Row { base: low - share.base, g: -share.g }, k, false));
        }
        if let Some(high) = tighter(|b| b.at_most, -1.0).filter(|high| *high < LIMIT) {
            program.rows.push((Row { base: share.base - high, g: share.g }, k, true));
        }
    }
    if !bounds.is_empty() {
        feasible(bounds)?;
    }
    let (y, rounds) = program.cut()?;
    program.polish(y, rounds, bounds)
}

impl Program {
    /// vᵀ J w.
    fn reading(&self, v: &Vector3<f64>, w: &Vector3<f64>) -> Row {
        let p = pair(v, w);
        Row { base: v.dot(w) / 3.0 + self.centre.dot(&p), g: self.gradient(&p) }
    }

    /// The gradient with respect to y of the reading p·x.
    fn gradient(&self, p: &Coordinates) -> Coordinates {
        self.root.transpose().solve_lower_triangular(p).unwrap_or(Coordinates::zeros())
    }

    fn tensor(&self, y: &Coordinates) -> Matrix3<f64> {
        let step = self.root.solve_upper_triangular(y).unwrap_or(Coordinates::zeros());
        tensor(&(self.centre + step))
    }

    /// Clarabel, with cuts until law and bounds hold.
    ///
    /// A wall enters when an answer lies beyond it, so that none is further away than the answer: walls at 1e5 standard
    /// deviations would end the solver's progress at answers of one.
    fn cut(&self) -> Result<(Coordinates, usize), FitError> {
        let mut y = Coordinates::zeros();
        let mut rows: Vec<Row> = Vec::new();
        let mut cones: Vec<[Row; 3]> = Vec::new();
        let mut last = f64::INFINITY;
        for round in 0..=CUTS {
            let (moments, v) = eigen(self.tensor(&y));
            let beyond = |row: &Row| row.base + row.g.dot(&y);
            let violated: Vec<Row> =
                self.rows.iter().map(|(row, ..)| *row).filter(|r| beyond(r) > VIOLATION).collect();
            let violation = violated.iter().map(beyond).fold(moments[2] - LIMIT, f64::max);
            // where the solver's own accuracy ends the descent, Newton's method and the certificate take over
            if violation <= VIOLATION || (round > 0 && violation <= 1e-5 && violation > 0.5 * last) {
                return Ok((y, round));
            }
            last = violation;
            rows.extend(violated);
            let walls: Vec<Row> = (0..3)
                .filter(|&k| moments[k] > LIMIT + VIOLATION)
                .map(|k| v.column(k).into_owned())
                .map(|v| self.reading(&v, &v))
                .map(|r| Row { base: r.base - LIMIT, g: r.g })
                .collect();
            let new_cones = !walls.is_empty() && round > 0;
            rows.extend(walls);
            // the answer is at least as far away as the furthest wall that it must reach
            let distance = |r: &Row| r.base / r.g.norm();
            let scale = rows.iter().map(distance).filter(|d| d.is_finite()).fold(0.0, f64::max);
            if scale == 0.0 {
                return Ok((y, round));
            }
            if new_cones {
                cones.extend((0..2).map(|k| self.minor(&v, &moments, k, scale)));
            }
            let mut conditions = Conditions::new(5);
            for row in &rows {
                let size = row.g.norm();
                if size > 0.0 {
                    conditions.nonnegative((row.g / size).as_slice(), -row.base / size / scale);
                }
            }
            for cone in &cones {
                let size = cone.iter().map(|r| r.g.norm()).fold(0.0, f64::max);
                conditions.second_order(cone.map(|r| ((r.g / size), r.base / size / scale)));
            }
            let answer = conditions.solve(&[1.0; 5], &[0.0; 5])?;
            y = Coordinates::from_column_slice(&answer) * scale;
        }
        Err(FitError::Solver { status: format!("the physical law is not met after {CUTS} rounds of cuts") })
    }

    /// The minor [½ − a, −c; −c, ½ − b] ⪰ 0 of the largest and the k-th axis as a cone: p + q ≥ |(q − p, 2c)| with
    /// p = (½ − a)/w, q = (½ − b) w, where w makes both of one size at answers of the size `scale`.
    fn minor(&self, v: &Matrix3<f64>, moments: &Vector3<f64>, k: usize, scale: f64) -> [Row; 3] {
        let (top, other) = (v.column(2).into_owned(), v.column(k).into_owned());
        let (a, b, c) = (self.reading(&top, &top), self.reading(&other, &other), self.reading(&top, &other));
        let small = a.g.norm() * scale;
        let large = (LIMIT - moments[k]).max(b.g.norm() * scale);
        let w = (small / large).sqrt();
        let p = Row { base: (LIMIT - a.base) / w, g: -a.g / w };
        let q = Row { base: (LIMIT - b.base) * w, g: -b.g * w };
        [
            Row { base: p.base + q.base, g: p.g + q.g },
            Row { base: q.base - p.base, g: q.g - p.g },
            Row { base: 2.0 * c.base, g: c.g * 2.0 },
        ]
    }

    /// Newton's method on the face that the solver's answer lies on, and the certificate.
    fn polish(&self, start: Coordinates, rounds: usize, bounds: &[Bound]) -> Result<Nearest, FitError> {
        let near = 1e-4 * (1.0 + start.norm());
        let (moments, axes) = eigen(self.tensor(&start));
        let distance = |k: usize| {
            let v = axes.column(k).into_owned();
            (LIMIT - moments[k]) / self.reading(&v, &v).g.norm()
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
                // of constraints that depend on each other, as the sides of a narrow bound, the furthest is not reached
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
                _ => return self.certify(newton, face, &held, rounds, bounds),
            }
        }
    }

    /// Principal axes and moments at `y`, descending.
    fn frame(&self, y: &Coordinates) -> ([Vector3<f64>; 3], [f64; 3]) {
        let (moments, axes) = eigen(self.tensor(y));
        (core::array::from_fn(|k| axes.column(2 - k).into_owned()), [moments[2], moments[1], moments[0]])
    }

    /// Gradients of the entries of J on the face, then of the bounds that are held.
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

    fn newton(&self, start: Coordinates, face: usize, held: &[usize]) -> Result<Newton, FitError> {
        let equations = face * (face + 1) / 2 + held.len();
        if equations == 0 {
            return Ok(Newton {
                y: Coordinates::zeros(),
                z: Matrix3::zeros(),
                held: Vec::new(),
                gradients: Vec::new(),
            });
        }
        let mut y = start;
        // Z is kept in sensor axes: where two moments agree, their axes differ from step to step
        let mut z = multiplier(&self.frame(&start).0, face, &self.least_multipliers(&start, face, held));
        let mut newton = None;
        for _ in 0..12 {
            let (v, moments) = self.frame(&y);
            let gradients = self.gradients(&v, face, held);
            let mut values = Vec::with_capacity(equations);
            for (a, moment) in moments.iter().take(face).enumerate() {
                values.extend((0..=a).map(|b| if a == b { moment - LIMIT } else { 0.0 }));
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
                hessian +=
                    (ga * gb.transpose() + gb * ga.transpose()) * (inner[(a, b)] / (LIMIT - moments[j]));
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
            let step = matrix.full_piv_lu().solve(&right).ok_or_else(|| FitError::Solver {
                status: "the active constraints depend on each other".into(),
            })?;
            let move_ = Coordinates::from_column_slice(&step.as_slice()[..5]);
            y += move_;
            let multipliers: Vec<f64> = (0..equations).map(|e| step[5 + e] / sizes[e]).collect();
            z = multiplier(&v, face, &multipliers);
            newton = Some(Newton { y, z, held: multipliers[face * (face + 1) / 2..].to_vec(), gradients });
            if move_.norm() <= 1e-15 * (1.0 + y.norm()) {
                break;
            }
        }
        newton.ok_or_else(|| FitError::Solver { status: "no Newton step was taken".into() })
    }

    fn certify(
        &self,
        newton: Newton,
        face: usize,
        held: &[usize],
        rounds: usize,
        bounds: &[Bound],
    ) -> Result<Nearest, FitError> {
        let y = newton.y;
        let (_, moments) = self.frame(&y);
        let mut gradient = y + self.gradient(&coordinates(&newton.z));
        let mut violation = (moments[0] - LIMIT).max(0.0);
        for (k, (row, ..)) in self.rows.iter().enumerate() {
            violation = violation.max(row.base + row.g.dot(&y));
            if let Some(at) = held.iter().position(|&h| h == k) {
                gradient += row.g * newton.held[at];
            }
        }
        let (z, _) = eigen(newton.z);
        violation = violation.max(
            (newton.z * (Matrix3::identity() * LIMIT - self.tensor(&y))).norm() / (1.0 + newton.largest()),
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
            return Err(FitError::Solver {
                status: format!(
                    "the answer is not optimal: stationarity {:.1e}, violation {:.1e}, multiplier {:.1e}",
                    certificate.stationarity, certificate.violation, certificate.dual_violation
                ),
            });
        }
        let mut active = Vec::new();
        if face > 0 {
            let name = if face == 1 { "I1 + I2 >= I3" } else { "I1 + I2 >= I3 and I1 + I3 >= I2 (a rod)" };
            active.push(ActiveConstraint { name: name.into(), multiplier: newton.z.trace() });
        }
        for (&k, &multiplier) in held.iter().zip(&newton.held) {
            let (_, bound, upper) = self.rows[k];
            active.push(ActiveConstraint { name: describe(bound, &bounds[bound], upper), multiplier });
        }
        let mut x = self.centre + self.root.solve_upper_triangular(&y).unwrap_or(Coordinates::zeros());
        if face > 0 {
            // the last rounding goes towards the sphere: the tensor handed out is physical, not nearly so
            x *= ((LIMIT - 1.0 / 3.0) / (moments[0] - 1.0 / 3.0)).min(1.0) * (1.0 - 1e-14);
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
    /// Multipliers of the bounds that are held.
    held: Vec<f64>,
    gradients: Vec<Coordinates>,
}

impl Newton {
    fn largest(&self) -> f64 {
        self.held.iter().copied().fold(self.z.amax(), |m, h| m.max(h.abs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::coordinates::basis;

    /// Uniform on (−1, 1), from a linear congruence.
    fn numbers(mut state: u64) -> impl FnMut() -> f64 {
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        }
    }

    #[test]
    fn a_physical_centre_is_its_own_answer() {
        let centre = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45)));
        let answer = nearest(centre, Form::identity() * 1e3, &[]).unwrap();
        assert_eq!(answer.x, centre);
        assert!(answer.active.is_empty());
    }

    #[test]
    fn with_the_identity_as_metric_the_answer_is_the_clipped_spectrum() {
        // eigenvalues (0.05, 0.25, 0.7): the nearest with trace 1 and λ ≤ ½ shares the excess equally among the others
        let centre = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.05, 0.25, 0.7)));
        let answer = nearest(centre, Form::identity() * 1e4, &[]).unwrap();
        let expected = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.15, 0.35, 0.5)));
        assert!((answer.x - expected).norm() < 1e-14, "{}", (answer.x - expected).norm());
        assert_eq!(answer.active.len(), 1);
        // two eigenvalues above: both end at ½, and the third is nothing: a rod
        let centre = coordinates(&Matrix3::from_diagonal(&Vector3::new(-0.4, 0.65, 0.75)));
        let answer = nearest(centre, Form::identity() * 1e4, &[]).unwrap();
        let expected = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.0, 0.5, 0.5)));
        assert!((answer.x - expected).norm() < 1e-14);
        assert!(answer.active[0].name.contains("rod"));
    }

    /// Every answer is certified inside; here hard metrics (condition up to 1e8 and more) and centres far outside the cone.
    #[test]
    fn hard_random_programs_end_certified_and_no_feasible_tensor_is_nearer() {
        let mut next = numbers(4);
        let mut held = 0;
        for trial in 0..300 {
            let mut root = Form::from_fn(|i, k| if i < k { next() } else { 0.0 });
            for k in 0..5 {
                root[(k, k)] = libm::pow(10.0, 2.5 + 2.0 * next());
            }
            let centre = Coordinates::from_fn(|_, _| 0.5 * next());
            let answer = nearest(centre, root, &[]).unwrap_or_else(|error| panic!("{trial}: {error}"));
            let (moments, _) = eigen(tensor(&answer.x));
            assert!(moments[2] <= LIMIT + 1e-12 && moments[0] >= -1e-12, "{trial}: {moments}");
            held += answer.active.len();
            let cost = (root * (answer.x - centre)).norm();
            for _ in 0..20 {
                // a step towards any physical tensor stays physical, and must not help
                let other = Coordinates::from_fn(|_, _| 0.06 * next());
                let step = answer.x + (other - answer.x) * 1e-5;
                assert!((root * (step - centre)).norm() >= cost * (1.0 - 1e-13), "{trial}");
            }
        }
        assert!(held > 100);
    }

    /// A flat body well measured: the law is a hair's breadth away, the other walls 1e5 standard deviations.
    #[test]
    fn remote_walls_do_not_stop_the_solver() {
        let mut next = numbers(31);
        for trial in 0..200 {
            let mut root = Form::from_fn(|i, k| if i < k { 1e4 * next() } else { 0.0 });
            for k in 0..5 {
                root[(k, k)] = libm::pow(10.0, 5.5 + 1.5 * next());
            }
            let (a, b) = (0.2 + 0.05 * next(), 1e-6 * next().abs());
            let flat = Matrix3::from_diagonal(&Vector3::new(a, 0.5 - a - b, 0.5 + b));
            let centre = coordinates(&flat) + Coordinates::from_fn(|_, _| 1e-6 * next());
            let answer = nearest(centre, root, &[]).unwrap_or_else(|error| panic!("{trial}: {error}"));
            assert!(eigen(tensor(&answer.x)).0[2] <= LIMIT, "{trial}");
        }
    }

    #[test]
    fn the_answer_turns_with_the_axes() {
        let turn = *nalgebra::Rotation3::from_axis_angle(&Vector3::y_axis(), 0.7).matrix()
            * nalgebra::Rotation3::from_axis_angle(&Vector3::x_axis(), -1.1).matrix();
        let map = Form::from_fn(|i, k| basis(i).dot(&(turn * basis(k) * turn.transpose())));
        let mut next = numbers(11);
        for _ in 0..20 {
            let root = Form::from_fn(|i, k| {
                if i < k {
                    next()
                } else if i == k {
                    5.0 + 4.0 * next()
                } else {
                    0.0
                }
            }) * 100.0;
            let centre = Coordinates::from_fn(|_, _| 0.4 * next());
            let a = nearest(centre, root, &[]).unwrap();
            let turned = (root * map.transpose()).qr().r();
            let b = nearest(map * centre, turned, &[]).unwrap();
            assert!((map * a.x - b.x).norm() < 1e-13, "{:e}", (map * a.x - b.x).norm());
        }
    }

    #[test]
    fn bounds_hold_and_contradictions_are_named() {
        let centre = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.2, 0.35, 0.45)));
        let root = Form::identity() * 100.0;
        let x = |at_least, at_most| Bound { axis: Vector3::x(), at_least, at_most };
        let answer = nearest(centre, root, &[x(Some(0.25), None)]).unwrap();
        assert!((tensor(&answer.x)[(0, 0)] - 0.25).abs() < 1e-15);
        assert!(answer.active[0].name.starts_with("bound 1"), "{:?}", answer.active);
        assert!(answer.active[0].multiplier > 0.0);

        let clash =
            nearest(centre, root, &[x(Some(0.4), None), x(None, Some(0.3))]).err().unwrap().to_string();
        assert!(clash.contains("bound 1") && clash.contains("bound 2"), "{clash}");
        let law = nearest(centre, root, &[x(Some(0.6), None)]).err().unwrap().to_string();
        assert!(law.contains("half the trace"), "{law}");

        // the same bound twice, once looser, and one that the law implies
        let twice = [x(Some(0.25), None), x(Some(0.25), None), x(Some(0.22), Some(0.5))];
        let answer = nearest(centre, root, &twice).unwrap();
        assert!((tensor(&answer.x)[(0, 0)] - 0.25).abs() < 1e-15);
        assert_eq!(answer.active.len(), 1);
        for edge in [
            &[x(Some(0.3), Some(0.3))][..],
            &[x(Some(0.3), None), x(None, Some(0.300_000_1))],
            &[x(Some(0.2), Some(0.199_999_9))],
            &[x(Some(0.5), None)],
            &[x(None, Some(0.0))],
        ] {
            let error = nearest(centre, root, edge).err().unwrap();
            assert!(matches!(error, FitError::NoRoom(_)), "{error}");
        }
        let outside = nearest(centre, root, &[x(Some(5000.0), None)]).err().unwrap().to_string();
        assert!(outside.contains("bound 1 is 5000"), "{outside}");
    }
}
