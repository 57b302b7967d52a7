//! Rows for readers and for programs.

use polhode_pages::table::{Cell, Column, Table, row};

use super::super::contestants::knows_the_motion;
use super::Motions;
use super::cases::{Case, Kind, LONG};
use super::contest::{CLOSED_FORM, Contestant, Currency, ranked};
use super::entry::{Entry, Found};
use crate::statistics::{Quantiles, rounded};

/// Accuracies that winners are named for, rad.
const ACCURACIES: [f64; 6] = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12];

/// Horizons of the columns, units.
const COLUMNS: [f64; 5] = [1e2, 1e3, 1e4, 1e5, 1e6];

/// Methods that know nothing of rotation: their costs are always given.
pub(in crate::experiments) const GENERAL: [&str; 9] =
    ["explicit-euler", "rk4", "rk4-normalized", "rk8", "tsit5", "dop853", "taylor", "gauss:4", "gauss:8"];

/// Of the others, the costs up to so many times the least.
const CLOSE: f64 = 4.0;

/// A case with its references and all runs.
pub(super) struct Contest<'a> {
    pub(super) case: &'a Case,
    pub(super) motions: &'a Motions,
    pub(super) contestants: Vec<Contestant>,
}

impl Contest<'_> {
    /// Starts that are judged up to a horizon: all whose motion is known so far, if they are at least half of them.
    pub(super) fn starts(&self, horizon: usize) -> Vec<usize> {
        let end = self.case.horizons[horizon];
        let motions = if end > LONG { self.motions.far() } else { &self.motions.all };
        let asked = motions.len();
        let known = |k: &usize| motions[*k].known_until() >= end * self.case.unit * (1.0 - 1e-9);
        let found: Vec<usize> = (0..asked).filter(known).collect();
        if 2 * found.len() >= asked { found } else { Vec::new() }
    }

    /// Horizons to which the motion is known, with the starts that are judged there.
    fn judged(&self) -> impl Iterator<Item = (usize, f64, Vec<usize>)> {
        let horizons = self.case.horizons.iter().enumerate();
        horizons.map(|(k, horizon)| (k, *horizon, self.starts(k))).filter(|(_, _, starts)| !starts.is_empty())
    }
}

pub(super) fn errors() -> Table {
    let caption = "Largest attitude error by method and step, up to 10^2 to 10^6 units of time: median over the \
                   starts; a unit is about the time of one radian, a power of two in s. The steps of a method end where two \
                   halvings in a row bring no smaller error.";
    let quantile = |name, meaning| Column::new(name, "rad", meaning).hidden();
    let median = |name, meaning| Column::new(name, "rad", meaning).digits(2);
    let columns = vec![
        Column::new("case", "", "body and starts"),
        Column::new("method", "", "name in the catalogue, with scheme or tolerance"),
        Column::new("h", "s", "step").hidden(),
        Column::new("h_units", "", "step in units").heading("h/u").digits(3),
        Column::new(
            "evaluations",
            "",
            "evaluations of all kinds per unit of time, an implicit solution as six; median",
        )
        .heading("evals/u")
        .digits(3),
        quantile("error_1e2_p10", "10 % of the largest attitude errors up to 10^2 units"),
        median("error_1e2", "their median, empty where half of the starts are lost"),
        quantile("error_1e2_p90", "their 90 %"),
        quantile("error_1e3_p10", "10 % up to 10^3 units"),
        median("error_1e3", "median up to 10^3 units"),
        quantile("error_1e3_p90", "90 % up to 10^3 units"),
        quantile("error_1e4_p10", "10 % up to 10^4 units"),
        median("error_1e4", "median up to 10^4 units"),
        quantile("error_1e4_p90", "90 % up to 10^4 units"),
        quantile("error_1e5_p10", "10 % up to 10^5 units, of the first five starts"),
        median("error_1e5", "median up to 10^5 units"),
        quantile("error_1e5_p90", "90 % up to 10^5 units"),
        quantile("error_1e6_p10", "10 % up to 10^6 units, of the first five starts"),
        median("error_1e6", "median up to 10^6 units"),
        quantile("error_1e6_p90", "90 % up to 10^6 units"),
        Column::new(
            "energy_error",
            "",
            "largest relative error of the energy, or of Jacobi's constant, at the looks; median",
        )
        .heading("energy")
        .digits(2),
        Column::new("starts", "", "starts of the longest runs").hidden(),
        Column::new("held", "", "of these, those whose attitude is held to the end"),
        Column::new("status", "", "ok, or what became of the first start that is not held"),
    ];
    Table::new("errors", caption, columns)
}

/// The row of an entry, whose start times are 0.
pub(super) fn error_row(case: &Case, entry: &Entry, found: &Found) -> Vec<Cell> {
    let unit = case.unit;
    let evaluations = Quantiles::of(found.run.evaluations.clone()).map(|cost| cost.median);
    let mut cells = row![
        case.name.as_str(),
        entry.method.name(),
        entry.step,
        entry.step.map(|step| step / unit),
        evaluations,
    ]
    .to_vec();
    for column in COLUMNS {
        let place = case.horizons.iter().position(|horizon| *horizon == column);
        let errors = place.and_then(|place| found.run.errors(place));
        cells.extend([
            errors.map(|errors| errors.low).into(),
            errors.map(|errors| errors.median).into(),
            errors.map(|errors| errors.high).into(),
        ]);
    }
    cells.extend(row![found.energy, found.held.1, found.held.0, found.ending.as_str()]);
    cells
}

/// Who reaches an accuracy at the least cost, by case and horizon.
pub(super) fn winners(name: &str, contests: &[Contest], currency: Currency) -> Table {
    let (caption, [cost, low, high, next]) = match currency {
        Currency::Evaluations => (
            "Who reaches an accuracy from half of the starts with the fewest evaluations (right sides, turns, elliptic additions, \
             free flows and kicks; an implicit solution counts as six); exact-step, which is exact for free bodies at any step, \
             and methods with +phase, which use it at output, stand apart.",
            ["evaluations", "evaluations_p10", "evaluations_p90", "evaluations_next"],
        ),
        Currency::Time => (
            "Who reaches an accuracy from half of the starts in the least processor time, in steps of rk4 per unit of time, timed \
             in the same moments; exact-step, which is exact for free bodies at any step, and methods with +phase, which use it at \
             output, stand apart.",
            ["rk4_steps", "rk4_steps_p10", "rk4_steps_p90", "rk4_steps_next"],
        ),
    };
    let columns = vec![
        Column::new("case", "", "body and starts"),
        Column::new("turned", "", "units of time, about as many rad").digits(2),
        Column::new("accuracy", "rad", "largest attitude error up to then").digits(2),
        Column::new("winner", "", "the cheapest method of those that do not stand apart"),
        Column::new(
            cost,
            "",
            "its cost per unit of time, between two steps as a power law: median over the starts",
        )
        .heading("cost/u")
        .digits(3),
        Column::new(low, "", "the same: 10 % of the starts").heading("10 %").digits(3),
        Column::new(high, "", "the same: 90 %; empty where these do not reach it").heading("90 %").digits(3),
        Column::new("next", "", "the next one").hidden(),
        Column::new(next, "", "its cost").hidden(),
        Column::new("rk4_ratio", "", "the cost of rk4 over that of the winner").heading("rk4").digits(2),
        Column::new("exact_step", "", "the cost of exact-step").hidden(),
        Column::new("starts", "", "starts that are judged").hidden(),
    ];
    let mut table = Table::new(name, caption, columns);
    for contest in contests {
        for (k, horizon, starts) in contest.judged() {
            for accuracy in accuracies(contest.case, horizon) {
                let all = ranked(&contest.contestants, accuracy, k, currency, &starts);
                let of = |name: &str| all.iter().find(|found| found.0 == name).map(|found| found.1.median);
                let mut others = all.iter().filter(|found| !knows_the_motion(found.0));
                let Some(&(winner, cost)) = others.next() else { continue };
                let next = others.next();
                table.push(row![
                    contest.case.name.as_str(),
                    horizon,
                    accuracy,
                    winner,
                    cost.median,
                    cost.low,
                    cost.high,
                    next.map(|next| next.0),
                    next.map(|next| next.1.median),
                    of("rk4").map(|rk4| rk4 / cost.median),
                    of(CLOSED_FORM),
                    starts.len() as u64,
                ]);
            }
        }
    }
    table
}

/// Processor times of all that are close to the winner, and of the general-purpose methods.
pub(super) fn costs(contests: &[Contest]) -> Table {
    let caption = "Processor time at which the attitude is held, in steps of rk4 per unit of time.";
    let cost = |name, meaning| Column::new(name, "", meaning);
    let columns = vec![
        Column::new("kind", "", "what is asked of a method"),
        Column::new("case", "", "body and starts"),
        Column::new("turned", "", "units of time, about as many rad"),
        Column::new("accuracy", "rad", "largest attitude error up to then"),
        Column::new("method", "", "name in the catalogue"),
        Column::new("general", "", "whether the method knows nothing of rotation"),
        cost("rk4_steps", "processor time per unit of time in steps of rk4: median over the starts"),
        cost("rk4_steps_p10", "the same: 10 %"),
        cost("rk4_steps_p90", "the same: 90 %; empty where these do not reach the accuracy"),
    ];
    let mut table = Table::new("costs", caption, columns);
    for contest in contests {
        for (k, horizon, starts) in contest.judged() {
            for accuracy in accuracies(contest.case, horizon) {
                let all = ranked(&contest.contestants, accuracy, k, Currency::Time, &starts);
                let rivals = all.iter().filter(|found| !knows_the_motion(found.0));
                let Some(least) = rivals.map(|found| found.1.median).next() else { continue };
                for (method, cost) in all {
                    let general = GENERAL.contains(&method);
                    if general || cost.median <= CLOSE * least {
                        table.push(row![
                            contest.case.kind.name(),
                            contest.case.name.as_str(),
                            horizon,
                            accuracy,
                            method,
                            if general { "yes" } else { "no" },
                            rounded(cost.median),
                            rounded(cost.low),
                            rounded(cost.high),
                        ]);
                    }
                }
            }
        }
    }
    table
}

/// Accuracies that are judged up to a horizon.
fn accuracies(case: &Case, horizon: f64) -> impl Iterator<Item = f64> {
    let finest = case.finest(horizon);
    ACCURACIES.into_iter().filter(move |accuracy| *accuracy >= finest * (1.0 - 1e-9))
}

/// Whether panels of a kind stand on the sheet of free bodies.
pub(super) fn is_free(kind: Kind) -> bool {
    matches!(kind, Kind::Free | Kind::Separatrix)
}
