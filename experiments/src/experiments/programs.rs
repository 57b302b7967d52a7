//! Programs that people run beside the methods here: at equal step, and beside a method of no larger error.

use polhode::body::Body;
use polhode::catalogue;
use polhode::flow::FreeMotion;
use polhode::method::{AnyMethod, method};
use polhode::num::Dd;
use polhode::rotation::rotation_angle;
use polhode::run::{Run, Watch};
use polhode::truth::LOST;
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Column, Table, row};
use serde::Deserialize;

use crate::experiment::{Context, Report};
use crate::timing::StepTime;

/// Figures that the programs themselves give, with what they were asked.
const FIGURES: &str = include_str!("../../data/programs.csv");

const BODY: &str = "textbook";

/// End of the runs, s.
const END: f64 = 1e4;

/// The method that is asked for the error of each program, in steps that are the end over powers of two.
const RIVAL: &str = "dmv:10";
const FEWEST: u32 = 13;
const MOST: u32 = 20;

#[derive(Clone, Deserialize)]
struct Program {
    program: String,
    version: Option<String>,
    scheme: String,
    /// The same scheme here.
    method: Option<String>,
    /// s; none where the program chooses it.
    step: Option<f64>,
    energy_error: f64,
    momentum_error: f64,
    attitude_error: f64,
    /// Processor time per second of motion, in steps of a Runge–Kutta method written by hand.
    rk4_steps: f64,
}

/// One run to the end.
#[derive(Clone, Copy)]
struct Measured {
    step: f64,
    energy_error: Option<f64>,
    attitude_error: f64,
    /// As that of programs.
    rk4_steps: f64,
}

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let mut reader =
        csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(FIGURES.as_bytes());
    let programs = reader.deserialize().collect::<Result<Vec<Program>, _>>().map_err(unexpected)?;
    let same = programs.iter().map(|program| Some((program.method.clone()?, steps(program.step?)?)));
    let ladder = (FEWEST..=MOST).map(|power| Some((RIVAL.to_owned(), 1 << power)));
    let found = context.in_parallel(same.chain(ladder).collect(), |part| {
        part.map(|(name, steps)| measure(&name, steps)).transpose()
    });
    let mut found = found.into_iter().collect::<Result<Vec<_>, _>>()?;
    let ladder: Vec<Measured> = found.split_off(programs.len()).into_iter().flatten().collect();

    let mut errors = errors();
    let mut costs = costs();
    for (program, same) in programs.iter().zip(found) {
        let error = program.attitude_error;
        // the longest step whose error is not larger
        let equal = ladder.iter().find(|run| error <= LOST && run.attitude_error <= error);
        let version = program.version.as_deref();
        errors.push(row![
            program.program.as_str(),
            version,
            program.scheme.as_str(),
            program.step,
            program.energy_error,
            program.momentum_error,
            held(error),
            program.method.as_deref(),
            same.and_then(|run| run.energy_error),
            same.and_then(|run| held(run.attitude_error)),
            equal.map(|run| run.step),
            equal.map(|run| run.attitude_error),
        ]);
        costs.push(row![
            program.program.as_str(),
            program.scheme.as_str(),
            held(error).map_or("lost", |_| "held"),
            program.rk4_steps,
            program.method.as_deref(),
            same.map(|run| run.rk4_steps),
            equal.map(|run| run.rk4_steps),
        ]);
    }
    Ok(Report { tables: vec![errors], times: vec![costs], ..Report::default() })
}

/// Steps of `step` to the end.
fn steps(step: f64) -> Option<u64> {
    Some(libm::round(END / step)).filter(|steps| *steps >= 1.0).map(|steps| steps as u64)
}

fn held(error: f64) -> Option<f64> {
    (error <= LOST).then_some(error)
}

fn measure(name: &str, steps: u64) -> Result<Measured, Error> {
    let named = catalogue::body(BODY).ok_or_else(|| unexpected("the textbook body is missing"))?;
    let body = Body::free(named.inertia.clone());
    let start = body.state(Default::default(), named.omega_body.into()).map_err(unexpected)?;
    let method: Box<dyn AnyMethod> = method(name).map_err(unexpected)?;
    let step = END / steps as f64;
    let run = Run::new(method.as_ref(), &body, &start, step).map_err(unexpected)?;
    let exact = FreeMotion::from_point(body.inertia(), run.start().to_dd());
    let time = StepTime::measure(
        method.as_ref(),
        &body,
        body.enter(&start).map_err(unexpected)?.to_f64(),
        polhode::body::Clock::new(step),
    )?;
    let mut run = run.watching(Watch::EveryStep);
    let end = run.advance_to(steps).map_err(unexpected)?;
    let truth = exact.point_at_dd(Dd::from(step) * Dd::from(steps));
    Ok(Measured {
        step,
        energy_error: end.worst.energy,
        attitude_error: rotation_angle(end.point.to_dd().attitude, truth.attitude).hi(),
        rk4_steps: rounded(time.seconds / time.rk4 / step),
    })
}

/// To three digits: what depends on the machine has no more.
fn rounded(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}

fn errors() -> Table {
    let caption = "Programs beside the methods here: the body 1, 2, 3 to 10^4 s, at equal step, and beside dmv:10 at an attitude error that is not larger.";
    let columns = vec![
        Column::new("program", "", "who ran"),
        Column::new("version", "", "of the program").hidden(),
        Column::new("scheme", "", "as the program calls it"),
        Column::new("step", "s", "step; empty where the program chooses it"),
        Column::new("energy_error", "", "largest relative error of the energy that the program gives")
            .heading("energy")
            .digits(2),
        Column::new("momentum_error", "", "the same of the momentum").heading("momentum").digits(2),
        Column::new(
            "attitude_error",
            "rad",
            "attitude error at the end that the program gives; empty where it is lost",
        )
        .heading("attitude")
        .digits(2),
        Column::new("method", "", "the same scheme here").heading("here"),
        Column::new("method_energy_error", "", "its largest relative energy error at the same step")
            .heading("energy")
            .digits(2),
        Column::new("method_attitude_error", "rad", "its attitude error").heading("attitude").digits(2),
        Column::new(
            "equal_step",
            "s",
            "longest step of dmv:10 whose attitude error is not larger than the program's",
        )
        .heading("step of dmv:10")
        .digits(3),
        Column::new("equal_attitude_error", "rad", "the attitude error then").heading("its error").digits(2),
    ];
    Table::new("errors", caption, columns)
}

fn costs() -> Table {
    let caption = "Processor time per second of motion in steps of rk4: of programs as measured beside a hand-written one, of the \
                   methods here on this machine.";
    let columns = vec![
        Column::new("program", "", "who ran"),
        Column::new("scheme", "", "as the program calls it"),
        Column::new("attitude", "", "whether the attitude is held to 1 rad at the end"),
        Column::new("rk4_steps", "", "processor time of the program"),
        Column::new("method", "", "the same scheme here"),
        Column::new("method_rk4_steps", "", "processor time at the same step"),
        Column::new(
            "equal_rk4_steps",
            "",
            "processor time of dmv:10 at an attitude error that is not larger",
        ),
    ];
    Table::new("costs", caption, columns)
}
