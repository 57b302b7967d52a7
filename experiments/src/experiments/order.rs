//! Convergence orders, measured in double-double against the exact motion.

use polhode::body::{Body, Problem};
use polhode::catalogue;
use polhode::method::{AnyMethod, without_projections};
use polhode::run::{Halving, halvings};
use polhode_files::error::Error;
use polhode_pages::figure::{Curve, Figure};
use polhode_pages::table::{Column, Table, row};

use super::followed::claimed_evaluations;
use crate::experiment::{Context, Report};
use crate::statistics::largest;

/// Time over which errors grow, s: a power of two, so that every step is exact.
const SPAN: f64 = 2.0;

/// Errors above this are those of the method, not of rounding in double-double.
const FLOOR: f64 = 1e-24;

/// Between an order as it is claimed and as it is measured.
const CLOSE: f64 = 0.1;

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let finest = context.scale.pick(8, 12, 14);
    let failed = |error: &dyn std::fmt::Display| Error::Failed(error.to_string());
    let dyadic = catalogue::body("dyadic").ok_or_else(|| failed(&"no dyadic body in the catalogue"))?;
    let body = Body::free(dyadic.inertia);
    let start = body
        .enter_omega(nalgebra::UnitQuaternion::identity().into(), polhode::rotation::Vec3(dyadic.omega_body))
        .map_err(|error| failed(&error))?;
    let measure = |method: Box<dyn AnyMethod>| {
        let errors = halvings(method.as_ref(), &body, &start, SPAN, 4..finest + 1);
        errors.map(|errors| (method, errors)).map_err(|error| failed(&error))
    };
    let order = |method: &dyn AnyMethod| method.claims(Problem::Free).and_then(|claims| claims.order);
    let stepping = without_projections().into_iter().filter(|method| order(method).is_some()).collect();
    let series = context.in_parallel(stepping, measure);

    let mut errors = Table::new(
        "errors",
        format!("Errors of attitude and momentum after {SPAN} s by step, dyadic body, in double-double."),
        vec![
            Column::new("method", "", "name in the catalogue"),
            Column::new("h", "s", "step").latex("$h$"),
            Column::new(
                "evaluations",
                "",
                "evaluations of the right-hand side; empty where a step is made of other work",
            ),
            Column::new("attitude_error", "rad", "angle between computed and exact attitude")
                .heading("attitude"),
            Column::new("attitude_order", "", "log2 of the ratio to the error at twice the step")
                .heading("order"),
            Column::new("momentum_error", "", "|m - m_exact| / |m|, body axes").heading("momentum"),
            Column::new("momentum_order", "", "log2 of the ratio to the error at twice the step")
                .heading("order"),
        ],
    );
    let mut orders = Table::new(
        "orders",
        "Order of convergence: claimed, and measured at the last halving of the step whose errors are above 1e-24.",
        vec![
            Column::new("method", "", "name in the catalogue"),
            Column::new("claimed", "", "order that the method claims"),
            Column::new("attitude_order", "", "measured on the attitude").heading("attitude").digits(5),
            Column::new("momentum_order", "", "measured on the momentum").heading("momentum").digits(5),
        ],
    );
    let (mut as_claimed, mut failures) = (0, Vec::new());
    let mut figure = Figure::log_log(
        "order",
        format!(
            "Attitude error of body 5/8 : 3/4 : 1 after {SPAN} s, in double-double; claimed orders in brackets"
        ),
        "step h (s)",
        "attitude error (rad)",
    );
    for found in series {
        let (method, halved) = found?;
        let mut last = (None, None);
        for (k, now) in halved.iter().enumerate() {
            let order = |pick: fn(&Halving) -> f64| {
                k.checked_sub(1).map(|before| libm::log2(pick(&halved[before]) / pick(now)))
            };
            let found = (order(|e| e.attitude_error), order(|e| e.momentum_error));
            // below, the rounding of double-double shows
            if now.attitude_error.min(now.momentum_error) > FLOOR {
                last = found;
            }
            let evaluations = claimed_evaluations(&method, Problem::Free, (SPAN / now.h) as u64);
            errors.push(row![
                method.name(),
                now.h,
                evaluations,
                now.attitude_error,
                found.0,
                now.momentum_error,
                found.1,
            ]);
        }
        orders.push(row![method.name(), order(&method).map(u64::from), last.0, last.1]);
        let measured = [last.0, last.1].into_iter().flatten();
        let claim = order(&method).map_or(f64::NAN, f64::from);
        let off = largest(measured.map(|found| (found - claim).abs()));
        if off <= CLOSE {
            as_claimed += 1;
        } else {
            failures.push(format!("{} claims order {claim}, {off} from what is measured", method.name()));
        }
        let claimed = order(&method).map_or(String::new(), |order| format!(" ({order})"));
        let points = halved.iter().map(|e| (e.h, e.attitude_error)).collect();
        figure.series.push(Curve::new(method.name() + &claimed, points));
    }
    // a fan of slopes in the corner that no curve reaches
    let widest = figure.series.iter().flat_map(|s| s.points.iter().map(|p| p.0)).fold(0.0, f64::max);
    for (label, slope) in [("h²", 2.0), ("h⁸", 8.0)] {
        figure.guide(label, slope, (widest / 8.0, 1e-29), [widest / 8.0, widest]);
    }
    let checks = as_claimed + failures.len() as u64;
    Ok(Report {
        conclusion: format!("{as_claimed} of {checks} methods converge with the order that they claim"),
        checks,
        failures,
        views: vec![orders.clone()],
        tables: vec![orders, errors],
        figures: vec![figure],
        ..Report::default()
    })
}
