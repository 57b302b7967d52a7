//! Where the joint fit begins, in closed form, and what gives the sizes.
//!
//! With C = t S the shape of carrier and proof body is S + μ (D − tr D S), μ = 1/(t + tr D): linear in one over the trace of both. So
//! is one over the trace, times the inertia of a wheel, v (1 − μ tr D) from v of the carrier alone.

use nalgebra::{DMatrix, DVector, Matrix3, SMatrix};

use crate::carrier::error::CarrierError;
use crate::carrier::estimate::{Size, SizeSource};
use crate::carrier::proof::ProofBody;
use crate::carrier::records::Attached;
use crate::error::FitError;
use crate::physical::coordinates::{Coordinates, coordinates, symmetric, tensor};
use crate::physical::nearest::Normal;
use crate::thresholds::carrier::{INVERSES, LEAST};
use crate::thresholds::noise::SURE;

/// What one record tells by itself: one over the trace, or the quotient of a wheel's inertia and the trace, then the shape.
pub(super) struct Alone {
    pub(super) attached: Attached,
    pub(super) proof: Option<ProofBody>,
    pub(super) told: Normal,
}

impl Alone {
    fn shape(&self) -> Coordinates {
        Coordinates::from_column_slice(&self.told.centre.as_slice()[self.told.centre.len() - 5..])
    }

    /// One over the trace and its standard deviation.
    fn inverse(&self) -> Option<(f64, f64)> {
        let value = *self.told.centre.as_slice().first().filter(|_| self.told.centre.len() == 6)?;
        Some((value, self.covariance()?[(0, 0)].sqrt()))
    }

    fn covariance(&self) -> Option<DMatrix<f64>> {
        let factor = self.told.root.clone().try_inverse()?;
        Some(&factor * factor.transpose())
    }

    fn added(&self) -> Matrix3<f64> {
        self.proof.map_or(Matrix3::zeros(), |proof| proof.added())
    }
}

/// Where the joint fit begins, kg m².
pub(super) struct Start {
    pub(super) carrier: Matrix3<f64>,
    pub(super) object: Option<Matrix3<f64>>,
    pub(super) wheel: Option<f64>,
    pub(super) sizes: Vec<Size>,
}

/// From what each record tells alone, the carrier's first; `finds_wheel` where the wheel's inertia is an unknown.
pub(super) fn start(alone: &[Alone], finds_wheel: bool) -> Result<Start, CarrierError> {
    let carrier = &alone[0];
    let mut traces: Vec<(f64, Size)> = Vec::new();
    let by_inputs = carrier.inverse().filter(|_| !finds_wheel);
    if let Some((value, sigma)) = by_inputs.filter(|(value, sigma)| *value > SURE * sigma) {
        traces.push((1.0 / value, Size { source: SizeSource::Inputs, relative: sigma / value }));
    }
    let proofs = pairs(alone, false)?;
    for pair in proofs.iter().filter(|pair| pair.is_told()) {
        let relative = pair.sigma / pair.inverse / (pair.inverse * pair.trace());
        traces.push((pair.trace(), Size { source: SizeSource::Proof, relative }));
    }
    let best = traces.iter().min_by(|a, b| a.1.relative.total_cmp(&b.1.relative));
    let lightest = || match surest(&proofs) {
        Some(pair) => pair.untold(),
        None => CarrierError::NoSize { told: by_inputs },
    };
    let trace = best.ok_or_else(lightest)?.0;
    let tensor_of = |one: &Alone, trace: f64| tensor(&one.shape()) * trace;
    let carried = tensor_of(carrier, trace);
    let of_wheel = |one: &Alone| Some(one.inverse()?.0 * (trace + one.added().trace()));
    let wheel = alone.iter().filter(|one| !one.attached.has_object()).find_map(of_wheel);
    if finds_wheel && wheel.is_none() {
        let error = Box::new(FitError::NoWheelSpeed);
        return Err(CarrierError::Record { attached: carrier.attached, error });
    }
    let wheel = wheel.filter(|_| finds_wheel);
    let object = match alone.iter().any(|one| one.attached.has_object()) {
        true => Some(object(alone, wheel)?.1 - carried),
        false => None,
    };
    Ok(Start { carrier: carried, object, wheel, sizes: traces.into_iter().map(|(_, size)| size).collect() })
}

/// Relative deviation and tensor of carrier and object.
fn object(alone: &[Alone], wheel: Option<f64>) -> Result<(f64, Matrix3<f64>), CarrierError> {
    let wheel = wheel.unwrap_or(1.0);
    let by_inputs = alone.iter().filter(|one| one.attached.has_object() && wheel > 0.0).filter_map(|one| {
        let (value, sigma) = one.inverse().filter(|(value, sigma)| *value > SURE * sigma)?;
        Some((sigma / value, tensor(&one.shape()) * (wheel / value) - one.added()))
    });
    let proofs = pairs(alone, true)?;
    let by_proof = proofs.iter().filter(|pair| pair.is_told());
    let by_proof = by_proof.map(|pair| (pair.sigma / pair.inverse, tensor(&pair.shape) * pair.trace()));
    let best = by_inputs.chain(by_proof).min_by(|a, b| a.0.total_cmp(&b.0));
    let moved = surest(&proofs).map(|pair| (pair.inverse, pair.sigma));
    best.ok_or(CarrierError::ObjectSize { moved })
}

/// A body with and without the proof body.
struct Pair {
    /// Of the body without it.
    shape: Coordinates,
    /// Trace of the proof body, kg m².
    added: f64,
    /// One over the trace of both and its standard deviation.
    inverse: f64,
    sigma: f64,
}

impl Pair {
    fn is_told(&self) -> bool {
        self.inverse > SURE * self.sigma
    }

    /// Of the body without the proof body, kg m².
    fn trace(&self) -> f64 {
        let both = 1.0 / self.inverse;
        (both - self.added).max(LEAST * both)
    }

    /// Why it does not tell the size.
    fn untold(&self) -> CarrierError {
        let Pair { inverse, sigma, .. } = *self;
        if inverse < -SURE * sigma {
            return CarrierError::Opposite { inverse, sigma };
        }
        CarrierError::TooLight {
            trace: self.added,
            inverse: self.inverse,
            sigma: self.sigma,
            needed: SURE,
            bound: 1.0 / (SURE * self.sigma),
        }
    }
}

/// The one that stands out of its deviation the most.
fn surest(pairs: &[Pair]) -> Option<&Pair> {
    pairs.iter().max_by(|a, b| (a.inverse / a.sigma).total_cmp(&(b.inverse / b.sigma)))
}

/// Every two records of a body with and without proof body; with the object or of the carrier.
fn pairs(alone: &[Alone], object: bool) -> Result<Vec<Pair>, CarrierError> {
    let of = |proof: bool| {
        let fits = move |one: &&Alone| one.attached.has_object() == object && one.proof.is_some() == proof;
        alone.iter().filter(fits)
    };
    let mut found = Vec::new();
    for base in of(false) {
        for (with, proof) in of(true).filter_map(|with| Some((with, with.proof.as_ref()?))) {
            found.extend(pair(base, with, proof, proof.deviations()?));
        }
    }
    Ok(found)
}

fn pair(base: &Alone, with: &Alone, proof: &ProofBody, deviations: Option<[f64; 6]>) -> Option<Pair> {
    let size = base.told.centre.len().min(with.told.centre.len());
    let last = |one: &Alone| -> Option<(DVector<f64>, DMatrix<f64>)> {
        let first = one.told.centre.len() - size;
        let covariance = one.covariance()?.view((first, first), (size, size)).into_owned();
        Some((one.told.centre.rows(first, size).into_owned(), covariance))
    };
    let ((z, covariance), (z_with, covariance_with)) = (last(base)?, last(with)?);
    let apart = z_with - &z;
    // what a tensor E adds to both, over μ: the coordinates of E less tr E times z
    let response = |e: &Matrix3<f64>| {
        let x = coordinates(e);
        DVector::from_fn(size, |k, _| if k + 5 < size { 0.0 } else { x[k + 5 - size] }) - &z * e.trace()
    };
    let slope = response(&proof.added());
    let own = deviations.map_or(DMatrix::zeros(size, size), |sigmas| {
        let each = sigmas.iter().enumerate().map(|(e, sigma)| response(&symmetric(e)) * *sigma);
        each.fold(DMatrix::zeros(size, size), |sum, d| sum + &d * d.transpose())
    });
    let added = proof.added().trace();
    let (mut inverse, mut sigma) = (0.0_f64, f64::INFINITY);
    for _ in 0..INVERSES {
        let share = (inverse * added).clamp(0.0, 1.0);
        let less = (1.0 - share) * (1.0 - share);
        let all = &covariance_with + &covariance * less + &own * ((share / added) * (share / added));
        let weighted = all.cholesky()?.solve(&slope);
        let information = weighted.dot(&slope);
        if information <= 0.0 {
            break;
        }
        (inverse, sigma) = (weighted.dot(&apart) / information, 1.0 / information.sqrt());
    }
    Some(Pair { shape: base.shape(), added, inverse, sigma })
}

/// Six numbers in the order xx, yy, zz, xy, xz, yz as a tensor.
pub(super) fn of_entries(entries: &[f64]) -> Matrix3<f64> {
    entries.iter().enumerate().fold(Matrix3::zeros(), |sum, (k, entry)| sum + symmetric(k) * *entry)
}

/// d(coordinates of T/tr T)/d(entries of T), of a tensor of shape `x` and this trace.
pub(super) fn slope_of_shape(x: &Coordinates, trace: f64) -> SMatrix<f64, 5, 6> {
    SMatrix::from_columns(&core::array::from_fn::<_, 6, _>(|k| {
        let e = symmetric(k);
        (coordinates(&e) - x * e.trace()) / trace
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn alone(attached: Attached, proof: Option<ProofBody>, centre: &[f64], sigma: f64) -> Alone {
        let size = centre.len();
        let root = DMatrix::identity(size, size) / sigma;
        Alone { attached, proof, told: Normal { centre: DVector::from_column_slice(centre), root } }
    }

    /// A proof body of trace 1 with a product of 0.1, on a sphere of trace 3: the shape changes along xy alone, by √2 · 0.1 μ with
    /// μ = 1/4, and one over the trace of both has the deviations along that, over √2 · 0.1.
    #[test]
    fn two_shapes_tell_the_trace_with_the_deviation_along_their_difference() {
        let (mu, product, sigma) = (0.25, 0.1, 0.01);
        let along = core::f64::consts::SQRT_2 * product;
        let mut added = Matrix3::identity() / 3.0;
        (added[(0, 1)], added[(1, 0)]) = (product, product);
        let proof = ProofBody::adding(added).unwrap();
        let base = alone(Attached::Nothing, None, &[0.0; 5], sigma);
        let with = alone(Attached::Proof, Some(proof), &[0.0, 0.0, along * mu, 0.0, 0.0], sigma);
        // of the base (1 − μ)² of the variance; of an entry xy 2 s² μ²
        let own = sigma * sigma * (1.0 + 0.5625);
        for (deviations, variance) in [
            (None, own),
            (Some([0.0, 0.0, 0.0, 0.02, 0.0, 0.0]), own + 2.0 * 4e-4 / 16.0),
            (Some([0.0, 0.0, 0.0, 0.0, 0.02, 0.02]), own),
        ] {
            let found = pair(&base, &with, &proof, deviations).unwrap();
            assert!((found.inverse - mu).abs() < 1e-12 && (found.added - 1.0).abs() < 1e-15);
            let expected = variance.sqrt() / along;
            assert!((found.sigma / expected - 1.0).abs() < 1e-12, "{} {expected}", found.sigma);
            assert!((found.trace() - 3.0).abs() < 1e-10 && found.shape == Coordinates::zeros());
        }
        // a quotient of 2 without it falls by the share 1 − μ: its slope is −2
        let base = alone(Attached::Nothing, None, &[2.0, 0.0, 0.0, 0.0, 0.0, 0.0], sigma);
        let both = alone(Attached::Proof, Some(proof), &[1.5, 0.0, 0.0, along * mu, 0.0, 0.0], sigma);
        let found = pair(&base, &both, &proof, None).unwrap();
        let expected = (own / (4.0 + along * along)).sqrt();
        assert!((found.inverse - mu).abs() < 1e-12 && (found.sigma / expected - 1.0).abs() < 1e-12);
        // where one has no quotient the shapes tell it alone
        let found = pair(&base, &with, &proof, None).unwrap();
        assert!((found.sigma * along / own.sqrt() - 1.0).abs() < 1e-12);
    }

    /// One over the trace that stands out of five deviations tells it; the carrier keeps a thousandth of that at least.
    #[test]
    fn a_pair_tells_the_size_beyond_five_deviations() {
        let pair = |inverse, sigma| Pair { shape: Coordinates::zeros(), added: 1.0, inverse, sigma };
        assert!((pair(0.25, 0.01).trace() - 3.0).abs() < 1e-15);
        assert!((pair(2.0, 0.01).trace() - 5e-4).abs() < 1e-18);
        assert!(pair(0.51, 0.1).is_told() && !pair(0.49, 0.1).is_told());
        assert_eq!(pair(-0.51, 0.1).untold(), CarrierError::Opposite { inverse: -0.51, sigma: 0.1 });
        let light =
            CarrierError::TooLight { trace: 1.0, inverse: -0.49, sigma: 0.1, needed: 5.0, bound: 2.0 };
        assert_eq!(pair(-0.49, 0.1).untold(), light);
        let all = [pair(0.2, 0.1), pair(0.3, 0.05), pair(-0.9, 0.1)];
        assert_eq!(surest(&all).map(|pair| pair.inverse), Some(0.3));
        assert!(surest(&[]).is_none());
    }

    /// The deviation of one over the trace is that with the shape left open: 1 + 0.75² where the root has 0.75 beside its one.
    #[test]
    fn the_trace_has_the_deviation_of_an_open_shape() {
        let mut one = alone(Attached::Nothing, None, &[0.5, 0.1, 0.2, 0.3, 0.4, 0.6], 1.0);
        one.told.root[(0, 1)] = 0.75;
        assert_eq!(one.inverse(), Some((0.5, 1.25)));
        assert_eq!(one.shape(), Coordinates::new(0.1, 0.2, 0.3, 0.4, 0.6));
        assert_eq!(alone(Attached::Nothing, None, &[0.5, 0.1, 0.2, 0.3, 0.4], 1.0).inverse(), None);
    }

    /// A quotient j/(t + d) of a wheel tells carrier and object without what the proof body adds, and a wheel of no inertia tells nothing.
    #[test]
    fn wheels_tell_the_object_beside_a_proof_body() {
        let body = Matrix3::new(2.0, 0.1, 0.0, 0.1, 3.0, -0.2, 0.0, -0.2, 4.0);
        let proof = ProofBody::adding(Matrix3::identity() * 2.0).unwrap();
        let (wheel, both) = (0.5, body + proof.added());
        let shape = coordinates(&(both / both.trace()));
        let of = |wheel: f64| {
            let centre: Vec<f64> = [wheel / both.trace()].into_iter().chain(shape.iter().copied()).collect();
            [
                alone(Attached::Nothing, None, &[0.0; 5], 1e-4),
                alone(Attached::ObjectAndProof, Some(proof), &centre, 1e-4),
            ]
        };
        let (relative, found) = object(&of(wheel), Some(wheel)).unwrap();
        assert!((found - body).amax() < 1e-13, "{found}");
        assert!((relative / (1e-4 * 15.0 / 0.5) - 1.0).abs() < 1e-12, "{relative}");
        let none = object(&of(wheel), Some(-wheel)).unwrap_err();
        assert_eq!(none, CarrierError::ObjectSize { moved: None });
    }
}
