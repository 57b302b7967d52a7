//! Attitude errors of all methods of order four beside that of rk4, over random free bodies: at the same step, and at the same
//! cost.

use polhode::body::Problem;
use polhode::method::{AnyMethod, method, without_projections};
use polhode::num::Random;
use polhode::run::Watch;
use polhode::truth::{Care, Ending, LOST, Truth, evenly};
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Cell, Column, Table, row};

use super::contestants::{SCHEMES, knows_the_motion, weighed};
use super::phase::drawn;
use crate::experiment::{Context, Report};
use crate::statistics::{Interval, Quantiles, largest};

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
    let mut found = found.iter().map(|errors| Beside::new(errors, &yardstick)).collect::<Option<Vec<_>>>();
    let found = found.as_mut().ok_or_else(|| unexpected("no start from which an attitude is held"))?;
    found.sort_by(|a, b| a.at_cost.ratios.median.total_cmp(&b.at_cost.ratios.median));
    let caption = format!(
        "Largest attitude error over that of rk4, methods of order four, from {bodies} random bodies and starts that turn by {span} rad: at the \
         step of 1/{} rad, and at as many evaluations (an implicit solution counts as six); below 1 a method is more accurate than rk4.",
        1.0 / STEP
    );
    let mut table = Table::new("methods", caption, columns());
    for Beside { name, cost, at_step, at_cost } in found.iter() {
        let cells = [at_step, at_cost].into_iter().flat_map(Compared::cells);
        table.push(row![*name, *cost].into_iter().chain(cells));
    }
    let beaten = found.iter().filter(|one| one.at_cost.ratios.median > 1.0).map(|one| one.name);
    let beaten: Vec<&str> = beaten.collect();
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

/// A method beside the yardstick.
struct Beside<'a> {
    name: &'a str,
    cost: f64,
    at_step: Compared,
    at_cost: Compared,
}

/// Errors over those of the yardstick.
struct Compared {
    ratios: Quantiles,
    /// Of the starts from which they are smaller.
    better: Interval,
}

impl<'a> Beside<'a> {
    /// `None` where there is no start from which one of the two holds the attitude.
    fn new(errors: &'a Errors, yardstick: &Errors) -> Option<Self> {
        Some(Beside {
            name: &errors.name,
            cost: errors.cost,
            at_step: Compared::new(&errors.at_step, &yardstick.at_step)?,
            at_cost: Compared::new(&errors.at_cost, &yardstick.at_cost)?,
        })
    }
}

impl Compared {
    /// Starts from which both are lost do not count.
    fn new(mine: &[f64], theirs: &[f64]) -> Option<Self> {
        let ratios = mine.iter().zip(theirs).map(|(mine, theirs)| mine / theirs);
        let ratios: Vec<f64> = ratios.filter(|ratio| !ratio.is_nan()).collect();
        let better = ratios.iter().filter(|ratio| **ratio < 1.0).count();
        let better = Interval::new(better as u64, ratios.len() as u64)?;
        Some(Compared { ratios: Quantiles::of(ratios)?, better })
    }

    fn cells(&self) -> [Cell; 6] {
        // empty where the attitude is lost
        let held = |ratio: f64| Some(ratio).filter(|ratio| ratio.is_finite());
        let Compared { ratios: Quantiles { low, median, high }, better } = self;
        row![held(*low), held(*median), held(*high), better.share, better.low, better.high]
    }
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
    fn starts_from_which_both_are_lost_do_not_count() {
        let lost = f64::INFINITY;
        let found = Compared::new(&[2.0, lost, lost, 1.0], &[1.0, lost, 1.0, lost]).unwrap();
        assert_eq!(found.ratios, Quantiles { low: 0.0, median: 2.0, high: lost });
        assert_eq!(found.better.share, 1.0 / 3.0);
        assert!(Compared::new(&[lost], &[lost]).is_none());
    }
}
