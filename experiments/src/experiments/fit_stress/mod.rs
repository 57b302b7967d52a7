//! The fit under stress: bodies that are neither free nor rigid, sensors with errors of every kind, odd bodies and odd sampling.
//!
//! An answer is silently wrong where its own 99.9 % ellipsoid does not hold the truth, no warning is given, and the report's lines of
//! systematic errors do not cover the error at the size that the sensor's error has.

mod body;
mod cases;
mod sensor;

use std::time::Instant;

use nalgebra::{Matrix3, Vector3};
use polhode::num::Random;
use polhode_files::error::{Error, unexpected};
use polhode_fit::{FitError, Record, Segment, Settings, fit};
use polhode_pages::table::{Column, Table, row};

use super::fit_field::tally::Tally;
use super::fit_field::trial::{Answer, Trial, Verdict, lines_cover};
use super::tensors::{entries, random_rotation, square, tensor_along};
use crate::experiment::{Context, Report};
use crate::statistics::{Interval, rounded};
use cases::{CASES, Case, Model, Sampling, Start};

const SEED: u64 = 404_026;

/// A body of trace 1 with its axes in a random direction.
fn tensor(moments: [f64; 3], random: &mut Random) -> (Matrix3<f64>, Matrix3<f64>) {
    let turn = random_rotation(random);
    let trace: f64 = moments.iter().sum();
    (tensor_along(&turn, Vector3::from(moments) / trace), *turn.matrix())
}

/// True times, and those that the record has.
fn times(case: &Case, shorter: f64, random: &mut Random) -> (Vec<f64>, Vec<f64>) {
    let count = (case.seconds * shorter * case.rate) as usize;
    let interval = 1.0 / case.rate;
    let regular = (0..=count).map(|i| i as f64 * interval);
    match case.sampling {
        Sampling::Regular => (regular.clone().collect(), regular.collect()),
        Sampling::HiddenJitter(share) | Sampling::KnownJitter(share) => {
            let limit = 0.45 * interval;
            let scattered =
                regular.clone().map(|t| t + (random.normal() * share * interval).clamp(-limit, limit));
            let scattered: Vec<f64> = scattered.collect();
            let is_known = matches!(case.sampling, Sampling::KnownJitter(_));
            (scattered.clone(), if is_known { scattered } else { regular.collect() })
        }
        Sampling::Lost(share) => {
            let kept: Vec<f64> = regular.filter(|_| random.uniform() >= share).collect();
            (kept.clone(), kept)
        }
    }
}

fn trial(case: &Case, shorter: f64, stream: u64) -> Result<Trial, Error> {
    let mut random = Random::new(SEED).stream(stream);
    let (j, axes) = tensor(case.moments, &mut random);
    let mut record = Record::default();
    let gyroscope = case.error.gyroscope(case.noise, &mut random);
    let mut along = Vector3::zeros();
    for _ in 0..case.tosses {
        let omega = match case.start {
            Start::Random(size) => random.normal_vector().normalize() * size,
            Start::Near(axis, angle) => {
                let off = axes.column((axis + 1) % 3) * libm::sin(angle);
                axes.column(axis) * libm::cos(angle) + off
            }
        };
        let (true_times, stamps) = times(case, shorter, &mut random);
        let draws = random.clone();
        along = draws.clone().normal_vector().normalize();
        let late = |by: f64| {
            let times: Vec<f64> = true_times.iter().map(|t| t + by).collect();
            body::rates(&j, &omega, &times, case.acting, &mut draws.clone())
        };
        let mut rates = body::rates(&j, &omega, &true_times, case.acting, &mut random);
        if let sensor::Error::Skew(by) = case.error {
            let (y, z) = (late(by), late(2.0 * by));
            rates.iter_mut().zip(y.iter().zip(&z)).for_each(|(w, (y, z))| (w.y, w.z) = (y.y, z.z));
        }
        case.error.on_rates(&true_times, &mut rates);
        let mut readings = gyroscope.read(&true_times, &rates, &mut random).map_err(unexpected)?;
        case.error.on_readings(&mut readings, case.noise, &mut random);
        record.segments.push(Segment::new("record", stamps, readings).map_err(unexpected)?);
    }
    let start = Instant::now();
    let found = fit(&record, &Settings::default());
    let seconds = start.elapsed().as_secs_f64();
    let verdict = match found {
        Ok(estimate) => {
            let e = entries(&(estimate.shape.tensor() - j));
            let mut errors = case.error.lines();
            if let body::Acting::Wheel(share) = case.acting {
                errors.extend([
                    ("wheel_x", share * along.x),
                    ("wheel_y", share * along.y),
                    ("wheel_z", share * along.z),
                ]);
            }
            if let body::Acting::Magnet(size) = case.acting {
                errors.push(("magnet", size));
            }
            let mirror = estimate.mirror.as_ref().map(|mirror| mirror.principal_moments());
            let trace: f64 = case.moments.iter().sum();
            let is_mirror = mirror.zip(estimate.sigma_mirror).is_some_and(|(mirror, sigmas)| {
                (0..3).all(|k| (mirror[k] - case.moments[k] / trace).abs() < 5.0 * sigmas[k])
            });
            Verdict::Answered(Answer {
                over_bound: None,
                own: square(&e, &estimate.free_covariance, true),
                warned: !estimate.warnings.is_empty(),
                open: false,
                lines_cover: if case.error.is_mirror() {
                    is_mirror
                } else {
                    lines_cover(&estimate, &j, &errors)
                },
            })
        }
        Err(FitError::Units { .. } | FitError::Undersampled { .. }) => Verdict::Units,
        Err(_) => Verdict::Refused,
    };
    Ok(Trial { verdict, seconds })
}

/// Standard deviations of a share that chance may bring.
const SURELY: f64 = 5.0;

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let trials: u64 = context.scale.pick(1, 1, 100);
    let shorter = context.scale.pick(0.4, 1.0, 1.0);
    let parts = (0..CASES.len()).flat_map(|case| (0..trials).map(move |k| (case, k))).collect();
    let results = context.in_parallel(parts, |(case, k): (usize, u64)| {
        let own = if CASES[case].seconds > 1.0 { shorter } else { 1.0 };
        trial(&CASES[case], own, ((case as u64) << 32) + k)
    });
    let results = results.into_iter().collect::<Result<Vec<Trial>, Error>>()?;
    let caption = format!(
        "Records of bodies and sensors with what the fit has no model of, and of odd ones that it has, {trials} each."
    );
    let mut table = Table::new("stress", caption, columns());
    let (mut failures, mut sum) = (Vec::new(), Tally::default());
    for (case, cell) in CASES.iter().zip(results.chunks(trials as usize)) {
        let tally = Tally::new(cell, 5);
        let coverage = tally.coverage();
        let shown = |x: Option<f64>| x.map(rounded);
        table.push(row![
            case.name,
            case.model.name(),
            tally.refused + tally.units,
            shown(coverage.map(|c| c.share)),
            shown(coverage.map(|c| c.low)),
            shown(coverage.map(|c| c.high)),
            tally.warned,
            tally.outside,
            tally.by_lines,
            tally.silent,
            trials,
        ]);
        let mut say = |what: String| failures.push(format!("{}: {what}", case.name));
        if tally.silent > 0 && case.model != Model::Missing {
            say(format!("{} of {} silently wrong", tally.silent, tally.answered()));
        }
        if case.model == Model::AtHand {
            let held = Interval::wide(tally.covered(), tally.answered(), SURELY);
            if held.is_some_and(|held| held.high < 0.91) {
                say(format!("{} of {} covered", tally.covered(), tally.answered()));
            }
            if Interval::wide(tally.refused + tally.units, trials, SURELY).is_some_and(|i| i.low > 0.02) {
                say(format!("{} of {trials} refused", tally.refused + tally.units));
            }
        }
        sum.add(tally);
    }
    let conclusion = format!(
        "{} of {} answers are silently wrong, {} records refused",
        sum.silent,
        sum.answered(),
        sum.refused + sum.units
    );
    Ok(Report {
        conclusion,
        tables: vec![table],
        seed: Some(SEED),
        checks: CASES.len() as u64,
        failures,
        ..Report::default()
    })
}

fn columns() -> Vec<Column> {
    vec![
        Column::new("case", "", "the body, what acts on it, or how it is measured"),
        Column::new("model", "", "whether the fit has a model of it"),
        Column::new("refused", "", "records without an answer"),
        Column::new("coverage", "", "share of answers whose own 95 % ellipsoid holds the truth"),
        Column::new("coverage_low", "", "lower end of its 95 % interval (Wilson)").heading("from"),
        Column::new("coverage_high", "", "upper end of its 95 % interval (Wilson)").heading("to"),
        Column::new("warned", "", "answers with a warning"),
        Column::new("outside", "", "answers whose own 99.9 % ellipsoid does not hold the truth"),
        Column::new("by_lines", "", "of these, without a warning, those that the report's lines of systematic errors cover at the size that the error has, or whose line of left-handed axes is the true body")
            .heading("by lines"),
        Column::new("silent", "", "of these, those with neither"),
        Column::new("records", "", "records").hidden(),
    ]
}
