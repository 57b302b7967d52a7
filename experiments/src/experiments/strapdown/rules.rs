//! The rules side by side: errors at equal samples and at equal arithmetic, and their orders.

use nalgebra::Vector3;
use polhode::laws::{Counted, operations};
use polhode::num::Real;
use polhode::rotation::{Quat, Vec3};
use polhode::strapdown::{Kind, Rule, Strapdown};
use polhode::truth::LOST;
use polhode_files::error::{Error, unexpected};
use polhode_pages::figure::{Curve, Figure};
use polhode_pages::table::{Column, Table, row};

use super::motion::{Known, even};
use crate::experiment::{Context, Report};

/// The start of the table, 1.1 rad/s.
const OMEGA: [f64; 3] = [0.4, 1.0, -0.3];

/// Step, s, and time, s: 0.011, 0.055 and 0.22 rad a sample.
const CASES: [(f64, f64); 3] = [(0.01, 200.0), (0.05, 1000.0), (0.2, 1000.0)];

/// The rule whose arithmetic the others get: by more samples in the same time.
const RICH: (u32, usize) = (6, 8);

fn rules(kind: Kind) -> Result<Vec<Rule>, Error> {
    let mut rules: Vec<Rule> = Rule::RIVALS.into_iter().filter(|rule| rule.check(kind).is_ok()).collect();
    for (order, samples) in [(2, 2), (4, 4), (4, 6), (6, 6), (6, 8), (6, 10)] {
        rules.push(Rule::magnus(order, samples).map_err(unexpected)?);
    }
    Ok(rules)
}

/// What a sine with its cosine counts: about as many operations as its polynomials take.
const SINE: u64 = 20;

/// Operations of a rule for one sample: arithmetic on a double that counts.
pub(super) fn cost(kind: Kind, rule: Rule) -> Result<u64, Error> {
    const SAMPLES: u32 = 400;
    let mut strapdown = Strapdown::<Counted>::new(kind, rule, Quat::identity()).map_err(unexpected)?;
    let mut push = |k: u32| {
        let angle = 0.01 * f64::from(k);
        let (sin, cos) = libm::sincos(angle);
        let reading = Vec3([cos, sin, 0.3]).map(|x| Counted::of(0.01 * x));
        strapdown.push(Counted::of(f64::from(k)), reading).map(|_| ()).map_err(unexpected)
    };
    // the weights of even steps are worked out with the first
    (0..100).try_for_each(&mut push)?;
    let mut failed = Ok(());
    let done = operations(|| failed = (100..100 + SAMPLES).try_for_each(&mut push));
    failed?;
    Ok((done.arithmetic + done.roots + SINE * (done.sines + done.others)) / u64::from(SAMPLES))
}

/// Error, or nothing where the attitude is lost.
fn held(error: f64) -> Option<f64> {
    (error < LOST).then_some(error)
}

pub(super) fn compare(context: &Context, report: &mut Report) -> Result<(), Error> {
    let cases = context.scale.pick(&CASES[1..2], &CASES[..], &CASES[..]);
    let shorter = context.scale.pick(0.1, 0.3, 1.0);
    let mut parts = Vec::new();
    for kind in [Kind::Rate, Kind::Increment] {
        let rich = cost(kind, Rule::magnus(RICH.0, RICH.1).map_err(unexpected)?)?;
        for rule in rules(kind)? {
            let own = cost(kind, rule)?;
            let denser = rich.div_ceil(own).max(1);
            parts.extend(cases.iter().map(|case| (kind, rule, *case, own, denser)));
        }
    }
    let rows = context.in_parallel(parts, |(kind, rule, (h, until), own, denser)| {
        let known = Known::free(Vector3::from(OMEGA))?;
        let until = until * shorter;
        let same = known.error(kind, rule, &even(h, until))?;
        let more = match denser {
            1 => same,
            _ => known.error(kind, rule, &even(h / denser as f64, until))?,
        };
        Ok::<_, Error>(row![
            kind.name(),
            rule.to_string(),
            h * Vector3::from(OMEGA).norm(),
            until,
            held(same),
            own,
            denser,
            held(more)
        ])
    });
    let mut table = Table::new(
        "rules",
        "Largest attitude error of each rule on the free body with moments 1, 2, 3, at equal samples, and at equal arithmetic: with as \
         many samples more as the arithmetic of order 6 through 8 samples pays for. Empty: beyond 1 rad, lost.",
        vec![
            Column::new("kind", "", "what a reading is"),
            Column::new("rule", "", "rule"),
            Column::new("angle", "rad", "turn between two samples").digits(2),
            Column::new("time", "s", "time of the record").hidden(),
            Column::new("error", "rad", "largest attitude error at equal samples").digits(2),
            Column::new("operations", "", "arithmetic of one sample"),
            Column::new("denser", "", "samples in the time of one, at equal arithmetic"),
            Column::new("error_equal_arithmetic", "rad", "largest attitude error at equal arithmetic")
                .heading("at equal arithmetic")
                .digits(2),
        ],
    );
    for row in rows {
        table.push(row?);
    }
    for kind in [Kind::Rate, Kind::Increment] {
        let caption = format!("Attitude errors of the rules, readings: {kind}.");
        report.views.push(table.view(format!("rules-{kind}"), caption, &["kind"], ("kind", kind.name())));
    }
    report.tables.push(table);
    Ok(())
}

/// Orders that rules have, where errors are those of the rule and not of rounding or of a wide polynomial far from convergence.
fn claimed(kind: Kind, rule: Rule) -> Option<f64> {
    match (kind, rule) {
        (_, Rule::Magnus(magnus)) if magnus.samples() == magnus.order() as usize => {
            Some(f64::from(magnus.order()))
        }
        (Kind::Rate, Rule::Hold) => Some(1.0),
        (Kind::Rate, Rule::Trapezoid | Rule::RungeKutta) | (_, Rule::Hold) => Some(2.0),
        (_, Rule::Trapezoid) => Some(3.0),
        _ => None,
    }
}

/// Between an order as it is claimed and as it is measured at the last halving.
const CLOSE: f64 = 0.15;

pub(super) fn orders(context: &Context, report: &mut Report) -> Result<(), Error> {
    let halvings: u32 = context.scale.pick(4, 5, 7);
    let mut parts = Vec::new();
    for motion in ["free", "top"] {
        for kind in Kind::ALL {
            parts.extend(rules(kind)?.into_iter().map(|rule| (motion, kind, rule)));
        }
    }
    let found = context.in_parallel(parts, |(motion, kind, rule)| {
        let known = if motion == "top" { Known::top()? } else { Known::free(Vector3::from(OMEGA))? };
        let steps = (0..halvings).map(|k| 0.8 / f64::from(1 << k));
        let errors = steps.map(|h| known.error(kind, rule, &even(h, 16.0)).map(|error| (h, error)));
        errors.collect::<Result<Vec<_>, Error>>().map(|errors| (motion, kind, rule, errors))
    });
    let mut table = Table::new(
        "orders",
        "Attitude error over 16 s by the step between samples, and its order at each halving, on the free body and on a heavy top.",
        vec![
            Column::new("motion", "", "free: moments 1, 2, 3; top: symmetric, under gravity"),
            Column::new("kind", "", "what a reading is"),
            Column::new("rule", "", "rule"),
            Column::new("h", "s", "time between samples"),
            Column::new("error", "rad", "largest attitude error").digits(2),
            Column::new("order", "", "log2 of the ratio to the error at twice the step"),
        ],
    );
    let mut figure = Figure::log_log(
        "orders",
        "Attitude error over 16 s of a free body from instantaneous rates",
        "time between samples (s)",
        "attitude error (rad)",
    );
    for found in found {
        let (motion, kind, rule, errors) = found?;
        let mut last = None;
        for (k, (h, error)) in errors.iter().enumerate() {
            let order = k.checked_sub(1).map(|before| libm::log2(errors[before].1 / error));
            if *error > 1e-12 && *error < 1e-2 {
                last = order.or(last);
            }
            table.push(row![motion, kind.name(), rule.to_string(), *h, *error, order]);
        }
        if let (Some(claimed), Some(found)) = (claimed(kind, rule), last) {
            report.checks += 1;
            if (claimed - found).abs() > CLOSE {
                let place = format!("{rule} on {kind}s, {motion}");
                report.failures.push(format!("{place}: order {found:.2} where {claimed} is claimed"));
            }
        }
        if motion == "free" && kind == Kind::Rate {
            figure.series.push(Curve::new(rule.to_string(), errors));
        }
    }
    report.tables.push(table);
    report.figures.push(figure);
    Ok(())
}
