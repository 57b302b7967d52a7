//! What each model of the torque makes of a record, and each error of the record without one.

use core::fmt;

use crate::models::reading_error::ReadingError;
use crate::models::weighed::{Weighed, shares};
use crate::physical::coordinates::{eigen, tensor};
use crate::report::answer::{ratios, sigmas};
use crate::settings::torque::TorqueModel;
use crate::thresholds::warnings::AS_WELL;
use crate::units::Motion;

/// What a model of the torque makes of a record, before law and limits are imposed.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct ModelFit {
    /// The model.
    pub model: TorqueModel,
    /// Whether a level of torque noise is one of its unknowns: such noise may take the place of a torque.
    pub has_torque_noise: bool,
    /// Log-likelihood less that without a torque; each coefficient adds a half where it is of no use. Of a model that was not fitted by
    /// itself it is that of the first order about the answer: far below zero it says that the model is refuted, and not by how much.
    pub gain: f64,
    /// Its share among all, each with its likelihood less one for every coefficient.
    pub share: f64,
    /// Principal moments, ascending, as shares of the trace.
    pub principal: [f64; 3],
    /// Their standard deviations under this model alone.
    pub sigma_principal: [f64; 3],
    /// I₁/I₃ and I₂/I₃.
    pub ratios: [f64; 2],
    /// Their standard deviations under this model alone.
    pub sigma_ratios: [f64; 2],
    /// Share of |dω/dt|² that the free motion of this tensor leaves unexplained, as [`Estimate::unexplained`](crate::Estimate::unexplained).
    pub unexplained: Option<f64>,
    /// Mean square of the equations of a segment, over their noise, at what the other segments say; 1 where the model is right. `None` of
    /// one segment.
    pub held_out: Option<f64>,
}

/// What an error of the sensor, or of the momentum of wheels as it is told, makes of a record in the place of a torque, before law and limits are imposed.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorFit {
    /// The error.
    pub error: ReadingError,
    /// Its largest component: an angle, rad, a ratio, an offset, rad/s, or a delay, s.
    pub size: f64,
    /// Whether torque noise acts beside it.
    pub has_torque_noise: bool,
    /// Log-likelihood less that without torque and error, of the first order as that of [`ModelFit::gain`].
    pub gain: f64,
    /// Its share among the models, as [`ModelFit::share`]; zero where no torque was chosen and it explains little.
    pub share: f64,
    /// Principal moments, ascending, as shares of the trace.
    pub principal: [f64; 3],
    /// Their standard deviations with this error, without a torque.
    pub sigma_principal: [f64; 3],
    /// I₁/I₃ and I₂/I₃.
    pub ratios: [f64; 2],
    /// Their standard deviations with this error, without a torque.
    pub sigma_ratios: [f64; 2],
    /// As [`ModelFit::held_out`].
    pub held_out: Option<f64>,
}

impl fmt::Display for ErrorFit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.error, self.error.of_size(self.size))
    }
}

/// Principal moments and ratios of a tensor, each with its standard deviation.
struct Shown {
    principal: [f64; 3],
    sigma_principal: [f64; 3],
    ratios: [f64; 2],
    sigma_ratios: [f64; 2],
}

impl Shown {
    fn of(one: &Weighed) -> Shown {
        let (moments, axes) = eigen(tensor(&one.x));
        let v = [0, 1, 2].map(|k| axes.column(k).into_owned());
        let ratios = ratios(&one.factor, &v, &moments);
        Shown {
            principal: moments.into(),
            sigma_principal: sigmas(&one.factor, &v, &moments).0,
            ratios: ratios.map(|r| r.0),
            sigma_ratios: ratios.map(|r| r.1),
        }
    }
}

/// Of each model beside the `chosen` one, with what the free `motion` of its tensor explains.
pub(crate) fn models(weighed: &[Weighed], chosen: TorqueModel, motion: Option<&Motion>) -> Vec<ModelFit> {
    let each = weighed.iter().zip(shares(weighed, chosen)).filter(|(one, _)| one.error.is_none());
    each.map(|(one, share)| {
        let Shown { principal, sigma_principal, ratios, sigma_ratios } = Shown::of(one);
        ModelFit {
            model: one.model,
            has_torque_noise: one.has_noise,
            gain: one.gain,
            share,
            principal,
            sigma_principal,
            ratios,
            sigma_ratios,
            unexplained: motion.and_then(|motion| motion.unexplained(&tensor(&one.x))),
            held_out: one.held_out,
        }
    })
    .collect()
}

/// Of each error of the record beside them.
pub(crate) fn reading_errors(weighed: &[Weighed], chosen: TorqueModel) -> Vec<ErrorFit> {
    let each = weighed.iter().zip(shares(weighed, chosen)).filter_map(|(one, share)| {
        let (error, size) = one.error?;
        let Shown { principal, sigma_principal, ratios, sigma_ratios } = Shown::of(one);
        let (gain, held_out) = (one.gain, one.held_out);
        Some(ErrorFit {
            error,
            size,
            has_torque_noise: one.has_noise,
            gain,
            share,
            principal,
            sigma_principal,
            ratios,
            sigma_ratios,
            held_out,
        })
    });
    each.collect()
}

/// The error of the record that explains the record without a torque as well as the `chosen` one, and its log-likelihood less that of this.
pub(crate) fn as_well(weighed: &[Weighed], chosen: TorqueModel) -> Option<(ReadingError, f64, f64)> {
    let torque = weighed.iter().find(|one| one.is_torque(chosen)).filter(|_| chosen != TorqueModel::None)?;
    let errors = weighed.iter().filter(|one| one.error.is_some());
    let best = errors.max_by(|a, b| a.score().total_cmp(&b.score()))?;
    let (error, size) = best.error.filter(|_| best.score() > torque.score() - AS_WELL)?;
    Some((error, size, best.gain - torque.gain))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physical::coordinates::{Form, coordinates};
    use nalgebra::{Matrix3, Vector3};

    const DEVIATION: f64 = 1e-3;

    /// A model of moments 0.25, 0.3 and 0.45, whose coordinates have one deviation each and are independent.
    fn of(model: TorqueModel, error: Option<(ReadingError, f64)>, gain: f64) -> Weighed {
        let x = coordinates(&Matrix3::from_diagonal(&Vector3::new(0.45, 0.25, 0.3)));
        let factor = Form::identity() * DEVIATION;
        Weighed { model, error, has_noise: false, gain, x, factor, held_out: Some(1.5) }
    }

    /// Of the errors the one of the highest score counts, where that is at most three below the score of the torque; what is told is its
    /// likelihood over that of the torque.
    #[test]
    fn an_error_explains_as_well_within_three_of_the_score() {
        let torque = of(TorqueModel::Drag, None, 20.0);
        let error = |error, gain| of(TorqueModel::None, Some((error, 0.25)), gain);
        let (delays, offsets) = (ReadingError::Delays, ReadingError::Offsets);
        let found = |errors: &[Weighed], chosen| {
            let all: Vec<Weighed> = core::iter::once(torque.clone()).chain(errors.iter().cloned()).collect();
            as_well(&all, chosen)
        };
        // the scores are 19, 16.75 and 16.5
        let both = [error(delays, 18.75), error(offsets, 19.5)];
        assert_eq!(found(&both, TorqueModel::Drag), Some((delays, 0.25, -1.25)));
        assert_eq!(found(&both[1..], TorqueModel::Drag), Some((offsets, 0.25, -0.5)));
        let most = 20.0 - 1.0 - AS_WELL;
        assert_eq!(found(&[error(delays, most + 2.0)], TorqueModel::Drag), None);
        assert!(found(&[error(delays, most + 2.0 + 1e-9)], TorqueModel::Drag).is_some());
        // of no torque, of one that is not among them, and without errors nothing is said
        assert_eq!(found(&both, TorqueModel::None), None);
        assert_eq!(found(&both, TorqueModel::Constant), None);
        assert_eq!(found(&[], TorqueModel::Drag), None);
    }

    /// Torques and errors are told apart, each with the moments of its tensor and their deviations: the gradients of moments have the squares
    /// 2/3 and the products −1/3.
    #[test]
    fn each_model_has_its_moments_with_their_deviations() {
        let noisy = |one: Weighed| Weighed { has_noise: true, ..one };
        let all = [
            of(TorqueModel::None, None, 0.0),
            noisy(of(TorqueModel::None, Some((ReadingError::Delays, 2.5e-3)), 7.0)),
            noisy(of(TorqueModel::Drag, None, 2.0)),
        ];
        let torques = models(&all, TorqueModel::None, None);
        let errors = reading_errors(&all, TorqueModel::None);
        // a coefficient that gains one weighs as much as none, noise is one, and an error weighs nothing beside no torque
        let told: Vec<_> =
            torques.iter().map(|one| (one.model, one.has_torque_noise, one.gain, one.share)).collect();
        assert_eq!(told, [(TorqueModel::None, false, 0.0, 0.5), (TorqueModel::Drag, true, 2.0, 0.5)]);
        let [error] = &errors[..] else { panic!("{errors:?}") };
        assert_eq!((error.error, error.size, error.gain), (ReadingError::Delays, 2.5e-3, 7.0));
        assert_eq!((error.has_torque_noise, error.share, error.held_out), (true, 0.0, Some(1.5)));
        assert_eq!(error.to_string(), "delays 2.5 ms");
        let near = |found: &[f64], expected: &[f64]| {
            assert_eq!(found.len(), expected.len());
            let apart = found.iter().zip(expected).map(|(a, b)| (a / b - 1.0).abs());
            assert!(apart.fold(0.0, f64::max) < 1e-9, "{found:?} {expected:?}");
        };
        let ratios = [25.0 / 45.0, 30.0 / 45.0];
        // r = a/c varies by (da − r dc)/c
        let of_ratio = |r: f64| DEVIATION * ((2.0 + 2.0 * r + 2.0 * r * r) / 3.0).sqrt() / 0.45;
        for one in &torques {
            assert!(one.unexplained.is_none() && one.held_out == Some(1.5));
            near(&one.principal, &[0.25, 0.3, 0.45]);
            near(&one.sigma_principal, &[DEVIATION * (2.0_f64 / 3.0).sqrt(); 3]);
            near(&one.ratios, &ratios);
            near(&one.sigma_ratios, &ratios.map(of_ratio));
        }
        near(&error.principal, &torques[0].principal);
        near(&error.sigma_principal, &torques[0].sigma_principal);
        near(&error.ratios, &torques[0].ratios);
        near(&error.sigma_ratios, &torques[0].sigma_ratios);
    }
}
