//! A joint fit, or its refusal, as one page that needs no other file.

use polhode_fit::CarrierEstimate;
use polhode_pages::document::{Block, Form, Tone};

use super::report::{agreement, bodies, sizes};
use crate::fit::as_read::AsRead;
use crate::fit::page::{against, capital, minus, numbers};
use crate::fit::report::{ENTRIES, SURE, scaled};

/// The page of an answer from the files `names`.
pub(super) fn estimated(e: &CarrierEstimate, (names, as_read): (&str, &AsRead), form: Form) -> String {
    let warnings = e.all_warnings();
    let mut parts = vec![verdict(e, warnings.len())];
    parts.extend(bodies(e).into_iter().flat_map(|(_, words, body)| {
        let moments = (0..3).map(|k| {
            let value = shown(body.principal[k], body.sigma_principal[k]);
            let axis = body.axes * nalgebra::Vector3::ith(k, 1.0);
            let axis = axis.iter().map(|x| minus(&format!("{x:.5}")));
            [format!("I{}", k + 1), value].into_iter().chain(axis).collect()
        });
        let entries = ENTRIES.iter().enumerate().map(|(place, (name, i, k))| {
            let sigma = body.covariance[(place, place)].max(0.0).sqrt();
            vec![(*name).to_string(), shown(body.tensor[(*i, *k)], sigma)]
        });
        [
            Block::Heading(capital(words)),
            Block::Table(
                ["", "kg m², 95 %", "axis: x", "y", "z"].map(String::from).to_vec(),
                moments.collect(),
            ),
            Block::Table(["entry", "kg m², 95 %"].map(String::from).to_vec(), entries.collect()),
        ]
    }));
    let mut facts = sizes(e);
    if let Some(wheel) = e.wheel {
        facts.insert(0, format!("wheel inertia: {} kg m² (95 %)", shown(wheel.inertia, wheel.sigma)));
    }
    facts.push(agreement(e));
    facts.extend(as_read.sentences());
    parts.extend([Block::Heading("Size and agreement".into()), Block::List(facts)]);
    if !warnings.is_empty() {
        parts.extend([Block::Heading("Warnings".into()), Block::List(warnings)]);
    }
    if !e.nuisances.is_empty() {
        parts.extend([Block::Heading("Sensor, from all records".into()), numbers(&e.nuisances)]);
    }
    let rows = e.records.iter().map(|(attached, of)| {
        let noise = minus(&format!("{:.2e}", of.noise_sigma));
        vec![attached.to_string(), of.samples.to_string(), noise, of.torque.model.to_string()]
    });
    let heads = ["record", "samples", "noise (rad/s)", "torque"].map(String::from).to_vec();
    parts.extend([Block::Heading("Records".into()), Block::Table(heads, rows.collect())]);
    form.write(&format!("Carrier and object from {names}"), &parts)
}

/// The page of a refusal.
pub(super) fn refused(reason: &str, (names, as_read): (&str, &AsRead), form: Form) -> String {
    let verdict = Block::Verdict(Tone::Bad, format!("No inertia tensor: {reason}."));
    let parts = [verdict, Block::List(as_read.sentences())];
    form.write(&format!("No inertia from {names}"), &parts)
}

/// The moments of what was asked for, the last of the bodies, large.
fn verdict(e: &CarrierEstimate, warnings: usize) -> Block {
    let (words, body) = bodies(e).pop().map_or(("carrier", &e.carrier), |(_, words, body)| (words, body));
    let moments = [0, 1, 2].map(|k| shown(body.principal[k], body.sigma_principal[k])).join(", ");
    let (tone, against) = against(warnings);
    Block::Verdict(tone, format!("{}: moments {moments} kg m² (95 %){against}.", capital(words)))
}

fn shown(value: f64, sigma: f64) -> String {
    minus(&scaled(value, SURE * sigma).replace("+-", "±"))
}
