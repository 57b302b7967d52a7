//! The ranking of methods over many random bodies with a start each: from which share of them a method is the quickest, and how far
//! behind the quickest it is.
//!
//! A share of starts needs many of them, long spans do not: bodies turn by at most a thousand units of time here, a unit being
//! about the time of one radian, a hundred where there is no closed form; `work-precision` has a few starts over far longer times. The time of a step is measured
//! once for each method, on a few of the bodies: it is the same from every start where a step does the same work, and in the ratio of
//! the evaluations where a method chooses its steps. Implicit methods are timed at every step.

mod members;
mod ranks;
mod runs;

use polhode_files::error::{Error, unexpected};

use self::members::SEED;
use self::ranks::{Field, ranking};
use super::contestants::knows_the_motion;
use super::work_precision::contest::{CLOSED_FORM, Contestant, Currency};
use super::work_precision::entry::{Budget, contestant, families};
use crate::experiment::{Context, Report};

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let budget = Budget {
        evaluations: context.scale.pick(10.0, 60.0, 320.0),
        tolerances: context.scale.pick(3, 2, 1),
    };
    let ensembles = members::all(context)?;
    let mut parts = Vec::new();
    for ensemble in &ensembles {
        let body = ensemble.truths.first().ok_or_else(|| unexpected("a kind has no starts"))?.body();
        for family in families(body, 1.0, budget)? {
            let name = family.first().map(|entry| entry.method.name());
            // those that take the exact motion back stand in work-precision
            if name.is_some_and(|name| name == CLOSED_FORM || !knows_the_motion(&name)) {
                parts.push((ensemble, family));
            }
        }
    }
    let found: Vec<Result<_, Error>> = context.in_parallel(parts, |(ensemble, family)| {
        let runs = runs::all(&family, ensemble)?;
        Ok((ensemble.kind, contestant(&family, runs)))
    });
    let mut contestants: Vec<Vec<Contestant>> = ensembles.iter().map(|_| Vec::new()).collect();
    for part in found {
        let (kind, contestant) = part?;
        let place = ensembles.iter().position(|ensemble| ensemble.kind == kind).unwrap_or(0);
        contestants[place].extend(contestant);
    }
    let fields: Vec<Field> = ensembles
        .iter()
        .zip(&contestants)
        .map(|(ensemble, contestants)| Field { ensemble, contestants })
        .collect();
    let by_evaluations = ranking(&fields, Currency::Evaluations)?;
    let by_time = ranking(&fields, Currency::Time)?;
    let caption = "The methods that take the fewest evaluations, by problem and accuracy.";
    let shown = by_evaluations.ranks.view("shown", caption, &[], ("shown", "yes"));
    Ok(Report {
        conclusion: by_evaluations.conclusion,
        views: vec![shown, by_evaluations.lie_groups.clone()],
        tables: vec![by_evaluations.ranks, by_evaluations.lie_groups],
        timing: Some(by_time.ranks),
        times: vec![by_time.lie_groups],
        seed: Some(SEED),
        ..Report::default()
    })
}
