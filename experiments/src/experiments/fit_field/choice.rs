//! Whether deviations hold after the fit has chosen the torque: constant torques and drags from what no record of this length can tell
//! up to what every one does, in random directions.
//!
//! Fixed before the first count: 95 % ellipsoids hold the truth in 0.93 to 0.985 of all records, in no row in less than 0.91; records
//! of which another model was chosen than the one that acts lie outside their 99.9 % ellipsoid no more often than chance allows
//! beside that. Chance is that of the binomial distribution; Wilson's interval, which was taken at first, refutes two of 64, which
//! happens once in 500 times.

use nalgebra::Vector3;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_files::error::{Error, unexpected};
use polhode_fit::{Disturbances, Gyroscope, Record, Settings, TorqueModel, fit, simulate_with};
use polhode_pages::table::{Column, Table, row};

use super::tally::ELLIPSOIDS;
use crate::experiment::Context;
use crate::experiments::tensors::{entries, random_rotation, square, tensor_along};
use crate::statistics::{Interval, chance_of, rounded};

const SEED: u64 = 402_026;
const MOMENTS: [f64; 3] = [1.0, 2.0, 2.6];
/// Noise of a component over the rate, 1 rad/s.
const NOISE: f64 = 1e-2;
const SECONDS: u64 = 60;
const RATE: u64 = 20;
/// Sizes of the constant torque, rad/s² per trace, and of drag, 1/s.
const TORQUES: [f64; 5] = [1e-5, 3e-5, 1e-4, 3e-4, 1e-3];
const DRAGS: [f64; 4] = [1e-5, 3e-5, 1e-4, 1e-3];

/// What acts on the bodies of a row.
#[derive(Clone, Copy)]
struct Acting {
    model: TorqueModel,
    size: f64,
}

/// An answer.
struct Answer {
    chosen: TorqueModel,
    /// Square of its distance from the truth in its own deviations.
    square: Option<f64>,
    /// Its deviations over those under the chosen model alone.
    wider: Option<f64>,
}

fn trial(acting: Acting, stream: u64) -> Result<Option<Answer>, Error> {
    let mut random = Random::new(SEED).stream(stream);
    let turn = random_rotation(&mut random);
    let trace: f64 = MOMENTS.iter().sum();
    let j = tensor_along(&turn, Vector3::from(MOMENTS) / trace);
    let body = Inertia::from_tensor(j).map_err(unexpected)?;
    let omega = random.normal_vector().normalize();
    let direction = random.normal_vector().normalize();
    let disturbances = match acting.model {
        TorqueModel::Drag => Disturbances::default().with_relative_drag(acting.size),
        _ => Disturbances::default().with_torque(direction * acting.size),
    };
    let times: Vec<f64> = (0..=RATE * SECONDS).map(|i| i as f64 / RATE as f64).collect();
    let sensor = Gyroscope::default().with_noise(NOISE);
    let rates =
        simulate_with(&body, omega, &times, &disturbances, &sensor, &mut random).map_err(unexpected)?;
    let record = Record::from_samples(&times, &rates).map_err(unexpected)?;
    Ok(fit(&record, &Settings::default()).ok().map(|estimate| {
        let e = entries(&(estimate.shape.tensor() - body.tensor()));
        let own = estimate.models.iter().find(|one| one.model == estimate.torque.model);
        let size = |sigma: &[f64; 3]| sigma.iter().map(|s| s * s).sum::<f64>().sqrt();
        Answer {
            chosen: estimate.torque.model,
            square: square(&e, &estimate.free_covariance, true),
            wider: own.map(|own| size(&estimate.sigma_principal) / size(&own.sigma_principal)),
        }
    }))
}

/// Counts of one row or several.
#[derive(Default)]
struct Counts {
    refused: u64,
    answered: u64,
    /// Answers whose 95 % and 99.9 % ellipsoids hold the truth.
    inside: [u64; 2],
    /// Answers of another model than the one that acts, and those of them outside of their 99.9 % ellipsoid.
    other: u64,
    other_outside: u64,
    wider: Vec<f64>,
}

impl Counts {
    fn add(&mut self, acting: Acting, answer: Option<&Answer>) {
        let Some(answer) = answer else {
            self.refused += 1;
            return;
        };
        self.answered += 1;
        let (usual, rare) = ELLIPSOIDS[0];
        let within = |limit: f64| answer.square.is_some_and(|square| square < limit);
        self.inside[0] += u64::from(within(usual));
        self.inside[1] += u64::from(within(rare));
        if answer.chosen != acting.model {
            self.other += 1;
            self.other_outside += u64::from(!within(rare));
        }
        self.wider.extend(answer.wider);
    }

    /// What is not as demanded, by more than chance.
    fn failures(&self, name: &str, low: f64, high: f64) -> Vec<String> {
        let mut failed = Vec::new();
        let share = Interval::wide(self.inside[0], self.answered, SURELY);
        if share.is_some_and(|share| share.high < low || share.low > high) {
            failed.push(format!("{name}: {} of {} covered", self.inside[0], self.answered));
        }
        if chance_of(self.other_outside, self.other, RARE) < SURELY_SHARE {
            failed.push(format!(
                "{name}: {} of {} of another model outside of their 99.9 % ellipsoid",
                self.other_outside, self.other
            ));
        }
        failed
    }
}

/// Standard deviations of a share that chance may bring.
const SURELY: f64 = 3.3;
/// The share of a normal distribution beyond so many, above.
const SURELY_SHARE: f64 = 4.834e-4;
/// Share of answers outside of their 99.9 % ellipsoid.
const RARE: f64 = 1e-3;

/// The table, and what should not have happened.
pub(super) fn table(context: &Context) -> Result<(Table, Vec<String>), Error> {
    let trials = context.scale.pick(1, 1, 1000);
    let torques = TORQUES.map(|size| Acting { model: TorqueModel::Constant, size });
    let drags = DRAGS.map(|size| Acting { model: TorqueModel::Drag, size });
    let rows: Vec<Acting> = torques.into_iter().chain(drags).collect();
    let parts: Vec<(usize, u64)> =
        (0..rows.len()).flat_map(|row| (0..trials).map(move |k| (row, k))).collect();
    let answers = context.in_parallel(parts, |(row, k)| trial(rows[row], ((row as u64) << 32) + k));
    let answers = answers.into_iter().collect::<Result<Vec<Option<Answer>>, Error>>()?;
    let caption = format!(
        "Deviations after the fit has chosen the torque: {trials} records of {SECONDS} s at {RATE} Hz a row, moments 1, 2, 2.6, 1 rad/s, noise \
         {NOISE} rad/s."
    );
    let mut table = Table::new("choice", caption, columns());
    let (mut pooled, mut failures) = (Counts::default(), Vec::new());
    for (&acting, cell) in rows.iter().zip(answers.chunks(trials as usize)) {
        let mut counts = Counts::default();
        for answer in cell {
            counts.add(acting, answer.as_ref());
            pooled.add(acting, answer.as_ref());
        }
        let coverage = Interval::new(counts.inside[0], counts.answered);
        counts.wider.sort_by(f64::total_cmp);
        table.push(row![
            acting.model.to_string(),
            acting.size,
            counts.answered - counts.other,
            counts.refused,
            coverage.map(|c| rounded(c.share)),
            coverage.map(|c| rounded(c.low)),
            coverage.map(|c| rounded(c.high)),
            counts.answered - counts.inside[1],
            counts.other,
            counts.other_outside,
            counts.wider.get(counts.wider.len() / 2).copied().map(rounded),
        ]);
        failures.extend(counts.failures(&format!("{} {}", acting.model, acting.size), 0.91, 1.0));
    }
    failures.extend(pooled.failures("all records with a torque", 0.93, 0.985));
    Ok((table, failures))
}

fn columns() -> Vec<Column> {
    vec![
        Column::new("torque", "", "what acts: a constant torque in a random direction, or drag"),
        Column::new("size", "", "its size: rad/s^2 per trace, or 1/s"),
        Column::new("chosen", "", "answers with that model"),
        Column::new("refused", "", "records without an answer"),
        Column::new("coverage", "", "share of answers whose own 95 % ellipsoid holds the truth"),
        Column::new("coverage_low", "", "lower end of its 95 % interval (Wilson)").heading("from"),
        Column::new("coverage_high", "", "upper end of its 95 % interval (Wilson)").heading("to"),
        Column::new("outside", "", "answers whose own 99.9 % ellipsoid does not hold the truth"),
        Column::new("other", "", "answers with another model"),
        Column::new("other_outside", "", "of these, those outside of their 99.9 % ellipsoid")
            .heading("of these outside"),
        Column::new("wider", "", "median of the deviations over those under the chosen model alone"),
    ]
}
