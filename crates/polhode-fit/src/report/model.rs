//! What each model of the torque makes of a record.

use crate::models::weighed::{Weighed, shares};
use crate::physical::coordinates::{eigen, tensor};
use crate::report::answer::{ratios, sigmas};
use crate::settings::torque::TorqueModel;
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

/// Of each model beside the `chosen` one, with what the free `motion` of its tensor explains.
pub(crate) fn models(weighed: &[Weighed], chosen: TorqueModel, motion: Option<&Motion>) -> Vec<ModelFit> {
    let each = weighed.iter().zip(shares(weighed, chosen));
    each.map(|(one, share)| {
        let j = tensor(&one.x);
        let (moments, axes) = eigen(j);
        let v = [0, 1, 2].map(|k| axes.column(k).into_owned());
        let ratios = ratios(&one.factor, &v, &moments);
        ModelFit {
            model: one.model,
            gain: one.gain,
            share,
            principal: moments.into(),
            sigma_principal: sigmas(&one.factor, &v, &moments).0,
            ratios: ratios.map(|r| r.0),
            sigma_ratios: ratios.map(|r| r.1),
            unexplained: motion.and_then(|motion| motion.unexplained(&j)),
            held_out: one.held_out,
        }
    })
    .collect()
}
