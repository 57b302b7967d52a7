//! The program min ½|y|², and its answer by the solver with cuts.

use nalgebra::{Matrix3, Vector3};

use super::conic::Conditions;
use super::coordinates::{Coordinates, Form, eigen, pair, tensor};
use super::failure::SolverFailure;
use super::law::{CUTS, LARGEST_SHARE};

/// Violation of the law that ends the cuts.
const VIOLATION: f64 = 1e-9;

/// A reading base + g·y that must not be positive.
#[derive(Clone, Copy)]
pub(super) struct Row {
    pub(super) base: f64,
    pub(super) g: Coordinates,
}

/// min ½|y|² over the physical tensors x̂ + R⁻¹ y that obey the limits.
pub(super) struct Program {
    pub(super) centre: Coordinates,
    pub(super) root: Form,
    pub(super) rows: Vec<(Row, usize, bool)>,
}

impl Program {
    /// vᵀ J w.
    pub(super) fn reading(&self, v: &Vector3<f64>, w: &Vector3<f64>) -> Row {
        let p = pair(v, w);
        Row { base: v.dot(w) / 3.0 + self.centre.dot(&p), g: self.gradient(&p) }
    }

    /// The gradient with respect to y of the reading p·x.
    pub(super) fn gradient(&self, p: &Coordinates) -> Coordinates {
        self.root.transpose().solve_lower_triangular(p).unwrap_or(Coordinates::zeros())
    }

    pub(super) fn tensor(&self, y: &Coordinates) -> Matrix3<f64> {
        let step = self.root.solve_upper_triangular(y).unwrap_or(Coordinates::zeros());
        tensor(&(self.centre + step))
    }

    /// The answer of Clarabel, with cuts added until the law and the limits are met.
    ///
    /// A cut is added only when violated, so that no cut is farther away than the current iterate: next to cuts at 1e5
    /// standard deviations the solver would not resolve answers at one.
    pub(super) fn cut(&self) -> Result<(Coordinates, usize), SolverFailure> {
        let mut y = Coordinates::zeros();
        let mut rows: Vec<Row> = Vec::new();
        let mut cones: Vec<[Row; 3]> = Vec::new();
        let mut last = f64::INFINITY;
        for round in 0..=CUTS {
            let (moments, v) = eigen(self.tensor(&y));
            let beyond = |row: &Row| row.base + row.g.dot(&y);
            let violated: Vec<Row> =
                self.rows.iter().map(|(row, ..)| *row).filter(|r| beyond(r) > VIOLATION).collect();
            let violation = violated.iter().map(beyond).fold(moments[2] - LARGEST_SHARE, f64::max);
            // where the solver's own accuracy ends the descent, Newton's method and the certificate take over
            if violation <= VIOLATION || (round > 0 && violation <= 1e-5 && violation > 0.5 * last) {
                return Ok((y, round));
            }
            last = violation;
            rows.extend(violated);
            let walls: Vec<Row> = (0..3)
                .filter(|&k| moments[k] > LARGEST_SHARE + VIOLATION)
                .map(|k| v.column(k).into_owned())
                .map(|v| self.reading(&v, &v))
                .map(|r| Row { base: r.base - LARGEST_SHARE, g: r.g })
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
        Err(SolverFailure::Cuts { rounds: CUTS })
    }

    /// The minor [½ − a, −c; −c, ½ − b] ⪰ 0 of the largest and the k-th axis as a cone: p + q ≥ |(q − p, 2c)| with
    /// p = (½ − a)/w, q = (½ − b) w, where w makes both of one size at answers of the size `scale`.
    fn minor(&self, v: &Matrix3<f64>, moments: &Vector3<f64>, k: usize, scale: f64) -> [Row; 3] {
        let (top, other) = (v.column(2).into_owned(), v.column(k).into_owned());
        let (a, b, c) = (self.reading(&top, &top), self.reading(&other, &other), self.reading(&top, &other));
        let small = a.g.norm() * scale;
        let large = (LARGEST_SHARE - moments[k]).max(b.g.norm() * scale);
        let w = (small / large).sqrt();
        let p = Row { base: (LARGEST_SHARE - a.base) / w, g: -a.g / w };
        let q = Row { base: (LARGEST_SHARE - b.base) * w, g: -b.g * w };
        [
            Row { base: p.base + q.base, g: p.g + q.g },
            Row { base: q.base - p.base, g: q.g - p.g },
            Row { base: 2.0 * c.base, g: c.g * 2.0 },
        ]
    }
}
