//! Maps of equal steps that know the motion beside those that approach it: how near each comes, by order and step.

use nalgebra::{Matrix3, Vector3};
use polhode::body::{Body, Problem};
use polhode::flow::FreeMotion;
use polhode::inertia::Inertia;
use polhode::method::{AnyMethod, method};
use polhode::num::{Dd, Random};
use polhode::run::Run;
use polhode::truth::{LOST, attitude_error};
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Column, Table, row};

use super::SEED;
use crate::experiment::{Context, Report};
use crate::statistics::rounded;
use crate::timing::StepTime;

const MOMENTS: [f64; 3] = [1.0, 2.0, 3.0];

/// Steps, s: at 1 rad/s about the turn of a step, rad.
const STEPS: [f64; 5] = [1.0, 0.75, 0.5, 0.25, 0.125];

/// Times of comparison, s: whole numbers of each step, of which no one is a multiple of 64, where `exact-step` renews its state.
const SHORT: f64 = 765.0;
const LONG: f64 = 12285.0;

/// The closed form in steps, and the discrete Moser–Veselov map of these orders.
fn methods() -> Result<Vec<Box<dyn AnyMethod>>, Error> {
    let orders = (4..=20).step_by(2).map(|order| format!("dmv:{order}"));
    let names = std::iter::once("exact-step".to_owned()).chain(orders);
    names.map(|name| method(&name).map_err(unexpected)).collect()
}

pub(super) fn run(context: &Context, report: &mut Report) -> Result<(), Error> {
    let (starts, span) = context.scale.pick((3, SHORT), (8, LONG), (50, LONG));
    let body = Body::free(Inertia::from_moments(MOMENTS).map_err(unexpected)?);
    let starts: Vec<_> = (0..starts)
        .map(|number| {
            let omega = Random::new(SEED + 2).stream(number).normal_vector().normalize();
            body.state(Default::default(), omega).map_err(unexpected)
        })
        .collect::<Result<_, _>>()?;
    let exact = |start| -> Result<_, Error> {
        let motion = FreeMotion::from_state(body.inertia(), start).map_err(unexpected)?;
        Ok(motion.point_at_dd(Dd::from(span)).attitude)
    };
    let ends = starts.iter().map(exact).collect::<Result<Vec<_>, _>>()?;

    let mut table = Table::new(
        "maps",
        format!(
            "Attitude error of body 1:2:3 after {span} s at 1 rad/s in any direction, {} starts, by method and step.",
            starts.len()
        ),
        vec![
            Column::new("method", "", "exact-step, or the discrete Moser-Veselov map of an order"),
            Column::new("h", "s", "step").latex("$h$"),
            Column::new("steps", "", "steps: of dmv one solution of three quadratic equations each, of exact-step one addition theorem"),
            Column::new("corrections", "", "Newton corrections in a solution, on average, counted on the plain map of the step; at every order alike")
                .digits(2),
            Column::new("median", "rad", "attitude error of half of the starts; empty where more than one in ten is lost").digits(2),
            Column::new("low", "rad", "what one in ten stays below").heading("10 %").digits(2),
            Column::new("high", "rad", "what one in ten exceeds").heading("90 %").digits(2),
            Column::new("lost", "", "starts whose attitude is more than 1 rad off, or whose run failed"),
            Column::new("starts", "", "starts").hidden(),
            Column::new("span", "s", "time at which the attitudes are compared").hidden(),
        ],
    );
    let methods = methods()?;
    let cases: Vec<_> = methods.iter().flat_map(|method| STEPS.map(|h| (method.as_ref(), h))).collect();
    let errors_of = |(method, h): (&dyn AnyMethod, f64)| -> Result<Vec<f64>, Error> {
        let mut errors = Vec::with_capacity(starts.len());
        for (start, end) in starts.iter().zip(&ends) {
            let mut run = Run::new(method, &body, start, h).map_err(unexpected)?;
            let found = run.advance_to((span / h) as u64);
            errors.push(found.map_or(f64::INFINITY, |found| attitude_error(found.point.attitude, *end)));
        }
        errors.sort_by(f64::total_cmp);
        Ok(errors)
    };
    for (errors, (method, h)) in context.in_parallel(cases.clone(), errors_of).into_iter().zip(&cases) {
        let errors = errors?;
        // the nearest member; where more than one in ten is lost, the others are near by chance
        let at = |share: f64| errors[((errors.len() - 1) as f64 * share).round() as usize];
        let share = |share: f64| (at(0.9) <= LOST).then(|| rounded(at(share)));
        let lost = errors.iter().filter(|error| **error > LOST).count() as u64;
        let steps = (span / h) as u64;
        let solved = method.claims(Problem::Free).is_some_and(|claims| claims.cost.solves > 0);
        let corrections = solved.then(|| rounded(corrections(*h, starts[0].momentum(), 1000)));
        table.push(row![
            method.name(),
            *h,
            steps,
            corrections,
            share(0.5),
            share(0.1),
            share(0.9),
            lost,
            starts.len() as u64,
            span
        ]);
    }
    report.checks += table.rows().len() as u64;
    report.tables.push(table);
    report.timing = Some(timing(&body, &cases)?);
    Ok(())
}

/// Newton corrections that a step of the discrete Moser–Veselov map takes, on average over some `steps` from the momentum `m`, by
/// the rule of the library: from the series to the fifth order until the next correction would be below rounding.
fn corrections(h: f64, mut m: Vector3<f64>, steps: u32) -> f64 {
    let half = Vector3::from(MOMENTS).map(|moment| 0.5 * h / moment);
    let settled = f64::EPSILON / 2.0 / 1024.0;
    let mut count = 0;
    for _ in 0..steps {
        // u = (1 + |c|²) m + u × c with c = ½h I⁻¹ u, by orders of h
        let (mut terms, mut cayley) = (vec![m], vec![m.component_mul(&half)]);
        for n in 1..5 {
            let mut term = Vector3::zeros();
            (0..n).for_each(|k| term += terms[k].cross(&cayley[n - 1 - k]));
            (0..n - 1).for_each(|k| term += m * cayley[k].dot(&cayley[n - 2 - k]));
            terms.push(term);
            cayley.push(term.component_mul(&half));
        }
        let mut u: Vector3<f64> = terms.iter().sum();
        for _ in 0..50 {
            let c = u.component_mul(&half);
            let lacking = m * (1.0 + c.norm_squared()) + u.cross(&c) - u;
            let diagonal = Matrix3::from_diagonal(&half);
            let gradient = m * (c.component_mul(&half) * 2.0).transpose() + u.cross_matrix() * diagonal
                - c.cross_matrix();
            let correction = (Matrix3::identity() - gradient).lu().solve(&lacking).unwrap_or(lacking);
            u += correction;
            count += 1;
            let moved = correction.amax() / m.amax();
            if moved * moved <= settled {
                break;
            }
        }
        let c = u.component_mul(&half);
        m += u.cross(&c) * (2.0 / (1.0 + c.norm_squared()));
    }
    f64::from(count) / f64::from(steps)
}

/// Of a step, beside that of rk4.
fn timing(body: &Body, cases: &[(&dyn AnyMethod, f64)]) -> Result<Table, Error> {
    let mut table = Table::new(
        "timing",
        "Time of a step, least of many bursts, beside that of rk4 in the same moments.",
        vec![
            Column::new("method", "", "name in the catalogue"),
            Column::new("h", "s", "step"),
            Column::new("step_ns", "ns", "a step"),
            Column::new("rk4_ns", "ns", "a step of rk4"),
            Column::new("rk4_steps", "", "steps of rk4 that take as long as one second of motion"),
        ],
    );
    let omega = Random::new(SEED + 2).stream(0).normal_vector().normalize();
    let start = body.state(Default::default(), omega).map_err(unexpected)?;
    let start = body.enter(&start).map_err(unexpected)?.to_f64();
    for (method, h) in cases {
        let time = StepTime::measure(*method, body, start, polhode::body::Clock::new(*h))?;
        table.push(row![method.name(), *h, time.seconds * 1e9, time.rk4 * 1e9, time.seconds / time.rk4 / h,]);
    }
    Ok(table)
}
