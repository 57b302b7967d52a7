//! Whether a body is driven: pushed by more than drag, a constant torque and small torques at random.

use nalgebra::Vector3;

use crate::error::FitError;
use crate::physical::constraint::Constraint;
use crate::report::estimate::Estimate;
use crate::report::torque_free::InvariantTrend;
use crate::signal::moments::Moments;
use crate::signal::stretch::Stretch;
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::judgement::{AUDIBLE, DRIVEN, GROWN, GROWN_BY_HALF, OUTSIDE_OF_LAW};
use crate::units::Motion;

/// Refuses the tensor of a driven body; `rms` is the unit of the rates.
///
/// Either free motion with drag and a constant torque leaves much of |ω'|² unexplained, or the momentum grows while drag stands
/// at its bound, by half, or less where the tensor is held far from what the record tells without the physical law.
pub(crate) fn check_driven(
    e: &Estimate,
    motion: Option<&Motion>,
    stretches: &[Stretch],
    rms: f64,
) -> Result<(), FitError> {
    let unexplained = motion.and_then(Motion::unexplained_by_torques);
    let trend = e.momentum_trend;
    let growth = trend.map_or(0.0, |trend| trend.rate);
    let longest = stretches.iter().map(Stretch::duration).fold(0.0, f64::max) / rms;
    let is_at_bound =
        e.active_constraints.iter().any(|active| matches!(active.constraint, Constraint::Drag { .. }));
    let least = if e.pull > OUTSIDE_OF_LAW { GROWN } else { GROWN_BY_HALF };
    let grows = is_at_bound && growth * longest > least;
    let is_unexplained = unexplained.is_some_and(|share| share > DRIVEN);
    match is_unexplained || (grows && trend.is_some_and(InvariantTrend::significant)) {
        true => Err(FitError::Driven { unexplained, growth, pull: e.pull }),
        false => Ok(()),
    }
}

/// Refuses momenta of wheels and torques that the rates contradict, by the same share as that of a driven body.
///
/// Here it is that of the equations with these: what the residuals ∫ φ (J ω' + …) dt are of ∫ φ J ω' dt, beyond the noise of the rates in both.
pub(crate) fn check_inputs(
    weak: &WeakEstimate,
    stretches: &[Stretch],
    variance: f64,
) -> Result<(), FitError> {
    let (mut left, mut slopes, mut noise) = (0.0, 0.0, 0.0);
    for part in &weak.parts {
        let stretch = &stretches[part.stretch];
        let tests = &part.linearised.tests;
        let moments = Moments::new(stretch, &vec![Vector3::zeros(); stretch.times.len()], tests);
        let j = part.linearised.terms.j;
        slopes += (0..tests.count).map(|m| (j * moments.readings(m).slope).norm_squared()).sum::<f64>();
        let own = part.linearised.residuals(&weak.at);
        left += own.iter().map(|residual| residual * residual).sum::<f64>();
        noise += own.len() as f64 * part.covariance(stretch).mean_variances().0 * variance;
    }
    let unexplained = (left - noise) / (slopes - noise);
    if noise < AUDIBLE * slopes && unexplained > DRIVEN {
        return Err(FitError::Contradicted { unexplained: unexplained.min(1.0) });
    }
    Ok(())
}
