//! The program min ½|y|², and its answer by the solver with cuts.

use crate::thresholds::program::{SHARE, STALLED, VIOLATION};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use crate::physical::conic::Conditions;
use crate::physical::constraint::Constraint;
use crate::physical::coordinates::{basis, eigen, symmetric};
use crate::physical::dissipation::Dissipation;
use crate::physical::failure::SolverFailure;
use crate::physical::law::LARGEST_SHARE;
use crate::thresholds::program::CUTS;

/// A reading base + g·y that must not be positive.
#[derive(Clone)]
pub(super) struct Row {
    pub(super) base: f64,
    pub(super) g: DVector<f64>,
}

impl Row {
    pub(super) fn at(&self, y: &DVector<f64>) -> f64 {
        self.base + self.g.dot(y)
    }
}

/// A symmetric matrix base + Σ z_k B_k of the unknowns z whose eigenvalues must not exceed `most`.
pub(super) struct Wall {
    base: Matrix3<f64>,
    terms: Vec<(usize, Matrix3<f64>)>,
    pub(super) most: f64,
}

impl Wall {
    /// No moment exceeds half the trace; `first` is the place of the five coordinates of the tensor.
    pub(super) fn law(first: usize) -> Wall {
        Wall {
            base: Matrix3::identity() / 3.0,
            terms: (0..5).map(|k| (first + k, basis(k))).collect(),
            most: LARGEST_SHARE,
        }
    }

    /// No moment of a body exceeds the sum of the others: M = T − ½ tr T of T = `base` + Σ z_k E_k, whose six entries
    /// xx, yy, zz, xy, xz, yz begin at `first`.
    pub(super) fn body(first: usize, base: &Matrix3<f64>) -> Wall {
        let less = |t: Matrix3<f64>| t - Matrix3::identity() * (0.5 * t.trace());
        Wall {
            base: less(*base),
            terms: (0..6).map(|k| (first + k, less(symmetric(k)))).collect(),
            most: 0.0,
        }
    }

    fn value(&self, z: &DVector<f64>) -> Matrix3<f64> {
        self.terms.iter().fold(self.base, |sum, (k, b)| sum + b * z[*k])
    }
}

/// min ½|y|² over the unknowns ẑ + R⁻¹ y that obey rows and walls.
pub(super) struct Program {
    pub(super) centre: DVector<f64>,
    /// Upper triangular.
    pub(super) root: DMatrix<f64>,
    /// The physical law first.
    pub(super) walls: Vec<Wall>,
    /// Whether the last five unknowns are the coordinates of a shape, whose law is the first wall.
    pub(super) has_shape: bool,
    /// Each with what it says, and the units of that in one of the row.
    pub(super) rows: Vec<(Row, Constraint, f64)>,
}

impl Program {
    /// Without rows but those by which drag takes energy.
    pub(super) fn new(centre: DVector<f64>, root: DMatrix<f64>, dissipation: &[Dissipation]) -> Program {
        let law = Wall::law(centre.len() - 5);
        let mut program = Program { centre, root, walls: vec![law], has_shape: true, rows: Vec::new() };
        for of in dissipation {
            let unit = program.deviation(of.place) / SHARE;
            let mut p = DVector::zeros(program.centre.len());
            p[of.place] = -1.0 / unit;
            let row = Row { base: p.dot(&program.centre), g: program.gradient(&p) };
            program.rows.push((row, of.constraint(), unit));
        }
        program
    }

    /// Of bodies in kg m², or any unit: the places of their first entries, and what is added to them.
    pub(super) fn of_bodies(
        centre: DVector<f64>,
        root: DMatrix<f64>,
        bodies: &[(usize, Matrix3<f64>)],
    ) -> Program {
        let walls = bodies.iter().map(|(first, base)| Wall::body(*first, base)).collect();
        Program { centre, root, walls, has_shape: false, rows: Vec::new() }
    }

    /// The standard deviation of an unknown.
    fn deviation(&self, place: usize) -> f64 {
        let mut p = DVector::zeros(self.centre.len());
        p[place] = 1.0;
        self.gradient(&p).norm()
    }

    /// vᵀ M w of a wall.
    pub(super) fn reading(&self, wall: &Wall, v: &Vector3<f64>, w: &Vector3<f64>) -> Row {
        let mut p = DVector::zeros(self.centre.len());
        for (k, b) in &wall.terms {
            p[*k] = v.dot(&(b * w));
        }
        Row { base: v.dot(&(wall.base * w)) + self.centre.dot(&p), g: self.gradient(&p) }
    }

    /// The gradient of tr(Z M) of a wall.
    pub(super) fn push(&self, wall: &Wall, z: &Matrix3<f64>) -> DVector<f64> {
        let mut p = DVector::zeros(self.centre.len());
        for (k, b) in &wall.terms {
            p[*k] = b.dot(z);
        }
        self.gradient(&p)
    }

    /// The gradient with respect to y of the reading p·z.
    pub(super) fn gradient(&self, p: &DVector<f64>) -> DVector<f64> {
        self.root.transpose().solve_lower_triangular(p).unwrap_or_else(|| DVector::zeros(p.len()))
    }

    /// The unknowns at `y`.
    pub(super) fn unknowns(&self, y: &DVector<f64>) -> DVector<f64> {
        let step = self.root.solve_upper_triangular(y).unwrap_or_else(|| DVector::zeros(y.len()));
        &self.centre + step
    }

    /// The matrix of a wall at `y`.
    pub(super) fn matrix(&self, wall: &Wall, y: &DVector<f64>) -> Matrix3<f64> {
        wall.value(&self.unknowns(y))
    }

    /// The answer of Clarabel, with cuts added until the law and the limits are met.
    ///
    /// A cut is added only when violated, so that no cut is farther away than the current iterate: next to cuts at 1e5
    /// standard deviations the solver would not resolve answers at one.
    pub(super) fn cut(&self) -> Result<(DVector<f64>, usize), SolverFailure> {
        let size = self.centre.len();
        let mut y = DVector::zeros(size);
        let mut rows: Vec<Row> = Vec::new();
        let mut cones: Vec<[Row; 3]> = Vec::new();
        let mut last = f64::INFINITY;
        for round in 0..=CUTS {
            let spectra: Vec<_> = self.walls.iter().map(|wall| eigen(self.matrix(wall, &y))).collect();
            let violated: Vec<Row> =
                self.rows.iter().map(|(row, ..)| row).filter(|r| r.at(&y) > VIOLATION).cloned().collect();
            let beyond = self.walls.iter().zip(&spectra).map(|(wall, (values, _))| values[2] - wall.most);
            let violation = violated.iter().map(|row| row.at(&y)).chain(beyond).fold(f64::MIN, f64::max);
            // where the solver's own accuracy ends the descent, Newton's method and the certificate take over
            if violation <= VIOLATION
                || (round > 0 && violation <= STALLED[0] && violation > STALLED[1] * last)
            {
                return Ok((y, round));
            }
            last = violation;
            rows.extend(violated);
            let mut broken = Vec::new();
            for (wall, (values, axes)) in self.walls.iter().zip(&spectra) {
                let before = rows.len();
                for k in (0..3).filter(|&k| values[k] > wall.most + VIOLATION) {
                    let v = axes.column(k).into_owned();
                    let r = self.reading(wall, &v, &v);
                    rows.push(Row { base: r.base - wall.most, g: r.g });
                }
                if rows.len() > before && round > 0 {
                    broken.push((wall, values, axes));
                }
            }
            // the answer is at least as far away as the furthest wall that it must reach
            let distance = |r: &Row| r.base / r.g.norm();
            let scale = rows.iter().map(distance).filter(|d| d.is_finite()).fold(0.0, f64::max);
            if scale == 0.0 {
                return Ok((y, round));
            }
            for (wall, values, axes) in broken {
                cones.extend((0..2).map(|k| self.minor(wall, axes, values, k, scale)));
            }
            let mut conditions = Conditions::new(size);
            for row in &rows {
                let size = row.g.norm();
                if size > 0.0 {
                    conditions.nonnegative((&row.g / size).as_slice(), -row.base / size / scale);
                }
            }
            for cone in &cones {
                let size = cone.iter().map(|r| r.g.norm()).fold(0.0, f64::max);
                conditions.second_order(cone.each_ref().map(|r| (&r.g / size, r.base / size / scale)));
            }
            let answer = conditions.solve(&vec![1.0; size], &vec![0.0; size])?;
            y = DVector::from_vec(answer) * scale;
        }
        Err(SolverFailure::Cuts { rounds: CUTS })
    }

    /// The minor [m − a, −c; −c, m − b] ⪰ 0 of the largest and the k-th axis as a cone: p + q ≥ |(q − p, 2c)| with
    /// p = (m − a)/w, q = (m − b) w, where w makes both of one size at answers of the size `scale`.
    fn minor(&self, wall: &Wall, v: &Matrix3<f64>, moments: &Vector3<f64>, k: usize, scale: f64) -> [Row; 3] {
        let (top, other) = (v.column(2).into_owned(), v.column(k).into_owned());
        let a = self.reading(wall, &top, &top);
        let b = self.reading(wall, &other, &other);
        let c = self.reading(wall, &top, &other);
        let small = a.g.norm() * scale;
        let large = (wall.most - moments[k]).max(b.g.norm() * scale);
        let w = (small / large).sqrt();
        let p = Row { base: (wall.most - a.base) / w, g: -a.g / w };
        let q = Row { base: (wall.most - b.base) * w, g: -b.g * w };
        [
            Row { base: p.base + q.base, g: &p.g + &q.g },
            Row { base: q.base - p.base, g: q.g - p.g },
            Row { base: 2.0 * c.base, g: c.g * 2.0 },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::coordinates::coordinates;

    /// A drag below zero beside a tensor of which one moment is beyond the law.
    fn program() -> Program {
        let j = Matrix3::new(0.15, 0.02, -0.01, 0.02, 0.3, 0.03, -0.01, 0.03, 0.55);
        let centre = [-0.02].into_iter().chain(coordinates(&j).iter().copied().collect::<Vec<f64>>());
        let root = DMatrix::from_fn(6, 6, |i, k| match k.checked_sub(i) {
            None => 0.0,
            Some(0) => 40.0 + i as f64,
            Some(_) => ((3 * i + 5 * k) % 7) as f64,
        });
        let of = [Dissipation { place: 0, name: "drag" }];
        Program::new(DVector::from_iterator(6, centre), root, &of)
    }

    fn increments() -> DVector<f64> {
        DVector::from_fn(6, |k, _| 0.7 - 0.3 * k as f64)
    }

    /// Readings of both kinds of walls are those of their matrices at any increments, and what pushes is the gradient of a product with it.
    #[test]
    fn readings_are_those_of_the_matrix() {
        let (program, y) = (program(), increments());
        let base = Matrix3::new(0.3, 0.0, 0.1, 0.0, -0.2, 0.0, 0.1, 0.0, 0.4);
        let (v, w) = (Vector3::new(0.3, -0.5, 0.7), Vector3::new(-0.2, 0.4, 0.9));
        let z = Matrix3::new(0.4, 0.1, 0.0, 0.1, 0.2, -0.3, 0.0, -0.3, 0.7);
        let zero = DVector::zeros(6);
        for wall in [Wall::law(1), Wall::body(0, &base)] {
            let (here, start) = (program.matrix(&wall, &y), program.matrix(&wall, &zero));
            for (v, w) in [(v, v), (v, w), (w, v)] {
                let expected = v.dot(&(here * w));
                assert!((program.reading(&wall, &v, &w).at(&y) - expected).abs() < 1e-14);
            }
            let expected = z.dot(&(here - start));
            assert!((program.push(&wall, &z).dot(&y) - expected).abs() < 1e-14);
        }
        // of a tensor T without its half trace: the entries from the first on, and what is added to them
        let own = program.unknowns(&y);
        let t = base + (0..6).fold(Matrix3::zeros(), |sum, k| sum + symmetric(k) * own[k]);
        let expected = t - Matrix3::identity() * (0.5 * t.trace());
        assert!((program.matrix(&Wall::body(0, &base), &y) - expected).amax() < 1e-15);
        assert_eq!((Wall::law(0).most, Wall::body(0, &base).most), (0.5, 0.0));
    }

    /// The cone of two axes has the square of its height less that of its width as four times the minor of ½ − J along them.
    #[test]
    fn cones_are_minors_of_what_is_left_to_the_law() {
        let program = program();
        let wall = &program.walls[0];
        let (moments, axes) = eigen(program.matrix(wall, &DVector::zeros(6)));
        for k in 0..2 {
            let cone = program.minor(wall, &axes, &moments, k, 3.0);
            for y in [increments(), increments() * -2.0, DVector::zeros(6)] {
                let here = Matrix3::identity() * 0.5 - program.matrix(wall, &y);
                let (top, other) = (axes.column(2).into_owned(), axes.column(k).into_owned());
                let (p, q) = (top.dot(&(here * top)), other.dot(&(here * other)));
                let c = top.dot(&(here * other));
                let [height, apart, across] = cone.each_ref().map(|row| row.at(&y));
                let square = height * height - apart * apart - across * across;
                assert!((square - 4.0 * (p * q - c * c)).abs() < 1e-13, "{k}: {square:e}");
                assert!((across.abs() - 2.0 * c.abs()).abs() < 1e-14, "{k}: {across:e}");
            }
        }
    }

    /// The row of a drag is minus its value in thousands of its deviations, by the inverse of the information.
    #[test]
    fn drag_is_measured_by_its_deviation() {
        let (program, y) = (program(), increments());
        let covariance = program.root.tr_mul(&program.root).try_inverse().unwrap();
        let deviation = covariance[(0, 0)].sqrt();
        assert!((program.deviation(0) / deviation - 1.0).abs() < 1e-12);
        let [(row, constraint, unit)] = &program.rows[..] else { panic!() };
        assert_eq!(*constraint, Constraint::Drag { name: "drag" });
        assert!((unit * SHARE / deviation - 1.0).abs() < 1e-12);
        assert!((row.at(&y) + program.unknowns(&y)[0] / unit).abs() < 1e-12, "{}", row.at(&y));
        assert!(row.at(&DVector::zeros(6)) > 0.0, "a drag below zero breaks the law");
    }
}
