//! The torque that attitudes ask for beside torque noise.

use crate::columns::sets::torque_columns;
use crate::models::MODELS;
use crate::models::weighed::{Weighed, asked};
use crate::physical::coordinates::Coordinates;
use crate::settings::torque::TorqueModel;
use crate::smoothed::search::{Found, Noise};

/// A model with its torque.
pub(crate) struct Chosen {
    pub(crate) found: Found,
    pub(crate) model: TorqueModel,
    /// Log-likelihood with the torque less that without.
    pub(crate) gain: f64,
    /// The coordinates without it.
    pub(crate) without: Coordinates,
    /// What each torque makes of the attitudes.
    pub(crate) models: Vec<Weighed>,
}

/// The model with the torque that is asked for, or the one that the attitudes ask for, from that without one.
pub(crate) fn choose(none: Found, torque: TorqueModel, noise: Noise) -> Option<Chosen> {
    let floor = none.likelihood;
    let weighed = |model, found: &Found| {
        let factor = found.covariance()?.cholesky()?.l();
        let gain = found.likelihood - floor;
        let has_noise = found.level.torque > 0.0;
        Some(Weighed { model, error: None, has_noise, gain, x: found.at.x, factor, held_out: None })
    };
    let mut models: Vec<Weighed> = Vec::new();
    let without = none.at.x;
    let mut best: Option<(f64, TorqueModel, Found)> = None;
    for model in MODELS {
        let found = match model {
            TorqueModel::None => Some(none.clone()),
            // a torque changes what passes for its noise
            _ => none.with(&torque_columns(model), noise),
        };
        let Some(found) = found.filter(|found| found.is_still) else { continue };
        models.extend(weighed(model, &found));
        let score = if torque == model { f64::INFINITY } else { found.likelihood - floor - asked(model) };
        let is_candidate = torque == model || torque == TorqueModel::Auto;
        if is_candidate && best.as_ref().is_none_or(|(highest, ..)| score > *highest) {
            best = Some((score, model, found));
        }
    }
    let (_, model, found) = best?;
    Some(Chosen { gain: found.likelihood - floor, found, model, without, models })
}
