//! Whether a body is driven: pushed by more than drag, a constant torque and small torques at random.

use crate::error::FitError;
use crate::physical::constraint::Constraint;
use crate::report::estimate::Estimate;
use crate::report::torque_free::InvariantTrend;
use crate::signal::stretch::Stretch;
use crate::thresholds::judgement::{DRIVEN, GROWN, GROWN_BY_HALF, OUTSIDE_OF_LAW};
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
