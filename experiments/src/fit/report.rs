//! A fit as text, as rows and as JSON.

use nalgebra::{Matrix3, SMatrix};
use polhode::fit::{AverageAxis, Estimate, Identifiability, Nuisance, Record, TorqueModel};
use serde_json::{Value, json};

use crate::table::{Column, Format, Table, row};

const METHOD: &str = "weak form, generalised least squares on denoised samples";
const ENTRIES: [(&str, usize, usize); 6] =
    [("xx", 0, 0), ("yy", 1, 1), ("zz", 2, 2), ("xy", 0, 1), ("xz", 0, 2), ("yz", 1, 2)];

/// A tensor in full.
pub(super) fn identified(e: &Estimate, format: Format) -> String {
    match format {
        Format::Table => text(e),
        Format::Csv => rows(e).csv(),
        Format::Json => pretty(&object(e)),
    }
}

/// What a record tells that does not determine the tensor.
pub(super) struct Facts {
    /// How many of the five numbers are known, where they can be counted.
    pub(super) rank: Option<usize>,
    pub(super) known: Vec<String>,
    pub(super) open: Vec<String>,
}

impl Facts {
    pub(super) fn unidentified(what: &Identifiability) -> Self {
        Facts {
            rank: Some(what.rank),
            known: what.known.iter().map(ToString::to_string).collect(),
            open: what.null_directions.iter().map(ToString::to_string).collect(),
        }
    }

    pub(super) fn unsettled(axes: &[AverageAxis]) -> Self {
        let open = "the ratios of the moments, and the axes otherwise: the iteration did not converge";
        Facts {
            rank: None,
            known: axes.iter().map(AverageAxis::to_string).collect(),
            open: vec![open.into()],
        }
    }

    pub(super) fn report(&self, record: &Record, format: Format) -> String {
        match format {
            Format::Json => pretty(&json!({
                "shape": null, "principal": null, "axes": null, "covariance": null, "sigma_principal": null,
                "inertia": null, "inertia_covariance": null, "noise_sigma": null,
                "samples": record.samples(), "segments": record.segments.len(), "method": METHOD,
                "identifiable": false, "rank": self.rank, "null_directions": self.open, "known": self.known,
                "triangle_slack": null, "active_constraints": [], "chi2_per_dof": null, "warnings": [],
            })),
            Format::Csv => {
                let columns = vec![
                    Column::new("kind", "", "known or undetermined"),
                    Column::new("fact", "", "in words"),
                ];
                let mut table = Table::new("facts", "What the record tells.", columns);
                self.known.iter().for_each(|fact| table.push(row!["known", fact.clone()]));
                self.open.iter().for_each(|fact| table.push(row!["undetermined", fact.clone()]));
                table.csv()
            }
            Format::Table => {
                let list = |facts: &[String]| facts.iter().map(|f| format!("  {f}\n")).collect::<String>();
                let counted = self.rank.map(|rank| format!("{rank} of 5 numbers of the tensor are known.\n"));
                format!(
                    "{}Known:\n{}Undetermined:\n{}",
                    counted.unwrap_or_default(),
                    if self.known.is_empty() { "  nothing\n".into() } else { list(&self.known) },
                    list(&self.open)
                )
            }
        }
    }
}

fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}

fn square(m: &Matrix3<f64>) -> Vec<Vec<f64>> {
    (0..3).map(|i| (0..3).map(|j| m[(i, j)]).collect()).collect()
}

fn matrix(m: &SMatrix<f64, 6, 6>) -> Vec<Vec<f64>> {
    (0..6).map(|i| (0..6).map(|j| m[(i, j)]).collect()).collect()
}

fn object(e: &Estimate) -> Value {
    let axes = e.axes.quaternion();
    json!({
        "shape": square(&e.shape.tensor()),
        "principal": e.principal,
        "axes": [axes.w, axes.i, axes.j, axes.k],
        "covariance": matrix(&e.covariance),
        "sigma_principal": e.sigma_principal,
        "sigma_axes": e.sigma_axes,
        "ratios": e.ratios,
        "sigma_ratios": e.sigma_ratios,
        "inertia": e.inertia.as_ref().map(|i| square(&i.tensor())),
        "inertia_covariance": e.inertia_covariance.as_ref().map(matrix),
        "noise_sigma": e.noise_sigma,
        "samples": e.samples,
        "segments": e.segments,
        "radius": e.radius,
        "method": METHOD,
        "identifiable": true,
        "null_directions": [],
        "spectrum": e.identifiability.deviations,
        "bound": e.bound.as_ref().map(matrix),
        "bound_ratio": e.bound_ratio,
        "triangle_slack": e.triangle_slack,
        "active_constraints": e.active_constraints.iter()
            .map(|c| json!({ "name": c.constraint.to_string(), "multiplier": c.multiplier })).collect::<Vec<_>>(),
        "certificate": {
            "stationarity": e.certificate.stationarity, "violation": e.certificate.violation,
            "dual_violation": e.certificate.dual_violation, "rounds": e.certificate.rounds,
        },
        "chi2_per_dof": e.chi2_per_dof,
        "pull": e.pull,
        "dof": e.dof,
        "momentum_drift": { "rate": e.momentum_trend.rate, "sigma": e.momentum_trend.sigma },
        "energy_drift": { "rate": e.energy_trend.rate, "sigma": e.energy_trend.sigma },
        "torque": {
            "model": torque_name(e.torque.model), "gain": e.torque.gain, "ratios_without": e.torque.ratios_without,
            "coefficients": nuisances(&e.torque.coefficients),
        },
        "nuisances": nuisances(&e.nuisances),
        "systematic": e.systematic.iter().map(|s| json!({
            "name": s.name, "size": s.size, "unit": s.unit, "principal": s.principal, "ratios": s.ratios,
        })).collect::<Vec<_>>(),
        "per_segment": e.per_segment.iter().map(|s| json!({
            "segment": s.segment + 1, "samples": s.samples, "noise_sigma": s.noise_sigma,
            "torque_noise": s.torque_noise, "weight": s.weight, "shift": s.shift,
        })).collect::<Vec<_>>(),
        "spikes": e.spikes.iter().map(|s| json!({ "line": s.line, "time": s.time })).collect::<Vec<_>>(),
        "rho": e.per_segment.iter().map(|s| s.torque_noise * s.weight).sum::<f64>(),
        "whiteness": { "correlation": e.whiteness.correlation, "sigma": e.whiteness.sigma },
        "warnings": e.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
    })
}

/// By name, each with value, standard deviation, unit and prior.
fn nuisances(list: &[Nuisance]) -> Value {
    let each = list.iter().map(|n| {
        let value = json!({ "value": n.value, "sigma": n.sigma, "unit": n.unit, "prior": n.prior });
        (n.name.to_string(), value)
    });
    Value::Object(each.collect())
}

fn torque_name(model: TorqueModel) -> &'static str {
    match model {
        TorqueModel::Drag => "drag",
        TorqueModel::Drag3 => "drag3",
        TorqueModel::Drag6 => "drag6",
        TorqueModel::Constant => "constant",
        _ => "none",
    }
}

fn rows(e: &Estimate) -> Table {
    let columns = vec![
        Column::new("quantity", "", "what"),
        Column::new("value", "", "estimate"),
        Column::new("sigma", "", "standard deviation"),
    ];
    let mut table = Table::new("fit", "Inertia from measured angular velocity.", columns);
    for k in 0..3 {
        table.push(row![format!("principal_{}", k + 1), e.principal[k], e.sigma_principal[k]]);
    }
    table.push(row!["ratio_1_3", e.ratios[0], e.sigma_ratios[0]]);
    table.push(row!["ratio_2_3", e.ratios[1], e.sigma_ratios[1]]);
    for (k, (name, i, j)) in ENTRIES.into_iter().enumerate() {
        table.push(row![format!("shape_{name}"), e.shape.tensor()[(i, j)], e.covariance[(k, k)].sqrt()]);
    }
    let q = e.axes.quaternion();
    for (name, value) in [("axes_w", q.w), ("axes_x", q.i), ("axes_y", q.j), ("axes_z", q.k)] {
        table.push(row![name, value, None::<f64>]);
    }
    if let (Some(inertia), Some(covariance)) = (&e.inertia, &e.inertia_covariance) {
        for (k, (name, i, j)) in ENTRIES.into_iter().enumerate() {
            table.push(row![format!("inertia_{name}"), inertia.tensor()[(i, j)], covariance[(k, k)].sqrt()]);
        }
    }
    for n in e.torque.coefficients.iter().chain(&e.nuisances) {
        table.push(row![n.name, n.value, n.sigma]);
    }
    table.push(row!["triangle_slack", e.triangle_slack, 2.0 * e.sigma_principal[2]]);
    table.push(row!["noise_sigma", e.noise_sigma, None::<f64>]);
    table.push(row!["chi2_per_dof", e.chi2_per_dof, (2.0 / e.dof.max(1) as f64).sqrt()]);
    table.push(row!["bound_ratio", e.bound_ratio, None::<f64>]);
    table.push(row!["momentum_drift", e.momentum_trend.rate, e.momentum_trend.sigma]);
    table.push(row!["energy_drift", e.energy_trend.rate, e.energy_trend.sigma]);
    table.push(row!["whiteness", e.whiteness.correlation, e.whiteness.sigma]);
    table
}

/// `value +- sigma` with two digits of the deviation.
fn with_error(value: f64, sigma: f64) -> String {
    if !(sigma > 0.0 && sigma.is_finite()) {
        return format!("{value:.6}");
    }
    let digits = (1 - libm::floor(libm::log10(sigma)) as i32).clamp(0, 15) as usize;
    format!("{value:.digits$} +- {sigma:.digits$}")
}

fn text(e: &Estimate) -> String {
    let mut lines = vec![
        format!("{} samples, segments: {}, noise {:.3e} rad/s", e.samples, e.segments, e.noise_sigma),
        format!("method: {METHOD}, test functions of half width {:.4} s", e.radius),
        String::new(),
        "principal moments (shares of the trace) and axes in sensor axes:".into(),
    ];
    let axes = e.axes.to_rotation_matrix();
    for k in 0..3 {
        let v = axes.matrix().column(k);
        let turn = e.sigma_axes[k].to_degrees();
        let turn = if turn < 90.0 { format!("{turn:.2} deg about it") } else { "any turn about it".into() };
        lines.push(format!(
            "  I{}  {:<26} ({:8.5}, {:8.5}, {:8.5}) +- {turn}",
            k + 1,
            with_error(e.principal[k], e.sigma_principal[k]),
            v[0],
            v[1],
            v[2]
        ));
    }
    lines.push(format!("  I1/I3  {}", with_error(e.ratios[0], e.sigma_ratios[0])));
    lines.push(format!("  I2/I3  {}", with_error(e.ratios[1], e.sigma_ratios[1])));
    let tensor = |name: &str, m: &Matrix3<f64>| {
        let row = |i: usize| format!("  {:13.6e} {:13.6e} {:13.6e}", m[(i, 0)], m[(i, 1)], m[(i, 2)]);
        format!("\n{name}:\n{}\n{}\n{}", row(0), row(1), row(2))
    };
    for n in e.torque.coefficients.iter().chain(&e.nuisances) {
        lines.push(format!("  {:<16} {} {}", n.name, with_error(n.value, n.sigma), n.unit).trim_end().into());
    }
    if !e.systematic.is_empty() {
        lines.push(
            "systematic changes of I1, I2, I3 by errors of the sensor that are taken to be zero:".into(),
        );
        for s in &e.systematic {
            let [a, b, c] = s.principal.map(|change| format!("{change:9.5}"));
            let name = format!("{} {} {}", s.name, s.size, s.unit);
            lines.push(format!("  {:<28} {a} {b} {c}", name.trim_end()));
        }
    }
    lines.push(tensor("shape (trace 1)", &e.shape.tensor()));
    if let Some(inertia) = &e.inertia {
        lines.push(tensor("inertia (kg m^2)", &inertia.tensor()));
    }
    let percent = |drift: polhode::fit::InvariantTrend| with_error(100.0 * drift.rate, 100.0 * drift.sigma);
    lines.extend([
        String::new(),
        format!("standard deviations of the five determined combinations: {}", spectrum(e)),
        e.bound_ratio.map_or("no Cramer-Rao bound for this tensor".into(), |r| {
            format!("standard deviation over the Cramer-Rao bound: {r:.3}")
        }),
        format!("chi^2 per degree of freedom: {:.3} ({} degrees)", e.chi2_per_dof, e.dof),
        format!(
            "correlation of neighbouring residuals: {:.3} +- {:.3}",
            e.whiteness.correlation, e.whiteness.sigma
        ),
        format!("drift of |J w|: {} per cent per second", percent(e.momentum_trend)),
        format!("drift of w J w: {} per cent per second", percent(e.energy_trend)),
        format!("I1 + I2 - I3: {}", with_error(e.triangle_slack, 2.0 * e.sigma_principal[2])),
        format!(
            "optimality: stationarity {:.1e}, violation {:.1e}, after {} rounds of cutting planes",
            e.certificate.stationarity, e.certificate.violation, e.certificate.rounds
        ),
    ]);
    lines.join("\n") + "\n"
}

fn spectrum(e: &Estimate) -> String {
    e.identifiability.deviations.map(|d| format!("{d:.1e}")).join(", ")
}
