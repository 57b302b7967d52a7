//! A tensor that is known beforehand, with its uncertainty.

use crate::thresholds::limits::SYMMETRIC;
use nalgebra::{DMatrix, DVector, Matrix3, SMatrix};

use crate::error::FitError;
use crate::physical::coordinates::{Coordinates, ENTRIES, Form, basis, coordinates, eigen};
use crate::physical::nearest::Normal;

/// An inertia tensor that is known beforehand, as from a CAD model, with the covariance of its entries: a normal
/// distribution that a fit joins with what the record tells.
///
/// ```
/// use nalgebra::Vector3;
/// use polhode_fit::{Prior, Record, Settings, fit, simulate};
/// use polhode::inertia::Inertia;
/// use polhode::num::Random;
/// # let body = Inertia::from_moments([1.0, 2.0, 2.6])?;
/// # let times: Vec<f64> = (0..1000).map(|i| f64::from(i) / 100.0).collect();
/// # let rates = simulate(&body, Vector3::new(0.3, 1.0, 0.4), &times, 1e-2, &mut Random::new(7))?;
/// // the CAD model has each entry to two per cent, and the size
/// let model = Inertia::from_moments([1.01, 1.98, 2.61])?;
/// let settings = Settings::default().with_prior(Prior::relative(model.tensor(), 0.02));
/// let record = Record::from_samples(&times, &rates)?;
/// let (with, without) = (fit(&record, &settings)?, fit(&record, &Settings::default())?);
/// assert!(with.sigma_principal[0] < without.sigma_principal[0]);
/// assert!(with.inertia.is_some() && without.inertia.is_none());
/// # Ok::<(), polhode::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Prior {
    tensor: Matrix3<f64>,
    covariance: SMatrix<f64, 6, 6>,
    sized: bool,
}

impl Prior {
    /// From a tensor, kg m², sensor axes, and the covariance of its entries xx, yy, zz, xy, xz, yz, (kg m²)².
    #[must_use]
    pub fn new(tensor: Matrix3<f64>, covariance: SMatrix<f64, 6, 6>) -> Prior {
        Prior { tensor, covariance, sized: true }
    }

    /// From a tensor, kg m², sensor axes, whose entries ij have independent standard deviations of `share` √(I_ii I_jj).
    #[must_use]
    pub fn relative(tensor: Matrix3<f64>, share: f64) -> Prior {
        let mut covariance = SMatrix::zeros();
        for (k, (i, j)) in ENTRIES.into_iter().enumerate() {
            covariance[(k, k)] = share * share * tensor[(i, i)] * tensor[(j, j)];
        }
        Prior { tensor, covariance, sized: true }
    }

    /// The same for the shape alone: the size is not known, and the tensor is in any unit.
    #[must_use]
    pub fn shape_only(self) -> Prior {
        Prior { sized: false, ..self }
    }

    /// Refuses a tensor or a covariance that is none.
    pub(crate) fn check(&self) -> Result<(), FitError> {
        let trace = self.tensor.trace();
        if !(trace > 0.0 && (trace * trace).is_normal() && self.tensor.iter().all(|v| v.is_finite())) {
            return Err(FitError::Setting { name: "the trace of the prior tensor", value: trace });
        }
        let scaled = self.covariance / (trace * trace);
        let least = if scaled.iter().all(|v| v.is_finite()) { eigen(scaled).0[0] } else { f64::NAN };
        let symmetric = (scaled - scaled.transpose()).amax() <= SYMMETRIC * scaled.amax();
        if !(least > 0.0 && symmetric) {
            return Err(FitError::PriorCovariance { least: least * trace * trace, symmetric });
        }
        Ok(())
    }

    /// What it says of the shape and the logarithm of the trace.
    pub(crate) fn told(&self) -> Result<Told, FitError> {
        let trace = self.tensor.trace();
        let x = coordinates(&(self.tensor / trace));
        // derivatives of the coordinates and of the logarithm of the trace with respect to the entries
        let slope = SMatrix::<f64, 6, 6>::from_fn(|row, k| {
            let (i, j) = ENTRIES[k];
            let of_trace = if i == j { 1.0 / trace } else { 0.0 };
            if row == 5 {
                return of_trace;
            }
            let both = if i == j { 1.0 } else { 2.0 };
            both * basis(row)[(i, j)] / trace - x[row] * of_trace
        });
        let covariance = slope * self.covariance * slope.transpose();
        let singular = FitError::PriorCovariance { least: 0.0, symmetric: true };
        let inverse = |c: DMatrix<f64>| {
            // L⁻¹ is a root of the information (L Lᵀ)⁻¹
            c.cholesky().and_then(|factor| factor.l().try_inverse())
        };
        let whole = DMatrix::from_fn(6, 6, |i, k| covariance[(i, k)]);
        let shape = whole.view((0, 0), (5, 5)).into_owned();
        match (inverse(shape), inverse(whole)) {
            (Some(shape_root), Some(root)) => {
                Ok(Told { x, trace, covariance, shape_root, root, sized: self.sized })
            }
            _ => Err(singular),
        }
    }
}

/// A prior as a normal distribution of the coordinates of the shape and the logarithm of the trace.
pub(crate) struct Told {
    pub(crate) x: Coordinates,
    /// kg m².
    pub(crate) trace: f64,
    covariance: SMatrix<f64, 6, 6>,
    /// Roots of the information about the shape, and about shape and size.
    shape_root: DMatrix<f64>,
    root: DMatrix<f64>,
    pub(crate) sized: bool,
}

impl Told {
    /// As a distribution of the shape alone.
    pub(crate) fn shape(&self) -> Normal {
        let centre = DVector::from_column_slice(self.x.as_slice());
        Normal { centre, root: self.shape_root.clone().qr().r() }
    }

    /// A root of the information about the shape.
    pub(crate) fn shape_root(&self) -> Form {
        Form::from_fn(|i, k| self.shape_root[(i, k)])
    }

    /// Joined with what a record tells; `input` is the place of one over the trace among its unknowns, and the trace that
    /// goes with 1. With the square of the distance of the two, in standard deviations, and its degrees of freedom.
    pub(crate) fn join(&self, told: &Normal, input: Option<(usize, f64)>) -> Option<(Normal, f64, usize)> {
        let first = told.centre.len() - 5;
        let sized = input.filter(|_| self.sized);
        let root = if sized.is_some() { &self.root } else { &self.shape_root };
        let mut rows = DMatrix::zeros(root.nrows(), told.centre.len());
        rows.columns_mut(first, 5).copy_from(&root.columns(0, 5));
        let mut at = DVector::from_column_slice(self.x.as_slice());
        if let Some((place, unit)) = sized {
            // d ln trace = −du/u
            let expected = unit / self.trace;
            rows.column_mut(place).copy_from(&(root.column(5) / -expected));
            at = at.push(-1.0);
        }
        let (joined, squares) = told.with(&rows, &(root * at))?;
        Some((joined, squares, root.nrows()))
    }

    /// The trace of a tensor of shape `x`, the derivative of its logarithm, and the variance of that at a given shape.
    pub(crate) fn size(&self, x: &Coordinates) -> (f64, Coordinates, f64) {
        let of_shape = self.covariance.fixed_view::<5, 5>(0, 0).into_owned();
        let mixed: Coordinates = self.covariance.fixed_view::<5, 1>(0, 5).into_owned();
        let slope = of_shape.cholesky().map_or(Coordinates::zeros(), |factor| factor.solve(&mixed));
        let variance = (self.covariance[(5, 5)] - slope.dot(&mixed)).max(0.0);
        (self.trace * libm::exp(slope.dot(&(x - self.x))), slope, variance)
    }

    /// Standard deviation of the logarithm of the trace.
    pub(crate) fn size_deviation(&self) -> f64 {
        self.covariance[(5, 5)].sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use polhode::num::Random;

    /// Against the moments of shapes and sizes that were drawn.
    #[test]
    fn the_distribution_of_shape_and_size_is_that_of_the_entries() {
        let tensor = Matrix3::new(2.0, 0.2, -0.1, 0.2, 3.0, 0.3, -0.1, 0.3, 4.0);
        let prior = Prior::relative(tensor, 1e-3);
        let told = prior.told().unwrap();
        let mut random = Random::new(5);
        let (mut sum, count) = (SMatrix::<f64, 6, 6>::zeros(), 20_000);
        for _ in 0..count {
            let mut drawn = tensor;
            for (i, j) in ENTRIES {
                drawn[(i, j)] += 1e-3 * (tensor[(i, i)] * tensor[(j, j)]).sqrt() * random.normal();
                drawn[(j, i)] = drawn[(i, j)];
            }
            let x = coordinates(&(drawn / drawn.trace())) - told.x;
            let size = libm::log(drawn.trace() / told.trace);
            let v = SMatrix::<f64, 6, 1>::from_fn(|k, _| if k < 5 { x[k] } else { size });
            sum += v * v.transpose() / f64::from(count);
        }
        // in units of the deviations an entry scatters by at most √(2/20000) = 0.01
        let scale = |k: usize| told.covariance[(k, k)].sqrt();
        for i in 0..6 {
            for k in 0..6 {
                let apart = (sum[(i, k)] - told.covariance[(i, k)]) / scale(i) / scale(k);
                assert!(apart.abs() < 0.05, "{i} {k}: {apart}");
            }
        }
    }

    /// Two independent normal distributions of a number: the inverse variances add.
    #[test]
    fn inverse_variances_add() {
        let tensor = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.5));
        let told = Prior::relative(tensor, 1e-2).told().unwrap();
        let root = DMatrix::identity(5, 5) * 200.0;
        let centre = told.shape().centre.add_scalar(1e-3);
        let record = Normal { centre: centre.clone(), root };
        let (joined, squares, freedom) = told.join(&record, None).unwrap();
        let information = |n: &Normal| n.root.transpose() * &n.root;
        let expected = information(&record) + information(&told.shape());
        assert!((information(&joined) - &expected).amax() < 1e-9 * expected.amax());
        let mean = expected
            .clone()
            .cholesky()
            .unwrap()
            .solve(&(information(&record) * &centre + information(&told.shape()) * told.shape().centre));
        assert!((&joined.centre - mean).amax() < 1e-12);
        let covariance =
            information(&record).try_inverse().unwrap() + information(&told.shape()).try_inverse().unwrap();
        let apart = &centre - told.shape().centre;
        let distance = apart.dot(&covariance.cholesky().unwrap().solve(&apart));
        assert!((squares / distance - 1.0).abs() < 1e-9 && freedom == 5, "{squares} {distance}");
    }

    #[test]
    fn what_is_no_covariance_is_refused() {
        let tensor = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.5));
        assert!(Prior::relative(tensor, 0.01).check().is_ok());
        for share in [0.0, f64::NAN] {
            let error = Prior::relative(tensor, share).check().unwrap_err();
            assert!(matches!(error, FitError::PriorCovariance { .. }), "{error}");
        }
        let mut negative = Prior::relative(tensor, 0.01).covariance;
        negative[(2, 2)] = -1e-4;
        let error = Prior::new(tensor, negative).check().unwrap_err().to_string();
        assert!(error.contains("smallest eigenvalue is -1.000e-4"), "{error}");
        assert!(matches!(Prior::relative(-tensor, 0.01).check(), Err(FitError::Setting { .. })));
        // what has no information either
        let singular = Prior::relative(tensor, 0.0).told().err();
        assert_eq!(singular, Some(FitError::PriorCovariance { least: 0.0, symmetric: true }));
    }

    /// A prior whose entries depend on each other.
    fn correlated() -> Prior {
        let tensor = Matrix3::new(2.0, 0.2, -0.1, 0.2, 3.0, 0.3, -0.1, 0.3, 4.0);
        let factor = SMatrix::<f64, 6, 6>::from_fn(|i, k| 0.02 / (1.0 + ((3 * i + 2 * k) % 7) as f64));
        Prior::new(tensor, factor * factor.transpose() + SMatrix::identity() * 1e-4)
    }

    /// At a given shape the logarithm of the trace is a normal number: by the information about both, with the slope −Λ_xs/Λ_ss and the
    /// variance 1/Λ_ss.
    #[test]
    fn the_size_at_a_given_shape_is_the_conditional_one() {
        let told = correlated().told().unwrap();
        let information = told.covariance.try_inverse().unwrap();
        let x = told.x + Coordinates::new(1e-3, -2e-3, 5e-4, 0.0, 1e-3);
        let (trace, slope, variance) = told.size(&x);
        let expected = Coordinates::from_fn(|k, _| -information[(k, 5)] / information[(5, 5)]);
        assert!((slope - expected).amax() < 1e-8 * (1.0 + expected.amax()));
        assert!(expected.amax() > 1e-3 && (variance * information[(5, 5)] - 1.0).abs() < 1e-8);
        assert!((libm::log(trace / 9.0) - expected.dot(&(x - told.x))).abs() < 1e-9);
        // of the trace itself: the sum of the covariances of the moments
        let moments = correlated().covariance.fixed_view::<3, 3>(0, 0).sum();
        assert!((told.size_deviation() / (moments.sqrt() / 9.0) - 1.0).abs() < 1e-9);
    }

    /// A prior with a size tells one over the trace too: as it grows by a share of itself, the logarithm of the trace falls by that.
    #[test]
    fn a_prior_with_a_size_tells_one_over_the_trace() {
        let told = correlated().told().unwrap();
        let unit = 4.5;
        let u = 0.5;
        let mut map = DMatrix::zeros(6, 6);
        (0..5).for_each(|k| map[(k, k + 1)] = 1.0);
        map[(5, 0)] = -1.0 / u;
        let own = DMatrix::from_fn(6, 6, |i, k| told.covariance[(i, k)]).try_inverse().unwrap();
        let of_prior = map.transpose() * own * &map;
        let apart = DVector::from_fn(6, |k, _| if k == 0 { 0.1 * u } else { 1e-3 });
        let at = DVector::from_fn(6, |k, _| if k == 0 { u } else { told.x[k - 1] });
        let record = Normal { centre: &at + &apart, root: DMatrix::identity(6, 6) * 200.0 };
        let (joined, squares, freedom) = told.join(&record, Some((0, unit))).unwrap();
        let expected = DMatrix::identity(6, 6) * 4e4 + &of_prior;
        let information = joined.root.transpose() * &joined.root;
        assert!((information - &expected).amax() < 1e-9 * expected.amax());
        let step = expected.cholesky().unwrap().solve(&(&of_prior * &apart));
        assert!((&joined.centre - (&record.centre - step)).amax() < 1e-9);
        let covariance = DMatrix::identity(6, 6) / 4e4 + of_prior.try_inverse().unwrap();
        let distance = apart.dot(&covariance.cholesky().unwrap().solve(&apart));
        assert!((squares / distance - 1.0).abs() < 1e-7 && freedom == 6, "{squares} {distance}");
        let alone = correlated().shape_only().told().unwrap();
        let (joined, _, freedom) = alone.join(&record, Some((0, unit))).unwrap();
        assert!(freedom == 5 && (joined.centre[0] - record.centre[0]).abs() < 1e-12);
    }

    /// A prior needs a trace whose square is a number, and a covariance that is symmetric to rounding.
    #[test]
    fn a_prior_needs_a_size_and_a_symmetric_covariance() {
        let tensor = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.5));
        let mut open = tensor;
        open[(0, 1)] = f64::NAN;
        for bad in [Matrix3::zeros(), tensor * 1e-170, tensor * 1e170, open] {
            let found = Prior::relative(bad, 0.01).check();
            let name = "the trace of the prior tensor";
            assert!(matches!(found, Err(FitError::Setting { name: of, .. }) if of == name), "{found:?}");
        }
        // a billionth of the largest entry, which is 6.25e-4
        for (apart, is_refused) in [(5e-13, false), (1e-12, true)] {
            let mut covariance = Prior::relative(tensor, 0.01).covariance;
            covariance[(0, 1)] += apart;
            let found = Prior::new(tensor, covariance).check();
            let is_asymmetric = matches!(found, Err(FitError::PriorCovariance { symmetric: false, .. }));
            assert!(is_asymmetric == is_refused && found.is_ok() != is_refused, "{found:?}");
        }
    }
}
