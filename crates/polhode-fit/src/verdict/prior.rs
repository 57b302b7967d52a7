//! Whether a prior tensor, the limits and the record agree.

use crate::columns::effect::Class;
use crate::error::FitError;
use crate::physical::constraint::ActiveConstraint;
use crate::physical::coordinates::{Coordinates, ENTRIES, tensor};
use crate::physical::failure::SolverFailure;
use crate::physical::nearest::{Normal, nearest};
use crate::physical::prior::{Prior, Told};
use crate::report::nuisance::Agreement;
use crate::settings::Settings;
use crate::solve::joint::Joint;
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::judgement::{EXCLUDED, OUTSIDE};

/// A prior that limits and law allow.
pub(crate) fn consistent(prior: &Prior, settings: &Settings) -> Result<Told, FitError> {
    let prior = prior.told()?;
    let alone = nearest(&prior.shape(), &settings.limits, &[])?;
    let pulls = |c: &&ActiveConstraint| c.multiplier;
    if let Some(active) = alone.active.iter().max_by(|a, b| pulls(a).total_cmp(&pulls(b)))
        && alone.pull > OUTSIDE
    {
        return Err(FitError::PriorOutside { constraint: active.constraint, pull: alone.pull });
    }
    Ok(prior)
}

/// What the record tells, joined with the prior, and how they agree.
pub(crate) fn with_prior(
    joint: &Joint,
    weak: &WeakEstimate,
    prior: &Told,
    input: Option<f64>,
) -> Result<(Normal, Option<Agreement>), FitError> {
    let place = joint.kept.iter().position(|&k| weak.columns[k].class() == Class::Input);
    let joined = prior.join(&joint.told, place.zip(input));
    let (told, chi2, dof) = joined.ok_or(FitError::Solver(SolverFailure::Information))?;
    Ok((told, Some(Agreement { chi2, dof })))
}

/// Refuses a prior and a record that exclude each other.
pub(crate) fn check_agreement(
    prior: &Told,
    Agreement { chi2, dof }: Agreement,
    x: &Coordinates,
) -> Result<(), FitError> {
    if chi2 <= EXCLUDED[dof.clamp(5, 6) - 5] {
        return Ok(());
    }
    let six = |x: &Coordinates| ENTRIES.map(|entry| tensor(x)[entry]);
    Err(FitError::PriorContradicted {
        prior: six(&prior.x),
        record: Box::new(six(x)),
        chi2,
        dof,
        mirror: None,
    })
}
