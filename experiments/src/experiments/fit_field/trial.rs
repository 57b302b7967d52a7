//! One record and its fit.

use std::time::Instant;

use nalgebra::{Matrix3, SMatrix, Vector3};
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_files::error::{Error, unexpected};
use polhode_fit::{Estimate, FitError, Record, Segment, Warning, fit, simulate_with};

use super::bound::Problem;
use super::cases::{Case, Drawn};
use crate::experiments::tensors::{entries, random_tensor, square};

/// The fit of one record.
pub(in crate::experiments) struct Trial {
    pub(in crate::experiments) verdict: Verdict,
    /// Time of the fit.
    pub(in crate::experiments) seconds: f64,
}

pub(in crate::experiments) enum Verdict {
    Answered(Answer),
    /// The units look mistaken, or the sampling does.
    Units,
    Refused,
}

pub(in crate::experiments) struct Answer {
    /// eᵀ C⁻¹ e with C the bound.
    pub(in crate::experiments) over_bound: Option<f64>,
    /// The same with the covariance that the fit states.
    pub(in crate::experiments) own: Option<f64>,
    pub(in crate::experiments) warned: bool,
    /// Whether a warning says that the record cannot tell its units.
    pub(in crate::experiments) open: bool,
    /// Whether the statistical and systematic lines of the report cover the errors of the principal moments.
    pub(in crate::experiments) lines_cover: bool,
}

pub(super) fn trial(case: &Case, noise: f64, times: &[f64], seed: u64, stream: u64) -> Result<Trial, Error> {
    let mut random = Random::new(seed).stream(stream);
    let j = random_tensor([1.0, 2.0, 2.6], &mut random);
    let omega = random.normal_vector().normalize();
    let body = Inertia::from_tensor(j).map_err(unexpected)?;
    let drawn = case.draw(noise, (j * omega).norm(), &mut random);
    let (acting, sensor) = (&drawn.disturbances, &drawn.gyroscope);
    let rates = simulate_with(&body, omega, times, acting, sensor, &mut random).map_err(unexpected)?;
    let record = record(case, times, &rates, &drawn)?;

    let start = Instant::now();
    let found = fit(&record, &case.settings());
    let seconds = start.elapsed().as_secs_f64();
    let verdict = match found {
        Ok(estimate) => {
            let problem = Problem {
                tensor: j,
                omega,
                drag: acting.relative_drag,
                torque: acting.torque,
                wheel: acting.wheel,
                scale: sensor.scale,
                torque_noise: acting.torque_noise,
                noise,
                unknown: case.unknown(),
            };
            let bound = problem.bound(times).ok_or_else(|| unexpected("a motion without a bound"))?;
            Verdict::Answered(answer(case, &estimate, &j, &bound, &drawn))
        }
        Err(FitError::Units { .. } | FitError::Undersampled { .. }) => Verdict::Units,
        Err(_) => Verdict::Refused,
    };
    Ok(Trial { verdict, seconds })
}

/// The readings in the units that the case gives them.
fn record(case: &Case, times: &[f64], rates: &[Vector3<f64>], drawn: &Drawn) -> Result<Record, Error> {
    let times: Vec<f64> = times.iter().map(|t| t * case.time_factor).collect();
    let rates: Vec<Vector3<f64>> = rates.iter().map(|w| w * case.rate_factor).collect();
    if !case.wheel_known {
        return Record::from_samples(&times, &rates).map_err(unexpected);
    }
    let momenta = times.iter().map(|t| drawn.disturbances.wheel_at(*t)).collect();
    let segment = Segment::new("record", times, rates).and_then(|segment| segment.with_wheel(momenta));
    let mut record = Record::default();
    record.segments.push(segment.map_err(unexpected)?);
    Ok(record)
}

fn answer(
    case: &Case,
    estimate: &Estimate,
    truth: &Matrix3<f64>,
    bound: &SMatrix<f64, 6, 6>,
    drawn: &Drawn,
) -> Answer {
    let warned = !estimate.warnings.is_empty();
    let open = estimate.warnings.iter().any(|warning| matches!(warning, Warning::Units { .. }));
    let absolute = estimate.inertia.as_ref().zip(estimate.inertia_covariance.as_ref());
    let (over_bound, own) = match absolute.filter(|_| case.wheel_known) {
        Some((inertia, covariance)) => {
            let e = entries(&(inertia.tensor() - truth));
            (square(&e, bound, false), square(&e, covariance, false))
        }
        // an answer without the scale that the wheel gives is none
        None if case.wheel_known => (None, None),
        None => {
            let e = entries(&(estimate.shape.tensor() - truth));
            (square(&e, bound, true), square(&e, &estimate.free_covariance, true))
        }
    };
    Answer { over_bound, own, warned, open, lines_cover: lines_cover(estimate, truth, &drawn.errors()) }
}

/// The normal deviate that only one in a thousand exceeds, either sign.
const ONE_IN_A_THOUSAND: f64 = 3.290_526_731_491_895;

/// Whether each principal moment is off by no more than its deviation and the systematic lines allow for, at the errors
/// that the sensor really has.
pub(in crate::experiments) fn lines_cover(
    estimate: &Estimate,
    truth: &Matrix3<f64>,
    errors: &[(&'static str, f64)],
) -> bool {
    let mut moments: [f64; 3] = truth.symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    (0..3).all(|k| {
        let change = |name: &str, error: f64| {
            let line = estimate.systematic.iter().find(|line| line.name == name);
            line.map_or(0.0, |line| (line.principal[k] * error / line.size).abs())
        };
        let of =
            |random: bool| errors.iter().filter(move |(name, _)| ["walk", "magnet"].contains(name) == random);
        let systematic: f64 = of(false).map(|(name, error)| change(name, *error)).sum();
        let by_chance: f64 = of(true).map(|(name, size)| change(name, *size)).sum();
        // the lines are derivatives: a tenth is left for what is not linear
        (estimate.principal[k] - moments[k]).abs()
            <= ONE_IN_A_THOUSAND * libm::hypot(estimate.sigma_principal[k], by_chance) + 1.1 * systematic
    })
}
