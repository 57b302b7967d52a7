//! The fit with what real records have: drag, torque noise, wheels, sensors that are off, spikes, mistaken units, mirrored axes.

mod bound;
mod cases;
mod choice;
pub(super) mod tally;
pub(super) mod trial;
mod units;

use polhode_files::error::Error;
use polhode_pages::table::{Column, Table, row};

use crate::experiment::{Context, Report};
use crate::statistics::{Interval, rounded};
use cases::{CASES, Model};
use tally::Tally;
use trial::{Trial, trial};

const SEED: u64 = 160_160;

pub(crate) fn run(context: &Context) -> Result<Report, Error> {
    let trials = context.scale.pick(1, 1, 150);
    let (seconds, rate) = context.scale.pick((12, 50), (20, 100), (60, 100));
    let noises: &[f64] = context.scale.pick(&[1e-2], &[1e-2], &[1e-3, 1e-2]);
    let times: Vec<f64> = (0..=rate * seconds).map(|i| i as f64 / rate as f64).collect();
    let cells: Vec<(usize, f64)> =
        (0..CASES.len()).flat_map(|case| noises.iter().map(move |noise| (case, *noise))).collect();
    let parts = cells.iter().flat_map(|&(case, noise)| (0..trials).map(move |k| (case, noise, k))).collect();
    let results = context.in_parallel(parts, |(case, noise, k): (usize, f64, u64)| {
        // at each noise the same bodies, starts and deviates
        trial(&CASES[case], noise, &times, SEED, ((case as u64) << 32) + k)
    });
    let results = results.into_iter().collect::<Result<Vec<Trial>, Error>>()?;

    let caption = format!(
        "Records of {seconds} s at {rate} Hz with what real ones have, {trials} each, moments 1, 2, 2.6, 1 rad/s."
    );
    let mut table = Table::new("field", caption, columns());
    let mut timing = timing_table();
    let mut failures = Vec::new();
    let mut pooled = Tally::default();
    for (&(case, noise), cell) in cells.iter().zip(results.chunks(trials as usize)) {
        let case = &CASES[case];
        let tally = Tally::new(cell, if case.wheel_known { 6 } else { 5 });
        let coverage = tally.coverage();
        let shown = |x: Option<f64>| x.map(rounded);
        table.push(row![
            case.name,
            case.model.name(),
            noise,
            shown(tally.over_bound()),
            shown(tally.median()),
            shown(coverage.map(|c| c.share)),
            shown(coverage.map(|c| c.low)),
            shown(coverage.map(|c| c.high)),
            tally.refused,
            tally.units,
            tally.warned,
            tally.outside,
            tally.by_lines,
            tally.silent,
            trials,
        ]);
        timing.push(row![case.name, noise, tally.seconds(0.5), tally.seconds(1.0)]);
        failures.extend(tally.demands(case, noise));
        if case.model == Model::AtHand {
            pooled.add(tally);
        }
    }
    let totals = totals(&pooled, &cells, &results, trials as usize);
    let hidden = ["model", "median", "coverage_low", "coverage_high"];
    let by_model = [
        ("at-hand", "Records of which the fit has a model.", Model::AtHand),
        ("missing", "Records with what the fit has no model of.", Model::Missing),
        ("wrong-unit", "Records in other units than they say.", Model::WrongUnit),
    ];
    let mut views: Vec<Table> = by_model
        .into_iter()
        .map(|(name, what, model)| table.view(name, what, &hidden, ("model", model.name())))
        .collect();
    views.push(totals.clone());
    let (units, failed) = units::table(context)?;
    views.push(units.clone());
    failures.extend(failed);
    let (choice, failed) = choice::table(context)?;
    views.push(choice.clone());
    failures.extend(failed);
    Ok(Report {
        tables: vec![table, totals, units, choice],
        views,
        timing: Some(timing),
        seed: Some(SEED),
        failures,
        ..Report::default()
    })
}

fn columns() -> Vec<Column> {
    vec![
        Column::new("case", "", "what is wrong with body or sensor"),
        Column::new("model", "", "whether the fit has a model of it"),
        Column::new("noise", "", "standard deviation of a component over the rate"),
        Column::new("error_over_bound", "", "root of the mean of e C^-1 e / n with C the bound that knows of the unknown torques and sensor errors")
            .heading("error/bound"),
        Column::new("median", "", "median over records of the root of e C^-1 e / n"),
        Column::new("coverage", "", "share of answers whose own 95 % ellipsoid holds the truth"),
        Column::new("coverage_low", "", "lower end of its 95 % interval (Wilson)").heading("from"),
        Column::new("coverage_high", "", "upper end of its 95 % interval (Wilson)").heading("to"),
        Column::new("refused", "", "records refused for another reason than units"),
        Column::new("units", "", "records refused because the units or the sampling look mistaken"),
        Column::new("warned", "", "answers with a warning"),
        Column::new("outside", "", "answers whose own 99.9 % ellipsoid does not hold the truth"),
        Column::new("by_lines", "", "of these, without a warning, those that the report's lines of systematic errors cover at the size that the sensor's error has")
            .heading("by lines"),
        Column::new("silent", "", "of these, those with neither"),
        Column::new("records", "", "records").hidden(),
    ]
}

fn timing_table() -> Table {
    Table::new(
        "timing",
        "Time of a fit.",
        vec![
            Column::new("case", "", "what is wrong with body or sensor"),
            Column::new("noise", "", "standard deviation of a component over the rate"),
            Column::new("median", "s", "median time of a fit"),
            Column::new("longest", "s", "longest time of a fit"),
        ],
    )
}

/// Counts over all rows of a kind, with their intervals.
fn totals(pooled: &Tally, cells: &[(usize, f64)], results: &[Trial], trials: usize) -> Table {
    let columns = vec![
        Column::new("quantity", "", "what is counted"),
        Column::new("count", "", "how many"),
        Column::new("of", "", "of how many"),
        Column::new("share", "", "count over all"),
        Column::new("low", "", "lower end of its 95 % interval (Wilson)").heading("from"),
        Column::new("high", "", "upper end of its 95 % interval (Wilson)").heading("to"),
    ];
    let caption = "Counts over all rows of a kind. Rows of both noises share motions and draws; the intervals take them as independent.";
    let mut table = Table::new("totals", caption, columns);
    let mut push = |quantity: &str, count: u64, of: u64| {
        let interval = Interval::new(count, of);
        let shown = |x: fn(&Interval) -> f64| interval.as_ref().map(x).map(rounded);
        table.push(row![quantity, count, of, shown(|i| i.share), shown(|i| i.low), shown(|i| i.high)]);
    };
    let of = |wanted: &dyn Fn(&cases::Case) -> bool| -> Tally {
        let mut sum = Tally::default();
        for (&(case, _), cell) in cells.iter().zip(results.chunks(trials)) {
            if wanted(&CASES[case]) {
                sum.add(Tally::new(cell, 5));
            }
        }
        sum
    };
    let ideal = of(&|case| case.name == "ideal");
    let right_units = of(&|case| case.model != Model::WrongUnit);
    let wrong_units = of(&|case| case.model == Model::WrongUnit);
    let known = of(&|case| case.model == Model::AtHand);
    push("95 % ellipsoids that hold the truth, model at hand", pooled.covered(), pooled.answered());
    push("refused, model at hand", known.refused + known.units, known.records());
    push("warnings on ideal records", ideal.warned, ideal.answered());
    push("outside the 99.9 % ellipsoid, all records", right_units.outside, right_units.answered());
    push(
        "of these, without a warning and within the systematic lines",
        right_units.by_lines,
        right_units.outside,
    );
    push("silently wrong, all records", right_units.silent, right_units.answered());
    push("right units taken for mistaken", right_units.units, right_units.records());
    let (mistaken, answered) = (wrong_units.records(), wrong_units.answered());
    push("mistaken units caught", wrong_units.units, mistaken);
    push("mistaken units refused for another reason", wrong_units.refused, mistaken);
    push("mistaken units of a record that is said not to tell its units", wrong_units.open, mistaken);
    push("mistaken units answered without a word on them", answered - wrong_units.open, mistaken);
    table
}
