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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::constraint::Constraint;
    use crate::physical::limits::{Limit, side};
    use nalgebra::{Matrix3, Vector3};

    /// Five numbers or six exclude each other beyond their own thresholds, and both tensors are told with the trace 1.
    #[test]
    fn a_prior_and_a_record_exclude_each_other_beyond_their_threshold() {
        let tensor = Matrix3::new(2.0, 0.2, -0.1, 0.2, 3.0, 0.3, -0.1, 0.3, 5.0);
        let prior = Prior::relative(tensor, 0.01).told().unwrap();
        let x = Coordinates::zeros();
        for (dof, most) in [(5, EXCLUDED[0]), (6, EXCLUDED[1])] {
            assert_eq!(check_agreement(&prior, Agreement { chi2: most, dof }, &x), Ok(()));
            let found = check_agreement(&prior, Agreement { chi2: 1.001 * most, dof }, &x);
            let Err(FitError::PriorContradicted { prior, record, chi2, dof: of, .. }) = &found else {
                panic!("{found:?}")
            };
            assert!(*chi2 == 1.001 * most && *of == dof);
            for (found, expected) in prior.iter().zip([0.2, 0.3, 0.5, 0.02, -0.01, 0.03]) {
                assert!((found - expected).abs() < 1e-14, "{prior:?}");
            }
            let third = 1.0 / 3.0;
            assert_eq!(**record, [third, third, third, 0.0, 0.0, 0.0]);
        }
    }

    /// A prior may lie outside of the law by a few of its deviations, and of the limits too; further off, what pulls most is named.
    #[test]
    fn a_prior_far_outside_of_law_or_limits_is_refused() {
        // the deviation of the largest moment is 0.01 √((1 − 0.55)² 0.55² + 0.55² (0.2² + 0.25²)) = 0.0030
        let of = |largest: f64, limits: Vec<Limit>| {
            let j = Matrix3::from_diagonal(&Vector3::new(0.2, 0.8 - largest, largest));
            consistent(&Prior::relative(j, 0.01), &Settings::default().with_limits(limits)).err()
        };
        assert!(of(0.505, Vec::new()).is_none() && of(0.45, Vec::new()).is_none());
        let Some(FitError::PriorOutside { constraint, pull }) = of(0.55, Vec::new()) else { panic!() };
        assert!(constraint == Constraint::Triangle && pull > OUTSIDE);
        let limit = Limit { axis: Vector3::x(), at_least: Some(0.25), at_most: None };
        let Some(FitError::PriorOutside { constraint, .. }) = of(0.45, vec![limit]) else { panic!() };
        assert_eq!(constraint, side(0, &limit, false));
    }
}
