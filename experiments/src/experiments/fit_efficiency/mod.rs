//! How far each estimator of inertia stays from the Cramér–Rao bound, and whether its own errors are honest.

mod baselines;

use baselines::Baseline;
use nalgebra::{Matrix3, Quaternion, SMatrix, UnitQuaternion, Vector3};
use polhode::fit::{Estimate, FitError, Record, Settings, fit, foreseen_bound, simulate};
use polhode::inertia::Inertia;
use polhode::num::Random;

use crate::error::Error;
use crate::experiment::{Context, Report};
use crate::figure::{Figure, Series};
use crate::table::{Cell, Column, Table, row};

const SEED: u64 = 40_400;
/// Noise of a component as a share of the rate.
const NOISES: [f64; 3] = [1e-3, 1e-2, 1e-1];
/// Their columns: name and heading.
const NOISE_COLUMNS: [(&str, &str); 3] =
    [("noise_0.001", "noise 0.001"), ("noise_0.01", "noise 0.01"), ("noise_0.1", "noise 0.1")];
const BODIES: [(&str, [f64; 3]); 3] =
    [("asymmetric", [1.0, 2.0, 2.6]), ("near-symmetric", [1.0, 2.0, 2.1]), ("planar", [1.0, 2.0, 3.0])];
const BASELINES: [Baseline; 4] = [
    Baseline::CentralDifferences,
    Baseline::SavitzkyGolay { window: 21 },
    Baseline::SavitzkyGolay { window: 101 },
    Baseline::Momentum,
];
const OWN: &str = "weak form, denoised";
/// The 95 % point of χ² with five degrees of freedom.
const ELLIPSOID: f64 = 11.070_497_693_516_35;

/// One trial: squared error in units of the bound, by estimator.
struct Trial {
    /// The library's own; `None` where it refused.
    own: Option<f64>,
    covered: bool,
    physical: bool,
    /// Broke off for another reason than a record that says too little.
    broken: bool,
    baselines: [Option<f64>; 4],
}

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let trials = context.scale.pick(3, 10, 400);
    let seconds = context.scale.pick(20, 60, 60);
    let cells: Vec<(usize, usize)> =
        (0..BODIES.len()).flat_map(|body| (0..NOISES.len()).map(move |noise| (body, noise))).collect();
    let parts = cells.iter().flat_map(|&(body, noise)| (0..trials).map(move |k| (body, noise, k))).collect();
    let results = context.in_parallel(parts, |(body, noise, k): (usize, usize, u64)| {
        // the same motions at each noise, so that columns compare
        // at every noise the same bodies, starts and deviates
        let stream = ((body as u64) << 32) + k;
        trial(BODIES[body].1, NOISES[noise], seconds, stream)
    });
    let results = results.into_iter().collect::<Result<Vec<Trial>, Error>>()?;

    let mut table = Table::new(
        "efficiency",
        format!(
            "Error over the Cramer-Rao bound, {trials} records of {seconds} s at 100 Hz, random axes and starts."
        ),
        vec![
            Column::new(
                "body",
                "",
                "principal moments: asymmetric 1, 2, 2.6; near-symmetric 1, 2, 2.1; planar 1, 2, 3",
            ),
            Column::new("estimator", "", "formulation"),
            Column::new("noise", "", "standard deviation of a component over the rate"),
            Column::new(
                "error_over_bound",
                "",
                "root of the mean of e C^-1 e / 5 with C the bound; 1 is the best possible",
            )
            .heading("error/bound"),
            Column::new("coverage", "", "share of trials whose own 95 % ellipsoid holds the truth"),
            Column::new("answered", "", "trials with an answer"),
            Column::new("refused", "", "trials refused because the record does not determine the tensor"),
        ],
    );
    let mut figure = Figure::log_log(
        "efficiency",
        "Error over the Cramér–Rao bound, asymmetric body",
        "noise over rate",
        "error over bound",
    );
    let mut failures = Vec::new();
    let mut curves: Vec<Series> = Vec::new();
    for (&(body, noise), cell) in cells.iter().zip(results.chunks(trials as usize)) {
        let (name, level) = (BODIES[body].0, NOISES[noise]);
        let own: Vec<f64> = cell.iter().filter_map(|t| t.own).collect();
        let covered = cell.iter().filter(|t| t.covered).count() as f64 / own.len().max(1) as f64;
        let broken = cell.iter().filter(|t| t.broken).count();
        let refused = cell.len() - own.len() - broken;
        let over = over_bound(&own);
        table.push(row![name, OWN, level, rounded(over), rounded(covered), own.len() as u64, refused as u64]);
        if broken > 0 || cell.iter().any(|t| t.own.is_some() && !t.physical) {
            failures
                .push(format!("{name}, noise {level}: {broken} fits broke off, or a tensor is not physical"));
        }
        if body == 0 && refused > 0 {
            failures.push(format!("{name}, noise {level}: {refused} of {trials} records refused"));
        }
        if let Some(limits) =
            promise(body, level, trials).filter(|(low, high)| !(*low..=*high).contains(&over))
        {
            failures.push(format!("{name}, noise {level}: {over:.3} of the bound, outside {limits:?}"));
        }
        let mut point = |label: String, value: f64| {
            if body != 0 {
                return;
            }
            match curves.iter_mut().find(|s| s.name == label) {
                Some(series) => series.points.push((level, value)),
                None => curves.push(Series::new(label, vec![(level, value)])),
            }
        };
        point(OWN.into(), over);
        for (k, form) in BASELINES.into_iter().enumerate() {
            let errors: Vec<f64> = cell.iter().filter_map(|t| t.baselines[k]).collect();
            let over = over_bound(&errors);
            let answered = errors.len() as u64;
            table.push(row![name, form.name(), level, rounded(over), None::<f64>, answered, Cell::Empty]);
            point(form.name().trim_start_matches("baseline: ").into(), over);
        }
    }
    let compared = comparison(&curves);
    figure.series = curves;
    Ok(Report {
        tables: vec![table, compared],
        figures: vec![figure],
        seed: Some(SEED),
        failures,
        ..Report::default()
    })
}

/// The curves of the asymmetric body as a table: a row for each formulation, a column for each noise.
fn comparison(curves: &[Series]) -> Table {
    let mut columns = vec![Column::new("formulation", "", "how the equation of motion is used")];
    let at = "error over bound at this noise, a share of the rate";
    columns.extend(NOISE_COLUMNS.map(|(name, heading)| Column::new(name, "", at).heading(heading)));
    let caption = "Error over the Cramer-Rao bound, asymmetric body.";
    let mut table = Table::new("formulations", caption, columns);
    for series in curves {
        let mut cells = vec![Cell::from(series.name.clone())];
        cells.extend(series.points.iter().map(|(_, value)| Cell::from(rounded(*value))));
        table.push(cells);
    }
    table
}

/// What is promised of the asymmetric body, widened by four standard deviations where trials are few.
fn promise(body: usize, noise: f64, trials: u64) -> Option<(f64, f64)> {
    let scatter = (2.0 / (5.0 * trials as f64)).sqrt() / 2.0;
    let margin = f64::max(0.1, 4.0 * scatter);
    (body == 0).then_some((1.0 - margin, if noise < 0.05 { 1.0 + margin } else { 1.6 }))
}

fn over_bound(squares: &[f64]) -> f64 {
    (squares.iter().sum::<f64>() / (5 * squares.len()) as f64).sqrt()
}

/// Four digits: what a Monte Carlo figure can bear, and the same on every machine.
fn rounded(x: f64) -> Option<f64> {
    format!("{x:.3e}").parse().ok().filter(|x: &f64| x.is_finite())
}

fn entries(j: &Matrix3<f64>) -> SMatrix<f64, 6, 1> {
    SMatrix::from([[j[(0, 0)], j[(1, 1)], j[(2, 2)], j[(0, 1)], j[(0, 2)], j[(1, 2)]]])
}

/// eᵀ C⁺ e, where C is singular along the trace alone.
fn square(e: &SMatrix<f64, 6, 1>, c: &SMatrix<f64, 6, 6>) -> Option<f64> {
    let trace = SMatrix::<f64, 6, 1>::from([[1.0, 1.0, 1.0, 0.0, 0.0, 0.0]]);
    let regular = c + trace * trace.transpose() * c.trace();
    Some(e.dot(&regular.cholesky()?.solve(e)))
}

fn trial(moments: [f64; 3], noise: f64, seconds: usize, stream: u64) -> Result<Trial, Error> {
    let mut random = Random::new(SEED).stream(stream);
    let (w, v) = (random.normal(), random.normal_vector());
    let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, v.x, v.y, v.z)).to_rotation_matrix();
    let j = turn.matrix() * Matrix3::from_diagonal(&Vector3::from(moments)) * turn.matrix().transpose();
    let j = (j + j.transpose()) / (2.0 * j.trace());
    let omega = random.normal_vector().normalize();
    let failed = |error: &dyn std::fmt::Display| Error::Failed(format!("random stream {stream}: {error}"));
    let body = Inertia::from_tensor(j).map_err(|error| failed(&error))?;
    let times: Vec<f64> = (0..=100 * seconds).map(|i| i as f64 / 100.0).collect();
    let rates = simulate(&body, omega, &times, noise, &mut random).map_err(|error| failed(&error))?;
    let record = Record::from_samples(&times, &rates).map_err(|error| failed(&error))?;

    let nothing = Trial { own: None, covered: false, physical: false, broken: false, baselines: [None; 4] };
    let estimate: Estimate = match fit(&record, &Settings::default()) {
        Ok(estimate) => estimate,
        Err(FitError::Unidentifiable(_) | FitError::Unsettled { .. }) => return Ok(nothing),
        Err(_) => return Ok(Trial { broken: true, ..nothing }),
    };
    let error = |shape: Matrix3<f64>| entries(&(shape - j));
    let bound = foreseen_bound(&body, omega, &times, noise).ok_or_else(|| failed(&"no Cramér–Rao bound"))?;
    let own = error(estimate.shape.tensor());
    let covered = square(&own, &estimate.free_covariance).is_some_and(|s| s < ELLIPSOID);
    let baselines = BASELINES.map(|form| square(&error(form.shape(&record)?), &bound));
    let physical = estimate.principal[2] <= 0.5 && estimate.principal[0] > 0.0;
    Ok(Trial { own: square(&own, &bound), covered, physical, broken: false, baselines })
}
