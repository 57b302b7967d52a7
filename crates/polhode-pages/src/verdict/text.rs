//! Verdicts in words, for a terminal.

use crate::table::{Column, Table, row, to_digits};
use polhode::audit::{Signature, Verdict};

use super::advice;
use super::outcome::{Outcome, named, sentence};

const WIDTH: usize = 78;

/// Every body of the file, the answer first.
#[must_use]
pub fn text(name: &str, outcomes: &[Outcome]) -> String {
    outcomes.iter().map(|outcome| one(name, outcome)).collect::<Vec<_>>().join("\n")
}

fn one(name: &str, outcome: &Outcome) -> String {
    let verdict = &outcome.verdict;
    let mut lines = Vec::new();
    let of = outcome.body.as_ref().map_or(String::new(), |body| format!(", body {body}"));
    let suspect =
        if outcome.is_suspected() { format!("; suspect: {}", outcome.suspect()) } else { String::new() };
    push(&mut lines, &format!("{name}{of}: {}{suspect}", outcome.judgement()), "");
    push(&mut lines, &format!("Reading: {}.", outcome.reading()), "  ");
    if let Some(tie) = &verdict.tie {
        push(&mut lines, &format!("{} readings fit equally well: {}.", tie.readings.len(), tie.reason), "  ");
        for reading in &tie.readings {
            push(&mut lines, &format!("- {}", reading), "    ");
        }
    }
    lines.push(String::new());
    lines.extend(conservation(verdict).terminal().lines().map(String::from));
    lines.push(String::new());
    for line in attitude(outcome) {
        push(&mut lines, &line, "  ");
    }
    for line in causes(outcome) {
        push(&mut lines, &line, "  ");
    }
    let tie = usize::from(verdict.tie.is_some());
    let warnings = outcome.warnings();
    for warning in &warnings[..warnings.len() - tie] {
        push(&mut lines, &sentence(warning), "  ");
    }
    lines.join("\n") + "\n"
}

/// What the motion keeps, and how well the record does.
pub(super) fn conservation(verdict: &Verdict) -> Table {
    let mut table = Table::new(
        "conservation",
        "What the motion conserves.",
        vec![
            Column::new("quantity", "", "conserved by the motion"),
            Column::new("error", "", "largest relative change from the first row").digits(2),
            Column::new("slope", "1/s", "of the relative change").digits(2),
            Column::new("half_width", "1/s", "of the 95 % interval of the slope").heading("+-").digits(2),
            Column::new("resolution", "", "what noise and digits explain of the error").digits(2),
            Column::new("conserved", "", "within the tolerance or the resolution"),
        ],
    );
    for line in &verdict.conservation {
        table.push(row![
            named(&line.quantity).1,
            line.error,
            line.drift.map(|drift| drift.slope),
            line.drift.map(|drift| drift.half_width),
            line.resolution,
            if line.conserved { "yes" } else { "no" },
        ]);
    }
    table
}

/// Attitude error and flips, a sentence each.
pub(super) fn attitude(outcome: &Outcome) -> Vec<String> {
    let verdict = &outcome.verdict;
    let mut lines = Vec::new();
    if let Some(error) = verdict.attitude_error {
        let start = if error.fitted_start { "fits all rows best" } else { "starts at the first row" };
        lines.push(format!(
            "Largest attitude error: {} rad, at t = {} s, from the exact motion that {start}. At the end it is {} rad along the motion (phase) and {} rad across it (drift).",
            size(error.largest), to_digits(error.at, 6), size(error.phase), size(error.drift)
        ));
    }
    if let Some(noise) = verdict.noise {
        let given = [noise.attitude, noise.rates].map(|sigma| format!("{sigma:.1e}"));
        lines.push(format!(
            "Undecided: it agrees with the motion within noise of {} rad and {} rad/s (standard deviations of a component). If the record has that noise, declare it: --noise {}.",
            given[0], given[1], given.join(",")
        ));
    }
    if let Some(difference) = &outcome.against {
        lines.push(format!(
            "Against {}: largest difference {} rad at t = {} s, among {} rows at the same times; {} rad are allowed.",
            difference.name,
            size(difference.largest),
            to_digits(difference.at, 6),
            difference.rows,
            size(difference.tolerance)
        ));
    }
    if let (Some(flips), Some(exact)) = (verdict.flips, verdict.flips_exact) {
        lines.push(format!("Flips: {flips}; the exact motion has {exact}."));
    }
    lines
}

/// A size with two digits.
fn size(x: f64) -> String {
    if x == 0.0 { "0".into() } else { to_digits(x, 2) }
}

/// What makes the record wrong, and what to do about it, a sentence each.
pub(super) fn causes(outcome: &Outcome) -> Vec<String> {
    let verdict = &outcome.verdict;
    let mut lines = verdict.signature.as_ref().map_or(Vec::new(), integrator);
    lines.extend(verdict.other_body.as_ref().map(ToString::to_string));
    lines.extend(verdict.other_torque.as_ref().map(ToString::to_string));
    lines.extend(verdict.other_wheel.as_ref().map(ToString::to_string));
    lines.extend(outcome.advice.as_ref().map(advice::sentence));
    lines
}

/// The integrator with what it predicts beside what was measured.
fn integrator(found: &Signature) -> Vec<String> {
    let order = found.order.map_or(String::new(), |order| format!(" (order {order})"));
    let mut lines = vec![format!(
        "The errors are like those of {}{order} with h = {} s, {} a row. Run from the first row, that method has an error of {} rad at t = {} s; the record has {} rad.",
        found.method,
        to_digits(found.step, 6),
        if found.steps_per_row == 1 { "one step".into() } else { format!("{} steps", found.steps_per_row) },
        size(found.predicted_attitude_error),
        to_digits(found.at, 6),
        size(found.measured_attitude_error)
    )];
    if let (Some(predicted), Some(measured)) = (found.predicted_energy_change, found.measured_energy_change) {
        lines.push(format!(
            "Relative change of the energy up to then: {} with that method, {} in the record.",
            size(predicted),
            size(measured)
        ));
    }
    lines
}

/// One row for each body, for programs.
#[must_use]
pub fn rows(outcomes: &[Outcome]) -> Table {
    let of_reading = |name, meaning| Column::new(name, "", meaning);
    let mut table = Table::new(
        "verdicts",
        "Verdicts.",
        vec![
            Column::new("id", "", "name of the body, where the file has several"),
            Column::new("rows", "", "rows of the record"),
            Column::new("verdict", "", "right, wrong or undecided"),
            Column::new("suspect", "", "what is wrong"),
            of_reading("quaternion", "place of the scalar"),
            of_reading("attitude", "direction of the attitude"),
            of_reading("euler", "sequence of Euler angles"),
            of_reading("omega_frame", "axes of the angular velocity"),
            of_reading("rate_unit", "unit of the angular velocity"),
            of_reading("momentum_frame", "axes of the angular momentum"),
            of_reading("ties", "readings that fit alike"),
            Column::new("energy_error", "", "largest relative change of the energy"),
            Column::new("momentum_error", "", "largest relative change of |m|"),
            Column::new("momentum_vector_error", "", "largest relative change of L in space"),
            Column::new(
                "attitude_error",
                "rad",
                "largest angle from the exact motion, or from the golden trajectory",
            ),
            Column::new("flips", "", "changes of sign along the middle axis"),
            Column::new("flips_exact", "", "the same of the exact motion"),
        ],
    );
    for outcome in outcomes {
        let verdict = &outcome.verdict;
        let reading = &verdict.reading;
        table.push(row![
            outcome.body.clone(),
            outcome.rows as u64,
            outcome.judgement(),
            outcome.suspect(),
            reading.quaternion.map(|order| order.to_string()),
            reading.attitude.map(|direction| direction.to_string()),
            reading.angles.map(|angles| angles.sequence.to_string()),
            reading.omega_frame.map(|frame| frame.to_string()),
            reading.rate_unit.map(|unit| unit.to_string()),
            reading.momentum_frame.map(|frame| frame.to_string()),
            verdict.tie.as_ref().map_or(0, |tie| tie.readings.len()) as u64,
            outcome.error(|quantity| *quantity == polhode::body::Conserved::Energy),
            outcome.error(|quantity| *quantity == polhode::body::Conserved::MomentumNorm),
            outcome.error(|quantity| *quantity == polhode::body::Conserved::Momentum),
            outcome.attitude_error(),
            verdict.flips,
            verdict.flips_exact,
        ]);
    }
    table
}

/// Adds `text`, wrapped; `indent` stands before every line but a first one without it.
fn push(lines: &mut Vec<String>, text: &str, indent: &str) {
    let mut line = indent.to_string();
    for word in text.split_whitespace() {
        let blank = usize::from(line.len() > indent.len());
        if blank == 1 && line.chars().count() + 1 + word.chars().count() > WIDTH {
            lines.push(std::mem::replace(&mut line, format!("{indent}  ")));
        } else if blank == 1 && !line.ends_with(' ') {
            line.push(' ');
        }
        line += word;
    }
    lines.push(line);
}
