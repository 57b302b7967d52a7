//! Attitude errors of all methods of order four beside that of rk4, over random free bodies: at the same step, and at the same
//! cost; from any start, and from starts next to the separatrix.

use polhode::body::Problem;
use polhode::method::{AnyMethod, method, without_projections};
use polhode::num::Random;
use polhode::run::Watch;
use polhode::truth::{AGREEMENT, Care, Ending, LOST, Truth, evenly};
use polhode_files::error::{Error, unexpected};
use polhode_pages::table::{Column, Table, row};

use super::compared::Compared;
use super::contestants::{SCHEMES, knows_the_motion, weighed};
use super::phase::drawn;
use super::separatrix;
use crate::experiment::{Context, Report};
use crate::statistics::largest;

const SEED: u64 = 1901;

/// Step of all at the same step, and of rk4 at the same cost, s: bodies turn at 1 rad/s.
const STEP: f64 = 1.0 / 32.0;

/// Times at which the attitude is looked at, equally far apart.
const LOOKS: u32 = 64;

/// Distances k'² from the separatrix, powers of ten, at which starts are drawn beside those in any direction.
const NEAR: [i32; 3] = [-2, -4, -8];

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
    let caption = format!(
        "Largest attitude error over that of rk4, methods of order four, {bodies} random bodies that turn by {span} rad, from any start and at three \
         distances from the separatrix: at the step of 1/{} rad, and at as many evaluations (an implicit solution counts as six); below 1 a method is \
         more accurate than rk4.",
        1.0 / STEP
    );
    let mut table = Table::new("methods", caption, columns());
    let mut conclusion = String::new();
    for distance in std::iter::once(None).chain(NEAR.map(Some)) {
        let truths = context.in_parallel((0..bodies).collect(), |member| truth(distance, member, span));
        let truths = truths.into_iter().collect::<Result<Vec<_>, Error>>()?;
        let found = context.in_parallel(of_order_four()?, |method| examine(method.as_ref(), &truths));
        let mut found = found.into_iter().collect::<Result<Vec<_>, Error>>()?;
        let of_rk4 = found.iter().position(|errors| errors.name == YARDSTICK);
        let yardstick =
            of_rk4.map(|k| found.remove(k)).ok_or_else(|| unexpected("rk4 is not of order four"))?;
        let beside = found.iter().map(|errors| Beside::new(errors, &yardstick)).collect::<Option<Vec<_>>>();
        let mut beside = beside.ok_or_else(|| unexpected("no start from which an attitude is held"))?;
        beside.sort_by(|a, b| a.at_cost.ratios.median.total_cmp(&b.at_cost.ratios.median));
        for Beside { name, cost, at_step, at_cost } in &beside {
            let cells = [at_step, at_cost].into_iter().flat_map(Compared::cells);
            let complement = distance.map(separatrix::ten);
            table.push(row![start_name(distance), complement, *name, *cost].into_iter().chain(cells));
        }
        if distance.is_none() {
            let beaten = beside.iter().filter(|one| one.at_cost.ratios.median > 1.0).map(|one| one.name);
            let beaten: Vec<&str> = beaten.collect();
            conclusion = format!(
                "Of {} other methods of order four, at as many evaluations, {} lose more of the attitude than rk4 in the median over {bodies} random bodies: {}",
                beside.len(),
                beaten.len(),
                beaten.join(", ")
            );
        }
    }
    let any = start_name(None);
    let caption = "Largest attitude error over that of rk4, methods of order four, random bodies, any start.";
    let view = table.view("any-start", caption, &["start", "complement"], ("start", any));
    Ok(Report { conclusion, tables: vec![table], views: vec![view], seed: Some(SEED), ..Report::default() })
}

/// As the table calls starts at a distance from the separatrix, or anywhere.
fn start_name(distance: Option<i32>) -> &'static str {
    if distance.is_some() { "near" } else { "any" }
}

/// The true motion of a random body over `span` s.
fn truth(distance: Option<i32>, member: u64, span: f64) -> Result<Truth, Error> {
    let random = Random::new(SEED);
    let (body, start) = drawn(random.stream(member))?;
    let times = evenly(span, LOOKS);
    let Some(decade) = distance else {
        return Truth::new(&body, &start, &times).map_err(unexpected);
    };
    let (point, _) = separatrix::near(&body, decade, member, 1.0, random.stream((1 << 32) | member))?;
    Truth::from_point(&body, point, 0.0, &times, AGREEMENT).map_err(unexpected)
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

impl<'a> Beside<'a> {
    /// `None` where there is no start from which one of the two holds the attitude.
    fn new(errors: &'a Errors, yardstick: &Errors) -> Option<Self> {
        Some(Beside {
            name: &errors.name,
            cost: errors.cost,
            at_step: Compared::new(&errors.at_step, &yardstick.at_step, SEED)?,
            at_cost: Compared::new(&errors.at_cost, &yardstick.at_cost, SEED)?,
        })
    }
}

fn columns() -> Vec<Column> {
    let share = |name, meaning| Column::new(name, "", meaning).hidden();
    let interval = |name: &'static str, meaning| {
        Column::new(name, "", meaning).heading(if name.ends_with("low") { "from" } else { "to" }).digits(2)
    };
    vec![
        Column::new("start", "", "any: in all directions; near: next to the separatrix"),
        Column::new("complement", "", "k'2 of starts next to the separatrix: their distance to it")
            .heading("k'²")
            .latex("$k'^2$"),
        Column::new("method", "", "name in the catalogue, with its scheme"),
        Column::new("cost", "", "evaluations of a step over those of rk4").digits(2),
        Column::new("step_p10", "", "at the same step: 10 % of the ratios").hidden(),
        Column::new("step", "", "at the same step: median; empty where most are lost")
            .heading("same step")
            .digits(2),
        interval(
            "step_low",
            "95 % interval of this median, by ensembles drawn from the starts: its lower end",
        ),
        interval("step_high", "its upper end"),
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
        interval("cost_low", "95 % interval of this median: its lower end"),
        interval("cost_high", "its upper end"),
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
}
