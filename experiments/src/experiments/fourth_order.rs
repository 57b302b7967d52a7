//! Attitude errors of all methods of order four beside that of rk4, over random free bodies: at the same step, and at the same
//! cost.

use polhode::body::Problem;
use polhode::method::{AnyMethod, method, without_projections};
use polhode::num::Random;
use polhode::run::Watch;
use polhode::truth::{Care, Ending, LOST, Truth, evenly};
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Column, Table, row};

use super::contestants::{SCHEMES, knows_the_motion, weighed};
use super::phase::drawn;
use crate::experiment::{Context, Report};
use crate::statistics::{Interval, largest};

const SEED: u64 = 1901;

/// Step of all at the same step, and of rk4 at the same cost, s: bodies turn at 1 rad/s.
const STEP: f64 = 1.0 / 32.0;

/// Times at which the attitude is looked at, equally far apart.
const LOOKS: u32 = 64;

/// What the others are compared with.
const YARDSTICK: &str = "rk4";

/// The largest attitude error of a method from every start, rad; infinite where the attitude is lost.
struct Errors {
    name: String,
    /// Evaluations of a step over those of rk4.
    cost: f64,
    at_step: Vec<f64>,
    at_cost: Vec<f64>,
}

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let bodies: u64 = context.scale.pick(4, 16, 128);
    let span = context.scale.pick(64.0, 256.0, 1024.0);
    let truths = context.in_parallel((0..bodies).collect(), |member| {
        let (body, start) = drawn(Random::new(SEED).stream(member))?;
        Truth::new(&body, &start, &evenly(span, LOOKS)).map_err(unexpected)
    });
    let truths = truths.into_iter().collect::<Result<Vec<_>, Error>>()?;
    let found = context.in_parallel(of_order_four()?, |method| examine(method.as_ref(), &truths));
    let mut found = found.into_iter().collect::<Result<Vec<_>, Error>>()?;
    let of_rk4 = found.iter().position(|errors| errors.name == YARDSTICK);
    let yardstick = of_rk4.map(|k| found.remove(k)).ok_or_else(|| unexpected("rk4 is not of order four"))?;
    found.sort_by(|a, b| median(&a.ratios(&yardstick).1).total_cmp(&median(&b.ratios(&yardstick).1)));
    let caption = format!(
        "Largest attitude error over that of rk4, methods of order four, from {bodies} random bodies and starts that turn by {span} rad: at the \
         step of 1/{} rad, and at as many evaluations (an implicit solution counts as six); below 1 a method is more accurate than rk4.",
        1.0 / STEP
    );
    let mut table = Table::new("methods", caption, columns());
    for errors in &found {
        let (at_step, at_cost) = errors.ratios(&yardstick);
        let better = |ratios: &[f64]| ratios.iter().filter(|ratio| **ratio < 1.0).count() as u64;
        let shares = [&at_step, &at_cost].map(|ratios| Interval::new(better(ratios), bodies));
        table.push(row![
            errors.name.as_str(),
            errors.cost,
            finite(quantile(&at_step, 0.1)),
            finite(median(&at_step)),
            finite(quantile(&at_step, 0.9)),
            shares[0].map(|share| share.share),
            shares[0].map(|share| share.low),
            shares[0].map(|share| share.high),
            finite(quantile(&at_cost, 0.1)),
            finite(median(&at_cost)),
            finite(quantile(&at_cost, 0.9)),
            shares[1].map(|share| share.share),
            shares[1].map(|share| share.low),
            shares[1].map(|share| share.high),
        ]);
    }
    let beaten: Vec<&str> = found
        .iter()
        .filter(|errors| median(&errors.ratios(&yardstick).1) > 1.0)
        .map(|errors| errors.name.as_str())
        .collect();
    let conclusion = format!(
        "Of {} other methods of order four, at as many evaluations, {} lose more of the attitude than rk4 in the median over {bodies} random bodies: {}",
        found.len(),
        beaten.len(),
        beaten.join(", ")
    );
    Ok(Report { conclusion, tables: vec![table], seed: Some(SEED), ..Report::default() })
}

/// Of the catalogue and of the schemes beside it, those with equal steps that know nothing of the exact motion.
fn of_order_four() -> Result<Vec<Box<dyn AnyMethod>>, Error> {
    let schemes =
        SCHEMES.iter().map(|name| method(name).map_err(unexpected)).collect::<Result<Vec<_>, _>>()?;
    let all = without_projections().into_iter().chain(schemes);
    let is_one = |method: &dyn AnyMethod| {
        let order = method.claims(Problem::Free).and_then(|claims| claims.order);
        // without torque kick-drift is exact, whatever its scheme
        let name = method.name();
        let exact = knows_the_motion(&name) || name.starts_with("kick-drift");
        order == Some(4) && method.tolerance().is_none() && !exact
    };
    Ok(all.filter(|method| is_one(method.as_ref())).collect())
}

fn examine(method: &dyn AnyMethod, truths: &[Truth]) -> Result<Errors, Error> {
    let weight = |method: &dyn AnyMethod| {
        method.claims(Problem::Free).map_or(f64::INFINITY, |claims| weighed(claims.cost))
    };
    let yardstick = polhode::method::method(YARDSTICK).map_err(unexpected)?;
    let cost = weight(method) / weight(yardstick.as_ref());
    let errors = |step: f64| {
        let of_one = |truth: &Truth| {
            let mut care = Care::default();
            (care.watch, care.until_lost) = (Watch::Never, true);
            let judged = truth.judge(method, step, care).map_err(unexpected)?;
            let largest = largest(judged.looks.iter().map(|look| look.attitude_error));
            Ok(if judged.ending == Ending::Held && largest <= LOST { largest } else { f64::INFINITY })
        };
        truths.iter().map(of_one).collect::<Result<Vec<_>, Error>>()
    };
    Ok(Errors { name: method.name(), cost, at_step: errors(STEP)?, at_cost: errors(STEP * cost)? })
}

impl Errors {
    /// Over those of another, ascending: at the same step, and at the same cost. Starts from which both are lost do not count.
    fn ratios(&self, other: &Errors) -> (Vec<f64>, Vec<f64>) {
        let over = |mine: &[f64], theirs: &[f64]| {
            let ratios = mine.iter().zip(theirs).map(|(mine, theirs)| mine / theirs);
            let mut ratios: Vec<f64> = ratios.filter(|ratio| !ratio.is_nan()).collect();
            ratios.sort_by(f64::total_cmp);
            ratios
        };
        (over(&self.at_step, &other.at_step), over(&self.at_cost, &other.at_cost))
    }
}

/// By the nearest rank, of ascending values; infinite of none.
fn quantile(values: &[f64], share: f64) -> f64 {
    let last = values.len().saturating_sub(1) as f64;
    values.get((share * last).round() as usize).copied().unwrap_or(f64::INFINITY)
}

fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// Empty where the attitude is lost.
fn finite(x: f64) -> Option<f64> {
    Some(x).filter(|x| x.is_finite())
}

fn columns() -> Vec<Column> {
    let share = |name, meaning| Column::new(name, "", meaning).hidden();
    vec![
        Column::new("method", "", "name in the catalogue, with its scheme"),
        Column::new("cost", "", "evaluations of a step over those of rk4").digits(2),
        Column::new("step_p10", "", "at the same step: 10 % of the ratios").hidden(),
        Column::new("step", "", "at the same step: median; empty where most are lost")
            .heading("same step")
            .digits(2),
        Column::new("step_p90", "", "at the same step: 90 %").heading("90 %").digits(2),
        Column::new(
            "step_better",
            "",
            "share of the bodies where it is more accurate than rk4 at the same step",
        )
        .heading("better")
        .digits(2),
        share("step_better_low", "95 % interval of this share: its lower end"),
        share("step_better_high", "its upper end"),
        Column::new("cost_p10", "", "at the same cost: 10 % of the ratios").hidden(),
        Column::new("cost_median", "", "at the same cost: median").heading("same cost").digits(2),
        Column::new("cost_p90", "", "at the same cost: 90 %").heading("90 %").digits(2),
        Column::new(
            "cost_better",
            "",
            "share of the bodies where it is more accurate than rk4 at the same cost",
        )
        .heading("better")
        .digits(2),
        share("cost_better_low", "95 % interval of this share: its lower end"),
        share("cost_better_high", "its upper end"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_methods_of_order_four_have_equal_steps_and_rk4_is_one() {
        let names: Vec<String> = of_order_four().unwrap().iter().map(|method| method.name()).collect();
        for name in ["rk4", "rkmk4", "commutator-free-4", "gauss:4", "dmv:4", "two-turn@suzuki-4"] {
            assert!(names.iter().any(|found| found == name), "{name}: {names:?}");
        }
        assert!(!names.iter().any(|name| name == "dmv:6" || name.starts_with("tsit5")), "{names:?}");
    }

    #[test]
    fn ratios_leave_out_starts_from_which_both_are_lost() {
        let of = |errors: &[f64]| Errors {
            name: String::new(),
            cost: 1.0,
            at_step: errors.to_vec(),
            at_cost: errors.to_vec(),
        };
        let lost = f64::INFINITY;
        let (ratios, _) = of(&[2.0, lost, lost, 1.0]).ratios(&of(&[1.0, lost, 1.0, lost]));
        assert_eq!(ratios, [0.0, 2.0, lost]);
        assert_eq!((quantile(&ratios, 0.5), finite(quantile(&ratios, 0.9))), (2.0, None));
    }
}
