//! The weak equations of single test functions along a record, with everything that is linear in them.

use crate::thresholds::flights::{NOISE_DEVIATIONS, NOISE_OF_SLOPE, NOISE_OF_VALUE, SLOW};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use crate::columns::equation::crossed;
use crate::physical::coordinates::{Coordinates, ENTRIES, Form, basis};
use crate::signal::stretch::Stretch;
use crate::signal::test_functions::{Seen, TestFunctions};

/// Unknowns: five of the tensor, drag along each sensor axis, the factor of known inputs, a constant torque.
pub(super) const UNKNOWNS: usize = 12;
/// The first of these, without the constant torque.
pub(super) const LOCAL: usize = 9;

pub(super) type Vector = SVector<f64, UNKNOWNS>;
type Square = SMatrix<f64, UNKNOWNS, UNKNOWNS>;

/// The sums of one test function.
#[derive(Clone, Copy, Debug)]
pub(super) struct Test {
    pub(super) centre: f64,
    /// Σ w φ' ω.
    slope: Vector3<f64>,
    /// Σ w φ ω.
    value: Vector3<f64>,
    /// The entries of Σ w φ ω ωᵀ.
    square: [f64; 6],
    /// Σ w φ.
    area: f64,
    /// Σ w (−φ' h + φ ω × h − φ τ) of known inputs.
    input: Vector3<f64>,
    /// Bound on the mean square of the residual by the noise of the rates, over its variance.
    noise: f64,
}

impl Test {
    /// Σ w φ |ω|², against which a torque is large or small.
    pub(super) fn size(&self) -> f64 {
        self.square[0] + self.square[1] + self.square[2]
    }

    /// Root mean square rate.
    pub(super) fn rate(&self) -> f64 {
        (self.size() / self.area).max(0.0).sqrt()
    }

    /// Whether the body hardly turns, where `speed` is the rate of its motion.
    pub(super) fn is_slow(&self, speed: f64) -> bool {
        self.rate() < SLOW * speed
    }

    /// The residual that noise of this variance stays below, squared.
    pub(super) fn noise(&self, variance: f64) -> f64 {
        NOISE_DEVIATIONS * NOISE_DEVIATIONS * variance * self.noise
    }

    /// The residual that counts as 1, where torques up to a share of the trace times |ω|² do.
    pub(super) fn scale(&self, share: f64, variance: f64) -> f64 {
        let torque = share * self.size();
        (torque * torque + self.noise(variance)).sqrt()
    }

    /// The derivatives with respect to the unknowns.
    pub(super) fn columns(&self) -> [Vector3<f64>; UNKNOWNS] {
        let s = self.square;
        let full = Matrix3::new(s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2]);
        core::array::from_fn(|k| match k {
            0..5 => {
                let b = basis(k);
                crossed(&full, &b) - b * self.slope
            }
            5..8 => Vector3::ith(k - 5, self.value[k - 5]),
            8 => self.input,
            _ => Vector3::ith(k - LOCAL, -self.area),
        })
    }

    /// The residual where all unknowns are zero: that of a sphere.
    pub(super) fn at_sphere(&self) -> Vector3<f64> {
        self.slope / -3.0
    }

    /// The residual at `x`.
    pub(super) fn residual(&self, x: &Vector) -> Vector3<f64> {
        self.columns().iter().zip(x.iter()).fold(self.at_sphere(), |sum, (column, x)| sum + column * *x)
    }
}

/// The tests of a stretch; none where it is too short.
pub(super) fn tests(stretch: &Stretch, radius: f64) -> Vec<Test> {
    let Some(functions) = TestFunctions::new(stretch, radius) else { return Vec::new() };
    let none = |centre| Test {
        centre,
        slope: Vector3::zeros(),
        value: Vector3::zeros(),
        square: [0.0; 6],
        area: 0.0,
        input: Vector3::zeros(),
        noise: 0.0,
    };
    let mut tests: Vec<Test> = functions.centres().into_iter().map(none).collect();
    for (i, ((&t, w), &weight)) in stretch.times.iter().zip(&stretch.rates).zip(&stretch.weights).enumerate()
    {
        let products = ENTRIES.map(|(a, b)| w[a] * w[b]);
        let seen = Seen::new(&functions, t);
        for (test, (_, slope, value)) in tests[seen.first..].iter_mut().zip(seen.each()) {
            let (slope, value) = (weight * slope, weight * value);
            test.slope += w * slope;
            test.value += w * value;
            test.square.iter_mut().zip(products).for_each(|(sum, p)| *sum += value * p);
            test.area += value;
            test.noise += NOISE_OF_SLOPE * slope * slope + NOISE_OF_VALUE * value * value * w.norm_squared();
            if let Some(inputs) = &stretch.inputs {
                let (h, torque) = (inputs.wheel[i], inputs.torque[i]);
                test.input += (w.cross(&h) - torque) * value - h * slope;
            }
        }
    }
    tests
}

/// Normal equations of some tests.
#[derive(Clone, Copy, Debug)]
pub(super) struct Normal {
    matrix: Square,
    vector: Vector,
    squares: f64,
    /// Residuals.
    pub(super) count: usize,
}

impl Normal {
    /// Of no test, with independent priors of these precisions about `mean`.
    pub(super) fn prior(precisions: &Vector, mean: &Vector) -> Normal {
        let weighted = precisions.component_mul(mean);
        Normal {
            matrix: Square::from_diagonal(precisions),
            vector: -weighted,
            squares: weighted.dot(mean),
            count: 0,
        }
    }

    /// With one more test, its residual over `scale`; only the first `active` unknowns change it.
    pub(super) fn add(&mut self, test: &Test, scale: f64, active: usize) {
        let columns = test.columns().map(|column| column / scale);
        let own = test.at_sphere() / scale;
        for i in 0..active {
            for k in 0..=i {
                self.matrix[(i, k)] += columns[i].dot(&columns[k]);
            }
            self.vector[i] += columns[i].dot(&own);
        }
        self.squares += own.norm_squared();
        self.count += 3;
    }

    /// The unknowns of least squares.
    pub(super) fn solve(&self) -> Option<Vector> {
        let mut full = self.matrix;
        full.fill_upper_triangle_with_lower_triangle();
        Some(full.cholesky()?.solve(&-self.vector))
    }

    /// What is left for the tensor, all other unknowns at their best.
    pub(super) fn of_tensor(&self) -> Option<Reduced> {
        let mut full = self.matrix;
        full.fill_upper_triangle_with_lower_triangle();
        const OTHERS: usize = UNKNOWNS - 5;
        let own = full.fixed_view::<OTHERS, OTHERS>(5, 5).into_owned().cholesky()?;
        let shared = full.fixed_view::<OTHERS, 5>(5, 0).into_owned();
        let right = self.vector.fixed_rows::<OTHERS>(5).into_owned();
        let (by_tensor, by_right) = (own.solve(&shared), own.solve(&right));
        Some(Reduced {
            matrix: full.fixed_view::<5, 5>(0, 0) - shared.transpose() * by_tensor,
            vector: self.vector.fixed_rows::<5>(0) - shared.transpose() * by_right,
            squares: self.squares - right.dot(&by_right),
            count: self.count,
        })
    }
}

/// A sum of squares as a function of the tensor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reduced {
    pub(super) matrix: Form,
    pub(super) vector: Coordinates,
    squares: f64,
    count: usize,
}

impl Reduced {
    /// Mean square of the residuals at `x`.
    pub(super) fn mean_square(&self, x: &Coordinates) -> f64 {
        let sum = self.squares + x.dot(&(self.matrix * x)) + 2.0 * self.vector.dot(x);
        sum.max(0.0) / self.count.max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Size, rate and scale of a test are those of its sums; without tests least squares give the mean of the priors.
    #[test]
    fn sums_give_size_rate_and_scale() {
        let test = Test {
            centre: 0.0,
            slope: Vector3::new(3.0, -6.0, 9.0),
            value: Vector3::zeros(),
            square: [1.0, 2.0, 3.0, 9.0, 9.0, 9.0],
            area: 1.5,
            input: Vector3::zeros(),
            noise: 0.25,
        };
        assert_eq!((test.size(), test.rate(), test.scale(0.5, 0.0)), (6.0, 2.0, 3.0));
        let noise = NOISE_DEVIATIONS * NOISE_DEVIATIONS;
        assert!((test.noise(4.0) / noise - 1.0).abs() < 1e-12);
        assert!((test.scale(0.5, 4.0) / (9.0 + noise).sqrt() - 1.0).abs() < 1e-12);
        assert!(test.is_slow(2.02 / SLOW) && !test.is_slow(1.98 / SLOW));
        assert_eq!(test.residual(&Vector::zeros()), Vector3::new(-1.0, 2.0, -3.0));
        let (precisions, mean) = (Vector::repeat(4.0), Vector::from_fn(|k, _| k as f64 - 3.0));
        let normal = Normal::prior(&precisions, &mean);
        assert!((normal.solve().unwrap() - mean).amax() < 1e-12 && normal.count == 0);
        assert!((normal.squares - 4.0 * mean.norm_squared()).abs() < 1e-9);
    }
}
