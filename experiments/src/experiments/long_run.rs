//! Errors at logarithmic times over very many steps: what grows, and how fast.

use std::time::Instant;

use polhode::body::Body;
use polhode::catalogue;
use polhode::flow::FreeMotion;
use polhode::method::method;
use polhode::run::{Run, Schedule};
use polhode::truth::{Ending, LOST, attitude_error};
use polhode_files::error::Error;
use polhode_pages::figure::{Curve, Figure, ten_to};
use polhode_pages::table::{Cell, Column, Table, row};

use super::followed::status;
use crate::experiment::{Context, Report};

const METHODS: [&str; 8] = [
    "rk4",
    "rk4-normalized",
    "implicit-midpoint",
    "rattle",
    "dmv:10",
    "lie-poisson",
    "two-turn",
    "exact-step",
];

/// A dyadic step: n h is exact, and about 0.05 rad.
const STEP: f64 = 1.0 / 64.0;

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let power = context.scale.pick(4, 6, 9);
    let (steps, counted) = (10_u64.pow(power), ten_to(power as i32));
    let found = context.in_parallel(METHODS.to_vec(), |name| follow(name, steps));
    let mut series = Table::new(
        "series",
        format!("Errors at logarithmic times over {counted} steps of {STEP} s, dyadic body."),
        vec![
            Column::new("method", "", "name in the catalogue"),
            Column::new("steps", "", "steps taken"),
            Column::new("t", "s", "time").hidden(),
            Column::new("energy_error", "", "max |E - E0| / |E0| over every step so far")
                .heading("energy")
                .digits(2),
            Column::new("momentum_error", "", "max ||m| - |m0|| / |m0| over every step so far")
                .heading("|m|")
                .latex("$|m|$")
                .digits(2),
            Column::new("momentum_vector_error", "", "max |L - L0| / |L0| over every step so far")
                .heading("L")
                .latex("$L$")
                .digits(2),
            Column::new(
                "attitude_error",
                "rad",
                "angle between computed and exact attitude; empty once it is lost",
            )
            .heading("attitude")
            .digits(2),
            Column::new(
                "status",
                "",
                "ok; lost: the attitude was first seen more than 1 rad off at this time",
            ),
        ],
    );
    let mut summary = series.clone();
    summary.name = "summary".into();
    summary.caption = format!("Errors after {counted} steps of {STEP} s, dyadic body.");
    let mut timing = Table::new(
        "timing",
        "Time of each run with its errors observed at every step, two runs side by side where there are two cores.",
        vec![
            Column::new("method", "", "name in the catalogue"),
            Column::new("seconds", "s", "wall time of the run"),
            Column::new("step_ns", "ns", "the same per step").heading("ns/step"),
        ],
    );
    let mut energy = Figure::log_log(
        "energy",
        format!("Energy error over {counted} steps of 1/64 s, body 5/8 : 3/4 : 1"),
        "steps",
        "largest relative energy error so far",
    );
    let mut attitude = Figure::log_log(
        "attitude",
        format!("Attitude error over {counted} steps of 1/64 s, body 5/8 : 3/4 : 1"),
        "steps",
        "attitude error (rad)",
    );
    attitude.level("lost beyond 1 rad", 1.0);
    for (name, found) in METHODS.into_iter().zip(found) {
        let (rows, seconds) = found?;
        let curve = |column: &str| {
            let places = series.place("steps").zip(series.place(column));
            let cells =
                |row: &Vec<Cell>| places.map(|(steps, error)| (row[steps].clone(), row[error].clone()));
            let point = |row: &Vec<Cell>| match cells(row) {
                Some((Cell::Integer(n), Cell::Number(x))) => Some((n as f64, x)),
                _ => None,
            };
            Curve::new(name, rows.iter().filter_map(point).collect())
        };
        energy.series.push(curve("energy_error"));
        attitude.series.push(curve("attitude_error"));
        if let Some(last) = rows.last() {
            summary.push(last.clone());
        }
        timing.push(row![name, seconds, seconds * 1e9 / steps as f64]);
        for row in rows {
            series.push(row);
        }
    }
    Ok(Report {
        tables: vec![series],
        views: vec![summary],
        figures: vec![energy, attitude],
        timing: Some(timing),
        ..Report::default()
    })
}

/// The rows of one method, and the seconds they took.
fn follow(name: &str, steps: u64) -> Result<(Vec<Vec<Cell>>, f64), Error> {
    let failed = |error: &dyn std::fmt::Display| Error::Failed(format!("{name}: {error}"));
    let dyadic = catalogue::body("dyadic").ok_or_else(|| failed(&"no dyadic body in the catalogue"))?;
    let body = Body::free(dyadic.inertia);
    let start = body.state(Default::default(), dyadic.omega_body.into()).map_err(|e| failed(&e))?;
    let method = method(name).map_err(|e| failed(&e))?;
    let mut run = Run::new(method.as_ref(), &body, &start, STEP).map_err(|e| failed(&e))?;
    let exact = FreeMotion::from_point(body.inertia(), run.start().to_dd());
    let clock = Instant::now();
    let (mut rows, mut ending) = (Vec::new(), Ending::Held);
    for sample in run.samples(Schedule::logarithmic(steps, 4)).skip(1) {
        let sample = sample.map_err(|e| failed(&e))?;
        let attitude = attitude_error(sample.point.attitude, exact.point_at_dd(sample.elapsed).attitude);
        if ending == Ending::Held && attitude > LOST {
            ending = Ending::Lost(sample.elapsed.hi());
        }
        let worst = sample.worst;
        rows.push(
            row![
                name,
                sample.steps,
                sample.elapsed.hi(),
                worst.energy,
                worst.momentum_norm,
                worst.momentum_vector,
                (ending == Ending::Held).then_some(attitude),
                status(ending)
            ]
            .to_vec(),
        );
    }
    Ok((rows, clock.elapsed().as_secs_f64()))
}
