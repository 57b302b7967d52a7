//! Work against precision: every method on free and forced bodies, at many steps, to several horizons.

mod cases;
mod contest;

use polhode::method::{AnyMethod, catalogue, method};
use polhode::run::Watch;

use self::cases::Case;
use self::contest::{CLOSED_FORM, Contestant, Currency, Run, ranked};
use crate::error::{Error, unexpected};
use crate::experiment::{Context, Report};
use crate::figure::{Figure, Series, sheet};
use crate::measured::{Care, Motion, StepTime, evaluations, is_adaptive};
use crate::table::{Cell, Column, Table, row};

/// Schemes beside the catalogue; those that a force does not admit are left out there.
const SCHEMES: [&str; 19] = [
    "dmv:4",
    "dmv:6",
    "rattle@suzuki-4",
    "lie-poisson@suzuki-4",
    "lie-poisson@kahan-li-6",
    "two-turn@suzuki-4",
    "two-turn@blanes-moan-s6",
    "two-turn@blanes-moan-s10",
    "two-turn@kahan-li-8",
    "two-turn@sofroniou-spaletta-10",
    "kick-drift@srkn-6b",
    "kick-drift@srkn-11b",
    "kick-drift@srkn-14a",
    "kick-drift@bce-22",
    "kick-drift@omelyan-mryglod-folk-4",
    "kick-drift@aba-10-6-4",
    "dmv:6@srkn-11b",
    "dmv:10@srkn-11b",
    "rk4-projected",
];

/// Tolerances of methods that choose their steps.
const TOLERANCES: [&str; 7] = ["1e-3", "1e-5", "1e-7", "1e-9", "1e-11", "1e-13", "1e-15"];

/// Steps are 100 units over 2^k, from this k on.
const COARSEST: i32 = 5;

/// The finest step of a method takes at most so many evaluations per unit of time.
#[derive(Clone, Copy)]
struct Budget {
    /// At any horizon but the last of three.
    evaluations: f64,
    /// To the last of three.
    to_the_end: f64,
    /// Of the tolerances every so many are taken.
    tolerances: usize,
}

/// An implicit solution counts as so many evaluations: the sweeps that it takes where a step turns the body by about 15°.
const SOLUTION: u32 = 6;

/// Accuracies that winners are named for, rad.
const ACCURACIES: [f64; 6] = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12];

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let cases = cases::all(context.scale)?;
    // the longest first, so that no core waits at the end
    let mut motions = context.in_parallel((0..cases.len()).rev().collect(), |k: usize| {
        let Case { body, start, .. } = &cases[k];
        Motion::new(body, start, 0.0, &cases[k].looks())
    });
    motions.reverse();
    let motions: Vec<Motion> = motions.into_iter().collect::<Result<_, _>>()?;
    let budget = Budget {
        evaluations: context.scale.pick(40.0, 160.0, 640.0),
        to_the_end: 80.0,
        tolerances: context.scale.pick(3, 1, 1),
    };
    let mut parts = Vec::new();
    for (k, case) in cases.iter().enumerate() {
        for family in families(case, budget)? {
            parts.push((k, family));
        }
    }
    let found = context.in_parallel(parts, |(k, family)| {
        let mut time = None;
        let rows = family.iter().map(|entry| entry.measure(&cases[k], &motions[k], &mut time));
        rows.collect::<Result<Vec<_>, _>>().map(|rows| (k, family, rows))
    });
    let mut errors = Table::new("errors", errors_caption(), error_columns());
    let mut contests: Vec<Vec<Contestant>> = cases.iter().map(|_| Vec::new()).collect();
    for part in found {
        let (k, family, rows) = part?;
        let (mut runs, mut cells) = (Vec::new(), Vec::new());
        for (run, row) in rows {
            runs.push(run);
            cells.push(row);
        }
        cells.into_iter().for_each(|row| errors.push(row));
        if let Some(entry) = family.first() {
            contests[k].push(Contestant::new(entry.method.as_ref(), runs));
        }
    }
    let fewest = winners("winners", &cases, &motions, &contests, Currency::Evaluations);
    let timing = winners("timing", &cases, &motions, &contests, Currency::Time);
    let mut report = Report::default();
    for (accuracy, name) in [("0.0001", "winners-4"), ("1e-8", "winners-8"), ("1e-12", "winners-12")] {
        let caption = format!("Who holds the attitude to {accuracy} rad with the fewest evaluations.");
        let hidden = ["accuracy", "evaluations_next"];
        report.views.push(fewest.view(name, caption, &hidden, ("accuracy", accuracy)));
    }
    let forced = |case: &Case| case.body.gravity::<f64>().is_some() || !case.body.forces().is_empty();
    let split = cases.iter().position(forced).unwrap_or(cases.len());
    let sheets = [
        (0..split, "Free bodies", ["free-time", "free-evaluations"]),
        (split..cases.len(), "Tops, and a body in orbit", ["forced-time", "forced-evaluations"]),
    ];
    for (range, what, names) in sheets {
        for (currency, name) in [Currency::Time, Currency::Evaluations].into_iter().zip(names) {
            let panel = |k: usize| panel(&cases[k], &motions[k], &contests[k], currency);
            let panels: Vec<Figure> = range.clone().map(panel).collect();
            let title = format!(
                "{what}: largest attitude error up to the end against cost; wide: the least of all but exact-step"
            );
            report.drawings.push(sheet(name, &title, 2, &panels)?);
        }
    }
    report.tables = vec![errors, fewest];
    report.timing = Some(timing);
    Ok(report)
}

/// A method at one step or tolerance.
struct Entry {
    method: Box<dyn AnyMethod>,
    /// In s; `None` where the method chooses it.
    step: Option<f64>,
    /// Up to which time it runs, units.
    end: f64,
}

/// Every method that takes the case, each from coarse to fine.
fn families(case: &Case, budget: Budget) -> Result<Vec<Vec<Entry>>, Error> {
    let mut names: Vec<String> = catalogue().iter().map(|method| method.name()).collect();
    names.extend(SCHEMES.map(String::from));
    // without torque kick-drift is exact-step, whatever its scheme
    let free = case.body.forces().is_empty() && case.body.gravity::<f64>().is_none();
    names.retain(|name| !(free && name.starts_with("kick-drift")));
    let mut families = Vec::new();
    for name in names {
        let of_name = method(&name).map_err(unexpected)?;
        let Some(claims) = of_name.claims(case.body.problem()) else { continue };
        let mut family = Vec::new();
        if is_adaptive(&name) {
            for tolerance in TOLERANCES.iter().step_by(budget.tolerances) {
                // the tightest ones are not those of every method
                if let Ok(method) = method(&format!("{name}:{tolerance}")) {
                    family.push(Entry { method, step: None, end: case.end() });
                }
            }
        } else {
            let of_step = evaluations(of_name.as_ref(), &case.body) as f64;
            let cost = of_step + f64::from((SOLUTION - 1) * claims.cost.solves);
            for k in COARSEST.. {
                let step = 100.0 * libm::exp2(-f64::from(k));
                if cost / step > budget.evaluations && k > COARSEST {
                    break;
                }
                let end = if cost / step > budget.to_the_end { case.end().min(1e4) } else { case.end() };
                let method = method(&name).map_err(unexpected)?;
                family.push(Entry { method, step: Some(step * case.unit), end });
            }
        }
        let taken = |entry: &Entry| {
            let clock = polhode::body::Clock::new(entry.step.unwrap_or(1.0));
            entry.method.prepare_f64(clock, &case.body).is_ok()
        };
        if family.first().is_some_and(taken) {
            families.push(family);
        }
    }
    Ok(families)
}

impl Entry {
    /// `known_time` is that of a step at another step of the same method.
    fn measure(
        &self,
        case: &Case,
        motion: &Motion,
        known_time: &mut Option<StepTime>,
    ) -> Result<(Run, Vec<Cell>), Error> {
        let unit = case.unit;
        // one that chooses its steps is read at the looks of the first horizon
        let step = self.step.unwrap_or(case.horizons[0] * unit / 32.0);
        let until = self.end * unit * (1.0 + 1e-9);
        let care = Care { watch: Watch::AtSamples, until_lost: true, until };
        let measured = motion.measure(self.method.as_ref(), step, care).map_err(unexpected)?;
        let claims = self.method.claims(case.body.problem());
        let varies = self.step.is_none() || claims.is_some_and(|claims| claims.cost.solves > 0);
        let time = match *known_time {
            Some(time) if !varies => time,
            _ => motion.step_time(self.method.as_ref(), step)?,
        };
        let errors: Vec<Option<f64>> =
            case.horizons.iter().map(|horizon| measured.largest_attitude_error(horizon * unit)).collect();
        let of_step = evaluations(self.method.as_ref(), &case.body) as f64;
        let solves = claims.map_or(0, |claims| claims.cost.solves);
        let weighed = 1.0 + f64::from((SOLUTION - 1) * solves) / of_step;
        let last = measured.looks.last().map(|look| look.evaluations as f64 / (look.elapsed / unit));
        let per_unit = last.map(|cost| cost * weighed).filter(|cost| *cost > 0.0);
        let worst = measured.last.worst;
        let mut cells = row![
            case.name.as_str(),
            self.method.name(),
            self.step,
            self.step.map(|step| step / unit),
            per_unit,
        ]
        .to_vec();
        cells.extend((0..4).map(|k| at_horizon(case, k).and_then(|k| errors[k]).into()));
        cells.extend(row![worst.energy.or(worst.jacobi), measured.ending.words(0.0)]);
        *known_time = Some(time);
        let run = Run {
            evaluations: per_unit.unwrap_or(f64::INFINITY),
            time: time.seconds / time.rk4 / (step / unit),
            errors,
        };
        Ok((run, cells))
    }
}

/// Horizons of the columns, units.
const COLUMNS: [f64; 4] = [1e2, 1e3, 1e4, 1e6];

/// Which of the horizons of a case is the k-th column.
fn at_horizon(case: &Case, k: usize) -> Option<usize> {
    case.horizons.iter().position(|horizon| *horizon == COLUMNS[k])
}

fn errors_caption() -> String {
    "Largest attitude error by method and step, up to 10^2, 10^3, 10^4 and 10^6 units of time; a unit is about the time of one \
     radian, a power of two in s."
        .into()
}

fn error_columns() -> Vec<Column> {
    let error = |name, meaning| Column::new(name, "rad", meaning).digits(2);
    vec![
        Column::new("case", "", "body and start"),
        Column::new("method", "", "name in the catalogue, with scheme or tolerance"),
        Column::new("h", "s", "step").hidden(),
        Column::new("h_units", "", "step in units").heading("h/u").digits(3),
        Column::new(
            "evaluations",
            "",
            "evaluations of all kinds per unit of time, an implicit solution as six",
        )
        .heading("evals/u")
        .digits(3),
        error("error_1e2", "largest attitude error up to 10^2 units"),
        error("error_1e3", "the same up to 10^3 units"),
        error("error_1e4", "the same up to 10^4 units"),
        error("error_1e6", "the same up to 10^6 units"),
        Column::new(
            "energy_error",
            "",
            "largest relative error of the energy, or of Jacobi's constant, at the looks",
        )
        .heading("energy")
        .digits(2),
        Column::new("status", "", "ok, or what became of the run"),
    ]
}

fn winners(
    name: &str,
    cases: &[Case],
    motions: &[Motion],
    contests: &[Vec<Contestant>],
    currency: Currency,
) -> Table {
    let (caption, unit_of_cost, meaning) = match currency {
        Currency::Evaluations => (
            "Who reaches an accuracy with the fewest evaluations (right sides, turns, elliptic additions, free flows and kicks; an \
             implicit solution counts as six); exact-step, which is exact for free bodies at any step, stands apart.",
            "evaluations",
            "evaluations per unit of time, between two steps as a power law",
        ),
        Currency::Time => (
            "Who reaches an accuracy in the least processor time, in steps of rk4 per unit of time, timed in the same moments; \
             exact-step, which is exact for free bodies at any step, stands apart.",
            "rk4_steps",
            "processor time per unit of time in steps of rk4, between two steps as a power law",
        ),
    };
    let mut table = Table::new(
        name,
        caption,
        vec![
            Column::new("case", "", "body and start"),
            Column::new("turned", "", "units of time, about as many rad").digits(2),
            Column::new("accuracy", "rad", "largest attitude error up to then").digits(2),
            Column::new("winner", "", "the cheapest method but for exact-step"),
            Column::new(unit_of_cost, "", meaning).heading("cost/u").digits(3),
            Column::new("next", "", "the next one").hidden(),
            Column::new(
                if currency == Currency::Time { "rk4_steps_next" } else { "evaluations_next" },
                "",
                "its cost",
            )
            .hidden(),
            Column::new("rk4_ratio", "", "the cost of rk4 over that of the winner").heading("rk4").digits(2),
            Column::new("exact_step", "", "the cost of exact-step").hidden(),
        ],
    );
    for ((case, motion), contest) in cases.iter().zip(motions).zip(contests) {
        for (k, horizon) in case.horizons.iter().enumerate() {
            if motion.reference().known_until() < horizon * case.unit * (1.0 - 1e-9) {
                continue;
            }
            for accuracy in ACCURACIES {
                let all = ranked(contest, accuracy, k, currency);
                let of = |name: &str| all.iter().find(|found| found.0 == name).map(|found| found.1);
                let mut others = all.iter().filter(|found| found.0 != CLOSED_FORM);
                let Some(&(winner, cost)) = others.next() else { continue };
                let next = others.next();
                table.push(row![
                    case.name.as_str(),
                    *horizon,
                    accuracy,
                    winner,
                    cost,
                    next.map(|next| next.0),
                    next.map(|next| next.1),
                    of("rk4").map(|rk4| rk4 / cost),
                    of(CLOSED_FORM),
                ]);
            }
        }
    }
    table
}

/// The methods that win at some accuracy, and two that everybody knows, at the last horizon to which the motion is known.
fn panel(case: &Case, motion: &Motion, contest: &[Contestant], currency: Currency) -> Figure {
    let known = motion.reference().known_until();
    let reached = case.horizons.iter().filter(|horizon| *horizon * case.unit <= known * (1.0 + 1e-9));
    let last = reached.count().saturating_sub(1);
    let (x, least) = match currency {
        Currency::Time => ("processor time per unit of time (steps of rk4)", "least time"),
        Currency::Evaluations => ("evaluations per unit of time", "fewest evaluations"),
    };
    let title =
        format!("{}: {}; after {:e} units of {} s", case.name, case.what, case.horizons[last], case.unit);
    let mut figure = Figure::log_log("panel", title, x, "largest attitude error (rad)");
    let others: Vec<&Contestant> = contest.iter().filter(|one| one.name != CLOSED_FORM).collect();
    let mut shown: Vec<&str> = vec!["rk4", "dop853"];
    let mut envelope: Vec<(f64, f64)> = Vec::new();
    for k in 0..=26 {
        let accuracy = libm::exp10(-0.5 * f64::from(k));
        let costs = others.iter().filter_map(|&one| {
            let cost = one.cost_of(accuracy, last, currency)?;
            Some((one.name.as_str(), cost))
        });
        let cheapest = costs.min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((name, cost)) = cheapest {
            envelope.push((cost, accuracy));
            // the names of whole accuracies suffice
            if k >= 4 && k % 4 == 0 && !shown.contains(&name) {
                shown.push(name);
            }
        }
    }
    envelope.sort_by(|a, b| a.0.total_cmp(&b.0));
    if envelope.len() > 1 {
        figure.series.push(Series::new(least, envelope).wide());
    }
    for name in shown.into_iter().chain([CLOSED_FORM]) {
        let Some(one) = contest.iter().find(|one| one.name == name) else { continue };
        let points = one.points(last, currency);
        if !points.is_empty() {
            figure.series.push(Series::new(name, points));
        }
    }
    figure.level("1 rad", 1.0);
    figure
}
