//! Inertia from measured attitudes: how far from the Cramér–Rao bound, beside differences of the attitudes that are fitted as rates.

use nalgebra::{Matrix3, SMatrix, UnitQuaternion, Vector3};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode::rotation::{Quat, Vec3};
use polhode_files::error::{Error, unexpected};
use polhode_fit::{FitError, Poses, Record, Settings, fit, fit_poses, foreseen_attitude_bound};
use polhode_pages::table::{Cell, Column, Table, row};

use super::tensors::{ELLIPSOID, entries, random_tensor, square};
use crate::experiment::{Context, Report};
use crate::statistics::{Interval, rounded};

const SEED: u64 = 401_600;
/// Standard deviation of a component of the rotation vector, degrees.
const NOISES: [f64; 3] = [0.05, 0.5, 2.0];
/// Attitudes a second; the body turns by about one radian in it.
const RATES: [usize; 3] = [5, 30, 200];
const BODIES: [(&str, [f64; 3]); 4] = [
    ("asymmetric", [1.0, 2.0, 2.6]),
    ("near-symmetric", [1.0, 2.0, 2.1]),
    ("planar", [1.0, 2.0, 3.0]),
    ("slender", [1.0, 3.0, 3.3]),
];
/// Deviation of a number of the tensor, over the trace, from which on a record counts as not determining it.
const VAGUE: f64 = 0.1;

/// The square of the least that the error over the bound can be. A planar body lies on the wall I₁ + I₂ = I₃ of what bodies can be, of which the bound
/// knows nothing: half of the answers would lie beyond it, and the law takes the part across the wall from the error of these, one of
/// five.
fn squared_least(moments: [f64; 3]) -> f64 {
    if moments[0] + moments[1] > moments[2] { 1.0 } else { 0.9 }
}

/// Records of a row from which on its own intervals tell something.
const TELLING: u64 = 40;

/// The squared error of one answer, over the bound and over the covariance that is stated.
#[derive(Clone, Copy)]
struct Outcome {
    over_bound: f64,
    own: f64,
}

struct Trial {
    /// `None` where it was refused.
    own: Option<Outcome>,
    /// Whether the bound says that the record leaves a number open.
    is_vague: bool,
    /// By differences of the attitudes.
    differenced: Option<Outcome>,
}

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let trials: u64 = context.scale.pick(2, 2, 40);
    let seconds = context.scale.pick(12, 12, 30);
    let rates = context.scale.pick(&RATES[..2], &RATES[..], &RATES[..]);
    let cells: Vec<(usize, usize, usize)> = (0..BODIES.len())
        .flat_map(|body| {
            (0..NOISES.len()).flat_map(move |noise| (0..rates.len()).map(move |rate| (body, noise, rate)))
        })
        .collect();
    let parts = cells.iter().flat_map(|&cell| (0..trials).map(move |k| (cell, k))).collect();
    let results = context.in_parallel(parts, |((body, noise, rate), k): ((usize, usize, usize), u64)| {
        // draws of their own for each row, so that rows can be pooled
        let stream = (((body * NOISES.len() + noise) * RATES.len() + rate) as u64) << 32 | k;
        trial(BODIES[body].1, NOISES[noise].to_radians(), rates[rate], seconds, stream)
    });
    let are_checked =
        if trials >= TELLING { "" } else { " Too few to check each row: all are checked together." };
    let caption = format!(
        "Inertia from attitudes: {trials} records of {seconds} s a row, random axes and starts, 1 rad/s.{are_checked}"
    );
    let mut table = Table::new("attitudes", caption, columns());
    let (mut pooled, mut pooled_differenced, mut failures) =
        (Summary::default(), Summary::default(), Vec::new());
    // records, and those that were refused wrongly
    let mut all = [0, 0];
    let mut leasts = 0.0;
    for (&(body, noise, rate), cell) in cells.iter().zip(results.chunks(trials as usize)) {
        let name = format!("{}, {} deg, {} Hz", BODIES[body].0, NOISES[noise], rates[rate]);
        // a record that cannot be made is the failure of its row
        failures.extend(
            cell.iter().filter_map(|trial| trial.as_ref().err()).map(|error| format!("{name}: {error}")),
        );
        let cell: Vec<&Trial> = cell.iter().filter_map(|trial| trial.as_ref().ok()).collect();
        let made = cell.len() as u64;
        let own = Summary::of(cell.iter().map(|trial| trial.own));
        let differenced = Summary::of(cell.iter().map(|trial| trial.differenced));
        // told apart by the bound of the true motion, of which the estimate has its own
        let wrongly = cell.iter().filter(|trial| trial.own.is_none() && !trial.is_vague).count() as u64;
        let of = (BODIES[body].0, Some(NOISES[noise]), Some(rates[rate] as u64));
        table.push(cells_of(of, [&own, &differenced], [made, wrongly], seconds));
        if trials >= TELLING {
            failures.extend(
                own.failures(squared_least(BODIES[body].1).sqrt())
                    .map(|failure| format!("{name}: {failure}")),
            );
        }
        if wrongly > allowed(trials) {
            failures.push(format!(
                "{name}: {wrongly} of {trials} refused though the bound determines the tensor"
            ));
        }
        leasts += made as f64 * squared_least(BODIES[body].1);
        pooled.add(&own);
        pooled_differenced.add(&differenced);
        all[0] += made;
        all[1] += wrongly;
    }
    table.push(cells_of(("all", None, None), [&pooled, &pooled_differenced], all, seconds));
    let conclusion = match (pooled.over_bound(), pooled.interval(), pooled.coverage()) {
        (Some(over), Some((low, high)), Some(c)) => {
            let is_told = high - low < 0.1;
            failures.extend(
                pooled
                    .failures((leasts / all[0] as f64).sqrt())
                    .filter(|_| is_told)
                    .map(|failure| format!("pooled: {failure}")),
            );
            format!(
                "from attitudes the errors are {over:.3} times the Cramer-Rao bound ({low:.3} to {high:.3}), and {:.1} % ({:.1} to {:.1}) of the \
                 95 % ellipsoids hold the truth",
                100.0 * c.share,
                100.0 * c.low,
                100.0 * c.high
            )
        }
        _ => String::new(),
    };
    let checks = cells.len() as u64 * if trials >= TELLING { 3 } else { 1 } + 2;
    Ok(Report { conclusion, checks, tables: vec![table], seed: Some(SEED), failures, ..Report::default() })
}

/// The cells of a row: its body, noise and rate, its answers and those by differences, and how many records were made and how many of them
/// refused wrongly.
fn cells_of(
    (body, noise, rate): (&str, Option<f64>, Option<u64>),
    [own, differenced]: [&Summary; 2],
    [made, wrongly]: [u64; 2],
    seconds: usize,
) -> [Cell; 16] {
    let coverage = own.coverage();
    row![
        body,
        noise,
        rate,
        own.over_bound(),
        own.interval().map(|(low, _)| rounded(low)),
        own.interval().map(|(_, high)| rounded(high)),
        coverage.map(|c| rounded(c.share)),
        coverage.map(|c| rounded(c.low)),
        coverage.map(|c| rounded(c.high)),
        made - own.answered,
        wrongly,
        differenced.over_bound(),
        differenced.coverage().map(|c| rounded(c.share)),
        made - differenced.answered,
        made,
        seconds as u64,
    ]
}

/// Records a row that noise alone lets look like those of a torque: one in a few hundred.
fn allowed(trials: u64) -> u64 {
    1 + trials / 100
}

/// All answers of a row.
#[derive(Default)]
struct Summary {
    squares: Vec<f64>,
    covered: u64,
    answered: u64,
}

impl Summary {
    fn of(outcomes: impl Iterator<Item = Option<Outcome>>) -> Self {
        let mut summary = Summary::default();
        for outcome in outcomes.flatten() {
            summary.squares.push(outcome.over_bound);
            summary.answered += 1;
            summary.covered += u64::from(outcome.own < ELLIPSOID);
        }
        summary
    }

    fn add(&mut self, other: &Summary) {
        self.squares.extend(&other.squares);
        self.covered += other.covered;
        self.answered += other.answered;
    }

    /// What of the limits that are asked of every row it contradicts, by its 95 % intervals; `least` is the least error over the
    /// bound.
    fn failures(&self, least: f64) -> impl Iterator<Item = String> {
        let over = self.over_bound().zip(self.interval());
        let over = over.filter(|(_, (low, high))| *high < 0.95 * least || *low > 1.05 * least);
        let over = over.map(|(over, (low, high))| format!("{over} of the bound ({low:.3} to {high:.3})"));
        let covered = self.coverage().filter(|c| c.high < 0.93 || c.low > 0.97);
        let covered = covered.map(|c| format!("{:.3} of the ellipsoids hold the truth", c.share));
        over.into_iter().chain(covered)
    }

    /// Share of the answers whose ellipsoid holds the truth.
    fn coverage(&self) -> Option<Interval> {
        Interval::new(self.covered, self.answered)
    }

    /// Root of the mean of e C⁻¹ e / 5.
    fn over_bound(&self) -> Option<f64> {
        let mean = self.squares.iter().sum::<f64>() / (5 * self.squares.len().max(1)) as f64;
        (!self.squares.is_empty()).then(|| rounded(mean.sqrt()))
    }

    /// Its 95 % interval, by the scatter of the squares.
    fn interval(&self) -> Option<(f64, f64)> {
        let count = self.squares.len() as f64;
        if count < 2.0 {
            return None;
        }
        let mean = self.squares.iter().sum::<f64>() / count;
        let variance = self.squares.iter().map(|s| (s - mean) * (s - mean)).sum::<f64>() / (count - 1.0);
        // of the logarithm of a root half as wide as of the mean
        let half = libm::exp(0.98 * (variance / count).sqrt() / mean);
        let over = (mean / 5.0).sqrt();
        Some((over / half, over * half))
    }
}

fn trial(moments: [f64; 3], noise: f64, rate: usize, seconds: usize, stream: u64) -> Result<Trial, Error> {
    let mut random = Random::new(SEED).stream(stream);
    let j = random_tensor(moments, &mut random);
    let body = Inertia::from_tensor(j).map_err(unexpected)?;
    let omega = random.normal_vector().normalize();
    let times: Vec<f64> = (0..=rate * seconds).map(|i| i as f64 / rate as f64).collect();
    let motion = FreeMotion::from_omega(&body, UnitQuaternion::identity(), omega).map_err(unexpected)?;
    let middle = 0.5 * seconds as f64;
    let mut attitudes: Vec<UnitQuaternion<f64>> = Vec::with_capacity(times.len());
    for t in &times {
        let off = Quat::exponential(Vec3::from(random.normal_vector() * noise));
        attitudes.push((motion.at(t - middle).map_err(unexpected)?.attitude * off).into());
    }
    let bound = foreseen_attitude_bound(&body, omega, &times, noise)
        .ok_or_else(|| Error::Failed(format!("random stream {stream}: no Cramér–Rao bound")))?;
    let outcome = |tensor: Matrix3<f64>, covariance: &SMatrix<f64, 6, 6>| {
        let error = entries(&(tensor - j));
        Some(Outcome { over_bound: square(&error, &bound, true)?, own: square(&error, covariance, true)? })
    };
    let poses = Poses::new("record", &times, &attitudes).map_err(unexpected)?;
    let own = match fit_poses(&poses, &Settings::default()) {
        Ok(estimate) => outcome(estimate.shape.tensor(), &estimate.free_covariance),
        Err(_) => None,
    };
    // the largest deviation of a coordinate is at most that of the Frobenius norm
    let widest = bound.trace() + bound[(3, 3)] + bound[(4, 4)] + bound[(5, 5)];
    Ok(Trial {
        own,
        is_vague: widest.sqrt() > 0.5 * VAGUE,
        differenced: differenced(&times, &attitudes).and_then(|(j, c)| outcome(j, &c)),
    })
}

/// What the fit of rates makes of the differences of neighbouring attitudes, one step after the other.
fn differenced(
    times: &[f64],
    attitudes: &[UnitQuaternion<f64>],
) -> Option<(Matrix3<f64>, SMatrix<f64, 6, 6>)> {
    let steps = times.windows(2).zip(attitudes.windows(2));
    let (middles, rates): (Vec<f64>, Vec<Vector3<f64>>) = steps
        .map(|(t, q)| {
            let turn: Vector3<f64> = Quat::from(q[0].inverse() * q[1]).logarithm().into();
            (0.5 * (t[0] + t[1]), turn / (t[1] - t[0]))
        })
        .unzip();
    let record = Record::from_samples(&middles, &rates).ok()?;
    let answer: Result<_, FitError> = fit(&record, &Settings::default());
    answer.ok().map(|estimate| (estimate.shape.tensor(), estimate.free_covariance))
}

fn columns() -> Vec<Column> {
    vec![
        Column::new(
            "body",
            "",
            "principal moments: asymmetric 1, 2, 2.6; near-symmetric 1, 2, 2.1; planar 1, 2, 3; slender 1, 3, 3.3; all: the records of all rows together",
        ),
        Column::new(
            "noise",
            "deg",
            "standard deviation of a component of the rotation vector of an attitude",
        ),
        Column::new("rate", "Hz", "attitudes a second; the body turns by about 1 rad/s"),
        Column::new(
            "error_over_bound",
            "",
            "root of the mean of e C^-1 e / 5 with C the bound; the least possible is 1, and the root of 9/10 for planar bodies, at the wall of what bodies can be",
        )
        .heading("error/bound"),
        Column::new("low", "", "lower end of its 95 % interval").heading("from"),
        Column::new("high", "", "upper end of its 95 % interval").heading("to"),
        Column::new("coverage", "", "share of answers whose own 95 % ellipsoid holds the truth"),
        Column::new("coverage_low", "", "lower end of its 95 % interval (Wilson)").heading("from"),
        Column::new("coverage_high", "", "upper end of its 95 % interval (Wilson)").heading("to"),
        Column::new("refused", "", "records without an answer"),
        Column::new("wrongly", "", "of these, those whose bound determines the tensor"),
        Column::new(
            "differenced",
            "",
            "error over the bound of rates from differences of neighbouring attitudes",
        )
        .heading("differences"),
        Column::new("differenced_coverage", "", "their coverage").heading("coverage"),
        Column::new("differenced_refused", "", "records that they give no answer to").heading("refused"),
        Column::new("records", "", "records").hidden(),
        Column::new("seconds", "s", "length of a record").hidden(),
    ]
}
