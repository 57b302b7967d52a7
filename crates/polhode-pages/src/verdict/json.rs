//! Verdicts as JSON.

use polhode::audit::{Reading, Verdict};
use polhode::body::Conserved;
use serde_json::{Map, Value, json};

use super::advice;
use super::outcome::{Outcome, named};

/// An object for a file of one body, else an array.
#[must_use]
pub fn text(outcomes: &[Outcome]) -> String {
    let value = match outcomes {
        [one] => object(one),
        several => Value::Array(several.iter().map(object).collect()),
    };
    format!("{value:#}\n")
}

fn reading(reading: &Reading) -> Value {
    let mut value = Map::new();
    let mut put = |key: &str, found: Option<String>| {
        if let Some(found) = found {
            value.insert(key.into(), found.into());
        }
    };
    put("quaternion", reading.quaternion.map(|order| order.to_string()));
    put("attitude", reading.attitude.map(|direction| direction.to_string()));
    put("euler", reading.angles.map(|angles| angles.sequence.to_string()));
    put("turns", reading.angles.map(|angles| angles.turns.to_string()));
    put("angle_unit", reading.angles.map(|angles| angles.unit.to_string()));
    put("omega_frame", reading.omega_frame.map(|frame| frame.to_string()));
    put("rate_unit", reading.rate_unit.map(|unit| unit.to_string()));
    put("momentum_frame", reading.momentum_frame.map(|frame| frame.to_string()));
    value.insert("moments".into(), json!(reading.moments.map(|k| k + 1)));
    value.into()
}

fn with_form(mut reading: Value, form: Option<&str>) -> Value {
    reading["form"] = json!(form);
    reading
}

/// The answer for one body.
#[must_use]
pub fn object(outcome: &Outcome) -> Value {
    let verdict = &outcome.verdict;
    let mut value = json!({
        "verdict": outcome.judgement(),
        "suspect": outcome.suspect(),
        "reading": with_form(reading(&verdict.reading), outcome.form),
        "ties": verdict.tie.as_ref().map_or(Vec::new(), |tie| tie.readings.iter().map(reading).collect()),
        "ranking": ranking(verdict),
        "rows": outcome.rows,
        "energy_error": outcome.error(|quantity| *quantity == Conserved::Energy),
        "momentum_error": outcome.error(|quantity| *quantity == Conserved::MomentumNorm),
        "momentum_vector_error": outcome.error(|quantity| *quantity == Conserved::Momentum),
        "attitude_error": outcome.attitude_error(),
        "flips": verdict.flips,
        "flips_exact": verdict.flips_exact,
        "conservation": conservation(verdict),
        "motion": verdict.attitude_error.map(|error| json!({
            "largest": error.largest, "at": error.at, "phase": error.phase, "drift": error.drift,
            "fitted_start": error.fitted_start, "from_first_row": error.from_first_row,
        })),
        "integrator": verdict.signature.as_ref().map(|found| json!({
            "method": found.method, "step": found.step, "steps_per_row": found.steps_per_row, "order": found.order,
            "predicted_attitude_error": found.predicted_attitude_error,
            "measured_attitude_error": found.measured_attitude_error,
            "predicted_energy_change": found.predicted_energy_change,
            "measured_energy_change": found.measured_energy_change,
            "at": found.at, "mismatch": found.mismatch,
        })),
        "other_body": verdict.other_body.map(|found| json!({
            "moments": found.moments, "principal": found.principal,
        })),
        "other_torque": verdict.other_torque.map(|found| json!({
            "size": found.size, "factor": found.factor,
            "frame": found.constant.map(|(frame, _)| frame.to_string()), "torque": found.constant.map(|(_, torque)| torque),
        })),
        "other_wheel": verdict.other_wheel.map(|found| json!({
            "number": found.number, "speed": found.speed, "held": found.is_held,
        })),
        "advice": outcome.advice.as_ref().map(advice::object),
        "resolution": {
            "noise": verdict.noise.map(|noise| [noise.attitude, noise.rates]),
            "attitude": verdict.resolution.attitude, "rates": verdict.resolution.rates,
            "digits": verdict.resolution.digits, "single_precision": verdict.resolution.single_precision,
        },
        "body": {
            "inertia": verdict.body.inertia().tensor().row_iter()
                .map(|row| row.iter().copied().collect()).collect::<Vec<Vec<f64>>>(),
        },
        "warnings": outcome.warnings(),
    });
    if let Some(name) = &outcome.body {
        value["id"] = json!(name);
    }
    if let Some(difference) = &outcome.against {
        value["against"] = json!({
            "file": difference.name, "rows": difference.rows, "of": difference.of, "largest": difference.largest, "at": difference.at,
            "tolerance": difference.tolerance, "exact": verdict.attitude_error.map(|error| error.largest),
        });
    }
    value
}

fn ranking(verdict: &Verdict) -> Vec<Value> {
    let shown = verdict.ranking.iter().take(super::RANKED);
    shown
        .map(|ranked| {
            json!({
                "reading": reading(&ranked.reading), "log_likelihood_ratio": ranked.log_likelihood_ratio,
                "attitude_defect": ranked.attitude_defect, "rate_defect": ranked.rate_defect,
            })
        })
        .collect()
}

fn conservation(verdict: &Verdict) -> Map<String, Value> {
    let line = |found: &polhode::audit::Conservation| {
        let value = json!({
            "error": found.error, "resolution": found.resolution, "conserved": found.conserved,
            "slope": found.drift.map(|drift| drift.slope), "half_width": found.drift.map(|drift| drift.half_width),
        });
        (named(&found.quantity).0.to_string(), value)
    };
    verdict.conservation.iter().map(line).collect()
}
