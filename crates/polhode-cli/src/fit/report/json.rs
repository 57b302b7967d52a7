//! A fit as JSON.

use nalgebra::{Matrix3, SMatrix};
use polhode_fit::{Estimate, InvariantTrend, Nuisance, Record};
use serde_json::{Map, Value, json};

use super::super::flights::Spans;
use super::{Sources, attitudes, unused};

fn square(m: &Matrix3<f64>) -> Vec<Vec<f64>> {
    (0..3).map(|i| (0..3).map(|j| m[(i, j)]).collect()).collect()
}

fn matrix(m: &SMatrix<f64, 6, 6>) -> Vec<Vec<f64>> {
    (0..6).map(|i| (0..6).map(|j| m[(i, j)]).collect()).collect()
}

pub(super) fn object(e: &Estimate, record: &Record, (spans, read, as_read): Sources<'_>) -> Value {
    let mut whole = answer(e);
    if let (Value::Object(all), Value::Object(more)) = (&mut whole, grounds(e, record, spans)) {
        all.extend(more);
        all.insert("attitudes".into(), attitudes::json(e, read));
        all.insert("read_as".into(), as_read.json());
    }
    whole
}

/// The tensor, and how far to trust it.
fn answer(e: &Estimate) -> Value {
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
        "rms_rate": e.rms_rate,
        "noise_sigma": e.noise_sigma,
        "quanta": e.quanta,
        "samples": e.samples,
        "segments": e.segments,
        "radius": e.radius,
        "method": e.method.words(),
        "identifiable": e.identifiability.complete(),
        "null_directions":
            e.identifiability.null_directions.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "rank": e.identifiability.rank,
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
        "momentum_drift": e.momentum_trend.map(drift),
        "energy_drift": e.energy_trend.map(drift),
        "unexplained": e.unexplained,
        "mirror": e.mirror.as_ref().map(|mirror| square(&mirror.tensor())),
        "sigma_mirror": e.sigma_mirror,
        "whiteness": { "correlation": e.whiteness.correlation, "sigma": e.whiteness.sigma },
    })
}

fn drift(of: InvariantTrend) -> Value {
    json!({ "rate": of.rate, "sigma": of.sigma })
}

/// What it rests on.
fn grounds(e: &Estimate, record: &Record, spans: &Spans) -> Value {
    json!({
        "torque": {
            "model": e.torque.model.to_string(),
            "coefficients": nuisances(&e.torque.coefficients),
            "gain": e.torque.gain,
            "ratios_without": e.torque.ratios_without,
        },
        "models": e.models.iter().map(|one| json!({
            "torque": one.model.to_string(), "torque_noise": one.has_torque_noise, "log_likelihood": one.gain,
            "share": one.share,
            "principal": one.principal, "sigma_principal": one.sigma_principal,
            "ratios": one.ratios, "sigma_ratios": one.sigma_ratios,
            "unexplained_share": one.unexplained, "held_out": one.held_out,
        })).collect::<Vec<_>>(),
        "reading_errors": e.reading_errors.iter().map(|one| json!({
            "error": one.error.to_string(), "size": one.size, "torque_noise": one.has_torque_noise,
            "log_likelihood": one.gain, "share": one.share,
            "principal": one.principal, "sigma_principal": one.sigma_principal,
            "ratios": one.ratios, "sigma_ratios": one.sigma_ratios, "held_out": one.held_out,
        })).collect::<Vec<_>>(),
        "nuisances": nuisances(&e.nuisances),
        "prior": e.prior.map(|p| json!({ "chi2": p.chi2, "dof": p.dof })),
        "systematic": e.systematic.iter().map(|line| json!({
            "name": line.name, "size": line.size, "unit": line.unit,
            "principal": line.principal, "ratios": line.ratios,
        })).collect::<Vec<_>>(),
        "unseen_change": e.unseen_change,
        "rho": e.per_segment.iter().map(|s| s.torque_noise * s.weight).sum::<f64>(),
        "per_segment": e.per_segment.iter().map(|s| json!({
            "segment": s.segment + 1, "samples": s.samples, "noise_sigma": s.noise_sigma,
            "torque_noise": s.torque_noise, "weight": s.weight, "shift": s.without.map(|w| w.shift),
            "ratios_without": s.without.map(|w| w.ratios), "sigma_ratios_without": s.without.map(|w| w.sigma_ratios),
        })).collect::<Vec<_>>(),
        "spikes": e.spikes.iter().map(|s| json!({
            "segment": s.segment + 1, "line": s.line, "time": s.time, "burst": s.burst.map(|k| k + 1),
        })).collect::<Vec<_>>(),
        "correlation": matrix(&e.correlation()),
        "next_steps": e.next_steps().iter().map(ToString::to_string).collect::<Vec<_>>(),
        "unused_columns": unused(record),
        "flights": spans.json(),
        "flight_limits": spans.limits(),
        "warnings": e.warnings.iter().map(ToString::to_string).chain(spans.remark().map(String::from))
            .collect::<Vec<_>>(),
    })
}

/// By name: value, standard deviation, unit, and the deviation of the prior where there is one.
pub(in crate::fit) fn nuisances(of: &[Nuisance]) -> Map<String, Value> {
    let entry = |n: &Nuisance| {
        let value = json!({ "value": n.value, "sigma": n.sigma, "unit": n.unit, "prior": n.prior });
        (n.name.to_string(), value)
    };
    of.iter().map(entry).collect()
}
