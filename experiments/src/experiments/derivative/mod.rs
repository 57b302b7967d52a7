//! The derivative of the exact motion, of free bodies and of tops, and the motion through two attitudes: accuracy by regime, beside an integration of the
//! variational equations, completeness of the solutions, and what a covariance says beside an ensemble.

mod taylor;
mod tops;

use std::collections::BTreeMap;
use std::time::Instant;

use nalgebra::{SMatrix, UnitQuaternion, Vector3};
use polhode::body::{Body, State};
use polhode::catalogue;
use polhode::flow::{FreeMotion, StartCovariance, TurnAxes};
use polhode::inertia::Inertia;
use polhode::num::{Covariance, Random};
use polhode::rotation::{Quat, Vec3, rotation_angle};
use polhode_files::error::Error;
use polhode_pages::table::{Column, Table, row, to_digits};

use crate::experiment::{Context, Report};
use crate::statistics::larger;
use crate::timing::{best, discard};
use taylor::{Variational, relative_error};

const FIXTURES: &str = include_str!("../../../data/derivative.csv");

/// What is promised of the derivative, relative to its largest entry.
const PROMISE: f64 = 1e-13;
const SEED: u64 = 20_261_124;

/// Bodies between whose attitudes motions are looked for.
const BODIES: [&str; 5] = ["textbook", "toutatis", "spacecraft", "oblate", "prolate"];

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let mut report = Report { seed: Some(SEED), ..Report::default() };
    let worst = fixtures(&mut report)?;
    let mut timing = timing_table();
    beside_taylor(context, &mut report, &mut timing)?;
    tops::run(context, &mut report, &mut timing)?;
    let solutions = through(context, &mut report, &mut timing)?;
    covariance(context, &mut report)?;
    report.timing = Some(timing);
    report.conclusion = format!(
        "the derivative is within {} of fixtures of mpmath in every regime; {solutions}",
        to_digits(worst, 2)
    );
    Ok(report)
}

fn timing_table() -> Table {
    Table::new(
        "timing",
        "Least times of many bursts on this machine.",
        vec![
            Column::new("what", "", "what is done"),
            Column::new("body", "", "name in the catalogue"),
            Column::new("microseconds", "us", "time of one").digits(3),
        ],
    )
}

fn failed(name: &str, error: &dyn std::fmt::Display) -> Error {
    Error::Failed(format!("{name}: {error}"))
}

/// The columns by momentum and tensor, rotation vectors in space.
fn columns(motion: &FreeMotion, t: f64) -> Result<SMatrix<f64, 6, 9>, Error> {
    let found = motion.at_with_derivative(t).map_err(|error| failed("derivative", &error))?;
    Ok(found.by_momentum(TurnAxes::Space).fixed_columns::<9>(3).into_owned())
}

/// Against fixtures; gives the largest error.
fn fixtures(report: &mut Report) -> Result<f64, Error> {
    let mut by_regime: BTreeMap<&str, (u64, f64, f64)> = BTreeMap::new();
    for (number, line) in FIXTURES.lines().enumerate().filter(|(_, line)| !line.starts_with('#')).skip(1) {
        let broken = || Error::Failed(format!("derivative.csv:{}: not a case", number + 1));
        let fields: Vec<&str> = line.split(',').collect();
        let double = |k: usize| fields.get(k).and_then(|f| f.parse::<f64>().ok()).ok_or_else(broken);
        let moments = [double(2)?, double(3)?, double(4)?];
        let start = Vec3([double(6)?, double(7)?, double(8)?]);
        let attitude = Quat::from_components([double(9)?, double(10)?, double(11)?, double(12)?]);
        let t = double(13)?;
        let mut exact = SMatrix::<f64, 6, 9>::zeros();
        for column in 0..9 {
            for row in 0..6 {
                exact[(row, column)] = double(14 + 6 * column + row)?;
            }
        }
        let body = Body::free(Inertia::from_moments(moments).map_err(|_| broken())?);
        let inside = if fields[5] == "omega" {
            body.enter_omega(attitude, start)
        } else {
            body.enter(&State { attitude, momentum_body: start })
        };
        let motion = FreeMotion::from_point(body.inertia(), inside.map_err(|_| broken())?);
        let (norm, moment) = units(&motion, moments);
        let error = relative_error(&columns(&motion, t)?, &exact, norm, moment);
        let turned = motion.character().map_or(0.0, |c| c.spin * t.abs());
        let entry = by_regime.entry(fields[1]).or_default();
        *entry = (entry.0 + 1, larger(entry.1, error), entry.2.max(turned));
    }
    let mut table = Table::new(
        "regimes",
        "The derivative against fixtures of mpmath, by regime, relative to its largest entry.",
        vec![
            Column::new("regime", "", "kind of body and start"),
            Column::new("cases", "", "derivatives compared"),
            Column::new("turned", "rad", "|omega| t at most").digits(2),
            Column::new(
                "error",
                "",
                "largest error over the largest entry, with |m| and the largest moment as units",
            )
            .digits(2),
        ],
    );
    let mut worst = 0.0_f64;
    for (regime, (cases, error, turned)) in by_regime {
        table.push(row![regime, cases, turned, error]);
        report.checks += cases;
        worst = larger(worst, error);
    }
    if worst.is_nan() || worst > PROMISE {
        report.failures.push(format!("derivative: error {worst:e} exceeds {PROMISE:e}"));
    }
    report.tables.push(table);
    Ok(worst)
}

fn units(motion: &FreeMotion, moments: [f64; 3]) -> (f64, f64) {
    let norm = motion.point_at(0.0).momentum_body.norm() * motion.body().scale();
    (norm, moments.iter().fold(0.0, |a: f64, &b| a.max(b)))
}

/// Beside an integration of the variational equations.
fn beside_taylor(context: &Context, report: &mut Report, timing: &mut Table) -> Result<(), Error> {
    let mut table = Table::new(
        "taylor",
        "The closed form beside a Taylor integration of the variational equations: how far they differ.",
        vec![
            Column::new("body", "", "name in the catalogue"),
            Column::new("turned", "rad", "|omega| t").digits(2),
            Column::new("steps", "", "steps of the Taylor integration, order 24"),
            Column::new("difference", "", "largest difference over the largest entry").digits(2),
        ],
    );
    let far = context.scale.pick(100.0, 1e3, 1e4);
    for name in ["textbook", "spacecraft", "oblate"] {
        let named = catalogue::body(name).ok_or_else(|| failed(name, &"not in the catalogue"))?;
        let set_up = || FreeMotion::from_omega(&named.inertia, Default::default(), named.omega_body.into());
        let motion = set_up().map_err(|error| failed(name, &error))?;
        let speed = Vec3(named.omega_body).norm();
        let moments = named.inertia.tensor().diagonal();
        let start = named.inertia.momentum(named.omega_body.into());
        let (norm, moment) = units(&motion, moments.into());
        for turned in [0.1 * far, far] {
            // times are powers of two times a unit, so that both forms mean the same time
            let t = libm::exp2(libm::round(libm::log2(turned / speed)));
            let mut taylor = Variational::new(moments.into(), start.into());
            let clock = Instant::now();
            let steps = taylor.advance(t);
            let seconds = clock.elapsed().as_secs_f64();
            let difference = relative_error(&taylor.columns(), &columns(&motion, t)?, norm, moment);
            table.push(row![name, t * speed, steps, difference]);
            report.checks += 1;
            // rounding makes the phase of an integration drift, and the derivative follows it
            if difference.is_nan() || difference >= 1e-9 {
                report.failures.push(format!("{name}: Taylor differs by {difference:e} at {t} s"));
            }
            if turned == far {
                timing.push(row![format!("Taylor integration over {turned} rad"), name, seconds * 1e6]);
            }
        }
        let times: Vec<f64> = (1..=256).map(|n| f64::from(n) * 12.345 / speed).collect();
        let burst = || times.iter().for_each(|&t| discard(motion.at_with_derivative(t)));
        timing.push(row!["at_with_derivative", name, best(50, &burst) / 256.0 * 1e6]);
        let first = || discard(set_up().map(|motion| motion.at_with_derivative(times[0])));
        let plain = || discard(set_up().map(|motion| motion.at(times[0])));
        timing.push(row!["set-up of a motion and one state", name, best(200, &plain) * 1e6]);
        timing.push(row!["set-up of a motion and one derivative", name, best(200, &first) * 1e6]);
    }
    report.tables.push(table);
    Ok(())
}

/// Motions through two attitudes: the true one is among them.
fn through(context: &Context, report: &mut Report, timing: &mut Table) -> Result<String, Error> {
    let pairs = context.scale.pick(40, 1_000, 20_000_u64);
    let mut table = Table::new(
        "through",
        format!("All motions through two attitudes, 0.01 to 4 turns apart, of {pairs} random pairs a body."),
        vec![
            Column::new("body", "", "name in the catalogue"),
            Column::new("pairs", "", "pairs of attitudes"),
            Column::new("found", "", "pairs of which the true motion is among the solutions"),
            Column::new("solutions", "", "motions found in all"),
            Column::new("iterations", "", "most of Newton's iterations after the search"),
            Column::new("miss", "rad", "largest angle to the attitude asked for").digits(2),
            Column::new("incomplete", "", "pairs whose search says that it may lack some"),
        ],
    );
    let (mut all, mut solutions) = (0, 0);
    for (number, name) in BODIES.into_iter().enumerate() {
        let named = catalogue::body(name).ok_or_else(|| failed(name, &"not in the catalogue"))?;
        const BATCH: u64 = 20;
        let batch = |batch: u64| {
            let mut random = Random::new(SEED + number as u64).stream(batch);
            let mut seen = Seen::default();
            for _ in 0..BATCH {
                seen.look(&named.inertia, &mut random);
            }
            seen
        };
        let mut seen = Seen::default();
        for one in context.in_parallel((0..pairs / BATCH).collect(), batch) {
            seen.add(&one);
        }
        let first = batch(0);
        let each = best(5, &|| discard(batch(0))) / first.solutions as f64;
        timing.push(row!["through, one solution", name, each * 1e6]);
        table.push(row![
            name,
            seen.pairs,
            seen.found,
            seen.solutions,
            u64::from(seen.iterations),
            seen.miss,
            seen.incomplete
        ]);
        report.checks += seen.pairs;
        if seen.found < seen.pairs {
            report
                .failures
                .push(format!("{name}: of {} pairs the true motion is not found", seen.pairs - seen.found));
        }
        all += seen.pairs;
        solutions += seen.solutions;
    }
    report.tables.push(table);
    Ok(format!("the true motion is among the solutions of {all} pairs of attitudes, {solutions} in all"))
}

/// What was seen of pairs of attitudes.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    pairs: u64,
    found: u64,
    solutions: u64,
    iterations: u32,
    miss: f64,
    incomplete: u64,
}

impl Seen {
    fn add(&mut self, other: &Seen) {
        self.pairs += other.pairs;
        self.found += other.found;
        self.solutions += other.solutions;
        self.iterations = self.iterations.max(other.iterations);
        self.miss = self.miss.max(other.miss);
        self.incomplete += other.incomplete;
    }

    fn look(&mut self, inertia: &Inertia, random: &mut Random) {
        let q0 = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(
            random.normal(),
            random.normal(),
            random.normal(),
            random.normal(),
        ));
        let omega = random.normal_vector();
        let Ok(motion) = FreeMotion::from_omega(inertia, q0, omega) else { return };
        let Ok(character) = motion.character() else { return };
        let turns = libm::exp10(random.between(-2.0, libm::log10(4.0)));
        let time = turns * core::f64::consts::TAU / character.spin;
        let Ok(end) = motion.at(time) else { return };
        self.pairs += 1;
        let Ok(found) = FreeMotion::through(inertia, (0.0, q0), (time, end.rotation()), turns + 0.05) else {
            return;
        };
        self.solutions += found.list.len() as u64;
        self.incomplete += u64::from(!found.complete);
        for passage in &found.list {
            self.iterations = self.iterations.max(passage.iterations);
            self.miss = self.miss.max(passage.miss);
        }
        let near = |omega_body: Vector3<f64>| (omega_body - omega).norm() < 1e-6 * omega.norm();
        self.found += u64::from(found.list.iter().any(|passage| near(passage.omega_body)));
    }
}

/// First-order covariance beside the spread of an ensemble.
fn covariance(context: &Context, report: &mut Report) -> Result<(), Error> {
    let members = context.scale.pick(2_000, 20_000, 100_000_u64);
    let mut table = Table::new(
        "covariance",
        format!("First-order covariance of the attitude beside the spread of {members} members."),
        vec![
            Column::new("body", "", "name in the catalogue"),
            Column::new("turned", "rad", "|omega| t").digits(2),
            Column::new("sigma", "", "standard deviation of the start: rad, and of omega relative").digits(2),
            Column::new("angle_first_order", "rad", "root mean square of the angle, to first order")
                .heading("first order")
                .digits(3),
            Column::new("angle_members", "rad", "the same of the members").heading("members").digits(3),
            Column::new("nonlinearity", "", "measure of what the first order leaves out").digits(2),
        ],
    );
    for name in ["textbook", "toutatis", "oblate"] {
        let named = catalogue::body(name).ok_or_else(|| failed(name, &"not in the catalogue"))?;
        let omega = Vector3::from(named.omega_body);
        let speed = omega.norm();
        let motion = FreeMotion::from_omega(&named.inertia, Default::default(), omega)
            .map_err(|error| failed(name, &error))?;
        for (turned, sigma) in [(10.0, 1e-3), (1e3, 1e-5), (1e3, 1e-3), (1e5, 1e-3)] {
            let t = turned / speed;
            let rate = sigma * speed;
            let deviation = |k: usize| [sigma, rate, 0.0][(k / 3).min(2)];
            let start = Covariance::independent(std::array::from_fn(deviation))
                .map_err(|error| failed(name, &error))?;
            let start = StartCovariance::new(start, TurnAxes::Space);
            let found = motion.covariance(t, &start).map_err(|error| failed(name, &error))?;
            let first_order = found.state.fixed_view::<3, 3>(0, 0).trace().sqrt();
            let now = motion.at(t).map_err(|error| failed(name, &error))?.attitude;
            const BATCH: u64 = 500;
            let batch = |number: u64| {
                let mut random = Random::new(SEED).stream(number);
                let mut sum = 0.0;
                for _ in 0..BATCH {
                    let turn = random.normal_vector() * sigma;
                    let half = Vec3([0.5 * turn.x, 0.5 * turn.y, 0.5 * turn.z]);
                    let q0: UnitQuaternion<f64> = Quat::new(1.0, half).normalized().into();
                    let other =
                        FreeMotion::from_omega(&named.inertia, q0, omega + random.normal_vector() * rate);
                    let Ok(end) = other.map(|motion| motion.at(t)) else { continue };
                    let Ok(end) = end else { continue };
                    let angle = rotation_angle(now, end.attitude);
                    sum += angle * angle;
                }
                sum
            };
            let sum: f64 = context.in_parallel((0..members / BATCH).collect(), batch).into_iter().sum();
            let spread = (sum / members as f64).sqrt();
            table.push(row![name, turned, sigma, first_order, spread, found.nonlinearity]);
            report.checks += 1;
            let gap = (first_order / spread - 1.0).abs();
            let noise = 4.0 / (members as f64).sqrt();
            if found.nonlinearity < 0.1 && gap > 0.1 + noise {
                report
                    .failures
                    .push(format!("{name}: first order is off by {gap:e} where the measure is small"));
            }
        }
    }
    report.tables.push(table);
    Ok(())
}
