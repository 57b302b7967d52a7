//! Whether one component of the momentum of wheels is told too large or too small.

use crate::columns::column::Column;
use crate::columns::effect::Class;
use crate::columns::sets::{told_components, torque_columns};
use crate::columns::wheel_axis::WheelAxis;
use crate::error::{FitError, ToldComponent};
use crate::report::suspect::gain_of_told;
use crate::settings::torque::TorqueModel;
use crate::signal::stretch::Stretch;
use crate::solve::ladder::{Chosen, Demand, climb, likelihood};
use crate::solve::radius::{Ends, estimate, pilot};
use crate::solve::rounds::Noise;
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::judgement::{AS_LIKELY, CALMER, ENORMOUS, PLAUSIBLE, TOLD, WIDER};
use crate::thresholds::warnings::SENSOR;
use crate::verdict::driven::{is_explained, is_noise};

/// Refuses momenta of wheels that explain the rates with one component so many times as large, and as they are do not without torques at
/// random; also where these are a part of both, and by far the smaller one with that component.
pub(crate) fn check_told(
    chosen: &Chosen,
    demand: Demand<'_>,
    stretches: &[Stretch],
    variance: f64,
    rms: f64,
) -> Result<(), FitError> {
    let components = told_components(stretches);
    if components.is_empty() || is_explained(chosen, variance) {
        return Ok(());
    }
    let part = pilot(stretches);
    let torques = [TorqueModel::Drag, TorqueModel::Constant].into_iter().flat_map(torque_columns);
    let torques: Vec<Column> = torques.collect();
    let as_told = likelihood(&chosen.weak, variance);
    let explaining = components.into_iter().filter_map(|axis| {
        let own = Column::new(WheelAxis(axis), None);
        let columns: Vec<Column> = demand.columns.iter().copied().chain([own]).collect();
        let free = Demand { torque: TorqueModel::Auto, noise: Noise::Fitted, columns: &columns, ..demand };
        // quick, and of most of them no
        let with_torques: Vec<Column> = torques.iter().chain(&columns).copied().collect();
        let quick = estimate(&part, demand.radius, &with_torques, variance, Ends::Torques).ok().flatten();
        if quick.is_some_and(|weak| weak.has_settled() && is_noise(&weak, variance)) {
            let found = climb(stretches, free, variance).ok()?;
            let sees_as_much = found.weak.radius <= WIDER * chosen.weak.radius;
            let is_cause = found.weak.has_settled() && is_explained(&found, variance) && sees_as_much;
            return Some((f64::INFINITY, factor(&found.weak, axis, variance)?)).filter(|_| is_cause);
        }
        let equations = chosen.equations.as_ref()?;
        if gain_of_told(&chosen.weak, stretches, equations, (variance, rms), axis)? <= SENSOR {
            return None;
        }
        // one radius for both, so that their likelihoods are those of the same equations
        let found = climb(stretches, Demand { radius: Some(chosen.weak.radius), ..free }, variance).ok()?;
        let gain = likelihood(&found.weak, variance) - as_told;
        let is_calmer = torque_noise(&found.weak) < CALMER * torque_noise(&chosen.weak);
        let told = factor(&found.weak, axis, variance)?;
        let is_plausible = (1.0 / PLAUSIBLE..=PLAUSIBLE).contains(&told.factor);
        let is_cause = found.weak.has_settled() && gain > ENORMOUS && is_calmer && is_plausible;
        Some((gain, told)).filter(|_| is_cause)
    });
    let explaining: Vec<(f64, ToldComponent)> =
        explaining.filter(|(_, told)| (told.factor - 1.0).abs() > TOLD * told.sigma).collect();
    let most = explaining.iter().fold(0.0, |most: f64, (gain, _)| most.max(*gain));
    let likely = explaining.into_iter().filter(|(gain, _)| gain + AS_LIKELY >= most).map(|(_, told)| told);
    match likely.collect::<Vec<ToldComponent>>() {
        told if told.is_empty() => Ok(()),
        told => Err(FitError::Told(told)),
    }
}

/// The largest level of torque noise.
fn torque_noise(weak: &WeakEstimate) -> f64 {
    weak.parts.iter().map(|part| part.levels.torque).fold(0.0, f64::max)
}

/// How many times as large as told a component is.
fn factor(weak: &WeakEstimate, axis: usize, variance: f64) -> Option<ToldComponent> {
    let own = Column::new(WheelAxis(axis), None);
    let is_input = |column: &Column| column.class() == Class::Input;
    let input = weak.columns.iter().position(is_input)?;
    let further = weak.columns.iter().position(|column| column.is_alike(&own))?;
    let (all, more) = (weak.at.c[input], weak.at.c[further]);
    let spread = weak.stacked.as_ref()?.joint_factor()?;
    // of 1 + c/u
    let slope = spread.row(further) / all - spread.row(input) * (more / (all * all));
    let deviation = (variance * weak.misfit(variance).max(1.0)).sqrt();
    Some(ToldComponent { axis, factor: 1.0 + more / all, sigma: slope.norm() * deviation })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::column::Unknowns;
    use crate::columns::input::Input;
    use crate::physical::coordinates::Coordinates;
    use crate::solve::stacked::Stacked;

    /// An estimate of the factor u = 0.5 of all momenta and of c = 0.1 beside it for the y axis, which are known to a fiftieth and a
    /// hundredth of the noise, each by itself.
    fn estimate(columns: Vec<Column>) -> WeakEstimate {
        let at = Unknowns { x: Coordinates::zeros(), c: vec![0.5, 0.1] };
        let rows: Vec<f64> = (0..7)
            .flat_map(|i| (0..8).map(move |k| if i == k { [50.0, 100.0, 10.0][i.min(2)] } else { 0.0 }))
            .collect();
        let stacked = Stacked::new(&[rows.as_slice()], &columns, &at, 1.0);
        let root = stacked.root;
        WeakEstimate { root, squares: 100.0, stacked: Some(stacked), ..WeakEstimate::plain(columns, at, 105) }
    }

    /// A component is 1 + c/u times as large as told, with the deviation of that: of c over u, and of u times c/u².
    #[test]
    fn a_component_is_so_many_times_as_large() {
        let (input, own) = (Column::new(Input, None), Column::new(WheelAxis(1), None));
        let weak = estimate(vec![input, own]);
        // of a variance of 0.25 the misfit is 4: the deviation of a reading is 1
        let told = factor(&weak, 1, 0.25).unwrap();
        assert!(told.axis == 1 && (told.factor - 1.2).abs() < 1e-15, "{told:?}");
        let (of_c, of_u): (f64, f64) = (0.01 / 0.5, 0.02 * 0.1 / 0.25);
        let sigma = (of_c * of_c + of_u * of_u).sqrt();
        assert!((told.sigma / sigma - 1.0).abs() < 1e-8, "{told:?} {sigma}");
        // what is less than the noise narrows nothing
        let quiet = factor(&weak, 1, 4.0).unwrap();
        assert!((quiet.sigma / (2.0 * sigma) - 1.0).abs() < 1e-8, "{quiet:?} {sigma}");
        assert!(factor(&weak, 0, 0.25).is_none() && factor(&weak, 2, 0.25).is_none());
        assert!(factor(&estimate(vec![own, own]), 1, 0.25).is_none());
    }
}
