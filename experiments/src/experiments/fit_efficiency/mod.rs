//! How far each estimator of inertia stays from the Cramér–Rao bound, and whether its own errors are honest.

mod outcome;

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::num::Random;
use polhode_files::error::{Error, unexpected};
use polhode_fit::{
    Disturbances, FitError, Gyroscope, Record, Settings, TorqueModel, fit, foreseen_bound_with, simulate_with,
};
use polhode_pages::figure::{Curve, Figure};
use polhode_pages::table::{Cell, Column, Table};
use polhode_rivals::{ATTITUDE_NOISE, Given, RIVALS, Rival};

use super::tensors::{entries, random_tensor, square};
use crate::experiment::{Context, Report};
use crate::statistics::rounded;
use outcome::{Outcome, Summary, best};

const SEED: u64 = 40_400;
/// Noise of a component as a share of the rate.
const NOISES: [f64; 3] = [1e-3, 1e-2, 1e-1];
/// That of the conclusion.
const SHOWN: f64 = NOISES[1];
/// Their columns: name and heading.
const NOISE_COLUMNS: [(&str, &str); 3] =
    [("noise_0.001", "noise 0.001"), ("noise_0.01", "noise 0.01"), ("noise_0.1", "noise 0.1")];
/// Names, principal moments, and drag in 1/s, which is tried at the noise of the conclusion alone.
const BODIES: [(&str, [f64; 3], f64); 4] = [
    ("asymmetric", [1.0, 2.0, 2.6], 0.0),
    ("near-symmetric", [1.0, 2.0, 2.1], 0.0),
    ("planar", [1.0, 2.0, 3.0], 0.0),
    ("asymmetric, drag", [1.0, 2.0, 2.6], 0.01),
];
/// One record of so many, but never fewer than two, is given to WENDy, which takes the time of all others together, and one of so
/// many to the unscented filter.
const OF_WENDY: u64 = 12;
const OF_UNSCENTED: u64 = 3;
const OWN: &str = "weak form, denoised";
/// Streams of random numbers for those attitudes, apart from those of the records.
const ATTITUDES: u64 = 1 << 48;

/// One record, as each estimator answers it.
struct Trial {
    /// The library; `None` where it refused.
    own: Option<Outcome>,
    physical: bool,
    /// Broke off for another reason than a record that says too little.
    broken: bool,
    /// By rival and choice; no choice where a rival was not asked.
    rivals: Vec<Vec<Option<Outcome>>>,
}

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let trials = context.scale.pick(2, 3, 170);
    let seconds = context.scale.pick(10, 60, 60);
    let cells = (0..BODIES.len()).flat_map(|body| (0..NOISES.len()).map(move |noise| (body, noise)));
    let cells: Vec<(usize, usize)> =
        cells.filter(|&(body, noise)| BODIES[body].2 == 0.0 || NOISES[noise] == SHOWN).collect();
    let parts = cells.iter().flat_map(|&(body, noise)| (0..trials).map(move |k| (body, noise, k))).collect();
    let results = context.in_parallel(parts, |(body, noise, k): (usize, usize, u64)| {
        // at every noise the same bodies, starts and deviates, so that columns compare
        let stream = ((body as u64) << 32) + k;
        let some = |one_of: u64| BODIES[body].2 == 0.0 && k < trials.div_ceil(one_of).max(2);
        let asked = |rival: Rival| match rival {
            Rival::Wendy => some(OF_WENDY),
            Rival::Unscented => some(OF_UNSCENTED),
            Rival::OutputError => true,
            Rival::OutputErrorWithDrag => BODIES[body].2 > 0.0,
            _ => BODIES[body].2 == 0.0,
        };
        trial(BODIES[body], NOISES[noise], seconds, stream, asked)
    });
    let results = results.into_iter().collect::<Result<Vec<Trial>, Error>>()?;

    let mut table = Table::new(
        "efficiency",
        format!(
            "Error over the Cramer-Rao bound, {trials} records of {seconds} s at 100 Hz, of which WENDy has {} and the unscented filter {}; random \
             axes and starts.",
            trials.div_ceil(OF_WENDY).max(2).min(trials),
            trials.div_ceil(OF_UNSCENTED).max(2).min(trials)
        ),
        columns(),
    );
    let mut figure = Figure::log_log(
        "efficiency",
        format!(
            "Error over the Cramér–Rao bound: {trials} records of {seconds} s at 100 Hz, asymmetric body; bars: 95 % of what so few \
             records scatter"
        ),
        "noise over rate",
        "error over bound",
    );
    let (mut failures, mut checks, mut conclusion) = (Vec::new(), 0, String::new());
    let mut curves: Vec<Curve> = Vec::new();
    for (&(body, noise), cell) in cells.iter().zip(results.chunks(trials as usize)) {
        let (name, level) = (BODIES[body].0, NOISES[noise]);
        // the last that was asked is maximum likelihood of the right law
        let likeliest =
            |t: &Trial| t.rivals.iter().rev().find_map(|choices| choices.first().copied()).flatten();
        let likelihood: Vec<Option<Outcome>> = cell.iter().map(likeliest).collect();
        let own: Vec<Option<Outcome>> = cell.iter().map(|t| t.own).collect();
        let summary = Summary::new(&own, &likelihood);
        let broken = cell.iter().filter(|t| t.broken).count();
        let refused = (cell.len() - summary.answered - broken) as u64;
        let mut point = |label: &str, summary: &Summary| {
            if body != 0 {
                return;
            }
            let value = (level, summary.over_bound);
            match curves.iter_mut().find(|s| s.name == label) {
                Some(series) => series.push(value, summary.interval),
                None => curves.push(Curve::new(label, vec![value]).with_spread(vec![summary.interval])),
            }
        };
        table.push(summary.row(name, OWN, "", level, refused));
        point(OWN, &summary);
        if broken > 0 || cell.iter().any(|t| t.own.is_some() && !t.physical) {
            failures
                .push(format!("{name}, noise {level}: {broken} fits broke off, or a tensor is not physical"));
        }
        checks += 1;
        if body == 0 && level == SHOWN {
            conclusion = summary.conclusion();
        }
        if body == 0 && refused > 0 {
            failures.push(format!("{name}, noise {level}: {refused} of {trials} records refused"));
        }
        let over = summary.over_bound;
        if let Some(limits) =
            promise(body, level, trials).filter(|(low, high)| !(*low..=*high).contains(&over))
        {
            failures.push(format!("{name}, noise {level}: {over:.3} of the bound, outside {limits:?}"));
        }
        for (place, rival) in RIVALS.into_iter().enumerate() {
            let asked: Vec<&Trial> = cell.iter().filter(|t| !t.rivals[place].is_empty()).collect();
            if asked.is_empty() {
                continue;
            }
            let likelihood: Vec<Option<Outcome>> = asked.iter().map(|t| likeliest(t)).collect();
            let by_choice = (0..rival.choices())
                .map(|k| asked.iter().map(|t| t.rivals[place][k]).collect::<Vec<_>>())
                .map(|outcomes| Summary::new(&outcomes, &likelihood));
            let Some((k, summary)) = best(by_choice) else { continue };
            let without = (asked.len() - summary.answered) as u64;
            table.push(summary.row(name, rival.name(), &rival.choice(k), level, without));
            point(rival.name(), &summary);
        }
    }
    let compared = comparison(&curves);
    let hidden = ["body", "choice", "answered"];
    let caption = "Errors over the Cramer-Rao bound, and coverage of the 95 % ellipsoids, asymmetric body.";
    let asymmetric = table.view("asymmetric", caption, &hidden, ("body", "asymmetric"));
    figure.series = curves;
    Ok(Report {
        conclusion,
        checks,
        views: vec![asymmetric, compared.clone()],
        tables: vec![table, compared],
        figures: vec![figure],
        seed: Some(SEED),
        failures,
        ..Report::default()
    })
}

/// The curves of the asymmetric body as a table: a row for each formulation, a column for each noise.
fn comparison(curves: &[Curve]) -> Table {
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

fn trial(
    (_, moments, drag): (&str, [f64; 3], f64),
    noise: f64,
    seconds: usize,
    stream: u64,
    asked: impl Fn(Rival) -> bool,
) -> Result<Trial, Error> {
    let mut random = Random::new(SEED).stream(stream);
    let j = random_tensor(moments, &mut random);
    let omega = random.normal_vector().normalize();
    let failed = |error: &dyn std::fmt::Display| Error::Failed(format!("random stream {stream}: {error}"));
    let body = Inertia::from_tensor(j).map_err(|error| failed(&error))?;
    let times: Vec<f64> = (0..=100 * seconds).map(|i| i as f64 / 100.0).collect();
    let (acting, sensor) =
        (Disturbances::default().with_relative_drag(drag), Gyroscope::default().with_noise(noise));
    let rates =
        simulate_with(&body, omega, &times, &acting, &sensor, &mut random).map_err(|error| failed(&error))?;
    let record = Record::from_samples(&times, &rates).map_err(|error| failed(&error))?;

    let (model, coefficients): (_, &[f64]) =
        if drag > 0.0 { (TorqueModel::Drag, &[drag]) } else { (TorqueModel::None, &[]) };
    let known = Settings::default().with_torque(model);
    let bound = foreseen_bound_with(&body, omega, &times, noise, &known, coefficients)
        .ok_or_else(|| failed(&"no Cramér–Rao bound"))?;
    let over_bound = |shape: Matrix3<f64>| square(&entries(&(shape - j)), &bound, true);

    let (mut own, mut broken, mut physical) = (None, false, true);
    match fit(&record, &Settings::default()) {
        Ok(estimate) => {
            let error = entries(&(estimate.shape.tensor() - j));
            own = over_bound(estimate.shape.tensor()).map(|over_bound| Outcome {
                over_bound,
                own: square(&error, &estimate.free_covariance, true),
            });
            physical = estimate.principal[2] <= 0.5 && estimate.principal[0] > 0.0;
        }
        Err(FitError::Unidentifiable(_) | FitError::Unsettled { .. }) => {}
        Err(_) => broken = true,
    }
    let attitudes = attitudes(&body, omega, &times, stream)?;
    let given = Given::new(&record, noise, &attitudes);
    let rivals = RIVALS
        .iter()
        .map(|rival| {
            (0..if asked(*rival) { rival.choices() } else { 0 })
                .map(|k| {
                    let answer = rival.answer(k, &given)?;
                    let over_bound = over_bound(answer.shape)?;
                    Some(Outcome { over_bound, own: answer.own_square(&j) })
                })
                .collect()
        })
        .collect();
    Ok(Trial { own, physical, broken, rivals })
}

/// The attitudes at `times` as a second instrument measures them.
fn attitudes(
    body: &Inertia,
    omega: Vector3<f64>,
    times: &[f64],
    stream: u64,
) -> Result<Vec<UnitQuaternion<f64>>, Error> {
    let mut random = Random::new(SEED).stream(ATTITUDES + stream);
    let motion = FreeMotion::from_omega(body, UnitQuaternion::identity(), omega).map_err(unexpected)?;
    times
        .iter()
        .map(|&t| {
            let exact = motion.at(t).map_err(unexpected)?.rotation();
            let off = random.normal_vector() * (0.5 * ATTITUDE_NOISE);
            Ok(exact * UnitQuaternion::from_quaternion(Quaternion::new(1.0, off.x, off.y, off.z)))
        })
        .collect()
}

fn columns() -> Vec<Column> {
    vec![
        Column::new(
            "body",
            "",
            "principal moments: asymmetric 1, 2, 2.6; near-symmetric 1, 2, 2.1; planar 1, 2, 3; drag: of 1 % of the momentum a second",
        ),
        Column::new("estimator", "", "formulation"),
        Column::new("choice", "", "what serves the estimator best at this noise, of several tried"),
        Column::new("noise", "", "standard deviation of a component over the rate"),
        Column::new(
            "error_over_bound",
            "",
            "root of the mean of e C^-1 e / 5 with C the bound; 1 is the best possible",
        )
        .heading("error/bound"),
        Column::new("median", "", "median over records of the root of e C^-1 e / 5; 0.933 if efficient"),
        Column::new(
            "quantile_90",
            "",
            "the same, which nine records of ten do not exceed; 1.36 if efficient",
        )
        .heading("90 %"),
        Column::new(
            "over_likelihood",
            "",
            "error over that of maximum likelihood, records that both answered",
        )
        .heading("over ML"),
        Column::new("coverage", "", "share of answers whose own 95 % ellipsoid holds the truth"),
        Column::new("answered", "", "records with an answer"),
        Column::new("refused", "", "records without an answer: refused, or the search did not come to rest"),
    ]
}
