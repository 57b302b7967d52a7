//! Whether a body is driven: pushed by more than drag, a constant torque and small torques at random.

use nalgebra::Vector3;

use crate::columns::column::Column;
use crate::columns::effect::Class;
use crate::columns::sets::torque_columns;
use crate::error::FitError;
use crate::physical::constraint::Constraint;
use crate::report::estimate::Estimate;
use crate::report::torque_free::InvariantTrend;
use crate::settings::torque::TorqueModel;
use crate::signal::moments::Moments;
use crate::signal::stretch::{KnownInputs, Stretch};
use crate::solve::ladder::{Chosen, Demand, climb};
use crate::solve::radius::{Ends, estimate, pilot};
use crate::solve::rounds::Noise;
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::judgement::{AUDIBLE, DRIVEN, GROWN, GROWN_BY_HALF, OUTSIDE_OF_LAW, WIDER};
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
        left += part.left.iter().map(|residual| residual * residual).sum::<f64>();
        noise += part.left.len() as f64 * part.covariance(stretch).mean_variances().0 * variance;
    }
    let unexplained = (left - noise) / (slopes - noise);
    if noise < AUDIBLE * slopes && unexplained > DRIVEN {
        return Err(FitError::Contradicted { unexplained: unexplained.min(1.0) });
    }
    Ok(())
}

/// Refuses momenta of wheels that explain the rates with their components in another order or with other signs, and as they are do not without
/// torques at random.
pub(crate) fn check_order(
    chosen: &Chosen,
    demand: Demand<'_>,
    stretches: &[Stretch],
    variance: f64,
) -> Result<(), FitError> {
    let turns = |inputs: &KnownInputs| inputs.wheel.iter().any(|h| *h != Vector3::zeros());
    if is_explained(chosen, variance) || !stretches.iter().filter_map(|s| s.inputs.as_ref()).any(turns) {
        return Ok(());
    }
    let free = Demand { torque: TorqueModel::Auto, noise: Noise::Fitted, ..demand };
    let torques = [TorqueModel::Drag, TorqueModel::Constant].into_iter().flat_map(torque_columns);
    let columns: Vec<Column> = torques.chain(demand.columns.iter().copied()).collect();
    let part = pilot(stretches);
    // signs that are all reversed change that of the size alone
    let signs = [[1.0; 3], [-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0]];
    for (order, signs) in ORDERS.iter().flat_map(|order| signs.map(|signs| (*order, signs))).skip(1) {
        let exchanged = |of: &[Stretch]| -> Vec<Stretch> {
            of.iter().map(|stretch| stretch.with_exchanged(order, signs)).collect()
        };
        // quick, and of most of them no
        let quick = estimate(&exchanged(&part), demand.radius, &columns, variance, Ends::Torques);
        let is_likely = |weak: &WeakEstimate| weak.has_settled() && is_noise(weak, variance);
        if !quick.ok().flatten().is_some_and(|weak| is_likely(&weak)) {
            continue;
        }
        let Ok(found) = climb(&exchanged(stretches), free, variance) else { continue };
        let weak = &found.weak;
        let is_input = |column: &Column| column.class() == Class::Input;
        let size = weak.columns.iter().position(is_input).and_then(|place| weak.at.c.get(place));
        // wider test functions see less
        let sees_as_much = weak.radius <= WIDER * chosen.weak.radius;
        if let Some(size) = size
            && is_explained(&found, variance)
            && weak.has_settled()
            && sees_as_much
        {
            return Err(FitError::Exchanged { order, signs: signs.map(|sign| sign * size.signum()) });
        }
    }
    Ok(())
}

/// In which the components of a vector may be written; first as they are.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]];

/// Whether an estimate needs no torque noise, and leaves no more than noise.
pub(super) fn is_explained(chosen: &Chosen, variance: f64) -> bool {
    !chosen.weak.has_torque_noise() && is_noise(&chosen.weak, variance)
}

pub(super) fn is_noise(weak: &WeakEstimate, variance: f64) -> bool {
    weak.misfit(variance) <= weak.expected_misfit()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::column::Unknowns;
    use crate::physical::coordinates::Coordinates;
    use crate::signal::covariance::Levels;
    use crate::signal::test_functions::TestFunctions;
    use crate::solve::linearised::Linearised;
    use crate::solve::weak_estimate::Part;

    /// A sphere turns steadily, so that its equations leave all that the rates change by. Momenta contradict the rates where more than 15 % of
    /// that is left beyond the noise, if less than half is noise, and no more than all of it is told.
    #[test]
    fn momenta_are_refused_by_what_they_leave() {
        let times: Vec<f64> = (0..=200).map(|k| 0.1 * f64::from(k)).collect();
        let rate = |t: &f64| Vector3::new(libm::sin(*t), libm::cos(2.0 * t), 0.5);
        let stretch = Stretch::new(times.clone(), times.iter().map(rate).collect());
        let tests = TestFunctions::new(&stretch, 1.0).unwrap();
        let at = Unknowns { x: Coordinates::zeros(), c: Vec::new() };
        let found = |left: f64, noise: f64| {
            let raw = vec![Vector3::zeros(); times.len()];
            let linearised = Linearised::new(&stretch, &raw, &[], at.clone(), tests.clone());
            let residuals = linearised.residuals(&at);
            let all: f64 = residuals.iter().map(|r| r * r).sum();
            let left = residuals.iter().map(|r| r * left.sqrt()).collect();
            let (white, _) = linearised.covariance(&stretch, &raw).mean_variances();
            let variance = noise * all / (3 * tests.count) as f64 / white;
            let mut weak = WeakEstimate::of_rows(&[], &at, Vec::new(), 1.0);
            let (levels, rows) = (Levels::WHITE, Vec::new());
            weak.parts =
                vec![Part { stretch: 0, linearised, rows, left, levels, log_determinant: 0.0, noise: raw }];
            check_inputs(&weak, core::slice::from_ref(&stretch), variance)
        };
        let told = |left: f64, noise: f64| match found(left, noise) {
            Err(FitError::Contradicted { unexplained }) => Some(unexplained),
            other => {
                assert_eq!(other, Ok(()));
                None
            }
        };
        for noise in [0.0, 0.1] {
            let most = DRIVEN * (1.0 - noise) + noise;
            assert_eq!(told(0.999 * most, noise), None, "{noise}");
            let unexplained = told(1.001 * most, noise).unwrap();
            assert!(
                (unexplained * (1.0 - noise) / (1.001 * most - noise) - 1.0).abs() < 1e-9,
                "{unexplained}"
            );
        }
        assert_eq!(told(4.0, 0.0), Some(1.0));
        assert!(told(0.9, 0.999 * AUDIBLE).is_some() && told(0.9, 1.001 * AUDIBLE).is_none());
    }
}
