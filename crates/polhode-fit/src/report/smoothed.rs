//! The report on attitudes of a body on which torques act.

use nalgebra::{DMatrix, DVector, Matrix3};

use crate::columns::sets::torque_columns;
use crate::error::FitError;
use crate::models::weighed::spread;
use crate::physical::coordinates::{Form, eigen, tensor};
use crate::physical::failure::SolverFailure;
use crate::physical::law::LARGEST_SHARE;
use crate::physical::nearest::{Normal, nearest};
use crate::poses::fault::PoseFault;
use crate::poses::free::Read;
use crate::report::answer::{Answer, of_entries, ratios, sigmas};
use crate::report::attitudes::AttitudeFit;
use crate::report::deviations::{Deviations, deviations};
use crate::report::estimate::{Estimate, Method, Residuals};
use crate::report::exact::{Told, absolute, identify};
use crate::report::model::models;
use crate::report::nuisance::{Agreement, FittedTorque, Nuisance, SegmentSummary, WithoutSegment};
use crate::report::torque_free::Whiteness;
use crate::report::warnings::of_smoothed;
use crate::settings::Settings;
use crate::settings::torque::TorqueModel;
use crate::signal::covariance::{Shape, acceleration_density};
use crate::signal::stretch::Stretch;
use crate::smoothed::choice::Chosen;
use crate::verdict::prior::{check_agreement, consistent};

/// Everything that can be said of the answer; `read` is what was known of the attitudes before.
pub(crate) fn report(
    repeated: usize,
    settings: &Settings,
    read: &Read,
    chosen: &Chosen,
    told: Told,
) -> Result<Estimate, FitError> {
    let found = &chosen.found;
    let singular = || FitError::Solver(SolverFailure::Information);
    let squares: f64 = found.whitened.iter().flatten().map(|(_, left)| left.norm_squared()).sum();
    let misfit = squares / found.dof.max(1.0);
    // what the noise does not explain enlarges the deviations
    let excess = misfit.max(1.0);
    let own = found.covariance().ok_or_else(singular)? * excess;
    let of_choice = match settings.torque {
        TorqueModel::Auto => spread(&chosen.models, chosen.model),
        _ => Form::zeros(),
    };
    let covariance = own + of_choice;
    let information = covariance.cholesky().ok_or_else(singular)?.inverse();
    let rates: Vec<Stretch> = found
        .tracks
        .iter()
        .zip(&found.paths)
        .map(|(track, path)| Stretch::new(track.times.clone(), path.iter().map(|at| at.rate).collect()))
        .collect();
    let identifiability = identify(&rates, &found.at.x, &information);
    let prior = settings.prior.as_ref().map(|prior| consistent(prior, settings)).transpose()?;
    if !identifiability.complete() {
        return Err(FitError::Unidentifiable(Box::new(identifiability)));
    }
    if !found.is_still {
        return Err(PoseFault::Unsettled.into());
    }
    let root = information.cholesky().ok_or_else(singular)?.l().transpose();
    let own = Normal {
        centre: DVector::from_column_slice(found.at.x.as_slice()),
        root: DMatrix::from_column_slice(5, 5, root.as_slice()),
    };
    let (joined, agreed) = match &prior {
        None => (own, None),
        Some(prior) => {
            let (joined, chi2, dof) = prior.join(&own, None).ok_or_else(singular)?;
            let agreed = Agreement { chi2, dof };
            check_agreement(prior, agreed, &found.at.x)?;
            (joined, Some(agreed))
        }
    };
    let answer = nearest(&joined, &settings.limits, &[])?;
    let Deviations { free: factor, on_face, .. } = deviations(&joined, &[], &settings.limits, &[], &answer)?;
    let Answer { shape, moments, axes, v } = Answer::new(&answer.x)?;
    let (sigma_principal, sigma_axes) = sigmas(&on_face, &v, &moments);
    let ratios = ratios(&on_face, &v, &moments);
    let (j, both) = (shape.tensor(), on_face * on_face.transpose());
    let (inertia, inertia_covariance) =
        absolute(settings, (&rates, 0.0, None), read.unit, chosen.model, &j, &both, &answer.x)?;
    let residuals: Vec<Residuals> = found
        .whitened
        .iter()
        .zip(&found.tracks)
        .zip(&read.used)
        .map(|((left, track), &(segment, middle))| {
            let values: Vec<[f64; 3]> = left.iter().map(|(_, left)| (*left).into()).collect();
            let squares: f64 = values.iter().flatten().map(|v| v * v).sum();
            Residuals {
                segment,
                times: left.iter().map(|(sample, _)| middle + track.times[*sample] / read.unit).collect(),
                mean_square: squares / (3 * values.len()).max(1) as f64,
                values,
            }
        })
        .collect();
    let density = torque_noise(chosen, read.unit, &j);
    let noise_sigma = found.variance.sqrt() * excess.sqrt();
    let left_out: usize = found.tracks.iter().flat_map(|t| &t.used).filter(|used| !**used).count();
    let attitudes = AttitudeFit {
        noise_sigma,
        noise_is_given: settings.attitude_noise.is_some(),
        residual: found.variance.sqrt() * misfit.sqrt(),
        local_noise: read.local_noise,
        is_inverse: told.is_inverse,
        direction_gain: told.gain,
        largest_turn: read.largest_turn,
        left_out: read.jumps + left_out,
        repeated,
        alignment: None,
    };
    let mut estimate = Estimate {
        principal: moments.into(),
        sigma_principal,
        axes,
        sigma_axes,
        ratios: ratios.map(|r| r.0),
        sigma_ratios: ratios.map(|r| r.1),
        covariance: of_entries(&on_face),
        free_covariance: of_entries(&factor),
        bound: None,
        bound_ratio: None,
        inertia,
        inertia_covariance,
        quanta: [0.0; 3],
        rms_rate: read.unit,
        noise_sigma: 0.0,
        chi2_per_dof: misfit + answer.pull * answer.pull / found.dof.max(1.0),
        pull: answer.pull,
        dof: found.dof as usize,
        samples: found.whitened.iter().map(Vec::len).sum(),
        segments: read.used.len(),
        method: Method::Smoother,
        radius: None,
        identifiability,
        triangle_slack: (2.0 * (LARGEST_SHARE - moments[2])).max(0.0),
        active_constraints: answer.active,
        certificate: answer.certificate,
        momentum_trend: None,
        energy_trend: None,
        whiteness: Whiteness::new(residuals.iter().map(|r| r.values.as_flattened())),
        torque: torque(chosen, excess, read.unit, settings.torque == TorqueModel::Auto),
        models: models(&chosen.models, chosen.model, None),
        reading_errors: Vec::new(),
        nuisances: Vec::new(),
        systematic: Vec::new(),
        prior: agreed,
        per_segment: summaries(chosen, read, &information, (excess, of_choice), density),
        unexplained: None,
        attitudes: Some(attitudes),
        mirror: None,
        sigma_mirror: None,
        spikes: Vec::new(),
        residuals,
        warnings: Vec::new(),
        shape,
    };
    let known = settings.attitude_noise.or(read.local_noise);
    let over = known.map(|known| found.variance * misfit / (known * known));
    estimate.warnings = of_smoothed(&estimate, over, density);
    Ok(estimate)
}

/// Power spectral density of the angular acceleration, (rad/s²)² s.
fn torque_noise(chosen: &Chosen, unit: f64, j: &Matrix3<f64>) -> f64 {
    let level = chosen.found.level;
    let shape = if level.shape == 0 { Shape::Moments } else { Shape::Alike };
    level.torque * chosen.found.variance * acceleration_density(shape, j) * unit * unit * unit
}

fn torque(chosen: &Chosen, excess: f64, unit: f64, is_chosen: bool) -> FittedTorque {
    let found = &chosen.found;
    let covariance = found.information.clone().cholesky().map(|c| c.inverse() * excess);
    let each = torque_columns(chosen.model).into_iter().zip(&found.at.c).enumerate();
    let coefficients = each.map(|(k, (column, value))| {
        let sigma = covariance.as_ref().map_or(f64::INFINITY, |c| c[(5 + k, 5 + k)].sqrt());
        Nuisance::new(&column, *value, sigma, unit)
    });
    let (moments, _) = eigen(tensor(&chosen.without));
    let acts = is_chosen && chosen.model != TorqueModel::None;
    FittedTorque {
        model: chosen.model,
        is_chosen,
        coefficients: coefficients.collect(),
        gain: acts.then_some(chosen.gain),
        ratios_without: acts.then(|| [moments[0] / moments[2], moments[1] / moments[2]]),
    }
}

/// Each segment and its share of the information.
fn summaries(
    chosen: &Chosen,
    read: &Read,
    total: &Form,
    (excess, of_choice): (f64, Form),
    density: f64,
) -> Vec<SegmentSummary> {
    let inverse = total.cholesky().map(|c| c.inverse());
    let found = &chosen.found;
    let tracks = read.used.iter().zip(&found.tracks);
    let each =
        tracks.zip(found.of_each.iter().zip(&found.without)).map(|((&(segment, _), track), (own, rest))| {
            SegmentSummary {
                segment,
                samples: track.used.iter().filter(|used| **used).count(),
                noise_sigma: 0.0,
                torque_noise: density,
                weight: inverse.map_or(0.0, |inverse| (inverse * own).trace() / 5.0),
                without: rest.map(|(step, covariance)| {
                    let shift = step.dot(&(total * step)).sqrt();
                    WithoutSegment::new(&(found.at.x + step), &(covariance * excess + of_choice), shift)
                }),
            }
        });
    let mut each: Vec<SegmentSummary> = each.collect();
    let sum: f64 = each.iter().map(|s| s.weight).sum();
    if sum > 0.0 {
        each.iter_mut().for_each(|s| s.weight /= sum);
    }
    each
}
