//! The runs of one method on all bodies of a kind, from coarse to fine, and their times.

use polhode::method::Claimed;
use polhode::run::Watch;
use polhode::truth::{Care, Judged, Truth};
use polhode_files::error::{Error, unexpected};

use super::super::work_precision::contest::Run;
use super::super::work_precision::entry::{Entry, errors_of, is_settled};
use super::members::Ensemble;
use crate::statistics::Quantiles;
use crate::timing::StepTime;

/// Bodies on which a step is timed.
const TIMED: usize = 5;

/// The runs of the methods of `family`, as far as finer steps bring anything.
pub(super) fn all(family: &[Entry], ensemble: &Ensemble) -> Result<Vec<Run>, Error> {
    let mut runs = Vec::new();
    for entry in family {
        runs.push(errors(entry, ensemble)?);
        // the next ones would cost more for no more
        if is_settled(ensemble.horizons.len(), &runs.iter().collect::<Vec<_>>()) {
            break;
        }
    }
    let mut known = None;
    // from the finest on: coarse steps may end in numbers that are none, which take another time
    for (entry, run) in family.iter().zip(&mut runs).rev() {
        run.time = times(entry, run, ensemble, &mut known)?;
    }
    Ok(runs)
}

/// Of a method that chooses its steps, the interval of output.
fn step(entry: &Entry, ensemble: &Ensemble) -> f64 {
    entry.step.unwrap_or(ensemble.horizons[0] / 32.0)
}

fn errors(entry: &Entry, ensemble: &Ensemble) -> Result<Run, Error> {
    let end = ensemble.horizons.last().copied().unwrap_or(0.0);
    let mut care = Care::default();
    (care.watch, care.until_lost, care.until) = (Watch::AtSamples, true, end * (1.0 + 1e-9));
    let step = step(entry, ensemble);
    let judge = |truth: &Truth| truth.judge(entry.method.as_ref(), step, care).map(Some).map_err(unexpected);
    let judged = ensemble.truths.iter().map(judge).collect::<Result<Vec<Option<Judged>>, Error>>()?;
    let evaluations = judged.iter().flatten().zip(&ensemble.truths);
    let evaluations = evaluations.map(|(one, truth)| entry.per_unit(truth.body().problem(), 1.0, one));
    Ok(Run {
        evaluations: evaluations.collect(),
        time: Vec::new(),
        errors: ensemble.horizons.iter().map(|horizon| errors_of(&judged, *horizon, end)).collect(),
    })
}

/// Time per unit of time in steps of rk4, by start; `known` is that of a step at another step of the same method.
fn times(entry: &Entry, run: &Run, ensemble: &Ensemble, known: &mut Option<f64>) -> Result<Vec<f64>, Error> {
    let step = step(entry, ensemble);
    let problem = ensemble.truths.first().map(|truth| truth.body().problem());
    let claims = problem.and_then(|problem| entry.method.claims(problem));
    let varies = entry.step.is_none() || claims.is_some_and(|claims| claims.cost.solves > 0);
    let of_step = match *known {
        Some(time) if !varies => time,
        _ => {
            let mut ratios = Vec::new();
            for (truth, evaluations) in ensemble.truths.iter().zip(&run.evaluations).take(TIMED) {
                let time = StepTime::of(entry.method.as_ref(), truth, step)?;
                let steps = time.seconds / time.rk4;
                // one that chooses its steps takes as much time as it takes evaluations
                ratios.push(if entry.step.is_some() { steps } else { steps / (evaluations * step) });
            }
            Quantiles::of(ratios)
                .map(|ratios| ratios.median)
                .ok_or_else(|| unexpected("no start is timed"))?
        }
    };
    *known = Some(of_step);
    let of_start = |evaluations: &f64| match entry.step {
        Some(_) => of_step / step,
        None => of_step * evaluations,
    };
    Ok(run.evaluations.iter().map(of_start).collect())
}
