//! A joint fit as text, as rows and as JSON.

use nalgebra::Matrix3;
use polhode_fit::{CarrierEstimate, MeasuredBody, Nuisance, Size};
use polhode_pages::table::{Format, Table, row};
use serde_json::{Map, Value, json};

use crate::fit::as_read::AsRead;
use crate::fit::report::{ENTRIES, SURE, estimates, nuisances, scaled, tensor, with_error, wrapped_lines};

pub(super) fn report(e: &CarrierEstimate, as_read: &AsRead, format: Format) -> String {
    match format {
        Format::Table => text(e, as_read),
        Format::Csv => rows(e).csv(),
        Format::Json => format!("{:#}\n", object(e, as_read)),
    }
}

/// The bodies that the fit tells: name of the rows, words, tensor.
pub(super) fn bodies(e: &CarrierEstimate) -> Vec<(&'static str, &'static str, &MeasuredBody)> {
    let added = if e.object_itself.is_some() { "object, as it adds to the carrier" } else { "object" };
    let all = [
        ("carrier", "carrier", Some(&e.carrier)),
        ("object", added, e.object.as_ref()),
        ("object_itself", "object about its centre of mass", e.object_itself.as_ref()),
    ];
    all.into_iter().filter_map(|(name, words, body)| Some((name, words, body?))).collect()
}

/// What gives the size, and how well each does by itself.
pub(super) fn sizes(e: &CarrierEstimate) -> Vec<String> {
    let line = |size: &Size| {
        let relative = 100.0 * size.relative;
        format!("size by the {} alone: to {relative:.2} % (one standard deviation)", size.source)
    };
    e.sizes.iter().map(line).collect()
}

/// How the records agree.
pub(super) fn agreement(e: &CarrierEstimate) -> String {
    let (chi2, dof) = (e.agreement.chi2, e.agreement.dof);
    match dof {
        0 => "agreement of the records: not tested, as there are no degrees of freedom".into(),
        _ => format!("agreement of the records: chi^2 {chi2:.1} of {dof} degrees of freedom"),
    }
}

fn text(e: &CarrierEstimate, as_read: &AsRead) -> String {
    let mut lines = Vec::new();
    for (_, words, body) in bodies(e) {
        lines.push(format!("{words}: principal moments (kg m^2, 95 %)"));
        for k in 0..3 {
            lines.push(format!(
                "  I{}  {}",
                k + 1,
                scaled(body.principal[k], SURE * body.sigma_principal[k])
            ));
        }
    }
    if let Some(wheel) = e.wheel {
        lines.push(format!("wheel inertia: {} kg m^2 (95 %)", scaled(wheel.inertia, SURE * wheel.sigma)));
    }
    lines.extend(sizes(e));
    lines.push(agreement(e));
    lines.extend(wrapped_lines(&as_read.sentences()));
    for (_, words, body) in bodies(e) {
        lines.push(tensor(&format!("{words} (kg m^2, sensor axes)"), &body.tensor));
        let deviations = Matrix3::from_fn(|i, k| body.covariance[(place(i, k), place(i, k))].sqrt());
        lines.push(tensor("standard deviations (kg m^2)", &deviations));
    }
    if !e.nuisances.is_empty() {
        lines.extend([String::new(), "sensor, from all records:".into()]);
        let line = |n: &Nuisance| {
            format!("  {:<16} {} {}", n.name, with_error(n.value, n.sigma), n.unit).trim_end().to_string()
        };
        lines.extend(e.nuisances.iter().map(line));
    }
    lines.extend([String::new(), "record                           samples  noise (rad/s)  torque".into()]);
    for (attached, of) in &e.records {
        lines.push(format!(
            "{attached:<31}  {:>7}  {:>13.3e}  {}",
            of.samples, of.noise_sigma, of.torque.model
        ));
    }
    lines.join("\n") + "\n"
}

/// The place of an entry in the order xx, yy, zz, xy, xz, yz.
fn place(i: usize, k: usize) -> usize {
    if i == k { i } else { i + k + 2 }
}

fn rows(e: &CarrierEstimate) -> Table {
    let mut table = estimates("carrier", "Carrier, proof body and object as one fit.");
    for (name, _, body) in bodies(e) {
        for (entry, i, k) in ENTRIES {
            let sigma = body.covariance[(place(i, k), place(i, k))].sqrt();
            table.push(row![format!("{name}_{entry}"), body.tensor[(i, k)], sigma, "kg m^2"]);
        }
        for k in 0..3 {
            let of = format!("{name}_principal_{}", k + 1);
            table.push(row![of, body.principal[k], body.sigma_principal[k], "kg m^2"]);
        }
    }
    if let Some(wheel) = e.wheel {
        table.push(row!["wheel_inertia", wheel.inertia, wheel.sigma, "kg m^2"]);
    }
    e.nuisances.iter().for_each(|n| table.push(row![n.name, n.value, n.sigma, n.unit]));
    table.push(row!["chi2", e.agreement.chi2, (2.0 * e.agreement.dof as f64).sqrt(), ""]);
    table.push(row!["pull", e.pull, None::<f64>, "standard deviations"]);
    table
}

fn object(e: &CarrierEstimate, as_read: &AsRead) -> Value {
    let square =
        |m: &Matrix3<f64>| (0..3).map(|i| json!([m[(i, 0)], m[(i, 1)], m[(i, 2)]])).collect::<Value>();
    let mut all: Map<String, Value> = ["carrier", "object", "object_itself", "wheel"]
        .map(|name| (name.to_string(), Value::Null))
        .into_iter()
        .collect();
    for (name, _, body) in bodies(e) {
        let axes = body.axes.quaternion();
        let covariance = body.covariance.row_iter().map(|r| r.iter().copied().collect::<Value>());
        all[name] = json!({
            "inertia": square(&body.tensor),
            "inertia_covariance": covariance.collect::<Value>(),
            "principal_moments": body.principal,
            "sigma_principal": body.sigma_principal,
            "axes": [axes.w, axes.i, axes.j, axes.k],
        });
    }
    if let Some(wheel) = e.wheel {
        all["wheel"] = json!({ "inertia": wheel.inertia, "sigma": wheel.sigma });
    }
    let more = json!({
        "covariance": e.covariance.row_iter().map(|r| r.iter().copied().collect::<Value>()).collect::<Value>(),
        "sizes": e.sizes.iter()
            .map(|size| json!({ "source": size.source.to_string(), "relative_sigma": size.relative })).collect::<Value>(),
        "chi2": e.agreement.chi2,
        "dof": e.agreement.dof,
        "pull": e.pull,
        "nuisances": nuisances(&e.nuisances),
        "records": e.records.iter().map(|(attached, of)| json!({
            "attached": attached.to_string(), "samples": of.samples, "segments": of.segments,
            "noise_sigma": of.noise_sigma, "torque": of.torque.model.to_string(), "chi2_per_dof": of.chi2_per_dof,
            "shape": square(&of.shape.tensor()),
            "warnings": of.warnings.iter().map(ToString::to_string).collect::<Value>(),
        })).collect::<Value>(),
        "read_as": as_read.json(),
        "warnings": e.warnings.iter().map(ToString::to_string).collect::<Value>(),
    });
    if let Value::Object(more) = more {
        all.extend(more);
    }
    Value::Object(all)
}
