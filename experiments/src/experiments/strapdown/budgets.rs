//! Whether error budgets hold: simulated records of gyroscopes of several grades.

use core::f64::consts::PI;

use nalgebra::{UnitQuaternion, Vector3};
use polhode::num::Random;
use polhode::rotation::{Quat, rotation_angle};
use polhode::strapdown::{Budgeted, Estimate, Kind, Rule, Sensor, Strapdown, choose, noise};
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Cell, Column, Table, row};

use super::motion::{Known, even};
use crate::experiment::{Context, Report};

/// A grade of gyroscopes: what is wrong with them, as standard deviations.
struct Grade {
    name: &'static str,
    /// Angular random walk, °/√h.
    walk: f64,
    /// Bias, °/h.
    bias: f64,
    /// Scale error.
    scale: f64,
    /// Error of a time stamp, s.
    stamps: f64,
}

const GRADES: [Grade; 3] = [
    Grade { name: "phone", walk: 0.3, bias: 60.0, scale: 1e-3, stamps: 1e-4 },
    Grade { name: "tactical", walk: 0.01, bias: 1.0, scale: 1e-4, stamps: 1e-6 },
    Grade { name: "navigation", walk: 0.001, bias: 0.01, scale: 5e-6, stamps: 1e-8 },
];

/// What is wrong with the sensor of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Causes {
    /// White noise alone: the scale error would hide it.
    Noise,
    /// Noise, bias, scale error and errors of the stamps.
    All,
}

impl Causes {
    fn name(self) -> &'static str {
        match self {
            Causes::Noise => "noise",
            Causes::All => "all",
        }
    }
}

/// Samples a second, and the time of a record, s.
const RATES: [(f64, f64); 4] = [(5.0, 60.0), (20.0, 60.0), (100.0, 60.0), (1000.0, 10.0)];

/// Angular velocity at the start, rad/s.
const SPEED: f64 = 1.1;

/// Share of the errors inside of the 95 % of their budget that counts as right, over a thousand records.
const COVERED: core::ops::RangeInclusive<f64> = 0.93..=0.97;

const SEED: u64 = 41;

const DEGREE: f64 = PI / 180.0;

impl Grade {
    fn sensor(&self, causes: Causes, interval: f64) -> Sensor {
        let noise = Sensor::noise_of_walk(self.walk * DEGREE / 60.0, interval);
        let sensor = Sensor::default().with_noise(noise);
        if causes == Causes::Noise {
            return sensor;
        }
        sensor.with_bias(self.bias * DEGREE / 3600.0).with_scale(self.scale).with_stamps(self.stamps)
    }
}

/// One record: true attitude at the end, and what was read.
struct Simulated {
    truth: Quat<f64>,
    start: Quat<f64>,
    times: Vec<f64>,
    readings: Vec<Vector3<f64>>,
}

fn simulated(sensor: &Sensor, interval: f64, until: f64, random: &mut Random) -> Result<Simulated, Error> {
    let direction = random.normal_vector();
    let known = Known::free(direction * (SPEED / direction.norm()))?;
    let times = even(interval, until);
    // the last attitude is that of the time that is written
    let mut sampled: Vec<f64> = times.iter().map(|t| t + sensor.stamps * random.normal()).collect();
    sampled.iter_mut().for_each(|t| *t = t.max(0.0));
    let bias = random.normal_vector() * sensor.bias;
    let scale = random.normal_vector() * sensor.scale;
    let read = |rate: Vector3<f64>, random: &mut Random| {
        rate + rate.component_mul(&scale) + bias + random.normal_vector() * sensor.noise
    };
    let rates = known.rates(&sampled)?;
    let readings = rates.into_iter().map(|rate| read(rate.into(), random)).collect();
    let ends = known.attitudes(&[times[0], times[times.len() - 1]])?;
    Ok(Simulated { truth: ends[1], start: ends[0], times, readings })
}

/// What became of one record, by the noise of the data sheet and by that found in the record.
struct Outcome {
    rule: Rule,
    error: f64,
    trapezoid: f64,
    truncation: f64,
    walk: f64,
    sigma: f64,
    inside: [bool; 2],
}

fn last(record: &Simulated, rule: Rule, sensor: Sensor) -> Result<Estimate, Error> {
    let start = UnitQuaternion::from(record.start);
    let mut budgeted = Budgeted::ending(Kind::Rate, rule, start, sensor).map_err(unexpected)?;
    for (t, reading) in record.times.iter().zip(&record.readings) {
        budgeted.push(*t, *reading).map_err(unexpected)?;
    }
    let end = budgeted.finish().last().copied();
    end.ok_or_else(|| unexpected("a record without samples"))
}

fn outcome(
    (causes, grade): (Causes, &Grade),
    (rate, until): (f64, f64),
    random: &mut Random,
) -> Result<Outcome, Error> {
    let sensor = grade.sensor(causes, 1.0 / rate);
    let record = simulated(&sensor, 1.0 / rate, until, random)?;
    // errors of the stamps are part of the noise that a record shows
    let found = sensor.with_noise(noise(&record.times, &record.readings)).with_stamps(0.0);
    let rule = choose(&record.times, &record.readings, Kind::Rate, None, None, found).map_err(unexpected)?;
    let truth = UnitQuaternion::from(record.truth);
    let (stated, found) = (last(&record, rule, sensor)?, last(&record, rule, found)?);
    let mut trapezoid = Strapdown::new(Kind::Rate, Rule::Trapezoid, record.start).map_err(unexpected)?;
    for (t, reading) in record.times.iter().zip(&record.readings) {
        trapezoid.push(*t, (*reading).into()).map_err(unexpected)?;
    }
    trapezoid.finish();
    Ok(Outcome {
        rule,
        error: stated.error(truth).norm(),
        trapezoid: rotation_angle(trapezoid.attitude(), record.truth),
        truncation: stated.budget.truncation,
        walk: stated.budget.random_walk,
        sigma: stated.budget.sigma(),
        inside: [stated.holds(truth), found.holds(truth)],
    })
}

pub(super) fn budgets(context: &Context, report: &mut Report) -> Result<(), Error> {
    let records = context.scale.pick(12, 12, 1000);
    let rates = context.scale.pick(&RATES[..2], &RATES[..3], &RATES[..]);
    let mut cells = Vec::new();
    for causes in [Causes::Noise, Causes::All] {
        for grade in &GRADES {
            cells.extend(rates.iter().map(|rate| (causes, grade, *rate)));
        }
    }
    let of_cell = |cell: usize| (0..records).map(move |record| (cell, (cell as u64) << 32 | record));
    let parts: Vec<(usize, u64)> = (0..cells.len()).flat_map(of_cell).collect();
    let random = Random::new(SEED);
    let outcomes = context.in_parallel(parts, |(cell, stream)| {
        let (causes, grade, rate) = cells[cell];
        outcome((causes, grade), rate, &mut random.stream(stream))
    });
    let mut outcomes = outcomes.into_iter();
    let mut table = Table::new(
        "budgets",
        "Simulated records by grade and rate: errors at the end, and whether they are inside the 95 % of their budget.",
        columns(),
    );
    for (causes, grade, (rate, until)) in &cells {
        let own = outcomes.by_ref().take(records as usize).collect::<Result<Vec<_>, Error>>()?;
        let rms = |of: fn(&Outcome) -> f64| {
            (own.iter().map(|o| of(o) * of(o)).sum::<f64>() / own.len() as f64).sqrt()
        };
        let share = |k: usize| own.iter().filter(|o| o.inside[k]).count() as f64 / own.len() as f64;
        let shares = [share(0), share(1)];
        if records >= 1000 {
            for (share, by) in shares.into_iter().zip(["the data sheet", "the record"]) {
                report.checks += 1;
                if !COVERED.contains(&share) {
                    report.failures.push(format!(
                        "{} at {rate} Hz, causes {}, noise by {by}: {:.1} % of the errors inside their 95 %",
                        grade.name,
                        causes.name(),
                        100.0 * share
                    ));
                }
            }
        }
        table.push(row![
            causes.name(),
            grade.name,
            *rate,
            *until,
            records,
            usual(&own),
            rms(|o| o.error),
            rms(|o| o.sigma) * 3_f64.sqrt(),
            rms(|o| o.walk) * 3_f64.sqrt(),
            rms(|o| o.truncation),
            rms(|o| o.trapezoid),
            shares[0],
            shares[1],
        ]);
    }
    report.seed = Some(SEED);
    report.tables.push(table);
    Ok(())
}

/// The rule that is chosen most often.
fn usual(outcomes: &[Outcome]) -> Cell {
    let count = |rule: Rule| outcomes.iter().filter(|o| o.rule == rule).count();
    let most = outcomes.iter().map(|o| (count(o.rule), o.rule.to_string())).max();
    most.map(|(_, rule)| rule).into()
}

fn columns() -> Vec<Column> {
    vec![
        Column::new(
            "causes",
            "",
            "noise: white noise alone; all: bias, scale error and errors of the stamps too",
        ),
        Column::new("grade", "", "grade of the gyroscope"),
        Column::new("rate", "1/s", "samples a second"),
        Column::new("time", "s", "time of a record"),
        Column::new("records", "", "number of records").hidden(),
        Column::new("rule", "", "rule that was chosen most often"),
        Column::new("error", "rad", "root mean square of the angle of the attitude error").digits(2),
        Column::new("budget", "rad", "the same as the budget has it").digits(2),
        Column::new("random_walk", "rad", "its part of random walk").digits(2),
        Column::new("truncation", "rad", "its part of truncation").digits(2),
        Column::new("trapezoid", "rad", "root mean square of the error of the trapezoid with coning")
            .digits(2),
        Column::new("inside", "", "share of errors inside their 95 %, noise by the data sheet").digits(3),
        Column::new("inside_found", "", "the same, noise found in the record").digits(3),
    ]
}
