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
    /// Log-likelihood less that without a torque; each coefficient adds a half where it is of no use.
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
    /// Log-likelihood less that without torque and error.
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
