//! What a record says of its fit: computed once, and matched.

use nalgebra::Matrix3;

use crate::error::FitError;
use crate::physical::coordinates::{Form, tensor};
use crate::physical::failure::SolverFailure;
use crate::physical::prior::Told;
use crate::report::averages;
use crate::report::identifiability::Identifiability;
use crate::report::torque_free::trends;
use crate::settings::Settings;
use crate::settings::torque::TorqueModel;
use crate::signal::stretch::Stretch;
use crate::solve::completed::{Completed, completed};
use crate::solve::ladder::Chosen;
use crate::solve::weak_estimate::WeakEstimate;
use crate::thresholds::judgement::UNTOLD;
use crate::thresholds::rounds::ROUNDS;
use crate::verdict::prior::consistent;

/// What a record says of its fit.
pub(crate) enum Verdict {
    /// The rates change, and no tensor explains them.
    Unsettled,
    /// It cannot tell coefficients of the torque that was asked for.
    UntoldTorque {
        names: Vec<&'static str>,
        /// How many of the five numbers of the tensor are determined with them.
        rank: usize,
    },
    /// It leaves numbers of the tensor open.
    Undetermined(Identifiability),
    /// It leaves numbers open that a prior supplies.
    Completed(Box<Supported>, Box<Completed>),
    /// It determines the tensor.
    Determined(Box<Supported>),
}

/// What an answer rests on beside the weak estimate.
pub(crate) struct Supported {
    pub(crate) identifiability: Identifiability,
    pub(crate) prior: Option<Told>,
}

/// A record that is judged, in its own units.
pub(crate) struct Case<'a> {
    pub(crate) stretches: &'a [Stretch],
    pub(crate) settings: &'a Settings,
    pub(crate) variance: f64,
    /// Unit of the rates, rad/s.
    pub(crate) rms: f64,
    /// Whether wheels or torques of the record give the tensor its size.
    pub(crate) is_sized: bool,
}

impl Case<'_> {
    /// The verdict on what was chosen.
    pub(crate) fn judge(&self, chosen: &Chosen) -> Result<Verdict, FitError> {
        let Case { stretches, settings, variance, .. } = *self;
        let weak = &chosen.weak;
        let misfit = weak.misfit(variance);
        let prior = settings.prior.as_ref().map(|prior| consistent(prior, settings)).transpose()?;
        // what the noise does not explain enlarges the deviations
        let enlarged = variance * misfit.max(1.0);
        let singular = || FitError::Solver(SolverFailure::Covariance);
        let identifiability = identify(weak, stretches, enlarged).ok_or_else(singular)?;
        let is_open = !weak.has_settled() || !identifiability.complete();
        let filling = prior.as_ref().filter(|_| is_open && !self.is_sized);
        let filled =
            filling.and_then(|prior| completed(stretches, weak, &prior.shape_root(), prior.x, variance));
        if let Some(filled) = filled {
            let identifiability =
                Identifiability::new(&filled.alone, &scatter_of(stretches), &tensor(&filled.weak.x()));
            return Ok(Verdict::Completed(Box::new(Supported { identifiability, prior }), Box::new(filled)));
        }
        if !weak.has_settled() && misfit > weak.expected_misfit() {
            return Ok(Verdict::Unsettled);
        }
        let names = untold(weak, stretches, enlarged, &identifiability);
        // of a torque that was not asked for the message could ask for nothing simpler
        if settings.torque != TorqueModel::Auto && !names.is_empty() {
            return Ok(Verdict::UntoldTorque { names, rank: identifiability.rank });
        }
        match identifiability.complete() {
            true => Ok(Verdict::Determined(Box::new(Supported { identifiability, prior }))),
            false => Ok(Verdict::Undetermined(identifiability)),
        }
    }

    /// The rates are not constant, and still no tensor explains them.
    pub(crate) fn unsettled(&self, weak: &WeakEstimate, factor: Option<f64>) -> FitError {
        let Case { stretches, settings, variance, rms, .. } = *self;
        let misfit = weak.misfit(variance);
        let axes = averages::axes(stretches, variance);
        let (fall, _) =
            trends(stretches, Clone::clone, &(Matrix3::identity() / 3.0), variance * misfit.max(1.0), |_| {
                Matrix3::zeros()
            });
        let fall = (settings.torque == TorqueModel::None && fall.rate < 0.0 && fall.significant())
            .then_some(-fall.rate * rms);
        FitError::Unsettled { rounds: ROUNDS, noise: variance.sqrt() * rms, factor, axes, fall, mirror: None }
    }
}

/// Coefficients of torque that the record cannot tell: from the tensor, which it would determine without them, or at all.
fn untold(
    weak: &WeakEstimate,
    stretches: &[Stretch],
    variance: f64,
    identifiability: &Identifiability,
) -> Vec<&'static str> {
    let Some(stacked) = &weak.stacked else { return Vec::new() };
    let torques: Vec<usize> =
        (0..weak.columns.len()).filter(|&k| weak.columns[k].class().is_torque()).collect();
    if torques.is_empty() {
        return Vec::new();
    }
    let mut names = Vec::new();
    let mut name = |k: usize| {
        let name = weak.columns[k].label().name;
        if !names.contains(&name) {
            names.push(name);
        }
    };
    if identifiability.complete() {
        let Some(factor) = stacked.joint_factor() else { return Vec::new() };
        let fitted = |k: usize| {
            weak.columns[k].segment.is_none_or(|s| weak.parts.iter().any(|part| part.stretch == s))
        };
        let vague = |k: usize| factor.row(k).norm() * variance.sqrt() > UNTOLD;
        torques.iter().copied().filter(|&k| fitted(k) && vague(k)).for_each(&mut name);
        return names;
    }
    let without = weak.without(&torques, variance.sqrt());
    let known = without.and_then(|root| identify_by(&root, weak, stretches, variance));
    if known.is_some_and(|known| known.complete()) {
        torques.into_iter().for_each(&mut name);
    }
    names
}

fn identify_by(
    root: &Form,
    weak: &WeakEstimate,
    stretches: &[Stretch],
    variance: f64,
) -> Option<Identifiability> {
    let svd = (root / variance.sqrt()).svd(false, true);
    let directions = svd.v_t?.transpose();
    Some(Identifiability::new(&(svd.singular_values, directions), &scatter_of(stretches), &tensor(&weak.x())))
}

fn scatter_of(stretches: &[Stretch]) -> Matrix3<f64> {
    let (mut scatter, mut count) = (Matrix3::zeros(), 0.0);
    for w in stretches.iter().flat_map(|s| &s.rates) {
        scatter += w * w.transpose();
        count += 1.0;
    }
    scatter / count
}

fn identify(weak: &WeakEstimate, stretches: &[Stretch], variance: f64) -> Option<Identifiability> {
    let (singular, directions) = weak.spectrum()?;
    let spectrum = (singular / variance.sqrt(), directions);
    Some(Identifiability::new(&spectrum, &scatter_of(stretches), &tensor(&weak.x())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::column::{Column, Unknowns};
    use crate::columns::drag::Drag;
    use crate::columns::offset::Offset;
    use crate::physical::coordinates::Coordinates;
    use crate::solve::weak_estimate::tests::one_row_each;
    use crate::thresholds::identifiability::VAGUE;
    use nalgebra::Vector3;

    /// A torque is told up to a deviation of one unit of the rate, where the record that tells it was used. Of a record that leaves the tensor open a
    /// torque is to blame where the tensor would be told without it.
    #[test]
    fn torques_that_a_record_cannot_tell_are_found() {
        let stretches = [Stretch::new(vec![0.0, 1.0], vec![Vector3::new(0.5, 0.8, -0.4); 2])];
        let variance = 0.25_f64;
        let of = |drag: Column, deviation: f64, last: f64, rank: usize| {
            let columns = [Column::new(Offset(1), None), drag];
            let at = Unknowns::at(Coordinates::zeros(), &columns);
            // offsets that are open are no torque
            let weights = [1e-2, variance.sqrt() / deviation, 1e3, 1e3, 1e3, 1e3, last];
            let rows = one_row_each(&weights, &[0.0; 7]);
            let weak = WeakEstimate::of_rows(&columns, &at, vec![rows], variance.sqrt());
            let singular = Coordinates::from_fn(|k, _| if k < rank { 1e3 } else { 0.0 });
            let scatter = scatter_of(&stretches);
            let body = Matrix3::from_diagonal(&Vector3::new(0.2, 0.3, 0.5));
            let told = Identifiability::new(&(singular, Form::identity()), &scatter, &body);
            untold(&weak, &stretches, variance, &told)
        };
        let drag = Column::new(Drag, None);
        assert!(of(drag, 0.999 * UNTOLD, 1e3, 5).is_empty());
        assert_eq!(of(drag, 1.001 * UNTOLD, 1e3, 5), ["drag"]);
        // the record has one segment
        assert_eq!(of(drag.of_segment(0), 1.001 * UNTOLD, 1e3, 5), ["drag"]);
        assert!(of(drag.of_segment(1), 1.001 * UNTOLD, 1e3, 5).is_empty());
        assert_eq!(of(drag, 0.5, 1e3, 4), ["drag"]);
        // a number of the tensor is told to 1/√(weight² over the variance)
        assert_eq!(of(drag, 0.5, 1.01 * variance.sqrt() / VAGUE, 4), ["drag"]);
        assert!(of(drag, 0.5, 0.99 * variance.sqrt() / VAGUE, 4).is_empty());
        assert!(of(Column::new(Offset(0), None), 1.001 * UNTOLD, 1e3, 4).is_empty());
    }

    /// The mean of ω ωᵀ counts each sample once, in whatever stretch it is.
    #[test]
    fn the_scatter_is_the_mean_over_all_samples() {
        let three = vec![Vector3::x(), Vector3::y() * 2.0, Vector3::new(1.0, 0.0, 1.0)];
        let one = vec![Vector3::z() * 3.0];
        let stretches = [Stretch::new(vec![0.0, 1.0, 2.0], three), Stretch::new(vec![0.0], one)];
        let expected = Matrix3::new(2.0, 0.0, 1.0, 0.0, 4.0, 0.0, 1.0, 0.0, 10.0) / 4.0;
        assert_eq!(scatter_of(&stretches), expected);
    }

    /// Where no tensor explains rates that fall, their fall is told in 1/s if no torque was to be fitted; a rise is none. The noise is told in the
    /// unit of the rates.
    #[test]
    fn a_fall_is_told_where_no_torque_was_fitted() {
        let at = Unknowns { x: Coordinates::zeros(), c: Vec::new() };
        let weak = WeakEstimate { moved: f64::INFINITY, ..WeakEstimate::plain(Vec::new(), at, 20) };
        let of = |slope: f64, torque: TorqueModel| {
            // energy changes by the slope, momentum by half of it
            let times: Vec<f64> = (0..21).map(f64::from).collect();
            let rate = |t: &f64| Vector3::new(0.6, -0.4, 0.5) * (1.0 + slope * (t - 10.0)).sqrt();
            let stretches = [Stretch::new(times.clone(), times.iter().map(rate).collect())];
            let (stretches, settings) = (&stretches[..], &Settings::default().with_torque(torque));
            let case = Case { stretches, settings, variance: 1e-8, rms: 4.0, is_sized: false };
            match case.unsettled(&weak, Some(2.5)) {
                FitError::Unsettled { rounds, noise, factor, fall, mirror, .. } => {
                    assert!((noise - 4e-4).abs() < 1e-15 && rounds == ROUNDS);
                    assert!(factor == Some(2.5) && mirror.is_none());
                    fall
                }
                other => panic!("{other}"),
            }
        };
        let fall = of(-0.02, TorqueModel::None).unwrap();
        assert!((fall - 0.04).abs() < 1e-10, "{fall}");
        assert_eq!(of(0.02, TorqueModel::None), None);
        assert_eq!(of(-0.02, TorqueModel::Auto), None);
        // within the noise
        assert_eq!(of(-1e-8, TorqueModel::None), None);
    }
}
