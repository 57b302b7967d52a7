//! The free body that comes nearest to a record in given units.
//!
//! With rate × time f times as large as read, ω' + f J⁻¹ (ω × J ω) + k ω − a = 0, with drag k and a constant acceleration a. Its
//! residuals are linear in the sums of the record, so that products of these are all that least squares over J asks for.
//! J = tr(Σ) − Σ with Σ = L Lᵀ is every tensor that a body can have, and no other.

use nalgebra::{Matrix3, SMatrix, SVector};

use super::sums::{FEATURES, Gram};
use crate::columns::equation::crossed;
use crate::physical::coordinates::{basis, eigen, symmetric, tensor};
use crate::thresholds::units::{GAINED, RAISED, SMALLEST, STEPS};

/// L, k, a.
const UNKNOWNS: usize = 10;
type Coefficients = SMatrix<f64, 3, FEATURES>;
type Quadratic = SMatrix<f64, 3, 6>;

/// A body that was fitted to a record in one unit.
#[derive(Clone, Debug)]
pub(super) struct FreeBody {
    root: Matrix3<f64>,
    drag: f64,
    constant: [f64; 3],
    /// Sum of squares of what it leaves of the derivatives.
    pub(super) squares: f64,
}

/// ω × J ω by the entries of ω ωᵀ.
fn products(j: &Matrix3<f64>) -> Quadratic {
    let mut of = Quadratic::zeros();
    (0..6).for_each(|k| of.set_column(k, &crossed(&symmetric(k), j)));
    of
}

/// tr(Σ) − Σ, and back by half of it.
fn turned(sigma: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::from_diagonal_element(sigma.trace()) - sigma
}

impl FreeBody {
    /// The best of those that least squares reach from J by linear equations, and from the sphere.
    pub(super) fn nearest(gram: &Gram, factor: f64) -> Option<FreeBody> {
        let starts = [linear(gram, factor), Some(Matrix3::identity() / 3.0)];
        let bodies =
            starts.into_iter().flatten().filter_map(|j| FreeBody::known(&j)?.descended(gram, factor));
        bodies.min_by(|a, b| a.squares.total_cmp(&b.squares))
    }

    /// The same from this body on.
    pub(super) fn descended(mut self, gram: &Gram, factor: f64) -> Option<FreeBody> {
        let mut damping = 1e-3;
        self.squares = self.squares_by(gram, factor)?;
        for _ in 0..STEPS {
            let own = self.coefficients(factor)? * gram;
            let slopes = self.slopes(factor)?;
            let weighted = slopes.map(|slope| slope * gram);
            let mut normal = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::from_fn(|i, k| weighted[i].dot(&slopes[k]));
            let gradient = SVector::<f64, UNKNOWNS>::from_fn(|i, _| slopes[i].dot(&own));
            let scale = normal.diagonal();
            let least = scale.max() * f64::EPSILON;
            (0..UNKNOWNS).for_each(|k| normal[(k, k)] += damping * scale[k] + least);
            let next =
                normal.cholesky().and_then(|normal| self.moved(&-normal.solve(&gradient), gram, factor));
            match next.filter(|next| next.squares < self.squares) {
                Some(next) => {
                    let gained = self.squares - next.squares;
                    let done = gained <= GAINED * next.squares;
                    self = next;
                    damping *= 0.1;
                    if done {
                        break;
                    }
                }
                None if damping > RAISED => break,
                None => damping *= 10.0,
            }
        }
        self.squares.is_finite().then_some(self)
    }

    /// A known body that nothing but its motion drives.
    pub(super) fn known(j: &Matrix3<f64>) -> Option<FreeBody> {
        let sigma = Matrix3::from_diagonal_element(0.5 * j.trace()) - j;
        let (values, axes) = eigen(sigma);
        let values = values.map(|value| value.max(SMALLEST * j.trace()));
        let root = (axes * Matrix3::from_diagonal(&values) * axes.transpose()).cholesky()?.l();
        Some(FreeBody { root, drag: 0.0, constant: [0.0; 3], squares: f64::INFINITY })
    }

    /// What it leaves by other weights.
    pub(super) fn squares_by(&self, gram: &Gram, factor: f64) -> Option<f64> {
        let coefficients = self.coefficients(factor)?;
        Some(inner(&coefficients, &coefficients, gram))
    }

    fn tensor(&self) -> Matrix3<f64> {
        turned(&(self.root * self.root.transpose()))
    }

    fn coefficients(&self, factor: f64) -> Option<Coefficients> {
        let j = self.tensor();
        let motion = j.try_inverse()? * products(&j) * factor;
        let mut of = Coefficients::zeros();
        of.fixed_view_mut::<3, 6>(0, 3).copy_from(&motion);
        for p in 0..3 {
            (of[(p, p)], of[(p, 9 + p)], of[(p, 12)]) = (1.0, self.drag, -self.constant[p]);
        }
        Some(of)
    }

    /// Their derivatives by the unknowns.
    fn slopes(&self, factor: f64) -> Option<[Coefficients; UNKNOWNS]> {
        let j = self.tensor();
        let inverse = j.try_inverse()?;
        let motion = inverse * products(&j);
        Some(core::array::from_fn(|k| {
            let mut of = Coefficients::zeros();
            match k {
                0..6 => {
                    let (row, column) = ENTRIES_OF_ROOT[k];
                    let mut change = Matrix3::zeros();
                    change[(row, column)] = 1.0;
                    let change = change * self.root.transpose();
                    let change = turned(&(change + change.transpose()));
                    let own = inverse * (products(&change) - change * motion) * factor;
                    of.fixed_view_mut::<3, 6>(0, 3).copy_from(&own);
                }
                6 => (0..3).for_each(|p| of[(p, 9 + p)] = 1.0),
                _ => of[(k - 7, 12)] = -1.0,
            }
            of
        }))
    }

    fn moved(&self, step: &SVector<f64, UNKNOWNS>, gram: &Gram, factor: f64) -> Option<FreeBody> {
        let mut next = self.clone();
        for (k, (row, column)) in ENTRIES_OF_ROOT.into_iter().enumerate() {
            next.root[(row, column)] += step[k];
        }
        // the size of the tensor says nothing
        next.root /= next.root.norm();
        next.drag += step[6];
        (0..3).for_each(|p| next.constant[p] += step[7 + p]);
        next.squares = next.squares_by(gram, factor)?;
        Some(next)
    }
}

/// Rows and columns of L.
const ENTRIES_OF_ROOT: [(usize, usize); 6] = [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)];

fn inner(a: &Coefficients, b: &Coefficients, gram: &Gram) -> f64 {
    (a * gram).dot(b)
}

/// The tensor of least squares in J ω' + f ω × J ω − τ = 0, which is linear in it.
fn linear(gram: &Gram, factor: f64) -> Option<Matrix3<f64>> {
    let of = |j: &Matrix3<f64>| {
        let mut coefficients = Coefficients::zeros();
        coefficients.fixed_view_mut::<3, 3>(0, 0).copy_from(j);
        coefficients.fixed_view_mut::<3, 6>(0, 3).copy_from(&(products(j) * factor));
        coefficients
    };
    let origin = of(&(Matrix3::identity() / 3.0));
    let slopes: [Coefficients; 8] = core::array::from_fn(|k| match k {
        0..5 => of(&basis(k)),
        _ => {
            let mut constant = Coefficients::zeros();
            constant[(k - 5, 12)] = -1.0;
            constant
        }
    });
    let normal = SMatrix::<f64, 8, 8>::from_fn(|i, k| inner(&slopes[i], &slopes[k], gram));
    let gradient = SVector::<f64, 8>::from_fn(|i, _| inner(&slopes[i], &origin, gram));
    let solved = normal.cholesky()?.solve(&-gradient);
    Some(tensor(&solved.fixed_rows::<5>(0).into_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_moves_every_unknown() {
        let body = FreeBody::known(&Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, 2.0, 2.5))).unwrap();
        let step = SVector::from_fn(|k, _| 0.001 * (k + 1) as f64);
        let moved = body.moved(&step, &Gram::identity(), 1.0).unwrap();
        assert!((moved.root.norm() - 1.0).abs() < 1e-15);
        let size = (body.root + {
            let mut change = Matrix3::zeros();
            ENTRIES_OF_ROOT.iter().enumerate().for_each(|(k, entry)| change[*entry] = step[k]);
            change
        })
        .norm();
        for (k, entry) in ENTRIES_OF_ROOT.into_iter().enumerate() {
            assert!((moved.root[entry] * size - body.root[entry] - step[k]).abs() < 1e-15, "{k}");
        }
        assert_eq!((moved.drag, moved.constant), (step[6], [step[7], step[8], step[9]]));
    }

    fn example() -> FreeBody {
        let j = Matrix3::new(0.2, 0.01, -0.02, 0.01, 0.35, 0.03, -0.02, 0.03, 0.45);
        let body = FreeBody::known(&j).unwrap();
        assert!((body.tensor() / body.tensor().trace() - j).amax() < 1e-14);
        FreeBody { drag: 0.05, constant: [0.01, -0.02, 0.03], ..body }
    }

    /// The residual ω' + f J⁻¹ (ω × J ω) + k ω − a of a motion, and its derivatives by L, k and a.
    #[test]
    fn coefficients_are_those_of_the_equation_and_slopes_their_differences() {
        let (body, factor) = (example(), 1.7);
        let (w, slope) = (nalgebra::Vector3::new(0.3, -0.8, 0.5), nalgebra::Vector3::new(0.1, 0.2, -0.4));
        let squares = crate::physical::coordinates::ENTRIES.map(|(a, b)| w[a] * w[b]);
        let features: Vec<f64> = slope.iter().chain(&squares).chain(&w).copied().chain([1.0]).collect();
        let features = SVector::<f64, FEATURES>::from_column_slice(&features);
        let j = body.tensor();
        let turned = j.try_inverse().unwrap() * w.cross(&(j * w)) * factor;
        let expected = slope + turned + w * body.drag - nalgebra::Vector3::from(body.constant);
        assert!((body.coefficients(factor).unwrap() * features - expected).amax() < 1e-14);
        let gram = features * features.transpose();
        assert!((body.squares_by(&gram, factor).unwrap() - expected.norm_squared()).abs() < 1e-14);

        let slopes = body.slopes(factor).unwrap();
        let h = 1e-6;
        for (k, slope) in slopes.iter().enumerate() {
            let moved = |by: f64| {
                let mut body = body.clone();
                match k {
                    0..6 => body.root[ENTRIES_OF_ROOT[k]] += by,
                    6 => body.drag += by,
                    _ => body.constant[k - 7] += by,
                }
                body.coefficients(factor).unwrap()
            };
            let difference = (moved(h) - moved(-h)) / (2.0 * h);
            assert!((difference - slope).amax() < 1e-7, "{k}");
        }
    }

    /// From motions that a body with drag and a constant acceleration has, least squares find it with its factor, and leave nothing.
    #[test]
    fn the_nearest_body_is_the_one_that_moves_so() {
        let (body, mut random) = (example(), polhode::num::Random::new(3));
        for factor in [1.0, 0.6] {
            let mut gram = Gram::zeros();
            let j = body.tensor();
            for _ in 0..60 {
                let w = random.normal_vector();
                let slope = nalgebra::Vector3::from(body.constant)
                    - w * body.drag
                    - j.try_inverse().unwrap() * w.cross(&(j * w)) * factor;
                let squares = crate::physical::coordinates::ENTRIES.map(|(a, b)| w[a] * w[b]);
                let all: Vec<f64> = slope.iter().chain(&squares).chain(&w).copied().chain([1.0]).collect();
                let features = SVector::<f64, FEATURES>::from_column_slice(&all);
                gram += features * features.transpose();
            }
            let found = FreeBody::nearest(&gram, factor).unwrap();
            let shape = |body: &FreeBody| body.tensor() / body.tensor().trace();
            assert!(found.squares < 1e-6, "{factor}: {:e}", found.squares);
            assert!((shape(&found) - shape(&body)).amax() < 1e-3, "{factor}");
            assert!(
                (found.drag - body.drag).abs() < 1e-3 && (found.constant[1] + 0.02).abs() < 1e-3,
                "{factor}"
            );
            // without drag and acceleration the linear start alone misses it
            let known = FreeBody::known(&j).unwrap();
            assert!(known.squares_by(&gram, factor).unwrap() > 1e-3);
        }
    }
}
