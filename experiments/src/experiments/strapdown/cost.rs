//! Time of a sample, and ten million samples in constant memory.

use std::time::Instant;

use core::f64::consts::TAU;
use polhode::num::Real;
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode::strapdown::{Budgeted, Kind, Rule, Sensor, Strapdown};
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Column, Table, row};

use super::rules::cost;
use crate::build::PROFILE;
use crate::experiment::{Context, Report};

/// Interval, s.
const STEP: f64 = 0.01;

/// Samples in which a rate turns about body z once, so that a table holds its readings and the attitude is in closed form.
const PERIOD: usize = 500;

fn readings() -> Vec<Vec3<f64>> {
    let of = |k: usize| {
        let (sin, cos) = Real::sin_cos(TAU * k as f64 / PERIOD as f64);
        Vec3([cos, sin, 0.5])
    };
    (0..PERIOD).map(of).collect()
}

/// `exp(½ t (1, 0, 0.5 + ν)) exp(−½ t (0, 0, ν))` after whole periods, ν the rate of the period.
fn attitude(samples: u64) -> Quat<f64> {
    let rate = TAU / (PERIOD as f64 * STEP);
    let axis = Vec3([1.0, 0.0, 0.5 + rate]);
    // the angle of a period, reduced before it is taken so often
    let angle = (axis.norm() * STEP * PERIOD as f64).rem_euclid(TAU);
    let periods = samples / PERIOD as u64;
    let second = if periods % 2 == 1 { -1.0 } else { 1.0 };
    Quat::exponential(axis * ((periods as f64 * angle).rem_euclid(2.0 * TAU) / axis.norm())) * second
}

/// Seconds of a sample and the attitude after `samples`, a multiple of the period.
fn stream(rule: Rule, samples: u64) -> Result<(f64, Quat<f64>), Error> {
    let readings = readings();
    let mut strapdown = Strapdown::new(Kind::Rate, rule, Quat::identity()).map_err(unexpected)?;
    let clock = Instant::now();
    for k in 0..=samples {
        strapdown.push(STEP * k as f64, readings[(k % PERIOD as u64) as usize]).map_err(unexpected)?;
    }
    strapdown.finish();
    Ok((clock.elapsed().as_secs_f64() / samples as f64, strapdown.attitude()))
}

/// What everyone has: q ← q ∘ (1, ½ h ω), normalised.
fn product_loop(samples: u64) -> (f64, Quat<f64>) {
    let readings = readings();
    let mut q = Quat::identity();
    let clock = Instant::now();
    for k in 0..samples {
        let half = readings[(k % PERIOD as u64) as usize] * (0.5 * STEP);
        q = (q * Quat::new(1.0, half)).normalized();
    }
    (clock.elapsed().as_secs_f64() / samples as f64, q)
}

pub(super) fn time(context: &Context, report: &mut Report) -> Result<(), Error> {
    let samples: u64 = context.scale.pick(10_000, 100_000, 10_000_000);
    let magnus = |order, count| Rule::magnus(order, count).map_err(unexpected);
    let truth = attitude(samples);
    let mut errors = Table::new(
        "stream",
        "A stream of samples, 0.01 s apart, at 1.1 rad/s: error at the end, arithmetic of a sample, and all the memory that the stream takes.",
        vec![
            Column::new("rule", "", "rule; product: q (1, h w / 2), normalised"),
            Column::new("samples", "", "number of samples"),
            Column::new("error", "rad", "attitude error at the end").digits(2),
            Column::new("operations", "", "arithmetic of one sample"),
            Column::new("bytes", "", "size of the state"),
        ],
    );
    let mut times = Table::new(
        "timing",
        "Time of one sample.",
        vec![Column::new("rule", "", "rule"), Column::new("time", "ns", "time of one sample").digits(3)],
    );
    let (seconds, end) = product_loop(samples);
    let mut add = |name: String, seconds: f64, end: Quat<f64>, operations: Option<u64>, bytes: usize| {
        errors.push(row![name.clone(), samples, rotation_angle(end, truth), operations, bytes as u64]);
        times.push(row![name, seconds * 1e9]);
    };
    add("product".into(), seconds, end, None, size_of::<Quat<f64>>());
    for rule in [Rule::Hold, Rule::Trapezoid, Rule::TwoSpeed, magnus(4, 4)?, magnus(6, 6)?, magnus(6, 8)?] {
        let (seconds, end) = stream(rule, samples)?;
        add(rule.to_string(), seconds, end, Some(cost(Kind::Rate, rule)?), size_of::<Strapdown<f64>>());
    }
    let rule = magnus(6, 8)?;
    let (readings, some) = (readings(), samples / 10);
    let sensor = Sensor::default().with_noise(1e-3);
    let mut budgeted = Budgeted::new(Kind::Rate, rule, Default::default(), sensor).map_err(unexpected)?;
    let clock = Instant::now();
    for k in 0..some {
        let reading = readings[(k % PERIOD as u64) as usize];
        budgeted.push(STEP * k as f64, reading.into()).map_err(unexpected)?;
    }
    times.push(row![format!("{rule} with budget"), clock.elapsed().as_secs_f64() / some as f64 * 1e9]);
    report.tables.push(errors);
    // other builds do not optimise what is generic
    report.timing = (PROFILE == "paper").then_some(times);
    Ok(())
}
