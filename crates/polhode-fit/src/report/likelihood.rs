//! What reports on likelihoods share: of the exact motion, and of a motion under torques.

use nalgebra::{DMatrix, DVector, Matrix3, SMatrix};
use polhode::inertia::Inertia;

use crate::columns::sets::torque_columns;
use crate::error::FitError;
use crate::physical::coordinates::{Coordinates, Form, eigen, tensor};
use crate::physical::failure::SolverFailure;
use crate::physical::nearest::Normal;
use crate::physical::prior::Prior;
use crate::poses::fault::PoseFault;
use crate::report::identifiability::Identifiability;
use crate::report::nuisance::Agreement;
use crate::report::scale::{Scale, by_prior, check_constant, check_same};
use crate::settings::Settings;
use crate::settings::known::Known;
use crate::settings::torque::TorqueModel;
use crate::signal::stretch::Stretch;
use crate::thresholds::bound::OPEN;
use crate::verdict::prior::{check_agreement, consistent};

/// Of which stretches a size is asked.
#[derive(Clone, Copy, Debug)]
pub(super) enum Of {
    /// All: the size of the answer.
    All,
    /// Those of one segment, which is compared with others.
    Segment,
}

/// How the direction of attitudes was told.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Told {
    /// Whether it is the other one than that in which they were read.
    pub(crate) is_inverse: bool,
    /// Log-likelihood of it less that of the other, where both were tried.
    pub(crate) gain: Option<f64>,
}

/// Which of the five numbers the information determines.
pub(super) fn identify(stretches: &[Stretch], x: &Coordinates, information: &Form) -> Identifiability {
    let (values, directions) = eigen(*information);
    let most = values[4];
    // ascending values, and what is rounding tells nothing
    let singular = Coordinates::from_fn(|k, _| {
        let value = values[4 - k];
        if value > OPEN * most { value.sqrt() } else { 0.0 }
    });
    let descending = Form::from_fn(|i, k| directions[(i, 4 - k)]);
    let mut scatter = Matrix3::zeros();
    for stretch in stretches {
        stretch.rates.iter().for_each(|w| scatter += w * w.transpose());
    }
    Identifiability::new(&(singular, descending), &scatter, &tensor(x))
}

/// What a likelihood with that `information` about `x` tells, joined with the prior, and how they agree; `is_still` where its search has ended.
pub(super) fn joined(
    settings: &Settings,
    identifiability: &Identifiability,
    is_still: bool,
    x: &Coordinates,
    information: &Form,
) -> Result<(Normal, Option<Agreement>), FitError> {
    let prior = settings.prior.as_ref().map(|prior| consistent(prior, settings)).transpose()?;
    if !identifiability.complete() {
        return Err(FitError::Unidentifiable(Box::new(identifiability.clone())));
    }
    if !is_still {
        return Err(PoseFault::Unsettled.into());
    }
    let singular = || FitError::Solver(SolverFailure::Information);
    let root = information.cholesky().ok_or_else(singular)?.l().transpose();
    let own = Normal {
        centre: DVector::from_column_slice(x.as_slice()),
        root: DMatrix::from_column_slice(5, 5, root.as_slice()),
    };
    let Some(prior) = prior else { return Ok((own, None)) };
    let (joined, chi2, dof) = prior.join(&own, None).ok_or_else(singular)?;
    let agreed = Agreement { chi2, dof };
    check_agreement(&prior, agreed, x)?;
    Ok((joined, Some(agreed)))
}

/// The absolute tensor by the rates of a fitted motion, where something gives its size, and its covariance; `torque` was fitted. `scale` is the
/// size by the stretches of the motion, of all of them or of those of one segment.
pub(super) fn absolute(
    settings: &Settings,
    rates: &[Stretch],
    torque: TorqueModel,
    j: &Matrix3<f64>,
    covariance: &Form,
    x: &Coordinates,
    scale: impl Fn(Known, &[Stretch], Of) -> Scale,
) -> Result<(Option<Inertia>, Option<SMatrix<f64, 6, 6>>), FitError> {
    let prior = settings.prior.as_ref().map(Prior::told).transpose()?.filter(|prior| prior.sized);
    let Some(known) = settings.known else {
        return prior.map_or(Ok((None, None)), |prior| by_prior(j, &prior, covariance, x));
    };
    check_constant(known, &torque_columns(torque))?;
    check_same(known, rates, covariance, 1.0, |segment, _| scale(known, segment, Of::Segment))?;
    let scale = scale(known, rates, Of::All);
    let (inertia, covariance) = scale.sized(known, prior.as_ref(), j, covariance, 1.0, None)?;
    Ok((Some(inertia), Some(covariance)))
}
