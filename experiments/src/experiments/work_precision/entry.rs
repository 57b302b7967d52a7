//! Which methods run at which steps, and what a run from every start of a case shows.

use polhode::body::{Body, Clock, Problem};
use polhode::method::{AnyMethod, Claimed, method, without_projections};
use polhode::run::{RunError, Watch};
use polhode::truth::{Care, Ending, Judged, LOST, Truth};
use polhode_files::error::{Error, unexpected};

use super::super::contestants::{SCHEMES, TAKEN_BACK, weighed, weight};
use super::Motions;
use super::cases::{Case, LONG};
use super::contest::{Contestant, Run};
use crate::statistics::Quantiles;
use crate::timing::StepTime;

/// Tolerances of methods that choose their steps.
const TOLERANCES: [f64; 7] = [1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13, 1e-15];

/// Steps are 100 units over 2^k, from this k on.
const COARSEST: i32 = 5;

/// Beyond the horizon `LONG` a run goes only where it costs at most `AFFORDABLE` evaluations in all and its median error up to there
/// is at most `WORTH_WHILE` rad.
const AFFORDABLE: f64 = 1.5e7;
const WORTH_WHILE: f64 = 1e-3;

/// A method is not run at finer steps once so many of them in a row have brought no smaller error: there it is rounding.
const IDLE: usize = 2;

/// How far a scale goes.
#[derive(Clone, Copy)]
pub(in crate::experiments) struct Budget {
    /// Evaluations per unit of time that the finest step takes at most.
    pub(in crate::experiments) evaluations: f64,
    /// Of the tolerances every so many are taken.
    pub(in crate::experiments) tolerances: usize,
}

/// A method at one step or tolerance.
pub(in crate::experiments) struct Entry {
    pub(in crate::experiments) method: Box<dyn AnyMethod>,
    /// In s; `None` where the method chooses it.
    pub(in crate::experiments) step: Option<f64>,
}

/// What the runs of an entry showed.
pub(super) struct Found {
    pub(super) run: Run,
    /// Largest relative error of the energy or of Jacobi's constant at the looks, of the start in the middle.
    pub(super) energy: Option<f64>,
    /// Starts from which the attitude is held to the last horizon that was tried, of how many.
    pub(super) held: (u64, u64),
    /// What became of the first run that did not come to its end; `not predicted` of one from whose start nothing is known to take
    /// back.
    pub(super) ending: String,
}

/// Every method that takes `body`, each from coarse to fine in parts of `unit` s: the runs end where finer steps
/// [bring nothing](is_settled).
pub(in crate::experiments) fn families(
    body: &Body,
    unit: f64,
    budget: Budget,
) -> Result<Vec<Vec<Entry>>, Error> {
    let mut names: Vec<String> = without_projections().iter().map(|method| method.name()).collect();
    names.extend(SCHEMES.into_iter().chain(TAKEN_BACK).map(String::from));
    // without torque kick-drift is exact-step, whatever its scheme
    names.retain(|name| !(body.problem() == Problem::Free && name.starts_with("kick-drift")));
    let mut families = Vec::new();
    for name in names {
        let of_name = method(&name).map_err(unexpected)?;
        let Some(claims) = of_name.claims(body.problem()) else { continue };
        let mut family = Vec::new();
        if of_name.tolerance().is_some() {
            for tolerance in TOLERANCES.iter().step_by(budget.tolerances) {
                // the tightest ones are not those of every method
                if let Ok(method) = of_name.with_tolerance(*tolerance) {
                    family.push(Entry { method, step: None });
                }
            }
        } else {
            let cost = weighed(claims.cost);
            for k in COARSEST.. {
                let step = 100.0 * libm::exp2(-f64::from(k));
                if cost / step > budget.evaluations && k > COARSEST {
                    break;
                }
                let method = method(&name).map_err(unexpected)?;
                family.push(Entry { method, step: Some(step * unit) });
            }
        }
        let taken =
            |entry: &Entry| entry.method.prepare_f64(Clock::new(entry.step.unwrap_or(1.0)), body).is_ok();
        if family.first().is_some_and(taken) {
            families.push(family);
        }
    }
    Ok(families)
}

/// The runs of one family.
pub(in crate::experiments) fn contestant(family: &[Entry], runs: Vec<Run>) -> Option<Contestant> {
    // one name for all tolerances
    let method = &family.first()?.method;
    let name = method.name();
    let base = name.split(':').next().unwrap_or(&name).to_owned();
    let name = if method.tolerance().is_some() { base } else { name };
    Some(Contestant { name, runs })
}

/// Whether the last `IDLE` of the runs of a family, from coarse to fine, have brought no smaller median error to any of the first
/// `horizons`.
pub(in crate::experiments) fn is_settled(horizons: usize, runs: &[&Run]) -> bool {
    let Some(before) = runs.len().checked_sub(IDLE).filter(|before| *before > 0) else { return false };
    let least = |runs: &[&Run], horizon: usize| {
        let medians = runs.iter().filter_map(|run| run.errors(horizon)).map(|errors| errors.median);
        medians.fold(f64::INFINITY, f64::min)
    };
    (0..horizons).all(|horizon| {
        let known = least(&runs[..before], horizon);
        known.is_finite() && least(&runs[before..], horizon) >= known
    })
}

impl Entry {
    /// `known_time` is that of a step at another step of the same method.
    pub(super) fn measure(
        &self,
        case: &Case,
        motions: &Motions,
        known_time: &mut Option<StepTime>,
    ) -> Result<Found, Error> {
        let (problem, unit, horizons) = (case.body.problem(), case.unit, case.horizons);
        // one that chooses its steps is read at the looks of the first horizon
        let step = self.step.unwrap_or(horizons[0] * unit / 32.0);
        let run = |motion: &Truth, horizon: f64| {
            let mut care = Care::default();
            (care.watch, care.until_lost) = (Watch::AtSamples, true);
            care.until = horizon * unit * (1.0 + 1e-9);
            match motion.judge(self.method.as_ref(), step, care) {
                Ok(judged) => Ok(Some(judged)),
                Err(RunError::Phase(_)) => Ok(None),
                Err(error) => Err(unexpected(error)),
            }
        };
        let common = horizons.iter().copied().filter(|horizon| *horizon <= LONG).fold(0.0, f64::max);
        let mut all = motions.all.iter().map(|motion| run(motion, common)).collect::<Result<Vec<_>, _>>()?;
        let evaluations: Vec<f64> = all
            .iter()
            .map(|measured| measured.as_ref().map_or(f64::INFINITY, |one| self.per_unit(problem, unit, one)))
            .collect();
        let mut errors: Vec<Vec<Option<f64>>> =
            horizons.iter().map(|horizon| errors_of(&all, horizon * unit, common * unit)).collect();
        let end = horizons.last().copied().unwrap_or(common);
        let before = horizons.iter().rposition(|horizon| *horizon <= LONG).unwrap_or(0);
        let middle = |values: Vec<f64>| Quantiles::of(values).map_or(f64::INFINITY, |found| found.median);
        let error = middle(errors[before].iter().copied().flatten().collect());
        if end > LONG && error <= WORTH_WHILE && middle(evaluations.clone()) * end <= AFFORDABLE {
            all = motions.far().iter().map(|motion| run(motion, end)).collect::<Result<Vec<_>, _>>()?;
            let last = horizons.len() - 1;
            errors[last] = errors_of(&all, end * unit, end * unit);
            errors[last].resize(motions.all.len(), None);
        }
        let claims = self.method.claims(problem);
        let varies = self.step.is_none() || claims.is_some_and(|claims| claims.cost.solves > 0);
        let time = match (*known_time, motions.all.first()) {
            (Some(time), _) if !varies => time,
            (_, Some(motion)) => StepTime::of(self.method.as_ref(), motion, step)?,
            (_, None) => return Err(unexpected("a case has no starts")),
        };
        *known_time = Some(time);
        let of_first = time.seconds / time.rk4 / (step / unit);
        // one that chooses its steps takes as much time as it takes evaluations
        let time = evaluations.iter().map(|count| match self.step {
            Some(_) => of_first,
            None => of_first * count / evaluations[0],
        });
        let energies = all.iter().flatten().filter_map(|one| one.last.worst.energy.or(one.last.worst.jacobi));
        let endings = || all.iter().map(|measured| measured.as_ref().map(|measured| measured.ending));
        let ending = endings().find(|ending| *ending != Some(Ending::Held)).unwrap_or(Some(Ending::Held));
        let held = endings().filter(|ending| *ending == Some(Ending::Held)).count();
        Ok(Found {
            run: Run { time: time.collect(), evaluations, errors },
            energy: Quantiles::of(energies.collect()).map(|energy| energy.median),
            held: (held as u64, all.len() as u64),
            ending: ending.map_or("not predicted".into(), |ending| ending.to_string()),
        })
    }

    /// Evaluations per `unit` s on a body with that problem.
    pub(in crate::experiments) fn per_unit(&self, problem: Problem, unit: f64, measured: &Judged) -> f64 {
        let cost = self.method.claims(problem).map(|claims| claims.cost).unwrap_or_default();
        let last = measured.looks.last().map(|look| look.evaluations as f64 / (look.elapsed / unit));
        last.map(|found| found * weight(cost)).filter(|cost| *cost > 0.0).unwrap_or(f64::INFINITY)
    }
}

/// The largest attitude error of each run up to `horizon` s; `None` where the runs end before.
pub(in crate::experiments) fn errors_of(runs: &[Option<Judged>], horizon: f64, end: f64) -> Vec<Option<f64>> {
    let error = |measured: &Option<Judged>| {
        let seen = measured.as_ref().and_then(|measured| measured.largest_attitude_error(horizon));
        let seen = seen.filter(|error| *error <= LOST);
        (horizon <= end).then(|| seen.unwrap_or(f64::INFINITY))
    };
    runs.iter().map(error).collect()
}
